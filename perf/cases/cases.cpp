// SPDX-License-Identifier: MIT
#include "perf/cases/cases.h"

#include "perf/kernels/probes.h"

namespace topple::perf {

std::span<const Case> all_cases() {
    static constexpr Case cases[] = {
        probes[0],
        probes[1],
        probes[2],
        probes[3],
        {"voxel_normals", voxel_normals},
        {"plane_mean", plane_mean},
        {"normal_cluster", normal_cluster},
        {"carve_leaves", carve_leaves},
        {"carve", carve},
        {"six_fill_sweep", six_fill_sweep},
        {"six_fill_vote", six_fill_vote},
        {"cell_share", cell_share},
        {"segmented_sum", segmented_sum},
        {"dense_layer", dense_layer},
        {"neighbour_pool", neighbour_pool},
        {"support_function", support_function},
        {"group_stance", group_stance},
        {"disturbance_reach", disturbance_reach},
        {"disturbance", disturbance},
        {"rocking", rocking},
        {"primitives/reduction", reduction},
        {"primitives/scan", scan},
        {"primitives/compaction", compaction},
        {"primitives/sort", sort_keys},
        {"primitives/sort_wide_records", sort_wide_records},
        {"primitives/unique", unique_wide_keys},
        {"primitives/sparse_grid", sparse_grid},
        {"primitives/segmented_sum", segmented_sums},
        {"primitives/segmented_scan", segmented_scan},
        {"primitives/histogram", histogram},
        {"primitives/gather", gather_words},
        {"primitives/components", components},
    };
    return cases;
}

}  // namespace topple::perf
