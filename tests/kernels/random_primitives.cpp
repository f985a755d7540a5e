// SPDX-License-Identifier: MIT
#include "grid_bounds.hpp"
#include "grid_find.hpp"
#include "grid_keys.hpp"
#include "grid_masks.hpp"
#include "grid_pack.hpp"
#include "grid_shift.hpp"
#include "grid_unpack.hpp"
#include "random_dispatches.h"
#include "topple/kernels/primitives/components.h"
#include "topple/kernels/primitives/indexed.h"
#include "topple/kernels/primitives/reduce.h"
#include "topple/kernels/primitives/runs.h"
#include "topple/kernels/primitives/scan.h"
#include "topple/kernels/primitives/sort.h"
#include "topple/kernels/primitives/sparse_grid.h"

namespace topple::test {
namespace random_primitive {

using Words = std::vector<std::uint32_t>;

primitives::Words out(RandomBatch& to, std::size_t count) {
    return to.out<std::uint32_t>(count);
}
// Of few values or of all, so that there are equal ones and runs of them.
primitives::Words keys(RandomBatch& to, Random& random, std::uint32_t size) {
    Words words = naturals(random, size, std::size_t{1} << random.below(33));
    if (random.below(2)) std::ranges::sort(words);
    return to.in(words);
}
primitives::Segments segments(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto low = keys(to, random, size);
    const std::uint32_t kind = random.below(3);
    if (kind == 0) return primitives::Segments::of_flags(low);
    if (kind == 1) return primitives::Segments::of_keys(low);
    return primitives::Segments::of_keys(low, keys(to, random, size));
}
primitives::Reduction reduction(Random& random) {
    return primitives::Reduction{random.below(3)};
}

void reduce_words(RandomBatch& to, Random& random, std::uint32_t size) {
    primitives::reduce(to.queue, to.scratch, reduction(random), to.in(naturals(random, size)),
                       out(to, 1));
}

void reduce_reals(RandomBatch& to, Random& random, std::uint32_t size) {
    primitives::reduce(to.queue, to.scratch, reduction(random),
                       to.in(unbounded(random, size, false)), to.out<float>(1));
}

void scan(RandomBatch& to, Random& random, std::uint32_t size) {
    primitives::scan(to.queue, to.scratch, to.in(naturals(random, size)), out(to, size),
                     random.below(2));
}

void compact(RandomBatch& to, Random& random, std::uint32_t size) {
    Words flags = naturals(random, size, 1 + random.below(4));
    const std::size_t room = random.below(4) ? size : random.below(size + 1u);
    primitives::compact(to.queue, to.scratch, to.in(flags), to.in(naturals(random, size)),
                        out(to, room), out(to, 1));
}

void sort(RandomBatch& to, Random& random, std::uint32_t size) {
    primitives::Records from{keys(to, random, size)}, sorted{out(to, size)};
    if (random.below(2)) {
        from.high = keys(to, random, size);
        sorted.high = out(to, size);
    }
    if (random.below(2)) {
        from.value = to.in(naturals(random, size));
        sorted.value = out(to, size);
    }
    primitives::sort(to.queue, to.scratch, from, sorted);
}

void runs(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto starts = out(to, size + 1u), count = out(to, 1);
    primitives::unique(to.queue, to.scratch, segments(to, random, size), out(to, size),
                       out(to, size), starts, count);
    primitives::run_lengths(to.queue, starts, count, out(to, size));
}

void segmented_sum(RandomBatch& to, Random& random, std::uint32_t size) {
    primitives::segmented_sum(to.queue, to.scratch, segments(to, random, size),
                              to.in(naturals(random, size)), out(to, size), out(to, 1));
}

void segmented_scan(RandomBatch& to, Random& random, std::uint32_t size) {
    primitives::segmented_scan(to.queue, to.scratch, segments(to, random, size),
                               to.in(naturals(random, size)), out(to, size), random.below(2));
}

// Indices of some of `size` elements, and of some that are none.
primitives::Words indices(RandomBatch& to, Random& random, std::uint32_t size) {
    return to.in(naturals(random, random.below(2 * size + 2u), size + 3u));
}

void gather(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto index = indices(to, random, size);
    primitives::gather(to.queue, index, to.in(naturals(random, size)),
                       out(to, primitives::size(index)));
}

void scatter(RandomBatch& to, Random& random, std::uint32_t size) {
    Words index(size);
    std::iota(index.begin(), index.end(), random.below(3));
    random.shuffle(index);
    primitives::scatter(to.queue, to.in(index), to.in(naturals(random, size)), out(to, size));
}

void add_by_key(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto key = indices(to, random, size);
    primitives::add_by_key(to.queue, key, to.in(naturals(random, primitives::size(key))),
                           to.inout(naturals(random, size)));
}

void histogram(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto key = indices(to, random, size);
    primitives::histogram(to.queue, key, to.inout(naturals(random, size)));
}

void components(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t edges = random.below(2 * size + 2u);
    const auto ends = [&] { return to.in(naturals(random, edges, size + 1u)); };
    primitives::connected_components(to.queue, to.scratch, ends(), ends(), out(to, size));
}

void grid_keys(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto axis = [&] {
        return to.in(random.below(2) ? reals(random, size, 1e7f) : unbounded(random, size, true));
    };
    to.queue.add<kernels::GridKeys>(
        size, {.x = axis(), .y = axis(), .z = axis(), .low = out(to, size), .high = out(to, size)},
        {size, positive(random, 1, 100)[0]});
}

void grid_shift(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto way = [&] { return static_cast<std::int32_t>(random.word()) >> random.below(32); };
    to.queue.add<kernels::GridShift>(size,
                                     {.low = keys(to, random, size),
                                      .high = keys(to, random, size),
                                      .low_to = out(to, size),
                                      .high_to = out(to, size)},
                                     {size, way(), way(), way(), random.word()});
}

void grid_masks(RandomBatch& to, Random& random, std::uint32_t size) {
    const Words first = beginnings(random, size, 9);
    to.queue.add<kernels::GridMasks>(size,
                                     {.low = to.in(naturals(random, first.back())),
                                      .first = to.in(first),
                                      .mask = out(to, 16 * std::size_t{size})},
                                     {size});
}

// Of masks of any bits: what a cell's place is follows from them all the same.
void grid_find(RandomBatch& to, Random& random, std::uint32_t size) {
    constexpr std::int32_t reach = 1 << 5;
    std::vector<std::uint64_t> leaf(random.below(300));
    for (auto& key : leaf) {
        const auto at = [&] { return 8 * (static_cast<std::int32_t>(random.below(8)) - 4); };
        key = primitives::grid_key(at(), at(), at());
    }
    std::ranges::sort(leaf);
    leaf.erase(std::ranges::unique(leaf).begin(), leaf.end());
    Words low, high;
    for (const std::uint64_t key : leaf) {
        low.push_back(static_cast<std::uint32_t>(key));
        high.push_back(static_cast<std::uint32_t>(key >> 32));
    }
    const auto axis = [&] { return to.in(integers(random, size, -reach, reach)); };
    to.queue.add<kernels::GridFind>(
        size,
        {.i = axis(),
         .j = axis(),
         .k = axis(),
         .grid = {to.in(low), to.in(high), to.in(naturals(random, leaf.size())),
                  to.in(naturals(random, 16 * leaf.size()))},
         .place = out(to, size)},
        {size, static_cast<std::uint32_t>(leaf.size())});
}

void grid_packing(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto low = keys(to, random, size), high = keys(to, random, size);
    const std::uint32_t groups = (size + 1023) / 1024;
    to.queue.add<kernels::GridBounds>(
        groups, {.low = low, .high = high, .dst = out(to, 6 * std::size_t{groups})},
        {size, groups});
    const auto packed = out(to, size);
    const kernels::GridPackParams params{.count = size,
                                         .x = random.word(),
                                         .y = random.word(),
                                         .z = random.word(),
                                         .bits_y = random.below(19),
                                         .bits_z = random.below(19),
                                         .none = random.word()};
    to.queue.add<kernels::GridPack>(size, {.low = low, .high = high, .packed = packed}, params);
    to.queue.add<kernels::GridUnpack>(
        size, {.packed = packed, .low = out(to, size), .high = out(to, size)}, params);
}

void search(RandomBatch& to, Random& random, std::uint32_t size) {
    const auto list = [&](std::uint32_t count) {
        std::vector<std::uint64_t> all;
        for (const std::uint32_t low : naturals(random, count, 5000))
            all.push_back(std::uint64_t{random.below(3)} << 32 | low);
        return all;
    };
    std::vector<std::uint64_t> sorted = list(random.below(5000));
    std::ranges::sort(sorted);
    sorted.erase(std::ranges::unique(sorted).begin(), sorted.end());
    const auto word = [&](const std::vector<std::uint64_t>& all, unsigned shift) {
        Words words;
        for (const std::uint64_t key : all)
            words.push_back(static_cast<std::uint32_t>(key >> shift));
        return to.in(words);
    };
    const std::vector<std::uint64_t> wanted = list(size);
    primitives::search(to.queue, word(sorted, 0), word(sorted, 32), word(wanted, 0),
                       word(wanted, 32), out(to, size));
}

}  // namespace random_primitive

std::span<const RandomCase> random_primitives() {
    using namespace random_primitive;
    static constexpr RandomCase cases[] = {
        {"reduce_words", 5000, reduce_words},
        {"reduce_reals", 5000, reduce_reals},
        {"scan", 5000, scan},
        {"compact", 5000, compact},
        {"sort", 5000, sort},
        {"runs", 5000, runs},
        {"primitives' segmented_sum", 5000, segmented_sum},
        {"segmented_scan", 5000, segmented_scan},
        {"primitives' gather", 5000, gather},
        {"scatter", 5000, scatter},
        {"add_by_key", 5000, add_by_key},
        {"histogram", 5000, histogram},
        {"components", 5000, components},
        {"grid_keys", 5000, grid_keys},
        {"grid_shift", 5000, grid_shift},
        {"grid_masks", 1000, grid_masks},
        {"grid_find", 5000, grid_find},
        {"grid_packing", 5000, grid_packing},
        {"search_keys", 5000, search},
    };
    return cases;
}

}  // namespace topple::test
