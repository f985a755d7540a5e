// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/algebraic_model.h"
#include "geometry/merge.h"

namespace topple::geometry {

namespace {

Eigen::Vector3d position(const Surfels& s, std::size_t i) {
    return {s.x[i], s.y[i], s.z[i]};
}

// Surfels, each once, in the order in which they were added.
class Reached {
  public:
    explicit Reached(std::size_t most) : slots_(std::bit_ceil(2 * most)) {}
    void clear() {
        list_.clear();
        std::fill(slots_.begin(), slots_.end(), 0u);
    }
    void add(std::uint32_t i) {
        std::size_t at = i * 0x9E3779B9u & (slots_.size() - 1);
        for (; slots_[at] != 0; at = (at + 1) & (slots_.size() - 1))
            if (slots_[at] == i + 1) return;
        slots_[at] = i + 1;
        list_.push_back(i);
    }
    const std::vector<std::uint32_t>& list() const { return list_; }

  private:
    std::vector<std::uint32_t> slots_;  // open addressing: surfel + 1, or 0
    std::vector<std::uint32_t> list_;
};

// The surfel farthest from `from` among those that `steps` steps inside the region reach.
std::uint32_t set_back(const Surfels& s, const Regions& regions, std::uint32_t start,
                       const Eigen::Vector3d& from, int steps, Reached& reached) {
    const std::int32_t label = regions.label[start];
    reached.clear();
    reached.add(start);
    std::size_t head = 0;
    for (int step = 0; step < steps; ++step) {
        const std::size_t ring_end = reached.list().size();
        for (; head < ring_end; ++head) {
            const std::uint32_t i = reached.list()[head];
            for (auto e = s.neighbour_first[i]; e < s.neighbour_first[i + 1]; ++e)
                if (regions.label[s.neighbours[e]] == label) reached.add(s.neighbours[e]);
        }
    }
    std::uint32_t best = start;
    double best_d = -1;
    for (const std::uint32_t i : reached.list()) {
        const double d = (position(s, i) - from).squaredNorm();
        if (d > best_d || (d == best_d && i < best)) best_d = d, best = i;
    }
    return best;
}

Eigen::Vector3d onto(const AlgebraicModel& model, const Eigen::Vector3d& p) {
    const Eigen::Vector3d g = gradient(model, p);
    const double length = g.norm();
    return length > 1e-9 ? Eigen::Vector3d(p - distance(model, p) * g / length) : p;
}

}  // namespace

std::vector<RegionSamples> sample_regions(const Surfels& surfels, const Regions& regions,
                                          const MergeOptions& options) {
    std::vector<RegionSamples> out(regions.regions.size());
    std::vector<std::uint64_t> seen(out.size(), 0);
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const std::int32_t label = regions.label[i];
        if (label < 0) continue;
        const auto k = static_cast<std::size_t>(label);
        const Region& region = regions.regions[k];
        // Sample number m stands at surfel m * count / samples of the region.
        const std::uint64_t count = std::max<std::uint64_t>(region.surfels, 1);
        const std::uint64_t wanted = std::min<std::uint64_t>(count, options.samples);
        const bool take = seen[k] * wanted / count != (seen[k] + 1) * wanted / count;
        ++seen[k];
        if (!take) continue;
        const Eigen::Vector3d p = onto(region.model, position(surfels, i));
        out[k].points.push_back(p);
        out[k].normals.push_back(gradient(region.model, p).normalized());
    }
    for (std::size_t k = 0; k < out.size(); ++k)
        out[k].tolerance_m = 2 * regions.regions[k].residual_m + 0.25 * surfels.cell_m;
    return out;
}

std::vector<Border> find_borders(const Surfels& surfels, const Regions& regions) {
    struct Pair {
        std::int32_t a, b;
        std::uint32_t i, j;
        auto operator<=>(const Pair&) const = default;
    };
    std::vector<Pair> pairs;
    for (std::uint32_t i = 0; i < surfels.size(); ++i) {
        if (regions.label[i] < 0) continue;
        for (auto e = surfels.neighbour_first[i]; e < surfels.neighbour_first[i + 1]; ++e) {
            const std::uint32_t j = surfels.neighbours[e];
            if (regions.label[j] > regions.label[i])
                pairs.push_back({regions.label[i], regions.label[j], i, j});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<Border> borders;
    for (const Pair& p : pairs) {
        if (borders.empty() || borders.back().a != p.a || borders.back().b != p.b)
            borders.push_back({p.a, p.b, {}});
        borders.back().pairs.emplace_back(p.i, p.j);
    }
    return borders;
}

double inside_share(const Surfels& surfels, const Regions& regions, const Border& border,
                    const std::array<double, 2>& tolerance_m, const MergeOptions& options) {
    const auto a = static_cast<std::size_t>(border.a), b = static_cast<std::size_t>(border.b);
    const AlgebraicModel& fa = regions.regions[a].model;
    const AlgebraicModel& fb = regions.regions[b].model;
    const auto side = static_cast<std::size_t>(2 * options.set_back_cells + 1);
    Reached reached(side * side * side);
    std::uint64_t inside = 0, all = 0;
    const std::size_t lines = std::min<std::size_t>(options.segments, border.pairs.size());
    for (std::size_t line = 0; line < lines; ++line) {
        const auto [i, j] = border.pairs[line * border.pairs.size() / lines];
        const Eigen::Vector3d middle = 0.5 * (position(surfels, i) + position(surfels, j));
        const int steps = options.set_back_cells;
        const Eigen::Vector3d p =
            onto(fa, position(surfels, set_back(surfels, regions, i, middle, steps, reached)));
        const Eigen::Vector3d q =
            onto(fb, position(surfels, set_back(surfels, regions, j, middle, steps, reached)));
        for (std::uint32_t k = 1; k <= options.points_per_segment; ++k) {
            const double t = k / (options.points_per_segment + 1.0);
            const Eigen::Vector3d r = p + t * (q - p);
            ++all;
            inside +=
                distance(fa, r) < 0.5 * tolerance_m[0] && distance(fb, r) < 0.5 * tolerance_m[1];
        }
    }
    return all ? static_cast<double>(inside) / static_cast<double>(all) : 0;
}

double concavity(const RegionSamples& a, const RegionSamples& b, const FreeSpace& free) {
    const double tolerance = std::max(a.tolerance_m, b.tolerance_m);
    constexpr std::size_t lines = 12;  // points of each region that lines are drawn between
    const std::size_t step_a = a.points.size() / lines + 1, step_b = b.points.size() / lines + 1;
    std::uint64_t in_front = 0, tried = 0, apart = 0;
    for (std::size_t i = 0; i < a.points.size(); ++i)
        for (std::size_t j = 0; j < b.points.size(); ++j) {
            const Eigen::Vector3d d = b.points[j] - a.points[i];
            const bool front = a.normals[i].dot(d) > tolerance || b.normals[j].dot(d) < -tolerance;
            in_front += front;
            if (i % step_a != 0 || j % step_b != 0) continue;
            ++tried;
            apart += front || free.between(a.points[i], b.points[j]);
        }
    const double all = static_cast<double>(a.points.size() * b.points.size());
    if (all == 0) return 0;
    return std::max(static_cast<double>(in_front) / all,
                    static_cast<double>(apart) / static_cast<double>(tried));
}

}  // namespace topple::geometry
