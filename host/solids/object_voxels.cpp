// SPDX-License-Identifier: MIT
#include "solids/object_voxels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/sort_unique.h"
#include "core/vectors.h"
#include "solids/solid_places.h"

namespace topple::solids {
namespace {

// Less of a voxel than this is what noise leaves beyond a face.
constexpr std::uint32_t sliver = BoundaryCells::whole / 50;

struct Share {
    std::int32_t object, primitive;
    std::uint32_t share, most;  // of all, and of the primitive
    bool cell, whole;
};

void add(std::int32_t object, std::int32_t primitive, std::uint32_t share, bool cell,
         std::vector<Share>& to) {
    auto found = std::ranges::find(to, object, &Share::object);
    if (found == to.end())
        found = to.insert(to.end(), Share{object, primitive, 0, 0, false, false});
    if (share > found->most) {
        found->most = share;
        found->primitive = primitive;
    }
    found->share += share;
    found->cell = found->cell || cell;
}

// Finds what lies behind cells of which a patch leaves hardly anything.
class LayersBehind {
  public:
    LayersBehind(const SolidCells& cells, const BoundaryCells& boundary)
        : cells_(cells), b_(boundary), seen_on_(boundary.patches) {}

    // Fills those of one object's voxels, sorted, and returns those to be added. Where a layer of
    // single voxels goes over into the one behind, both are there, so that they hang together.
    std::vector<ObjectVoxel> fill(std::span<ObjectVoxel> voxels) const {
        std::vector<ObjectVoxel> out;
        std::vector<Step> steps;
        for (const ObjectVoxel& v : voxels) {
            if (!v.cell || (v.filled && !is_thin(v))) continue;
            const std::optional<Step> step = behind(v);
            if (!step) continue;
            const ObjectVoxel* there = find_at(voxels, moved(v.at, step->axis, step->sign));
            if ((!there || !there->filled) && !is_edge(voxels, *step)) steps.push_back(*step);
        }
        const auto take = [&](const ObjectVoxel& like, const Place& at) {
            if (ObjectVoxel* there = find_at(voxels, at))
                there->filled = true;
            else if (!is_cell(at))
                out.push_back({like.object, like.primitive, at, 0, 0, false, true, true});
        };
        for (const Step& s : steps) take(*s.from, moved(s.from->at, s.axis, s.sign));
        for (const Step& s : steps) {
            if (s.from->filled) continue;
            for (std::size_t to = 1; to <= 2; ++to) {
                for (const std::int32_t side : {-1, 1}) {
                    const Place beside = moved(s.from->at, (s.axis + to) % 3, side);
                    const ObjectVoxel* found = find_at(voxels, beside);
                    if (found && found->filled) take(*found, moved(beside, s.axis, s.sign));
                }
            }
        }
        sort_unique(out, &ObjectVoxel::at);
        return out;
    }

  private:
    // From a voxel to the one behind it.
    struct Step {
        const ObjectVoxel* from;
        Vec3 normal;  // of the patch between
        std::size_t axis;
        std::int32_t sign;
    };
    static ObjectVoxel* find_at(std::span<ObjectVoxel> voxels, const Place& at) {
        const auto found = std::ranges::lower_bound(voxels, at, {}, &ObjectVoxel::at);
        return found != voxels.end() && found->at == at ? &*found : nullptr;
    }

