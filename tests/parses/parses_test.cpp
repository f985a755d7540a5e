// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "parses/c_calls.h"
#include "parses/try_parse.h"
#include "scenes/temporary_folder.h"

namespace topple::parses {
namespace {

// The first of the scenes that fuzz_parses goes through, and those that once broke something.
TEST(Parses, random_scenes_are_parsed_soundly_or_refused) {
    const auto device = device::open_device("native", 1);
    const scenes::TemporaryFolder folder("topple_parses");
    for (std::uint64_t seed = 0; seed < 60; ++seed)
        EXPECT_EQ(try_parse(seed, device, seed % 5 ? "" : folder.path() / "out"), "")
            << "seed " << seed;
}

TEST(Parses, random_calls_of_the_interface_for_C_return_or_say_why) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) EXPECT_EQ(try_calls(seed), "") << seed;
}

}  // namespace
}  // namespace topple::parses
