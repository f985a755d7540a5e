// SPDX-License-Identifier: MIT
#include "safety/wind/wind_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/thread_pool.h"
#include "physics/directions.h"
#include "physics/landscape.h"
#include "safety/columns.h"
#include "safety/fields.h"
#include "safety/objects.h"
#include "safety/wind/wind_space.h"

namespace topple::safety {
namespace {

constexpr double bins_per_voxel = 2;  // lines of wind across a voxel's width

// Lines of wind across one object: for each layer and line, the cell that the wind meets first.
struct FirstHits {
    std::int64_t bins = 0, layers = 0;
    double low = 0;                  // where the first line's bin begins, voxels across the wind
    std::vector<std::int64_t> cell;  // layers x bins; -1: none
};

FirstHits first_hits(const SolidCells& solid, std::span<const std::uint32_t> cells, double dx,
                     double dy) {
    const auto across = [&](std::uint32_t c) {
        return (solid.i[c] + 0.5) * -dy + (solid.j[c] + 0.5) * dx;
    };
    const auto along = [&](std::uint32_t c) {
        return (solid.i[c] + 0.5) * dx + (solid.j[c] + 0.5) * dy;
    };
    const double half_width =
        (std::fabs(dx) + std::fabs(dy)) / 2;  // of a voxel, seen along the wind
    double low = INFINITY, high = -INFINITY;
    std::int32_t bottom = std::numeric_limits<std::int32_t>::max(),
                 top = std::numeric_limits<std::int32_t>::min();
    for (const std::uint32_t c : cells) {
        low = std::min(low, across(c));
        high = std::max(high, across(c));
        bottom = std::min(bottom, solid.k[c]);
        top = std::max(top, solid.k[c]);
    }
    FirstHits hits;
    hits.low = low - half_width;
    hits.bins =
        static_cast<std::int64_t>(std::ceil((high - low + 2 * half_width) * bins_per_voxel)) + 1;
    hits.layers = std::int64_t{top} - bottom + 1;
    hits.cell.assign(static_cast<std::size_t>(hits.bins * hits.layers), -1);
    std::vector<double> depth(hits.cell.size(), INFINITY);
    for (const std::uint32_t c : cells) {
        // The lines whose middles cross the voxel; the slack makes a voxel's edges hit the same
        // lines on either side of it.
        const double from = (across(c) - half_width - hits.low) * bins_per_voxel - 0.5 - 1e-9;
        const double to = (across(c) + half_width - hits.low) * bins_per_voxel - 0.5 - 1e-9;
        for (auto bin = static_cast<std::int64_t>(std::ceil(from)); static_cast<double>(bin) < to;
             ++bin) {
            if (bin < 0 || bin >= hits.bins) continue;
            const auto at = static_cast<std::size_t>((solid.k[c] - bottom) * hits.bins + bin);
            if (along(c) < depth[at]) {  // cells ascend: the lowest of equals stays
                depth[at] = along(c);
                hits.cell[at] = c;
            }
        }
    }
    return hits;
}

// Which of the first hits the wind reaches. Layers whose first voxels stand in one column share the
// line there: up to 64 of them are looked at together.
std::vector<bool> open_hits(const SolidCells& solid, const Columns& columns, const FirstHits& hits,
                            double dx, double dy, double shelter) {
    std::vector<bool> open(hits.cell.size());
    for (std::int64_t bin = 0; bin < hits.bins; ++bin) {
        // The line's middle, at the depth of the voxels' centres; layers whose first voxels stand
        // in one column share it, up to 64.
        const double across = hits.low + (static_cast<double>(bin) + 0.5) / bins_per_voxel;
        for (std::int64_t layer = 0; layer < hits.layers;) {
            const std::int64_t c = hits.cell[layer * hits.bins + bin];
            if (c < 0) {
                ++layer;
                continue;
            }
            const auto first = static_cast<std::size_t>(c);
            std::uint64_t asked = 0;
            std::int64_t run = 0;
            for (; run < 64 && layer + run < hits.layers; ++run) {
                const auto n = hits.cell[(layer + run) * hits.bins + bin];
                if (n < 0) continue;
                const auto cell = static_cast<std::size_t>(n);
                if (solid.i[cell] != solid.i[first] || solid.j[cell] != solid.j[first]) break;
                asked |= std::uint64_t{1} << run;
            }
            const double along = (solid.i[first] + 0.5) * dx + (solid.j[first] + 0.5) * dy;
            const std::uint64_t reached = open_to_wind(
                columns, along * dx - across * dy, along * dy + across * dx, solid.k[first], asked,
                solid.i[first], solid.j[first], dx, dy, shelter);
            for (std::int64_t r = 0; r < run; ++r) {
                if (reached >> r & 1) open[(layer + r) * hits.bins + bin] = true;
            }
            layer += run;
        }
    }
    return open;
}

void offer_arrows(ArrowSample& arrows, const SolidCells& solid,
                  std::span<const std::uint32_t> cells,
                  const std::vector<std::array<float, 3>>& wind, double speed, float directions) {
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::uint32_t c = cells[n];
        if (wind[n][2] == 0) continue;
        arrows.offer({(solid.i[c] + 0.5) * solid.voxel_m, (solid.j[c] + 0.5) * solid.voxel_m,
                      (solid.k[c] + 0.5) * solid.voxel_m},
                     {wind[n][0] / wind[n][2] * speed, wind[n][1] / wind[n][2] * speed, 0},
                     wind[n][2] / directions);
    }
}

// The ways that the wind blows, unit.
std::vector<std::array<double, 2>> ways(const WindOptions& options) {
    if (options.from_deg) {
        // From the east it blows exactly along -x, as from the 16.
        const auto exact = [](double v) { return std::fabs(v) < 1e-12 ? 0.0 : v; };
        const double angle = *options.from_deg * std::numbers::pi / 180;
        return {{exact(-std::sin(angle)), exact(-std::cos(angle))}};
    }
    return {directions().begin(), directions().end()};
}

// Of wind that blows along `way`, onto an object's front.
WindLoad load_on(const RiskObject& object, const MassSpread& stands, const Frontage& front,
                 const std::array<double, 2>& way) {
    return {front.area_m2,
            front.center_m - stands.bottom_m,
            half_base(object, stands, way[0], way[1]),
            stands.height(),
            {way[0], way[1], 0}};
}

// The force from which wind tips a body, over its weight; infinite where it slides away instead.
double tipping_force(const WindLoad& load, double friction) {
    const double b = load.half_base_m, h = load.height_m, p = load.pressure_height_m;
    if (p > 0 && b <= friction * p) return b / p;
    if (b <= friction * h) return friction;
    if (p > h) return std::max(friction, (b - friction * h) / (p - h));
    return std::numeric_limits<double>::infinity();
}

// The speed from which a gust tips it over the edge ahead; infinite where none does.
double tipping_gust_m_s(const RiskObject& object, const WindLoad& load,
                        const WindOptions& options) {
    if (!(load.area_m2 > 0) || !(load.pressure_height_m > 0))
        return std::numeric_limits<double>::infinity();
    const double force =
        object.mass_kg * physics::gravity * load.half_base_m / load.pressure_height_m;
    return std::sqrt(2 * force /
                     (options.air_density_kg_m3 * options.drag_coefficient * load.area_m2));
}

double least_gust_m_s(const RiskObject& object, std::span<const WindLoad> loads,
                      const WindOptions& options) {
    double least = std::numeric_limits<double>::infinity();
    for (const WindLoad& load : loads)
        least = std::min(least, tipping_gust_m_s(object, load, options));
    return std::isfinite(least) ? least : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Frontage wind_frontage(const SolidCells& solid, const Columns& columns,
                       std::span<const std::uint32_t> cells, const std::array<double, 2>& way,
                       double shelter_m) {
    Frontage out;
    if (cells.empty()) return out;
    const auto [dx, dy] = way;
    const FirstHits hits = first_hits(solid, cells, dx, dy);
    const double line_area = solid.voxel_m * solid.voxel_m / bins_per_voxel;
    double moment = 0;
    const std::vector<bool> open =
        open_hits(solid, columns, hits, dx, dy, shelter_m / solid.voxel_m);
    for (std::size_t at = 0; at < hits.cell.size(); ++at) {
        if (!open[at]) continue;
        const auto c = static_cast<std::uint32_t>(hits.cell[at]);
        out.area_m2 += line_area;
        moment += line_area * (solid.k[c] + 0.5) * solid.voxel_m;
        out.cells.push_back(c);
    }
    if (out.area_m2 > 0) out.center_m = moment / out.area_m2;
    std::sort(out.cells.begin(), out.cells.end());
    out.cells.erase(std::unique(out.cells.begin(), out.cells.end()), out.cells.end());
    return out;
}

double wind_force(const WindLoad& load, const WindOptions& options) {
    return 0.5 * options.air_density_kg_m3 * options.drag_coefficient * load.area_m2 *
           options.speed_m_s * options.speed_m_s;
}

double wind_work(const RiskObject& object, const WindLoad& load, const WindOptions& options) {
    const double force = wind_force(load, options), weight = object.mass_kg * physics::gravity;
    if (!(force > 0) || !(weight > 0)) return 0;
    // That way it can't fall: its energy alone counts, and brings nothing.
    const double towards = push_barrier_J(object, load.way);
    const auto work = [&](double threshold, double barrier, double own_energy) {
        if (!std::isfinite(towards)) barrier = 0;
        if (threshold <= 0) return std::max(barrier, own_energy);
        const double ratio = force / threshold;
        return ratio * (ratio < 1 ? barrier : std::max(barrier, own_energy));
    };
    const double rubs = object.friction * weight;
    double most = 0;
    const double tips = tipping_force(load, object.friction) * weight;
    if (std::isfinite(tips))
        most = work(tips, over_edge_J(object, load.way),
                    tipping_energy(object.mass_kg, load.height_m, load.half_base_m));
    // Sliding matters where there is an edge to slide off.
    const double distance = slide_towards_m(object, load.way, 0);
    if (std::isfinite(distance)) most = std::max(most, work(rubs, towards, rubs * distance));
    return most;
}

std::vector<double> tipping_gusts(device::Device& device, const Surroundings& surroundings,
                                  std::span<const RiskObject> objects, const WindOptions& options) {
    const auto cells =
        cells_of_objects(movable_object_of_cells(surroundings, objects), objects.size());
    const Columns columns(*surroundings.cells);
    std::vector<double> out(objects.size(), std::numeric_limits<double>::quiet_NaN());
    device.threads().each(objects.size(), 1, [&](std::size_t o) {
        if (cells[o].empty() || objects[o].grounded) return;
        const MassSpread stands = stance(surroundings, cells[o], objects[o]);
        std::vector<WindLoad> loads;
        for (const auto& way : directions()) {
            const Frontage front =
                wind_frontage(*surroundings.cells, columns, cells[o], way, options.shelter_m);
            loads.push_back(load_on(objects[o], stands, front, way));
        }
        out[o] = least_gust_m_s(objects[o], loads, options);
    });
    return out;
}

Disturbance wind_field(device::Device& device, const Surroundings& surroundings,
                       std::span<const RiskObject> objects, const WindOptions& options) {
    Disturbance out;
    out.name = wind_kind().name;
    const std::vector<std::array<double, 2>> blown = ways(options);
    const auto directions = static_cast<float>(blown.size());
    out.draws = blown.size();
    out.work.resize(objects.size());
    out.response.resize(objects.size());
    out.strongest.resize(objects.size());
    const auto object_of_cell = movable_object_of_cells(surroundings, objects);
    const auto cells = cells_of_objects(object_of_cell, objects.size());
    out.exposure.assign(object_of_cell.size(), 0.0f);
    const SolidCells& solid = *surroundings.cells;
    const Columns columns(solid);

    std::vector<Frontage> fronts(objects.size() * blown.size());  // by object, then by way
    device.threads().each(fronts.size(), 1, [&](std::size_t n) {
        const std::size_t o = n / blown.size();
        if (!cells[o].empty() && !objects[o].grounded)
            fronts[n] =
                wind_frontage(solid, columns, cells[o], blown[n % blown.size()], options.shelter_m);
    });
    if (!options.from_deg)
        out.gust_m_s.assign(objects.size(), std::numeric_limits<double>::quiet_NaN());
    ArrowSample arrows;
    for (std::size_t o = 0; o < objects.size(); ++o) {
        if (cells[o].empty() || objects[o].grounded) continue;
        const MassSpread stands = stance(surroundings, cells[o], objects[o]);
        std::vector<std::array<float, 3>> wind(cells[o].size(),
                                               {0, 0, 0});  // sum of directions, count
        std::vector<WindLoad> gales;
        for (std::size_t w = 0; w < blown.size(); ++w) {
            const Frontage& front = fronts[o * blown.size() + w];
            if (front.area_m2 <= 0) continue;
            const auto [dx, dy] = blown[w];
            for (const std::uint32_t c : front.cells) {
                const auto n =
                    std::lower_bound(cells[o].begin(), cells[o].end(), c) - cells[o].begin();
                auto& sum = wind[n];
                sum = {sum[0] + static_cast<float>(dx), sum[1] + static_cast<float>(dy),
                       sum[2] + 1};
                out.exposure[c] += 1.0f / directions;
            }
            const WindLoad load = load_on(objects[o], stands, front, blown[w]);
            gales.push_back(load);
            const double force = wind_force(load, options);
            if (force > out.strongest[o].force_N)
                out.strongest[o] = {force, load.pressure_height_m};
        }
        if (!options.from_deg) out.gust_m_s[o] = least_gust_m_s(objects[o], gales, options);
        out.response[o] = [gales = std::move(gales), options,
                           probability = 1.0 / double{directions}](const RiskObject& object) {
            std::vector<WorkSample> work;
            for (WindLoad load : gales) {
                load.half_base_m = std::max(0.0, load.half_base_m + object.border_shift_m);
                work.push_back({wind_work(object, load, options), probability, load.way});
            }
            return work;
        };
        out.work[o] = out.response[o](objects[o]);
        offer_arrows(arrows, solid, cells[o], wind, options.speed_m_s, directions);
    }
    out.samples = arrows.take();
    if (options.over_space)
        out.space = wind_over_space(device.threads(), solid, columns, blown, options);
    // That nothing was judged is said once for all.
    if (out.samples.x.empty() && !std::ranges::all_of(objects, &RiskObject::grounded))
        out.notes.push_back("No object of the scene stands in the wind.");
    return out;
}

}  // namespace topple::safety
