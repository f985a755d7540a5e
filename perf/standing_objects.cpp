// SPDX-License-Identifier: MIT
#include "perf/standing_objects.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "graph/contact_graph.h"
#include "graph/stable_objects.h"
#include "lab/random.h"
#include "physics/assess.h"
#include "physics/drop.h"

namespace topple::simulation {
namespace {

using Part = std::vector<Cell>;

constexpr double cell_m = 0.02;
// Of a table, half a side and the level of its top; half a side of the floor around and under it,
// and of one on which nothing comes to an end.
constexpr std::int32_t half_table = 22, table_top = 25, half_floor = 40, half_wide_floor = 120;

Part block(const Cell& low, const Cell& size) {
    Part cells;
    for (std::int32_t i = 0; i < size[0]; ++i) {
        for (std::int32_t j = 0; j < size[1]; ++j) {
            for (std::int32_t k = 0; k < size[2]; ++k)
                cells.push_back({low[0] + i, low[1] + j, low[2] + k});
        }
    }
    return cells;
}

Part disc(std::int32_t radius, std::int32_t low, std::int32_t height) {
    Part cells = block({-radius, -radius, low}, {2 * radius, 2 * radius, height});
    std::erase_if(cells, [&](const Cell& c) {
        const int x = 2 * c[0] + 1, y = 2 * c[1] + 1;
        return x * x + y * y > 4 * radius * radius;
    });
    return cells;
}

// What legs of one size at the corners of a rectangle carry, and the legs.
std::vector<Part> on_legs(std::int32_t width, std::int32_t depth, std::int32_t legs) {
    std::vector<Part> parts{block({0, 0, legs}, {width, depth, 2})};
    for (const std::int32_t i : {0, width - 2}) {
        for (const std::int32_t j : {0, depth - 2}) parts.push_back(block({i, j, 0}, {2, 2, legs}));
    }
    return parts;
}

struct Shape {
    const char* name;
    std::vector<Part> parts;
    bool on_floor = false, over_edge = false;
};

Shape random_shape(std::size_t kind, scenes::Random& random) {
    const auto r = [&](int low, int high) { return std::int32_t{random.integer(low, high)}; };
    switch (kind % 12) {
        case 0:
            return {"box", {block({0, 0, 0}, {r(4, 8), r(4, 8), r(12, 25)})}};
        case 1:
            return {"flat box", {block({0, 0, 0}, {r(8, 16), r(8, 16), r(2, 5)})}};
        case 2:
            return {"column", {block({0, 0, 0}, {r(3, 5), r(3, 5), r(20, 35)})}};
        case 3: {
            const std::int32_t deep = r(5, 8);
            return {"L",
                    {block({0, 0, 0}, {r(8, 14), deep, 3}), block({0, 0, 3}, {3, deep, r(8, 18)})}};
        }
        case 4:
            return {"table", on_legs(r(20, 35), r(16, 28), r(20, 30)), true};
        case 5: {
            Shape chair{"chair", on_legs(r(16, 20), 18, r(16, 22)), true};
            const Cell seat = chair.parts[0].front();
            chair.parts.push_back(block({0, 0, seat[2] + 2}, {2, 18, r(14, 22)}));
            return chair;
        }
        case 6: {
            const std::int32_t pole = r(14, 22);
            return {"lamp",
                    {disc(r(4, 7), 0, 2), block({-1, -1, 2}, {2, 2, pole}),
                     disc(r(4, 6), 2 + pole, r(4, 7))}};
        }
        case 7: {
            const std::int32_t high = r(14, 20), side = r(5, 8);
            return {"arm to a side",
                    {block({0, 0, 0}, {side, side, high}),
                     block({side, 0, high - 4}, {r(3, 7), side, 4})}};
        }
        case 8:
            return {
                "over the edge", {block({0, 0, 0}, {r(10, 16), r(5, 10), r(3, 10)})}, false, true};
        case 9: {
            const std::int32_t foot = r(10, 16);
            return {"steps",
                    {block({0, 0, 0}, {foot, foot, 4}), block({0, 0, 4}, {foot * 2 / 3, foot, 4}),
                     block({0, 0, 8}, {foot / 3, foot, r(4, 8)})}};
        }
        case 10:
            return {"cylinder", {disc(r(3, 5), 0, r(8, 16))}};
        default: {
            const std::int32_t wide = r(10, 18), deep = r(3, 6), high = r(8, 16);
            return {"arch",
                    {block({0, 0, 0}, {3, deep, high}), block({wide - 3, 0, 0}, {3, deep, high}),
                     block({0, 0, high}, {wide, deep, 3})}};
        }
    }
}

template <typename Move>
void move(std::vector<Part>& parts, const Move& to) {
    for (Part& part : parts) {
        for (Cell& c : part) c = to(c);
    }
}

std::pair<Cell, Cell> bounds(const std::vector<Part>& parts) {
    std::pair<Cell, Cell> box{parts[0][0], parts[0][0]};
    for (const Part& part : parts) {
        for (const Cell& c : part) {
            for (std::size_t a = 0; a < 3; ++a) {
                box.first[a] = std::min(box.first[a], c[a]);
                box.second[a] = std::max(box.second[a], c[a]);
            }
        }
    }
    return box;
}

}  // namespace

std::vector<StandingObject> standing_objects(std::uint64_t seed, std::size_t count) {
    scenes::Random random(seed);
    std::vector<StandingObject> objects;
    for (std::size_t n = 0; n < count; ++n) {
        Shape shape = random_shape(n, random);
        for (int turns = random.integer(0, 3); turns > 0; --turns)
            move(shape.parts, [](const Cell& c) { return Cell{-1 - c[1], c[0], c[2]}; });
        // Side by side, each on its own piece of floor.
        const std::int32_t floor = shape.on_floor ? half_wide_floor : half_floor;
        const Cell origin{static_cast<std::int32_t>(n) * (2 * half_wide_floor + 2), 0, 0};
        const auto [low, high] = bounds(shape.parts);
        Cell to{0, 0, shape.on_floor ? 0 : table_top};
        for (std::size_t a = 0; a < 2; ++a) {
            const std::int32_t side = high[a] - low[a] + 1;
            const std::int32_t room = half_table - 1;
            to[a] = random.integer(-room, room - side) - low[a];
            if (shape.over_edge && a == 0)
                to[a] = half_table - side + random.integer(1, side * 2 / 5) - low[a];
            to[a] += origin[a];
        }
        move(shape.parts, [&](const Cell& c) {
            return Cell{c[0] + to[0], c[1] + to[1], c[2] + to[2]};
        });
        StandingObject object{shape.name, {cell_m, 700, std::move(shape.parts)}, {}};
        object.fixed = block({origin[0] - floor, origin[1] - floor, -1}, {2 * floor, 2 * floor, 1});
        if (!shape.on_floor) {
            const Part top = block({origin[0] - half_table, origin[1] - half_table, table_top - 2},
                                   {2 * half_table, 2 * half_table, 2});
            object.fixed.insert(object.fixed.end(), top.begin(), top.end());
        }
        objects.push_back(std::move(object));
    }
    return objects;
}

StandingScene::StandingScene(device::Device& device, const std::vector<StandingObject>& objects)
    : device_(device), object_of_primitive_{0} {
    std::vector<std::pair<Cell, std::int32_t>> all;  // primitive 0: what is fixed
    std::vector<std::vector<std::int32_t>> members;
    std::vector<double> density{0};
    for (const StandingObject& object : objects) {
        members.emplace_back();
        for (const Cell& c : object.fixed) all.emplace_back(c, 0);
        for (const Part& part : object.body.parts) {
            const auto primitive = static_cast<std::int32_t>(object_of_primitive_.size());
            for (const Cell& c : part) all.emplace_back(c, primitive);
            members.back().push_back(primitive);
            object_of_primitive_.push_back(static_cast<std::int32_t>(members.size()));
            density.push_back(object.body.density_kg_m3);
        }
    }
    std::sort(all.begin(), all.end());
    cells_.voxel_m = cell_m;
    for (const auto& [c, primitive] : all) {
        cells_.i.push_back(c[0]);
        cells_.j.push_back(c[1]);
        cells_.k.push_back(c[2]);
        cells_.primitive.push_back(primitive);
        cells_.basis.push_back(Basis::surface);
    }
    const auto primitives = static_cast<std::int32_t>(object_of_primitive_.size());
    const auto bodies = physics::mass_properties(device, cells_, primitives, density);
    const graph::ContactGraph contacts = graph::build_contact_graph(device, cells_, primitives);
    hulls_ =
        physics::part_hulls(cells_, {}, std::vector<bool>(density.size(), true), device.threads());
    for (std::vector<std::int32_t>& parts : members)
        candidates_.push_back(graph::candidate_of(
            contacts, bodies, std::vector<bool>(static_cast<std::size_t>(primitives)),
            std::move(parts)));
}

std::vector<physics::Instability> StandingScene::instability() const {
    std::vector<physics::Candidate> candidates = candidates_;
    const CellColumns columns(cells_);
    std::vector<physics::MassProperties> bodies{
        {}};  // what is fixed has no mass, and does not slide
    for (physics::Candidate& candidate : candidates) {
        candidate.edge_drop_m = physics::drops_when_tipped_m(cells_, columns, candidate);
        bodies.push_back(candidate.body);
    }
    const std::vector<double> coefficient(bodies.size(), friction);
    const auto slides = physics::slide_all(cells_, object_of_primitive_, bodies, coefficient);
    std::vector<physics::Instability> result;
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        const physics::Stability tips =
            physics::assess(physics::standing_hull(hulls_, candidates[n]), candidates[n]);
        result.push_back(physics::combine_curves(tips, slides[n + 1]));
    }
    return result;
}

}  // namespace topple::simulation
