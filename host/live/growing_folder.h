// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "topple/session.h"

namespace topple::live {

// A folder of depth frames (docs/formats.md) into which another program writes meanwhile: frames
// come in the order of their names, the trajectory has a pose for each, and may be written anew.
class GrowingFolder {
  public:
    explicit GrowingFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // The depth camera's; none as long as the folder can't be read. It may be that it is being
    // written: then waits_for() says what was wrong.
    std::optional<Intrinsics> intrinsics();
    // Adds the frames that have come, at most so many, and corrects poses that are others now;
    // whether there were any. A frame that the session refuses is left out, and `told` of it.
    bool read(Session& session, std::size_t most, const std::function<void(const char*)>& told);
    const std::string& waits_for() const { return waits_for_; }

  private:
    struct Known {
        std::optional<FrameId> frame;  // none: refused
        Mat4 pose{};
    };
    std::filesystem::path folder_;
    std::vector<Known> known_;  // by image, in the order of their names
    std::string waits_for_;
};

}  // namespace topple::live
