// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

// How well one labelling of points agrees with another: the measures of Chen, Golovinskiy and
// Funkhouser, "A Benchmark for 3D Mesh Segmentation" (2009), on points instead of faces. A negative
// predicted label is a segment of its own, a negative true one no point's.
namespace topple::scenes {

struct SegmentationScore {
    double hamming = 0;          // mean of the next two
    double missing = 0;          // share of points outside of their true segment's best match
    double false_alarm = 0;      // share of points outside of their predicted segment's best match
    double cut_discrepancy = 0;  // see below
    double miou = 0;             // best intersection over union of each true segment, all alike
};

// All but the cut discrepancy, which needs to know where the points are. Throws Error(usage) for
// spans of different sizes.
SegmentationScore segmentation_score(std::span<const std::int32_t> truth,
                                     std::span<const std::int32_t> predicted);

struct Positions {
    std::span<const float> x, y, z;  // metres, any frame
};

// How far the borders of segments lie from where they should. Points are thinned to one per cell of
// `cell_m` (their mean, with the labels of most); a cell is on a cut where one of its 26 neighbours
// has another label. With d(p, C) the shortest way from p to the nearest cell of C through
// neighbouring cells, and r the mean distance of the cells from their centroid,
//   ( mean over p in cuts(predicted) of d(p, cuts(truth))
//   + mean over p in cuts(truth) of d(p, cuts(predicted)) ) / r.
// A cell further than r, or with no way at all, counts as r away; 0 where neither labelling has a
// cut. Throws Error(usage) for spans of different sizes, or a cell that is not above 0.
double cut_discrepancy(const Positions& points, std::span<const std::int32_t> truth,
                       std::span<const std::int32_t> predicted, double cell_m);

}  // namespace topple::scenes
