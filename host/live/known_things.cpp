// SPDX-License-Identifier: MIT
#include "live/known_things.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/alike.h"
#include "core/vectors.h"

namespace topple::live {
namespace {

constexpr std::size_t none = ~std::size_t{0};
// Of the pixels that show either of two, those that must show both.
constexpr double least_shared = 0.1;
// Of the pixels that show a thing, and of which is told, those that must be seen through where it
// came or has gone; where it is left out, as it is no longer there; where it moved aside. And of
// all of its pixels.
constexpr double most_of_it = 0.5, much_of_it = 0.3, some_of_it = 0.1, least_told = 0.1;
// Centres are found to so much.
constexpr double aside_m = 0.05;
// By what share of the longer one sides of one thing may differ, and its weights of the heavier
// one: of what moved; and of what is no longer there and stands so near, which is another size to
// each pass, as it saw other sides.
struct Likeness {
    double sides, mass;
};
constexpr Likeness like{alike_sides, 0.3}, roughly{0.3, 0.75};
constexpr double beside_m = 0.5;

struct Match {
    double alike;  // the more the better
    std::size_t before, now;
};

// Best first, then by number, so that the order is the same everywhere; each once.
void use_best(std::vector<Match> matches, std::vector<std::size_t>& before_of,
              std::vector<bool>& taken) {
    std::ranges::sort(matches, [](const Match& a, const Match& b) {
        return std::tuple(-a.alike, a.before, a.now) < std::tuple(-b.alike, b.before, b.now);
    });
    for (const Match& match : matches) {
        if (taken[match.before] || before_of[match.now] != none) continue;
        before_of[match.now] = match.before;
        taken[match.before] = true;
    }
}

std::vector<Match> by_pixels(const Showed& before, const ShownObjects& now) {
    std::map<std::pair<std::int32_t, std::int32_t>, double> both;
    std::map<std::int32_t, double> of_before, of_now;
    for (const auto& [frame, shows] : now) {
        const auto earlier = before.find(frame);
        // A file may say anything.
        if (earlier == before.end() || earlier->second.size() != shows.object.size()) continue;
        for (std::size_t n = 0; n < shows.object.size(); ++n) {
            const std::int32_t a = earlier->second[n], b = shows.object[n];
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

// Of the pixels that show each of so many objects, and of which some frames tell, the share that
// these see through; 0 where they tell of too few. showed: by pixel, of some of the frames.
std::vector<double> shares(std::size_t objects, const Showed& showed, const ShownObjects& shown,
                           std::vector<Says> Shown::*frames) {
    std::vector<double> all(objects), told(objects), through(objects);
    for (const auto& [frame, pixels] : shown) {
        const auto of = showed.find(frame);
        if (of == showed.end() || (pixels.*frames).size() != of->second.size()) continue;
        for (std::size_t n = 0; n < of->second.size(); ++n) {
            if (of->second[n] < 0) continue;
            const auto o = static_cast<std::size_t>(of->second[n]);
            const Says says = (pixels.*frames)[n];
            ++all[o];
            told[o] += says != Says::nothing;
            through[o] += says == Says::through;
        }
    }
    for (std::size_t o = 0; o < objects; ++o)
        through[o] = through[o] >= least_told * all[o] ? through[o] / std::max(1.0, told[o]) : 0;
    return through;
}

}  // namespace

std::vector<ThingPixels> KnownThings::pixels(
    const std::function<std::vector<std::uint32_t>(FrameId)>& pixels_of) const {
    std::vector<ThingPixels> out(before_.size());
    for (const auto& [frame, objects] : showed_) {
        const std::vector<std::uint32_t> pixels = pixels_of(frame);
        if (pixels.size() != objects.size()) continue;
        for (std::size_t n = 0; n < objects.size(); ++n) {
            const std::int32_t o = objects[n];
            if (o >= 0 && before_[static_cast<std::size_t>(o)].id != 0)
                out[static_cast<std::size_t>(o)][frame].push_back(pixels[n]);
        }
    }
    return out;
}

std::vector<Thing> KnownThings::name(const Scene& scene, const ShownObjects& shown,
                                     const std::vector<bool>& no_longer) {
    const std::size_t count = scene.objects.size();
    std::vector<std::size_t> before_of(count, none);
    std::vector<bool> taken(before_.size(), false);
    std::vector<Thing> out(count);
    // The building is the building, however little of it was seen.
    const auto building = std::ranges::find(before_, ThingId{0}, &Before::id);
    const auto ground = std::ranges::find(scene.objects, true, &Object::grounded);
    if (building != before_.end() && ground != scene.objects.end()) {
        const auto was = static_cast<std::size_t>(building - before_.begin());
        before_of[static_cast<std::size_t>(ground - scene.objects.begin())] = was;
        taken[was] = true;
    }
    const auto moved_m = [&](std::size_t b, std::size_t n) {
        return length(minus(scene.objects[n].box_middle_m, before_[b].middle_m));
    };
    const auto is_alike = [&](std::size_t b, std::size_t n, const Likeness& how) {
        const Object& object = scene.objects[n];
        return alike_sizes(object.size_m, before_[b].size_m, how.sides) &&
               std::abs(object.mass_kg - before_[b].mass_kg) <=
                   how.mass * std::max(object.mass_kg, before_[b].mass_kg);
    };
    const auto left = [&](std::size_t b) { return b < no_longer.size() && no_longer[b]; };
    std::vector<Match> shared = by_pixels(showed_, shown);
    std::erase_if(
        shared, [&](const Match& m) { return left(m.before) && !is_alike(m.before, m.now, like); });
    use_best(std::move(shared), before_of, taken);
    // Of what is left those that are like each other, the nearest first.
    const auto match_left = [&](const Likeness& how, const auto& may_be) {
        std::vector<Match> pairs;
        for (std::size_t b = 0; b < before_.size(); ++b)
            for (std::size_t n = 0; n < count; ++n)
                if (!taken[b] && before_of[n] == none && may_be(b, n) && is_alike(b, n, how))
                    pairs.push_back({-moved_m(b, n), b, n});
        use_best(std::move(pairs), before_of, taken);
    };
    // What no pixel shows, by its place.
    match_left(like, [&](std::size_t b, std::size_t n) { return moved_m(b, n) < aside_m; });
    Showed shows;
    for (const auto& [frame, pixels] : shown) shows[frame] = pixels.object;
    const std::vector<double> gone = shares(before_.size(), showed_, shown, &Shown::later);
    const auto has_gone = [&](std::size_t b) {
        return gone[b] >= (left(b) ? much_of_it : most_of_it);
    };
    const std::vector<double> came = shares(count, shows, shown, &Shown::earlier);

    const std::vector<bool> was_taken = taken;
    match_left(roughly,
               [&](std::size_t b, std::size_t n) { return left(b) && moved_m(b, n) < beside_m; });
    match_left(like,
               [&](std::size_t b, std::size_t n) { return has_gone(b) && came[n] >= most_of_it; });

    std::vector<Before> now(count);
    bool named = building != before_.end();  // a building, with the number 0
    for (std::size_t n = 0; n < count; ++n) {
        const Object& object = scene.objects[n];
        Thing& thing = out[n];
        thing.object = static_cast<std::int32_t>(n);
        const std::size_t b = before_of[n];
        if (b == none) {
            thing.id = object.grounded && !std::exchange(named, true) ? 0 : next_++;
            thing.change = came[n] >= most_of_it ? Change::came : Change::found;
        } else {
            thing.id = before_[b].id;
            const bool aside =
                gone[b] >= some_of_it && moved_m(b, n) >= aside_m && is_alike(b, n, like);
            if (!was_taken[b] || (thing.id != 0 && aside)) {
                thing.change = Change::moved;
                thing.moved_m = moved_m(b, n);
            }
        }
        now[n] = {thing.id, object.box_middle_m,     object.size_m, object.mass_kg,
                  {},       object.unsafety_category};
    }
    for (const Support& support : scene.supports)
        now[static_cast<std::size_t>(support.supported)].stands_on.push_back(
            out[static_cast<std::size_t>(support.supporter)].id);
    for (std::size_t n = 0; n < count; ++n) {
        std::ranges::sort(now[n].stands_on);
        if (out[n].change != Change::none) continue;
        const Before& was = before_[before_of[n]];
        if (was.category != now[n].category || was.stands_on != now[n].stands_on)
            out[n].change = Change::changed;
    }
    for (std::size_t b = 0; b < before_.size(); ++b)
        if (!taken[b])
            out.push_back(
                {.id = before_[b].id, .change = has_gone(b) ? Change::gone : Change::lost});
    before_ = std::move(now);
    showed_ = std::move(shows);
    return out;
}

}  // namespace topple::live
