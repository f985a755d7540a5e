// SPDX-License-Identifier: MIT
#include <malloc.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "child/answer_head.h"
#include "child/confine.h"
#include "child/process.h"
#include "topple/version.h"

// The child's side of process.h.
namespace topple::child {
namespace {

// A sanitizer's shadow takes terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memory_is_limited = false;
#else
constexpr bool memory_is_limited = true;
#endif

void limit(decltype(RLIMIT_AS) what, std::uint64_t value) {
    const rlimit both{value, value};
    ::setrlimit(what, &both);
}

std::uint64_t address_space_bytes() {
    unsigned long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
        std::fclose(file);
    }
    // Without /proc: what it takes at most, as measured.
    constexpr std::uint64_t usual = std::uint64_t{512} << 20;
    return pages ? pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : usual;
}

void take_limits(std::uint64_t memory_bytes, std::uint64_t cpu_s) {
    limit(RLIMIT_CORE, 0);
    if (memory_bytes > 0 && memory_is_limited) {
        // One arena: others each reserve 64 MiB of address space.
        ::mallopt(M_ARENA_MAX, 1);
        limit(RLIMIT_AS, address_space_bytes() + memory_bytes);
        // The answer's memory is nobody's address space until it is mapped.
        limit(RLIMIT_FSIZE, memory_bytes);
        limit(RLIMIT_NOFILE, 64);
    }
    if (cpu_s > 0) {
        const rlimit cpu{cpu_s, cpu_s + 1};
        ::setrlimit(RLIMIT_CPU, &cpu);
    }
}

}  // namespace

std::vector<std::string> accept_task(int argc, char** argv) {
    struct stat status {};
    if (argc < 6 || std::string(argv[1]) != version || ::fstat(answer_descriptor, &status) != 0)
        return {};
    end_with(std::strtol(argv[2], nullptr, 10));
    const AnswerHead begun{begun_magic, 0};
    if (::pwrite(answer_descriptor, &begun, sizeof(begun), 0) != sizeof(begun)) std::_Exit(1);
    take_limits(std::strtoull(argv[3], nullptr, 10), std::strtoull(argv[4], nullptr, 10));
    return {argv + 5, argv + argc};
}

void end_of_answer(int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) return;
    const AnswerHead head{answer_magic, static_cast<std::uint64_t>(status.st_size)};
    if (::pwrite(descriptor, &head, sizeof(head), 0) != sizeof(head)) std::_Exit(1);
}

}  // namespace topple::child
