// SPDX-License-Identifier: MIT
#include "cli/keep_to_budget.h"

#include <sys/resource.h>

#include <algorithm>
#include <thread>

#include "core/process_memory.h"
#include "points/budget.h"

namespace topple::cli {
namespace {

// Whether what the system counts as data is the program's alone: sanitizers have much of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool data_is_ours = false;
#else
constexpr bool data_is_ours = true;
#endif

}  // namespace

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
