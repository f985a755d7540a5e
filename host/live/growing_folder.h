// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "live/feed.h"

namespace topple::io {
class FrameSequence;
}

namespace topple::live {

// A folder of depth frames (docs/formats.md) into which another program writes meanwhile: frames
// come in the order of their names, the trajectory has a pose for each, and may be written anew.
class GrowingFolder final : public Feed {
  public:
    using Clock = std::chrono::steady_clock;
    // patience: for so long an image that can't be read must stay as it is, while one behind it can
    // be read, before it counts as damaged and not as one that is being written.
    explicit GrowingFolder(std::filesystem::path folder,
                           Clock::duration patience = std::chrono::seconds(2))
        : folder_(std::move(folder)), patience_(patience) {}

    // The depth camera's; none as long as the folder can't be read. It may be that it is being
    // written: then waits_for() says what was wrong.
    std::optional<Intrinsics> intrinsics();

    std::unique_ptr<Session> begin(const SessionOptions& options,
                                   const std::filesystem::path& checkpoint) override;
    bool read(Session& session, const Reading& how) override;
    bool ended() override { return false; }
    std::string missing_from(const std::string& out) const override;

  private:
    using Stamps = std::vector<std::pair<std::uintmax_t, std::filesystem::file_time_type>>;
    static Stamps stamps_of(const io::FrameSequence& frames, std::size_t image);
    bool is_damaged(const io::FrameSequence& frames, std::size_t image);
    void leave_out_damaged(Session& session, const Reading& how);

    std::filesystem::path folder_;
    Clock::duration patience_;
    // By image, in the order of their names, the pose that the session has; none: it was left out.
    std::vector<std::optional<Mat4>> poses_;
    // The next image, where it can't be read: its files' sizes and times, and since when.
    Stamps unread_;
    Clock::time_point unread_since_{};
    std::size_t damaged_ = 0;    // images
    std::string first_damaged_;  // its name, and why
};

}  // namespace topple::live
