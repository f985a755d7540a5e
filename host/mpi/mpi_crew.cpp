// SPDX-License-Identifier: MIT
#include "mpi/mpi_crew.h"

#include <mpi.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

namespace topple::mpi {
namespace {

using namespace std::chrono_literals;

// Between looks for a message: of those who want their next task, and of those who wait for others.
constexpr std::chrono::microseconds brief = 500us, long_while = 10ms;
// Between calls of the leader's poll while it waits for the others' last tasks, and between looks
// for a failure elsewhere.
constexpr std::chrono::milliseconds between_polls = 50ms;

// A failure as it is sent.
Error as_error(const std::exception_ptr& failed) {
    try {
        std::rethrow_exception(failed);
    } catch (const Error& error) {
        return error;
    } catch (const std::bad_alloc&) {
        return {ErrorKind::input,
                "out of memory; use a smaller --tile, or fewer ranks on a machine"};
    } catch (const std::exception& error) {
        return {ErrorKind::input, error.what()};
    }
}

bool has_come(int source, int tag, MPI_Status& status) {
    int come = 0;
    MPI_Iprobe(source, tag, MPI_COMM_WORLD, &come, &status);
    return come != 0;
}

}  // namespace

MpiCrew::MpiCrew() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    char name[MPI_MAX_PROCESSOR_NAME];
    int length = 0;
    MPI_Get_processor_name(name, &length);
    machine_.assign(name, static_cast<std::size_t>(length));
    find_cores();
}

MpiCrew::~MpiCrew() {
    if (server_.joinable()) server_.join();
}

