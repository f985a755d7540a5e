// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/sort_unique.h"
#include "solids/boundary.h"
#include "solids/solid_places.h"

namespace topple::solids {
namespace {

// How far, in voxels, a solid's last voxel may end from the patch at which it ends indeed.
constexpr double reach = 1.5;
constexpr double facing = 0.7;      // least cosine
constexpr std::int32_t beyond = 3;  // voxels that a patch goes on past where it was seen

struct Box {
    Place low{std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max(),
              std::numeric_limits<std::int32_t>::max()};
    Place high{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min(),
               std::numeric_limits<std::int32_t>::min()};
    void add(const Place& p) {
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], p[a]);
            high[a] = std::max(high[a], p[a]);
        }
    }
    bool meets(const Box& other) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (low[a] > std::int64_t{other.high[a]} + beyond ||
                other.low[a] > std::int64_t{high[a]} + beyond)
                return false;
        return true;
    }
};

// A face of a cell that is the border of its primitive.
struct Face {
    std::size_t cell;
    std::int32_t other;  // primitive beyond, across one empty voxel at most; -1: none
    bool faced;          // a patch of its own that was seen beside it faces that way
};

// Of each primitive and direction.
struct Side {
    std::vector<Face> faces;
    std::vector<std::int32_t> others;  // in whatever order, some more than once
    Box box;
};

class MateFinder {
  public:
    MateFinder(const SolidCells& cells, const SeenCells& seen, std::span<const std::uint8_t> faced,
               std::vector<SurfacePatch>& patches)
        : cells_(cells), faced_(faced), patches_(patches), extent_(patches.size()) {
        for (const std::vector<std::int32_t>* all : {&cells.primitive, &seen.primitive})
            for (const std::int32_t p : *all) primitives_ = std::max(primitives_, p + 1);
        of_primitive_.resize(static_cast<std::size_t>(primitives_));
        for (std::size_t n = 0; n < seen.size(); ++n) {
            const auto patch = static_cast<std::uint32_t>(seen.patch[n]);
            auto& own = of_primitive_[seen.primitive[n]];
            if (own.empty() || own.back() != patch) own.push_back(patch);
            extent_[patch].add(place_of(seen, n));
        }
        for (auto& own : of_primitive_) sort_unique(own);
    }

    void add(std::span<const Ledge> ledges) {
        for (const Ledge& l : ledges) {
            SurfacePatch level;
            level.origin = {0, 0, l.height_m};
            level.c = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
            ledges_[{l.above, l.below}].push_back(static_cast<std::uint32_t>(patches_.size()));
            patches_.push_back(level);
        }
    }

    std::vector<Mate> find(ThreadPool& threads) const {
        std::array<std::vector<Mate>, 6> found;  // by direction
        threads.each(found.size(), 1, [&](std::size_t direction) {
            add_sides(direction / 2, direction % 2 ? 1 : -1, found[direction]);
            std::ranges::sort(found[direction], {}, order_of);
        });
        std::vector<Mate> all;
        for (const std::vector<Mate>& some : found) {
            const auto middle = all.insert(all.end(), some.begin(), some.end());
            std::ranges::inplace_merge(all, middle, {}, order_of);
        }
        const auto others = std::ranges::unique(
            all, {}, [](const Mate& m) { return std::tuple(m.key(), m.patch, m.outside); });
        all.erase(others.begin(), others.end());
        return all;
    }

  private:
    static std::tuple<BorderKey, std::uint32_t, bool, bool> order_of(const Mate& m) {
        return {m.key(), m.patch, m.outside, !m.extends};
    }

    // The cell beside each, one way along an axis, across one empty voxel at most.
    std::vector<std::size_t> beside(std::size_t axis, int way) const {
        std::vector<std::size_t> next = next_cells(cells_, axis, 2);
        if (way > 0) return next;
        std::vector<std::size_t> previous(cells_.size(), no_cell);
        for (std::size_t n = 0; n < next.size(); ++n)
            if (next[n] != no_cell) previous[next[n]] = n;
        return previous;
    }

    void add_sides(std::size_t axis, int way, std::vector<Mate>& mates) const {
        const std::size_t direction = 2 * axis + (way > 0);
        const std::vector<std::size_t> beside_of = beside(axis, way);
        std::vector<Side> sides(static_cast<std::size_t>(primitives_));
        for (std::size_t n = 0; n < cells_.size(); ++n) {
            const std::int32_t p = cells_.primitive[n];
            if (p < 0) continue;
            const bool faced = (faced_[n] >> direction & 1) != 0;
            const std::size_t m = beside_of[n];
            const bool adjacent = m != no_cell && std::abs(std::int64_t{place_of(cells_, m)[axis]} -
                                                           place_of(cells_, n)[axis]) == 1;
            const std::int32_t other = m == no_cell ? -1 : cells_.primitive[m];
            // A face that was seen is where it was seen, but it may pass a voxel of another.
            if ((other == p && adjacent) || (faced && (other < 0 || other == p))) continue;
            Side& side = sides[p];
            side.faces.push_back({n, other == p ? -1 : other, faced});
            if (other >= 0 && other != p && (side.others.empty() || side.others.back() != other))
                side.others.push_back(other);
            side.box.add(place_of(cells_, n));
        }
        for (std::int32_t p = 0; p < primitives_; ++p) {
            Side& side = sides[p];
            sort_unique(side.others);
            if (!side.others.empty()) add_side(p, side, axis, way, mates);
        }
    }

