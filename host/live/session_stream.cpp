// SPDX-License-Identifier: MIT
#include "live/session_stream.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "io/json_entry.h"
#include "io/text.h"
#include "points/caller_frames.h"
#include "points/formats/frame_sequence.h"
#include "topple/error.h"

namespace topple::live {
namespace {

// Of a line: poses of some 50,000 frames.
constexpr std::size_t most_line_bytes = std::size_t{16} << 20;
constexpr std::uint64_t most_points = 10'000'000;  // of a sweep

Mat4 pose_of(const io::JsonEntry& entry, const std::string& name, const Json& json) {
    Mat4 out{};
    if (!json.is_array() || json.size() != out.size() ||
        !std::ranges::all_of(json, [](const Json& each) { return each.is_number(); }))
        entry.wrong(io::in_quotes(name) + " must be a list of 16 numbers, row by row");
    std::ranges::transform(json, out.begin(), [](const Json& each) { return each.get<double>(); });
    return out;
}

std::uint64_t count_of(const io::JsonEntry& entry, const char* name, std::uint64_t most) {
    const Json& json = entry.field(name);
    if (!json.is_number_unsigned() || json.get<std::uint64_t>() > most)
        entry.wrong(io::in_quotes(name) + " is " + json.dump().substr(0, 40) +
                    ", but must be a whole number up to " + std::to_string(most));
    return json.get<std::uint64_t>();
}

bool flag_of(const io::JsonEntry& entry, const char* name) {
    if (!entry.has(name)) return false;
    const Json& json = entry.field(name);
    if (!json.is_boolean()) entry.wrong(io::in_quotes(name) + " must be true or false");
    return json.get<bool>();
}

// What has other fields than these is of a later version, or misspelt.
void expect_only(const io::JsonEntry& entry, const Json& json,
                 std::initializer_list<std::string_view> known) {
    for (const auto& [name, value] : json.items())
        if (std::ranges::find(known, name) == known.end())
            entry.wrong("has " + io::in_quotes(name) + ", which it can't have");
}

}  // namespace

// On the thread that reads.
class SessionStream::Reader {
  public:
    Reader(int file, const std::filesystem::path& called, const std::function<bool()>& stops)
        : file_(file), called_(called), stops_(stops) {}

    // Nothing at the end, or where it is stopped. Throws Error(input).
    std::optional<Message> next() {
        std::string line;
        do {
            ++number_;
            if (!read_line(line)) return std::nullopt;
        } while (line.find_first_not_of(" \t\r") == std::string::npos);
        Message out;
        const std::string name = "message " + std::to_string(messages_++);
        out.called = called_.string() + ": " + name;
        const Json json = parsed(out.called, line);
        const io::JsonEntry entry(called_, name, json);
        if (entry.has("intrinsics")) {
            expect_only(entry, json, {"intrinsics"});
            if (messages_ > 1) entry.wrong("has intrinsics, which only the first may have");
            out.what = camera_.emplace(io::depth_intrinsics(out.called, json.at("intrinsics")));
        } else if (entry.has("add")) {
            add(entry, json, out);
        } else if (entry.has("correct")) {
            expect_only(entry, json, {"correct"});
            out.what = corrected(entry, json.at("correct"));
        } else if (entry.has("forget")) {
            expect_only(entry, json, {"forget"});
            out.what = Forget{count_of(entry, "forget", UINT32_MAX)};
        } else {
            entry.wrong("has none of \"intrinsics\", \"add\", \"correct\" and \"forget\"");
        }
        if (stopped_) return std::nullopt;
        payload_ = std::exchange(out.bytes, out.bytes + line.size());
        return out;
    }

  private:
    Json parsed(const std::string& called, const std::string& line) const {
        try {
            return io::parse_json(called, line);
        } catch (const Error& error) {
            std::string hint;
            if (line.find("NaN") != line.npos)
                hint = "; NaN is no number of JSON: send no frame whose place is not known";
            else if (payload_ > 0)
                hint = "; were the readings of the message before longer than the " +
                       std::to_string(payload_) + " bytes that its line means?";
            throw Error(error.kind(), error.what() + hint);
        }
    }

