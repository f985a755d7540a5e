// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/free_space.h"
#include "geometry/segmentation.h"

// The steps of merge_convex() (paper, 2.1.2).
namespace topple::geometry {

struct MergeOptions {
    // Share of a segment's points that must lie inside both models (Eq. 3).
    double delta2 = 0.6;
    // How far the segments' ends are set back from the border into their regions, in cells.
    int set_back_cells = 3;
    // Segments sampled per pair of regions, points per segment.
    std::uint32_t segments = 24, points_per_segment = 8;
    // Least length of the common border, as a multiple of the square root of the smaller region's
    // surfels (a square region's side), counted in adjacent surfel pairs.
    double border_share = 1.0;
    // Largest share of point pairs, one of each side, that see each other in front of themselves.
    double concavity_max = 0.12;
    // Points of each region that stand for it when the merged set's convexity is checked.
    std::uint32_t samples = 48;
    // Pieces of a level plane that bounds the scene (a floor or table among things) are one where
    // at most this share of the surfels around them lies below it; each holds at least this share
    // of all surfels.
    double behind_max = 0.01;
    double level_piece_min = 0.002;
    // Pieces of one face with something standing against the gap between them: the widest gap,
    // metres; how far before the face that thing begins and how far behind it nothing may be,
    // cells.
    double gap_m = 0.12, gap_cover_cells = 3;
    // Cutting faces of different solids that happen to be flush: the least part, in surfels; how
    // far in front of a face a surfel can't belong to its solid, in cells beyond the noise; the
    // cosine above which two faces are no crease; how many times its own surfels a face may have in
    // front of it; the longest cut, as a multiple of the side of a square as large as the smaller
    // part, unless that part is so many cells thick and this share of it is in front of the face;
    // how much shorter a level cut counts;
    // what a surfel that nothing speaks against costs when it is cut off, in cells of cut times the
    // side of a square as large as the whole face.
    std::uint32_t piece_min = 12;
    double front_cells = 1.5, crease_cos = 0.7, front_share = 4, neck_max = 1.5, thickness_min = 4,
           proven_min = 0.8, level_bias = 0.15, pull = 2;
};

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
RegionSamples sample_region(const Surfels& surfels, const CutRegions& cuts, std::size_t region,
                            const MergeOptions& options);

// Two regions that touch. a < b; `pairs` are adjacent surfels, the first in a, the second in b,
// ascending. length: number of the pairs as a multiple of the square root of the smaller region's
// surfels. inside_share: 0 where the border is shorter than MergeOptions::border_share.
struct Border {
    std::int32_t a = -1, b = -1;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    double length = 0, inside_share = 0;
};

// Share of the points on segments across the border that lie inside both models (Eq. 3).
// tolerance_m: of the regions a and b, beyond what noise moves a point.
double inside_share(const Surfels& surfels, const Regions& regions, const Border& border,
                    const std::array<double, 2>& tolerance_m, const MergeOptions& options);

// Share of point pairs of two regions that no convex solid has both on its surface: one lies in
// front of the other's surface, or free space lies between them.
double concavity(const RegionSamples& a, const RegionSamples& b, const FreeSpace& free);

// Whether two planes are pieces of one face, parted by something that stands against it: the board
// between two compartments of a shelf. The gap is covered in front and has nothing close behind.
bool are_face_pieces(const Surfels& surfels, const CutRegions& cuts,
                     const std::vector<RegionSamples>& samples, std::size_t a, std::size_t b,
                     const MergeOptions& options);

// Pairs of planes that are pieces of one level plane that bounds the scene, such as a table seen
// between the things on it: they lie in each other's plane, face up, and nothing around them is
// below. Two boxes of equal height are no such pair: their sides are below their tops. Upright
// pieces stay apart: shelves in a row have their backs in one plane just as a wall has.
std::vector<std::pair<std::int32_t, std::int32_t>> find_level_pieces(
    const Surfels& surfels, const Vec3& up, const Regions& regions,
    const std::vector<RegionSamples>& samples, const MergeOptions& options);

// The side of a chair's back, the edge of its seat and its legs often lie in one plane, as one
// region: not convex, so it can't be a face of one solid. Where a plane meets a solid in a convex
// edge and yet goes on in front of a face of it, it is cut between the two along its shortest neck.
// solid: which solid each region was merged to, or empty where nothing was merged yet: then each
// face stands for itself. facts: of `cuts`, and kept true to them.
class RegionFacts;
void cut_flush_faces(const Surfels& surfels, const Vec3& up, const std::vector<std::int32_t>& solid,
                     const MergeOptions& options, CutRegions& cuts, RegionFacts& facts);

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
