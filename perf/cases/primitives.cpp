// SPDX-License-Identifier: MIT
#include <memory>
#include <utility>

#include "perf/cases/cases.h"
#include "topple/kernels/primitives/components.h"
#include "topple/kernels/primitives/indexed.h"
#include "topple/kernels/primitives/reduce.h"
#include "topple/kernels/primitives/runs.h"
#include "topple/kernels/primitives/scan.h"
#include "topple/kernels/primitives/sort.h"
#include "topple/kernels/primitives/sparse_grid.h"

// Data-parallel primitives on arrays of 64 MiB, larger than any cache of the machines this is meant
// for. Bytes: each input and output once; of a sort, keys and values in and out once for each digit
// of 8 bits.
namespace topple::perf {
namespace {

constexpr std::uint32_t count = 1u << 24;
using Words = std::vector<std::uint32_t>;
using Buffer = device::Buffer<std::uint32_t>;

// The steps of a congruential generator (Numerical Recipes, ch. 7), its upper bits.
Words noise(std::uint32_t words, std::uint32_t below_bits, std::uint32_t seed = 1) {
    Words out(words);
    std::uint64_t state = seed;
    for (auto& word : out) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        word = static_cast<std::uint32_t>(state >> (64 - below_bits));
    }
    return out;
}

// Ascending; one in eight is a new one.
Words ascending() {
    Words out = noise(count, 3);
    std::uint32_t key = 0;
    for (auto& word : out) word = word == 0 ? ++key : key;
    return out;
}

struct On {
    explicit On(device::Device& device) : scratch(device) {}
    const Buffer& in(const Words& words, const char* name) {
        inputs.push_back(upload(scratch.device(), words, name));
        return inputs.back();
    }
    const Buffer& out(std::uint64_t words, const char* name) {
        outputs.push_back({scratch.device(), words, name});
        outputs.back().fill(0);
        return outputs.back();
    }
    primitives::Scratch scratch;
    std::vector<Buffer> inputs, outputs;
};

template <class Enqueue>
Prepared prepared(const std::shared_ptr<On>& on, double bytes, Enqueue enqueue,
                  std::function<void()> reset = {}) {
    return {
        {.items = static_cast<double>(on->inputs[0].size()), .unit = "elements", .bytes = bytes},
        [on, enqueue](device::Queue& queue) {
            enqueue(queue, on->scratch, on->inputs, on->outputs);
        },
        std::move(reset),
        [on] {
            Hash hash;
            for (const Buffer& output : on->outputs) hash.add(output.download());
            return hash.value();
        }};
}

using Arrays = const std::vector<Buffer>&;

}  // namespace

Prepared reduction(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(noise(count, 32), "from");
    on->out(1, "to");
    return prepared(on, 4.0 * count,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::reduce(queue, scratch, primitives::Reduction::sum,
                                           primitives::Words(in[0]), primitives::Words(out[0]));
                    });
}

Prepared scan(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(noise(count, 32), "from");
    on->out(count, "to");
    return prepared(on, 8.0 * count,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::scan(queue, scratch, in[0], out[0]);
                    });
}

// Half of the elements are kept.
Prepared compaction(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(noise(count, 1), "flags");
    on->in(noise(count, 32, 2), "from");
    on->out(count, "to");
    on->out(1, "count");
    return prepared(on, 10.0 * count,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::compact(queue, scratch, in[0], in[1], out[0], out[1]);
                    });
}

Prepared sort_keys(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(noise(count, 32), "keys");
    on->out(count, "sorted");
    return prepared(on, 4 * 8.0 * count,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::sort(queue, scratch, {in[0]}, {out[0]});
                    });
}

// 4 million keys of 64 bits with a value each.
Prepared sort_wide_records(device::Device& device) {
    constexpr std::uint32_t records = count / 4;
    const auto on = std::make_shared<On>(device);
    on->in(noise(records, 32, 1), "low");
    on->in(noise(records, 32, 2), "high");
    on->in(noise(records, 32, 3), "value");
    for (const char* name : {"low", "high", "value"}) on->out(records, name);
    return prepared(
        on, 8 * 24.0 * records,
        [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
            primitives::sort(queue, scratch, {in[0], in[1], in[2]}, {out[0], out[1], out[2]});
        });
}

