// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/face_limits.h"
#include "geometry/free_space.h"
#include "geometry/segmentation.h"

// The steps of merge_convex() (paper, 2.1.2).
namespace topple::geometry {

// Eq. 3: share of the points of segments that must lie inside both models, delta_2. The paper's.
inline constexpr double least_inside_share = 0.6;
// Least length of the border of two regions that meet, over the square root of the smaller one's
// surfels: that of one side of a square, so that what touches at a corner or a stretch is not one.
inline constexpr double least_border = 1;
// Surfels below which a part of a face is no face by itself: half as many again as a region has at
// least. Set by hand.
inline constexpr std::uint32_t least_piece = least_region + least_region / 2;
// Pieces of one face with something standing against the gap between them: the widest gap, metres.
// Boards, posts and books' spines are narrower. Set by hand.
inline constexpr double widest_face_gap_m = 0.12;

// Regions with their flush faces cut. members: the surfels of each region, ascending. flush,
// ledges: for each region the cuts of that kind that it lies beside, and on which side.
struct CutRegions {
    Regions regions;
    std::vector<std::vector<std::uint32_t>> members;
    std::vector<CutSides> flush, ledges;
    std::uint32_t count = 0;  // of cuts of either kind
    // Nothing is cut yet.
    explicit CutRegions(const Regions& regions);
    // Whether a cut parts two regions.
    bool parted(std::size_t a, std::size_t b) const;
    // Makes some of a region's surfels, ascending, a region of their own with the same sides; both
    // are fitted anew. Returns its number.
    std::size_t take_out(const Surfels& surfels, std::size_t region,
                         std::vector<std::uint32_t> part);
};

// What a region looks like from outside: evenly drawn points moved onto the model, with its
// normals.
struct RegionSamples {
    std::vector<Eigen::Vector3d> points, normals;
    double tolerance_m = 0;  // beyond what noise moves a point
};
RegionSamples sample_region(const Surfels& surfels, const CutRegions& cuts, std::size_t region);

// Two regions that touch. a < b; `pairs` are adjacent surfels, the first in a, the second in b,
// ascending. length: number of the pairs as a multiple of the square root of the smaller region's
// surfels. inside_share: 0 where the border is shorter than least_border.
struct Border {
    std::int32_t a = -1, b = -1;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    double length = 0, inside_share = 0;
};

// Share of the points on segments across the border that lie inside both models (Eq. 3).
// tolerance_m: of the regions a and b, beyond what noise moves a point.
double inside_share(const Surfels& surfels, const Regions& regions, const Border& border,
                    const std::array<double, 2>& tolerance_m);

// Share of point pairs of two regions that no convex solid has both on its surface: one lies in
// front of the other's surface, or free space lies between them.
double concavity(const RegionSamples& a, const RegionSamples& b, const FreeSpace& free);

// Whether two planes are pieces of one face, parted by something that stands against it: the board
// between two compartments of a shelf. The gap is covered in front and has nothing close behind.
bool are_face_pieces(const Surfels& surfels, const CutRegions& cuts,
                     const std::vector<RegionSamples>& samples, std::size_t a, std::size_t b);

// Pairs of planes that are pieces of one level plane that bounds the scene, such as a table seen
// between the things on it: they lie in each other's plane, face up, and nothing around them is
// below. Two boxes of equal height are no such pair: their sides are below their tops. Upright
// pieces stay apart: shelves in a row have their backs in one plane just as a wall has.
std::vector<std::pair<std::int32_t, std::int32_t>> find_level_pieces(
    const Surfels& surfels, const Vec3& up, const Regions& regions,
    const std::vector<RegionSamples>& samples);

// The side of a chair's back, the edge of its seat and its legs often lie in one plane, as one
// region: not convex, so it can't be a face of one solid. Where a plane meets a solid in a convex
// edge and yet goes on in front of a face of it, it is cut between the two along its shortest neck.
// solid: which solid each region was merged to, or empty where nothing was merged yet: then each
// face stands for itself. facts: of `cuts`, and kept true to them.
class RegionFacts;
void cut_flush_faces(const Surfels& surfels, const Vec3& up, const std::vector<std::int32_t>& solid,
                     CutRegions& cuts, RegionFacts& facts);

// Solids that are stacks of several (find_ledge()) are cut at their ledges: all of their regions.
// solid: which one each region was merged to. Returns how many ledges there were.
std::uint32_t cut_at_ledges(const Surfels& surfels, const Vec3& up,
                            const std::vector<std::int32_t>& solid, CutRegions& cuts,
                            RegionFacts& facts, ThreadPool& threads);

// The surfel in the cell that holds p, or -1.
std::int64_t surfel_at(const Surfels& surfels, const Eigen::Vector3d& p);

// Whether two planes face the same way and lie in each other's plane.
bool coplanar(const Regions& regions, const std::vector<RegionSamples>& samples, std::size_t a,
              std::size_t b, double slack_m);

}  // namespace topple::geometry