    struct Candidate {
        std::uint32_t patch;
        std::int32_t other;  // -1: of any
        bool outside;
    };

    void add_side(std::int32_t p, const Side& side, std::size_t axis, int way,
                  std::vector<Mate>& mates) const {
        std::vector<Candidate> candidates;
        for (const std::uint32_t patch : of_primitive_[p]) candidates.push_back({patch, -1, false});
        for (const std::int32_t q : side.others) {
            for (const std::uint32_t patch : of_primitive_[q]) {
                if (extent_[patch].meets(side.box)) candidates.push_back({patch, q, true});
            }
            if (axis != 2) continue;
            const auto known = ledges_.find(way < 0 ? std::pair(p, q) : std::pair(q, p));
            if (known == ledges_.end()) continue;
            for (const std::uint32_t patch : known->second)
                candidates.push_back({patch, q, way < 0});
        }
        for (const Face& face : side.faces) {
            const Candidate* best = nullptr;
            double least = reach * cells_.voxel_m;
            const Vec3 at = middle_of(face.cell, axis, way);
            for (const Candidate& c : candidates) {
                if (face.other >= 0 && c.other >= 0 && c.other != face.other) continue;
                if (face.faced && c.outside) continue;
                const SurfacePatch& patch = patches_[c.patch];
                const Vec3 g = patch.gradient(at);
                const double along = (c.outside ? -way : way) * g[axis];
                if (!(along >= 0) || !(along >= facing * std::hypot(g[0], g[1], g[2]))) continue;
                const double d = std::abs(patch.distance(at));
                if (d >= least) continue;
                least = d;
                best = &c;
            }
            if (best) bound(p, face.cell, axis, way, *best, mates);
        }
    }

    Vec3 middle_of(std::size_t n, std::size_t axis, int way) const {
        Vec3 at = topple::middle_of(place_of(cells_, n), cells_.voxel_m);
        at[axis] += 0.5 * way * cells_.voxel_m;
        return at;
    }

    // Of the cells that the patch passes or leaves out inside of the primitive, and of those that
    // it reaches beyond.
    void bound(std::int32_t p, std::size_t n, std::size_t axis, int way, const Candidate& c,
               std::vector<Mate>& mates) const {
        const double h = cells_.voxel_m;
        const SurfacePatch& patch = patches_[c.patch];
        const Place from = place_of(cells_, n);
        for (std::int32_t step = -2; step <= 2; ++step) {
            const Place at = moved(from, axis, way * step);
            const Vec3 middle = topple::middle_of(at, h);
            const double d = (c.outside ? -1 : 1) * patch.distance(middle);
            const double half = reach_of(patch.gradient(middle), h);
            if (step <= 0 ? d > -half : d < half)
                mates.push_back({at, p, c.patch, c.outside, step > 0});
        }
    }

    const SolidCells& cells_;
    std::span<const std::uint8_t> faced_;
    std::vector<SurfacePatch>& patches_;
    std::vector<Box> extent_;  // of each patch, where it was seen
    std::int32_t primitives_ = 0;
    std::vector<std::vector<std::uint32_t>> of_primitive_;  // patches, ascending
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::uint32_t>> ledges_;
};

}  // namespace

std::uint8_t faced_by(const Vec3& g) {
    const double least = facing * std::hypot(g[0], g[1], g[2]);
    std::uint8_t out = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        if (g[a] <= -least) out |= static_cast<std::uint8_t>(1U << (2 * a));
        if (g[a] >= least) out |= static_cast<std::uint8_t>(1U << (2 * a + 1));
    }
    return out;
}

double reach_of(const Vec3& g, double voxel_m) {
    const double length = std::max(std::hypot(g[0], g[1], g[2]), 0.2);
    return 0.5 * voxel_m * (std::abs(g[0]) + std::abs(g[1]) + std::abs(g[2])) / length;
}

std::vector<Mate> find_mates(const SolidCells& cells, const SeenCells& seen,
                             std::span<const std::uint8_t> faced, std::span<const Ledge> ledges,
                             std::vector<SurfacePatch>& patches, ThreadPool& threads) {
    MateFinder finder(cells, seen, faced, patches);
    finder.add(ledges);
    return finder.find(threads);
}

}  // namespace topple::solids
