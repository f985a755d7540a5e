// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "lab/solids/scene.h"

namespace topple::scenes {

// Signed distance to one part of many: those far away are left out by their bounding spheres.
class Measure {
  public:
    explicit Measure(const Part& part)
        : part_(&part), heading_(part.heading()), radius_(part.bounding_radius()) {}

    const Part& part() const { return *part_; }
    // Whether |distance| could be below `best` at p.
    bool near(const Vec3& p, double best) const {
        const double x = p[0] - part_->center[0], y = p[1] - part_->center[1],
                     z = p[2] - part_->center[2];
        const double reach = radius_ + best;
        return !(x * x + y * y + z * z > reach * reach);
    }
    double at(const Vec3& p) const { return part_->distance(p, heading_); }

  private:
    const Part* part_;
    Part::Heading heading_;
    double radius_;
};

inline std::vector<Measure> measures(const World& truth) {
    return {truth.parts.begin(), truth.parts.end()};
}

}  // namespace topple::scenes
