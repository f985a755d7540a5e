// SPDX-License-Identifier: MIT
#include "solids/boundary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "solids/coherence.h"
#include "solids/combine.h"
#include "solids/matching.h"
#include "solids/solid_places.h"

namespace topple::solids {
namespace {

// In voxels, one standard error: what the solid's form is off where patches meet, bend or end.
// Found from things of known measures (docs/evaluation.md).
constexpr double patch_error = 0.025;

constexpr std::uint64_t voxel_chunk = 1 << 13;  // voxels handed to a thread at once

// Gathers what was seen of a primitive in the 27 voxels around one; voxels must come sorted, from
// (i, j, k) on.
class Around {
  public:
    Around(const SeenCells& seen, const Place& at) : seen_(seen) {
        const std::array<Place, 27> all = around(at);
        for (std::size_t column = 0; column < 9; ++column)
            from_[column] = first_at(seen, all[3 * column]);
    }

    // Adds up by patch, those of the primitive and those of others; both are emptied first.
    void gather(const Place& at, std::int32_t p, std::vector<SeenPatch>& own,
                std::vector<SeenPatch>& others) {
        own.clear();
        others.clear();
        const std::array<Place, 27> all = around(at);
        for (std::size_t column = 0; column < 9; ++column) {
            const Place &low = all[3 * column], &high = all[3 * column + 2];
            std::size_t& from = from_[column];
            while (from < seen_.size() && place_of(seen_, from) < low) ++from;
            for (std::size_t m = from; m < seen_.size() && place_of(seen_, m) <= high; ++m)
                add(m, place_of(seen_, m) == at, seen_.primitive[m] == p ? own : others);
        }
        for (std::vector<SeenPatch>* all : {&own, &others})
            for (SeenPatch& s : *all)
                for (double& v : s.mean) v /= s.count;
    }

  private:
    void add(std::size_t m, bool here, std::vector<SeenPatch>& out) const {
        const auto patch = static_cast<std::uint32_t>(seen_.patch[m]);
        auto found = std::ranges::find(out, patch, &SeenPatch::patch);
        if (found == out.end()) found = out.insert(out.end(), SeenPatch{patch});
        const double count = seen_.count[m];
        found->count += count;
        if (here) found->here += count;
        const float* at[3] = {&seen_.x[m], &seen_.y[m], &seen_.z[m]};
        for (std::size_t a = 0; a < 3; ++a) found->mean[a] += count * double{*at[a]};
    }

