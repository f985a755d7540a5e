// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

#include "geometry/frames_fusion.h"

namespace topple::geometry {
namespace {

constexpr std::uint32_t image_side = 320;
constexpr double focal = image_side / 2.0;  // 90 degrees
constexpr double centre = (image_side - 1) / 2.0;

// A coarse occupancy grid of the scene with a margin, to find free places in.
struct Coarse {
    Vec3 low{};
    double cell = 0;
    std::array<int, 3> size{};
    std::vector<bool> occupied;
    std::size_t at(int i, int j, int k) const {
        return (static_cast<std::size_t>(i) * static_cast<std::size_t>(size[1]) +
                static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(size[2]) +
               static_cast<std::size_t>(k);
    }
    bool inside(int i, int j, int k) const {
        return i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2];
    }
    Vec3 middle(const std::array<int, 3>& c) const {
        return {low[0] + (c[0] + 0.5) * cell, low[1] + (c[1] + 0.5) * cell,
                low[2] + (c[2] + 0.5) * cell};
    }
};

Coarse coarse_grid(const PointCloud& cloud, double spacing_m) {
    constexpr int most_cells = 48, margin = 2;
    const std::array<const std::vector<float>*, 3> p{&cloud.x, &cloud.y, &cloud.z};
    Coarse grid;
    Vec3 extent{};
    for (std::size_t a = 0; a < 3; ++a) {
        // The outer thousandth on each side is left out: stray points must not stretch the grid.
        std::vector<float> sorted = *p[a];
        const std::size_t cut = sorted.size() / 1000;
        const auto low = sorted.begin() + static_cast<std::ptrdiff_t>(cut);
        const auto high = sorted.end() - 1 - static_cast<std::ptrdiff_t>(cut);
        std::nth_element(sorted.begin(), low, sorted.end());
        grid.low[a] = *low;
        std::nth_element(sorted.begin(), high, sorted.end());
        extent[a] = *high - grid.low[a];
    }
    const double longest = *std::max_element(extent.begin(), extent.end());
    grid.cell = std::max({3 * spacing_m, longest / most_cells, 1e-6});
    for (std::size_t a = 0; a < 3; ++a) {
        grid.size[a] = static_cast<int>(extent[a] / grid.cell) + 1 + 2 * margin;
        grid.low[a] -= margin * grid.cell;
    }
    grid.occupied.assign(grid.at(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1) + 1, false);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        std::array<double, 3> c{};
        bool inside = true;
        for (std::size_t a = 0; a < 3; ++a) {
            c[a] = std::floor(((*p[a])[i] - grid.low[a]) / grid.cell);
            inside = inside && c[a] >= 0 && c[a] < grid.size[a];
        }
        if (!inside) continue;
        grid.occupied[grid.at(static_cast<int>(c[0]), static_cast<int>(c[1]),
                              static_cast<int>(c[2]))] = true;
    }
    return grid;
}

// Steps along the axes to the nearest occupied cell, from every cell.
std::vector<int> clearance(const Coarse& grid) {
    std::vector<int> distance(grid.occupied.size(), -1);
    std::deque<std::array<int, 3>> front;
    for (int i = 0; i < grid.size[0]; ++i) {
        for (int j = 0; j < grid.size[1]; ++j) {
            for (int k = 0; k < grid.size[2]; ++k) {
                if (!grid.occupied[grid.at(i, j, k)]) continue;
                distance[grid.at(i, j, k)] = 0;
                front.push_back({i, j, k});
            }
        }
    }
    while (!front.empty()) {
        const auto [i, j, k] = front.front();
        front.pop_front();
        constexpr std::array<std::array<int, 3>, 6> steps{
            {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
        for (const auto& s : steps) {
            const int a = i + s[0], b = j + s[1], c = k + s[2];
            if (!grid.inside(a, b, c) || distance[grid.at(a, b, c)] >= 0) continue;
            distance[grid.at(a, b, c)] = distance[grid.at(i, j, k)] + 1;
            front.push_back({a, b, c});
        }
    }
    return distance;
}

// Share of 26 directions in which something is seen: near 1 inside a room, near 0 outside of it.
double enclosure(const Coarse& grid, const std::array<int, 3>& from) {
    int hits = 0;
    for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dz = -1; dz <= 1; ++dz) {
                if (dx == 0 && dy == 0 && dz == 0) continue;
                int i = from[0], j = from[1], k = from[2];
                while (grid.inside(i, j, k) && !grid.occupied[grid.at(i, j, k)]) {
                    i += dx;
                    j += dy;
                    k += dz;
                }
                hits += grid.inside(i, j, k);
            }
        }
    }
    return hits / 26.0;
}

