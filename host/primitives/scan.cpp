// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/scan.h"

#include "chunk_compact.hpp"
#include "chunk_scan.hpp"
#include "chunk_sums.hpp"
#include "primitives/chunks.h"
#include "scan_base.hpp"

namespace topple::primitives {

void scan_chunks(device::Queue& queue, Scratch& scratch, const Words& sums, const Words& offsets,
                 const Words& carry, bool first_tile) {
    const auto count = static_cast<std::uint32_t>(size(sums));
    const std::uint64_t chunks = chunks_of<kernels::ChunkSums>(queue.device(), count);
    // What one work-item runs through while others would be started.
    if (chunks <= 4) {
        queue.add<kernels::ScanBase>(1, {.src = sums, .dst = offsets, .carry = carry},
                                     {.count = count, .mode = first_tile});
        return;
    }
    const auto above = scratch.take(chunks), above_offsets = scratch.take(chunks);
    queue.add<kernels::ChunkSums>(count, {.src = sums, .sum = above},
                                  {.count = count, .mode = ~0u});
    scan_chunks(queue, scratch, above, above_offsets, carry, first_tile);
    queue.add<kernels::ChunkScan>(count, {.src = sums, .first = above_offsets, .dst = offsets},
                                  {.count = count, .mode = 0});
}

void scan(device::Queue& queue, Scratch& scratch, const Words& from, const Words& to,
          bool inclusive) {
    check_size(to, size(from), "the output of a scan");
    const auto carry = scratch.take(1);
    for (const Tile& tile : cached_tiles(queue.device(), size(from))) {
        const std::uint64_t chunks = chunks_of<kernels::ChunkSums>(queue.device(), tile.count);
        const auto sums = scratch.take(chunks), offsets = scratch.take(chunks);
        const Words src = part(from, tile.first, tile.count);
        queue.add<kernels::ChunkSums>(tile.count, {.src = src, .sum = sums},
                                      {.count = tile.count, .mode = ~0u});
        scan_chunks(queue, scratch, sums, offsets, carry, tile.first == 0);
        queue.add<kernels::ChunkScan>(
            tile.count, {.src = src, .first = offsets, .dst = part(to, tile.first, tile.count)},
            {.count = tile.count, .mode = inclusive});
    }
}

void compact(device::Queue& queue, Scratch& scratch, const Words& flags, const Words& from,
             const Words& to, const Words& count) {
    check_size(from, size(flags), "what is compacted");
    check_size(count, 1, "the count of a compaction");
    const auto places = windows(queue.device(), to);
    if (size(flags) == 0) clear(queue, scratch, count);
    for (const Tile& tile : cached_tiles(queue.device(), size(flags))) {
        const std::uint64_t chunks = chunks_of<kernels::ChunkSums>(queue.device(), tile.count);
        const auto kept = scratch.take(chunks), offsets = scratch.take(chunks);
        const Words flag = part(flags, tile.first, tile.count);
        queue.add<kernels::ChunkSums>(tile.count, {.src = flag, .sum = kept},
                                      {.count = tile.count, .mode = 1});
        scan_chunks(queue, scratch, kept, offsets, count, tile.first == 0);
        for (const Tile& window : places) {
            // No more than tile.first + tile.count are kept up to here.
            if (window.first >= tile.first + std::uint64_t{tile.count}) break;
            queue.add<kernels::ChunkCompact>(
                tile.count,
                {.flag = flag,
                 .src = part(from, tile.first, tile.count),
                 .first = offsets,
                 .kept = kept,
                 .dst = part(to, window.first, window.count)},
                {.count = tile.count, .window_first = window.first, .window_count = window.count});
        }
    }
}

}  // namespace topple::primitives
