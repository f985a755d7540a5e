// SPDX-License-Identifier: MIT
#include "vdb/view_leaves.h"

#include <algorithm>

namespace topple::vdb {
namespace {

using Leaf = LeafTable::Leaf;

enum class Reach { none, some, all };

class Search {
  public:
    Search(const LeafTable& table, std::span<const ViewCone> cones,
           const kernels::CarveParams& params)
        : table_(table), cones_(cones), params_(params) {}

    // Leaves from `low` to `high`, inclusive; `cones`: those that may reach some of them.
    void visit(const Leaf& low, const Leaf& high, const std::vector<std::uint32_t>& cones) {
        std::vector<std::uint32_t> left;
        for (const std::uint32_t c : cones) {
            const Reach reach = reach_of(cones_[c], low, high);
            if (reach == Reach::all) return take(low, high);
            if (reach == Reach::some) left.push_back(c);
        }
        if (left.empty()) return;
        std::size_t longest = 0;
        for (std::size_t a = 1; a < 3; ++a)
            if (high[a] - low[a] > high[longest] - low[longest]) longest = a;
        if (high[longest] == low[longest]) return take(low, high);
        Leaf below = high, above = low;
        below[longest] = low[longest] + (high[longest] - low[longest]) / 2;
        above[longest] = below[longest] + 1;
        visit(low, below, left);
        visit(above, high, left);
    }
    std::vector<std::uint64_t> found;

  private:
    void take(const Leaf& low, const Leaf& high) {
        for (std::int32_t x = low[0]; x <= high[0]; ++x)
            for (std::int32_t y = low[1]; y <= high[1]; ++y)
                for (std::int32_t z = low[2]; z <= high[2]; ++z)
                    found.push_back(static_cast<std::uint64_t>(table_.index_of({x, y, z})));
    }

    // The distances to the cone's sides, times depth, are affine in the place: their extremes lie
    // at the corners of the box. Twice the kernel's slack, for it computes in single precision.
    Reach reach_of(const ViewCone& cone, const Leaf& low, const Leaf& high) const {
        const Leaf reference = table_.reference();
        const double w = params_.width, h = params_.height, slack = 2.0 * params_.slack_m;
        std::array<bool, 6> any{}, every{true, true, true, true, true, true};
        for (unsigned corner = 0; corner < 8; ++corner) {
            std::array<double, 3> v{};
            for (std::size_t a = 0; a < 3; ++a) {
                const bool upper = (corner >> a & 1) != 0;
                v[a] = (upper ? high[a] * 8.0 + 7 : low[a] * 8.0) - reference[a];
            }
            const auto row = [&](std::size_t r) {
                const float* c = cone.camera.data() + 4 * r;
                return c[0] * v[0] + c[1] * v[1] + c[2] * v[2] + c[3];
            };
            const double u_z = row(0), v_z = row(1), z = row(2);
            const std::array<double, 6> inside{
                u_z + slack * w,         w * z - u_z + slack * w,    v_z + slack * w,
                h * z - v_z + slack * w, z - params_.near_m + slack, cone.far_m + slack - z};
            for (std::size_t side = 0; side < 6; ++side) {
                any[side] = any[side] || inside[side] >= 0;
                every[side] = every[side] && inside[side] >= 0;
            }
        }
        const auto yes = [](bool b) { return b; };
        if (!std::all_of(any.begin(), any.end(), yes)) return Reach::none;
        return std::all_of(every.begin(), every.end(), yes) ? Reach::all : Reach::some;
    }

    const LeafTable& table_;
    std::span<const ViewCone> cones_;
    const kernels::CarveParams& params_;
};

}  // namespace

std::vector<std::uint64_t> leaves_in_view(const LeafTable& table, std::span<const ViewCone> cones,
                                          const kernels::CarveParams& params) {
    Search search(table, cones, params);
    std::vector<std::uint32_t> with_readings;
    for (std::uint32_t c = 0; c < cones.size(); ++c)
        if (cones[c].far_m > 0) with_readings.push_back(c);
    const Leaf high{table.low[0] + table.count[0] - 1, table.low[1] + table.count[1] - 1,
                    table.low[2] + table.count[2] - 1};
    if (table.box_size() > 0) search.visit(table.low, high, with_readings);
    for (const Leaf& leaf : table.beyond) search.visit(leaf, leaf, with_readings);
    std::sort(search.found.begin(), search.found.end());
    return std::move(search.found);
}

}  // namespace topple::vdb