    // Whether one patch bounds a voxel, or may, and nobody knows where its other side is.
    bool is_thin(const ObjectVoxel& v) const {
        if (v.whole) return true;
        return v.last == v.first + 1 && b_.slots_used(v.first) == 1 &&
               b_.share[v.first] < BoundaryCells::whole / 2;
    }
    // To the other side of the primitive's patch beside it.
    std::optional<Step> behind(const ObjectVoxel& v) const {
        std::optional<Step> out;
        double nearest = std::numeric_limits<double>::infinity();
        for (const std::uint32_t n : seen_on_(v.primitive)) {
            const std::optional<Beside> b = beside(b_.patches[n], v.at);
            if (!b || b->away >= nearest) continue;
            nearest = b->away;
            std::size_t axis = 0;
            for (std::size_t a = 1; a < 3; ++a)
                if (std::abs(b->normal[a]) > std::abs(b->normal[axis])) axis = a;
            out = Step{&v, b->normal, axis, b->normal[axis] > 0 ? -1 : 1};
        }
        return out;
    }
    // Whether a patch that bounds voxels around faces elsewhere and passes here, too: then the
    // solid ends here.
    bool is_edge(std::span<ObjectVoxel> voxels, const Step& step) const {
        constexpr double same = 0.85;  // cosine
        const Place &at = step.from->at, next = moved(at, step.axis, step.sign);
        const auto ends = [&](std::size_t n) {
            for (std::size_t s = 0; s < b_.slots_used(n); ++s) {
                for (const Place& p : {at, next}) {
                    const std::optional<Beside> b = beside(b_.patches[b_.slot[s][n]], p);
                    if (b && dot(b->normal, step.normal) < same) return true;
                }
            }
            return false;
        };
        for (const Place& near : around(at)) {
            const ObjectVoxel* v = find_at(voxels, near);
            if (!v) continue;
            for (std::size_t m = v->first; m < v->last; ++m)
                if (b_.primitive[m] == step.from->primitive && ends(m)) return true;
        }
        return false;
    }
    // The normal of a patch outside of which a voxel's middle is, if it passes the voxel or nearly
    // so, and how far away it is.
    struct Beside {
        double away;
        Vec3 normal;
    };
    std::optional<Beside> beside(const SurfacePatch& patch, const Place& at) const {
        constexpr double slack = 0.1;  // voxels
        const double h = cells_.voxel_m;
        const Vec3 middle = middle_of(at, h);
        const double d = patch.distance(middle);
        if (d < 0 || d > h) return std::nullopt;
        const Vec3 g = unit(patch.gradient(middle));
        const double reach = (std::abs(g[0]) + std::abs(g[1]) + std::abs(g[2])) / 2 + slack;
        if (d > reach * h) return std::nullopt;
        return Beside{d, g};
    }
    bool is_cell(const Place& at) const {
        const std::size_t n = first_at(cells_, at);
        return n < cells_.size() && place_of(cells_, n) == at;
    }

    const SolidCells& cells_;
    const BoundaryCells& b_;
    PatchesSeenOn seen_on_;
};

// Gives each object the layers behind its own.
void add_layers_behind(const SolidCells& cells, const BoundaryCells& boundary,
                       std::vector<ObjectVoxel>& voxels) {
    const LayersBehind layers(cells, boundary);
    std::vector<ObjectVoxel> all;
    for (std::size_t first = 0, last = 0; first < voxels.size(); first = last) {
        while (last < voxels.size() && voxels[last].object == voxels[first].object) ++last;
        const auto own = std::span(voxels).subspan(first, last - first);
        const std::vector<ObjectVoxel> added = layers.fill(own);
        std::ranges::merge(own, added, std::back_inserter(all), {}, &ObjectVoxel::at,
                           &ObjectVoxel::at);
    }
    voxels = std::move(all);
}

}  // namespace

std::vector<ObjectVoxel> object_voxels(const SolidCells& cells, const BoundaryCells& b,
                                       std::span<const std::int32_t> object_of_primitive) {
    const auto object = [&](std::int32_t p) { return object_of(p, object_of_primitive); };
    std::vector<ObjectVoxel> out;
    std::vector<Share> here;
    each_solid_place(
        cells, b, [&](const Place& at, std::size_t n, std::size_t first, std::size_t last) {
            bool bounded = false;
            here.clear();
            for (std::size_t m = first; m < last; ++m) {
                const bool own = n != no_cell && b.primitive[m] == cells.primitive[n];
                add(object(b.primitive[m]), b.primitive[m], b.share[m], own, here);
                bounded = bounded || own;
            }
            if (n != no_cell && !bounded) {
                const std::int32_t p = cells.primitive[n];
                add(object(p), p, BoundaryCells::whole, true, here);
                std::ranges::find(here, object(p), &Share::object)->whole = true;
            }
            for (const Share& s : here) {
                if (s.share == 0 && !s.cell) continue;
                out.push_back({s.object, s.primitive, at, static_cast<std::uint32_t>(first),
                               static_cast<std::uint32_t>(last), s.cell, s.whole,
                               s.share >= sliver});
            }
        });
    std::ranges::stable_sort(out, {}, &ObjectVoxel::object);
    add_layers_behind(cells, b, out);
    return out;
}

}  // namespace topple::solids
