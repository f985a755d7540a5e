// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/thread_pool.h"
#include "export/body.h"

namespace topple::exports {

// Joins parts of each body two by two, cheapest first, while the hull of both is hardly larger than
// they are and comes no closer to other bodies: simulators take time for each part that touches.
// Parts that are further apart than a voxel are not joined.
void merge_parts(std::vector<Body>& bodies, double voxel_m, ThreadPool& threads);

}  // namespace topple::exports
