// SPDX-License-Identifier: MIT
#include "objects/alternatives.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace topple {
namespace {

// A reading that is less likely is not told.
constexpr double least_alternative = 0.25;

using Parts = std::vector<std::int32_t>;

// A reading whose bodies are to be found.
struct Wanted {
    OtherReading reading;
    std::vector<Parts> bodies;  // one, or two
};

// found: those whose bodies are known without.
std::vector<Wanted> wanted(std::span<const graph::Joint> joints, const graph::KnownLinks& links,
                           const ObjectStage& stage, std::vector<OtherReading>& found) {
    const auto primitives = [&](ObjectId o) { return stage.objects[o].candidate.primitives; };
    std::vector<Wanted> out;
    const auto add = [&](ObjectId object, double probability, ObjectId with,
                         std::vector<Parts> bodies) {
        Wanted& w = out.emplace_back();
        w.reading.object = object;
        w.reading.probability = probability;
        w.reading.with = with;
        w.bodies = std::move(bodies);
    };
    for (std::size_t o = 0; o < stage.objects.size(); ++o) {
        const Body& object = stage.objects[o];
        if (object.grounded) continue;
        if (object.piece.probability >= least_alternative) {
            const ObjectId with = stage.object_of_primitive[object.piece.primitive];
            const Body& whole = stage.objects[with];
            if (static_cast<double>(object.candidate.body.voxels) <
                graph::least_part * static_cast<double>(whole.candidate.body.voxels)) {
                // Of which it would change little.
                found.push_back({o, object.piece.probability, with, whole});
            } else {
                Parts both = primitives(o);
                for (const std::int32_t p : primitives(with)) both.push_back(p);
                add(o, object.piece.probability, with, {std::move(both)});
            }
        }
        const double two = 1 - object.weakest.probability;
        if (two >= least_alternative)
            add(o, two, {}, graph::both_sides(joints, links, primitives(o), object.weakest));
    }
    std::ranges::stable_sort(out, std::ranges::greater{},
                             [](const Wanted& w) { return w.reading.probability; });
    return out;
}

// Takes those from the list of which no two want the same object.
std::vector<Wanted> next_round(std::vector<Wanted>& wanted, std::size_t objects) {
    std::vector<Wanted> round, later;
    std::vector<bool> taken(objects);
    for (Wanted& w : wanted) {
        // Two things are one object.
        const ObjectId a = w.reading.object, b = w.reading.with < 0 ? a : w.reading.with;
        const bool free = !taken[a.place()] && !taken[b.place()];
        if (free) taken[a.place()] = taken[b.place()] = true;
        (free ? round : later).push_back(std::move(w));
    }
    wanted = std::move(later);
    return round;
}

// Fills in the bodies of readings that share no object.
void find_bodies(const BodiesIf& bodies_if, std::vector<Wanted>& round) {
    std::vector<Parts> primitives;
    for (Wanted& w : round)
        for (Parts& body : w.bodies) primitives.push_back(std::move(body));
    std::vector<Body> bodies = bodies_if(std::move(primitives));
    auto first = bodies.begin();
    for (Wanted& w : round) {
        const auto end = first + static_cast<std::ptrdiff_t>(w.bodies.size());
        w.reading.body = std::move(*std::ranges::min_element(
            first, end, {}, [](const Body& body) { return body.instability.barrier_J; }));
        first = end;
    }
}

}  // namespace

std::vector<OtherReading> find_alternatives(const BodiesIf& bodies_if,
                                            std::span<const graph::Joint> joints,
                                            const graph::KnownLinks& links) {
    const ObjectStage& stage = bodies_if.stage;
    std::vector<OtherReading> out;
    std::vector<Wanted> left = wanted(joints, links, stage, out);
    while (!left.empty()) {
        std::vector<Wanted> round = next_round(left, stage.objects.size());
        find_bodies(bodies_if, round);
        for (Wanted& w : round) out.push_back(std::move(w.reading));
    }
    std::ranges::stable_sort(out, [](const OtherReading& a, const OtherReading& b) {
        return a.object != b.object ? a.object < b.object : a.probability > b.probability;
    });
    return out;
}

}  // namespace topple
