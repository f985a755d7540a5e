// SPDX-License-Identifier: MIT
#include "geometry/structure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "geometry/shell_faces.h"
#include "geometry/walls.h"

namespace topple::geometry {
namespace {

// A shell plane is no smaller than this share of the largest plane of its kind.
constexpr double floor_share = 0.1, wall_share = 0.05;
constexpr double floor_area_m2 = 0.02;
// A scrap is smaller than this share of its shell plane, faces the same way to within 60 degrees
// (the normals of noise are noisy), and lies with this share of itself within the slack of the
// plane.
constexpr double scrap_share = 0.05, scrap_cos = 0.5, scrap_inside = 0.9, shell_slack_cells = 2;
// Or it faces anyhow, and lies with this share of itself within so many cells of two shell planes
// that meet: where a wall meets a wall or the floor, normals and places of points are mixtures of
// both. No thing is as small as that across, and as close to both.
constexpr double corner_inside = 0.85, corner_cells = 5, corner_cos = 0.5;
// A level piece smaller than the first, in square metres, is floor only within the noise of the
// floor's plane, in cells, and a scrap on the floor is part of it only within that or
// below the second: the foot of a lamp and a book on the floor are as flat and as low.
constexpr double floor_piece_m2 = 0.25, least_thing_m2 = 0.01, noise_cells = 0.6;

// A level piece of at least this area that is higher than things one could take it for, or as low
// as a step, is another floor: a gallery, a platform. Tables are between them, beds smaller.
constexpr double other_floor_m2 = 4, storey_m = 1.8, lowest_step_m = 0.12, highest_step_m = 0.45;

// Walls of a building whose ceiling is not seen are no lower.
constexpr double high_wall_m = 2.0;
// What is no plane, but reaches that close to the ceiling, is built in: both faces of a wall
// between doors, the lintel above one, a pillar.
constexpr double touches_ceiling_m = 0.06;
// A storey's floor strays from its height by no more.
constexpr double uneven_storey_m = 0.1;

// How far a level primitive lies above others around its footprint, or nothing where they are
// hardly to be seen.
std::optional<double> step_m(const Surfels& s, const PrimitiveSet& primitives, const Vec3& up,
                             std::size_t piece, const std::vector<bool>& others) {
    constexpr double around_m = 0.3;
    constexpr double least_area_m2 = 0.02;
    // Two axes of the level plane.
    const Vec3 side = std::abs(up[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u{side[1] * up[2] - side[2] * up[1], side[2] * up[0] - side[0] * up[2],
                 side[0] * up[1] - side[1] * up[0]};
    const Vec3 v{u[1] * up[2] - u[2] * up[1], u[2] * up[0] - u[0] * up[2],
                 u[0] * up[1] - u[1] * up[0]};
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, own = 0;
    std::uint64_t count = 0;
    const auto place = [&](std::size_t n, std::size_t axis) {
        return component(axis == 0 ? u : v, s.x[n], s.y[n], s.z[n]);
    };
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (primitives.label[n] != static_cast<std::int32_t>(piece)) continue;
        for (std::size_t a = 0; a < 2; ++a) {
            low[a] = std::min(low[a], place(n, a) - around_m);
            high[a] = std::max(high[a], place(n, a) + around_m);
        }
        own += component(up, s.x[n], s.y[n], s.z[n]);
        ++count;
    }
    double theirs = 0;
    std::uint64_t near = 0;
    for (std::size_t n = 0; n < s.size(); ++n) {
        const std::int32_t l = primitives.label[n];
        if (l < 0 || !others[static_cast<std::size_t>(l)]) continue;
        const double x = place(n, 0), y = place(n, 1);
        if (x < low[0] || x > high[0] || y < low[1] || y > high[1]) continue;
        theirs += component(up, s.x[n], s.y[n], s.z[n]);
        ++near;
    }
    if (count == 0 || static_cast<double>(near) * s.cell_m * s.cell_m < least_area_m2)
        return std::nullopt;
    return own / static_cast<double>(count) - theirs / static_cast<double>(near);
}

// Of level pieces at about the floor's height those that are floor: the largest, and what continues
// one of them. A scan's floor is uneven by its drift, but has no step: a rug, a plinth and the
// lowest board of a shelf do.
std::vector<bool> continued_floor(const Surfels& s, const PrimitiveSet& primitives, const Vec3& up,
                                  const std::vector<Face>& face,
                                  std::vector<std::size_t> candidates, double noise_m) {
    std::vector<bool> floor(face.size());
    std::ranges::stable_sort(candidates, std::greater(),
                             [&](std::size_t p) { return face[p].area_m2; });
    if (!candidates.empty()) floor[candidates.front()] = true;
    std::vector<std::size_t> apart;
    for (bool more = true; more;) {
        more = false;
        apart.clear();
        for (const std::size_t p : candidates) {
            if (floor[p]) continue;
            const std::optional<double> step = step_m(s, primitives, up, p, floor);
            if (!step) apart.push_back(p);
            if (step && *step <= noise_m) floor[p] = more = true;
        }
    }
    for (const std::size_t p : apart) floor[p] = true;
    return floor;
}

// face: of each primitive; no area and no flatness where another storey has it.
std::vector<Structure> structure_of(const Surfels& surfels, const PrimitiveSet& primitives,
                                    const Vec3& up, const std::vector<Face>& face,
                                    const StoreyHint* storey) {
    std::vector<Structure> out(face.size(), Structure::none);
    double largest_level = 0, largest_upright = 0;
    for (const Face& f : face) {
        if (!f.is_plane()) continue;
        if (f.level(up) > horizontal_cos) largest_level = std::max(largest_level, f.area_m2);
        if (f.is_upright(up)) largest_upright = std::max(largest_upright, f.area_m2);
    }
    // The floor: the lowest of the large level planes, and what continues it at the same height.
    const auto may_be_floor = [&](const Face& f) {
        return f.is_plane() && f.level(up) > horizontal_cos &&
               f.area_m2 >= std::max(floor_area_m2, floor_share * largest_level);
    };
    double floor_height = INFINITY;
    for (const Face& f : face) {
        const double height = f.height_m(up);
        // With a storey, whose floor may be out of sight, a table top is not taken for it.
        if (storey && !(std::abs(height - storey->floor_m) < uneven_storey_m)) continue;
        if (may_be_floor(f)) floor_height = std::min(floor_height, height);
    }
    if (storey && std::isinf(floor_height)) floor_height = storey->floor_m;
    const double least_shell_m2 = std::max(wall_area_m2, wall_share * largest_upright);
    const RoomEnds ends =
        storey ? RoomEnds{} : find_room_ends(surfels, up, face, least_shell_m2, floor_height);
    const double ceiling =
        storey ? ceiling_height(face, up, floor_height, storey->top_m) : ends.ceiling_m;
    const bool covered = std::isfinite(ceiling);
    const auto is_ceiling = [&](std::size_t p) {
        return storey ? face[p].lowest_m - floor_height >= lowest_ceiling_m : ends.bounds[p];
    };
    const auto is_wall = [&](std::size_t p) {
        const Face& f = face[p];
        if (!storey && ends.bounds[p]) return true;
        if (covered) return f.is_sheet() && f.highest_m >= ceiling - below_ceiling_m;
        if (!storey) return f.is_plane() && is_stepped_wall(surfels, f, ends, floor_height);
        return f.is_plane() && f.highest_m - f.lowest_m >= high_wall_m && f.area_m2 >= high_wall_m2;
    };
    const double noise = noise_cells * surfels.cell_m, uneven = std::max(0.03, 2 * surfels.cell_m);
    std::vector<std::size_t> large;
    std::vector<bool> small(face.size()), other(face.size());
    for (std::size_t p = 0; p < face.size(); ++p) {
        const Face& f = face[p];
        const double above = f.height_m(up) - floor_height;
        if (!f.is_plane() || f.level(up) < horizontal_cos || above < -uneven) continue;
        if (f.area_m2 >= floor_piece_m2 && above < uneven) large.push_back(p);
        other[p] = f.area_m2 >= other_floor_m2 &&
                   (above >= storey_m || (above >= lowest_step_m && above <= highest_step_m));
        small[p] = f.area_m2 >= floor_area_m2 && f.area_m2 < floor_piece_m2 && above < noise;
    }
    const std::vector<bool> continued =
        continued_floor(surfels, primitives, up, face, large, noise);
    for (std::size_t p = 0; p < face.size(); ++p) {
        const Face& f = face[p];
        if (small[p] || other[p] || continued[p]) {
            out[p] = Structure::floor;
        } else if (f.area_m2 >= wall_area_m2 && f.highest_m >= ceiling - touches_ceiling_m &&
                   (!f.is_plane() || f.level(up) > -horizontal_cos)) {
            out[p] = Structure::wall;
        } else if (f.area_m2 >= least_shell_m2) {
            if (f.is_upright(up) && is_wall(p)) out[p] = Structure::wall;
            if (f.is_plane() && f.level(up) < -horizontal_cos && is_ceiling(p))
                out[p] = Structure::ceiling;
        }
    }
    if (covered) add_walls_under_shell(surfels, primitives, up, face, floor_height, out);
    add_wall_pieces(surfels, primitives, up, face, out);
    return out;
}

}  // namespace

std::vector<Structure> find_structure(const Surfels& surfels, const PrimitiveSet& primitives,
                                      const Vec3& up, std::span<const StoreyHint> storeys) {
    const std::vector<Face> all = faces(surfels, primitives.label, primitives.model.size(), up);
    if (storeys.size() < 2)
        return structure_of(surfels, primitives, up, all,
                            storeys.empty() ? nullptr : &storeys.front());
    std::vector<Structure> out(all.size(), Structure::none);
    for (const StoreyHint& storey : storeys) {
        const auto within = [&](const Face& f) {
            const double height = f.height_m(up);
            return height >= storey.below_m && height < storey.top_m;
        };
        std::vector<Face> own = all;
        for (Face& f : own) {
            if (!within(f)) f = {};
        }
        const std::vector<Structure> found = structure_of(surfels, primitives, up, own, &storey);
        for (std::size_t p = 0; p < all.size(); ++p) {
            if (within(all[p])) out[p] = found[p];
        }
    }
    return out;
}

void absorb_into_shell(const Surfels& s, PrimitiveSet& primitives,
                       std::vector<Structure>& structure) {
    const std::vector<Face> face = faces(s, primitives.label, primitives.model.size(), {0, 0, 0});
    const double slack = shell_slack_cells * s.cell_m;
    std::vector<std::int32_t> home(face.size(), -1);
    std::vector<std::vector<std::size_t>> beside(face.size());  // shell planes that it is close to
    for (std::size_t shell = 0; shell < face.size(); ++shell) {
        const Face& f = face[shell];
        if (structure[shell] == Structure::none || !f.is_sheet()) continue;
        std::vector<std::uint64_t> near(face.size(), 0), close(face.size(), 0), all(face.size(), 0);
        std::vector<double> offset(face.size(), 0);
        for (std::size_t n = 0; n < s.size(); ++n) {
            if (primitives.label[n] < 0) continue;
            const auto p = static_cast<std::size_t>(primitives.label[n]);
            ++all[p];
            const double d =
                (s.x[n] - f.px) * f.nx + (s.y[n] - f.py) * f.ny + (s.z[n] - f.pz) * f.nz;
            near[p] += std::abs(d) < slack;
            close[p] += std::abs(d) < corner_cells * s.cell_m;
            offset[p] += d;
        }
        for (std::size_t p = 0; p < face.size(); ++p) {
            const double facing = face[p].nx * f.nx + face[p].ny * f.ny + face[p].nz * f.nz;
            const double along = f.is_plane() ? facing : std::abs(facing);
            const bool thing = structure[shell] == Structure::floor &&
                               face[p].area_m2 >= least_thing_m2 &&
                               offset[p] > noise_cells * s.cell_m * static_cast<double>(all[p]);
            if (home[p] >= 0 || structure[p] != Structure::none ||
                !(face[p].area_m2 < scrap_share * f.area_m2)) {
                continue;
            }
            const auto count = static_cast<double>(all[p]);
            if (!thing && along > scrap_cos &&
                static_cast<double>(near[p]) >= scrap_inside * count) {
                home[p] = static_cast<std::int32_t>(shell);
            } else if (static_cast<double>(close[p]) >= corner_inside * count) {
                const auto meets = [&](std::size_t other) {
                    const Face& g = face[other];
                    return std::abs(g.nx * f.nx + g.ny * f.ny + g.nz * f.nz) < corner_cos;
                };
                if (std::any_of(beside[p].begin(), beside[p].end(), meets))
                    home[p] = static_cast<std::int32_t>(shell);
                beside[p].push_back(shell);
            }
        }
    }
    std::vector<std::int32_t> number(face.size(), -1);
    std::size_t next = 0;
    for (std::size_t p = 0; p < face.size(); ++p) {
        if (home[p] >= 0) continue;
        number[p] = static_cast<std::int32_t>(next);
        if (next != p) {
            primitives.model[next] = std::move(primitives.model[p]);
            primitives.regions[next] = std::move(primitives.regions[p]);
            structure[next] = structure[p];
        }
        ++next;
    }
    primitives.model.resize(next);
    primitives.regions.resize(next);
    structure.resize(next);
    for (std::int32_t& l : primitives.label) {
        if (l < 0) continue;
        const std::int32_t to = home[static_cast<std::size_t>(l)];
        l = number[static_cast<std::size_t>(to >= 0 ? to : l)];
    }
}

}  // namespace topple::geometry
