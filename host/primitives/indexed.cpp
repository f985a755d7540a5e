// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/indexed.h"

#include "add_by_key.hpp"
#include "gather_words.hpp"
#include "scatter_words.hpp"

namespace topple::primitives {
namespace {

// Calls body(tile, window, params) for each tile of the indices and each window of what they index.
template <class Body>
void each_pair(device::Queue& queue, const Words& index, const Words& indexed, std::uint32_t mode,
               const Body& body) {
    for (const Tile& tile : tiles(queue.device(), size(index)))
        for (const Tile& window : tiles(queue.device(), size(indexed)))
            body(tile, part(indexed, window.first, window.count),
                 kernels::IndexedParams{tile.count, window.first, window.count, mode});
}

void add(device::Queue& queue, const Words& keys, const Words& values, const Words& sums,
         std::uint32_t mode) {
    each_pair(queue, keys, sums, mode,
              [&](const Tile& tile, const Words& sum, const kernels::IndexedParams& params) {
                  queue.add<kernels::AddByKey>(tile.count,
                                               {.key = part(keys, tile.first, tile.count),
                                                .value = part(values, tile.first, tile.count),
                                                .sum = sum},
                                               params);
              });
}

}  // namespace

void gather(device::Queue& queue, const Words& index, const Words& from, const Words& to) {
    check_size(to, size(index), "the output of a gather");
    each_pair(queue, index, from, 0,
              [&](const Tile& tile, const Words& src, const kernels::IndexedParams& params) {
                  queue.add<kernels::GatherWords>(tile.count,
                                                  {.index = part(index, tile.first, tile.count),
                                                   .src = src,
                                                   .dst = part(to, tile.first, tile.count)},
                                                  params);
              });
}

void scatter(device::Queue& queue, const Words& index, const Words& from, const Words& to) {
    check_size(from, size(index), "what is scattered");
    each_pair(queue, index, to, 0,
              [&](const Tile& tile, const Words& dst, const kernels::IndexedParams& params) {
                  queue.add<kernels::ScatterWords>(tile.count,
                                                   {.index = part(index, tile.first, tile.count),
                                                    .src = part(from, tile.first, tile.count),
                                                    .dst = dst},
                                                   params);
              });
}

void add_by_key(device::Queue& queue, const Words& keys, const Words& values, const Words& sums) {
    check_size(values, size(keys), "the values of keys");
    add(queue, keys, values, sums, 0);
}

void histogram(device::Queue& queue, const Words& keys, const Words& counts) {
    add(queue, keys, keys, counts, 1);
}

}  // namespace topple::primitives
