// SPDX-License-Identifier: MIT
#include "solids/combine.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "solids/boundary.h"

namespace topple::solids {
namespace {

// A patch on the side of a voxel passes it, and a curved one may although it is flat in the middle:
// of its edge.
constexpr double on_side = 0.02, bulge = 0.05;

enum class Fate : std::uint8_t { passes, solid, air };

struct Leaf {
    const SeenPatch* seen;
    Fate fate;
};

Fate fate_of(const SurfacePatch& patch, const Vec3& middle, double voxel_m) {
    const double d = patch.distance(middle);
    const double half = reach_of(patch.gradient(middle), voxel_m);
    const double rim = half + (patch.flat() ? on_side : bulge) * voxel_m;
    return d <= -rim ? Fate::solid : d >= rim ? Fate::air : Fate::passes;
}

// The mean of points of a bent surface lies beside it.
Vec3 onto(const SurfacePatch& patch, Vec3 p) {
    constexpr int steps = 3;
    for (int step = 0; step < steps && !patch.flat(); ++step) {
        const Vec3 g = patch.gradient(p);
        const double length = std::hypot(g[0], g[1], g[2]), d = patch.distance(p);
        if (!(length > 0)) break;
        for (std::size_t a = 0; a < 3; ++a) p[a] -= d * g[a] / length;
    }
    return p;
}

enum class Relation : std::uint8_t { both, either, first, second };

// How far off a patch what lies on it may seem to be.
double tolerance(const SurfacePatch& a, const SurfacePatch& b, double voxel_m) {
    return 2 * (a.noise_m + b.noise_m) + 0.02 * voxel_m;
}

// Of two patches whose edge is convex each lies inside of the other. Parallel ones at a step lie
// one in and one out: the one of which more was seen in the voxel is there.
Relation relation(const SeenPatch& a, const SeenPatch& b, std::span<const SurfacePatch> patches,
                  double voxel_m) {
    const SurfacePatch &pa = patches[a.patch], &pb = patches[b.patch];
    const double of_a = pb.distance(a.mean), of_b = pa.distance(b.mean);
    const double least = tolerance(pa, pb, voxel_m);
    if (of_a * of_b < 0 && std::min(std::abs(of_a), std::abs(of_b)) > least) {
        constexpr double parallel = 0.9;  // cosine
        const Vec3 ga = pa.gradient(a.mean), gb = pb.gradient(b.mean);
        const double product = ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2];
        const double lengths = std::hypot(ga[0], ga[1], ga[2]) * std::hypot(gb[0], gb[1], gb[2]);
        if (product > parallel * lengths)
            return std::pair(a.here, a.count) >= std::pair(b.here, b.count) ? Relation::first
                                                                            : Relation::second;
    }
    return of_a + of_b > least ? Relation::either : Relation::both;
}

// The patches as "and" and "or" of one another, where that can be written so (a cograph); else as
// the "and" of them.
class Tree {
  public:
    Tree(std::vector<Leaf> leaves, std::span<const SurfacePatch> patches, double voxel_m)
        : leaves_(std::move(leaves)) {
        drop_hidden(patches, voxel_m);
        const std::size_t n = leaves_.size();
        either_.assign(n * n, false);
        for (std::size_t a = 0; a < n; ++a) {
            for (std::size_t b = a + 1; b < n; ++b) {
                const bool either = relation(*leaves_[a].seen, *leaves_[b].seen, patches,
                                             voxel_m) == Relation::either;
                either_[a * n + b] = either_[b * n + a] = either;
            }
        }
    }

    // Groups of leaves: all of them must hold, each by one of its members, or, if `any_group`, one
    // of them by all of its members.
    struct Groups {
        bool any_group = false;
        std::vector<std::vector<std::size_t>> members;
    };
    Groups groups() const {
        std::vector<std::size_t> all;
        for (std::size_t n = 0; n < leaves_.size(); ++n) all.push_back(n);
        Groups out;
        out.members = components(all, true);
        if (out.members.size() > 1 || all.size() == 1) return out;
        // All hang together by "either": are they groups of "both"?
        auto other = components(all, false);
        if (other.size() > 1) return {true, std::move(other)};
        out.members.clear();
        for (const std::size_t n : all) out.members.push_back({n});
        return out;
    }
    const Leaf& leaf(std::size_t n) const { return leaves_[n]; }
    bool empty() const { return leaves_.empty(); }

  private:
    void drop_hidden(std::span<const SurfacePatch> patches, double voxel_m) {
        for (std::size_t a = 0; a < leaves_.size(); ++a) {
            for (std::size_t b = a + 1; b < leaves_.size();) {
                const Relation r = relation(*leaves_[a].seen, *leaves_[b].seen, patches, voxel_m);
                if (r == Relation::second) std::swap(leaves_[a], leaves_[b]);
                if (r == Relation::first || r == Relation::second)
                    leaves_.erase(leaves_.begin() + static_cast<std::ptrdiff_t>(b));
                else
                    ++b;
            }
        }
    }

