// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/reduce.h"

#include <algorithm>

#include "reduce_float.hpp"
#include "reduce_uint.hpp"

namespace topple::primitives {
namespace {

constexpr std::uint64_t at_once = 1024;  // REDUCE_WORDS

template <class Kernel, class T>
void reduce_levels(device::Queue& queue, Scratch& scratch, std::uint32_t mode, Words from,
                   const Words& to) {
    check_size(to, 1, "the output of a reduction");
    const std::uint64_t items = queue.device().items_per_lane(Kernel::source());
    const auto level = [&](const Words& in, const Words& out) {
        // Tiles are of whole work-items' elements, and their results start at slices.
        const std::uint64_t whole = at_once * slice_words;
        const auto parts = tiles(queue.device(), std::max<std::uint64_t>(1, size(in)), whole);
        for (const Tile& tile : parts) {
            const auto count = static_cast<std::uint32_t>(
                std::min<std::uint64_t>(tile.count, size(in) - tile.first));
            const std::uint64_t results = (tile.count + at_once - 1) / at_once;
            queue.add<Kernel>(
                results * items,
                {.src = device::Slice<T>{part(in, tile.first, count).range},
                 .dst = device::Slice<T>{part(out, tile.first / at_once, results).range}},
                {.count = count, .mode = mode});
        }
    };
    std::vector<Scratch::Lease> held;
    while (size(from) > at_once) {
        held.push_back(scratch.take((size(from) + at_once - 1) / at_once));
        level(from, held.back());
        from = held.back();
    }
    level(from, part(to, 0, 1));
}

}  // namespace

void reduce(device::Queue& queue, Scratch& scratch, Reduction reduction, const Words& from,
            const Words& to) {
    reduce_levels<kernels::ReduceUint, std::uint32_t>(
        queue, scratch, static_cast<std::uint32_t>(reduction), from, to);
}

void reduce(device::Queue& queue, Scratch& scratch, Reduction reduction,
            const device::Slice<float>& from, const device::Slice<float>& to) {
    reduce_levels<kernels::ReduceFloat, float>(
        queue, scratch, static_cast<std::uint32_t>(reduction), {from.range}, {to.range});
}

}  // namespace topple::primitives
