// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "topple/session.h"

namespace topple::live {

// Where the frames of a session come from while another program makes them.
class Feed {
  public:
    virtual ~Feed() = default;

    // A session of what comes, or that goes on from a checkpoint, where there is such a file; null
    // as long as it is not known what comes. Throws Error(input) where the checkpoint is of
    // something else. The session's numbers of frames are those that the feed gives them.
    virtual std::unique_ptr<Session> begin(const SessionOptions& options,
                                           const std::filesystem::path& checkpoint) = 0;

    struct Reading {
        std::size_t most = SIZE_MAX;  // frames that are added at once
        bool is_last = false;         // nobody writes any more: what can't be read now is damaged
        // Lines about what is left out, and why.
        std::function<void(const std::string&)> told;
    };
    // Adds the frames that have come, and corrects poses that are others now; whether there were
    // any. A frame that the session refuses is left out.
    virtual bool read(Session& session, const Reading& how) = 0;
    // Why it goes on no further now; empty: nothing is wrong.
    const std::string& waits_for() const { return waits_for_; }
    // Whether nothing more can come; then waits_for() says what was wrong, if anything.
    virtual bool ended() = 0;
    // What came and is not in the session, and why, at the end; empty: nothing. out: what the
    // session was written to; empty: it was not.
    virtual std::string missing_from(const std::string& out) const {
        if (waits_for_.empty() || out.empty()) return waits_for_;
        return waits_for_ + "; what came since is not in " + out;
    }

  protected:
    // Of frames of such a camera; none: of sweeps of points.
    static std::unique_ptr<Session> session_of(const std::optional<Intrinsics>& camera,
                                               const SessionOptions& options,
                                               const std::filesystem::path& checkpoint);
    std::string waits_for_;
};

}  // namespace topple::live
