// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/runs.h"

#include <algorithm>
#include <optional>

#include "primitives/chunks.h"
#include "run_counts.hpp"
#include "run_lengths.hpp"
#include "run_open.hpp"
#include "run_scan.hpp"
#include "run_starts.hpp"
#include "run_sums.hpp"
#include "run_tails.hpp"
#include "topple/kernels/primitives/scan.h"

namespace topple::primitives {
namespace {

// A tile of runs, with the words before it that tell whether its first element begins one.
struct RunTile {
    RunTile(const Segments& runs, const Tile& tile)
        : first(tile.first),
          skip(tile.first ? static_cast<std::uint32_t>(slice_words) : 0),
          count(tile.count),
          low(of(runs.low)),
          high(of(runs.high)) {}
    Words of(const Words& words) const { return part(words, first - skip, skip + count); }
    kernels::RunParams params(std::uint32_t kind, const Tile& window, std::uint32_t mode) const {
        return {.count = count,
                .skip = skip,
                .tile_first = first,
                .kind = kind,
                .window_first = window.first,
                .window_count = window.count,
                .mode = mode};
    }
    std::uint32_t first, skip, count;
    Words low, high;
};

// Calls body(tile, first, kept) for each tile, after the dispatches that count its runs by
// chunks: how many begin before a chunk, and in it. count[0] becomes the number of all.
template <class Body>
void each_counted_tile(device::Queue& queue, Scratch& scratch, const Segments& runs,
                       const Words& count, const Body& body) {
    check_size(count, 1, "the count of runs");
    check_size(runs.high, size(runs.low), "the high words of keys");
    if (size(runs.low) == 0) clear(queue, scratch, count);
    for (const Tile& at : cached_tiles(queue.device(), size(runs.low))) {
        const RunTile tile(runs, at);
        const std::uint64_t chunks = chunks_of<kernels::RunCounts>(queue.device(), tile.count);
        const auto kept = scratch.take(chunks), first = scratch.take(chunks);
        queue.add<kernels::RunCounts>(tile.count, {.low = tile.low, .high = tile.high, .sum = kept},
                                      tile.params(runs.kind, {}, 0));
        scan_chunks(queue, scratch, kept, first, count, tile.first == 0);
        body(tile, first.words(), kept.words());
    }
}

// Windows of an output that runs up to the end of a tile may reach.
std::vector<Tile> reached(const device::Device& device, const Words& output, const RunTile& tile) {
    auto out = windows(device, output);
    std::erase_if(out, [&](const Tile& window) {
        return window.first > tile.first + std::uint64_t{tile.count};
    });
    return out;
}

}  // namespace

void unique(device::Queue& queue, Scratch& scratch, const Segments& runs, const Words& low_to,
            const Words& high_to, const Words& starts, const Words& count) {
    const std::uint64_t all = size(runs.low), most = size(low_to);
    const bool wide = runs.kind == 3;
    if (wide) check_size(high_to, most, "the high words of unique keys");
    check_size(starts, most + 1, "the starts of runs");
    if (all == 0) clear(queue, scratch, starts);
    const auto unused = scratch.take(1);
    each_counted_tile(
        queue, scratch, runs, count, [&](const RunTile& tile, const Words& first, const Words&) {
            for (const Tile& window : reached(queue.device(), low_to, tile)) {
                // The start behind the last may be the next window's first.
                const std::uint64_t room = std::min<std::uint64_t>(window.count + std::uint64_t{1},
                                                                   size(starts) - window.first);
                queue.add<kernels::RunStarts>(
                    tile.count,
                    {.low = tile.low,
                     .high = tile.high,
                     .first = first,
                     .low_to = part(low_to, window.first, window.count),
                     .high_to = wide ? part(high_to, window.first, window.count) : unused.words(),
                     .start = part(starts, window.first, room)},
                    tile.params(runs.kind, window, tile.first + std::uint64_t{tile.count} == all));
            }
        });
}

void run_lengths(device::Queue& queue, const Words& starts, const Words& count,
                 const Words& lengths) {
    check_size(starts, size(lengths) + 1, "the starts of runs");
    for (const Tile& tile : tiles(queue.device(), size(lengths)))
        queue.add<kernels::RunLengths>(
            tile.count,
            {.start = part(starts, tile.first, tile.count + std::uint64_t{1}),
             .runs = part(count, 0, 1),
             .length = part(lengths, tile.first, tile.count)},
            {.first = tile.first, .most = tile.count});
}

void segmented_sum(device::Queue& queue, Scratch& scratch, const Segments& runs,
                   const Words& values, const Words& sums, const Words& count) {
    check_size(values, size(runs.low), "the values of segments");
    each_counted_tile(queue, scratch, runs, count,
                      [&](const RunTile& tile, const Words& first, const Words& kept) {
                          for (const Tile& window : reached(queue.device(), sums, tile)) {
                              const Words sum = part(sums, window.first, window.count);
                              auto chunks = tile.params(runs.kind, window, 0);
                              chunks.count = static_cast<std::uint32_t>(size(first));
                              queue.add<kernels::RunOpen>(
                                  chunks.count, {.first = first, .kept = kept, .sum = sum}, chunks);
                              queue.add<kernels::RunSums>(tile.count,
                                                          {.low = tile.low,
                                                           .high = tile.high,
                                                           .value = tile.of(values),
                                                           .first = first,
                                                           .kept = kept,
                                                           .sum = sum},
                                                          tile.params(runs.kind, window, 0));
                          }
                      });
}

namespace {

constexpr std::uint32_t inclusive_mode = 1, carried_mode = 2, second_mode = 4, hand_on_mode = 8;

// One level of chunks: `mode` is run_scan's.
void scan_level(device::Queue& queue, Scratch& scratch, const RunTile& tile, std::uint32_t kind,
                const Words& value, const Words& carry, const Words& to, std::uint32_t mode) {
    const std::uint64_t chunks = chunks_of<kernels::RunTails>(queue.device(), tile.count);
    const auto before = scratch.take(chunks);
    if (chunks > 1) {
        const auto begins = scratch.take(chunks), tail = scratch.take(chunks);
        queue.add<kernels::RunTails>(
            tile.count,
            {.low = tile.low, .high = tile.high, .value = value, .begins = begins, .tail = tail},
            tile.params(kind, {}, 0));
        const RunTile above({begins, begins, 1}, {0, static_cast<std::uint32_t>(chunks)});
        scan_level(queue, scratch, above, 1, tail, carry, before,
                   inclusive_mode | (mode & (carried_mode | second_mode)));
    }
    queue.add<kernels::RunScan>(tile.count,
                                {.low = tile.low,
                                 .high = tile.high,
                                 .value = value,
                                 .before = before,
                                 .carry = carry,
                                 .dst = to},
                                tile.params(kind, {}, mode));
}

}  // namespace

void segmented_scan(device::Queue& queue, Scratch& scratch, const Segments& runs,
                    const Words& values, const Words& to, bool inclusive) {
    check_size(runs.high, size(runs.low), "the high words of keys");
    check_size(values, size(runs.low), "the values of segments");
    check_size(to, size(runs.low), "the output of a segmented scan");
    const auto carry = scratch.take(2);
    std::uint32_t turn = 0;
    for (const Tile& at : cached_tiles(queue.device(), size(runs.low))) {
        const RunTile tile(runs, at);
        scan_level(queue, scratch, tile, runs.kind, tile.of(values), carry, tile.of(to),
                   (inclusive ? inclusive_mode : 0) | (at.first ? carried_mode : 0) |
                       (turn ? second_mode : 0) | hand_on_mode);
        turn = 1 - turn;
    }
}

}  // namespace topple::primitives
