// SPDX-License-Identifier: MIT
#include <array>
#include <memory>
#include <numeric>

#include "dense_layer.hpp"
#include "lab/random.h"
#include "neighbour_pool.hpp"
#include "perf/cases/cases.h"

namespace topple::perf {
namespace {

using scenes::Random;
using Floats = std::vector<float>;
using Words = std::vector<std::uint32_t>;

// A graph of a large building's primitives and the joints between them.
constexpr std::uint32_t nodes = 20'000, edges = 100'000, width = 32;

Floats numbers(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    Floats out(count);
    for (float& v : out) v = static_cast<float>(2 * random.uniform() - 1);
    return out;
}

// Ends of the edges: near each other in the list, as the primitives of a room are.
std::array<Words, 2> ends() {
    Random random(2);
    std::array<Words, 2> out;
    for (std::uint32_t e = 0; e < edges; ++e) {
        const std::uint32_t a = e / (edges / nodes);
        out[0].push_back(a);
        out[1].push_back((a + 1 + static_cast<std::uint32_t>(200 * random.uniform())) % nodes);
    }
    return out;
}

}  // namespace

// What both ends of each joint change it by: the widest layer of the network.
Prepared dense_layer(device::Device& device) {
    const std::array<Words, 2> end = ends();
    Words each(edges);
    std::iota(each.begin(), each.end(), 0u);
    struct Buffers {
        device::Buffer<float> h, e, weight, y;
        device::Buffer<std::uint32_t> small, big, each;
    };
    auto on = std::make_shared<Buffers>(
        Buffers{upload(device, numbers(nodes * width, 1), "h"),
                upload(device, numbers(edges * width, 3), "e"),
                upload(device, numbers((1 + 3 * width) * width, 4), "weight"),
                {device, edges * width, "y"},
                upload(device, end[0], "small"),
                upload(device, end[1], "big"),
                upload(device, each, "each")});
    Prepared out;
    const double values = double{edges} * width;
    out.work = {.items = edges,
                .unit = "rows",
                .bytes = 4 * (double{nodes} * width + 2 * values + 3.0 * edges),
                .operations = values * (2 * 3 * width + 1)};
    out.enqueue = [on](device::Queue& queue) {
        queue.add<kernels::DenseLayer>(std::uint64_t{edges} * width,
                                       {.a = on->h,
                                        .b = on->h,
                                        .c = on->e,
                                        .of_a = on->small,
                                        .of_b = on->big,
                                        .of_c = on->each,
                                        .weight = on->weight,
                                        .y = on->y},
                                       {.rows = edges,
                                        .outputs = width,
                                        .width_a = width,
                                        .width_b = width,
                                        .width_c = width,
                                        .weight_first = 0,
                                        .rectified = 1,
                                        .added = 0});
    };
    out.hash = [on] { return Hash().add(on->y.download()).value(); };
    return out;
}

Prepared neighbour_pool(device::Device& device) {
    const std::array<Words, 2> end = ends();
    Words first(nodes + 1, 0), edge(2 * edges);
    for (const Words& side : end)
        for (const std::uint32_t node : side) ++first[node + 1];
    std::inclusive_scan(first.begin(), first.end(), first.begin());
    Words next(first.begin(), first.end() - 1);
    for (std::uint32_t e = 0; e < edges; ++e)
        for (const std::uint32_t side : {0u, 1u}) edge[next[end[side][e]]++] = 2 * e + side;
    struct Buffers {
        device::Buffer<float> small, big, y;
        device::Buffer<std::uint32_t> first, edge;
    };
    auto on =
        std::make_shared<Buffers>(Buffers{upload(device, numbers(edges * width, 1), "to_small"),
                                          upload(device, numbers(edges * width, 2), "to_big"),
                                          {device, std::uint64_t{nodes} * 2 * width, "y"},
                                          upload(device, first, "first"),
                                          upload(device, edge, "edge")});
    Prepared out;
    const double values = 2.0 * edges * width;
    out.work = {.items = 2.0 * edges,
                .unit = "messages",
                .bytes = 4 * (values + 2.0 * nodes * width + nodes + 2.0 * edges),
                .operations = 2 * values};
    out.enqueue = [on](device::Queue& queue) {
        queue.add<kernels::NeighbourPool>(std::uint64_t{nodes} * width,
                                          {.to_small = on->small,
                                           .to_big = on->big,
                                           .first = on->first,
                                           .edge = on->edge,
                                           .y = on->y},
                                          {.nodes = nodes, .width = width});
    };
    out.hash = [on] { return Hash().add(on->y.download()).value(); };
    return out;
}

}  // namespace topple::perf
