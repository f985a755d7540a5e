// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "lab/solids/part.h"

namespace topple::scenes {

// Which of many parts lie along a ray or near a place, by a tree of their bounding boxes. Room
// frame.
class RayCaster {
  public:
    explicit RayCaster(const std::vector<Part>& parts);  // which must outlive this

    struct Hit {
        double distance = std::numeric_limits<double>::infinity();  // m along the unit direction
        std::int32_t part = -1;                                     // -1: nothing was hit
    };
    Hit cast(const Vec3& origin, const Vec3& direction) const;

    // use(part, its signed distance) for each part that may be nearer to p than `reach`, and maybe
    // for others.
    template <class Use>
    void each_near(const Vec3& p, double reach, const Use& use) const;
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

template <class Use>
void RayCaster::each_near(const Vec3& p, double reach, const Use& use) const {
    std::array<std::uint32_t, 64> stack{};
    std::size_t depth = nodes_.empty() ? 0 : 1;  // from the root
    while (depth > 0) {
        const std::uint32_t at = stack[--depth];
        const Node& node = nodes_[at];
        bool near = true;
        for (std::size_t a = 0; a < 3; ++a)
            near = near && p[a] > node.box[0][a] - reach && p[a] < node.box[1][a] + reach;
        if (!near) continue;
        if (node.count == 0) {
            stack[depth++] = at + 1;
            stack[depth++] = node.first;
            continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            const std::uint32_t id = order_[k];
            use(static_cast<std::int32_t>(id), (*parts_)[id].distance(p, headings_[id]));
        }
    }
}

}  // namespace topple::scenes
