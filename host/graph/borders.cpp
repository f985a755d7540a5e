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

// Samples by cells of a grid, each cell a range.
class Cells {
  public:
    Cells(const SurfaceSamples& s, double edge_m) : edge_m_(edge_m), samples_(s) {
        entries_.reserve(s.size());
        for (std::uint32_t n = 0; n < s.size(); ++n) {
            if (s.primitive[n] >= 0) entries_.push_back({cell(n), n});
        }
        std::ranges::sort(entries_);
    }
    // Calls use(own, around) for each cell: its samples, and all in it and the 26 about it.
    template <class Use>
    void each(const Use& use) const {
        std::vector<std::uint32_t> own, around;
        for (auto at = entries_.begin(); at != entries_.end();) {
            const std::array<std::int32_t, 3> middle = at->first;
            own.clear();
            for (; at != entries_.end() && at->first == middle; ++at) own.push_back(at->second);
            around.clear();
            for (std::int32_t i = -1; i <= 1; ++i)
                for (std::int32_t j = -1; j <= 1; ++j)
                    add_column({middle[0] + i, middle[1] + j, middle[2]}, around);
            use(own, around);
        }
    }

  private:
    using Entry = std::pair<std::array<std::int32_t, 3>, std::uint32_t>;

    std::array<std::int32_t, 3> cell(std::uint32_t n) const {
        const auto at = [&](float v) { return static_cast<std::int32_t>(std::floor(v / edge_m_)); };
        return {at(samples_.x[n]), at(samples_.y[n]), at(samples_.z[n])};
    }
    // All samples in the column of three cells along z about one.
    void add_column(std::array<std::int32_t, 3> middle, std::vector<std::uint32_t>& out) const {
        const std::array<std::int32_t, 3> low{middle[0], middle[1], middle[2] - 1};
        auto at = std::ranges::lower_bound(entries_, low, {}, &Entry::first);
        for (; at != entries_.end() && at->first[0] == middle[0] && at->first[1] == middle[1] &&
               at->first[2] <= middle[2] + 1;
             ++at)
            out.push_back(at->second);
    }

    double edge_m_;
    const SurfaceSamples& samples_;
    std::vector<Entry> entries_;
};

std::vector<Contact> find_contacts(const SurfaceSamples& s) {
    const double reach = near_m(s.spacing_m);
    std::vector<Contact> out;
    std::vector<Contact> found;  // of one sample, one for each other primitive
    Cells(s, reach).each([&](std::span<const std::uint32_t> own,
                             std::span<const std::uint32_t> around) {
        for (const std::uint32_t n : own) {
            found.clear();
            for (const std::uint32_t m : around) {
                if (s.primitive[m] == s.primitive[n]) continue;
                const double dx = s.x[m] - s.x[n], dy = s.y[m] - s.y[n], dz = s.z[m] - s.z[n];
                const auto d = static_cast<float>(std::sqrt(dx * dx + dy * dy + dz * dz));
                if (d > reach) continue;
                const auto known = std::ranges::find_if(
                    found, [&](const Contact& c) { return s.primitive[c.to] == s.primitive[m]; });
                if (known == found.end()) {
                    const auto [a, b] = std::minmax(s.primitive[n], s.primitive[m]);
                    found.push_back({a, b, n, m, d, s.primitive[n] == a});
                } else if (std::tie(d, m) < std::tie(known->distance_m, known->to)) {
                    known->to = m;
                    known->distance_m = d;
                }
            }
            out.insert(out.end(), found.begin(), found.end());
        }
    });
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

std::vector<Border> find_borders(const SurfaceSamples& samples) {
    const std::vector<Contact> contacts = find_contacts(samples);
    std::vector<Border> out;
    for (std::size_t first = 0; first < contacts.size();) {
        std::size_t last = first;
        while (last < contacts.size() && contacts[last].a == contacts[first].a &&
               contacts[last].b == contacts[first].b)
            ++last;
        out.push_back(border_of(samples, std::span(contacts).subspan(first, last - first)));
        first = last;
    }
    return out;
}

}  // namespace topple::graph
