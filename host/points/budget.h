// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>

#include "topple/parse.h"

namespace topple {

// The memory that a parse may take, and the time after which it says that it takes long. What it
// will need is asked for where that is known before; and what it has taken is looked at wherever it
// polls, so that no stage goes on beyond the bound. A result does not depend on it.
class Budget {
  public:
    // What ParseOptions::max_memory_bytes says. Where it says nothing, three quarters of what is
    // free here, and of an input that is small no more than any of its size should need. The
    // options must stay. While it lives it is current() on the thread that made it.
    Budget(std::string source, std::uint64_t input_bytes, const ParseOptions& options);
    ~Budget();
    Budget(const Budget&) = delete;
    Budget& operator=(const Budget&) = delete;
    // Of the parse on this thread; null where there is none.
    static Budget* current();

    // What every run takes, about, whatever its bound: less is not looked at.
    static constexpr std::uint64_t least_bytes = std::uint64_t{256} << 20;

    std::uint64_t bytes() const { return bytes_; }
    // Whether it is the caller's, not this class's.
    bool asked() const { return of_ == Of::options; }
    // Whose bound that is, to follow after a number of bytes: "of max_memory_bytes (--max-memory)".
    std::string whose() const;
    // Seconds of the processor that an input of its size may take before a user is told.
    double seconds() const { return seconds_; }

    // The same options, with which a parse polls this, and tells it its stages.
    ParseOptions polled();

    // Throws Error(input) where `need_bytes` are more: "<what> 1.03 GiB, more than the 1.02 GiB
    // ...: allow that much, or <mend>".
    void check(const std::string& what, std::uint64_t need_bytes, const std::string& mend) const;
    // What the stages are about to work on, "1.2 million voxels of 0.02 m", and how it would be
    // less: "use voxel_m (--voxel) = 0.05"; for messages. expected_s: about how long it takes,
    // which is told at once where that is long.
    void begin_work(const std::string& what, const std::string& mend, double expected_s);

  private:
    using Clock = std::chrono::steady_clock;
    // Throws Error(input) where more than bytes() are taken; says so once where it takes long.
    void look();
    double spent_s() const;
    void tell(const std::string& what, const std::string& mend);

    const std::string source_;
    const ParseOptions& options_;
    const Clock::time_point start_ = Clock::now();
    const std::clock_t spent_before_ = std::clock();
    Clock::time_point looked_ = start_;
    Budget* const outer_;
    std::uint64_t bytes_ = 0, input_bytes_ = 0;
    enum class Of { options, machine, input } of_ = Of::options;
    double seconds_ = 0;
    bool told_ = false;
    std::string stage_, work_ = "its points", mend_ = "give fewer points";
};

// Bytes of a file, or of the files of a folder of frames.
std::uint64_t bytes_of_input(const std::filesystem::path& input);

// As Budget::check(), by the current budget; where there is none, by max_memory_bytes alone.
void check_memory(const std::string& what, std::uint64_t need_bytes, const ParseOptions& options,
                  const std::string& mend);

// What a parse with these options may take on this thread; UINT64_MAX: no limit. In words: "1.02
// GiB of max_memory_bytes (--max-memory)".
std::uint64_t memory_bound(const ParseOptions& options);
std::string memory_bound_text(const ParseOptions& options);

// "1.5 s", "12 s", "5 min".
std::string duration_text(double seconds);

}  // namespace topple
