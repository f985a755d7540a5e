// SPDX-License-Identifier: MIT
#include "geometry/ledges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/split.h"

namespace topple::geometry {
namespace {

// Of a side: along it, out of it, and up; metres.
struct SidePoint {
    double along, out, height;
};
struct LedgeSide {
    std::vector<SidePoint> points;
    std::vector<double> height;  // of the points, for what looks at no more of all of them
    double from = std::numeric_limits<double>::infinity(), to = -from;  // along it

    void add(const SidePoint& p) {
        points.push_back(p);
        height.push_back(p.height);
        from = std::min(from, p.along);
        to = std::max(to, p.along);
    }
    // Those between two distances from a height, in their order: below it, and above.
    std::array<std::vector<SidePoint>, 2> around(double at, double nearest, double farthest) const {
        constexpr std::size_t at_once = 256;
        std::array<std::uint32_t, at_once> found{};
        std::array<std::vector<SidePoint>, 2> out;
        for (std::size_t first = 0; first < height.size(); first += at_once) {
            const std::size_t last = std::min(first + at_once, height.size());
            std::size_t count = 0;
            for (std::size_t n = first; n < last; ++n) {
                const double off = std::abs(height[n] - at);
                found[count] = static_cast<std::uint32_t>(n);
                count += std::size_t{off >= nearest} & std::size_t{off <= farthest};
            }
            for (std::size_t k = 0; k < count; ++k)
                out[height[found[k]] > at].push_back(points[found[k]]);
        }
        return out;
    }
};

// Sides are told apart by eighths of the circle; a box has four, with gaps between.
constexpr std::size_t side_sectors = 8;

// What lies on either side of a height is looked at from half a cell, where a cell holds points of
// one of them only, up to three.
constexpr double from_cells = 0.5, to_cells = 3;
constexpr std::size_t least_surfels_each = 12;  // surfels above, and below
// A smaller step than this may be a seam, a larger one is a concave edge, at which regions end.
constexpr double least_step_cells = 0.25, most_step_cells = 1.5;
// What speaks for a step, twice the logarithms of likelihood ratios: against upright sides without
// one, of all sides and of each that counts; and against sides that lean instead.
constexpr double least_evidence = 30, least_of_side = 6, least_over_lean = 8;
constexpr double most_of_side = 200;  // so that one side says no more than several
// Of the surfels at the height, those on sides with a step.
constexpr double least_stepped_share = 0.6;
// Of the length that is looked at; and that, of all of the side's.
constexpr double least_side_covered = 0.5, least_side_length = 0.6;
// A ledge shows at heights up to half a cell off it.
constexpr double height_step_cells = 0.25;
constexpr int least_ledge_heights = 2;
// How much sides lean that are upright, m/m.
constexpr double upright_side_slope = 0.03;
// Noise of a surfel is no less than this, cells.
constexpr double least_noise_cells = 0.05;

struct SideStep {
    double size_m = 0;                    // rms over the side
    double over_none = 0, over_lean = 0;  // evidence
    std::size_t surfels = 0;
};

// Equations in so many unknowns, a row each.
template <int unknowns>
using Equations = Eigen::Matrix<double, Eigen::Dynamic, unknowns>;
template <int unknowns>
using Fit = Eigen::Matrix<double, unknowns, 1>;

// Least squares with a prior of the last column's factor: 0 +- slope.
template <int unknowns>
class SideFit {
  public:
    SideFit(const Equations<unknowns>& rows, const Eigen::VectorXd& out)
        : rows_(rows),
          out_(out),
          normal_(rows.transpose() * rows),
          right_(rows.transpose() * out) {}
    // What is left. slope: infinite for none.
    double residual(double noise, double slope, Fit<unknowns>& fit) const {
        Eigen::Matrix<double, unknowns, unknowns> normal = normal_;
        constexpr Eigen::Index last = unknowns - 1;
        const double weight = std::isfinite(slope) ? noise * noise / (slope * slope) : 0;
        normal(last, last) += weight;
        fit = normal.ldlt().solve(right_);
        return (out_ - rows_ * fit).squaredNorm() + weight * fit[last] * fit[last];
    }

