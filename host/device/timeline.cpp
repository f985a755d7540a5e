// SPDX-License-Identifier: MIT
#include "device/timeline.h"

#include <algorithm>
#include <utility>

namespace topple::device {
namespace {

// Memory that only batches in flight still keep alive. More of it is waited for: else a loop that
// never reads a result would take all there is.
constexpr std::uint64_t most_held_bytes = 256u << 20;

}  // namespace

std::uint64_t Timeline::begun(std::unique_ptr<Running> running, std::unique_ptr<BoundsCheck> checks,
                              std::vector<Memory*> bound) {
    const std::uint64_t batch = ++last_;
    for (Memory* memory : bound) memory->batch_ = batch;
    const bool ended = !running;
    flights_.push_back({batch, std::move(running), std::move(checks), std::move(bound), {}});
    if (ended) finish(batch);
    return batch;
}

bool Timeline::ended(std::uint64_t batch) {
    while (!flights_.empty() && flights_.front().running->ended()) finish_first();
    return flights_.empty() || batch < flights_.front().batch;
}

void Timeline::finish(std::uint64_t batch) {
    while (!flights_.empty() && flights_.front().batch <= batch) finish_first();
}

void Timeline::finish_first() {
    Running* const running = flights_.front().running.get();
    retire(running ? running->wait() : nullptr);
}

void Timeline::retire(std::exception_ptr error) {
    Flight flight = std::move(flights_.front());
    flights_.pop_front();
    if (!error && flight.checks) {
        flight.checks->memory().batch_ = 0;  // what it reads is no wait of the host's
        try {
            flight.checks->throw_if_found();
        } catch (const Error&) {
            error = std::current_exception();
        }
    }
    if (error) failures_.push_back({flight.batch, error});
    for (auto& memory : flight.given_back) {
        held_bytes_ -= memory->capacity_;
        std::erase(flight.bound, memory.get());
        pool_.give(std::move(memory));
    }
    for (Memory* memory : flight.bound)
        if (memory->batch_ == flight.batch) memory->batch_ended();
}

void Timeline::throw_failure(std::uint64_t batch) {
    const auto later = std::ranges::find_if(
        failures_, [&](const Failure& failure) { return failure.batch > batch; });
    if (later == failures_.begin()) return;
    const std::exception_ptr first = failures_.front().error;
    failures_.erase(failures_.begin(), later);
    std::rethrow_exception(first);
}

void Timeline::give_back(std::unique_ptr<Memory> memory) {
    memory->given_back();
    const bool lent = memory->capacity_ == 0;  // the caller may end it as soon as this returns
    if (lent) finish(memory->batch_);
    if (flights_.empty() || memory->batch_ < flights_.front().batch) {
        if (!lent) pool_.give(std::move(memory));
        return;
    }
    held_bytes_ += memory->capacity_;
    Flight& last = flights_[memory->batch_ - flights_.front().batch];
    last.given_back.push_back(std::move(memory));
    while (held_bytes_ > most_held_bytes) finish_first();
}

}  // namespace topple::device
