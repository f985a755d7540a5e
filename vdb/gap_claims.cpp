// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <vector>

#include "core/scan_gaps.h"
#include "vdb/completion.h"

namespace topple::vdb {
namespace {

// A hidden voxel between two solids and the one that is to have it.
struct Candidate {
    Voxel at;
    std::int32_t distance;  // voxels to that solid
    std::int32_t primitive;
    auto operator<=>(const Candidate&) const = default;
};

class Bridging {
  public:
    explicit Bridging(const VolumeView& view) : view_(view), cells_(view.cells()) {}

    // All voxels of the gaps along one axis.
    void along(int axis, std::int32_t longest) {
        const auto a = static_cast<std::size_t>(axis);
        for (std::size_t n = 0; n < cells_.size(); ++n) {
            Voxel at = place_of(cells_, n);
            ++at[a];
            const std::int32_t gap = view_.unseen_run(at, axis, 1, longest + 1);
            if (gap < 1 || gap > longest) continue;
            Voxel next = at;
            next[a] += gap;
            if (!view_.solid(next)) continue;  // seen to be empty: a gap it is
            const std::int32_t before = cells_.primitive[n], behind = view_.primitive(next);
            if (joins(before, behind, axis)) add_gap(at, axis, gap, before, behind);
        }
    }

    // Of several candidates for a voxel the nearest stands, then the lowest primitive.
    std::vector<Claim> claims() {
        std::ranges::sort(candidates_);
        std::vector<Claim> out;
        for (const Candidate& c : candidates_) {
            if (out.empty() || out.back().at != c.at)
                out.push_back({c.at, c.primitive, Basis::gap});
        }
        return out;
    }

  private:
    // Sideways, what stands close to a wall is not thereby joined to it.
    bool joins(std::int32_t a, std::int32_t b, int axis) const {
        return a >= 0 && b >= 0 && a != b && (axis == 2 || (view_.is_body(a) && view_.is_body(b)));
    }
    void add_gap(Voxel at, int axis, std::int32_t gap, std::int32_t before, std::int32_t behind) {
        for (std::int32_t step = 1; step <= gap; ++step, ++at[axis]) {
            const std::int32_t back = gap + 1 - step;
            const bool first = step < back || (step == back && before < behind);
            candidates_.push_back({at, std::min(step, back), first ? before : behind});
        }
    }

    const VolumeView& view_;
    const SolidCells& cells_;
    std::vector<Candidate> candidates_;
};

}  // namespace

std::vector<Claim> gap_claims(const VolumeView& view) {
    Bridging bridging(view);
    for (int axis = 0; axis < 3; ++axis) bridging.along(axis, noise_gap);
    return bridging.claims();
}

}  // namespace topple::vdb
