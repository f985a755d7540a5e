// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "topple/kernel_testing/case.h"

namespace topple::perf {

// In the order in which data passes the kernels; the four probes first.
std::span<const Case> all_cases();

// One for each kernel, in the file of its name or of its group.
Prepared voxel_normals(device::Device& device);
Prepared plane_mean(device::Device& device);
Prepared normal_cluster(device::Device& device);
Prepared carve_leaves(device::Device& device);
Prepared carve(device::Device& device);
Prepared six_fill_sweep(device::Device& device);
Prepared six_fill_vote(device::Device& device);
Prepared cell_share(device::Device& device);
Prepared segmented_sum(device::Device& device);
Prepared dense_layer(device::Device& device);
Prepared neighbour_pool(device::Device& device);
Prepared support_function(device::Device& device);
Prepared group_stance(device::Device& device);
Prepared disturbance_reach(device::Device& device);
Prepared disturbance(device::Device& device);
Prepared rocking(device::Device& device);
// Data-parallel primitives, each as a whole.
Prepared reduction(device::Device& device);
Prepared scan(device::Device& device);
Prepared compaction(device::Device& device);
Prepared sort_keys(device::Device& device);
Prepared sort_wide_records(device::Device& device);
Prepared unique_wide_keys(device::Device& device);
Prepared sparse_grid(device::Device& device);
Prepared segmented_sums(device::Device& device);
Prepared segmented_scan(device::Device& device);
Prepared histogram(device::Device& device);
Prepared gather_words(device::Device& device);
Prepared components(device::Device& device);

}  // namespace topple::perf
