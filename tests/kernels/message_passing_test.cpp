// SPDX-License-Identifier: MIT
#include "dense_layer.hpp"
#include "errors.h"
#include "neighbour_pool.hpp"
#include "oracle/message_passing_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

// The kernels of a network that passes messages along the edges of a graph.
namespace topple::test {
namespace {

using oracle::Matrix;
using Words = std::vector<std::uint32_t>;

Matrix rows_of(const std::vector<float>& flat, std::size_t width) {
    Matrix out;
    for (std::size_t at = 0; at < flat.size(); at += width)
        out.emplace_back(flat.begin() + static_cast<std::ptrdiff_t>(at),
                         flat.begin() + static_cast<std::ptrdiff_t>(at + width));
    return out;
}

class DenseLayer : public EachBackend {};
TOPPLE_ON_EACH_FORM(DenseLayer);

TEST_P(DenseLayer, MatchesTheOracle) {
    struct Shape {
        std::uint32_t rows, outputs, width[3];
        bool rectified, added;
    };
    for (const Shape& s :
         {Shape{0, 32, {3, 0, 0}, false, false}, Shape{1, 32, {1, 0, 0}, true, false},
          Shape{63, 64, {5, 2, 0}, false, true}, Shape{64, 32, {32, 64, 0}, true, true},
          Shape{997, 32, {32, 32, 32}, false, true}}) {
        SCOPED_TRACE(testing::Message() << s.rows << " rows");
        Random random(s.rows);
        constexpr std::uint32_t table_rows = 17;
        std::vector<float> table[3];
        Words of[3];
        Matrix x(s.rows);
        for (std::size_t part = 0; part < 3; ++part) {
            table[part] = random.floats(std::max(1u, table_rows * s.width[part]), -2, 2);
            const Matrix rows = rows_of(table[part], std::max(1u, s.width[part]));
            for (std::uint32_t row = 0; row < s.rows; ++row) {
                of[part].push_back(random.word() % table_rows);
                if (s.width[part] == 0) continue;
                const auto& more = rows[of[part].back()];
                x[row].insert(x[row].end(), more.begin(), more.end());
            }
            if (s.rows == 0) of[part].push_back(0);
        }
        const std::uint32_t inputs = s.width[0] + s.width[1] + s.width[2];
        // The layer does not stand at the start of the weights.
        const std::vector<float> weights = random.floats((2 + inputs) * s.outputs, -1, 1);
        Matrix w = rows_of(weights, s.outputs);
        w.erase(w.begin());
        const std::vector<float> before = random.floats(std::size_t{s.rows} * s.outputs, -3, 3);
        const device::Buffer<float> a(*device, table[0], "a"), b(*device, table[1], "b"),
            c(*device, table[2], "c"), weight(*device, weights, "weight");
        const device::Buffer<std::uint32_t> of_a(*device, of[0], "of_a"),
            of_b(*device, of[1], "of_b"), of_c(*device, of[2], "of_c");
        Guarded<float> y(*device, before.size(), "y");
        y.upload(before);
        run_kernel<kernels::DenseLayer>(*device, before.size(),
                                        {.a = a,
                                         .b = b,
                                         .c = c,
                                         .of_a = of_a,
                                         .of_b = of_b,
                                         .of_c = of_c,
                                         .weight = weight,
                                         .y = y.slice()},
                                        {.rows = s.rows,
                                         .outputs = s.outputs,
                                         .width_a = s.width[0],
                                         .width_b = s.width[1],
                                         .width_c = s.width[2],
                                         .weight_first = s.outputs,
                                         .rectified = s.rectified,
                                         .added = s.added});
        std::vector<double> want, bound;
        const Matrix held = rows_of(before, s.outputs);
        oracle::dense_layer(x, w, s.rectified, s.added ? &held : nullptr, want, bound);
        EXPECT_TRUE(within(y.download(), want, bound));
        EXPECT_TRUE(y.untouched());
    }
}

class NeighbourPool : public EachBackend {};
TOPPLE_ON_EACH_FORM(NeighbourPool);

TEST_P(NeighbourPool, MatchesTheOracle) {
    for (const auto& [nodes, count, width] :
         {std::array{1u, 0u, 32u}, {2u, 1u, 32u}, {64u, 63u, 64u}, {101u, 997u, 32u}}) {
        SCOPED_TRACE(testing::Message() << nodes << " nodes, " << count << " edges");
        Random random(count);
        std::vector<std::array<std::uint32_t, 2>> edges;
        for (std::uint32_t e = 0; e < count; ++e) {
            const std::uint32_t a = random.word() % nodes;
            edges.push_back({a, (a + 1 + random.word() % (nodes - 1)) % nodes});
        }
        Words first{0}, edge;
        for (std::uint32_t node = 0; node < nodes; ++node) {
            for (std::uint32_t e = 0; e < count; ++e)
                for (const std::uint32_t side : {0u, 1u})
                    if (edges[e][side] == node) edge.push_back(2 * e + side);
            first.push_back(static_cast<std::uint32_t>(edge.size()));
        }
        if (edge.empty()) edge.push_back(0);
        const std::size_t size = std::max(1u, count) * width;
        const std::vector<float> to_small = random.floats(size, 0, 2),
                                 to_big = random.floats(size, 0, 2);
        const device::Buffer<float> small(*device, to_small, "to_small"),
            big(*device, to_big, "to_big");
        const device::Buffer<std::uint32_t> firsts(*device, first, "first"),
            list(*device, edge, "edge");
        const Guarded<float> y(*device, std::size_t{nodes} * 2 * width, "y");
        run_kernel<kernels::NeighbourPool>(
            *device, std::size_t{nodes} * width,
            {.to_small = small, .to_big = big, .first = firsts, .edge = list, .y = y.slice()},
            {.nodes = nodes, .width = width});
        std::vector<double> want, bound;
        oracle::neighbour_pool(nodes, width, edges,
                               {rows_of(to_small, width), rows_of(to_big, width)}, want, bound);
        EXPECT_TRUE(within(y.download(), want, bound));
        EXPECT_TRUE(y.untouched());
    }
}

}  // namespace
}  // namespace topple::test
