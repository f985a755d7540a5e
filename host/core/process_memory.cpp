// SPDX-License-Identifier: MIT
#include "core/process_memory.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <string>

namespace topple {
namespace {

constexpr std::uint64_t unlimited = UINT64_MAX;

std::uint64_t less(std::uint64_t a, std::uint64_t b) {
    return a > b ? a - b : 0;
}

// Pages, as /proc/self/statm has them: all, in memory, those of files, code, none, data and stack.
std::array<std::uint64_t, 6> pages() noexcept {
    std::array<std::uint64_t, 6> out{};
    std::array<char, 256> text{};
    const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (file < 0) return out;
    const auto got = ::read(file, text.data(), text.size() - 1);
    ::close(file);
    char* at = text.data();
    for (std::uint64_t& value : out)
        if (got > 0) value = std::strtoull(at, &at, 10);
    return out;
}

std::uint64_t page_bytes() {
    return static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

// The first number of a file; `none` where there is none, as where it says "max".
std::uint64_t number_in(const std::string& file, std::uint64_t none) {
    std::ifstream in(file);
    std::uint64_t value = 0;
    return in >> value ? value : none;
}

// The sum of the lines "NAME value" of a file.
template <std::size_t names>
std::uint64_t sum_in(const std::string& file, const std::array<const char*, names>& of) {
    std::ifstream in(file);
    std::uint64_t sum = 0, value = 0;
    std::string name, rest;
    while (in >> name >> value) {
        if (std::ranges::find(of, name) != of.end()) sum += value;
        std::getline(in, rest);
    }
    return sum;
}

// The files in which a version of control groups says what one may take and takes.
struct GroupFiles {
    const char *root, *limit, *used;
    std::array<const char*, 2> cached;  // of memory.stat: is given up where it is needed
};
constexpr GroupFiles version_2{
    "/sys/fs/cgroup", "memory.max", "memory.current", {"active_file", "inactive_file"}};
constexpr GroupFiles version_1{"/sys/fs/cgroup/memory",
                               "memory.limit_in_bytes",
                               "memory.usage_in_bytes",
                               {"total_active_file", "total_inactive_file"}};

// The least that a group and those around it leave. In a container the group's own path is not
// there, and its files lie at the root. Paths are strings: where memory ends, copies of
// std::filesystem::path end the program (libstdc++ 12).
std::uint64_t left_of_group(const GroupFiles& files, std::string group) {
    std::uint64_t left = unlimited;
    for (;;) {
        const std::string folder = files.root + group + '/';
        const std::uint64_t limit = number_in(folder + files.limit, unlimited);
        if (limit != unlimited) {
            const std::uint64_t used = number_in(folder + files.used, 0);
            const std::uint64_t cached = sum_in(folder + "memory.stat", files.cached);
            left = std::min(left, less(limit, less(used, cached)));
        }
        if (group.empty()) return left;
        const auto slash = group.rfind('/');
        group.erase(slash == std::string::npos ? 0 : slash);
    }
}

std::uint64_t left_of_groups() {
    std::ifstream in("/proc/self/cgroup");  // "4:memory:/path", or "0::/path"
    std::uint64_t left = unlimited;
    std::string line;
    while (std::getline(in, line)) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string kinds = line.substr(first, second - first);
        const bool of_2 = line.starts_with("0::");
        if (!of_2 && kinds.find("memory") == std::string::npos) continue;
        left = std::min(left, left_of_group(of_2 ? version_2 : version_1, line.substr(second + 1)));
    }
    return left;
}

std::uint64_t left_of_limit(decltype(RLIMIT_AS) what, std::uint64_t used) {
    rlimit limit{};
    if (::getrlimit(what, &limit) != 0) return unlimited;
    // That of data is one that the program sets itself below the one it was given.
    const rlim_t most = what == RLIMIT_DATA ? limit.rlim_max : limit.rlim_cur;
    return most == RLIM_INFINITY ? unlimited : less(most, used);
}

}  // namespace

ProcessMemory process_memory() noexcept {
    const std::array<std::uint64_t, 6> n = pages();
    const std::uint64_t page = page_bytes();
    return {page * less(n[1], n[2]), page * n[2], page * n[5]};
}

std::uint64_t memory_left() {
    constexpr std::uint64_t kibibyte = 1024;
    const std::uint64_t available =
        sum_in("/proc/meminfo", std::array<const char*, 1>{"MemAvailable:"});
    std::uint64_t left = available == 0 ? unlimited : kibibyte * available;
    left = std::min(left, left_of_groups());
    const std::array<std::uint64_t, 6> n = pages();
    left = std::min(left, left_of_limit(RLIMIT_AS, page_bytes() * n[0]));
    return std::min(left, left_of_limit(RLIMIT_DATA, page_bytes() * n[5]));
}

}  // namespace topple
