// SPDX-License-Identifier: MIT
#include "lab/solids/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace topple::scenes {
namespace {

constexpr std::size_t leaf_size = 2;
constexpr double unbounded = std::numeric_limits<double>::infinity();

}  // namespace

RayCaster::RayCaster(const std::vector<Part>& parts) : parts_(&parts), order_(parts.size()) {
    for (const Part& part : parts) {
        headings_.push_back(part.heading());
        boxes_.push_back(part.bounds());
    }
    std::iota(order_.begin(), order_.end(), 0u);
    if (!parts.empty()) build(0, parts.size());
}

std::uint32_t RayCaster::build(std::size_t first, std::size_t last) {
    Bounds box = no_bounds(), middles = box;
    const auto middle_of = [&](std::uint32_t part, std::size_t a) {
        return boxes_[part][0][a] + boxes_[part][1][a];
    };
    for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t part = order_[k];
        extend(box, boxes_[part]);
        extend(middles, Vec3{middle_of(part, 0), middle_of(part, 1), middle_of(part, 2)});
    }
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(
        {box, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last - first)});
    if (last - first <= leaf_size) return node;
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
        if (middles[1][a] - middles[0][a] > middles[1][axis] - middles[0][axis]) axis = a;
    }
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const double at = middle_of(a, axis), bt = middle_of(b, axis);
        return at != bt ? at < bt : a < b;
    };
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(first), at(middle), at(last), before);
    build(first, middle);
    const std::uint32_t right = build(middle, last);
    nodes_[node].first = right;
    nodes_[node].count = 0;
    return node;
}

// Distance at which a ray enters a box, or infinity.
double RayCaster::entry(const Bounds& box, const Vec3& origin, const Vec3& inverse) const {
    double from = 0, to = unbounded;
    for (std::size_t a = 0; a < 3; ++a) {
        const double t0 = (box[0][a] - origin[a]) * inverse[a],
                     t1 = (box[1][a] - origin[a]) * inverse[a];
        from = std::max(from, std::min(t0, t1));
        to = std::min(to, std::max(t0, t1));
    }
    return from <= to ? from : unbounded;
}

RayCaster::Hit RayCaster::cast(const Vec3& origin, const Vec3& direction) const {
    Hit best;
    if (nodes_.empty()) return best;
    Vec3 inverse{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double d = std::abs(direction[a]) < 1e-12 ? 1e-12 : direction[a];
        inverse[a] = 1 / d;
    }
    struct Entry {
        std::uint32_t node;
        double from;
    };
    std::array<Entry, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = {0, entry(nodes_[0].box, origin, inverse)};
    while (depth > 0) {
        const Entry top = stack[--depth];
        if (!(top.from <= best.distance) || top.from == unbounded) continue;
        const Node& node = nodes_[top.node];
        if (node.count == 0) {
            Entry near{top.node + 1, entry(nodes_[top.node + 1].box, origin, inverse)};
            Entry far{node.first, entry(nodes_[node.first].box, origin, inverse)};
            if (far.from < near.from) std::swap(near, far);
            stack[depth++] = far;
            stack[depth++] = near;
            continue;
        }
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            const std::uint32_t id = order_[k];
            const double t = (*parts_)[id].hit(origin, direction, headings_[id]);
            const auto part = static_cast<std::int32_t>(id);
            if (t < best.distance || (t == best.distance && t < unbounded && part < best.part))
                best = {t, part};
        }
    }
    return best;
}

double RayCaster::clearance(const Vec3& p, double most) const {
    double best = most;
    each_near(p, most, [&](std::int32_t, double distance) { best = std::min(best, distance); });
    return best;
}

}  // namespace topple::scenes
