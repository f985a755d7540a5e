// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "points/formats/colour_image.h"
#include "points/frame_stream.h"
#include "topple/frames_view.h"

namespace topple {

// A frame as it is given to be parsed; it must stay.
FrameView view_of(const DepthFrame& frame, const Intrinsics& intrinsics);

// Depth frames in the caller's memory, each checked before anything relies on it: all at once where
// all are there, else one by one as they come. What they give is what FrameSequence gives of the
// same in files.
class CallerFrames final : public FrameStream {
  public:
    // The frames must stay as long as this. Throws Error: input (intrinsics, a pose or an image
    // make no sense, or are of different numbers), usage (both images and what gives them).
    explicit CallerFrames(const FramesView& frames);

    const Intrinsics& intrinsics() const override { return from_.intrinsics; }
    std::size_t size() const override { return poses_.size(); }
    DepthFrame load(std::size_t i) const override;
    DepthFrame load_coloured(std::size_t i) const override;
    bool one_by_one() const override { return from_.images.empty(); }

    bool posed() const { return !from_.camera_to_world.empty(); }
    const std::vector<Mat4>& poses() const { return poses_; }
    const std::string& source() const { return source_; }
    std::vector<std::string> notes() const;  // in sentences

  private:
    [[noreturn]] void refuse(const std::string& why) const;
    [[noreturn]] void refuse(std::size_t frame, const std::string& why) const;
    void check_cameras() const;
    void take_poses();
    FrameView view(std::size_t i) const;
    void check(std::size_t i, const FrameView& view) const;
    template <class Pixel>
    void check_rows(std::size_t i, const char* name, const ImageView<Pixel>& image) const;
    DepthFrame depth_of(std::size_t i, const FrameView& view) const;
    std::vector<std::uint16_t> stored_of(std::size_t i, const ImageView<float>& metres) const;

    const FramesView& from_;
    std::string source_;
    std::vector<Mat4> poses_;
};

}  // namespace topple
