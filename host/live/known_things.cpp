// SPDX-License-Identifier: MIT
#include "live/known_things.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/vectors.h"

namespace topple::live {
namespace {

constexpr std::size_t none = ~std::size_t{0};
// Of the pixels that show either of two, those that must show both.
constexpr double least_shared = 0.1;
// How much the size, along each axis from the shortest, and the weight of what moved may differ.
constexpr double alike_size = 0.15, alike_m = 0.02, alike_mass = 0.3;

struct Match {
    double alike;  // the more the better
    std::size_t before, now;
};

// Best first, then by number, so that the order is the same everywhere; each once.
template <class Use>
void use_best(std::vector<Match> matches, std::vector<std::size_t>& before_of,
              std::vector<bool>& taken, const Use& use) {
    std::ranges::sort(matches, [](const Match& a, const Match& b) {
        return std::tuple(-a.alike, a.before, a.now) < std::tuple(-b.alike, b.before, b.now);
    });
    for (const Match& match : matches) {
        if (taken[match.before] || before_of[match.now] != none) continue;
        before_of[match.now] = match.before;
        taken[match.before] = true;
        use(match);
    }
}

std::vector<Match> by_pixels(const ShownObjects& before, const ShownObjects& now) {
    std::map<std::pair<std::int32_t, std::int32_t>, double> both;
    std::map<std::int32_t, double> of_before, of_now;
    for (const auto& [frame, shows] : now) {
        const auto earlier = before.find(frame);
        if (earlier == before.end()) continue;
        for (std::size_t n = 0; n < shows.size(); ++n) {
            const std::int32_t a = earlier->second[n], b = shows[n];
            if (a >= 0) ++of_before[a];
            if (b >= 0) ++of_now[b];
            if (a >= 0 && b >= 0) ++both[{a, b}];
        }
    }
    std::vector<Match> out;
    for (const auto& [pair, count] : both) {
        const auto [a, b] = pair;
        const double shared = count / (of_before[a] + of_now[b] - count);
        if (shared >= least_shared)
            out.push_back({shared, static_cast<std::size_t>(a), static_cast<std::size_t>(b)});
    }
    return out;
}

bool alike(const Vec3& size, const Vec3& other) {
    Vec3 a = size, b = other;
    std::ranges::sort(a);
    std::ranges::sort(b);
    for (std::size_t n = 0; n < 3; ++n)
        if (std::abs(a[n] - b[n]) > alike_m + alike_size * std::max(a[n], b[n])) return false;
    return true;
}

}  // namespace

std::vector<Thing> KnownThings::name(const Scene& scene, const ShownObjects& shown) {
    const std::size_t count = scene.objects.size();
    std::vector<std::size_t> before_of(count, none);
    std::vector<bool> taken(before_.size(), false);
    std::vector<Thing> out(count);
    // The building is the building, however little of it was seen.
    for (std::size_t n = 0; n < count; ++n) {
        out[n].object = static_cast<std::int32_t>(n);
        if (!scene.objects[n].grounded) continue;
        const auto building = std::ranges::find(before_, ThingId{0}, &Before::id);
        if (building == before_.end()) continue;
        before_of[n] = static_cast<std::size_t>(building - before_.begin());
        taken[before_of[n]] = true;
        break;
    }
    use_best(by_pixels(shown_before_, shown), before_of, taken, [](const Match&) {});
    std::vector<Match> elsewhere;
    for (std::size_t b = 0; b < before_.size(); ++b) {
        for (std::size_t n = 0; n < count; ++n) {
            const Object& object = scene.objects[n];
            if (taken[b] || before_of[n] != none || object.grounded) continue;
            const double most_kg = std::max(object.mass_kg, before_[b].mass_kg);
            if (!alike(object.size_m, before_[b].size_m) ||
                std::abs(object.mass_kg - before_[b].mass_kg) > alike_mass * most_kg)
                continue;
            elsewhere.push_back({-length(minus(object.box_middle_m, before_[b].middle_m)), b, n});
        }
    }
    use_best(std::move(elsewhere), before_of, taken, [&](const Match& match) {
        out[match.now].change = Change::moved;
        out[match.now].moved_m = -match.alike;
    });

    std::vector<Before> now(count);
    bool building = std::ranges::any_of(before_, [](const Before& b) { return b.id == 0; });
    for (std::size_t n = 0; n < count; ++n) {
        const Object& object = scene.objects[n];
        if (before_of[n] != none) {
            out[n].id = before_[before_of[n]].id;
        } else {
            const bool first =
                object.grounded && !std::exchange(building, building || object.grounded);
            out[n].id = first ? 0 : next_++;
            out[n].change = Change::appeared;
        }
        now[n] = {out[n].id, object.box_middle_m,     object.size_m, object.mass_kg,
                  {},        object.unsafety_category};
    }
    for (const Support& support : scene.supports)
        now[static_cast<std::size_t>(support.supported)].stands_on.push_back(
            out[static_cast<std::size_t>(support.supporter)].id);
    for (std::size_t n = 0; n < count; ++n) {
        std::ranges::sort(now[n].stands_on);
        if (out[n].change != Change::none || before_of[n] == none) continue;
        const Before& was = before_[before_of[n]];
        if (was.category != now[n].category || was.stands_on != now[n].stands_on)
            out[n].change = Change::changed;
    }
    for (std::size_t b = 0; b < before_.size(); ++b)
        if (!taken[b]) out.push_back({.id = before_[b].id, .change = Change::vanished});
    before_ = std::move(now);
    shown_before_ = shown;
    return out;
}

}  // namespace topple::live
