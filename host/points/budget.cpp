// SPDX-License-Identifier: MIT
#include "points/budget.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <system_error>
#include <utility>

#include "core/number_text.h"
#include "core/process_memory.h"
#include "io/open_file.h"
#include "io/text.h"
#include "topple/error.h"

namespace topple {
namespace {

// What an input may take that nobody vouches for: of each begun megabyte as much as the densest
// honest rooms need, and then some.
constexpr std::uint64_t megabyte = 1'000'000, bytes_of_a_megabyte = 2'000'000'000;
// And how long, before it is told: a room takes some seconds.
constexpr double seconds_of_a_megabyte = 9;

constexpr std::chrono::milliseconds between_looks{25};

// Of the pages of files those that every run has, of the program and its libraries. Others are the
// input's, which the system drops where it needs them.
constexpr std::uint64_t program_bytes = std::uint64_t{64} << 20;

constexpr const char* of_options = "of max_memory_bytes (--max-memory)";
constexpr const char* with_options = " with max_memory_bytes (--max-memory)";

// All parses that run in this process: what they may take together, beside what it had before them.
struct Running {
    std::mutex mutex;
    std::uint64_t parses = 0, before = 0;
    double allowed = 0;
};
Running running;

std::uint64_t taken() {
    const ProcessMemory memory = process_memory();
    return memory.own + std::min(memory.of_files, program_bytes);
}

thread_local Budget* current_budget = nullptr;

[[noreturn]] void throw_beyond(const std::string& what, std::uint64_t need, std::uint64_t limit,
                               const std::string& whose, const std::string& mend) {
    const std::string with = whose == of_options ? "" : with_options;
    const std::string needed = io::sufficient_bytes_text(need);
    std::string given = io::bytes_text(limit);
    // More digits, where three say the same of both.
    for (int digits = 4; given == needed && digits < 12; ++digits)
        given = io::bytes_text(limit, digits);
    throw Error(ErrorKind::input, what + " " + needed + ", more than the " + given + " " + whose +
                                      ": allow that much" + with + ", or " + mend);
}

}  // namespace

Budget::Budget(std::string source, std::uint64_t input_bytes, const ParseOptions& options)
    : source_(std::move(source)),
      options_(options),
      outer_(current_budget),
      input_bytes_(input_bytes) {
    const std::uint64_t megabytes =
        std::max<std::uint64_t>(1, input_bytes / megabyte + (input_bytes % megabyte != 0));
    seconds_ = seconds_of_a_megabyte * static_cast<double>(megabytes);
    if (options.max_memory_bytes > 0) {
        bytes_ = options.max_memory_bytes;
    } else {
        const std::uint64_t left = memory_left(), of_machine = left - left / 4,
                            of_input = io::saturating_multiply(megabytes, bytes_of_a_megabyte);
        bytes_ = std::min(of_machine, of_input);
        of_ = of_input < of_machine ? Of::input : Of::machine;
    }
    const std::lock_guard lock(running.mutex);
    if (running.parses++ == 0) running.before = taken();
    running.allowed += static_cast<double>(bytes_);
    current_budget = this;
}

Budget::~Budget() {
    current_budget = outer_;
    const std::lock_guard lock(running.mutex);
    running.allowed -= static_cast<double>(bytes_);
    --running.parses;
}

Budget* Budget::current() {
    return current_budget;
}

std::string Budget::whose() const {
    if (of_ == Of::options) return of_options;
    if (of_ == Of::machine) return "that are three quarters of what is free here";
    return "that an input of " + io::bytes_text(input_bytes_) + " may take";
}

ParseOptions Budget::polled() {
    ParseOptions out = options_;
    out.cancelled = [this] {
        if (options_.cancelled && options_.cancelled()) return true;
        const auto now = Clock::now();
        if (now - looked_ < between_looks) return false;
        looked_ = now;
        look();
        return false;
    };
    out.progress = [this](const std::string& stage, double done) {
        if (stage != stage_) stage_ = stage;
        if (options_.progress) options_.progress(stage, done);
    };
    return out;
}

void Budget::check(const std::string& what, std::uint64_t need_bytes,
                   const std::string& mend) const {
    if (need_bytes > bytes_) throw_beyond(what, need_bytes, bytes_, whose(), mend);
}

double Budget::spent_s() const {
    return static_cast<double>(std::clock() - spent_before_) / CLOCKS_PER_SEC;
}

void Budget::tell(const std::string& what, const std::string& mend) {
    if (std::exchange(told_, true) || !options_.notice) return;
    options_.notice(source_ + ": " + what + ", which is long for an input of " +
                    io::bytes_text(input_bytes_) + "; where that is too long, " + mend);
}

void Budget::begin_work(const std::string& what, const std::string& mend, double expected_s) {
    work_ = what;
    mend_ = mend;
    const double whole_s = spent_s() + expected_s;
    if (whole_s > 2 * seconds_)
        tell(what + " take about " + duration_text(whole_s) + " of processor time", mend);
}

void Budget::look() {
    const std::uint64_t now = taken();
    double most = 0;  // that the process may have
    {
        // Whatever a system counts as taken before, a parse may take the least.
        const std::lock_guard lock(running.mutex);
        most = static_cast<double>(running.before) +
               std::max(running.allowed, static_cast<double>(least_bytes));
    }
    const std::string what = "in the stage \"" + stage_ + "\" " + work_;
    if (static_cast<double>(now) > most)
        throw Error(ErrorKind::input, source_ + ": " + what + " take more than the " +
                                          io::bytes_text(bytes_) + " " + whose() + ": allow more" +
                                          (asked() ? "" : with_options) + ", or " + mend_);
    // Where other threads of the process are busy, its time passes faster than the clock's.
    if (spent_s() > seconds_ &&
        2 * (Clock::now() - start_) > std::chrono::duration<double>(seconds_))
        tell(what + " have taken " + duration_text(spent_s()) + " of processor time", mend_);
}

std::uint64_t bytes_of_input(const std::filesystem::path& input) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (!fs::is_directory(input, error)) {
        const std::uintmax_t size = fs::file_size(input, error);
        return error ? 0 : size;
    }
    std::uint64_t sum = 0;
    for (const char* const folder : {"", "depth", "color"}) {
        for (const std::string& name : io::folder_names(input / folder, error)) {
            std::error_code missing;
            const std::uintmax_t size = fs::file_size(input / folder / name, missing);
            if (!missing) sum += size;
        }
    }
    return sum;
}

void check_memory(const std::string& what, std::uint64_t need_bytes, const ParseOptions& options,
                  const std::string& mend) {
    if (const Budget* budget = Budget::current()) return budget->check(what, need_bytes, mend);
    const std::uint64_t limit = memory_bound(options);
    if (need_bytes > limit) throw_beyond(what, need_bytes, limit, of_options, mend);
}

std::uint64_t memory_bound(const ParseOptions& options) {
    if (const Budget* budget = Budget::current()) return budget->bytes();
    return options.max_memory_bytes > 0 ? options.max_memory_bytes : UINT64_MAX;
}

std::string memory_bound_text(const ParseOptions& options) {
    const Budget* budget = Budget::current();
    return io::bytes_text(memory_bound(options)) + " " + (budget ? budget->whose() : of_options);
}

std::string duration_text(double seconds) {
    if (seconds < 9.5) return to_digits(seconds, 2) + " s";
    if (seconds < 90) return to_places(std::ceil(seconds), 0) + " s";
    return to_places(std::ceil(seconds / 60), 0) + " min";
}

}  // namespace topple
