// SPDX-License-Identifier: MIT
#pragma once

#include "device/device.h"
#include "geometry/manhattan.h"
#include "topple/cloud_view.h"

// A quick look at a scan: what of it decides how much work its parse has. A twentieth of a second
// for a room.
namespace topple {

struct ScanLook {
    // Sum over the smooth patches of the surface of their edges as squares, metres: grows with how
    // much stands in a room, as the edges do at which patches meet.
    double patches_m = 0;
    // How rough the surface is: the median over its surfels of the rms distance of points from the
    // plane, over the surfel's edge. Noise and clutter make more, smaller patches.
    double roughness = 0;
    // The box that the parse's grid spans, along the scene's axes: how large it is, and its ground.
    double box_m3 = 0, ground_m2 = 0;
};

// Splits the surface into smooth patches as a parse does, on surfels of the size that a parse with
// cells of `cell_m` has, but of coarser ones where those of `surface_m2` would be more than 20,000.
// The cloud has a point or more; hints: which way is up.
ScanLook look_at_scan(device::Device& device, const PointCloud& cloud, double cell_m,
                      double surface_m2, const geometry::FrameHints& hints);

}  // namespace topple
