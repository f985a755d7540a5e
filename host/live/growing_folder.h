// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "topple/session.h"

namespace topple::io {
class FrameSequence;
}

namespace topple::live {

// A folder of depth frames (docs/formats.md) into which another program writes meanwhile: frames
// come in the order of their names, the trajectory has a pose for each, and may be written anew.
class GrowingFolder {
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

    struct Reading {
        std::size_t most = SIZE_MAX;  // frames that are added at once
        bool is_last = false;         // nobody writes any more: what can't be read now is damaged
        std::function<void(const std::string&)> told;  // of each image that is left out, and why
    };
    // Adds the frames that have come, and corrects poses that are others now; whether there were
    // any. A frame that the session refuses is left out, as a damaged one is.
    bool read(Session& session, const Reading& how);
    const std::string& waits_for() const { return waits_for_; }

    std::size_t images() const { return known_.size(); }  // that were read or left out
    std::size_t damaged() const { return damaged_; }      // of them, left out as such
    const std::string& first_damaged() const { return first_damaged_; }  // its name, and why

  private:
    struct Known {
        std::optional<FrameId> frame;  // none: left out
        Mat4 pose{};
    };
    using Stamps = std::vector<std::pair<std::uintmax_t, std::filesystem::file_time_type>>;
    static Stamps stamps_of(const io::FrameSequence& frames, std::size_t image);
    bool is_damaged(const io::FrameSequence& frames, std::size_t image);
    void leave_out_damaged(const Reading& how);

    std::filesystem::path folder_;
    Clock::duration patience_;
    std::vector<Known> known_;  // by image, in the order of their names
    std::string waits_for_;
    // The next image, where it can't be read: its files' sizes and times, and since when.
    Stamps unread_;
    Clock::time_point unread_since_{};
    std::size_t damaged_ = 0;
    std::string first_damaged_;
};

}  // namespace topple::live
