// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cell_share.hpp"
#include "solids/boundary.h"
#include "topple/kernels/queue.h"

namespace topple::solids {

void measure_shares(device::Device& device, double voxel_m, BoundaryCells& b) {
    constexpr std::size_t batch = std::size_t{1} << 21;  // planes of 8 MiB, within any binding
    constexpr std::size_t numbers = 13;                  // of a patch
    std::vector<float> patch;
    for (const SurfacePatch& p : b.patches) {
        for (const double v : p.origin) patch.push_back(static_cast<float>(v));
        for (const double v : p.c) patch.push_back(static_cast<float>(v));
    }
    if (patch.empty()) patch.resize(numbers, 0.0F);
    b.share.assign(b.size(), 0);
    for (auto& m : b.moment) m.assign(b.size(), 0);
    const device::Buffer<float> patches(device, std::span<const float>(patch), "patches");
    for (std::size_t from = 0; from < b.size(); from += batch) {
        const std::size_t count = std::min(batch, b.size() - from);
        const auto part = [&](const auto& values) {
            return std::span(values).subspan(from, count);
        };
        std::vector<std::uint32_t> slots;
        for (const auto& s : b.slot) {
            const auto one = part(s);
            slots.insert(slots.end(), one.begin(), one.end());
        }
        const device::Buffer<std::int32_t> i(device, part(b.i), "boundary i"),
            j(device, part(b.j), "boundary j"), k(device, part(b.k), "boundary k");
        const device::Buffer<std::uint32_t> slot(device, std::span<const std::uint32_t>(slots),
                                                 "boundary slots"),
            form(device, part(b.form), "boundary forms");
        const device::Buffer<std::uint32_t> share(device, count, "shares");
        const device::Buffer<std::int32_t> moment(device, 3 * count, "moments");
        device::Queue queue(device);
        queue.add<kernels::CellShare>(count,
                                      {.ci = i,
                                       .cj = j,
                                       .ck = k,
                                       .slot = slot,
                                       .form = form,
                                       .surface = patches,
                                       .share = share,
                                       .moment = moment},
                                      {.cell_count = static_cast<std::uint32_t>(count),
                                       .voxel_m = static_cast<float>(voxel_m)});
        queue.run();
        const std::vector<std::uint32_t> shares = share.download();
        const std::vector<std::int32_t> moments = moment.download();
        std::ranges::copy(shares, b.share.begin() + static_cast<std::ptrdiff_t>(from));
        for (std::size_t a = 0; a < 3; ++a) {
            const auto first = moments.begin() + static_cast<std::ptrdiff_t>(a * count);
            std::copy(first, first + static_cast<std::ptrdiff_t>(count),
                      b.moment[a].begin() + static_cast<std::ptrdiff_t>(from));
        }
    }
}

}  // namespace topple::solids
