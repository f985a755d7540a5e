// SPDX-License-Identifier: MIT
#include "geometry/walls.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace topple::geometry {
namespace {

// Share of the scene's surfels that may lie behind a wall: windows, mirrors, open doors.
constexpr double behind_share = 0.02;
// What is no farther behind a face is of its own thickness, or, of a whole wall, a step of it.
constexpr double thin_m = 0.05, step_depth_m = 0.2;
// Pieces of a wall's plane face as it does and lie as near to it, or within the noise of cells as
// coarse as that; of a part that is wall at least this share does.
constexpr double same_wall_cos = 0.98, same_wall_m = 0.04, wall_piece_share = 0.75;
// A wall under a beam ends there along this share of its length.
constexpr double under_share = 0.5;

// Share of all surfels further behind the face than that, and than noise explains.
double share_behind(const Surfels& s, const Face& f, double thick_m) {
    const double slack = std::max(thick_m, 3 * s.cell_m);
    std::uint64_t behind = 0;
    for (std::size_t n = 0; n < s.size(); ++n) {
        behind += (s.x[n] - f.px) * f.nx + (s.y[n] - f.py) * f.ny + (s.z[n] - f.pz) * f.nz < -slack;
    }
    return s.size() ? static_cast<double>(behind) / static_cast<double>(s.size()) : 0;
}

// A face of a wall, and how far it reaches along it.
struct WallFace {
    Face face;
    LevelSpan span;
};

// Whether a face lies in the plane of a wall and near it. Of a wall that is a single sheet at this
// resolution, both faces lie in one plane.
bool continues(const WallFace& wall, const WallFace& piece, double near_m) {
    const Face &w = wall.face, &f = piece.face;
    const double facing = f.nx * w.nx + f.ny * w.ny + f.nz * w.nz;
    const double before = (f.px - w.px) * w.nx + (f.py - w.py) * w.ny + (f.pz - w.pz) * w.nz;
    return std::abs(facing) > same_wall_cos && std::abs(before) < near_m &&
           gap_m(wall.span, piece.span, facing < 0) <= door_m;
}

// Of the places along the wall that a sheet takes up, the share at which shell is right above it.
double share_under_shell(const Surfels& s, const std::vector<std::int32_t>& label, std::size_t p,
                         const Face& f, const Vec3& up, const std::vector<Structure>& structure) {
    const Vec3 along = level_axis(f, up);
    const auto is_shell = [&](std::int32_t l) {
        return l >= 0 && (structure[static_cast<std::size_t>(l)] == Structure::wall ||
                          structure[static_cast<std::size_t>(l)] == Structure::ceiling);
    };
    std::map<std::int64_t, bool> places;
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] != static_cast<std::int32_t>(p)) continue;
        bool& under = places[static_cast<std::int64_t>(
            std::floor(component(along, s.x[n], s.y[n], s.z[n]) / s.cell_m))];
        const double height = component(up, s.x[n], s.y[n], s.z[n]);
        if (under || height < f.highest_m - below_ceiling_m) continue;
        for (std::uint32_t k = s.neighbour_first[n]; k < s.neighbour_first[n + 1]; ++k) {
            const std::size_t m = s.neighbours[k];
            under = under || (is_shell(label[m]) && component(up, s.x[m], s.y[m], s.z[m]) > height);
        }
    }
    const auto count =
        std::ranges::count_if(places, [](const auto& place) { return place.second; });
    return places.empty() ? 0 : static_cast<double>(count) / static_cast<double>(places.size());
}

}  // namespace

RoomEnds find_room_ends(const Surfels& surfels, const Vec3& up, const std::vector<Face>& face,
                        double least_area_m2, double floor_m) {
    RoomEnds ends;
    std::vector<Face> bounds;
    for (const Face& f : face) {
        const bool bounding = f.is_plane() && f.area_m2 >= least_area_m2 &&
                              share_behind(surfels, f, thin_m) < behind_share;
        ends.bounds.push_back(bounding);
        if (!bounding) continue;
        bounds.push_back(f);
        if (f.is_upright(up)) ends.walls_end_m = std::max(ends.walls_end_m, f.highest_m);
    }
    ends.ceiling_m = ceiling_height(bounds, up, floor_m, INFINITY);
    return ends;
}

bool is_stepped_wall(const Surfels& surfels, const Face& f, const RoomEnds& ends, double floor_m) {
    return std::isfinite(ends.walls_end_m) && f.area_m2 >= high_wall_m2 &&
           f.lowest_m <= floor_m + below_ceiling_m &&
           f.highest_m >= ends.walls_end_m - below_ceiling_m &&
           share_behind(surfels, f, step_depth_m) < behind_share;
}

void add_walls_under_shell(const Surfels& surfels, const PrimitiveSet& primitives, const Vec3& up,
                           const std::vector<Face>& face, double floor_m,
                           std::vector<Structure>& structure) {
    std::vector<std::size_t> high;
    for (std::size_t p = 0; p < face.size(); ++p) {
        const Face& f = face[p];
        if (structure[p] == Structure::none && f.is_sheet() && f.is_upright(up) &&
            f.area_m2 >= high_wall_m2 && f.highest_m >= floor_m + lowest_ceiling_m)
            high.push_back(p);
    }
    // What becomes wall may be what another one ends at.
    for (bool more = true; more;) {
        more = false;
        for (const std::size_t p : high) {
            if (structure[p] != Structure::none ||
                share_under_shell(surfels, primitives.label, p, face[p], up, structure) <
                    under_share)
                continue;
            structure[p] = Structure::wall;
            more = true;
        }
    }
}

void add_wall_pieces(const Surfels& surfels, const PrimitiveSet& primitives, const Vec3& up,
                     const std::vector<Face>& face, std::vector<Structure>& structure) {
    const std::vector<std::int32_t>& label = primitives.faces.label;
    const std::vector<Face> region = faces(surfels, label, primitives.faces.regions.size(), up);
    const std::vector<LevelSpan> span = level_spans(surfels, label, region, up);
    const double near = std::max(same_wall_m, surfels.cell_m);
    const auto is_side = [&](std::size_t r) {
        return region[r].is_sheet() && region[r].is_upright(up);
    };
    std::vector<WallFace> walls;
    const auto add_faces = [&](std::size_t p) {
        for (const std::int32_t r : primitives.regions[p]) {
            const auto k = static_cast<std::size_t>(r);
            if (region[k].area_m2 >= wall_area_m2 && is_side(k))
                walls.push_back({region[k], span[k]});
        }
    };
    for (std::size_t p = 0; p < face.size(); ++p)
        if (structure[p] == Structure::wall) add_faces(p);
    const auto in_wall = [&](std::size_t r) {
        return is_side(r) && std::ranges::any_of(walls, [&](const WallFace& wall) {
                   return continues(wall, {region[r], span[r]}, near);
               });
    };
    for (bool more = true; more;) {
        std::vector<std::size_t> found;
        for (std::size_t p = 0; p < face.size(); ++p) {
            if (structure[p] != Structure::none || face[p].area_m2 < wall_area_m2) continue;
            double area = 0;
            for (const std::int32_t r : primitives.regions[p]) {
                const auto k = static_cast<std::size_t>(r);
                if (in_wall(k)) area += region[k].area_m2;
            }
            if (area >= std::max(wall_area_m2, wall_piece_share * face[p].area_m2))
                found.push_back(p);
        }
        for (const std::size_t p : found) {
            structure[p] = Structure::wall;
            add_faces(p);
        }
        more = !found.empty();
    }
}

}  // namespace topple::geometry