    const SeenCells& seen_;
    std::array<std::size_t, 9> from_{};
};

// The directions that what was seen around each cell of its primitive faces.
std::vector<std::uint8_t> faced_around(const SolidCells& cells, const SeenCells& seen,
                                       std::span<const SurfacePatch> patches,
                                       std::vector<BorderVoxel>& candidates, ThreadPool& pool) {
    std::vector<std::uint8_t> faced(cells.size(), 0), beside(cells.size(), 0);
    pool.run(cells.size(), voxel_chunk, [&](std::uint64_t first, std::uint64_t last) {
        Around seen_around(seen, place_of(cells, first));
        std::vector<SeenPatch> found, others;
        for (std::uint64_t n = first; n < last; ++n) {
            const std::int32_t p = cells.primitive[n];
            if (p < 0) continue;
            seen_around.gather(place_of(cells, n), p, found, others);
            for (const SeenPatch& s : found)
                faced[n] |= faced_by(patches[s.patch].gradient(s.mean));
            beside[n] = !found.empty();
        }
    });
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (beside[n]) candidates.push_back({place_of(cells, n), cells.primitive[n], true});
    return faced;
}

// Voxels of one primitive in which another was seen, too.
std::vector<BorderVoxel> shared(const SolidCells& cells, const SeenCells& seen) {
    std::vector<BorderVoxel> out;
    each_match(
        seen.size(), [&](std::size_t m) { return place_of(seen, m); }, cells.size(),
        [&](std::size_t n) { return place_of(cells, n); },
        [&](std::size_t m, std::size_t n) {
            if (cells.primitive[n] >= 0 && cells.primitive[n] != seen.primitive[m])
                out.push_back({place_of(seen, m), seen.primitive[m]});
        });
    return out;
}

// What mates reach, or bound of their primitive's own cells.
std::vector<BorderVoxel> border_of_mates(const SolidCells& cells, std::span<const Mate> mates) {
    std::vector<bool> own(mates.size(), false);
    each_match(
        mates.size(), [&](std::size_t m) { return mates[m].at; }, cells.size(),
        [&](std::size_t n) { return place_of(cells, n); },
        [&](std::size_t m, std::size_t n) { own[m] = cells.primitive[n] == mates[m].primitive; });
    std::vector<BorderVoxel> out;
    for (std::size_t m = 0; m < mates.size(); ++m)
        if (own[m] || mates[m].extends)
            out.push_back({mates[m].at, mates[m].primitive, own[m], !own[m]});
    return out;
}

// Of two that are sorted.
void unite(std::vector<BorderVoxel>& candidates, std::span<const BorderVoxel> more) {
    const auto middle = candidates.insert(candidates.end(), more.begin(), more.end());
    std::ranges::inplace_merge(candidates, middle, {}, &BorderVoxel::key);
    std::size_t kept = 0;
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        if (kept > 0 && candidates[kept - 1].key() == candidates[n].key()) {
            candidates[kept - 1].own = candidates[kept - 1].own || candidates[n].own;
            candidates[kept - 1].extends = candidates[kept - 1].extends || candidates[n].extends;
        } else {
            candidates[kept++] = candidates[n];
        }
    }
    candidates.resize(kept);
}

// A candidate, and a primitive whose surface is the other side of a wall there.
struct WallSide {
    std::size_t candidate;
    std::int32_t other;
};

// A wall thinner than a voxel may have its two sides in two primitives, as the inside of a cup and
// its outside: each is bounded by the other's patch, too, unless they are known to meet there.
void add_wall(std::size_t candidate, std::span<const SeenPatch> own,
              std::span<const SeenPatch> others, std::span<const SurfacePatch> patches,
              const Vec3& middle, double voxel_m, Combination& sum, std::vector<WallSide>& walls) {
    const auto meets = [&](std::int32_t other) {
        for (std::size_t s = 0; s < sum.used; ++s)
            if (sum.use[s].outside && patches[sum.slot[s]].primitive == other) return true;
        return false;
    };
    for (const SeenPatch& o : others) {
        const std::int32_t other = patches[o.patch].primitive;
        const bool wall =
            std::ranges::any_of(own, [&](const SeenPatch& s) { return are_wall(s, o, patches); });
        if (!wall || meets(other)) continue;
        add_bound(o.patch, false, patches, middle, voxel_m, sum);
        if (walls.empty() || walls.back().candidate != candidate || walls.back().other != other)
            walls.push_back({candidate, other});
    }
}

// How much a patch faces up or down.
double level(const SurfacePatch& patch, const Vec3& at) {
    const Vec3 g = patch.gradient(at);
    return std::abs(g[2]) / std::hypot(g[0], g[1], g[2]);
}

// Where faces of two primitives meet in a concave edge, as the bottom of a cup and its wall, both
// would fill the corner behind it. What stands on something ends there: of two faces the more level
// one bounds the other's primitive; its own is bounded by the other side of the wall instead.
void add_corner(std::span<const SeenPatch> own, std::span<const SeenPatch> others,
                std::span<const SurfacePatch> patches, const Vec3& middle, double voxel_m,
                Combination& sum) {
    if (own.empty() || others.empty()) return;
    const auto wall = [&](const SeenPatch& a, const SeenPatch& b) {
        return are_wall(a, b, patches);
    };
    const auto is_own = [&](const SeenPatch& s) {
        return std::ranges::any_of(own, [&](const SeenPatch& o) {
            return patches[o.patch].primitive == patches[s.patch].primitive || wall(o, s);
        });
    };
    std::vector<const SeenPatch*> mine, theirs;
    for (const SeenPatch& s : own) mine.push_back(&s);
    for (const SeenPatch& s : others) (is_own(s) ? mine : theirs).push_back(&s);
    for (const SeenPatch* o : theirs) {
        if (o->here == 0) continue;
        for (const SeenPatch* s : mine) {
            if (s->here == 0 || !are_concave(*s, *o, patches, voxel_m)) continue;
            const std::pair a(level(patches[s->patch], s->mean), s->patch),
                b(level(patches[o->patch], o->mean), o->patch);
            if (b > a) {
                add_bound(o->patch, true, patches, middle, voxel_m, sum);
                continue;
            }
            for (const SeenPatch* back : theirs)
                if (wall(*o, *back)) add_bound(back->patch, false, patches, middle, voxel_m, sum);
        }
    }
}

// What bounds each candidate, in their order; of one that nothing bounds, all is solid.
std::vector<Combination> combine_all(const SolidCells& cells, const SeenCells& seen,
                                     std::span<const SurfacePatch> patches,
                                     std::span<const Mate> mates, const std::vector<bool>& sheet,
                                     std::span<const BorderVoxel> candidates,
                                     std::vector<WallSide>& walls, ThreadPool& pool) {
    const double h = cells.voxel_m;
    std::vector<Combination> out(candidates.size());
    std::vector<std::vector<WallSide>> found_walls(candidates.size() / voxel_chunk + 1);
    pool.run(candidates.size(), voxel_chunk, [&](std::uint64_t first, std::uint64_t last) {
        const BorderVoxel& from = candidates[first];
        Around seen_around(seen, from.at);
        std::vector<WallSide>& here = found_walls[first / voxel_chunk];
        std::vector<SeenPatch> found, others;
        auto mate = std::ranges::lower_bound(mates, from.key(), {}, &Mate::key);
        for (std::uint64_t n = first; n < last; ++n) {
            const BorderVoxel& c = candidates[n];
            while (mate != mates.end() && mate->key() < c.key()) ++mate;
            const bool mates_here = mate != mates.end() && mate->key() == c.key();
            if (sheet[c.primitive] && !mates_here) continue;
            seen_around.gather(c.at, c.primitive, found, others);
            const Vec3 middle = middle_of(c.at, h);
            Combination& sum = out[n];
            sum = combine(found, patches, middle, h);
            for (auto m = mate; m != mates.end() && m->key() == c.key(); ++m)
                add_bound(m->patch, m->outside, patches, middle, h, sum);
            add_wall(n, found, others, patches, middle, h, sum, here);
            add_corner(found, others, patches, middle, h, sum);
        }
    });
    for (const auto& some : found_walls) walls.insert(walls.end(), some.begin(), some.end());
    return out;
}

// The bound of one solid by another's patch, as both know it.
struct Bound {
    Combination* of;
    std::size_t slot;
    double upright = 0;  // how much the patch faces up or down
};

// Where two solids meet at an edge, each may be bounded by a patch of the other: one of the two
// says all, and both together would leave a gap. What stands on something ends there: the level
// patch stays.
void settle_edges(std::span<const BorderVoxel> candidates, std::span<const SurfacePatch> patches,
                  double voxel_m, std::span<Combination> sums) {
    const auto bound_by = [&](std::size_t c, std::int32_t other) -> Bound {
        for (std::size_t s = 0; s < sums[c].used; ++s) {
            const SlotUse& use = sums[c].use[s];
            const SurfacePatch& patch = patches[sums[c].slot[s]];
            if (use.bounds && use.outside && patch.primitive == other)
                return {&sums[c], s, level(patch, middle_of(candidates[c].at, voxel_m))};
        }
        return {nullptr, 0};
    };
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        for (std::size_t m = n + 1; m < candidates.size() && candidates[m].at == candidates[n].at;
             ++m) {
            const Bound a = bound_by(n, candidates[m].primitive),
                        b = bound_by(m, candidates[n].primitive);
            if (!a.of || !b.of) continue;
            // Of what is nothing by its bound, nobody knows what it would be else.
            const bool drop_a = b.of->nothing || (!a.of->nothing && a.upright <= b.upright);
            const Bound& less = drop_a ? a : b;
            if (!less.of->nothing) drop_slot(less.slot, *less.of);
        }
    }
}