void MpiCrew::find_cores() {
    MPI_Comm machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
    int place = 0, here = 1;
    MPI_Comm_rank(machine, &place);
    MPI_Comm_size(machine, &here);
    const int first = place == 0;
    MPI_Allreduce(&first, &machines_, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    cpu_set_t mine;
    CPU_ZERO(&mine);
    // A machine of more cores than the set holds: that many are assumed, and shared by all.
    if (sched_getaffinity(0, sizeof(mine), &mine) != 0)
        for (std::size_t c = 0; c < CPU_SETSIZE; ++c) CPU_SET(c, &mine);
    std::vector<cpu_set_t> all(static_cast<std::size_t>(here));
    MPI_Allgather(&mine, sizeof(mine), MPI_BYTE, all.data(), sizeof(mine), MPI_BYTE, machine);
    MPI_Comm_free(&machine);
    double share = 0;
    for (std::size_t c = 0; c < CPU_SETSIZE; ++c) {
        if (!CPU_ISSET(c, &mine)) continue;
        share += 1.0 / static_cast<double>(std::ranges::count_if(
                           all, [&](const cpu_set_t& set) { return CPU_ISSET(c, &set); }));
    }
    cores_ = std::max(1u, static_cast<unsigned>(share + 1e-6));
}

void MpiCrew::tell_leader(Say say, std::int64_t value, const std::string& text) {
    const Message message{say, value, text.size()};
    MPI_Send(&message, sizeof(message), MPI_BYTE, 0, to_leader, MPI_COMM_WORLD);
    if (!text.empty())
        MPI_Send(text.data(), static_cast<int>(text.size()), MPI_BYTE, 0, text_to_leader,
                 MPI_COMM_WORLD);
}

std::string MpiCrew::signed_text(const Error& failed) const {
    return "rank " + std::to_string(rank_) + (machines_ > 1 ? " on " + machine_ : "") + ": " +
           failed.what();
}

void MpiCrew::tell_leader(const Error& failed) {
    tell_leader(Say::failed, static_cast<std::int64_t>(failed.kind()), signed_text(failed));
}

// 'o' an order, 's' stop, 'e' the end.
void MpiCrew::tell_all(char kind, const std::string& text) {
    const std::string message = std::string(1, kind) + text;
    for (int to = 1; to < size_; ++to)
        MPI_Send(message.data(), static_cast<int>(message.size()), MPI_BYTE, to, order_tag,
                 MPI_COMM_WORLD);
}

std::optional<std::pair<char, std::string>> MpiCrew::take_order() {
    const std::lock_guard lock(calls_);
    MPI_Status status;
    if (!has_come(0, order_tag, status)) return std::nullopt;
    int length = 0;
    MPI_Get_count(&status, MPI_BYTE, &length);
    std::string text(static_cast<std::size_t>(length), '\0');
    MPI_Recv(text.data(), length, MPI_BYTE, 0, order_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return std::pair(text.at(0), text.substr(1));
}

void MpiCrew::note_failure(const Error& failed) {
    const std::lock_guard lock(failure_lock_);
    if (!failure_) failure_ = failed;
    tasks_.close();
}

std::optional<Error> MpiCrew::failure() const {
    const std::lock_guard lock(failure_lock_);
    return failure_;
}

bool MpiCrew::serve_one() {
    MPI_Status status;
    if (!has_come(MPI_ANY_SOURCE, to_leader, status)) return false;
    const int from = status.MPI_SOURCE;
    Message message;
    MPI_Recv(&message, sizeof(message), MPI_BYTE, from, to_leader, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    std::string text(message.length, '\0');
    if (message.length > 0)
        MPI_Recv(text.data(), static_cast<int>(text.size()), MPI_BYTE, from, text_to_leader,
                 MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    switch (message.say) {
        case Say::next: {
            const auto task = tasks_.next(
                message.value < 0 ? std::nullopt : std::optional<std::uint64_t>(message.value));
            const std::int64_t answer = task ? static_cast<std::int64_t>(*task) : -1;
            MPI_Send(&answer, 1, MPI_INT64_T, from, task_tag, MPI_COMM_WORLD);
            break;
        }
        case Say::failed:
            note_failure({static_cast<ErrorKind>(message.value), text});
            break;
        case Say::left:
            ++left_;
            break;
        case Say::farewell:
            ++farewells_;
            break;
    }
    return true;
}

void MpiCrew::serve() {
    while (left_ < size_ - 1) {
        try {
            if (!serve_one()) std::this_thread::sleep_for(brief);
            if (!stopped_ && failure()) {
                stopped_ = true;
                tell_all('s');
            }
        } catch (...) {
            note_failure(as_error(std::current_exception()));
        }
    }
    alone_ = true;
}

void MpiCrew::begin(const std::string& order, std::vector<Task> tasks) {
    tasks_.begin(std::move(tasks));
    if (failure()) tasks_.close();
    left_ = 0;
    alone_ = false;
    tell_all('o', order);
    try {
        server_ = std::thread([this] { serve(); });
    } catch (const std::system_error&) {
        // Without a thread for them the others are served between the leader's own tasks.
    }
}

std::optional<std::string> MpiCrew::wait() {
    while (!ended_) {
        auto order = take_order();
        if (!order) {
            std::this_thread::sleep_for(long_while);
        } else if (order->first == 'o') {
            return std::move(order->second);
        } else if (order->first == 'e') {
            ended_ = true;
        }
    }
    return std::nullopt;
}

std::optional<std::uint64_t> MpiCrew::next(std::optional<std::uint64_t> finished) {
    if (rank_ == 0) return tasks_.next(finished);
    const std::lock_guard lock(calls_);
    tell_leader(Say::next, finished ? static_cast<std::int64_t>(*finished) : -1);
    MPI_Status status;
    while (!has_come(0, task_tag, status)) std::this_thread::sleep_for(brief);
    std::int64_t task = -1;
    MPI_Recv(&task, 1, MPI_INT64_T, 0, task_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (task < 0) return std::nullopt;
    return static_cast<std::uint64_t>(task);
}

void MpiCrew::end(std::exception_ptr failed, const std::function<void()>& poll) {
    if (rank_ > 0) {
        // Who was stopped has failed by that alone.
        const bool told = look_for_stop();
        const std::lock_guard lock(calls_);
        if (failed && !told) tell_leader(as_error(failed));
        tell_leader(Say::left, -1);
        return;
    }
    const auto fail = [&](const std::exception_ptr& error) {
        const Error own = as_error(error);
        note_failure({own.kind(), signed_text(own)});
        if (!failed) failed = error;
    };
    if (failed) fail(failed);
    auto last = std::chrono::steady_clock::now();
    if (!server_.joinable()) serve();
    while (!alone_) {
        std::this_thread::sleep_for(brief);
        if (failed || std::chrono::steady_clock::now() - last < between_polls) continue;
        last = std::chrono::steady_clock::now();
        try {
            poll();
        } catch (...) {
            fail(std::current_exception());
        }
    }
    if (server_.joinable()) server_.join();
    if (const auto first = failure()) throw *first;
}

bool MpiCrew::stopped() {
    // Whoever polls does so often, and each look may give this thread's time to another process.
    const std::int64_t now = std::chrono::steady_clock::now().time_since_epoch() / 1ns;
    std::int64_t last = looked_;
    if (now - last < between_polls / 1ns || !looked_.compare_exchange_strong(last, now))
        return stopped_;
    return look_for_stop();
}

bool MpiCrew::look_for_stop() {
    if (stopped_) return true;
    if (rank_ > 0) {
        // During a stage, and until this rank has left it, no other order can come.
        if (const auto order = take_order()) {
            stopped_ = true;
            ended_ = order->first == 'e';
        }
    } else if (!server_.joinable()) {
        const std::lock_guard lock(calls_);
        while (serve_one()) {
        }
        stopped_ = failure().has_value();
    }
    return stopped_;
}

void MpiCrew::finish(const std::optional<Error>& failed) {
    if (rank_ == 0) {
        tell_all('e');
        while (farewells_ < size_ - 1)
            if (!serve_one()) std::this_thread::sleep_for(brief);
        return;
    }
    if (failed) tell_leader(*failed);
    while (wait()) end(nullptr, [] {});
    tell_leader(Say::farewell, -1);
}

}  // namespace topple::mpi