    void add(const io::JsonEntry& entry, const Json& json, Message& out) {
        const std::string what = entry.text("add");
        const bool rgb = flag_of(entry, "rgb");
        if (what == "frame") {
            expect_only(entry, json, {"add", "pose", "rgb"});
            if (!camera_) entry.wrong("adds a frame, but the first message had no intrinsics");
            DepthFrame frame;
            frame.camera_to_world = pose_of(entry, "pose", entry.field("pose"));
            const std::size_t pixels = std::size_t{camera_->width} * camera_->height;
            frame.depth = read_values<std::uint16_t>(entry, pixels);
            if (rgb) frame.rgb = read_values<std::uint8_t>(entry, 3 * pixels);
            out.bytes = pixels * sizeof(std::uint16_t) + frame.rgb.size();
            out.what = std::move(frame);
        } else if (what == "points") {
            expect_only(entry, json, {"add", "pose", "rgb", "count"});
            if (camera_) entry.wrong("adds points, but the first message had intrinsics");
            const auto count = static_cast<std::size_t>(count_of(entry, "count", most_points));
            Sweep sweep;
            sweep.pose = pose_of(entry, "pose", entry.field("pose"));
            const auto at = read_values<float>(entry, 3 * count);
            std::vector<std::uint8_t> colours;
            if (rgb) colours = read_values<std::uint8_t>(entry, 3 * count);
            out.bytes = at.size() * sizeof(float) + colours.size();
            spread(at, {&sweep.points.x, &sweep.points.y, &sweep.points.z});
            spread(colours, {&sweep.points.red, &sweep.points.green, &sweep.points.blue});
            out.what = std::move(sweep);
        } else {
            entry.wrong("adds " + io::in_quotes(what) +
                        ", which is neither \"frame\" nor \"points\"");
        }
    }

    static Correct corrected(const io::JsonEntry& entry, const Json& json) {
        if (!json.is_object()) entry.wrong("\"correct\" must hold a pose for each frame's number");
        Correct out;
        for (const auto& [name, pose] : json.items()) {
            FrameId number = 0;
            const auto [end, error] =
                std::from_chars(name.data(), name.data() + name.size(), number);
            if (error != std::errc() || end != name.data() + name.size())
                entry.wrong("corrects " + io::in_quotes(name) + ", which is no frame's number");
            out.poses[number] = pose_of(entry, name, pose);
        }
        return out;
    }

    template <class T>
    static void spread(const std::vector<T>& from, const std::array<std::vector<T>*, 3>& to) {
        for (std::size_t n = 0; n < from.size(); ++n) to[n % 3]->push_back(from[n]);
    }

    // More bytes behind those that are held; false at the end, or where it is stopped.
    bool fill() {
        constexpr std::size_t at_once = std::size_t{1} << 20;
        constexpr int wait_ms = 100;
        held_.erase(0, std::exchange(used_, 0));
        while (!(stopped_ = stops_())) {
            pollfd ready{file_, POLLIN, 0};
            const int count = ::poll(&ready, 1, wait_ms);
            if (count == 0 || (count < 0 && errno == EINTR)) continue;
            const std::size_t before = held_.size();
            held_.resize(before + at_once);
            const ssize_t got = count < 0 ? -1 : ::read(file_, held_.data() + before, at_once);
            const int error = errno;
            held_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
            if (got >= 0) return got > 0;
            if (error == EINTR || error == EAGAIN) continue;
            io::fail(called_, std::string("can't be read: ") + std::strerror(error));
        }
        return false;
    }

    bool read_line(std::string& line) {
        std::size_t looked = 0;
        for (;;) {
            const std::string_view held = std::string_view(held_).substr(used_);
            if (const std::size_t end = held.find('\n', looked); end != held.npos) {
                line = held.substr(0, end);
                used_ += end + 1;
                return true;
            }
            looked = held.size();
            if (looked > most_line_bytes)
                io::fail(called_, "line " + std::to_string(number_) + " is longer than " +
                                      std::to_string(most_line_bytes >> 20) + " MiB");
            if (fill()) continue;
            if (stopped_ || looked == 0) return false;
            io::fail(called_, "ends within a message, which needs its line's end");
        }
    }

