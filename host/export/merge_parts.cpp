// SPDX-License-Identifier: MIT
#include "export/merge_parts.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "core/vectors.h"
#include "export/separate.h"
#include "export/simplify.h"

namespace topple::exports {
namespace {

// What joining may add: in all, of a body's solid; each time, of the hull of both; or for crumbs,
// of the body's solid; or a layer of so many voxels over half of the hull's surface, which is less
// than where the scan saw the surface to be.
constexpr double most_of_body = 0.15, most_of_both = 0.1, crumb_of_body = 0.0005;
constexpr double layer_voxels = 0.25;
// How much deeper a hull may reach into other bodies than its parts do.
constexpr double deeper_m = 1e-4;

struct Pair {
    double added_m3;
    std::size_t a, b;
    std::size_t hull = 0;  // of both, among those that were found
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

// A part and the area of each of its faces.
struct Faced {
    explicit Faced(ConvexPart of) : part(std::move(of)), area_m2(face_areas(part)) {}
    double surface_m2() const { return std::accumulate(area_m2.begin(), area_m2.end(), 0.0); }

    ConvexPart part;
    std::vector<double> area_m2;
};

// What the hull of both holds at least: one, and the cone from it to a corner of the other.
double least_hull_m3(const Faced& one, const Faced& other) {
    double most = 0;
    for (const Vec3& c : other.part.corner) {
        double cone = 0;
        for (std::size_t n = 0; n < one.area_m2.size(); ++n) {
            const HalfSpace& side = one.part.face[n];
            cone += std::max(0.0, dot(side.normal, c) - side.offset_m) * one.area_m2[n];
        }
        most = std::max(most, cone);
    }
    return one.part.volume_m3 + most / 3;
}

// Each point stands for the mean of both. As many as one part has at most are enough.
void gather(const ConvexPart& a, const ConvexPart& b, ConvexPart& both) {
    const double solid_m3 = a.solid_each_m3 * static_cast<double>(a.solid.size()) +
                            b.solid_each_m3 * static_cast<double>(b.solid.size());
    const std::size_t count = a.solid.size() + b.solid.size();
    const std::size_t step = std::max<std::size_t>(1, (count + most_points - 1) / most_points);
    for (std::size_t n = 0; n < count; n += step)
        both.solid.push_back(n < a.solid.size() ? a.solid[n] : b.solid[n - a.solid.size()]);
    both.solid_each_m3 = solid_m3 / std::max<double>(1, static_cast<double>(both.solid.size()));
}

class Merging {
  public:
    Merging(const Body& body, std::vector<const ConvexPart*> others, double voxel_m)
        : others_(std::move(others)),
          gone_(body.parts.size(), false),
          voxel_m_(voxel_m),
          most_m3_(most_of_body * body.solid_m3),
          crumb_m3_(crumb_of_body * body.solid_m3) {
        for (const ConvexPart& part : body.parts) parts_.emplace_back(part);
    }

    std::vector<ConvexPart> run(ThreadPool& threads) {
        std::vector<std::vector<Joined>> with(parts_.size());
        threads.each(parts_.size(), 1, [&](std::size_t a) {
            for (std::size_t b = a + 1; b < parts_.size(); ++b)
                if (auto both = joined_if_worth(a, b)) with[a].push_back(*std::move(both));
        });
        for (std::vector<Joined>& each : with)
            for (Joined& both : each) add(std::move(both));
        while (!pairs_.empty()) {
            const Pair best = pairs_.top();
            pairs_.pop();
            ConvexPart both = std::move(hulls_[best.hull]);
            if (gone_[best.a] || gone_[best.b] || best.added_m3 > most_m3_) continue;
            const ConvexPart &a = parts_[best.a].part, &b = parts_[best.b].part;
            if (reaches_deeper(both, a, b)) continue;
            most_m3_ -= std::max(0.0, best.added_m3);
            gather(a, b, both);
            gone_[best.a] = gone_[best.b] = true;
            parts_.emplace_back(simplified(std::move(both), fine_voxels * voxel_m_));
            gone_.push_back(false);
            for (std::size_t n = 0; n + 1 < parts_.size(); ++n)
                if (auto pair = joined_if_worth(n, parts_.size() - 1)) add(*std::move(pair));
        }
        std::vector<ConvexPart> left;
        for (std::size_t n = 0; n < parts_.size(); ++n)
            if (!gone_[n]) left.push_back(std::move(parts_[n].part));
        return left;
    }

