// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/ranked.h"
#include "core/rotation.h"
#include "core/solid_scene.h"
#include "core/union_find.h"
#include "live/appeared.h"
#include "physics/sliding.h"
#include "physics/tipping.h"
#include "vdb/voxel_scene.h"

namespace topple::live {
namespace {

// Readings of a cluster, at least, and how far apart the fine voxels are that belong together.
constexpr std::size_t least_readings = 80;
constexpr std::int32_t together = 4;
// Of the median over a cluster's voxels, the readings that one has that is more than noise.
constexpr double least_of_median = 0.5;
// Of a frame's readings at nothing that is known, those that must have come for it to tell of any.
constexpr double least_came = 0.5;
// So far below what was seen of a thing it may stand on something, voxels of the scene.
constexpr std::int32_t reach_below = 4;

Place cell_of(const Vec3& place, double voxel_m) {
    Place out{};
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = static_cast<std::int32_t>(std::floor(place[a] / voxel_m));
    return out;
}

// A voxel, and how many readings lie in it.
using Count = std::pair<Place, std::size_t>;

// Those that are more than noise, by how dense the readings of theirs lie.
std::vector<Place> dense_cells(const std::vector<Count>& cluster) {
    std::vector<double> counts;
    for (const auto& [cell, count] : cluster) counts.push_back(static_cast<double>(count));
    const double least = least_of_median * upper_median(counts);
    std::vector<Place> out;
    for (const auto& [cell, count] : cluster)
        if (static_cast<double>(count) >= least) out.push_back(cell);
    return out;
}

// counts: sorted. The largest first.
std::vector<std::vector<Place>> clusters(const std::vector<Count>& counts) {
    UnionFind sets(counts.size());
    for (std::size_t n = 0; n < counts.size(); ++n)
        for (std::int32_t di = 0; di <= together; ++di)
            for (std::int32_t dj = -together; dj <= together; ++dj) {
                // A run of the column's sorted cells.
                const Place low = sum_of(counts[n].first, {di, dj, -together});
                auto other = std::ranges::lower_bound(counts, low, {}, &Count::first);
                for (; other != counts.end() && other->first <= sum_of(low, {0, 0, 2 * together});
                     ++other)
                    sets.join(n, static_cast<std::size_t>(other - counts.begin()));
            }
    std::map<std::size_t, std::vector<Count>> of;
    std::map<std::size_t, std::size_t> readings;
    for (std::size_t n = 0; n < counts.size(); ++n) {
        of[sets.root(n)].push_back(counts[n]);
        readings[sets.root(n)] += counts[n].second;
    }
    std::vector<std::vector<Place>> out;
    for (const auto& [set, members] : of)
        if (readings[set] >= least_readings) out.push_back(dense_cells(members));
    std::ranges::stable_sort(out, std::ranges::greater{}, &std::vector<Place>::size);
    return out;
}

// The layer above what carries a cluster, whose lowest is `lowest`: above the highest solid voxel
// under any of its columns; none where nothing is near.
std::optional<std::int32_t> layer_above_carrier(const SolidScene& solids,
                                                const std::vector<Place>& cluster,
                                                std::int32_t lowest) {
    const std::int32_t below = coarse({0, 0, lowest})[2];
    std::optional<std::int32_t> out;
    for (const Place& cell : cluster) {
        const auto [first, last] = solids.columns().at(coarse(cell)[0], coarse(cell)[1]);
        for (std::size_t c = first; c < last; ++c) {
            const std::int32_t k = solids.cells().k[c];
            if (k <= below && k + 1 >= below - reach_below)
                out = std::max(out.value_or(k + 1), k + 1);
        }
    }
    return out;
}

bool holds(const physics::Polygon& polygon, double x, double y) {
    for (std::size_t e = 0; e < polygon.size(); ++e) {
        const auto &a = polygon[e], &b = polygon[(e + 1) % polygon.size()];
        if ((b[0] - a[0]) * (y - a[1]) < (b[1] - a[1]) * (x - a[0])) return false;
    }
    return true;
}

// In each layer, from that of its base on, what lies within the convex outline of all that of the
// cluster is as high or higher. Sorted.
std::vector<Place> filled(std::vector<Place> cluster, std::int32_t base) {
    std::ranges::stable_sort(cluster, std::ranges::greater{},
                             [](const Place& at) { return at[2]; });
    std::vector<Place> out;
    physics::Polygon outline;
    std::size_t next = 0;
    for (std::int32_t k = cluster.front()[2]; k >= base; --k) {
        const std::size_t first = next;
        for (; next < cluster.size() && cluster[next][2] == k; ++next)
            for (const double x : {0.0, 1.0})
                for (const double y : {0.0, 1.0})
                    outline.push_back({cluster[next][0] + x, cluster[next][1] + y});
        if (next > first) outline = physics::convex_polygon(std::move(outline));
        const auto [low_i, high_i] = std::ranges::minmax(outline, {}, [](auto& c) { return c[0]; });
        const auto [low_j, high_j] = std::ranges::minmax(outline, {}, [](auto& c) { return c[1]; });
        for (auto i = static_cast<std::int32_t>(low_i[0]); i < high_i[0]; ++i)
            for (auto j = static_cast<std::int32_t>(low_j[1]); j < high_j[1]; ++j)
                if (holds(outline, i + 0.5, j + 0.5)) out.push_back({i, j, k});
    }
    std::ranges::sort(out);
    return out;
}

}  // namespace

std::vector<Vec3> places_that_came(const ParseResult& scene, const FrameLabeller& labeller,
                                   const PointCloud& points, const Mat4& sensor_to_world,
                                   const Projection& projection, const std::vector<bool>& came,
                                   unsigned threads) {
    const vdb::VoxelFrame& frame = scene.voxels->frame();
    const auto in_grid = [&](const PointCloud& of, std::size_t i) {
        return frame.grid_of(transformed(sensor_to_world, {of.x[i], of.y[i], of.z[i]}));
    };
    // First what costs less.
    PointCloud free;
    std::vector<bool> has_come;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto seen = projection.see({points.x[i], points.y[i], points.z[i]});
        if (!seen) continue;
        const auto [x, y, z] = cell_of(in_grid(points, i), frame.voxel_m);
        if (scene.voxels->state_at(x, y, z) != vdb::State::empty) continue;
        has_come.push_back(came[seen->pixel]);
        free.x.push_back(points.x[i]);
        free.y.push_back(points.y[i]);
        free.z.push_back(points.z[i]);
    }
    const PointLabels known = labeller.label(CloudView(free), sensor_to_world, threads);
    std::vector<Vec3> out;
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
        if (known.primitive[i] >= 0 || known.object[i] >= 0) continue;
        ++unknown;
        if (has_come[i]) out.push_back(in_grid(free, i));
    }
    // Where poses are off, most of what is not where it was is no further off than they may be.
    if (static_cast<double>(out.size()) < least_came * static_cast<double>(unknown)) return {};
    return out;
}

std::vector<std::vector<Place>> new_bodies(const ParseResult& scene, std::span<const Vec3> places) {
    const SolidCells& solid = scene.solids->cells();
    std::map<Place, std::size_t> readings;
    for (const Vec3& place : places) ++readings[cell_of(place, solid.voxel_m / finer)];
    std::vector<std::vector<Place>> out;
    for (const std::vector<Place>& cluster : clusters({readings.begin(), readings.end()})) {
        const std::int32_t lowest =
            std::ranges::min(cluster, {}, [](const Place& cell) { return cell[2]; })[2];
        const auto base = layer_above_carrier(*scene.solids, cluster, lowest);
        if (!base) continue;
        std::vector<Place> body = filled(cluster, *base * finer);
        std::erase_if(body, [&](const Place& at) {
            const std::size_t there = first_at(solid, coarse(at));
            return there < solid.size() && place_of(solid, there) == coarse(at);
        });
        if (!body.empty()) out.push_back(std::move(body));
    }
    return out;
}

}  // namespace topple::live
