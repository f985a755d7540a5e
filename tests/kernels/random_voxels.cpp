// SPDX-License-Identifier: MIT
#include "carve.hpp"
#include "carve_case.h"
#include "carve_leaves.hpp"
#include "cell_share.hpp"
#include "random_dispatches.h"
#include "segmented_sum.hpp"
#include "six_fill_sweep.hpp"
#include "six_fill_vote.hpp"

// Inputs of the kernels of voxels, as random_kernels.cpp has them of the others.
namespace topple::test {
namespace random_voxel {

using Words = std::vector<std::uint32_t>;

Words shuffled(Random& random, std::uint32_t count) {
    Words out(count);
    std::iota(out.begin(), out.end(), 0u);
    random.shuffle(out);
    return out;
}

void carve_leaves(RandomBatch& to, Random& random, std::uint32_t size) {
    const CarveCase c(random.word(), size, 1 + random.below(3));
    to.queue.add<kernels::CarveLeaves>(size,
                                       {.leaf_x = to.in(c.origin[0]),
                                        .leaf_y = to.in(c.origin[1]),
                                        .leaf_z = to.in(c.origin[2]),
                                        .points = to.in(naturals(random, size, 2)),
                                        .camera = to.in(c.camera),
                                        .pyramid = to.in(c.pyramid),
                                        .mixed = to.out<std::uint32_t>(size),
                                        .front = to.out<std::uint32_t>(size)},
                                       c.params);
}

void carve(RandomBatch& to, Random& random, std::uint32_t size) {
    const CarveCase c(random.word(), size, 1 + random.below(3));
    to.queue.add<kernels::Carve>(std::uint64_t{512} * size,
                                 {.leaf_x = to.in(c.origin[0]),
                                  .leaf_y = to.in(c.origin[1]),
                                  .leaf_z = to.in(c.origin[2]),
                                  .mixed = to.in(naturals(random, size)),
                                  .camera = to.in(c.camera),
                                  .pyramid = to.in(c.pyramid),
                                  .evidence = to.inout(naturals(random, 512 * size))},
                                 c.params);
}

// Of a small number: what six_fill_sweep calls a cell, most of them such as can be filled.
std::uint32_t random_cell(Random& random, std::uint32_t n) {
    const std::uint32_t sides = random.below(2) * random.below(64) << 16;
    return n < 4 ? n : n < 7 ? n | sides : n == 7 ? 65535u | sides : 1u;
}

void six_fill_sweep(RandomBatch& to, Random& random, std::uint32_t size) {
    // Runs of one to four leaves.
    Words first, length;
    for (std::uint32_t at = 0; at < size; at += length.back()) {
        first.push_back(at);
        length.push_back(std::min(1 + random.below(4), size - at));
    }
    Words cells = naturals(random, 512 * size, 40);
    for (auto& cell : cells) cell = random_cell(random, cell);
    const std::uint32_t axis = random.below(3), runs = static_cast<std::uint32_t>(first.size());
    to.queue.add<kernels::SixFillSweep>(std::uint64_t{64} * runs,
                                        {.run_first = to.in(first),
                                         .run_length = to.in(length),
                                         .run_leaf = to.in(shuffled(random, size)),
                                         .run_ends = to.in(naturals(random, runs, 4)),
                                         .cells = to.in(cells),
                                         .entries = to.inout(naturals(random, 384 * size))},
                                        {.run_count = runs, .direction = 2 * axis});
}

void six_fill_vote(RandomBatch& to, Random& random, std::uint32_t leaves) {
    // Few labels and distances, so that ties are common; now and then any.
    Words cells = naturals(random, 512 * leaves, 12), entries = naturals(random, 384 * leaves, 7);
    for (auto& cell : cells) cell = random_cell(random, cell);
    for (auto& entry : entries)
        entry = random.below(30) ? entry | random.below(2) << 16 | random.below(3) << 17
                                 : random.word();
    to.queue.add<kernels::SixFillVote>(
        std::uint64_t{512} * leaves,
        {.cells = to.in(cells),
         .entries = to.in(entries),
         .filled = to.out<std::uint32_t>(512 * leaves)},
        {.count = 512 * leaves, .votes = 1 + random.below(6), .columns = random.below(2)});
}

void segmented_sum(RandomBatch& to, Random& random, std::uint32_t size) {
    const Words first = beginnings(random, size, random.below(8) ? 70 : 2048);
    const std::uint32_t cells = first.back();
    constexpr std::int32_t extent = 1 << 20;
    const auto axis = [&] { return to.in(integers(random, cells, -extent, extent)); };
    to.queue.add<kernels::SegmentedSum>(
        size,
        {.ci = axis(),
         .cj = axis(),
         .ck = axis(),
         .order = to.in(shuffled(random, cells)),
         .first = to.in(first),
         .sum = to.out<std::uint32_t>(3 * size)},
        {.origin_i = -extent, .origin_j = -extent, .origin_k = -extent});
}

void cell_share(RandomBatch& to, Random& random, std::uint32_t size) {
    constexpr std::uint32_t slots = 4, numbers = 13;
    const std::uint32_t patches = 1 + random.below(30);
    Words form = naturals(random, size);
    for (auto& word : form) word = (word & ~7u) | random.below(slots + 1);
    const auto axis = [&] { return to.in(integers(random, size, -50, 50)); };
    to.queue.add<kernels::CellShare>(size,
                                     {.ci = axis(),
                                      .cj = axis(),
                                      .ck = axis(),
                                      .slot = to.in(naturals(random, slots * size, patches)),
                                      .form = to.in(form),
                                      .surface = to.in(reals(random, numbers * patches, 2)),
                                      .share = to.out<std::uint32_t>(size),
                                      .moment = to.out<std::int32_t>(3 * size)},
                                     {.cell_count = size, .voxel_m = random.uniform(0.005f, 0.1f)});
}

}  // namespace random_voxel

std::span<const RandomCase> random_voxels() {
    using namespace random_voxel;
    static constexpr RandomCase cases[] = {
        {"carve_leaves", 300, carve_leaves},   {"carve", 4, carve},
        {"six_fill_sweep", 6, six_fill_sweep}, {"six_fill_vote", 6, six_fill_vote},
        {"segmented_sum", 200, segmented_sum}, {"cell_share", 500, cell_share},
    };
    return cases;
}

}  // namespace topple::test
