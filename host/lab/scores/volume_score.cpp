// SPDX-License-Identifier: MIT
#include "lab/scores/volume_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/thread_pool.h"
#include "lab/solids/ray_caster.h"

namespace topple::scenes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vec3 center_of(const World& truth, const SolidVoxels& solid, std::size_t n) {
    return truth.to_room({solid.x[n], solid.y[n], solid.z[n]});
}

Share precision(const std::vector<Verdict>& verdict) {
    const auto of = [&](Verdict v) {
        return static_cast<std::uint64_t>(std::ranges::count(verdict, v));
    };
    return share(of(Verdict::right), of(Verdict::right) + of(Verdict::wrong));
}

using Cell = std::array<std::int32_t, 3>;

// The cells of size h that hold voxels' centres, sorted.
std::vector<Cell> occupied_cells(const World& truth, const SolidVoxels& solid, double h) {
    std::vector<Cell> cells(solid.x.size());
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const Vec3 p = center_of(truth, solid, n);
        for (std::size_t a = 0; a < 3; ++a)
            cells[n][a] = static_cast<std::int32_t>(std::floor(p[a] / h));
    }
    std::ranges::sort(cells);
    return cells;
}

// Whether the cell or one of its six neighbours is among them.
bool is_near(const std::vector<Cell>& cells, const Cell& cell) {
    if (std::ranges::binary_search(cells, cell)) return true;
    for (std::size_t a = 0; a < 3; ++a) {
        for (const std::int32_t step : {1, -1}) {
            Cell beside = cell;
            beside[a] += step;
            if (std::ranges::binary_search(cells, beside)) return true;
        }
    }
    return false;
}

struct Count {
    std::uint64_t hits = 0, of = 0;
};

Count found(const Part& part, const std::vector<Cell>& occupied, double h, const Domain& domain) {
    const auto box = part.bounds();
    const Part::Heading heading = part.heading();
    Cell low{}, high{};
    for (std::size_t a = 0; a < 3; ++a) {
        low[a] = static_cast<std::int32_t>(std::floor(box[0][a] / h)) - 1;
        high[a] = static_cast<std::int32_t>(std::ceil(box[1][a] / h)) + 1;
    }
    Count count;
    for (std::int32_t i = low[0]; i < high[0]; ++i) {
        for (std::int32_t j = low[1]; j < high[1]; ++j) {
            for (std::int32_t k = low[2]; k < high[2]; ++k) {
                const Vec3 p{(i + 0.5) * h, (j + 0.5) * h, (k + 0.5) * h};
                if (!(part.distance(p, heading) < -0.25 * h) || (domain && !domain(p))) continue;
                count.of++;
                count.hits += is_near(occupied, {i, j, k});
            }
        }
    }
    return count;
}

Share recall(const World& truth, const SolidVoxels& solid, double h, const Domain& domain) {
    const std::vector<Cell> occupied = occupied_cells(truth, solid, h);
    std::vector<Count> counts(truth.parts.size());
    ThreadPool(0).each(counts.size(), 1, [&](std::size_t n) {
        if (truth.parts[n].object != 0) counts[n] = found(truth.parts[n], occupied, h, domain);
    });
    Count all;
    for (const Count& c : counts) {
        all.hits += c.hits;
        all.of += c.of;
    }
    return share(all.hits, all.of);
}

}  // namespace

std::vector<Verdict> verdicts(const World& truth, const SolidVoxels& solid, double h,
                              const Domain& domain) {
    const RayCaster parts(truth.parts);
    std::vector<Verdict> verdict(solid.x.size(), Verdict::not_judged);
    ThreadPool(0).each(verdict.size(), 256, [&](std::size_t n) {
        const Vec3 p = center_of(truth, solid, n);
        if (domain && !domain(p)) return;
        bool in_room = false;
        double near = infinity;
        parts.each_near(p, 2 * h, [&](std::int32_t part, double d) {
            if (truth.parts[part].object != 0)
                near = std::min(near, d);
            else
                in_room = in_room || d < 1.5 * h;
        });
        if (!in_room || near < 0) verdict[n] = near <= 0.87 * h ? Verdict::right : Verdict::wrong;
    });
    return verdict;
}

VolumeScore volume_score(const World& truth, const SolidVoxels& solid, double voxel_m,
                         const Domain& domain) {
    return {precision(verdicts(truth, solid, voxel_m, domain)),
            recall(truth, solid, voxel_m, domain)};
}

}  // namespace topple::scenes