// Where both sides of a wall are candidates of one voxel, both say the same of it: that counts
// once, for the one whose voxel it is.
std::vector<bool> told_twice(std::span<const BorderVoxel> candidates,
                             std::span<const WallSide> walls) {
    std::vector<bool> out(candidates.size(), false);
    for (const WallSide& w : walls) {
        const BorderVoxel& c = candidates[w.candidate];
        const BorderKey key(c.at, w.other);
        const auto found = std::ranges::lower_bound(candidates, key, {}, &BorderVoxel::key);
        if (found == candidates.end() || found->key() != key) continue;
        const auto m = static_cast<std::size_t>(found - candidates.begin());
        if (c.own == found->own)
            out[std::max(m, w.candidate)] = true;
        else
            out[c.own ? m : w.candidate] = true;
    }
    return out;
}

void add_cell(const BorderVoxel& c, const Combination& sum, BoundaryCells& out) {
    out.i.push_back(c.at[0]);
    out.j.push_back(c.at[1]);
    out.k.push_back(c.at[2]);
    out.primitive.push_back(c.primitive);
    for (std::size_t s = 0; s < BoundaryCells::slots; ++s) out.slot[s].push_back(sum.slot[s]);
    out.form.push_back(make_form(sum.any_group, sum.use, sum.used));
}

}  // namespace

