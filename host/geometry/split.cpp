// SPDX-License-Identifier: MIT
#include "geometry/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/ranked.h"
#include "geometry/algebraic_model.h"

namespace topple::geometry {

namespace {

constexpr std::uint64_t split_chunk = 1 << 13;  // surfels handed to a thread at once

// How far a surfel may be from a model, in standard deviations of its noise: of Gaussian noise one
// surfel in 370 is further.
constexpr double tolerance_sigmas = 3;
// Share of a cell that counts as noise even where the scan is clean: the error of resampling to
// cells. Set by hand.
constexpr double cell_noise_share = 0.1;
// How many times the typical angle between neighbouring normals is allowed: as tolerance_sigmas.
constexpr double angle_noises = tolerance_sigmas;

// The value at place `kept - 1` of a surfel's neighbourhood, in ascending order.
float nth_around(const Surfels& s, const std::vector<float>& value, std::size_t i,
                 std::size_t kept) {
    std::vector<float> around{value[i]};
    for (const std::uint32_t j : s.around(i)) around.push_back(value[j]);
    return ranked(around, kept - 1);
}

// The lower quartile of each surfel's neighbourhood, itself included: of 27 cells, of which those
// that both sides of a thin wall share have two surfels, and of ties to farther ones.
std::vector<float> lower_neighbours(const Surfels& s, const std::vector<float>& value,
                                    ThreadPool& threads) {
    constexpr std::size_t of_a_surface = 7;  // kept of 27
    std::vector<float> out(value.size());
    threads.each(value.size(), split_chunk, [&](std::size_t i) {
        const std::size_t kept = (1 + s.around(i).size()) / 4 + 1;
        if (kept > of_a_surface) {
            out[i] = nth_around(s, value, i, kept);
            return;
        }
        // The least ones so far, ascending.
        std::array<float, of_a_surface> least{};
        least.fill(std::numeric_limits<float>::infinity());
        const auto add = [&](float v) {
            if (!(v < least[kept - 1])) return;
            std::size_t at = kept - 1;
            for (; at > 0 && v < least[at - 1]; --at) least[at] = least[at - 1];
            least[at] = v;
        };
        add(value[i]);
        for (const std::uint32_t j : s.around(i)) add(value[j]);
        out[i] = least[kept - 1];
    });
    return out;
}

// Typical angle between neighbouring normals where the scan is smooth, radians.
double normal_noise(const Surfels& s, float smooth_m) {
    std::vector<float> angles;
    const std::size_t step = s.size() / 20000 + 1;
    for (std::size_t i = 0; i < s.size(); i += step) {
        if (s.roughness_m[i] > smooth_m) continue;
        for (const std::uint32_t j : s.around(i)) {
            if (s.roughness_m[j] > smooth_m) continue;
            const double c = normal(s, i).dot(normal(s, j));
            angles.push_back(static_cast<float>(std::acos(std::clamp(c, -1.0, 1.0))));
        }
    }
    return quantile(angles, 0.5);
}

}  // namespace

SplitScale measure_scale(const Surfels& surfels, ThreadPool& threads) {
    SplitScale scale;
    scale.layer_m = surfels.cell_m;
    std::vector<float> roughness = surfels.roughness_m;
    const float typical = quantile(roughness, 0.5), rough = quantile(roughness, 0.75);
    std::vector<float> noise = lower_neighbours(surfels, surfels.roughness_m, threads);
    noise = lower_neighbours(surfels, noise, threads);
    const double floor_m = cell_noise_share * surfels.cell_m;
    scale.tolerance_m.resize(surfels.size());
    threads.each(surfels.size(), split_chunk, [&](std::size_t i) {
        const double sigma = std::clamp(noise[i], 0.5f * typical, rough);
        scale.tolerance_m[i] = static_cast<float>(tolerance_sigmas * std::hypot(sigma, floor_m));
    });
    const double degree = EIGEN_PI / 180;
    scale.angle_rad = std::clamp(angle_noises * normal_noise(surfels, typical),
                                 least_angle_deg * degree, most_angle_deg * degree);
    return scale;
}

Region fit_region(const Surfels& surfels, const std::vector<std::uint32_t>& members, int degree,
                  double layer_m) {
    Region region;
    if (degree == 1) {
        PlaneMoments moments;
        for (const std::uint32_t i : members) moments.add(position(surfels, i), normal(surfels, i));
        region.model = fit_plane(moments, layer_m);
    } else {
        std::vector<Eigen::Vector3d> points, normals;
        for (const std::uint32_t i : members) {
            points.push_back(position(surfels, i));
            normals.push_back(normal(surfels, i));
        }
        region.model = fit_quadric(points, normals, layer_m);
    }
    double sum = 0;
    for (const std::uint32_t i : members) {
        const double d = distance(region.model, position(surfels, i));
        sum += d * d;
    }
    region.surfels = members.size();
    region.residual_m = std::sqrt(sum / static_cast<double>(members.size()));
    return region;
}

void refit_regions(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads,
                   Regions& regions) {
    std::vector<std::vector<std::uint32_t>> members(regions.regions.size());
    std::vector<std::int32_t> order;  // old ids by lowest surfel
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const std::int32_t label = regions.label[i];
        if (label < 0) continue;
        auto& list = members[label];
        if (list.empty()) order.push_back(label);
        list.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<Region> kept(order.size());
    threads.each(order.size(), 1, [&](std::size_t id) {
        const auto old = static_cast<std::size_t>(order[id]);
        kept[id] =
            fit_region(surfels, members[old], regions.regions[old].model.degree, scale.layer_m);
        for (const std::uint32_t i : members[old]) regions.label[i] = static_cast<std::int32_t>(id);
    });
    regions.regions = std::move(kept);
}

Regions split(const Surfels& surfels, ThreadPool& threads) {
    if (surfels.size() == 0) return {};
    const SplitScale scale = measure_scale(surfels, threads);
    Regions regions = grow_regions(surfels, scale, threads);
    refit_regions(surfels, scale, threads, regions);
    clean_regions(surfels, scale, threads, regions);
    return regions;
}

}  // namespace topple::geometry
