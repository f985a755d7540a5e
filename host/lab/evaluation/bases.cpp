// SPDX-License-Identifier: MIT
#include "lab/evaluation/bases.h"

#include <vector>

#include "lab/evaluation/text.h"
#include "lab/scores/volume_score.h"

namespace topple::evaluation {
namespace {

constexpr std::array<const char*, basis_count> names{
    "surface", "enclosed", "half_enclosed", "unlikely", "stand", "leg", "gap"};

}  // namespace

void add_voxels(const scenes::World& truth, const SolidScene& solids, const vdb::VoxelFrame& frame,
                BasisCounts& counts) {
    const SolidCells& cells = solids.cells();
    const SolidVoxels solid = vdb::solid_voxels(frame, cells, {});
    const std::vector<scenes::Verdict> verdict = scenes::verdicts(truth, solid, cells.voxel_m);
    for (std::size_t n = 0; n < verdict.size(); ++n) {
        BasisCounts::Count& count = counts.basis[static_cast<std::size_t>(cells.basis[n])];
        count.of += verdict[n] != scenes::Verdict::not_judged;
        count.right += verdict[n] == scenes::Verdict::right;
    }
}

std::string table_of(const BasisCounts& counts) {
    std::string out = "basis           voxels     share that is solid\n";
    for (std::size_t b = 0; b < basis_count; ++b) {
        const BasisCounts::Count& count = counts.basis[b];
        append(
            out, "%-12s %9llu %12.4f\n", names[b], static_cast<unsigned long long>(count.of),
            count.of > 0 ? static_cast<double>(count.right) / static_cast<double>(count.of) : 0.0);
    }
    return out;
}

}  // namespace topple::evaluation
