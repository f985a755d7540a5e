// SPDX-License-Identifier: MIT
#include "graph/borders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace topple::graph {
namespace {

using Eigen::Vector3d;
using geometry::SurfaceSamples;

constexpr double least_near_m = 0.06, near_edges = 2.2;
// What counts as clearly convex or concave (a sine), and as one plane (a cosine).
constexpr double clearly = 0.3, same_plane = 0.9;

// One sample and the nearest of another primitive.
struct Contact {
    std::int32_t a, b;  // a < b
    std::uint32_t from, to;
    float distance_m;
    bool of_a;  // whether `from` is a's
};

constexpr std::uint64_t sample_chunk = 1 << 12;  // samples handed to a thread at once

// A sample in its cell of a grid, by cell.
struct InCell {
    std::array<std::int32_t, 3> cell;
    std::uint32_t sample;
    auto operator<=>(const InCell&) const = default;
};

std::vector<InCell> by_cell(const SurfaceSamples& s, double edge_m) {
    const auto at = [&](float v) { return static_cast<std::int32_t>(std::floor(v / edge_m)); };
    std::vector<InCell> out;
    out.reserve(s.size());
    for (std::uint32_t n = 0; n < s.size(); ++n)
        if (s.primitive[n] >= 0) out.push_back({{at(s.x[n]), at(s.y[n]), at(s.z[n])}, n});
    std::ranges::sort(out);
    return out;
}

// The samples in the 27 cells around ones that are asked for in their order.
class Beside {
  public:
    explicit Beside(std::span<const InCell> samples, const InCell& first) : samples_(samples) {
        for (std::size_t column = 0; column < first_.size(); ++column)
            first_[column] = static_cast<std::size_t>(
                std::ranges::lower_bound(samples, low(first, column), {}, &InCell::cell) -
                samples.begin());
    }
    template <class Use>
    void each(const InCell& middle, const Use& use) {
        for (std::size_t column = 0; column < first_.size(); ++column) {
            const std::array<std::int32_t, 3> from = low(middle, column);
            std::size_t& first = first_[column];
            while (first < samples_.size() && samples_[first].cell < from) ++first;
            for (std::size_t n = first; n < samples_.size(); ++n) {
                const auto& cell = samples_[n].cell;
                if (cell[0] != from[0] || cell[1] != from[1] || cell[2] > from[2] + 2) break;
                use(samples_[n].sample);
            }
        }
    }

  private:
    static std::array<std::int32_t, 3> low(const InCell& middle, std::size_t column) {
        return {middle.cell[0] + static_cast<std::int32_t>(column / 3) - 1,
                middle.cell[1] + static_cast<std::int32_t>(column % 3) - 1, middle.cell[2] - 1};
    }

