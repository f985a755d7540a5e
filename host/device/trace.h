// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace topple::device {

// What devices and the host did, and when. Any thread may add to it.
class Trace {
  public:
    using Clock = std::chrono::steady_clock;
    using Number = std::pair<const char*, std::uint64_t>;
    struct Event {
        const char* kind;  // stage, batch, wait, build, write, read, fill; of devices: dispatch
        std::string name;  // of the stage, kernel or buffer
        std::uint32_t track = 0;
        Clock::time_point begin, end;
        std::vector<Number> numbers;  // such as bytes
    };

    // The one that TOPPLE_TRACE=FILE in the environment asks for, shared by all that record in this
    // process; null where it does not. Throws Error(input) where FILE can't be written.
    static std::shared_ptr<Trace> of_environment();

    Trace() = default;  // without a file
    explicit Trace(std::filesystem::path file);
    ~Trace();
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;

    // A line of events beside the host's threads, which get theirs with their first event.
    std::uint32_t add_track(const std::string& name);
    // Events are dropped where there is no memory for them.
    void add(Event event) noexcept;
    void add_here(Event event) noexcept;  // on this thread's track
    std::vector<Event> events() const;

    // Writes all events so far in the Trace Event Format (Chrome, Perfetto): whole or not at all,
    // in place of what was written before. Does nothing without a file. Throws Error(input).
    void write();

  private:
    struct Track {
        std::string name;
        bool device;
    };
    std::string text() const;

    mutable std::mutex mutex_;
    std::vector<Track> tracks_;
    std::map<std::thread::id, std::uint32_t> threads_;
    std::vector<Event> events_;
    std::size_t written_ = 0;  // events
    std::filesystem::path file_;
};

// An event of this thread's that lasts as long as this object. Costs nothing without a trace.
class TraceSpan {
  public:
    TraceSpan(Trace* trace, const char* kind, std::string_view name,
              std::initializer_list<Trace::Number> numbers = {})
        : trace_(trace) {
        if (trace) event_ = {kind, std::string(name), 0, Trace::Clock::now(), {}, numbers};
    }
    ~TraceSpan() {
        if (!trace_) return;
        event_.end = Trace::Clock::now();
        trace_->add_here(std::move(event_));
    }
    TraceSpan(const TraceSpan&) = delete;
    TraceSpan& operator=(const TraceSpan&) = delete;

  private:
    Trace* trace_;
    Trace::Event event_{};
};

// Processor time in ns: of this thread, or of all of the process.
std::uint64_t thread_cpu_ns();
std::uint64_t process_cpu_ns();

// When one dispatch ran, in ns by any clock, and the processor time of it.
struct DispatchTime {
    std::int64_t begin_ns, end_ns;
    std::uint64_t cpu_ns = 0;
};

// Shares out processor time by how long each ran.
void share_cpu(std::span<DispatchTime> times, std::uint64_t cpu_ns);

inline std::int64_t to_ns(Trace::Clock::time_point time) {
    return std::chrono::nanoseconds(time.time_since_epoch()).count();
}

}  // namespace topple::device
