// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/free_space.h"
#include "geometry/surfels.h"

namespace topple::geometry {

// Implicit algebraic model of degree 1 or 2 (paper, Eqs. 1-2): f(p) = q' A q with q = (1, x, y, z)
// about `origin`; f < 0 is inside, the sensor's side is outside; |f| is close to the distance in
// metres near the surface.
struct AlgebraicModel {
    int degree = 1;
    Vec3 origin{};
    // 1, x, y, z, xx, yy, zz, xy, xz, yz; the last six are zero for degree 1
    std::array<double, 10> coefficients{};
    double value(double x, double y, double z) const;
};

struct Region {
    AlgebraicModel model;
    double residual_m = 0;  // rms
    std::uint64_t surfels = 0;
};

// Over-segmentation into planar and quadric regions (paper, 2.1.1). label: region of each surfel,
// -1 for surfels that fit none.
struct Regions {
    std::vector<std::int32_t> label;
    std::vector<Region> regions;
};
Regions split(const Surfels& surfels, ThreadPool& threads);

// The cuts that a region lies beside, and on which side of each.
using CutSides = std::vector<std::pair<std::uint32_t, bool>>;
bool on_two_sides(const CutSides& a, const CutSides& b);  // of one cut

// Convexly connected regions merged into primitives (paper, 2.1.2, Eq. 3). label: primitive of each
// surfel, -1 for none; ids by falling size. model: "plane" | "quadric" | "merged". Planes that
// belong to several solids whose faces happen to be flush are cut first, and stacks of solids at
// their ledges: the regions of a primitive are counted after that. up: towards which things stand
// on one another, unit. free: where the sensor looked through.
struct PrimitiveSet {
    std::vector<std::int32_t> label;
    std::vector<std::string> model;
    std::vector<std::vector<std::int32_t>> regions;  // of each primitive, of those in `faces`
    Regions faces;                                   // the regions after cutting
    std::vector<CutSides> ledges;                    // of each of `faces`
};
PrimitiveSet merge_convex(const Surfels& surfels, const Regions& regions, const Vec3& up,
                          const FreeSpace& free, ThreadPool& threads);

// Whether a ledge parts the faces of two surfels.
bool ledge_between(const PrimitiveSet& primitives, std::size_t i, std::size_t j);

// Whether the surface goes on smoothly from one surfel to the other: the models of their faces
// agree around them, and no ledge is between.
bool in_one_surface(const Surfels& surfels, const PrimitiveSet& primitives, std::size_t i,
                    std::size_t j);

}  // namespace topple::geometry
