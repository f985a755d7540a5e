// SPDX-License-Identifier: MIT
#include "points/given_attributes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace topple::geometry {
namespace {

// Cells are so many distances of neighbours wide, and about so many are looked at, of those with
// points enough for a plane.
constexpr double cell_pitches = 4;
constexpr std::size_t points_in_cell = 16, cells = 1500, least_points = 8;
// A cell is flat where its least spread is this share of the middle one, as variances; a normal
// fits its plane within 60 degrees.
constexpr double flat_share = 0.15, fits_cos = 0.5;
// Normals and colours are left out beyond these.
constexpr double most_askew = 0.15, most_opposed = 0.2, most_noise = 0.9;

using Cell = std::vector<std::uint32_t>;

// The points of cells by their hash; about every n-th cell, so that enough of them are there.
std::map<std::uint64_t, Cell> sampled_cells(const CloudView& cloud, double cell_m) {
    const std::uint64_t every = std::max<std::uint64_t>(1, cloud.size() / points_in_cell / cells);
    const auto index = [&](float v) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / cell_m)));
    };
    std::map<std::uint64_t, Cell> out;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        std::uint64_t hash = index(cloud.x[n]) * 0x9E3779B97F4A7C15u;
        hash = (hash ^ hash >> 32 ^ index(cloud.y[n])) * 0xBF58476D1CE4E5B9u;
        hash = (hash ^ hash >> 32 ^ index(cloud.z[n])) * 0x94D049BB133111EBu;
        hash ^= hash >> 32;
        if (hash % every == 0) out[hash].push_back(static_cast<std::uint32_t>(n));
    }
    std::erase_if(out, [](const auto& cell) { return cell.second.size() < least_points; });
    return out;
}

// The direction of a cell's surface; zero where it is not flat.
Eigen::Vector3d direction_of(const CloudView& cloud, const Cell& cell) {
    const auto at = [&](std::uint32_t n) {
        return Eigen::Vector3d(cloud.x[n], cloud.y[n], cloud.z[n]);
    };
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t n : cell) mean += at(n);
    mean /= static_cast<double>(cell.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const std::uint32_t n : cell) spread += (at(n) - mean) * (at(n) - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    if (!(axes.eigenvalues()[0] <= flat_share * axes.eigenvalues()[1])) return {0, 0, 0};
    return axes.eigenvectors().col(0);
}

void look_at_normals(const CloudView& cloud, const std::map<std::uint64_t, Cell>& sampled,
                     GivenAttributes& out) {
    double known = 0, askew = 0, opposed = 0;
    for (const auto& [hash, cell] : sampled) {
        const Eigen::Vector3d direction = direction_of(cloud, cell);
        if (direction.isZero()) continue;
        double front = 0, back = 0;
        for (const std::uint32_t n : cell) {
            const Eigen::Vector3d normal(cloud.nx[n], cloud.ny[n], cloud.nz[n]);
            const double length = normal.norm();
            if (!(length > 0)) continue;
            const double cosine = direction.dot(normal) / length;
            ++known;
            if (std::abs(cosine) < fits_cos)
                ++askew;
            else
                ++(cosine > 0 ? front : back);
        }
        opposed += std::min(front, back);
    }
    if (!(known > 0)) return;
    out.askew = askew / known;
    out.opposed = known > askew ? opposed / (known - askew) : 0;
}

void look_at_colours(const CloudView& cloud, const std::map<std::uint64_t, Cell>& sampled,
                     GivenAttributes& out) {
    struct Spread {
        double count = 0, sum = 0, squares = 0;
        void add(double v) {
            ++count;
            sum += v;
            squares += v * v;
        }
        double about_mean() const { return count > 0 ? squares - sum * sum / count : 0; }
    };
    const std::array<const ByteColumn*, 3> channels{&cloud.red, &cloud.green, &cloud.blue};
    const auto known = [&](std::size_t n) {
        return cloud.red[n] != 0 || cloud.green[n] != 0 || cloud.blue[n] != 0;
    };
    std::array<Spread, 3> all;
    double within = 0, freedom = 0;  // of the channels in cells
    for (const auto& [hash, cell] : sampled) {
        std::array<Spread, 3> here;
        for (const std::uint32_t n : cell) {
            if (!known(n)) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                const double v = (*channels[c])[n];
                here[c].add(v);
                all[c].add(v);
            }
        }
        if (here[0].count < 2) continue;
        for (const Spread& channel : here) within += channel.about_mean();
        freedom += here[0].count - 1;
    }
    double total = 0;
    for (const Spread& channel : all) total += channel.about_mean();
    if (total > 0 && freedom > 0)
        out.colour_noise = (within / freedom) / (total / std::max(1.0, all[0].count - 1));
    std::size_t first = 0;
    while (first < cloud.size() && !known(first)) ++first;
    out.one_colour = true;
    for (std::size_t n = first; n < cloud.size() && out.one_colour; ++n) {
        out.one_colour = !known(n) || std::ranges::all_of(channels, [&](const ByteColumn* channel) {
            return (*channel)[n] == (*channel)[first];
        });
    }
}

}  // namespace

bool GivenAttributes::normals_contradict() const {
    return askew > most_askew || opposed > most_opposed;
}

bool GivenAttributes::colours_tell() const {
    return !one_colour && colour_noise <= most_noise;
}

GivenAttributes look_at_attributes(const CloudView& cloud, double around_m) {
    GivenAttributes out;
    if ((cloud.nx.empty() && cloud.red.empty()) || !(around_m > 0)) return out;
    const std::map<std::uint64_t, Cell> sampled = sampled_cells(cloud, cell_pitches * around_m);
    if (!cloud.nx.empty()) look_at_normals(cloud, sampled, out);
    if (!cloud.red.empty()) look_at_colours(cloud, sampled, out);
    return out;
}

}  // namespace topple::geometry