    std::vector<std::vector<std::size_t>> components(const std::vector<std::size_t>& of,
                                                     bool either) const {
        std::vector<std::vector<std::size_t>> out;
        std::vector<bool> taken(leaves_.size(), false);
        for (const std::size_t first : of) {
            if (taken[first]) continue;
            std::vector<std::size_t> group{first};
            taken[first] = true;
            for (std::size_t at = 0; at < group.size(); ++at) {
                for (const std::size_t n : of) {
                    if (taken[n] || either_[group[at] * leaves_.size() + n] != either) continue;
                    taken[n] = true;
                    group.push_back(n);
                }
            }
            out.push_back(std::move(group));
        }
        return out;
    }

    std::vector<Leaf> leaves_;
    std::vector<bool> either_;
};

}  // namespace

Combination combine(std::span<const SeenPatch> seen, std::span<const SurfacePatch> patches,
                    const Vec3& middle, double voxel_m) {
    std::vector<Leaf> leaves;
    for (const SeenPatch& s : seen)
        leaves.push_back({&s, fate_of(patches[s.patch], middle, voxel_m)});
    // The nearest ones, of which most was seen.
    std::ranges::stable_sort(leaves, [&](const Leaf& a, const Leaf& b) {
        return std::tuple(-a.seen->here, -a.seen->count) <
               std::tuple(-b.seen->here, -b.seen->count);
    });
    if (leaves.size() > BoundaryCells::slots) leaves.resize(BoundaryCells::slots);
    Combination out;
    if (leaves.empty()) return out;
    const Tree tree(std::move(leaves), patches, voxel_m);
    const Tree::Groups groups = tree.groups();
    out.any_group = groups.any_group;
    // What holds everywhere, or nowhere, in the voxel decides its group, or drops out of it.
    const Fate decides = out.any_group ? Fate::air : Fate::solid;
    bool decided = false;
    for (const std::vector<std::size_t>& group : groups.members) {
        const auto fate = [&](std::size_t n) { return tree.leaf(n).fate; };
        if (std::ranges::any_of(group, [&](std::size_t n) { return fate(n) == decides; })) continue;
        const std::size_t before = out.used;
        for (const std::size_t n : group) {
            if (fate(n) != Fate::passes) continue;
            out.slot[out.used] = tree.leaf(n).seen->patch;
            ++out.used;
        }
        if (out.used == before) {
            decided = true;  // none of its members holds, or all do
            break;
        }
        out.use[out.used - 1].last = true;
    }
    if (decided) {
        out.used = 0;
        out.use = {};
        out.nothing = !out.any_group;
    } else if (out.used == 0) {
        out.nothing = out.any_group;
    }
    if (out.used == 0) out.any_group = out.nothing;
    return out;
}

void add_bound(std::uint32_t patch, bool outside, std::span<const SurfacePatch> patches,
               const Vec3& middle, double voxel_m, Combination& sum) {
    if (sum.nothing) return;  // by what was seen, or by another
    Fate fate = fate_of(patches[patch], middle, voxel_m);
    if (outside && fate != Fate::passes) fate = fate == Fate::solid ? Fate::air : Fate::solid;
    if (fate == Fate::solid) return;
    if (fate == Fate::air) {
        // It alone says so.
        sum = {};
        sum.nothing = true;
        sum.slot[0] = patch;
        sum.use[0] = {outside, false, true};
        sum.used = 1;
        return;
    }
    if (sum.used == BoundaryCells::slots) return;
    for (std::size_t s = 0; s < sum.used; ++s)
        if (sum.slot[s] == patch && sum.use[s].outside == outside) return;
    sum.slot[sum.used] = patch;
    sum.use[sum.used] = {outside, false, true};
    ++sum.used;
}

bool are_wall(const SeenPatch& a, const SeenPatch& b, std::span<const SurfacePatch> patches) {
    constexpr double away = -0.7;  // cosine
    const SurfacePatch &pa = patches[a.patch], &pb = patches[b.patch];
    const Vec3 on_a = onto(pa, a.mean), on_b = onto(pb, b.mean);
    const Vec3 ga = pa.gradient(on_a), gb = pb.gradient(on_b);
    const double product = ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2];
    const double lengths = std::hypot(ga[0], ga[1], ga[2]) * std::hypot(gb[0], gb[1], gb[2]);
    return product < away * lengths && pa.distance(on_b) < 0 && pb.distance(on_a) < 0;
}

bool are_concave(const SeenPatch& a, const SeenPatch& b, std::span<const SurfacePatch> patches,
                 double voxel_m) {
    const SurfacePatch &pa = patches[a.patch], &pb = patches[b.patch];
    const double least = tolerance(pa, pb, voxel_m);
    return pa.distance(onto(pb, b.mean)) > least && pb.distance(onto(pa, a.mean)) > least;
}

void drop_slot(std::size_t slot, Combination& sum) {
    for (std::size_t s = slot; s + 1 < sum.used; ++s) {
        sum.slot[s] = sum.slot[s + 1];
        sum.use[s] = sum.use[s + 1];
    }
    --sum.used;
}

}  // namespace topple::solids
