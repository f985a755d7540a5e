// SPDX-License-Identifier: MIT
#include "compare/overlay.h"

#include "compare/eigen.h"

namespace topple::comparing {
namespace {

void lay(const Side& on, const Side& from, const Eigen::Isometry3d& motion, Overlay& out) {
    for (const SurfacePoint& point : from.surface) {
        const Eigen::Vector3d at = motion * mapped(point.place_m);
        const std::int32_t there = on.space.at({at.x(), at.y(), at.z()});
        ++out.all;
        out.both += there >= SeenSpace::of_none;
        out.free += there == SeenSpace::free;
    }
}

}  // namespace

Overlay overlay(const Side& a, const Side& b, const Eigen::Isometry3d& a_from_b) {
    Overlay out;
    lay(a, b, a_from_b, out);
    lay(b, a, a_from_b.inverse(), out);
    return out;
}

}  // namespace topple::comparing
