// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/algebraic_model.h"
#include "geometry/face_limits.h"
#include "geometry/merge.h"
#include "geometry/split.h"

namespace topple::geometry {

namespace {

// How far the ends of segments are set back from the border into their regions, in cells: beyond
// what the edge rounds, and not to the far side of a narrow face. Set by hand.
constexpr int set_back_cells = 3;
// Segments of a pair of regions and points on each, and points that stand for a region: enough that
// a share is known to about a tenth.
constexpr std::uint32_t segments = 24, points_per_segment = 8;
constexpr std::size_t region_samples = 48;

// Surfels, each once, in the order in which they were added.
class Reached {
  public:
    explicit Reached(std::size_t most) : slots_(std::bit_ceil(2 * most)) {}
    void clear() {
        for (const std::size_t at : taken_) slots_[at] = 0;
        taken_.clear();
        list_.clear();
    }
    void add(std::uint32_t i) {
        std::size_t at = (i * 0x9E3779B9u >> 7) & (slots_.size() - 1);
        for (; slots_[at] != 0; at = (at + 1) & (slots_.size() - 1))
            if (slots_[at] == i + 1) return;
        slots_[at] = i + 1;
        taken_.push_back(at);
        list_.push_back(i);
    }
    const std::vector<std::uint32_t>& list() const { return list_; }

  private:
    std::vector<std::uint32_t> slots_;  // open addressing: surfel + 1, or 0
    std::vector<std::size_t> taken_;    // slots
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
            for (const std::uint32_t j : s.around(i))
                if (regions.label[j] == label) reached.add(j);
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

RegionSamples sample_region(const Surfels& surfels, const CutRegions& cuts, std::size_t region) {
    const Region& of = cuts.regions.regions[region];
    const std::vector<std::uint32_t>& members = cuts.members[region];
    RegionSamples out;
    out.tolerance_m = own_surface_m(of.residual_m, surfels.cell_m);
    const std::size_t count = std::min(members.size(), region_samples);
    for (std::size_t n = 1; n <= count; ++n) {
        const std::size_t m = (n * members.size() + count - 1) / count - 1;
        const Eigen::Vector3d p = onto(of.model, position(surfels, members[m]));
        out.points.push_back(p);
        out.normals.push_back(gradient(of.model, p).normalized());
    }
    return out;
}

double inside_share(const Surfels& surfels, const Regions& regions, const Border& border,
                    const std::array<double, 2>& tolerance_m) {
    const auto a = static_cast<std::size_t>(border.a), b = static_cast<std::size_t>(border.b);
    const AlgebraicModel& fa = regions.regions[a].model;
    const AlgebraicModel& fb = regions.regions[b].model;
    const auto side = static_cast<std::size_t>(2 * set_back_cells + 1);
    Reached reached(side * side * side);
    std::uint64_t inside = 0, all = 0;
    const std::size_t lines = std::min<std::size_t>(segments, border.pairs.size());
    for (std::size_t line = 0; line < lines; ++line) {
        const auto [i, j] = border.pairs[line * border.pairs.size() / lines];
        const Eigen::Vector3d middle = 0.5 * (position(surfels, i) + position(surfels, j));
        const Eigen::Vector3d p = onto(
            fa, position(surfels, set_back(surfels, regions, i, middle, set_back_cells, reached)));
        const Eigen::Vector3d q = onto(
            fb, position(surfels, set_back(surfels, regions, j, middle, set_back_cells, reached)));
        for (std::uint32_t k = 1; k <= points_per_segment; ++k) {
            const double t = k / (points_per_segment + 1.0);
            const Eigen::Vector3d r = p + t * (q - p);
            ++all;
            inside +=
                distance(fa, r) < 0.5 * tolerance_m[0] && distance(fb, r) < 0.5 * tolerance_m[1];
        }
    }
    return all ? static_cast<double>(inside) / static_cast<double>(all) : 0;
}

double concavity(const RegionSamples& a, const RegionSamples& b, const FreeSpace& free) {
    // Samples lie on the models, whose places are surer than those of single points: half of what
    // noise moves a point by tells a plate from the table under it.
    const double tolerance = 0.5 * std::max(a.tolerance_m, b.tolerance_m);
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
