// SPDX-License-Identifier: MIT
#include "random_dispatches.h"
#include "topple/kernels/primitives/components.h"
#include "topple/kernels/primitives/indexed.h"
#include "topple/kernels/primitives/reduce.h"
#include "topple/kernels/primitives/runs.h"
#include "topple/kernels/primitives/scan.h"
#include "topple/kernels/primitives/sort.h"

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
    };
    return cases;
}

}  // namespace topple::test
