// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/short_number.h"
#include "physics/bodies.h"
#include "segmented_sum.hpp"
#include "solids/solid_places.h"
#include "topple/error.h"
#include "topple/kernels/queue.h"

namespace topple::physics {
namespace {

constexpr std::uint32_t segment_cells = 2048;             // with 21-bit indices a sum fits 32 bits
constexpr std::int64_t index_extent = 1 << 21;            // voxels across the scene
constexpr std::size_t slab_cells = std::size_t{1} << 23;  // 32 MiB per array, within any binding

struct Moments {
    std::uint64_t cells = 0, i = 0, j = 0, k = 0;
    // Of shares of voxels: 4096ths of voxels, and their moments about the scene's lowest corner in
    // those times quarters of an edge.
    std::uint64_t shares = 0, parts = 0;
    std::array<std::int64_t, 3> part_moment{};
};

// The cells that are not in the boundary, with their labels; the others have none.
SolidCells whole_cells(const SolidCells& cells, const BoundaryCells& boundary,
                       std::vector<Moments>& moments) {
    SolidCells out = cells;
    solids::each_bounded_cell(cells, boundary, [&](std::size_t b, std::size_t n) {
        if (cells.primitive[n] != boundary.primitive[b]) return;
        out.primitive[n] = -1;
        ++moments[cells.primitive[n]].parts;
    });
    return out;
}

void add_shares(const BoundaryCells& boundary, const std::array<std::int32_t, 3>& origin,
                std::vector<Moments>& moments) {
    constexpr std::int64_t steps = 4;  // of an edge
    const std::vector<std::int32_t>* axes[3] = {&boundary.i, &boundary.j, &boundary.k};
    for (std::size_t b = 0; b < boundary.size(); ++b) {
        Moments& m = moments[boundary.primitive[b]];
        m.shares += boundary.share[b];
        for (std::size_t a = 0; a < 3; ++a) {
            const std::int64_t middle =
                (std::int64_t{(*axes[a])[b]} - origin[a]) * steps + steps / 2;
            m.part_moment[a] += std::int64_t{boundary.share[b]} * middle + boundary.moment[a][b];
        }
    }
}

void check_cells(const SolidCells& cells, std::int32_t count) {
    const std::size_t n = cells.size();
    if (cells.j.size() != n || cells.k.size() != n || cells.primitive.size() != n) {
        throw Error(ErrorKind::input,
                    "solid cells: the arrays i, j, k and primitive differ in length");
    }
    if (!(cells.voxel_m > 0) || !std::isfinite(cells.voxel_m)) {
        throw Error(ErrorKind::input, "solid cells: voxel size " + short_number(cells.voxel_m) +
                                          " m is not a positive number");
    }
    for (const std::int32_t label : cells.primitive) {
        if (label < -1 || label >= count) {
            throw Error(ErrorKind::input, "solid cells: primitive " + std::to_string(label) +
                                              " is outside of -1 to " + std::to_string(count - 1));
        }
    }
}

std::array<std::int32_t, 3> origin_of(const SolidCells& cells) {
    std::array<std::int32_t, 3> origin{};
    const std::vector<std::int32_t>* axes[3] = {&cells.i, &cells.j, &cells.k};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax_element(axes[axis]->begin(), axes[axis]->end());
        origin[axis] = *low;
        if (std::int64_t{*high} - *low >= index_extent) {
            throw Error(ErrorKind::input, "solid cells: the scene spans " +
                                              std::to_string(std::int64_t{*high} - *low + 1) +
                                              " voxels along axis " + std::to_string(axis) +
                                              ", more than " + std::to_string(index_extent) +
                                              "; use a larger voxel_m (--voxel)");
        }
    }
    return origin;
}

// Adds the moments of the cells [begin, end) to their labels'.
void add_slab(device::Device& device, const SolidCells& cells, std::size_t begin, std::size_t end,
              const std::array<std::int32_t, 3>& origin, std::vector<Moments>& moments) {
    // Counting sort by label; what belongs to none comes first and is left out.
    std::vector<std::uint32_t> at(moments.size() + 2, 0);
    for (std::size_t n = begin; n < end; ++n) ++at[cells.primitive[n] + 2];
    for (std::size_t l = 1; l < at.size(); ++l) at[l] += at[l - 1];
    std::vector<std::uint32_t> first, segment_label, starts(at.begin(), at.end() - 1);
    for (std::size_t label = 0; label < moments.size(); ++label) {
        for (std::uint32_t s = at[label + 1]; s < at[label + 2]; s += segment_cells) {
            first.push_back(s);
            segment_label.push_back(static_cast<std::uint32_t>(label));
        }
        moments[label].cells += at[label + 2] - at[label + 1];
    }
    first.push_back(static_cast<std::uint32_t>(end - begin));
    std::vector<std::uint32_t> order(end - begin);
    for (std::size_t n = begin; n < end; ++n) {
        order[starts[cells.primitive[n] + 1]++] = static_cast<std::uint32_t>(n - begin);
    }
    const auto part = [&](const std::vector<std::int32_t>& axis) {
        return std::span<const std::int32_t>(axis).subspan(begin, end - begin);
    };
    device::Buffer<std::int32_t> ci(device, part(cells.i), "cell i"),
        cj(device, part(cells.j), "cell j"), ck(device, part(cells.k), "cell k");
    device::Buffer<std::uint32_t> order_buffer(device, std::span<const std::uint32_t>(order),
                                               "cell order"),
        first_buffer(device, std::span<const std::uint32_t>(first), "segments"),
        sum(device, segment_label.size() * 3, "segment sums");
    device::Queue queue(device);
    queue.add<kernels::SegmentedSum>(
        segment_label.size(),
        {.ci = ci, .cj = cj, .ck = ck, .order = order_buffer, .first = first_buffer, .sum = sum},
        {.origin_i = origin[0], .origin_j = origin[1], .origin_k = origin[2]});
    queue.run();
    const std::vector<std::uint32_t> sums = sum.download();
    for (std::size_t s = 0; s < segment_label.size(); ++s) {
        Moments& m = moments[segment_label[s]];
        m.i += sums[3 * s];
        m.j += sums[3 * s + 1];
        m.k += sums[3 * s + 2];
    }
}

}  // namespace

