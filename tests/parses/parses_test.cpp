// SPDX-License-Identifier: MIT
#include "lab/temporary_folder.h"
#include "parses/c_calls.h"
#include "parses/try_parse.h"
#include "testing.h"

namespace topple::parses {
namespace {

// The first that fuzz_parses goes through, and what once broke something.
std::vector<std::uint64_t> seeds(std::uint64_t count, std::vector<std::uint64_t> more) {
    for (std::uint64_t seed = 0; seed < count; ++seed) more.push_back(seed);
    return more;
}

TEST(Parses, random_scenes_are_parsed_soundly_or_refused) {
    const auto device = device::open_device("native", 1);
    const scenes::TemporaryFolder folder("topple_parses");
    for (const std::uint64_t seed : seeds(30, {10816, 10002167}))
        EXPECT_EQ(try_parse(seed, device, seed % 5 ? "" : folder.path() / "out"), "")
            << "seed " << seed;
    for (const std::uint64_t seed : seeds(60, {}))
        EXPECT_EQ(try_parse(seed, device, seed % 20 ? "" : folder.path() / "out", true), "")
            << "small, seed " << seed;
}

TEST(Parses, random_calls_of_the_interface_for_C_return_or_say_why) {
    for (const std::uint64_t seed : seeds(15, {1246})) EXPECT_EQ(try_calls(seed), "") << seed;
}

}  // namespace
}  // namespace topple::parses
