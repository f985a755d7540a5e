// SPDX-License-Identifier: MIT
#include "physics/hollow_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>

#include "physics/solid_pieces.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

using HollowVoxel = std::array<std::int32_t, 3>;

// What of a voxel one of the object's primitives is.
struct HollowPiece {
    HollowVoxel at;
    std::size_t primitive;  // its place in the list
    double share;
    Vec3 center;  // metres
};

std::vector<HollowPiece> hollow_pieces(const SolidScene& solids,
                                       std::span<const std::int32_t> primitives) {
    std::vector<HollowPiece> out;
    each_solid_piece(solids.cells(), solids.boundary(), [&](const SolidPiece& piece) {
        const auto own = std::ranges::lower_bound(primitives, piece.primitive);
        if (own == primitives.end() || *own != piece.primitive) return;
        out.push_back({{piece.i, piece.j, piece.k},
                       static_cast<std::size_t>(own - primitives.begin()),
                       piece.share,
                       piece.centre});
    });
    return out;
}

// The box around the object, a voxel wider on each side: how much of each voxel it is, and how deep
// below its surface the voxel's middle lies.
class ShellDepths {
  public:
    ShellDepths(std::span<const HollowPiece> pieces, double voxel_m) : voxel_m_(voxel_m) {
        HollowVoxel high = low_ = pieces.front().at;
        for (const HollowPiece& p : pieces) {
            for (std::size_t a = 0; a < 3; ++a) {
                low_[a] = std::min(low_[a], p.at[a]);
                high[a] = std::max(high[a], p.at[a]);
            }
        }
        for (std::size_t a = 0; a < 3; ++a) {
            --low_[a];
            count_[a] = high[a] - low_[a] + 2;
        }
        std::size_t voxels = 1;
        for (const std::int32_t along : count_) voxels *= static_cast<std::size_t>(along);
        constexpr std::size_t most_voxels = std::size_t{1} << 28;  // each takes 16 bytes
        if (voxels > most_voxels)
            throw Error(ErrorKind::input, "what is said to be hollow spans " +
                                              std::to_string(voxels) + " voxels, of " +
                                              std::to_string(most_voxels) +
                                              " at most; use a larger voxel_m (--voxel)");
        share_.assign(voxels, 0);
        for (const HollowPiece& p : pieces) share_[index(p.at)] += p.share;
        find_surface();
        sweep();
    }

    // The part of what the object has of a voxel that lies within wall_m of its surface.
    double part_of_shell(const HollowVoxel& at, double wall_m) const {
        const std::size_t v = index(at);
        const double wall = wall_m / voxel_m_;
        if (nearest_[v] == none) return 0;
        if (nearest_[v] == v) return std::min(1.0, wall / std::min(share_[v], 1.0));
        return std::clamp(wall - depth(v, nearest_[v]) + 0.5, 0.0, 1.0);
    }

  private:
    static constexpr std::size_t none = ~std::size_t{0};
    static constexpr double mostly = 0.5;

