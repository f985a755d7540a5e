// SPDX-License-Identifier: MIT
#include "safety/human/walkable_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/number_text.h"
#include "core/room_measures.h"
#include "safety/human/human_field.h"
#include "safety/objects.h"

namespace topple::safety {
namespace {

constexpr float no_floor = -std::numeric_limits<float>::infinity();

// Offsets of the cells whose centres lie within the radius (in cells), nearest first.
std::vector<Place> disc(double radius) {
    std::vector<Place> out;
    const auto r = static_cast<std::int64_t>(std::floor(radius + 1e-9));
    for (std::int64_t y = -r; y <= r; ++y) {
        for (std::int64_t x = -r; x <= r; ++x) {
            if (static_cast<double>(x * x + y * y) <= radius * radius + 1e-9) out.push_back({x, y});
        }
    }
    std::stable_sort(out.begin(), out.end(), [](const Place& a, const Place& b) {
        return a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
    });
    return out;
}

// The map's frame: cells no finer than the voxels, and so few that 16 planes of them, with
// the margins that the convolution adds, stay within 128 MiB.
WalkableMap empty_map(const SolidCells& cells, const HumanOptions& options) {
    WalkableMap map;
    map.voxel_m = cells.voxel_m;
    if (cells.size() == 0) return map;
    const auto [il, ih] = std::minmax_element(cells.i.begin(), cells.i.end());
    const auto [jl, jh] = std::minmax_element(cells.j.begin(), cells.j.end());
    map.i0 = *il;
    map.j0 = *jl;
    map.x0 = *il * cells.voxel_m;
    map.y0 = *jl * cells.voxel_m;
    map.cell_m =
        std::max({options.cell_m, cells.voxel_m, 0.02});  // finer than 2 cm tells nothing of people
    const double width = (static_cast<double>(*ih) - *il + 1) * cells.voxel_m;
    const double depth = (static_cast<double>(*jh) - *jl + 1) * cells.voxel_m;
    const auto across = [&](double metres, double margin) { return metres / map.cell_m + margin; };
    while (across(width, 160) * across(depth, 96) > 2097152.0) map.cell_m *= 2;
    if (map.cell_m > options.cell_m * 1.001) {
        map.notes.push_back("The walkable map has cells of " +
                            std::to_string(std::lround(map.cell_m * 1000)) +
                            " mm: as wide as the voxels, or as the size of the scene allows.");
    }
    map.nx = static_cast<std::int64_t>(std::floor((width / map.cell_m) - 1e-9)) + 1;
    map.ny = static_cast<std::int64_t>(std::floor((depth / map.cell_m) - 1e-9)) + 1;
    return map;
}

// Heights of the scanned floor: the top of each cell's highest floor voxel.
void scan_floor(WalkableMap& map, const Surroundings& s) {
    map.floor_m.assign(map.size(), no_floor);
    for (std::size_t c = 0; c < s.cells->size(); ++c) {
        if (!is_floor_cell(s, c)) continue;
        float& floor = map.floor_m[map.cell_of(s.cells->i[c], s.cells->j[c])];
        floor = std::max(floor, static_cast<float>((s.cells->k[c] + 1.0) * map.voxel_m));
    }
}

// Closing by a disc: a cell without floor becomes floor unless some disc of the hole's radius
// around a cell near it meets no floor at all. Returns which cells are floor.
std::vector<bool> bridge_holes(WalkableMap& map, double hole_m) {
    const std::vector<Place> reach = disc(hole_m / 2 / map.cell_m);
    const std::size_t n = map.size();
    std::vector<bool> scanned(n), near_floor(n);
    for (std::size_t c = 0; c < n; ++c) scanned[c] = map.floor_m[c] != no_floor;
    // Of all within reach of cell c, whether it is one of those.
    const auto reached = [&](const std::vector<bool>& those, std::size_t c) {
        return [&map, &those, from = map.place(static_cast<std::uint32_t>(c))](const Place& away) {
            const Place to{from.x + away.x, from.y + away.y};
            return map.inside(to) && those[map.index(to)];
        };
    };
    for (std::size_t c = 0; c < n; ++c)
        near_floor[c] = std::ranges::any_of(reach, reached(scanned, c));
    std::vector<bool> floor = scanned;
    for (std::size_t c = 0; c < n; ++c) {
        if (scanned[c] || !near_floor[c]) continue;
        floor[c] = std::ranges::all_of(reach, reached(near_floor, c));
        map.bridged += floor[c];
    }
    return floor;
}

// Gives every cell the height of the floor cell nearest to it in steps over edges.
void spread_floor(WalkableMap& map) {
    std::vector<std::uint32_t> queue;
    queue.reserve(map.size());
    for (std::size_t c = 0; c < map.size(); ++c) {
        if (map.floor_m[c] != no_floor) queue.push_back(static_cast<std::uint32_t>(c));
    }
    for (std::size_t at = 0; at < queue.size(); ++at) {
        const auto [x, y] = map.place(queue[at]);
        for (const Place& to : {Place{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
            if (!map.inside(to) || map.floor_m[map.index(to)] != no_floor) continue;
            map.floor_m[map.index(to)] = map.floor_m[queue[at]];
            queue.push_back(map.index(to));
        }
    }
}

// Cells with a solid at body height. Solids that belong to no primitive count from three voxels a
// cell on: fewer are noise.
std::vector<bool> obstacles(const WalkableMap& map, const Surroundings& s,
                            const HumanOptions& options) {
    const double step = std::max(options.step_height_m, map.voxel_m);
    std::vector<bool> shut(map.size());
    std::vector<std::uint8_t> specks(map.size());
    for (std::size_t v = 0; v < s.cells->size(); ++v) {
        const std::size_t c = map.cell_of(s.cells->i[v], s.cells->j[v]);
        const double bottom = s.cells->k[v] * map.voxel_m - double{map.floor_m[c]};
        const double slack = 1e-4 * map.voxel_m + 1e-6;
        if (bottom + map.voxel_m <= step + slack || bottom >= options.body_height_m - slack)
            continue;
        if (s.cells->primitive[v] >= 0 || ++specks[c] >= 3) shut[c] = true;
    }
    return shut;
}

void find_components(WalkableMap& map, const std::vector<bool>& walkable, double step_m) {
    map.component.assign(map.size(), -1);
    std::vector<std::uint32_t> queue;
    for (std::size_t start = 0; start < map.size(); ++start) {
        if (!walkable[start]) continue;
        map.walkable.push_back(static_cast<std::uint32_t>(start));
        if (map.component[start] >= 0) continue;
        map.component[start] = map.components;
        queue.assign(1, static_cast<std::uint32_t>(start));
        for (std::size_t at = 0; at < queue.size(); ++at) {
            const auto [x, y] = map.place(queue[at]);
            for (std::int64_t dy = -1; dy <= 1; ++dy) {
                for (std::int64_t dx = -1; dx <= 1; ++dx) {
                    if (!map.inside({x + dx, y + dy})) continue;
                    const std::uint32_t to = map.index({x + dx, y + dy});
                    if (!walkable[to] || map.component[to] >= 0) continue;
                    if (std::fabs(map.floor_m[to] - map.floor_m[queue[at]]) > step_m) continue;
                    map.component[to] = map.components;
                    queue.push_back(to);
                }
            }
        }
        ++map.components;
    }
}

}  // namespace

bool WalkableMap::holds(std::int32_t i, std::int32_t j) const {
    const auto inside = [&](std::int64_t voxel, std::int64_t n) {
        return voxel >= 0 && static_cast<double>(voxel) * voxel_m < static_cast<double>(n) * cell_m;
    };
    return inside(std::int64_t{i} - i0, nx) && inside(std::int64_t{j} - j0, ny);
}

std::size_t WalkableMap::cell_of(std::int32_t i, std::int32_t j) const {
    const auto at = [&](std::int64_t voxel, std::int64_t n) {
        const auto cell =
            static_cast<std::int64_t>((static_cast<double>(voxel) + 0.5) * voxel_m / cell_m);
        return std::clamp<std::int64_t>(cell, 0, n - 1);
    };
    return static_cast<std::size_t>(at(std::int64_t{j} - j0, ny) * nx +
                                    at(std::int64_t{i} - i0, nx));
}

WalkableMap walkable_map(const Surroundings& surroundings, const HumanOptions& options) {
    WalkableMap map = empty_map(*surroundings.cells, options);
    if (map.size() == 0) {
        map.notes.push_back("Nobody walks here: the scene has no solid cells.");
        return map;
    }
    scan_floor(map, surroundings);
    const bool any_floor = std::any_of(map.floor_m.begin(), map.floor_m.end(),
                                       [](float floor) { return floor != no_floor; });
    if (!any_floor) {
        map.component.assign(map.size(), -1);
        map.notes.push_back("Nobody walks here: no primitive of the scene is a floor.");
        return map;
    }
    const std::vector<bool> floor = bridge_holes(map, options.largest_hole_m);
    spread_floor(map);
    const std::vector<bool> shut = obstacles(map, surroundings, options);
    std::vector<bool> walkable = floor;
    const std::vector<Place> body = disc(options.body_radius_m / map.cell_m);
    for (std::size_t c = 0; c < map.size(); ++c) {
        if (!shut[c]) continue;
        const auto [x, y] = map.place(static_cast<std::uint32_t>(c));
        for (const Place& o : body)
            if (map.inside({x + o.x, y + o.y})) walkable[map.index({x + o.x, y + o.y})] = false;
    }
    find_components(map, walkable, std::max(options.step_height_m, map.voxel_m) + 1e-4);
    if (map.bridged > 0) {
        map.notes.push_back(
            std::to_string(map.bridged) +
            " cells of the walkable map have no scanned floor and were bridged: they lie in "
            "holes of at most " +
            std::to_string(std::lround(options.largest_hole_m * 100)) + " cm.");
    }
    if (map.walkable.empty()) {
        map.notes.push_back("Nobody walks here: solids leave no room for a body on the floor.");
        return map;
    }
    const double area = static_cast<double>(map.walkable.size()) * map.cell_m * map.cell_m;
    if (area < least_floor_m2) {
        map.notes.push_back("People walk on only " + to_places(area, 1) +
                            " square metres: either the floor was hardly scanned, so that people "
                            "are missed, or the lowest level surface is no floor but a table top "
                            "or the like, where nobody walks: then leave human out of the "
                            "disturbances.");
    }
    return map;
}

}  // namespace topple::safety
