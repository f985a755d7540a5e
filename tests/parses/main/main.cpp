// SPDX-License-Identifier: MIT
// fuzz_parses parses|small|calls FIRST SECONDS: parses random scenes (`small`: smaller ones) from a
// seed on for that long, or calls the interface for C; prints what is wrong with any, and at the
// end how many there were. Exit code 1 where something was.
#include <chrono>

#include "lab/temporary_folder.h"
#include "parses/c_calls.h"
#include "parses/try_parse.h"

int main(int argc, char** argv) {
    const std::string kind = argc == 4 ? argv[1] : "";
    if (kind != "parses" && kind != "small" && kind != "calls") {
        std::fprintf(stderr, "usage: fuzz_parses parses|small|calls FIRST SECONDS\n");
        return 2;
    }
    const auto device = topple::device::open_device("native", 1);
    const topple::scenes::TemporaryFolder folder("topple_parses");
    const std::uint64_t first = std::strtoull(argv[2], nullptr, 10);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoll(argv[3]));
    std::uint64_t seed = first, wrong = 0;
    for (; std::chrono::steady_clock::now() < end; ++seed) {
        // A crash leaves the seed in the last line.
        if (seed % 1000 == 0) {
            std::printf("%llu\n", static_cast<unsigned long long>(seed));
            std::fflush(stdout);
        }
        const std::string what =
            kind == "calls"
                ? topple::parses::try_calls(seed)
                : topple::parses::try_parse(seed, device, seed % 50 ? "" : folder.path() / "out",
                                            kind == "small");
        if (what.empty()) continue;
        ++wrong;
        std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), what.c_str());
        std::fflush(stdout);
    }
    std::printf("%llu %s, %llu wrong\n", static_cast<unsigned long long>(seed - first),
                kind == "calls" ? "times 40 calls" : "parses",
                static_cast<unsigned long long>(wrong));
    return wrong > 0;
}
