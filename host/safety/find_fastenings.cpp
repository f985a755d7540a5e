// SPDX-License-Identifier: MIT
#include "safety/find_fastenings.h"

#include <algorithm>
#include <cmath>

namespace topple {
namespace {

constexpr double strap_m = 0.3;  // set by hand

// Whether a part of the building beside the box's upper end was seen.
bool building_near(const SolidScene& solids, const Table<PrimitiveId, bool>& fixed,
                   const ObjectBox& box) {
    const SolidCells& cells = solids.cells();
    const double h = cells.voxel_m;
    const auto index = [h](double x) { return static_cast<std::int32_t>(std::floor(x / h)); };
    const auto ends = [&](std::size_t a) {
        const double half = box.size_m[a] / 2 + strap_m;
        return std::pair(index(box.middle_m[a] - half), index(box.middle_m[a] + half));
    };
    const auto [i0, i1] = ends(0);
    const auto [j0, j1] = ends(1);
    const std::int32_t low = index(box.top_m() - strap_m), high = index(box.top_m());
    for (std::int32_t i = i0; i <= i1; ++i) {
        for (std::int32_t j = j0; j <= j1; ++j) {
            const auto [first, last] = solids.columns().at(i, j);
            for (std::size_t n = first; n < last; ++n) {
                const std::int32_t p = cells.primitive[n];
                if (p < 0 || cells.k[n] < low || cells.k[n] > high) continue;
                const Role role = solids.role(p);
                if (fixed[p] && role != Role::floor && role != Role::ceiling) return true;
            }
        }
    }
    return false;
}

bool hidden_wall_near(const physics::HiddenWalls& walls, const ObjectBox& box) {
    constexpr int places = 5;  // along each side
    const Vec3 middle{box.middle_m[0], box.middle_m[1], box.top_m()};
    for (std::size_t across = 0; across < 2; ++across) {
        for (const double sign : {-1.0, 1.0}) {
            for (int n = 0; n < places; ++n) {
                Vec3 from = middle;
                from[1 - across] += box.size_m[1 - across] * ((n + 0.5) / places - 0.5);
                Vec3 to = from;
                to[across] += sign * (box.size_m[across] / 2 + strap_m);
                if (walls.between(from, to)) return true;
            }
        }
    }
    return false;
}

// Whether what carries most of it is the floor, or of the building and hardly higher, as scraps of
// a floor are; also where nothing is known to carry it.
bool on_floor(const SolidScene& solids, const ObjectStage& objects, double floor_m, ObjectId o) {
    constexpr double hardly_m = 0.15;  // set by hand
    const graph::Carrying* most = nullptr;
    const ObjectOf object(objects.object_of_primitive);
    for (const graph::Carrying& c : objects.contacts.carryings) {
        if (object(c.supported) == o && object(c.supporter) != o &&
            (!most || c.area_m2 > most->area_m2))
            most = &c;
    }
    if (!most || most->supporter < 0 || solids.role(most->supporter) == Role::floor) return true;
    return objects.objects[object(most->supporter)].grounded &&
           objects.objects[o].candidate.support_height_m < floor_m + hardly_m;
}

}  // namespace

std::vector<Fastening> find_fastenings(const SolidParts& parts, const ObjectStage& objects) {
    const std::vector<bool> fixed = fixed_primitives(objects.object_of_primitive, objects.objects);
    const double floor_m = objects.floors.middle_m();
    std::vector<Fastening> out(objects.objects.size());
    for (std::size_t o = 0; o < out.size(); ++o) {
        const ObjectBox& box = objects.objects[o].box;
        if (objects.objects[o].grounded || !std::isfinite(box.middle_m[0])) continue;
        out[o].wall =
            building_near(*parts.solids, fixed, box) || hidden_wall_near(objects.hidden_walls, box);
        out[o].floor = on_floor(*parts.solids, objects, floor_m, o);
    }
    return out;
}

}  // namespace topple
