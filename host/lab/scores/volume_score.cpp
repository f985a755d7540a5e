// SPDX-License-Identifier: MIT
#include "lab/scores/volume_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "lab/parallel.h"
#include "lab/solids/ray_caster.h"

namespace topple::scenes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vec3 center_of(const World& truth, const SolidVoxels& solid, std::size_t n) {
    return truth.to_room({solid.x[n], solid.y[n], solid.z[n]});
}

Share precision(const std::vector<Verdict>& verdict) {
    std::uint64_t right = 0, used = 0;
    for (const Verdict v : verdict) {
        used += v != Verdict::not_judged;
        right += v == Verdict::right;
    }
    return share(right, used);
}

// The cells of size h that hold voxels' centres, each packed into one word, 21 bits per axis.
class Occupied {
  public:
    Occupied(const World& truth, const SolidVoxels& solid, double h) {
        for (std::size_t n = 0; n < solid.x.size(); ++n) {
            const Vec3 p = center_of(truth, solid, n);
            cells_.push_back(packed(std::llround(std::floor(p[0] / h)),
                                    std::llround(std::floor(p[1] / h)),
                                    std::llround(std::floor(p[2] / h))));
        }
        std::sort(cells_.begin(), cells_.end());
    }
    // The cell or one of its six neighbours.
    bool near(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return has(i, j, k) || has(i + 1, j, k) || has(i - 1, j, k) || has(i, j + 1, k) ||
               has(i, j - 1, k) || has(i, j, k + 1) || has(i, j, k - 1);
    }

  private:
    static std::uint64_t packed(std::int64_t i, std::int64_t j, std::int64_t k) {
        constexpr std::int64_t half = 1 << 20;
        const auto bits = [](std::int64_t v) {
            return static_cast<std::uint64_t>(std::clamp(v + half, std::int64_t{0}, 2 * half - 1));
        };
        return bits(i) << 42 | bits(j) << 21 | bits(k);
    }
    bool has(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return std::binary_search(cells_.begin(), cells_.end(), packed(i, j, k));
    }

    std::vector<std::uint64_t> cells_;
};

struct Count {
    std::uint64_t hits = 0, of = 0;
};

Count found(const Part& part, const Occupied& occupied, double h, const Domain& domain) {
    const auto box = part.bounds();
    const Part::Heading heading = part.heading();
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::llround(std::floor(box[0][a] / h)) - 1;
        high[a] = std::llround(std::ceil(box[1][a] / h)) + 1;
    }
    const auto mid = [&](std::int64_t v) { return (static_cast<double>(v) + 0.5) * h; };
    Count count;
    for (std::int64_t i = low[0]; i < high[0]; ++i) {
        for (std::int64_t j = low[1]; j < high[1]; ++j) {
            for (std::int64_t k = low[2]; k < high[2]; ++k) {
                const Vec3 p{mid(i), mid(j), mid(k)};
                if (!(part.distance(p, heading) < -0.25 * h) || (domain && !domain(p))) continue;
                count.of++;
                count.hits += occupied.near(i, j, k);
            }
        }
    }
    return count;
}

Share recall(const World& truth, const SolidVoxels& solid, double h, const Domain& domain) {
    const Occupied occupied(truth, solid, h);
    std::vector<Count> counts(truth.parts.size());
    in_parallel(truth.parts.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            if (truth.parts[n].object != 0) counts[n] = found(truth.parts[n], occupied, h, domain);
        }
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
    in_parallel(verdict.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            const Vec3 p = center_of(truth, solid, n);
            if (domain && !domain(p)) continue;
            bool in_room = false;
            double near = infinity;
            parts.each_near(p, 2 * h, [&](std::int32_t part, double d) {
                if (truth.parts[part].object != 0)
                    near = std::min(near, d);
                else
                    in_room = in_room || d < 1.5 * h;
            });
            if (!in_room || near < 0)
                verdict[n] = near <= 0.87 * h ? Verdict::right : Verdict::wrong;
        }
    });
    return verdict;
}

VolumeScore volume_score(const World& truth, const SolidVoxels& solid, double voxel_m,
                         const Domain& domain) {
    return {precision(verdicts(truth, solid, voxel_m, domain)),
            recall(truth, solid, voxel_m, domain)};
}

}  // namespace topple::scenes
