// SPDX-License-Identifier: MIT
#include "solids/facets.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/vectors.h"

namespace topple::solids {
namespace {

constexpr double beyond_side = 0.25;  // how far beyond a side its patch may lie, in voxels

// Where a line along an axis crosses a patch, from `start`.
std::array<double, 2> crossings(const SurfacePatch& patch, const Vec3& start, std::size_t axis) {
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    const double a = patch.c[4 + axis], b = patch.gradient(start)[axis], c = patch.value(start),
                 root = b * b - 4 * a * c;
    if (!(root >= 0)) return {nowhere, nowhere};
    const double q = -0.5 * (b + std::copysign(std::sqrt(root), b));
    return {a != 0 ? q / a : nowhere, q != 0 ? c / q : nowhere};
}

}  // namespace

Vec3 outwards(const Facet& facet, std::span<const SurfacePatch> patches, const Vec3& at) {
    Vec3 g = patches[facet.patch].gradient(at);
    if (facet.outside)
        for (double& v : g) v = -v;
    return g;
}

ObjectEntries::ObjectEntries(const BoundaryCells& boundary,
                             std::span<const std::int32_t> object_of_primitive, double voxel_m)
    : b_(boundary), object_of_(object_of_primitive), h_(voxel_m), seen_on_(boundary.patches) {}

template <class Do>
void ObjectEntries::each(const ObjectVoxel& voxel, Do what) const {
    for (std::size_t n = voxel.first; n < voxel.last; ++n)
        if (object_of(b_.primitive[n], object_of_) == voxel.object) what(n);
}

std::optional<Facet> ObjectEntries::way_out(const ObjectVoxel& voxel, const Vec3& start,
                                            std::size_t axis, int sign, double end) const {
    std::optional<Facet> out;
    const double step = 1e-3 * h_;
    double last = -(1 + beyond_side) * h_;
    each(voxel, [&](std::size_t n) {
        for (std::size_t s = 0; s < b_.slots_used(n); ++s) {
            const SurfacePatch& patch = b_.patches[b_.slot[s][n]];
            for (const double along : crossings(patch, start, axis)) {
                const double t = sign * along;
                if (!(t > last) || t > end) continue;
                Vec3 before = start, after = start;
                before[axis] += sign * (t - step);
                after[axis] += sign * (t + step);
                if (!solid(voxel, before, 0) || solid(voxel, after, 0)) continue;
                last = t;
                out = Facet{b_.slot[s][n], b_.use(n, s).outside};
            }
        }
    });
    return out;
}

void ObjectEntries::middles(const ObjectVoxel& voxel, std::vector<Vec3>& out) const {
    std::vector<std::size_t> entries;
    each(voxel, [&](std::size_t n) {
        if (b_.share[n] > 0) entries.push_back(n);
    });
    std::ranges::stable_sort(entries, std::greater{}, [&](std::size_t n) { return b_.share[n]; });
    out.clear();
    for (const std::size_t n : entries) {
        Vec3 at{};
        for (std::size_t a = 0; a < 3; ++a)
            at[a] = (voxel.at[a] + 0.5 + b_.moment[a][n] / (4.0 * b_.share[n])) * h_;
        out.push_back(at);
    }
}

std::optional<Facet> ObjectEntries::beside(std::int32_t primitive, const Vec3& at, std::size_t axis,
                                           int sign) const {
    constexpr double facing = 0.3;  // cosine
    std::optional<Facet> out;
    double least = h_;
    for (const std::uint32_t n : seen_on_(primitive)) {
        const double away = std::abs(b_.patches[n].distance(at));
        if (away >= least) continue;
        const Vec3 g = b_.patches[n].gradient(at);
        if (sign * g[axis] < facing * length(g)) continue;
        least = away;
        out = Facet{n, false};
    }
    return out;
}

bool ObjectEntries::solid(const ObjectVoxel& voxel, const Vec3& p, double slack_m) const {
    bool any = voxel.whole;
    each(voxel, [&](std::size_t n) { any = any || b_.solid(n, p, slack_m); });
    return any;
}

void ObjectEntries::add_patches(const ObjectVoxel& voxel, std::vector<std::uint32_t>& out) const {
    each(voxel, [&](std::size_t n) {
        for (std::size_t s = 0; s < b_.slots_used(n); ++s) out.push_back(b_.slot[s][n]);
    });
}

namespace {

Facet facet_of(const VoxelFace& face, std::span<const ObjectVoxel> voxels,
               const ObjectEntries& entries, std::vector<Vec3>& starts) {
    const double h = entries.voxel_m();
    const ObjectVoxel& voxel = voxels[face.voxel];
    const std::size_t axis = face.axis();
    const double side = (voxel.at[axis] + face.direction % 2) * h;
    const auto end = [&](const Vec3& start) {
        return face.sign() * (side - start[axis]) + beyond_side * h;
    };
    Vec3 middle = middle_of(voxel.at, h);
    std::optional<Facet> found;
    if (!voxel.whole) {
        entries.middles(voxel, starts);
        for (const Vec3& start : starts) {
            found = entries.way_out(voxel, start, axis, face.sign(), end(start));
            if (found) break;
        }
    }
    // A patch that lies in the side itself may bound the sliver behind it only.
    if (!found && face.beyond != no_voxel)
        found = entries.way_out(voxels[face.beyond], middle, axis, face.sign(), end(middle));
    if (!found && voxel.whole) {
        middle[axis] = side;
        found = entries.beside(voxel.primitive, middle, axis, face.sign());
    }
    Facet out = found.value_or(Facet{});
    out.primitive = voxel.primitive;
    out.direction = face.direction;
    return out;
}

}  // namespace

std::vector<Facet> find_facets(std::span<const ObjectVoxel> voxels,
                               std::span<const VoxelFace> faces, const ObjectEntries& entries,
                               ThreadPool& pool) {
    constexpr std::uint64_t chunk = 1 << 11;
    std::vector<Facet> out(faces.size());
    pool.run(faces.size(), chunk, [&](std::uint64_t first, std::uint64_t last) {
        std::vector<Vec3> starts;
        for (std::uint64_t f = first; f < last; ++f)
            out[f] = facet_of(faces[f], voxels, entries, starts);
    });
    return out;
}

}  // namespace topple::solids
