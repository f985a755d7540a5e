// SPDX-License-Identifier: MIT
#include "device/trace.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>

#include "core/printable.h"
#include "topple/error.h"

namespace topple::device {
namespace {

constexpr int host_process = 1, device_process = 2;  // as the format groups tracks

// As JSON: control characters, and what is no UTF-8, are written as \\xNN.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : printable(text, SIZE_MAX)) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + "\"";
}

[[noreturn]] void can_not_write(const std::filesystem::path& file, const std::string& why) {
    throw Error(ErrorKind::input,
                printable(file.string(), SIZE_MAX) + ": can't be written: " + why);
}

// Through a file beside it, which takes its name when it is whole. A link is not written through.
void write_whole(const std::filesystem::path& file, const std::string& text) {
    struct stat status {};
    if (::lstat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
        can_not_write(file, "it is no regular file");
    std::string part = file.string() + ".XXXXXX";
    const int opened = ::mkstemp(part.data());
    if (opened < 0) can_not_write(file, std::strerror(errno));
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t wrote = ::write(opened, text.data() + done, text.size() - done);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) break;
        done += static_cast<std::size_t>(wrote);
    }
    const bool whole = done == text.size() && ::fchmod(opened, 0644) == 0;
    const bool closed = ::close(opened) == 0;
    if (whole && closed && std::rename(part.c_str(), file.c_str()) == 0) return;
    const std::string why = std::strerror(errno);
    ::unlink(part.c_str());
    can_not_write(file, why);
}

// The format's times are microseconds.
std::string micro(std::int64_t ns) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3f", static_cast<double>(ns) * 1e-3);
    return text;
}

// Names that don't say what was done with them.
std::string title(const Trace::Event& event) {
    for (const char* own : {"stage", "batch", "dispatch"})
        if (std::string_view(event.kind) == own) return event.name;
    return event.kind + (" " + event.name);
}

std::string metadata(const char* what, int process, std::size_t thread, const std::string& name) {
    return std::string("{\"ph\":\"M\",\"name\":\"") + what +
           "\",\"pid\":" + std::to_string(process) + ",\"tid\":" + std::to_string(thread) +
           ",\"args\":{\"name\":" + quoted(name) + "}}";
}

std::uint64_t cpu_ns(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000 +
           static_cast<std::uint64_t>(time.tv_nsec);
}

}  // namespace

std::shared_ptr<Trace> Trace::of_environment() {
    static std::mutex mutex;
    static std::weak_ptr<Trace> shared;
    const char* const file = ::secure_getenv("TOPPLE_TRACE");
    if (!file || !*file) return nullptr;
    const std::lock_guard lock(mutex);
    std::shared_ptr<Trace> trace = shared.lock();
    if (trace) return trace;
    try {
        shared = trace = std::make_shared<Trace>(std::filesystem::path(file));
    } catch (const Error& error) {
        throw Error(error.kind(), std::string("TOPPLE_TRACE: ") + error.what());
    }
    return trace;
}

// An empty one at once: what can't be written is told before work begins.
Trace::Trace(std::filesystem::path file) : file_(std::move(file)) {
    write_whole(file_, text());
}

Trace::~Trace() {
    try {
        write();
    } catch (const std::exception&) {  // a parse that ends well has told of it
    }
}

std::uint32_t Trace::add_track(const std::string& name) {
    const std::lock_guard lock(mutex_);
    tracks_.push_back({name, true});
    return static_cast<std::uint32_t>(tracks_.size() - 1);
}

void Trace::add(Event event) noexcept {
    try {
        const std::lock_guard lock(mutex_);
        events_.push_back(std::move(event));
    } catch (const std::exception&) {
    }
}

void Trace::add_here(Event event) noexcept {
    try {
        const std::lock_guard lock(mutex_);
        const auto [found, added] = threads_.try_emplace(
            std::this_thread::get_id(), static_cast<std::uint32_t>(tracks_.size()));
        if (added) tracks_.push_back({"host thread " + std::to_string(threads_.size()), false});
        event.track = found->second;
        events_.push_back(std::move(event));
    } catch (const std::exception&) {
    }
}

std::vector<Trace::Event> Trace::events() const {
    const std::lock_guard lock(mutex_);
    return events_;
}

std::string Trace::text() const {
    std::string out = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n";
    out += metadata("process_name", host_process, 0, "topple") + ",\n" +
           metadata("process_name", device_process, 0, "devices");
    const auto process = [&](std::size_t track) {
        return tracks_[track].device ? device_process : host_process;
    };
    for (std::size_t t = 0; t < tracks_.size(); ++t)
        out += ",\n" + metadata("thread_name", process(t), t, tracks_[t].name);
    for (const Event& event : events_) {
        const std::int64_t begin = to_ns(event.begin);
        out += ",\n{\"ph\":\"X\",\"cat\":" + quoted(event.kind) +
               ",\"name\":" + quoted(title(event)) +
               ",\"pid\":" + std::to_string(process(event.track)) +
               ",\"tid\":" + std::to_string(event.track) + ",\"ts\":" + micro(begin) +
               ",\"dur\":" + micro(to_ns(event.end) - begin) + ",\"args\":{";
        const char* comma = "";
        for (const auto& [key, value] : event.numbers) {
            out += comma;
            out += quoted(key) + ":" + std::to_string(value);
            comma = ",";
        }
        out += "}}";
    }
    return out + "\n]}\n";
}

void Trace::write() {
    const std::lock_guard lock(mutex_);
    if (file_.empty() || written_ == events_.size()) return;
    write_whole(file_, text());
    written_ = events_.size();
}

std::uint64_t thread_cpu_ns() {
    return cpu_ns(CLOCK_THREAD_CPUTIME_ID);
}

std::uint64_t process_cpu_ns() {
    return cpu_ns(CLOCK_PROCESS_CPUTIME_ID);
}

void share_cpu(std::span<DispatchTime> times, std::uint64_t cpu_ns) {
    double all = 0;
    for (const DispatchTime& time : times) all += static_cast<double>(time.end_ns - time.begin_ns);
    if (all <= 0) return;
    for (DispatchTime& time : times)
        time.cpu_ns = static_cast<std::uint64_t>(
            static_cast<double>(cpu_ns) * static_cast<double>(time.end_ns - time.begin_ns) / all);
}

}  // namespace topple::device
