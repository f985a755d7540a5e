// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/place.h"
#include "topple/scene.h"

namespace topple {

// A piece of a primitive's surface: where f(p) = c0 + c1 u + c2 v + c3 w + c4 uu + c5 vv + c6 ww
// + c7 uv + c8 uw + c9 vw is 0, (u, v, w) = p - origin; f < 0 is solid, |grad f| about 1, so that
// |f| is close to the distance in metres near the surface (paper, Eqs. 1-2). Grid frame.
struct SurfacePatch {
    Vec3 origin{};
    std::array<double, 10> c{};
    double noise_m = 0;           // standard deviation of its points about it
    double offset_m = 0;          // standard error of where it lies along its normal
    std::int32_t primitive = -1;  // on whose points it was seen; -1: on nobody's

    double value(const Vec3& p) const;
    Vec3 gradient(const Vec3& p) const;
    double distance(const Vec3& p) const;  // signed, to first order
    bool flat() const;
};

// Asked of every voxel and every point, so inline.
inline double SurfacePatch::value(const Vec3& p) const {
    const double u = p[0] - origin[0], v = p[1] - origin[1], w = p[2] - origin[2];
    return c[0] + c[1] * u + c[2] * v + c[3] * w + c[4] * u * u + c[5] * v * v + c[6] * w * w +
           c[7] * u * v + c[8] * u * w + c[9] * v * w;
}

inline Vec3 SurfacePatch::gradient(const Vec3& p) const {
    const double u = p[0] - origin[0], v = p[1] - origin[1], w = p[2] - origin[2];
    return {c[1] + 2 * c[4] * u + c[7] * v + c[8] * w, c[2] + 2 * c[5] * v + c[7] * u + c[9] * w,
            c[3] + 2 * c[6] * w + c[8] * u + c[9] * v};
}

inline double SurfacePatch::distance(const Vec3& p) const {
    // On a tube's axis the gradient vanishes.
    constexpr double least = 0.2;
    const Vec3 g = gradient(p);
    return value(p) / std::max(std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]), least);
}

// How one patch bounds what is solid in a voxel. Slots that are no bounds form groups, each of
// slots in a row that ends with `last`.
struct SlotUse {
    bool outside = false;  // what is outside of the patch is meant
    bool last = false;
    bool bounds = false;  // it bounds all, whatever the groups say
};

// What bounds solids within voxels, finer than these: for each primitive and each voxel through
// which its surface passes the patches that do, and the part of the voxel that is the primitive's.
// Two primitives may share a voxel. A primitive's voxel that is not here is solid as a whole.
// Sorted by (i, j, k, primitive).
struct BoundaryCells {
    static constexpr std::size_t slots = 4;       // patches of a voxel at most
    static constexpr std::uint32_t whole = 4096;  // share of a voxel that is all solid

    std::vector<SurfacePatch> patches;
    std::vector<std::int32_t> i, j, k, primitive;
    std::array<std::vector<std::uint32_t>, slots> slot;  // patches
    std::vector<std::uint32_t> form;                     // see make_form()
    std::vector<std::uint32_t> share;                    // 4096ths of the voxel
    // Of the share about the voxel's middle, in quarters of its edge: kernel cell_share.
    std::array<std::vector<std::int32_t>, 3> moment;

    std::size_t size() const { return i.size(); }
    // visit(array...) for each array that has a value for each voxel, the same one of all of these.
    template <class Visit, class... Cells>
    static void each_array(const Visit& visit, Cells&... of) {
        each_place_array(visit, of...);
        visit(of.primitive...);
        for (std::size_t s = 0; s < slots; ++s) visit(of.slot[s]...);
        visit(of.form...);
        visit(of.share...);
        for (std::size_t a = 0; a < 3; ++a) visit(of.moment[a]...);
    }
    std::uint32_t slots_used(std::size_t n) const { return form[n] & 7; }
    // Whether one group suffices for being solid and all members of it must agree; else all groups
    // must agree, and one member of each suffices. Of a voxel without slots nothing or all is
    // solid.
    bool any_group(std::size_t n) const { return form[n] >> 3 & 1; }
    SlotUse use(std::size_t n, std::size_t s) const {
        const std::uint32_t bits = form[n] >> (4 + 3 * s);
        return {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
    }
    // Whether p, a point in voxel n or on its border, is solid; patches count as slack_m wider.
    bool solid(std::size_t n, const Vec3& p, double slack_m) const;
    // The first that is not before (vi, vj, vk, p), in the order in which they are sorted.
    std::size_t first_from(std::int32_t vi, std::int32_t vj, std::int32_t vk, std::int32_t p) const;
    static constexpr std::size_t absent = ~std::size_t{0};
    std::size_t find(std::int32_t vi, std::int32_t vj, std::int32_t vk, std::int32_t p) const;
    // Whether it is sorted and all that it refers to is there: patches, and primitives of so many.
    bool fits(std::size_t primitives) const;
    // Those that are kept, in their order, with all patches.
    BoundaryCells only(const std::vector<bool>& kept) const;
};

// The word that kernel cell_share reads.
std::uint32_t make_form(bool any_group, const std::array<SlotUse, BoundaryCells::slots>& uses,
                        std::size_t used);

}  // namespace topple