std::vector<std::size_t> next_cells(const SolidCells& c, std::size_t axis, std::int32_t furthest) {
    const auto place = [&](std::size_t n) { return place_of(c, n); };
    std::vector<std::size_t> out(c.size(), no_cell);
    for (std::int32_t step = 1; step <= furthest; ++step) {
        const auto stepped = [&](std::size_t n) { return moved(place(n), axis, step); };
        each_match(c.size(), stepped, c.size(), place, [&](std::size_t n, std::size_t m) {
            if (out[n] == no_cell) out[n] = m;
        });
    }
    return out;
}

BoundaryCells without_void_solids(const SolidCells& cells, BoundaryCells all,
                                  std::size_t primitives) {
    std::vector<bool> left(primitives, true);
    for (const std::int32_t p : all.primitive) left[p] = false;
    for (std::size_t b = 0; b < all.size(); ++b)
        if (all.share[b] > 0) left[all.primitive[b]] = true;
    if (std::ranges::find(left, false) == left.end()) return all;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p >= 0 && !left[p])
            left[p] = all.find(cells.i[n], cells.j[n], cells.k[n], p) == BoundaryCells::absent;
    }
    std::vector<bool> kept;
    for (const std::int32_t p : all.primitive) kept.push_back(left[p]);
    return all.only(kept);
}

BoundaryCells find_boundary(device::Device& device, const SolidCells& cells, const SeenCells& seen,
                            std::vector<SurfacePatch> patches, const std::vector<bool>& sheet,
                            std::span<const Ledge> ledges) {
    for (std::size_t n = 0; n < seen.size(); ++n)
        patches[seen.patch[n]].primitive = seen.primitive[n];
    for (SurfacePatch& p : patches)
        p.offset_m = std::hypot(p.offset_m, patch_error * cells.voxel_m);
    std::vector<BorderVoxel> candidates;
    const std::vector<std::uint8_t> faced =
        faced_around(cells, seen, patches, candidates, device.threads());
    unite(candidates, shared(cells, seen));
    const std::vector<Mate> mates =
        find_mates(cells, seen, faced, ledges, patches, device.threads());
    unite(candidates, border_of_mates(cells, mates));
    std::vector<WallSide> walls;
    std::vector<Combination> sums =
        combine_all(cells, seen, patches, mates, sheet, candidates, walls, device.threads());
    const std::vector<bool> twice = told_twice(candidates, walls);
    settle_edges(candidates, patches, cells.voxel_m, sums);
    std::vector<bool> air = air_by_patches(cells, candidates, sums);
    const std::vector<BorderVoxel> beyond = cut_off(cells, air);
    const std::vector<bool> unreached = out_of_reach(cells, candidates, sums, air);

    BoundaryCells out;
    Combination nothing;
    nothing.nothing = nothing.any_group = true;
    auto cut = beyond.begin();
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        const BorderVoxel& c = candidates[n];
        for (; cut != beyond.end() && cut->key() < c.key(); ++cut) add_cell(*cut, nothing, out);
        if (cut != beyond.end() && cut->key() == c.key()) {
            add_cell(*cut++, nothing, out);
            continue;
        }
        // What is not the primitive's cell must be bounded by something, or mates reach it.
        const Combination& sum = sums[n];
        const bool counts = c.own ? sum.nothing || sum.used > 0
                                  : !unreached[n] && !sum.nothing && (sum.used > 0 || c.extends);
        if (twice[n]) {
            if (c.own) add_cell(c, nothing, out);
        } else if (counts) {
            add_cell(c, sum, out);
        }
    }
    for (; cut != beyond.end(); ++cut) add_cell(*cut, nothing, out);
    out.patches = std::move(patches);
    measure_shares(device, cells.voxel_m, out);
    return without_void_solids(cells, std::move(out), sheet.size());
}

}  // namespace topple::solids
