// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "host/io/files.h"
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "topple/parse.h"

// Options that make no sense are told before anything is parsed, and doubtful ones with the result.
namespace topple::test {
namespace {

template <class Call>
std::string refusal_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
    return "taken";
}

// `began`: what would show that a stage had begun.
template <class Input>
std::string refusal_before(const Input& input, ParseOptions options) {
    bool began = false;
    options.progress = [&](const std::string&, double) { began = true; };
    const std::string refused = refusal_of([&] { parse(input, options); });
    EXPECT_FALSE(began) << refused;
    return refused;
}

TEST(Options, AMotionThatIsNullIsRefused) {
    ParseOptions options;
    options.motions = {std::make_shared<BodyMotion>(), nullptr};
    EXPECT_EQ(refusal_before(SmallRoom::scattered().cloud, options),
              "motions: number 1 is null; give what read_motion() returns, or leave it out");
}

TEST(Options, ADisturbanceThatIsGivenTwiceIsRefused) {
    ParseOptions options;
    options.disturbances = {"human", "wind", "human"};
    EXPECT_EQ(refusal_before(SmallRoom::scattered().cloud, options),
              "--disturbance: human is given twice; name each once");
    EXPECT_EQ(refusal_of([&] { check_options(options); }),
              "--disturbance: human is given twice; name each once");
}

}  // namespace
}  // namespace topple::test
