// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "vdb/grids.h"

namespace topple::vdb {
namespace {

// A hidden voxel between two solids and the one that is to have it.
struct Claim {
    openvdb::Coord voxel;
    std::int32_t distance;  // voxels to that solid
    std::int32_t primitive;
    auto order() const { return std::tuple(voxel.x(), voxel.y(), voxel.z(), distance, primitive); }
};

class Bridging {
  public:
    Bridging(const SolidCellArrays& cells, const openvdb::Int32Grid& state,
             const std::vector<bool>& hollow)
        : cells_(cells), state_(state.getConstAccessor()), hollow_(hollow) {}

    // Claims all voxels of the gaps along one axis.
    void along(int axis, std::int32_t longest) {
        const std::array<const std::vector<std::int32_t>*, 3> at{&cells_.i, &cells_.j, &cells_.k};
        const auto& u = *at[static_cast<std::size_t>((axis + 1) % 3)];
        const auto& v = *at[static_cast<std::size_t>((axis + 2) % 3)];
        const auto& w = *at[static_cast<std::size_t>(axis)];
        std::vector<std::size_t> order(cells_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::tuple(u[a], v[a], w[a]) < std::tuple(u[b], v[b], w[b]);
        });
        for (std::size_t n = 1; n < order.size(); ++n) {
            const std::size_t a = order[n - 1], b = order[n];
            if (u[a] != u[b] || v[a] != v[b]) continue;
            if (w[b] - w[a] - 1 < 1 || w[b] - w[a] - 1 > longest) continue;
            if (joins(cells_.primitive[a], cells_.primitive[b], axis))
                claim(a, b, axis, w[b] - w[a] - 1);
        }
    }

    // Of several claims on a voxel the nearest stands, then the lowest primitive.
    std::vector<Claim> settled() {
        std::sort(claims_.begin(), claims_.end(),
                  [](const Claim& a, const Claim& b) { return a.order() < b.order(); });
        claims_.erase(
            std::unique(claims_.begin(), claims_.end(),
                        [](const Claim& a, const Claim& b) { return a.voxel == b.voxel; }),
            claims_.end());
        return std::move(claims_);
    }

  private:
    bool is_hollow(std::int32_t p) const {
        return static_cast<std::size_t>(p) < hollow_.size() && hollow_[static_cast<std::size_t>(p)];
    }
    // Sideways, what stands close to a wall is not thereby joined to it.
    bool joins(std::int32_t a, std::int32_t b, int axis) const {
        return a >= 0 && b >= 0 && a != b && (axis == 2 || (!is_hollow(a) && !is_hollow(b)));
    }
    void claim(std::size_t a, std::size_t b, int axis, std::int32_t gap) {
        openvdb::Coord voxel(cells_.i[a], cells_.j[a], cells_.k[a]);
        const std::size_t before = claims_.size();
        for (std::int32_t step = 1; step <= gap; ++step) {
            ++voxel[axis];
            if (state_.getValue(voxel) != static_cast<std::int32_t>(State::invisible)) {
                claims_.resize(before);  // seen to be empty: a gap it is
                return;
            }
            const std::int32_t to_b = gap + 1 - step;
            const bool first =
                step < to_b || (step == to_b && cells_.primitive[a] < cells_.primitive[b]);
            claims_.push_back({voxel, std::min(step, to_b), cells_.primitive[first ? a : b]});
        }
    }

    const SolidCellArrays& cells_;
    openvdb::Int32Grid::ConstAccessor state_;
    const std::vector<bool>& hollow_;
    std::vector<Claim> claims_;
};

}  // namespace

std::uint64_t VoxelScene::bridge(unsigned longest_gap, const std::vector<bool>& hollow) {
    Grids& g = *grids_;
    const SolidCellArrays cells = solid_cells();
    Bridging bridging(cells, *g.state, hollow);
    for (int axis = 0; axis < 3; ++axis)
        bridging.along(axis, static_cast<std::int32_t>(longest_gap));
    const std::vector<Claim> claims = bridging.settled();
    auto state = g.state->getAccessor();
    auto primitive = g.primitive->getAccessor();
    for (const Claim& c : claims) {
        state.setValueOn(c.voxel, static_cast<std::int32_t>(State::completed));
        primitive.setValueOn(c.voxel, c.primitive);
    }
    return claims.size();
}

}  // namespace topple::vdb
