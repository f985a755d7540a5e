// SPDX-License-Identifier: MIT
#include "scenes/blueprint.h"

#include <algorithm>
#include <limits>

namespace topple::scenes {
namespace {

int put(Blueprint& blueprint, Part part) {
    blueprint.parts.push_back(std::move(part));
    return static_cast<int>(blueprint.parts.size()) - 1;
}

}  // namespace

int Blueprint::box(const char* part, double x, double y, double bottom, const Vec3& size,
                   double yaw) {
    return put(*this, {Shape::box, {x, y, bottom + size[2] / 2}, size, yaw, 0, -1, part});
}

int Blueprint::cylinder(const char* part, double x, double y, double bottom, double diameter,
                        double height) {
    return put(*this, {Shape::cylinder,
                       {x, y, bottom + height / 2},
                       {diameter, diameter, height},
                       0,
                       0,
                       -1,
                       part});
}

int Blueprint::lying(const char* part, double x, double y, double bottom, double length,
                     double diameter, double yaw) {
    return put(*this, {Shape::lying_cylinder,
                       {x, y, bottom + diameter / 2},
                       {length, diameter, diameter},
                       yaw,
                       0,
                       -1,
                       part});
}

int Blueprint::sphere(const char* part, double x, double y, double bottom, double diameter) {
    return put(*this, {Shape::sphere,
                       {x, y, bottom + diameter / 2},
                       {diameter, diameter, diameter},
                       0,
                       0,
                       -1,
                       part});
}

int Blueprint::cone(const char* part, double x, double y, double bottom, double diameter,
                    double height, double top_ratio) {
    return put(*this, {Shape::cone,
                       {x, y, bottom + height / 2},
                       {diameter, diameter, height},
                       0,
                       top_ratio,
                       -1,
                       part});
}

void Blueprint::stand_on(int part, double clearance, const char* where, double rim) {
    const Part& p = parts[static_cast<std::size_t>(part)];
    // The square inside a disc.
    const double share = p.shape == Shape::box ? 0.5 : 0.5 * 0.7071;
    surfaces.push_back({part, p.center[0], p.center[1], share * p.size[0] - rim,
                        share * p.size[1] - rim, clearance, where});
}

std::array<Vec3, 2> Blueprint::bounds() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<Vec3, 2> all{Vec3{infinity, infinity, infinity},
                            Vec3{-infinity, -infinity, -infinity}};
    for (const Part& part : parts) {
        const auto one = part.bounds();
        for (std::size_t k = 0; k < 3; ++k) {
            all[0][k] = std::min(all[0][k], one[0][k]);
            all[1][k] = std::max(all[1][k], one[1][k]);
        }
    }
    return all;
}

}  // namespace topple::scenes
