// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "geometry/surfels.h"
#include "points/observation.h"
#include "points/single_scan.h"
#include "topple/kernels/device.h"

namespace topple {

// Sets the frames of out.cloud, an unorganised one, and where its points were seen from: from the
// places that its points name, or from that of the scan that it is, or else by virtual views, which
// tell which side of its surfaces was seen, too. Notes say which. tell: called now and then with
// about how much is done, 0 to 1; or empty.
void look_from_free_places(device::Device& device, const std::optional<geometry::SingleScan>& scan,
                           const geometry::PointSpacing& spacing,
                           const std::function<void(double)>& tell, Observation& out);
// The same of a part of a building, of which every cell of out.cell_m has a point.
void look_from_free_places(device::Device& device, Observation& out);

}  // namespace topple
