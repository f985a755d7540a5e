// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/manhattan.h"
#include "topple/cloud_view.h"
#include "topple/input.h"
#include "topple/kernels/device.h"

// A quick look at a scan: what of it decides how much work its parse has. A twentieth of a second
// for a room.
namespace topple {

// The box that a parse's grid spans, along the scene's axes.
struct GridBox {
    double ground_m2 = 0, height_m = 0;
    double m3() const { return ground_m2 * height_m; }
};
// The cloud has a point or more.
GridBox grid_box(const CloudView& cloud, const std::array<Vec3, 3>& axes);
// The space before what a depth image shows.
double seen_m3(const DepthFrame& frame, const Intrinsics& intrinsics);

struct ScanLook {
    // Sum over the smooth patches of the surface of their edges as squares, metres: grows with how
    // much stands in a room, as the edges do at which patches meet.
    double patches_m = 0;
    GridBox box;
};

// Splits the surface into smooth patches as a parse does, on surfels of the size that a parse with
// cells of `cell_m` has, but of coarser ones where those of `surface_m2` would be more than 20,000.
// The cloud has a point or more; hints: which way is up.
ScanLook look_at_scan(device::Device& device, const PointCloud& cloud, double cell_m,
                      double surface_m2, const geometry::FrameHints& hints);

}  // namespace topple
