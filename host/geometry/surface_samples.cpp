// SPDX-License-Identifier: MIT
#include "geometry/surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/ranked.h"
#include "core/rows.h"
#include "core/sorted_order.h"

namespace topple::geometry {
namespace {

// A cell and a point in it.
struct Key {
    std::int32_t i, j, k;
    std::uint32_t point;
    bool same_cell(const Key& o) const { return i == o.i && j == o.j && k == o.k; }
    friend auto operator<=>(const Key&, const Key&) = default;
};

// Numbers of this unit are added up exactly, whatever their order. As std::llround() does, which is
// a call: value / unit has the few digits of a float.
std::int64_t in_units(double value, double unit) {
    const double units = value * unit;
    return static_cast<std::int64_t>(units + (units < 0 ? -0.5 : 0.5));
}

// Samples at random on a surface, one in each square of side s on average, have their sixth
// neighbour at a median distance of sqrt(5.67 / pi) s.
double find_spacing(const SurfaceSamples& s) {
    constexpr std::size_t most = 1500, nth = 6;
    const double lattice = std::sqrt(3.14159265358979 / 5.67);
    const double cell = 4 * s.edge_m;
    std::vector<std::pair<std::array<std::int32_t, 3>, std::uint32_t>> cells;
    const auto at = [&](std::size_t n) {
        const auto index = [&](float v) { return static_cast<std::int32_t>(std::floor(v / cell)); };
        return std::array{index(s.x[n]), index(s.y[n]), index(s.z[n])};
    };
    for (std::size_t n = 0; n < s.size(); ++n)
        cells.emplace_back(at(n), static_cast<std::uint32_t>(n));
    std::ranges::sort(cells);
    std::vector<double> sixth, distance;
    const std::size_t step = std::max<std::size_t>(1, s.size() / most);
    for (std::size_t n = 0; n < s.size(); n += step) {
        distance.clear();
        const auto [i, j, k] = at(n);
        for (std::int32_t di = -1; di <= 1; ++di) {
            for (std::int32_t dj = -1; dj <= 1; ++dj) {
                const std::array low{i + di, j + dj, k - 1};
                auto entry =
                    std::ranges::lower_bound(cells, low, {}, [](const auto& e) { return e.first; });
                for (; entry != cells.end() && entry->first[0] == i + di &&
                       entry->first[1] == j + dj && entry->first[2] <= k + 1;
                     ++entry) {
                    const std::size_t m = entry->second;
                    if (m != n)
                        distance.push_back(
                            std::hypot(s.x[m] - s.x[n], s.y[m] - s.y[n], s.z[m] - s.z[n]));
                }
            }
        }
        if (distance.size() < nth) {  // farther than the cells around it
            sixth.push_back(cell);
            continue;
        }
        sixth.push_back(ranked(distance, nth - 1));
    }
    if (sixth.empty()) return s.edge_m;
    return std::max(s.edge_m, lattice * upper_median(sixth));
}

// The mean of the colours that are known, in fixed point as above.
void add_colour(const Surfels& surfels, std::span<const Key> keys, SurfaceSamples& out) {
    std::array<std::int64_t, 3> sum{};
    std::int64_t known = 0;
    constexpr double unit = 1 << 16;
    for (const Key& key : keys) {
        const std::size_t s = surfels.of_point[key.point];
        if (std::isnan(surfels.lab_l[s])) continue;
        ++known;
        sum[0] += in_units(surfels.lab_l[s], unit);
        sum[1] += in_units(surfels.lab_a[s], unit);
        sum[2] += in_units(surfels.lab_b[s], unit);
    }
    std::size_t axis = 0;
    for (auto* values : {&out.lab_l, &out.lab_a, &out.lab_b}) {
        const double mean = static_cast<double>(sum[axis++]) / (static_cast<double>(known) * unit);
        values->push_back(known ? static_cast<float>(mean)
                                : std::numeric_limits<float>::quiet_NaN());
    }
}

Vec3 turned(const SceneFrame& frame, double x, double y, double z) {
    Vec3 p{};
    for (std::size_t a = 0; a < 3; ++a)
        p[a] = frame.axes[a][0] * x + frame.axes[a][1] * y + frame.axes[a][2] * z;
    return p;
}

// The cells of some points, sorted.
std::vector<Key> sorted_keys(const CloudView& cloud, std::span<const std::uint32_t> points,
                             const SceneFrame& frame, double edge_m) {
    std::vector<Key> keys;
    keys.reserve(points.size());
    for (const std::uint32_t n : points) {
        const Vec3 p = turned(frame, cloud.x[n], cloud.y[n], cloud.z[n]);
        const auto cell = [&](std::size_t a) {
            return static_cast<std::int32_t>(std::floor(p[a] / edge_m));
        };
        keys.push_back({cell(0), cell(1), cell(2), n});
    }
    std::ranges::sort(keys);
    return keys;
}

// The mean of the points of a cell. Sums of fixed-point numbers: exact, so that the order of points
// plays no part.
void add_sample(const CloudView& cloud, const Surfels& surfels, const SceneFrame& frame,
                std::span<const Key> keys, SurfaceSamples& out) {
    std::array<std::int64_t, 6> sum{};
    constexpr double unit = 1 << 20;
    for (const Key& key : keys) {
        const std::size_t n = key.point, s = surfels.of_point[n];
        const std::array<double, 6> v{cloud.x[n],    cloud.y[n],    cloud.z[n],
                                      surfels.nx[s], surfels.ny[s], surfels.nz[s]};
        for (std::size_t a = 0; a < 6; ++a) sum[a] += in_units(v[a], unit);
    }
    const double count = static_cast<double>(keys.size()) * unit;
    const auto mean = [&](std::size_t a) { return static_cast<double>(sum[a]) / count; };
    const Vec3 p = turned(frame, mean(0), mean(1), mean(2)),
               n = turned(frame, mean(3), mean(4), mean(5));
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    out.x.push_back(static_cast<float>(p[0]));
    out.y.push_back(static_cast<float>(p[1]));
    out.z.push_back(static_cast<float>(p[2]));
    const double scale = length > 1e-6 ? 1 / length : 0;
    out.nx.push_back(static_cast<float>(scale * n[0]));
    out.ny.push_back(static_cast<float>(scale * n[1]));
    out.nz.push_back(static_cast<float>(scale * n[2]));
    if (!surfels.lab_l.empty()) add_colour(surfels, keys, out);
}

void append(const SurfaceSamples& part, SurfaceSamples& out) {
    const auto to = columns_of(out);
    const auto from = columns_of(part);
    for (std::size_t c = 0; c < to.size(); ++c)
        to[c]->insert(to[c]->end(), from[c]->begin(), from[c]->end());
    out.primitive.insert(out.primitive.end(), part.primitive.begin(), part.primitive.end());
}

SurfaceSamples taken(const SurfaceSamples& from, const std::vector<std::uint32_t>& which) {
    SurfaceSamples out;
    out.edge_m = from.edge_m;
    out.spacing_m = from.spacing_m;
    const auto columns = columns_of(out);
    const auto sources = columns_of(from);
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (sources[c]->empty()) continue;
        columns[c]->reserve(which.size());
        for (const std::size_t n : which) columns[c]->push_back((*sources[c])[n]);
    }
    for (const std::size_t n : which) out.primitive.push_back(from.primitive[n]);
    return out;
}

}  // namespace

