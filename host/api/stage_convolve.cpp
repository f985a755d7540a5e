// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <vector>

#include "api/arrays.h"
#include "disturbance.hpp"
#include "topple/kernels/queue.h"

namespace topple::stages {
namespace {

constexpr std::uint32_t block = 64;  // cells that the kernel works on together
constexpr const char* convolve_stage = "convolve";

// A footprint as the kernel wants it. Nothing stands in the way: one row of open cells for all.
struct Entries {
    std::vector<std::int32_t> delta;
    std::vector<std::uint32_t> row;
    std::vector<float> weight;
};

std::uint32_t reach_of(std::span<const FootprintEntry> footprint) {
    std::uint32_t reach = 0;
    for (const FootprintEntry& e : footprint) {
        for (const std::int64_t d : {std::int64_t{e.dx}, std::int64_t{e.dy}})
            reach = std::max(reach, static_cast<std::uint32_t>(std::abs(d)));
    }
    return reach;
}

void check(const MapShape& s, std::uint32_t reach, std::span<const FootprintEntry> footprint,
           std::span<const std::uint32_t> first) {
    require(s.width > 0 && s.height > 0 && s.directions > 0, convolve_stage, "the map is empty");
    require(first.size() == std::size_t{s.directions} + 1 && first.front() == 0 &&
                first.back() == footprint.size() && std::is_sorted(first.begin(), first.end()),
            convolve_stage,
            "first must rise from 0 to the " + std::to_string(footprint.size()) +
                " entries of the footprint in " + std::to_string(s.directions) + " steps");
    const std::uint64_t added = s.margin ? 0 : 2 * (std::uint64_t{reach} + 1);
    const std::uint64_t width = s.width + added + block, height = s.height + added;
    constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
    require(width < most && height < most && width * height <= most / s.directions, convolve_stage,
            "the map with its margin has more than 2^31 cells in all directions");
    if (s.margin == 0) return;
    require(reach < s.margin, convolve_stage,
            "a footprint that reaches " + std::to_string(reach) +
                " cells takes a wider margin than " + std::to_string(s.margin));
    const std::uint64_t margins = 2 * std::uint64_t{s.margin};
    require(s.width % block == 0 && s.height > margins && s.width > margins, convolve_stage,
            "with a margin, width must be a multiple of 64, and both sides larger than twice it");
}

// Planes with a margin of zeros around each.
std::vector<float> padded(std::span<const float> planes, const MapShape& from, const MapShape& to) {
    std::vector<float> out(std::size_t{to.width} * to.height * to.directions, 0.0f);
    for (std::uint32_t d = 0; d < from.directions; ++d) {
        for (std::uint32_t y = 0; y < from.height; ++y) {
            const std::size_t at = (std::size_t{d} * from.height + y) * from.width;
            std::copy_n(planes.begin() + static_cast<std::ptrdiff_t>(at), from.width,
                        out.begin() + static_cast<std::ptrdiff_t>(
                                          (std::size_t{d} * to.height + y + to.margin) * to.width +
                                          to.margin));
        }
    }
    return out;
}

// On planes that have their margin. density: directions x (height - 2 margin) rows.
void run(device::Device& device, const MapShape& s, const device::Slice<float>& primary,
         std::span<const FootprintEntry> footprint, std::span<const std::uint32_t> first,
         const device::Slice<float>& density) {
    Entries entries;
    for (const FootprintEntry& e : footprint) {
        entries.delta.push_back(e.dy * static_cast<std::int32_t>(s.width) + e.dx);
        entries.row.push_back(0);
        entries.weight.push_back(e.weight);
    }
    std::vector<std::uint32_t> starts;
    for (std::uint32_t y = s.margin; y < s.height - s.margin; ++y) {
        for (std::uint32_t x = 0; x < s.width; x += block) starts.push_back(y * s.width + x);
    }
    const auto cells = static_cast<std::uint32_t>(starts.size() * block);
    using Words = std::span<const std::uint32_t>;
    const device::Buffer<std::uint32_t> block_start(device, Words(starts), "block starts"),
        entry_first(device, first, "footprint first"),
        entry_row(device, Words(entries.row), "footprint rows");
    const device::Buffer<std::int32_t> entry_delta(
        device, std::span<const std::int32_t>(entries.delta), "footprint offsets");
    const device::Buffer<float> entry_weight(device, std::span<const float>(entries.weight),
                                             "footprint weights");
    device::Buffer<std::uint32_t> blocked(device, cells, "obstacles");
    blocked.fill(0);
    device::Queue queue(device);
    queue.add<kernels::Disturbance>(std::uint64_t{s.directions} * cells,
                                    {.block_start = block_start,
                                     .primary = primary,
                                     .blocked = blocked,
                                     .entry_first = entry_first,
                                     .entry_delta = entry_delta,
                                     .entry_row = entry_row,
                                     .entry_weight = entry_weight,
                                     .density = density},
                                    {.cell_count = cells,
                                     .row_count = 1,
                                     .plane_cells = s.width * s.height,
                                     .direction_count = s.directions,
                                     .footprint_first = 0,
                                     .band_first = 0,
                                     .band_count = 1,
                                     .output_first = 0});
    queue.run();
}

}  // namespace

void convolve(device::Device& device, const MapShape& shape, const Array<const float>& primary,
              std::span<const FootprintEntry> footprint, std::span<const std::uint32_t> first,
              const Array<float>& density) {
    const device::InUse in_use(device);
    const bool on_device = primary.on_device() || density.on_device();
    require(on_device == (shape.margin > 0), convolve_stage,
            on_device ? "arrays in a device's buffers take a margin"
                      : "arrays in host memory have no margin");
    const std::uint32_t reach = reach_of(footprint);
    check(shape, reach, footprint, first);
    MapShape inner = shape;
    if (!on_device) {
        inner.margin = reach + 1;
        inner.width = (shape.width + 2 * inner.margin + block - 1) / block * block;
        inner.height = shape.height + 2 * inner.margin;
    }
    const std::uint64_t plane = std::uint64_t{shape.width} * shape.height;
    const std::uint32_t rows = inner.height - 2 * inner.margin;
    const std::uint64_t written = std::uint64_t{inner.width} * rows * shape.directions;
    require(primary.count == plane * shape.directions, convolve_stage,
            "primary has " + std::to_string(primary.count) + " values, not " +
                std::to_string(plane * shape.directions));
    const std::uint64_t expected = on_device ? written : primary.count;
    require(density.count == expected, convolve_stage,
            "density has " + std::to_string(density.count) + " values, not " +
                std::to_string(expected));
    std::vector<float> with_margin;
    if (!on_device) with_margin = padded(primary.host, shape, inner);
    const Array<const float> from = on_device ? primary : Array<const float>(with_margin);
    const Bound<const float> in(device, from, from.count, "primary");
    const Bound<float> out(device, density, written, "density");
    run(device, inner, in.slice(), footprint, first, out.slice());
    if (density.on_device()) return;
    if (on_device) {
        out.own().download(density.host);
        return;
    }
    const std::vector<float> wide = out.own().download();
    for (std::size_t row = 0; row < std::size_t{rows} * shape.directions; ++row) {
        std::copy_n(wide.begin() + static_cast<std::ptrdiff_t>(row * inner.width + inner.margin),
                    shape.width,
                    density.host.begin() + static_cast<std::ptrdiff_t>(row * shape.width));
    }
}

}  // namespace topple::stages
