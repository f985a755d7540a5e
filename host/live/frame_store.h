// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/checksum.h"
#include "live/checkpoint.h"

namespace topple::live {

using Frames = std::map<FrameId, PosedFrame>;

std::string name_of(FrameId frame);
DepthFrame posed_image(const PosedFrame& kept);

// The frames that a session has. One thread may add them while others read.
class FrameStore {
  public:
    // image: ScanKind::image(). Of more than most_bytes those go whose cameras have a neighbour.
    FrameStore(KeptFrames from, std::uint64_t most_bytes,
               std::function<DepthFrame(const KeptFrame&)> image);

    // For the thread that adds.
    FrameId next() const { return frames_.next; }
    void skip();
    // Throws Error(input) for the frame before once more. readings: of what it holds, its pose not
    // yet. rigid: its pose, made so; given: as it was given.
    FrameId add(Checksum& readings, const Mat4& rigid, const Mat4& given,
                const std::function<std::shared_ptr<const KeptFrame>()>& made);
    // As those of Session.
    void correct(const std::map<FrameId, Mat4>& poses);
    void forget(FrameId frame);
    std::vector<FrameId> ids() const;
    std::uint64_t bytes() const;

    // Throws Error(input) where there are none.
    void need_any() const;
    // All, and how many changes there were before. Throws as need_any() does.
    std::pair<Frames, std::uint64_t> snapshot() const;
    std::uint64_t changes() const;
    KeptFrames all() const;

  private:
    void need_some() const;  // as need_any(), locked
    void drop(Frames::iterator kept);
    void keep_to_limit();
    void drop_least_missed();

    mutable std::mutex mutex_;
    KeptFrames frames_;
    std::uint64_t most_bytes_, bytes_ = 0, changes_ = 0;
    std::function<DepthFrame(const KeptFrame&)> image_;
};

}  // namespace topple::live
