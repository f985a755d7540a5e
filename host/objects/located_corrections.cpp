// SPDX-License-Identifier: MIT
#include "objects/located_corrections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/rotation.h"
#include "io/text.h"

namespace topple {
namespace {

constexpr double reach_voxels = 3, least_reach_m = 0.05;

struct Nearest {
    std::int32_t primitive = -1;
    double distance_m = std::numeric_limits<double>::infinity();
};

class Finder {
  public:
    Finder(const SolidScene& solids, const geometry::SceneFrame& frame)
        : solids_(solids), frame_(frame) {}

    // Within reach; of equally near voxels the first in their order.
    Nearest near(const Vec3& spot) const {
        const SolidCells& cells = solids_.cells();
        const Vec3 at = in_voxels(spot);
        const double reach = reach_m(cells.voxel_m) / cells.voxel_m;
        Nearest best{-1, reach * cells.voxel_m};
        for (const double x : at)  // no voxel is as far out as that
            if (!(std::abs(x) < 1e9)) return {};
        const auto first = [&](double x) {
            return static_cast<std::int32_t>(std::floor(x - reach));
        };
        const auto last = [&](double x) {
            return static_cast<std::int32_t>(std::floor(x + reach));
        };
        for (std::int32_t i = first(at[0]); i <= last(at[0]); ++i) {
            for (std::int32_t j = first(at[1]); j <= last(at[1]); ++j) {
                const auto [begin, end] = solids_.columns().at(i, j);
                for (std::size_t n = begin; n < end; ++n) consider(n, at, best);
            }
        }
        return best.primitive < 0 ? Nearest{} : best;
    }
    // However far it is.
    Nearest anywhere(const Vec3& spot) const {
        const Vec3 at = in_voxels(spot);
        Nearest best;
        for (std::size_t n = 0; n < solids_.cells().size(); ++n) consider(n, at, best);
        return best;
    }

  private:
    Vec3 in_voxels(const Vec3& spot) const {
        Vec3 out = turned(frame_.axes, minus(spot, frame_.origin_m));
        for (double& x : out) x /= solids_.voxel_m();
        return out;
    }
    void consider(std::size_t n, const Vec3& at, Nearest& best) const {
        const SolidCells& cells = solids_.cells();
        if (cells.primitive[n] < 0) return;
        const double distance =
            cells.voxel_m * std::hypot(cells.i[n] + 0.5 - at[0], cells.j[n] + 0.5 - at[1],
                                       cells.k[n] + 0.5 - at[2]);
        if (distance < best.distance_m) best = {cells.primitive[n], distance};
    }

    const SolidScene& solids_;
    const geometry::SceneFrame& frame_;
};

std::vector<std::int32_t> parts_at(const Finder& finder, std::span<const Vec3> spots,
                                   const char* list, double voxel_m, std::string& missed) {
    std::vector<std::int32_t> out;
    std::string numbers;
    const Vec3* lost = nullptr;
    for (std::size_t s = 0; s < spots.size(); ++s) {
        const Nearest found = finder.near(spots[s]);
        if (found.primitive >= 0) {
            out.push_back(found.primitive);
            continue;
        }
        numbers.append(lost ? ", " : " ").append(std::to_string(s + 1));
        if (!lost) lost = &spots[s];
    }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    if (lost) {
        missed.append(missed.empty() ? "found nothing within " : "; nothing within ")
            .append(io::short_number(reach_m(voxel_m)))
            .append(" m of ")
            .append(list);
        if (spots.size() > 1) missed.append(numbers);
        missed.append(" (the nearest solid is ")
            .append(io::two_digits(finder.anywhere(*lost).distance_m))
            .append(" m away)");
    }
    return out;
}

}  // namespace

double reach_m(double voxel_m) {
    return std::max(reach_voxels * voxel_m, least_reach_m);
}

std::vector<LocatedCorrection> locate(std::span<const Correction> corrections,
                                      const SolidScene& solids, const geometry::SceneFrame& frame) {
    const Finder finder(solids, frame);
    std::vector<LocatedCorrection> out;
    for (const Correction& c : corrections) {
        LocatedCorrection& to = out.emplace_back();
        to.at = parts_at(finder, c.at_m, "at_m", solids.voxel_m(), to.missed);
        to.from = parts_at(finder, c.from_m, "from_m", solids.voxel_m(), to.missed);
    }
    return out;
}

}  // namespace topple
