// SPDX-License-Identifier: MIT
#include "export/merge_parts.h"

#include <algorithm>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "export/separate.h"

namespace topple::exports {
namespace {

// What joining may add: in all, of a body's solid; each time, of the hull of both, or, for crumbs,
// of the body's solid.
constexpr double most_of_body = 0.05, most_of_both = 0.1, crumb_of_body = 0.0005;
// How much deeper a hull may reach into other bodies than its parts do.
constexpr double deeper_m = 1e-4;

struct Pair {
    double added_m3;
    std::size_t a, b;
    // Cheapest first, then oldest, so that the order is the same everywhere.
    bool operator<(const Pair& other) const {
        return std::tie(added_m3, a, b) > std::tie(other.added_m3, other.a, other.b);
    }
};

std::optional<ConvexPart> joined(const ConvexPart& a, const ConvexPart& b) {
    std::vector<Vec3> points = a.corner;
    points.insert(points.end(), b.corner.begin(), b.corner.end());
    return hull_part(points);
}

// Each point stands for the mean of both.
void gather(const ConvexPart& a, const ConvexPart& b, ConvexPart& both) {
    both.solid = a.solid;
    both.solid.insert(both.solid.end(), b.solid.begin(), b.solid.end());
    const double solid_m3 = a.solid_each_m3 * static_cast<double>(a.solid.size()) +
                            b.solid_each_m3 * static_cast<double>(b.solid.size());
    both.solid_each_m3 = solid_m3 / std::max<double>(1, static_cast<double>(both.solid.size()));
}

class Merging {
  public:
    Merging(const Body& body, std::vector<const ConvexPart*> others, double touching_m)
        : parts_(body.parts),
          others_(std::move(others)),
          gone_(parts_.size(), false),
          touching_m_(touching_m),
          most_m3_(most_of_body * body.solid_m3),
          crumb_m3_(crumb_of_body * body.solid_m3) {}

    std::vector<ConvexPart> run() {
        for (std::size_t a = 0; a < parts_.size(); ++a)
            for (std::size_t b = a + 1; b < parts_.size(); ++b) consider(a, b);
        while (!pairs_.empty()) {
            const Pair best = pairs_.top();
            pairs_.pop();
            if (gone_[best.a] || gone_[best.b] || best.added_m3 > most_m3_) continue;
            auto both = joined(parts_[best.a], parts_[best.b]);
            if (!both || reaches_deeper(*both, parts_[best.a], parts_[best.b])) continue;
            most_m3_ -= std::max(0.0, best.added_m3);
            gather(parts_[best.a], parts_[best.b], *both);
            gone_[best.a] = gone_[best.b] = true;
            parts_.push_back(*std::move(both));
            gone_.push_back(false);
            for (std::size_t n = 0; n + 1 < parts_.size(); ++n) consider(n, parts_.size() - 1);
        }
        std::vector<ConvexPart> left;
        for (std::size_t n = 0; n < parts_.size(); ++n)
            if (!gone_[n]) left.push_back(std::move(parts_[n]));
        return left;
    }

  private:
    void consider(std::size_t a, std::size_t b) {
        if (gone_[a] || gone_[b] || !near(parts_[a], parts_[b], touching_m_)) return;
        if (apart(parts_[a], parts_[b]).gap_m > touching_m_) return;
        const auto both = joined(parts_[a], parts_[b]);
        if (!both) return;
        const double added = both->volume_m3 - parts_[a].volume_m3 - parts_[b].volume_m3;
        if (added <= std::max(most_of_both * both->volume_m3, crumb_m3_) && added <= most_m3_)
            pairs_.push({added, a, b});
    }
    bool reaches_deeper(const ConvexPart& both, const ConvexPart& a, const ConvexPart& b) const {
        return std::ranges::any_of(others_, [&](const ConvexPart* other) {
            if (!near(both, *other, 0)) return false;
            const double deep = overlap_m(both, *other);
            return deep > deeper_m &&
                   deep > deeper_m + std::max(overlap_m(a, *other), overlap_m(b, *other));
        });
    }

    std::vector<ConvexPart> parts_;
    std::vector<const ConvexPart*> others_;
    std::vector<bool> gone_;
    std::priority_queue<Pair> pairs_;
    double touching_m_, most_m3_, crumb_m3_;
};

}  // namespace

void merge_parts(std::vector<Body>& bodies, double touching_m, ThreadPool& threads) {
    std::vector<ConvexPart> around(bodies.size());
    for (std::size_t n = 0; n < bodies.size(); ++n) around[n] = box_around(bodies[n].parts);
    std::vector<std::vector<ConvexPart>> merged(bodies.size());
    threads.each(bodies.size(), 1, [&](std::size_t n) {
        std::vector<const ConvexPart*> others;
        for (std::size_t k = 0; k < bodies.size(); ++k)
            if (k != n && near(around[n], around[k], 0))
                for (const ConvexPart& part : bodies[k].parts)
                    if (near(around[n], part, 0)) others.push_back(&part);
        merged[n] = Merging(bodies[n], std::move(others), touching_m).run();
    });
    for (std::size_t n = 0; n < bodies.size(); ++n) bodies[n].parts = std::move(merged[n]);
}

}  // namespace topple::exports