    std::size_t index(const HollowVoxel& at) const {
        const auto along = [&](std::size_t a) { return static_cast<std::size_t>(at[a] - low_[a]); };
        return (along(0) * static_cast<std::size_t>(count_[1]) + along(1)) *
                   static_cast<std::size_t>(count_[2]) +
               along(2);
    }
    HollowVoxel place(std::size_t v) const {
        const auto ny = static_cast<std::size_t>(count_[1]),
                   nz = static_cast<std::size_t>(count_[2]);
        return {low_[0] + static_cast<std::int32_t>(v / (ny * nz)),
                low_[1] + static_cast<std::int32_t>(v / nz % ny),
                low_[2] + static_cast<std::int32_t>(v % nz)};
    }
    bool in_box(const HollowVoxel& at) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (at[a] < low_[a] || at[a] >= low_[a] + count_[a]) return false;
        return true;
    }
    // Voxels that are mostly not the object, and those beside them that are not all of it: what is
    // missing of others is where its own parts meet.
    void find_surface() {
        nearest_.assign(share_.size(), none);
        for (std::size_t v = 0; v < share_.size(); ++v) {
            bool surface = share_[v] < mostly;
            if (!surface && share_[v] < 1) {
                const HollowVoxel at = place(v);
                for (std::size_t side = 0; side < 6 && !surface; ++side) {
                    HollowVoxel beside = at;
                    beside[side / 2] += side % 2 ? 1 : -1;
                    surface = !in_box(beside) || share_[index(beside)] < mostly;
                }
            }
            if (surface) nearest_[v] = v;
        }
    }
    // Of a voxel's middle, voxels, as seen from a voxel of the surface.
    double depth(std::size_t v, std::size_t surface) const {
        const HollowVoxel a = place(v), b = place(surface);
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) + std::min(share_[surface], 1.0) -
               0.5;
    }
    // Hands nearest voxels of the surface on from neighbour to neighbour, to and fro.
    void sweep() {
        std::vector<HollowVoxel> before;
        for (std::int32_t x = -1; x <= 1; ++x)
            for (std::int32_t y = -1; y <= 1; ++y)
                for (std::int32_t z = -1; z <= 1; ++z)
                    if (std::tuple(x, y, z) < std::tuple(0, 0, 0)) before.push_back({x, y, z});
        for (const std::int32_t way : {1, -1}) {
            for (std::size_t n = 0; n < share_.size(); ++n) {
                const std::size_t v = way > 0 ? n : share_.size() - 1 - n;
                if (nearest_[v] == v) continue;
                const HollowVoxel at = place(v);
                double least = nearest_[v] == none ? std::numeric_limits<double>::infinity()
                                                   : depth(v, nearest_[v]);
                for (const HollowVoxel& step : before) {
                    const HollowVoxel from{at[0] + way * step[0], at[1] + way * step[1],
                                           at[2] + way * step[2]};
                    if (!in_box(from) || nearest_[index(from)] == none) continue;
                    const double other = depth(v, nearest_[index(from)]);
                    if (other >= least) continue;
                    least = other;
                    nearest_[v] = nearest_[index(from)];
                }
            }
        }
    }

    double voxel_m_;
    HollowVoxel low_{};
    std::array<std::int32_t, 3> count_{};
    std::vector<double> share_;
    std::vector<std::size_t> nearest_;  // voxel of the surface; of those themselves
};

}  // namespace

HollowBody hollow_body(const SolidScene& solids, std::span<const std::int32_t> primitives,
                       double wall_m) {
    HollowBody out;
    out.volume_m3.assign(primitives.size(), 0);
    out.center.assign(primitives.size(), Vec3{});
    const std::vector<HollowPiece> pieces = hollow_pieces(solids, primitives);
    if (pieces.empty()) return out;
    const double h = solids.voxel_m();
    const ShellDepths depths(pieces, h);
    std::vector<double> volume;
    Vec3 moment{};
    double all = 0;
    for (const HollowPiece& p : pieces) {
        volume.push_back(p.share * depths.part_of_shell(p.at, wall_m) * h * h * h);
        out.volume_m3[p.primitive] += volume.back();
        all += volume.back();
        for (std::size_t a = 0; a < 3; ++a) {
            out.center[p.primitive][a] += volume.back() * p.center[a];
            moment[a] += volume.back() * p.center[a];
        }
    }
    for (std::size_t n = 0; n < primitives.size(); ++n)
        for (double& c : out.center[n]) c = out.volume_m3[n] > 0 ? c / out.volume_m3[n] : 0;
    if (!(all > 0)) return out;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        Vec3 d{};
        for (std::size_t a = 0; a < 3; ++a) d[a] = pieces[n].center[a] - moment[a] / all;
        const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        const double width = std::cbrt(volume[n]), own = width * width / 6;  // of a cube
        for (std::size_t a = 0; a < 3; ++a)
            out.inertia_m5[a] += volume[n] * (square - d[a] * d[a] + own);
        out.inertia_m5[3] -= volume[n] * d[0] * d[1];
        out.inertia_m5[4] -= volume[n] * d[0] * d[2];
        out.inertia_m5[5] -= volume[n] * d[1] * d[2];
    }
    return out;
}

}  // namespace topple::physics