  private:
    const Equations<unknowns>& rows_;
    const Eigen::VectorXd& out_;
    Eigen::Matrix<double, unknowns, unknowns> normal_;
    Fit<unknowns> right_;
};

// Share of the side's length that has surfels above as well as below: legs under a table's edge
// have little of it.
double covered_by_both(const std::array<std::vector<SidePoint>, 2>& parts, double first,
                       double last, double cell_m) {
    const auto bins = static_cast<std::size_t>((last - first) / cell_m) + 1;
    std::array<std::vector<bool>, 2> covered{std::vector<bool>(bins), std::vector<bool>(bins)};
    for (std::size_t above = 0; above < 2; ++above)
        for (const SidePoint& p : parts[above]) covered[above][(p.along - first) / cell_m] = true;
    std::size_t both = 0;
    for (std::size_t b = 0; b < bins; ++b) both += covered[0][b] && covered[1][b];
    return static_cast<double>(both) / static_cast<double>(bins);
}

// A side at a height as two sides, each with its place and direction, and as one:
//   out = a [above] + a' [below] + b [above] along + b' [below] along + c height
//   out = a + b along + c height.
std::optional<SideStep> step_at(const LedgeSide& side, double height, double cell_m) {
    std::array<std::vector<SidePoint>, 2> parts =
        side.around(height, from_cells * cell_m, to_cells * cell_m);
    std::array<double, 2> low, high;
    for (std::size_t above = 0; above < 2; ++above) {
        low[above] = std::numeric_limits<double>::infinity();
        high[above] = -low[above];
        for (const SidePoint& p : parts[above]) {
            low[above] = std::min(low[above], p.along);
            high[above] = std::max(high[above], p.along);
        }
    }
    // Both where the other is, too: what only one of them has may be another face.
    const double first = std::max(low[0], low[1]) - 0.5 * cell_m,
                 last = std::min(high[0], high[1]) + 0.5 * cell_m;
    for (std::vector<SidePoint>& part : parts) {
        std::erase_if(part, [&](const SidePoint& p) { return p.along < first || p.along > last; });
        if (part.size() < least_surfels_each) return std::nullopt;
        // The means of cells at an edge lie behind it.
        const auto [bottom, top] = std::ranges::minmax_element(part, {}, &SidePoint::height);
        if (top->height - bottom->height < cell_m) return std::nullopt;
    }
    if (last - first < least_side_length * (side.to - side.from) ||
        covered_by_both(parts, first, last, cell_m) < least_side_covered)
        return std::nullopt;
    const auto count = static_cast<Eigen::Index>(parts[0].size() + parts[1].size());
    Equations<5> two(count, 5);
    Equations<3> one(count, 3);
    Eigen::VectorXd out(count);
    const double middle = 0.5 * (first + last);
    Eigen::Index n = 0;
    for (std::size_t above = 0; above < 2; ++above) {
        const double in = above ? 1 : 0;
        for (const SidePoint& p : parts[above]) {
            const double along = p.along - middle, up = p.height - height;
            two.row(n) << in, 1 - in, in * along, (1 - in) * along, up;
            one.row(n) << 1, along, up;
            out[n++] = p.out;
        }
    }
    constexpr double any_slope = std::numeric_limits<double>::infinity();
    const SideFit<5> as_two(two, out);
    const SideFit<3> as_one(one, out);
    Fit<5> fit;
    Fit<3> unused;
    const double free = as_two.residual(0, any_slope, fit);
    const double noise =
        std::max(std::sqrt(free / static_cast<double>(std::max<Eigen::Index>(count - 5, 1))),
                 least_noise_cells * cell_m);
    const double stepped = as_two.residual(noise, upright_side_slope, fit);
    SideStep step;
    step.over_none =
        (as_one.residual(noise, upright_side_slope, unused) - stepped) / (noise * noise);
    step.over_lean = (as_one.residual(noise, any_slope, unused) - stepped) / (noise * noise);
    double squares = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
        const double d = fit[0] - fit[1] + (fit[2] - fit[3]) * one(k, 1);
        squares += d * d;
    }
    step.size_m = std::sqrt(squares / static_cast<double>(count));
    step.surfels = static_cast<std::size_t>(count);
    return step;
}

// How sure a ledge at this height is: 0 for none.
double ledge_evidence(const std::array<LedgeSide, side_sectors>& sides, double height,
                      double cell_m) {
    double sure = 0, over_lean = 0;
    std::size_t all = 0, stepped = 0;
    std::vector<std::size_t> where;
    for (std::size_t k = 0; k < side_sectors; ++k) {
        const std::optional<SideStep> step = step_at(sides[k], height, cell_m);
        if (!step) continue;
        all += step->surfels;
        over_lean += std::clamp(step->over_lean, -most_of_side, most_of_side);
        if (step->over_none < least_of_side || step->size_m < least_step_cells * cell_m ||
            step->size_m > most_step_cells * cell_m)
            continue;
        stepped += step->surfels;
        sure += std::min(step->over_none, most_of_side);
        where.push_back(k);
    }
    if (sure < least_evidence || over_lean < least_over_lean ||
        static_cast<double>(stepped) < least_stepped_share * static_cast<double>(all))
        return 0;
    // Sides that look the same way, or away from each other, may be shifted by a bend.
    for (const std::size_t a : where)
        for (const std::size_t b : where)
            if ((b + side_sectors - a) % side_sectors == 2) return sure;
    return 0;
}

}  // namespace

