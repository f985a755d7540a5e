// SPDX-License-Identifier: MIT
#include "safety/action.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace topple::safety {
namespace {

class Action : public ::testing::Test {
  protected:
    Action() {
        scene_.events["tolerable_J"] = 1;
        o_.barrier_J = 5;
        o_.barrier_error_J = 1;
        o_.release_J = 123;
        o_.fall_chance = {{"human", 0}, {"earthquake", 0.02}};
        o_.unsafety_category = "medium";
        o_.advice.sentence = "Fasten it to the wall.";
    }
    std::string text() const { return action_text(scene_, o_); }

    Scene scene_;
    Object o_;
};

TEST_F(Action, is_the_advice_where_there_is_need_to_act) {
    EXPECT_EQ(text(), "Fasten it to the wall.");
    o_.advice.sentence.clear();
    EXPECT_EQ(text(),
              "Its risk is below the 1 J per event that this run tolerates: if it must not fall "
              "all the same, fasten it.");
}

TEST_F(Action, is_none_where_nothing_happens) {
    o_.unsafety_category = "none";
    EXPECT_EQ(text(),
              "No need to act. To bring its risk below the 1 J per event that this run tolerates "
              "all the same: fasten it to the wall.");
    scene_.events.clear();
    EXPECT_EQ(text(),
              "No need to act. To bring its risk below what is tolerated all the same: fasten it "
              "to the wall.");
    o_.advice.sentence.clear();
    EXPECT_EQ(text(), "No need to act.");
    o_.barrier_J = 0.5;  // within its error: a category of none says nothing
    o_.advice.sentence = "Look whether it stands firm.";
    EXPECT_EQ(text(), o_.advice.sentence);
}

// What this run's events leave standing may fall in others.
TEST_F(Action, is_to_see_that_what_is_tall_and_heavy_is_fastened) {
    o_.unsafety_category = "none";
    o_.fall_chance = {{"earthquake", 0}};
    o_.advice.sentence.clear();
    o_.size_m = {0.4, 2.7, 1.96};
    EXPECT_EQ(text(),
              "Nothing in this run upsets it. It is tall and heavy: see that it is fastened.");
    o_.size_m[2] = 1.1;
    EXPECT_EQ(text(), "No need to act.");
    o_.size_m = {2.4, 2.7, 1.96};
    EXPECT_EQ(text(), "No need to act.") << "it is deeper than high";
    o_.size_m[0] = 0.4;
    o_.release_J = 78;
    EXPECT_EQ(text(), "No need to act.");
    o_.instability = {{20, 595}};
    EXPECT_THAT(text(), testing::HasSubstr("tall and heavy"));
}

TEST_F(Action, is_to_look_where_only_its_errors_upset_it) {
    o_.unsafety_certain = false;
    EXPECT_FALSE(upset_by_nothing(o_));
    EXPECT_EQ(text(), "Fasten it to the wall.");
    o_.fall_chance["earthquake"] = 0.00009;
    EXPECT_TRUE(upset_by_nothing(o_));
    EXPECT_EQ(text(),
              "Nothing upsets it as measured; if its foot is one error smaller, it falls with up "
              "to 123 J: check that it stands firm.");
    // Harder pushes than the easiest may free more.
    o_.instability = {{2, 0}, {9, 229}};
    EXPECT_THAT(text(), testing::HasSubstr("with up to 229 J"));
}

TEST_F(Action, is_to_see_what_was_not_seen) {
    o_.seen_enough = false;
    o_.unsafety_category.clear();
    o_.unsafety_certain = false;
    o_.advice.sentence = "See what holds it.";
    EXPECT_EQ(text(), "See what holds it.");
}

}  // namespace
}  // namespace topple::safety