  private:
    struct Joined {
        Pair pair;
        ConvexPart both;
    };
    std::optional<Joined> joined_if_worth(std::size_t first, std::size_t second) const {
        if (gone_[first] || gone_[second]) return std::nullopt;
        const ConvexPart &a = parts_[first].part, &b = parts_[second].part;
        if (!near(a, b, voxel_m_)) return std::nullopt;
        const double apart_m3 = a.volume_m3 + b.volume_m3;
        const double most_m3 = std::max(apart_m3 / (1 - most_of_both), apart_m3 + crumb_m3_);
        // A hull has hardly more surface than both.
        const double surface_m2 = parts_[first].surface_m2() + parts_[second].surface_m2();
        if (std::max(least_hull_m3(parts_[first], parts_[second]),
                     least_hull_m3(parts_[second], parts_[first])) >
            std::max(most_m3, apart_m3 + layer_m3(surface_m2)))
            return std::nullopt;
        if (apart(a, b).gap_m > voxel_m_) return std::nullopt;
        auto both = joined(a, b);
        if (!both) return std::nullopt;
        const double added = both->volume_m3 - apart_m3;
        if (added > most_m3_) return std::nullopt;
        if (both->volume_m3 > most_m3 && added > layer_m3(Faced(*both).surface_m2()))
            return std::nullopt;
        return Joined{{added, first, second}, *std::move(both)};
    }
    void add(Joined found) {
        found.pair.hull = hulls_.size();
        pairs_.push(found.pair);
        hulls_.push_back(std::move(found.both));
    }
    double layer_m3(double surface_m2) const { return layer_voxels * voxel_m_ * surface_m2 / 2; }
    bool reaches_deeper(const ConvexPart& both, const ConvexPart& a, const ConvexPart& b) const {
        return std::ranges::any_of(others_, [&](const ConvexPart* other) {
            if (!near(both, *other, 0)) return false;
            const double deep = overlap_m(both, *other);
            return deep > deeper_m &&
                   deep > deeper_m + std::max(overlap_m(a, *other), overlap_m(b, *other));
        });
    }

    std::vector<Faced> parts_;
    std::vector<const ConvexPart*> others_;
    std::vector<bool> gone_;
    std::priority_queue<Pair> pairs_;
    std::vector<ConvexPart> hulls_;
    double voxel_m_, most_m3_, crumb_m3_;
};

}  // namespace

void merge_parts(std::vector<Body>& bodies, double voxel_m, ThreadPool& threads) {
    std::vector<Extents<double>> around(bodies.size());
    for (std::size_t n = 0; n < bodies.size(); ++n) around[n] = box_around(bodies[n].parts);
    std::vector<std::vector<ConvexPart>> merged(bodies.size());
    std::vector<std::size_t> sizes;
    for (const Body& body : bodies) sizes.push_back(body.parts.size());
    threads.each_largest_first(sizes, [&](std::size_t n) {
        std::vector<const ConvexPart*> others;
        for (std::size_t k = 0; k < bodies.size(); ++k)
            if (k != n && near(around[n], around[k], 0))
                for (const ConvexPart& part : bodies[k].parts)
                    if (near(around[n], part, 0)) others.push_back(&part);
        merged[n] = Merging(bodies[n], std::move(others), voxel_m).run(threads);
    });
    for (std::size_t n = 0; n < bodies.size(); ++n) bodies[n].parts = std::move(merged[n]);
}

}  // namespace topple::exports