std::optional<double> find_ledge(const Surfels& s, std::span<const std::uint32_t> members,
                                 const Eigen::Vector3d& up) {
    constexpr double upright = 0.35;  // largest cosine of a side's normal to up
    const Eigen::Vector3d east = up.unitOrthogonal(), north = up.cross(east);
    struct Place {
        std::uint32_t surfel;
        double azimuth;
    };
    std::vector<Place> places;
    std::complex<double> quarter = 0;
    for (const std::uint32_t i : members) {
        const Eigen::Vector3d n = normal(s, i);
        if (n.squaredNorm() < 0.5 || std::abs(n.dot(up)) > upright) continue;
        const double azimuth = std::atan2(n.dot(north), n.dot(east));
        places.push_back({i, azimuth});
        quarter += std::polar(1.0, 4 * azimuth);
    }
    // Box-like: of normals in all directions alike, as a bottle's, nothing is left.
    constexpr double box_like = 0.5;
    if (places.size() < 4 * least_surfels_each ||
        std::abs(quarter) < box_like * static_cast<double>(places.size()))
        return std::nullopt;
    const double turn = std::arg(quarter) / 4, width = 2 * std::numbers::pi / side_sectors;
    std::array<LedgeSide, side_sectors> sides;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Place& p : places) {
        const auto k = static_cast<std::int64_t>(std::floor((p.azimuth - turn) / width + 0.5));
        const std::size_t sector =
            static_cast<std::size_t>(k + 2 * std::int64_t{side_sectors}) % side_sectors;
        const double angle = turn + width * static_cast<double>(sector);
        const Eigen::Vector3d out = std::cos(angle) * east + std::sin(angle) * north;
        const Eigen::Vector3d at = position(s, p.surfel);
        sides[sector].add({up.cross(out).dot(at), out.dot(at), up.dot(at)});
        low = std::min(low, up.dot(at));
        high = std::max(high, up.dot(at));
    }
    std::optional<double> best;
    double most = 0;
    for (double h = low + s.cell_m; h <= high - s.cell_m;) {
        // A run of heights, and the surest of them.
        double sure = 0, at = 0;
        int heights = 0;
        for (; h <= high - s.cell_m; h += height_step_cells * s.cell_m) {
            const double e = ledge_evidence(sides, h, s.cell_m);
            if (e == 0) break;
            ++heights;
            if (e > sure) sure = e, at = h;
        }
        if (heights >= least_ledge_heights && sure > most) most = sure, best = at;
        h += height_step_cells * s.cell_m;
    }
    return best;
}

std::vector<Ledge> ledges_between(const Surfels& s, const PrimitiveSet& primitives,
                                  const Vec3& upwards) {
    constexpr std::size_t least_pairs = 12;
    const Eigen::Vector3d up(upwards[0], upwards[1], upwards[2]);
    struct Sum {
        double height = 0;
        std::size_t pairs = 0;
    };
    std::map<std::pair<std::int32_t, std::int32_t>, Sum> sums;  // above, below
    const std::vector<std::int32_t>& label = primitives.label;
    for (std::size_t n = 0; n < s.size(); ++n) {
        for (const std::uint32_t m : s.around(n)) {
            if (label[n] < 0 || label[m] < 0 || label[n] == label[m]) continue;
            const double own = up.dot(position(s, n)), other = up.dot(position(s, m));
            if (own <= other || !ledge_between(primitives, n, m)) continue;
            Sum& sum = sums[{label[n], label[m]}];
            sum.height += 0.5 * (own + other);
            ++sum.pairs;
        }
    }
    std::vector<Ledge> out;
    for (const auto& [pair, sum] : sums) {
        const auto back = sums.find({pair.second, pair.first});
        if (sum.pairs < least_pairs || (back != sums.end() && back->second.pairs >= sum.pairs))
            continue;
        out.push_back({pair.first, pair.second, sum.height / static_cast<double>(sum.pairs)});
    }
    return out;
}

}  // namespace topple::geometry