    std::span<const InCell> samples_;
    std::array<std::size_t, 9> first_{};  // of each column of three cells along z
};

// Sorted by (a, b, from).
std::vector<Contact> find_contacts(const SurfaceSamples& s, ThreadPool& threads) {
    const double reach = near_m(s.spacing_m);
    const std::vector<InCell> samples = by_cell(s, reach);
    std::vector<std::vector<Contact>> parts(samples.size() / sample_chunk + 1);
    threads.run(samples.size(), sample_chunk, [&](std::uint64_t first, std::uint64_t last) {
        std::vector<Contact>& part = parts[first / sample_chunk];
        std::vector<Contact> found;  // of one sample, one for each other primitive
        Beside beside(samples, samples[first]);
        for (std::uint64_t at = first; at < last; ++at) {
            const std::uint32_t n = samples[at].sample;
            found.clear();
            beside.each(samples[at], [&](std::uint32_t m) {
                if (s.primitive[m] == s.primitive[n]) return;
                const double dx = s.x[m] - s.x[n], dy = s.y[m] - s.y[n], dz = s.z[m] - s.z[n];
                const auto d = static_cast<float>(std::sqrt(dx * dx + dy * dy + dz * dz));
                if (d > reach) return;
                for (Contact& c : found) {
                    if (s.primitive[c.to] != s.primitive[m]) continue;
                    if (std::tie(d, m) < std::tie(c.distance_m, c.to)) c.to = m, c.distance_m = d;
                    return;
                }
                const auto [a, b] = std::minmax(s.primitive[n], s.primitive[m]);
                found.push_back({a, b, n, m, d, s.primitive[n] == a});
            });
            part.insert(part.end(), found.begin(), found.end());
        }
    });
    std::vector<Contact> out;
    for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
    std::ranges::sort(out, {}, [](const Contact& c) { return std::tuple(c.a, c.b, c.from); });
    return out;
}

Border border_of(const SurfaceSamples& s, std::span<const Contact> contacts) {
    Border out;
    out.a = contacts.front().a;
    out.b = contacts.front().b;
    out.low = INFINITY;
    out.high = -INFINITY;
    std::vector<float> gaps;
    double coloured = 0;
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    std::vector<Vector3d> middles;
    const auto place = [&](std::uint32_t n) { return Vector3d(s.x[n], s.y[n], s.z[n]); };
    const auto normal = [&](std::uint32_t n) { return Vector3d(s.nx[n], s.ny[n], s.nz[n]); };
    for (const Contact& c : contacts) {
        (c.of_a ? out.near_a : out.near_b) += 1;
        gaps.push_back(c.distance_m);
        const std::uint32_t i = c.of_a ? c.from : c.to, j = c.of_a ? c.to : c.from;
        const Vector3d d = place(j) - place(i), unit = d / std::max(d.norm(), 1e-6);
        const Vector3d m = normal(i), n = normal(j);
        const double bend = (n - m).dot(unit), cosine = m.dot(n);
        const double off = 0.5 * (std::abs(m.dot(d)) + std::abs(n.dot(d)));
        out.convexity += bend;
        out.convex_share += bend > clearly;
        out.concave_share += bend < -clearly;
        out.parallel += cosine;
        out.flush_share += cosine > same_plane && off < 0.35 * s.spacing_m;
        out.offset += off;
        out.direction += unit;
        const Vector3d middle = 0.5 * (place(i) + place(j));
        middles.push_back(middle);
        out.center += middle;
        out.low = std::min(out.low, middle[2]);
        out.high = std::max(out.high, middle[2]);
        if (!s.coloured()) continue;
        const Vector3d colour(s.lab_l[i] - s.lab_l[j], s.lab_a[i] - s.lab_a[j],
                              s.lab_b[i] - s.lab_b[j]);
        if (!colour.allFinite()) continue;
        out.colour += colour.norm();
        coloured += 1;
    }
    const double count = static_cast<double>(contacts.size());
    for (double* sum : {&out.convexity, &out.convex_share, &out.concave_share, &out.parallel,
                        &out.flush_share, &out.offset})
        *sum /= count;
    out.colour /= coloured;
    out.direction /= count;
    out.center /= count;
    for (const Vector3d& middle : middles)
        products += (middle - out.center) * (middle - out.center).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(products / count,
                                                                Eigen::EigenvaluesOnly);
    out.spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    std::ranges::sort(gaps);
    out.gap_least = gaps.front();
    out.gap_20 = gaps[gaps.size() / 5];
    out.gap_50 = gaps[gaps.size() / 2];
    return out;
}

}  // namespace

double near_m(double spacing_m) {
    return std::max(least_near_m, near_edges * spacing_m);
}

std::vector<Border> find_borders(const SurfaceSamples& samples, ThreadPool& threads) {
    const std::vector<Contact> contacts = find_contacts(samples, threads);
    const auto same = [](const Contact& x, const Contact& y) { return x.a == y.a && x.b == y.b; };
    std::vector<std::span<const Contact>> of;
    for (std::size_t first = 0; first < contacts.size();) {
        std::size_t last = first;
        while (last < contacts.size() && same(contacts[last], contacts[first])) ++last;
        of.push_back(std::span(contacts).subspan(first, last - first));
        first = last;
    }
    std::vector<Border> out(of.size());
    threads.each(of.size(), 16, [&](std::size_t n) { out[n] = border_of(samples, of[n]); });
    return out;
}

}  // namespace topple::graph
