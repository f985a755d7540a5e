// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "scale/task_list.h"
#include "topple/crew.h"
#include "topple/error.h"

namespace topple::mpi {

// The ranks of an MPI job as a crew; rank 0 leads. It needs MPI_THREAD_SERIALIZED, and MPI
// initialised for as long as it lives.
//
// Ranks ask the leader for their tasks one by one. During a stage a thread of the leader's answers
// them, and it alone calls MPI there, while the others of its threads work, too. All waiting is by
// polling with sleeps: MPI's own would take a core from those who work.
class MpiCrew final : public Crew {
  public:
    MpiCrew();
    ~MpiCrew() override;

    int rank() const { return rank_; }
    // This rank's share of its machine's cores: each core that it may run on, divided by the number
    // of ranks that may, rounded down, but at least 1.
    unsigned cores() const { return cores_; }

    void begin(const std::string& order, std::vector<Task> tasks) override;
    std::uint64_t finished() const override { return tasks_.finished(); }
    std::optional<std::string> wait() override;
    std::optional<std::uint64_t> next(std::optional<std::uint64_t> finished) override;
    void end(std::exception_ptr failed, const std::function<void()>& poll) override;

    // Whether a rank has failed, for whoever works to stop early. The leader then throws failure().
    bool stopped();
    std::optional<Error> failure() const;

    // The last call, of every rank: tells the leader what this rank has failed with outside of
    // stages, and waits until all have come here.
    void finish(const std::optional<Error>& failed);

  private:
    // What ranks tell the leader.
    enum class Say : std::int64_t {
        next,     // "I want a task"; with the one that is finished
        failed,   // with kind and message
        left,     // "I have ended my part of the stage"
        farewell  // "I send nothing more"
    };
    struct Message {
        Say say = Say::next;
        std::int64_t value = -1;   // a task, or an ErrorKind
        std::uint64_t length = 0;  // of the text that follows
    };
    static constexpr int to_leader = 1, text_to_leader = 2, task_tag = 3, order_tag = 4;

    void find_cores();
    void tell_leader(Say say, std::int64_t value, const std::string& text = {});
    void tell_leader(const Error& failed);
    void tell_all(char kind, const std::string& text = {});
    std::optional<std::pair<char, std::string>> take_order();
    // The leader: handles a message that has come, if there is one.
    bool serve_one();
    bool look_for_stop();
    void serve();
    void note_failure(const Error& failed);
    std::string signed_text(const Error& failed) const;

    int rank_ = 0, size_ = 1, machines_ = 1;
    unsigned cores_ = 1;
    std::string machine_;
    std::mutex calls_;  // of MPI
    std::atomic<bool> stopped_{false};
    std::atomic<std::int64_t> looked_{0};  // when stopped() did so, nanoseconds
    bool ended_ = false;                   // a member's: that the leader has ended the job

    // The leader's.
    TaskList tasks_;
    std::thread server_;
    std::atomic<bool> alone_{false};  // all others have ended their part of the stage
    int left_ = 0, farewells_ = 0;
    mutable std::mutex failure_lock_;
    std::optional<Error> failure_;
};

}  // namespace topple::mpi
