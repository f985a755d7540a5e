// SPDX-License-Identifier: MIT
#include "cli/max_memory_option.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <map>
#include <thread>

#include "core/process_memory.h"
#include "points/budget.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

const std::map<std::string, double> size_units{
    {"", 1},         {"B", 1},      {"K", 0x1p10},   {"KiB", 0x1p10}, {"kB", 1e3},
    {"KB", 1e3},     {"M", 0x1p20}, {"MiB", 0x1p20}, {"MB", 1e6},     {"G", 0x1p30},
    {"GiB", 0x1p30}, {"GB", 1e9},   {"T", 0x1p40},   {"TiB", 0x1p40}, {"TB", 1e12}};

// Whether what the system counts as data is the program's alone: sanitizers have much of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool data_is_ours = false;
#else
constexpr bool data_is_ours = true;
#endif

// "500M", "4G", "1.5GB", or a number of bytes.
std::uint64_t parse_size(const std::string& text) {
    std::size_t used = 0;
    double value = 0;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    const auto unit = size_units.find(text.substr(used));
    if (used == 0 || unit == size_units.end() || !(value * unit->second >= 1) ||
        value * unit->second > 0x1p60) {
        throw Error(
            ErrorKind::usage,
            "--max-memory " + text +
                ": expected a size such as 500M or 4G (of 1024), or 500MB or 4GB (of 1000)");
    }
    return static_cast<std::uint64_t>(value * unit->second);
}

}  // namespace

void add_max_memory_option(CLI::App& app, std::uint64_t& bytes, const std::string& purpose) {
    app.add_option_function<std::string>(
        "--max-memory", [&bytes](const std::string& text) { bytes = parse_size(text); },
        purpose + "\n(4G and 4GiB are 4 * 1024^3 bytes, 4GB is 4 * 1000^3; so are M, K and T)");
}

void keep_to_budget(const std::string& input, const ParseOptions& options) {
    // What threads to come reserve for their stacks, which is hardly used.
    constexpr std::uint64_t stack_bytes = std::uint64_t{8} << 20;
    const std::uint64_t threads = std::thread::hardware_concurrency() + 2;
    const ProcessMemory now = process_memory();
    rlimit limit{};
    if (!data_is_ours || now.reserved == 0 || ::getrlimit(RLIMIT_DATA, &limit) != 0) return;
    const std::uint64_t unused = now.reserved - std::min(now.reserved, now.own);
    const std::uint64_t bytes =
        std::max(Budget::least_bytes, Budget(input, bytes_of_input(input), options).bytes());
    const std::uint64_t own = bytes - std::min(bytes / 4, now.of_files);
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_cur, own + unused + threads * stack_bytes);
    ::setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace topple::cli