SurfaceSamples sample_surface(const CloudView& cloud, const Surfels& surfels,
                              std::span<const std::int32_t> primitive_of_point,
                              const SceneFrame& frame, double edge_m, ThreadPool& threads) {
    std::int32_t last_primitive = -1;
    for (const std::int32_t p : primitive_of_point) last_primitive = std::max(last_primitive, p);
    // Those without a primitive first.
    std::vector<SurfaceSamples> parts(static_cast<std::size_t>(last_primitive) + 2);
    const Rows<std::uint32_t> members(parts.size(), [&](const auto& add) {
        for (std::uint32_t n = 0; n < cloud.size(); ++n)
            add(static_cast<std::size_t>(primitive_of_point[n] + 1), n);
    });
    threads.each(parts.size(), 1, [&](std::size_t p) {
        const std::vector<Key> keys = sorted_keys(cloud, members[p], frame, edge_m);
        for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
            while (last < keys.size() && keys[last].same_cell(keys[first])) ++last;
            add_sample(cloud, surfels, frame, std::span(keys).subspan(first, last - first),
                       parts[p]);
        }
        parts[p].primitive.resize(parts[p].x.size(), static_cast<std::int32_t>(p) - 1);
    });
    SurfaceSamples out;
    out.edge_m = edge_m;
    for (const SurfaceSamples& part : parts) append(part, out);
    out.spacing_m = find_spacing(out);
    return out;
}

std::array<std::vector<float>*, 9> columns_of(SurfaceSamples& s) {
    return {&s.x, &s.y, &s.z, &s.nx, &s.ny, &s.nz, &s.lab_l, &s.lab_a, &s.lab_b};
}

std::array<const std::vector<float>*, 9> columns_of(const SurfaceSamples& s) {
    return {&s.x, &s.y, &s.z, &s.nx, &s.ny, &s.nz, &s.lab_l, &s.lab_a, &s.lab_b};
}

SurfaceSamples samples_where(const SurfaceSamples& samples,
                             const std::function<bool(std::size_t)>& keep) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t n = 0; n < samples.size(); ++n)
        if (keep(n)) kept.push_back(n);
    return taken(samples, kept);
}

void sort_by_primitive(SurfaceSamples& samples) {
    std::vector<std::uint64_t> keys;
    for (const std::int32_t p : samples.primitive)
        keys.push_back(static_cast<std::uint64_t>(p + 1));
    samples = taken(samples, sorted_order(keys));
}

}  // namespace topple::geometry
