// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "lab/solids/part.h"

namespace topple::scenes {

// The first surface along a ray through many parts, by a tree of their bounding boxes. Room frame.
class RayCaster {
  public:
    explicit RayCaster(const std::vector<Part>& parts);  // which must outlive this

    struct Hit {
        double distance = std::numeric_limits<double>::infinity();  // m along the unit direction
        std::int32_t part = -1;                                     // -1: nothing was hit
    };
    Hit cast(const Vec3& origin, const Vec3& direction) const;

    // Least distance to any part, as far as `most`; negative inside of one.
    double clearance(const Vec3& p, double most) const;

    const std::vector<Part>& parts() const { return *parts_; }

  private:
    // A leaf holds order_[first, first + count); an inner node's children are the next one and
    // `first`.
    struct Node {
        Bounds box;
        std::uint32_t first = 0, count = 0;
    };
    std::uint32_t build(std::size_t first, std::size_t last);
    double entry(const Bounds& box, const Vec3& origin, const Vec3& inverse) const;

    const std::vector<Part>* parts_;
    std::vector<Part::Heading> headings_;
    std::vector<Bounds> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace topple::scenes