std::vector<MassProperties> mass_properties(device::Device& device, const SolidCells& cells,
                                            std::int32_t count,
                                            std::span<const double> density_kg_m3,
                                            const BoundaryCells& boundary) {
    if (count < 0 || density_kg_m3.size() != static_cast<std::size_t>(count)) {
        throw Error(ErrorKind::usage, "mass_properties: " + std::to_string(density_kg_m3.size()) +
                                          " densities for " + std::to_string(count) + " labels");
    }
    std::vector<MassProperties> bodies(static_cast<std::size_t>(count));
    if (count == 0 || cells.size() == 0) return bodies;
    check_cells(cells, count);
    const std::array<std::int32_t, 3> origin = origin_of(cells);
    std::vector<Moments> moments(bodies.size());
    const bool parted = boundary.size() > 0;
    const SolidCells whole = parted ? whole_cells(cells, boundary, moments) : SolidCells{};
    for (std::size_t begin = 0; begin < cells.size(); begin += slab_cells) {
        add_slab(device, parted ? whole : cells, begin, std::min(begin + slab_cells, cells.size()),
                 origin, moments);
    }
    add_shares(boundary, origin, moments);
    const double voxel = cells.voxel_m;
    for (std::size_t l = 0; l < bodies.size(); ++l) {
        const Moments& m = moments[l];
        if (m.cells == 0 && m.shares == 0) continue;
        MassProperties& body = bodies[l];
        body.voxels = m.cells + m.parts;
        const double parts = static_cast<double>(m.shares) / BoundaryCells::whole;
        const double volume = static_cast<double>(m.cells) + parts;
        body.volume_m3 = volume * voxel * voxel * voxel;
        body.mass_kg = body.volume_m3 * density_kg_m3[l];
        const std::uint64_t sums[3] = {m.i, m.j, m.k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double whole_moment =
                static_cast<double>(sums[axis]) + 0.5 * static_cast<double>(m.cells);
            const double moment =
                static_cast<double>(m.part_moment[axis]) / (4.0 * BoundaryCells::whole);
            body.center[axis] = ((whole_moment + moment) / volume + origin[axis]) * voxel;
        }
    }
    return bodies;
}

MassProperties combine(std::span<const MassProperties> bodies) {
    MassProperties all;
    Vec3 moment{}, first_moment{};
    for (const MassProperties& body : bodies) {
        all.voxels += body.voxels;
        all.volume_m3 += body.volume_m3;
        all.mass_kg += body.mass_kg;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            moment[axis] += body.mass_kg * body.center[axis];
            first_moment[axis] += body.volume_m3 * body.center[axis];
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Massless bodies still have a centre: that of their volume.
        if (all.mass_kg > 0) {
            all.center[axis] = moment[axis] / all.mass_kg;
        } else if (all.volume_m3 > 0) {
            all.center[axis] = first_moment[axis] / all.volume_m3;
        }
    }
    return all;
}

}  // namespace topple::physics