    // Little-endian. Memory grows with what comes, whatever is said to come.
    template <class T>
    std::vector<T> read_values(const io::JsonEntry& entry, std::size_t count) {
        std::vector<T> out;
        std::size_t left = count * sizeof(T);
        std::string bytes;
        while (left > 0) {
            if (used_ == held_.size() && !fill()) {
                if (stopped_) return {};
                entry.wrong("is cut short: " + std::to_string(left) + " of " +
                            std::to_string(count * sizeof(T)) + " bytes are missing");
            }
            const std::size_t some = std::min(left, held_.size() - used_);
            bytes.append(held_, used_, some);
            used_ += some;
            left -= some;
        }
        out.resize(count);
        if (count > 0) std::memcpy(out.data(), bytes.data(), bytes.size());
        return out;
    }

    const int file_;
    const std::filesystem::path called_;
    const std::function<bool()> stops_;
    std::optional<Intrinsics> camera_;
    std::string held_;
    std::size_t used_ = 0, number_ = 0, messages_ = 0;
    std::size_t payload_ = 0;  // of the message before
    bool stopped_ = false;
};

SessionStream::SessionStream(int file, std::string called, std::size_t most_bytes)
    : called_(std::move(called)), most_bytes_(most_bytes) {
    reading_ = std::thread([this, file] { read_on(file); });
}

SessionStream::~SessionStream() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    taken_.notify_all();
    reading_.join();
}

void SessionStream::read_on(int file) {
    Reader reader(file, called_, [this] {
        const std::lock_guard lock(mutex_);
        return stopping_;
    });
    std::string fault;
    try {
        while (auto message = reader.next()) {
            std::unique_lock lock(mutex_);
            taken_.wait(lock, [&] {
                return stopping_ || waiting_.empty() ||
                       waiting_bytes_ + message->bytes <= most_bytes_;
            });
            if (stopping_) return;
            waiting_bytes_ += message->bytes;
            waiting_.push_back(std::move(*message));
        }
    } catch (const std::exception& error) {
        fault = error.what();
    }
    const std::lock_guard lock(mutex_);
    closed_ = true;
    fault_ = std::move(fault);
}

std::optional<SessionStream::Message> SessionStream::next() {
    std::optional<Message> out;
    const std::lock_guard lock(mutex_);
    if (!waiting_.empty()) {
        out = std::move(waiting_.front());
        waiting_.pop_front();
        waiting_bytes_ -= out->bytes;
        taken_.notify_all();
    }
    return out;
}

bool SessionStream::ended() {
    const std::lock_guard lock(mutex_);
    if (!closed_ || !waiting_.empty()) return false;
    waits_for_ = fault_;
    return true;
}

std::unique_ptr<Session> SessionStream::begin(const SessionOptions& options,
                                              const std::filesystem::path& checkpoint) {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty()) return nullptr;
    const auto* camera = std::get_if<Intrinsics>(&waiting_.front().what);
    return session_of(camera ? std::optional(*camera) : std::nullopt, options, checkpoint);
}

bool SessionStream::apply(Session& session, const Message& message) {
    return std::visit(
        [&](const auto& what) {
            using What = std::decay_t<decltype(what)>;
            if constexpr (std::is_same_v<What, DepthFrame>) {
                session.add(view_of(what, *session.intrinsics()), what.camera_to_world);
            } else if constexpr (std::is_same_v<What, Sweep>) {
                session.add(CloudView(what.points), what.pose);
            } else if constexpr (std::is_same_v<What, Correct>) {
                session.correct(what.poses);
            } else if constexpr (std::is_same_v<What, Forget>) {
                session.forget(what.frame);
            }
            return !std::is_same_v<What, Intrinsics>;
        },
        message.what);
}

bool SessionStream::read(Session& session, const Reading& how) {
    bool changed = false;
    const FrameId first = session.next_frame();
    while (session.next_frame() - first < how.most) {
        const std::optional<Message> message = next();
        if (!message) break;
        try {
            changed |= apply(session, *message);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::usage) throw;
            const bool adds = std::holds_alternative<DepthFrame>(message->what) ||
                              std::holds_alternative<Sweep>(message->what);
            if (adds) session.skip_frame();
            if (how.told)
                how.told(message->called + ": " + error.what() +
                         (adds ? "; it is left out" : "; so the message does nothing"));
        }
    }
    return changed;
}

}  // namespace topple::live