// Places with much free space around them that see much of the scene, spread out.
std::vector<Vec3> places(const Coarse& grid, std::uint32_t count) {
    const std::vector<int> clear = clearance(grid);
    struct Place {
        Vec3 at;
        double free;    // metres to the nearest surface
        double weight;  // enclosure
    };
    std::vector<Place> free;
    for (int i = 0; i < grid.size[0]; ++i) {
        for (int j = 0; j < grid.size[1]; ++j) {
            for (int k = 0; k < grid.size[2]; ++k) {
                const int distance = clear[grid.at(i, j, k)];
                if (distance < 2) continue;
                free.push_back(
                    {grid.middle({i, j, k}), distance * grid.cell, enclosure(grid, {i, j, k})});
            }
        }
    }
    std::vector<Vec3> chosen;
    std::vector<double> apart(free.size(), std::numeric_limits<double>::max());
    while (chosen.size() < count) {
        std::size_t best = free.size();
        double best_score = 0;
        for (std::size_t i = 0; i < free.size(); ++i) {
            // Squared: a place outside of the room has all the clearance in the world.
            const double score =
                std::min(free[i].free, 0.5 * apart[i]) * free[i].weight * free[i].weight;
            if (score > best_score) {
                best_score = score;
                best = i;
            }
        }
        if (best == free.size()) break;
        chosen.push_back(free[best].at);
        for (std::size_t i = 0; i < free.size(); ++i) {
            const double dx = free[i].at[0] - free[best].at[0],
                         dy = free[i].at[1] - free[best].at[1],
                         dz = free[i].at[2] - free[best].at[2];
            apart[i] = std::min(apart[i], std::sqrt(dx * dx + dy * dy + dz * dz));
        }
    }
    return chosen;
}

// Six views from one place: +-x, +-y, +-z of the input's frame. Each point lies in one of them, but
// its splat may reach over the border into others, so every view takes what falls into it.
void render(const PointCloud& cloud, double spacing_m, const Vec3& eye, double depth_scale,
            std::vector<DepthFrame>& frames) {
    for (std::size_t view = 0; view < 6; ++view) {
        const std::size_t f = view / 2, d = (f + 2) % 3, r = (f + 1) % 3;
        const double sign = view % 2 == 0 ? 1 : -1;
        // Columns right, down, forward with right x down = forward.
        DepthFrame frame;
        frame.depth.assign(std::size_t{image_side} * image_side, 0);
        Mat4& m = frame.camera_to_world;
        m = {};
        m[4 * r] = sign;
        m[4 * d + 1] = 1;
        m[4 * f + 2] = sign;
        m[3] = eye[0];
        m[7] = eye[1];
        m[11] = eye[2];
        m[15] = 1;
        const std::array<const std::vector<float>*, 3> p{&cloud.x, &cloud.y, &cloud.z};
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const double z = sign * ((*p[f])[i] - eye[f]);
            // Nearer than its own splat is wide, a point would fill the view.
            if (!(z > spacing_m)) continue;
            const double u = focal * sign * ((*p[r])[i] - eye[r]) / z + centre;
            const double v = focal * ((*p[d])[i] - eye[d]) / z + centre;
            // Neighbours may lie up to twice their typical distance apart; their splats must still
            // meet.
            const double half = focal * spacing_m / z + 0.5;
            if (u + half < 0 || v + half < 0 || u - half > image_side - 1 ||
                v - half > image_side - 1)
                continue;
            const auto clip = [](double value) {
                return static_cast<std::uint32_t>(std::clamp(value, 0.0, image_side - 1.0));
            };
            const std::uint32_t u0 = clip(std::ceil(u - half)), u1 = clip(std::floor(u + half));
            const std::uint32_t v0 = clip(std::ceil(v - half)), v1 = clip(std::floor(v + half));
            const auto stored =
                static_cast<std::uint16_t>(std::clamp(std::round(z * depth_scale), 1.0, 65535.0));
            for (std::uint32_t y = v0; y <= v1; ++y) {
                for (std::uint32_t x = u0; x <= u1; ++x) {
                    std::uint16_t& pixel = frame.depth[std::size_t{y} * image_side + x];
                    if (pixel == 0 || stored < pixel) pixel = stored;
                }
            }
        }
        frames.push_back(std::move(frame));
    }
}

}  // namespace

void virtual_frames(const PointCloud& cloud, double spacing_m, std::uint32_t count,
                    Intrinsics& intrinsics, std::vector<DepthFrame>& frames) {
    frames.clear();
    intrinsics = {image_side, image_side, focal, focal, centre, centre, 1000};
    if (cloud.size() == 0 || !(spacing_m > 0)) return;
    double longest = 0;
    for (const auto* axis : {&cloud.x, &cloud.y, &cloud.z}) {
        const auto [low, high] = std::minmax_element(axis->begin(), axis->end());
        longest = std::max(longest, double{*high} - double{*low});
    }
    const Coarse grid = coarse_grid(cloud, spacing_m);
    // No depth is longer than the scene plus the grid's margin.
    intrinsics.depth_scale = std::min(10000.0, 65535 / (longest + 4 * grid.cell));
    for (const Vec3& eye : places(grid, count)) {
        render(cloud, spacing_m, eye, intrinsics.depth_scale, frames);
    }
}

}  // namespace topple::geometry