Prepared unique_wide_keys(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(ascending(), "low");
    on->in(Words(count, 5), "high");
    on->out(count, "low");
    on->out(count, "high");
    on->out(count + 1, "starts");
    on->out(1, "count");
    return prepared(on, (8.0 + 12.0 / 8) * count,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::unique(queue, scratch,
                                           primitives::Segments::of_keys(in[0], in[1]), out[0],
                                           out[1], out[2], out[3]);
                    });
}

// The leaves beside those of a grid of 2 million cells, and which of its cells others are, one
// after the other. Bytes: what is looked for and what is found; what is read of the grid stays in
// caches.
Prepared sparse_grid(device::Device& device) {
    constexpr std::uint32_t cells = count / 8;
    const auto on = std::make_shared<On>(device);
    const auto coordinates = std::make_shared<std::array<device::Buffer<std::int32_t>, 3>>();
    std::array<std::vector<std::int32_t>, 3> c;
    Words low, high;
    for (const std::uint32_t k : noise(cells, 30)) {
        for (std::size_t a = 0; a < 3; ++a)
            c[a].push_back(static_cast<std::int32_t>(k >> 10 * a & (a < 2 ? 1023 : 63)));
        const std::uint64_t cell = primitives::grid_key(c[0].back(), c[1].back(), c[2].back());
        low.push_back(static_cast<std::uint32_t>(cell));
        high.push_back(static_cast<std::uint32_t>(cell >> 32));
    }
    on->in(low, "low");
    on->in(high, "high");
    const auto grid = std::make_shared<primitives::SparseGrid>(
        primitives::SparseGrid::of_keys(device, on->inputs[0], on->inputs[1]));
    for (std::size_t a = 0; a < 3; ++a) (*coordinates)[a] = upload(device, c[a], "cells");
    on->out(cells, "places");
    on->out(grid->leaves, "leaves beside");
    return prepared(on, 16.0 * cells + 12.0 * grid->leaves,
                    [grid, coordinates](device::Queue& queue, primitives::Scratch& scratch, Arrays,
                                        Arrays out) {
                        const auto& [i, j, k] = *coordinates;
                        grid->find(queue, i, j, k, out[0]);
                        grid->neighbours(queue, scratch, 1, 0, 0, out[1]);
                    });
}

Prepared segmented_sums(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(ascending(), "keys");
    on->in(noise(count, 32), "values");
    on->out(count, "sums");
    on->out(1, "count");
    return prepared(on, (8.0 + 4.0 / 8) * count,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::segmented_sum(queue, scratch,
                                                  primitives::Segments::of_keys(in[0]), in[1],
                                                  out[0], out[1]);
                    });
}

Prepared segmented_scan(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(ascending(), "keys");
    on->in(noise(count, 32), "values");
    on->out(count, "sums");
    return prepared(on, 12.0 * count,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::segmented_scan(
                            queue, scratch, primitives::Segments::of_keys(in[0]), in[1], out[0]);
                    });
}

// Of 65,536 keys.
Prepared histogram(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(noise(count, 16), "keys");
    on->out(1u << 16, "counts");
    return prepared(
        on, 4.0 * count,
        [](device::Queue& queue, primitives::Scratch&, Arrays in, Arrays out) {
            primitives::histogram(queue, in[0], out[0]);
        },
        [on] { on->outputs[0].fill(0); });
}

Prepared gather_words(device::Device& device) {
    const auto on = std::make_shared<On>(device);
    on->in(noise(count, 24), "index");
    on->in(noise(count, 32, 2), "from");
    on->out(count, "to");
    return prepared(on, 12.0 * count,
                    [](device::Queue& queue, primitives::Scratch&, Arrays in, Arrays out) {
                        primitives::gather(queue, in[0], in[1], out[0]);
                    });
}

// 2 million nodes, an edge for each: most nodes in one component, many in small ones.
Prepared components(device::Device& device) {
    constexpr std::uint32_t nodes = count / 8;
    const auto on = std::make_shared<On>(device);
    on->in(noise(nodes, 21), "from");
    on->in(noise(nodes, 21, 2), "to");
    on->out(nodes, "components");
    return prepared(on, 12.0 * nodes,
                    [](device::Queue& queue, primitives::Scratch& scratch, Arrays in, Arrays out) {
                        primitives::connected_components(queue, scratch, in[0], in[1], out[0]);
                    });
}

}  // namespace topple::perf
