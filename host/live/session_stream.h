// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "live/feed.h"

namespace topple::live {

// Frames or sweeps of points, and corrections of their poses, as messages that another program
// writes one after the other into a file descriptor (docs/live.md): a line of JSON, and the
// readings that it tells of. A thread of its own reads them, as far ahead as memory allows: then
// whoever writes waits.
class SessionStream final : public Feed {
  public:
    // called: what messages call it. Messages that wait take so much memory at most.
    SessionStream(int file, std::string called, std::size_t most_bytes = std::size_t{256} << 20);
    ~SessionStream() override;

    std::unique_ptr<Session> begin(const SessionOptions& options) override;
    bool read(Session& session, const Reading& how) override;
    std::uint64_t number_of(FrameId frame) const override;
    bool ended() override;

  private:
    // Frames are numbered from 0 on as they come.
    using Number = std::uint64_t;
    struct Sweep {
        PointCloud points;
        Mat4 pose{};
    };
    struct Correct {
        std::map<Number, Mat4> poses;
    };
    struct Forget {
        Number frame = 0;
    };
    struct Message {
        std::variant<Intrinsics, DepthFrame, Sweep, Correct, Forget> what;
        std::string called;     // "standard input: message 3"
        std::size_t bytes = 0;  // that it takes, about
    };
    class Reader;

    std::optional<Message> next();
    void read_on(int file);
    // Whether it changed anything. Throws Error(input) for what the session refuses.
    bool apply(Session& session, const Message& message);
    FrameId frame_of(Number frame) const;

    const std::string called_;
    const std::size_t most_bytes_;
    std::vector<std::optional<FrameId>> frames_;  // by number; none: left out, or forgotten

    mutable std::mutex mutex_;
    std::condition_variable taken_;
    std::deque<Message> waiting_;
    std::size_t waiting_bytes_ = 0;
    bool closed_ = false, stopping_ = false;
    std::string fault_;
    std::thread reading_;
};

}  // namespace topple::live
