// SPDX-License-Identifier: MIT
#include "safety/action.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"
#include "safety/largest_risk.h"
#include "safety/unsafety_category.h"

namespace topple::safety {
namespace {

bool may_fall_hard(const Object& o) {
    return !o.unsafety_category.empty() && o.unsafety_category != "none";
}

// "the 1 J per event that this run tolerates"
std::string tolerated_text(const Scene& scene) {
    const auto at = scene.events.find("tolerable_J");
    if (at == scene.events.end()) return "what is tolerated";
    return "the " + io::short_number(at->second) + " J per event that this run tolerates";
}

// The most that any way out of its place sets free, which its category reckons with where a smaller
// foot makes it fall though nothing upsets it as measured.
double most_released_J(const Object& o) {
    double most = released_J(o);
    for (const InstabilityStep& step : o.instability)
        if (std::isfinite(step.S_J)) most = std::max(most, step.S_J);
    return most;
}

// What kills if it comes down all the same, as in an event stronger than this run's: higher than a
// child and than it is deep, and with enough to free.
bool tall_and_heavy(const Object& o) {
    constexpr double tall_m = 1.2;  // set by hand
    return o.size_m[2] > std::max(tall_m, std::min(o.size_m[0], o.size_m[1])) &&
           most_released_J(o) >= deadly_J;
}

}  // namespace

bool upset_by_nothing(const Object& o) {
    constexpr double hardly_ever = 1e-4;
    return std::ranges::none_of(o.fall_chance,
                                [](const auto& chance) { return chance.second >= hardly_ever; });
}

std::string action_text(const Scene& scene, const Object& o) {
    const bool doubtful = barrier_within_error(o);
    const std::string& advice = o.advice.sentence;
    if (!doubtful && o.seen_enough && may_fall_hard(o) && !o.unsafety_certain &&
        upset_by_nothing(o))
        return "Nothing upsets it as measured; if its foot is one error smaller, it falls with up "
               "to " +
               io::two_digits(most_released_J(o)) + " J: check that it stands firm.";
    if (o.unsafety_category != "none" || doubtful) {
        if (!advice.empty() || o.unsafety_category.empty()) return advice;
        return "Its risk is below " + tolerated_text(scene) +
               ": if it must not fall all the same, fasten it.";
    }
    if (tall_and_heavy(o)) {
        const std::string upset = upset_by_nothing(o) ? "Nothing" : "Hardly anything";
        return upset + " in this run upsets it. It is tall and heavy: see that it is fastened.";
    }
    if (advice.empty()) return "No need to act.";
    return "No need to act. To bring its risk below " + tolerated_text(scene) +
           " all the same: " + io::lower_case(advice.substr(0, 1)) + advice.substr(1);
}

}  // namespace topple::safety
