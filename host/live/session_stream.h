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

    std::unique_ptr<Session> begin(const SessionOptions& options,
                                   const std::filesystem::path& checkpoint) override;
    bool read(Session& session, const Reading& how) override;
    bool ended() override;

  private:
    struct Sweep {
        PointCloud points;
        Mat4 pose{};
    };
    struct Correct {
        std::map<FrameId, Mat4> poses;
    };
    struct Forget {
        FrameId frame = 0;
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
    static bool apply(Session& session, const Message& message);

    const std::string called_;
    const std::size_t most_bytes_;

    mutable std::mutex mutex_;
    std::condition_variable taken_;
    std::deque<Message> waiting_;
    std::size_t waiting_bytes_ = 0;
    bool closed_ = false, stopping_ = false;
    std::string fault_;
    std::thread reading_;
};

}  // namespace topple::live
