// SPDX-License-Identifier: MIT
#include "geometry/side_votes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <queue>

#include "core/vectors.h"
#include "geometry/surfel_discs.h"

namespace topple::geometry {
namespace {

// A surfel's side shows where it is seen no more obliquely than this (cosine), and is known to be
// seen from behind from here on.
constexpr double vote_cos = 0.25, behind_cos = 0.1;
// Neighbours whose normals' cosine is more lie in one surface.
constexpr float one_surface_cos = 0.8f;
// Of the surface around a surfel, what must be seen with it.
constexpr float least_pixel_share = 0.3f;
// What an eye that sees half of a surface around says of its side; less may be a leak.
constexpr float least_vote = 0.25f;
constexpr std::uint64_t vote_chunk = 1 << 14;  // surfels handed to a thread at once
// Rougher than this share of its cell, a surfel may be both faces of a thin board, or an edge.
constexpr double two_sided_cells = 0.25;

}  // namespace

SideVotes::SideVotes(const Surfels& surfels, std::span<const float> radii_m, ThreadPool& pool)
    : s_(surfels),
      radii_(radii_m),
      pool_(pool),
      side_(surfels.size(), 0),
      votes_(surfels.size(), 0) {}

double SideVotes::facing(std::size_t i, const Vec3& eye) const {
    const Vec3 d = minus(eye, {s_.x[i], s_.y[i], s_.z[i]});
    const double distance = length(d);
    return distance > 0 ? dot({s_.nx[i], s_.ny[i], s_.nz[i]}, d) / distance : 0;
}

bool SideVotes::one_sided(std::size_t i) const {
    return s_.has_normal(i) && s_.roughness_m[i] <= two_sided_cells * s_.cell_m;
}

bool SideVotes::from_behind(std::size_t i, const Vec3& eye) const {
    return one_sided(i) && side_[i] * facing(i, eye) < -behind_cos;
}

void SideVotes::believe_normals() {
    for (std::size_t i = 0; i < s_.size(); ++i) side_[i] = s_.has_normal(i) ? 1 : 0;
}

void SideVotes::forget() {
    std::ranges::fill(side_, std::int8_t{0});
}

float SideVotes::cosine(std::size_t i, std::size_t j) const {
    return s_.nx[i] * s_.nx[j] + s_.ny[i] * s_.ny[j] + s_.nz[i] * s_.nz[j];
}

// How much two surfels that belong together have their normals on one side: 1 in one plane, and
// where an edge or the thickness of a board parts them; -1 with one of the normals turned
// round. Koenig and Gumhold (2009) mirror one normal across the middle between both, which is
// where the other would be if the surface went on as an arc.
float SideVotes::agreement(std::size_t i, std::size_t j) const {
    const std::array<float, 3> d{s_.x[j] - s_.x[i], s_.y[j] - s_.y[i], s_.z[j] - s_.z[i]},
        n{s_.nx[i], s_.ny[i], s_.nz[i]}, m{s_.nx[j], s_.ny[j], s_.nz[j]};
    float cosine = 0, n_along = 0, m_along = 0, square = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        cosine += n[a] * m[a];
        n_along += n[a] * d[a];
        m_along += m[a] * d[a];
        square += d[a] * d[a];
    }
    return square > 0 ? cosine - 2 * n_along * m_along / square : cosine;
}

// Of the pixels that the surface that a surfel stands for takes up where nothing is before it.
float SideVotes::view_share(std::size_t i, std::uint32_t pixels, const Vec3& eye) const {
    const Vec3 d = minus({s_.x[i], s_.y[i], s_.z[i]}, eye);
    const double deep = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
    const double side = CubeView::focal * radii_[i] / radius_sides / deep;
    const double all = side * side * std::abs(facing(i, eye)) * length(d) / deep;
    return all > pixels ? static_cast<float>(pixels / all) : 1;
}

void SideVotes::count(CubeView& view) {
    std::vector<std::int8_t> seen(s_.size(), 0);  // from its normal's side 1, from the other -1
    std::vector<std::uint32_t> pixels(s_.size(), 0);
    pool_.each(6, 1, [&](std::size_t image) {
        view.for_each_seen(image, [&](std::uint32_t i, std::uint32_t count) {
            std::atomic_ref(pixels[i]).fetch_add(count, std::memory_order_relaxed);
            const double f = facing(i, view.eye);
            // The same in all images.
            if (!s_.has_normal(i) || std::abs(f) >= vote_cos)
                std::atomic_ref(seen[i]).store(f > 0 ? 1 : -1, std::memory_order_relaxed);
        });
    });
    std::vector<float> share(s_.size(), 1);
    pool_.each(s_.size(), vote_chunk, [&](std::size_t i) {
        if (seen[i] == 0) return;
        std::uint32_t around = 1, agree = 1;
        for (const std::uint32_t j : s_.around(i)) {
            const float along = agreement(i, j);
            if (std::abs(along) < one_surface_cos) continue;
            ++around;
            agree += seen[j] == (along > 0 ? seen[i] : -seen[i]);
        }
        share[i] = static_cast<float>(agree) / static_cast<float>(around);
        const float said = share[i] * view_share(i, pixels[i], view.eye);
        votes_[i] += static_cast<float>(seen[i]) * said * said;
    });
    pool_.each(6, 1, [&](std::size_t image) {
        for (std::uint32_t& i : view.surfel[image])
            if (i != CubeView::nothing && share[i] < least_pixel_share) i = CubeView::nothing;
    });
}

void SideVotes::agree() {
    for (std::size_t i = 0; i < s_.size(); ++i) {
        if (!s_.has_normal(i)) continue;
        float sum = votes_[i], voters = 1;
        for (const std::uint32_t j : s_.around(i)) {
            const float along = agreement(i, j);
            if (std::abs(along) <= one_surface_cos) continue;
            sum += along > 0 ? votes_[j] : -votes_[j];
            ++voters;
        }
        const bool known = std::abs(sum) >= least_vote * voters;
        side_[i] = static_cast<std::int8_t>(known ? (sum > 0 ? 1 : -1) : 0);
    }
}

void SideVotes::spread() {
    struct Reached {
        float said;
        std::uint32_t surfel;
        bool operator<(const Reached& o) const {
            return said != o.said ? said < o.said : surfel > o.surfel;
        }
    };
    std::vector<float> said(s_.size(), 0);  // for the normal's side, less for the other
    std::priority_queue<Reached> next;
    const auto tell = [&](std::uint32_t i) {
        for (const std::uint32_t j : s_.around(i)) {
            if (side_[j] != 0 || !s_.has_normal(j)) continue;
            said[j] += static_cast<float>(side_[i]) * std::abs(cosine(i, j)) * agreement(i, j);
            next.push({std::abs(said[j]), j});
        }
    };
    for (std::size_t i = 0; i < s_.size(); ++i)
        if (side_[i] != 0) tell(static_cast<std::uint32_t>(i));
    while (!next.empty()) {
        const Reached top = next.top();
        next.pop();
        if (side_[top.surfel] != 0 || top.said != std::abs(said[top.surfel])) continue;
        side_[top.surfel] = said[top.surfel] < 0 ? -1 : 1;
        tell(top.surfel);
    }
}

}  // namespace topple::geometry
