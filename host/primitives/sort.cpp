// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/sort.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/thread_pool.h"
#include "radix_count.hpp"
#include "radix_scatter.hpp"
#include "topple/kernels/primitives/scan.h"

namespace topple::primitives {
namespace {

constexpr unsigned digit_bits = 8;
constexpr std::uint64_t digits = 1u << digit_bits;

// Keys of a chunk: so few that all work-items of the device have some, and that lavapipe runs a
// work-item's loops over them and its 512 counters to their end (docs/dialect.md); so many that the
// counts of all chunks are few beside the keys.
std::uint64_t chunk_keys(device::Device& device, std::uint64_t count) {
    constexpr std::uint64_t unit = 512, most = 126 * unit;
    const std::uint64_t chunks =
        device.info().gpu ? 32768 : std::uint64_t{128} * device.threads().threads();
    const std::uint64_t least = device.items_per_lane(kernels::RadixCount::source());
    const std::uint64_t keys = std::clamp((count + chunks - 1) / chunks, least, most);
    return (keys + unit - 1) / unit * unit;
}

using Arrays = std::array<Words, 3>;

class RadixSort {
  public:
    RadixSort(device::Queue& queue, Scratch& scratch, std::uint64_t count)
        : queue_(queue),
          scratch_(scratch),
          chunk_(chunk_keys(queue.device(), count)),
          chunks_((count + chunk_ - 1) / chunk_),
          tiles_(tiles(queue.device(), count, chunk_)) {}

    // By one digit of the first array; `payloads` others go along.
    void pass(const Arrays& from, const Arrays& to, unsigned shift, std::uint32_t payloads) {
        const auto counts = scratch_.take(digits * chunks_),
                   starts = scratch_.take(digits * chunks_);
        for (const Tile& tile : tiles_)
            queue_.add<kernels::RadixCount>(
                work(tile), {.key = part(from[0], tile.first, tile.count), .counts = counts},
                params(tile, shift, payloads, {}));
        scan(queue_, scratch_, counts, starts);
        const auto unused = scratch_.take(1), nowhere = scratch_.take(1),
                   neither = scratch_.take(1);
        for (const Tile& tile : tiles_) {
            for (const Tile& window : windows(queue_.device(), to[0])) {
                const auto in = [&](std::size_t n) {
                    return n <= payloads ? part(from[n], tile.first, tile.count) : unused.words();
                };
                const auto out = [&](std::size_t n, const Words& none) {
                    return n <= payloads ? part(to[n], window.first, window.count) : none;
                };
                queue_.add<kernels::RadixScatter>(work(tile),
                                                  {.key = in(0),
                                                   .a = in(1),
                                                   .b = in(2),
                                                   .start = starts,
                                                   .key_to = out(0, nowhere),
                                                   .a_to = out(1, nowhere),
                                                   .b_to = out(2, neither)},
                                                  params(tile, shift, payloads, window));
            }
        }
    }

  private:
    std::uint64_t work(const Tile& tile) const {
        const std::uint64_t items = queue_.device().items_per_lane(kernels::RadixCount::source());
        return (tile.count + chunk_ - 1) / chunk_ * items;
    }
    kernels::RadixParams params(const Tile& tile, unsigned shift, std::uint32_t payloads,
                                const Tile& window) const {
        return {.count = tile.count,
                .chunk = static_cast<std::uint32_t>(chunk_),
                .chunks = static_cast<std::uint32_t>(chunks_),
                .chunk_first = static_cast<std::uint32_t>(tile.first / chunk_),
                .shift = shift,
                .payloads = payloads,
                .window_first = window.first,
                .window_count = window.count};
    }

    device::Queue& queue_;
    Scratch& scratch_;
    std::uint64_t chunk_, chunks_;
    std::vector<Tile> tiles_;
};

}  // namespace

void sort(device::Queue& queue, Scratch& scratch, const Records& from, const Records& to,
          unsigned bits) {
    const std::uint64_t count = size(from.low);
    const bool wide = from.high.range.memory, valued = from.value.range.memory;
    check_size(to.low, count, "the output of a sort");
    if (wide) check_size(from.high, count, "the high words of keys");
    if (wide) check_size(to.high, count, "the output of a sort");
    if (valued) check_size(from.value, count, "the values of a sort");
    if (valued) check_size(to.value, count, "the output of a sort");
    const unsigned most = wide ? 64 : 32;
    const unsigned passes =
        (std::clamp(bits ? bits : most, 1u, most) + digit_bits - 1) / digit_bits;
    if (count == 0) return;

    std::optional<Scratch::Lease> low, high, value;
    Records between;
    if (passes > 1) {
        between.low = low.emplace(scratch.take(count));
        if (wide) between.high = high.emplace(scratch.take(count));
        if (valued) between.value = value.emplace(scratch.take(count));
    }
    RadixSort radix(queue, scratch, count);
    const Records* in = &from;
    for (unsigned pass = 0; pass < passes; ++pass) {
        const Records* out = (passes - pass) % 2 ? &to : &between;
        const bool upper = pass * digit_bits >= 32;
        // The word with the digit first, then the other word, if any, and the value, if any.
        const auto arrays = [&](const Records& r) {
            Arrays a{upper ? r.high : r.low};
            std::size_t n = 1;
            if (wide) a[n++] = upper ? r.low : r.high;
            if (valued) a[n++] = r.value;
            for (Words& words : a)
                if (words.range.memory) words = part(words, 0, count);
            return a;
        };
        radix.pass(arrays(*in), arrays(*out), pass * digit_bits % 32,
                   static_cast<std::uint32_t>(wide) + static_cast<std::uint32_t>(valued));
        in = out;
    }
}

}  // namespace topple::primitives
