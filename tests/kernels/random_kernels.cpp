// SPDX-License-Identifier: MIT
#include "barrier_probe.hpp"
#include "dense_layer.hpp"
#include "dialect_probe.hpp"
#include "disturbance.hpp"
#include "disturbance_reach.hpp"
#include "divide.hpp"
#include "gather.hpp"
#include "group_stance.hpp"
#include "multiply_add.hpp"
#include "neighbour_pool.hpp"
#include "normal_cluster.hpp"
#include "plane_mean.hpp"
#include "random_dispatches.h"
#include "rocking.hpp"
#include "support_function.hpp"
#include "triad.hpp"
#include "voxel_normals.hpp"

// Inputs of each kernel as wild as its head comment, and comparisons that NaN must not reach,
// allow.
namespace topple::test {
namespace random_kernel {

using Words = std::vector<std::uint32_t>;

// Products of two are finite, and so are sums of many.
constexpr float large = 1e17f;

std::uint32_t rounded_up(std::uint32_t size, std::uint32_t unit) {
    return (size + unit - 1) / unit * unit;
}

void support_function(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t vertices = random.below(40), skipped = random.below(9),
                        directions = rounded_up(size, 32), first = random.below(70);
    const auto axis = [&](std::uint32_t count) { return to.in(reals(random, count, large)); };
    to.queue.add<kernels::SupportFunction>(directions,
                                           {.vx = axis(skipped + vertices),
                                            .vy = axis(skipped + vertices),
                                            .vz = axis(skipped + vertices),
                                            .dx = axis(directions),
                                            .dy = axis(directions),
                                            .dz = axis(directions),
                                            .s = to.out<float>(first + directions)},
                                           {.vertex_count = vertices,
                                            .vertex_first = skipped,
                                            .direction_count = directions,
                                            .output_first = first});
}

// Columns of cells that lie near one another, as of neighbouring queries, or anywhere.
struct Columns {
    std::int32_t radius;
    std::uint32_t queries, cells;
    Words columns, home;

    Columns(Random& random, std::uint32_t size)
        : radius(1 + static_cast<std::int32_t>(random.below(3))),
          queries(size),
          cells(16 + random.below(200)),
          home(naturals(random, size, cells)) {
        const std::uint32_t side = 2 * static_cast<std::uint32_t>(radius) + 1;
        const bool near = random.below(2);
        const std::uint32_t middle = random.below(cells);
        for (std::uint32_t n = 0; n < side * side * queries; ++n) {
            const std::uint32_t count = random.below(random.below(9) ? 3 : 16);
            const std::uint32_t first = near ? middle + random.below(8) : random.below(cells);
            columns.push_back(std::min(first, cells - count) | count << 28);
        }
    }
};

void voxel_normals(RandomBatch& to, Random& random, std::uint32_t size) {
    const Columns c(random, size);
    auto cells = positive(random, c.cells, 1);  // weights, then means and covariances
    // Squares of weights are no denormals, whose reciprocals would be infinite.
    for (float& weight : cells) weight = weight < 1e-6f ? 0 : weight;
    const auto rest = reals(random, 9 * c.cells, 0.5f);
    cells.insert(cells.end(), rest.begin(), rest.end());
    const float reach = static_cast<float>(c.radius) + 0.5f;
    to.queue.add<kernels::VoxelNormals>(size,
                                        {.cells = to.in(cells),
                                         .cell_z = to.in(integers(random, c.cells, -2, 3)),
                                         .columns = to.in(c.columns),
                                         .query_cell = to.in(c.home),
                                         .query = to.in(reals(random, 3 * size, 0.5f)),
                                         .prior = to.in(reals(random, 3 * c.cells, 1)),
                                         .fit = to.out<float>(6 * size)},
                                        {.query_count = size,
                                         .cell_count = c.cells,
                                         .radius = c.radius,
                                         .inverse_reach2 = 1 / (reach * reach),
                                         .use_prior = random.below(2)});
}

void plane_mean(RandomBatch& to, Random& random, std::uint32_t size) {
    const Columns c(random, size);
    auto planes = positive(random, c.cells, 1);
    const auto rest = reals(random, 7 * c.cells, 1);
    planes.insert(planes.end(), rest.begin(), rest.end());
    const float reach = static_cast<float>(c.radius) + 0.5f;
    to.queue.add<kernels::PlaneMean>(size,
                                     {.planes = to.in(planes),
                                      .cell_z = to.in(integers(random, c.cells, -2, 3)),
                                      .columns = to.in(c.columns),
                                      .query_cell = to.in(c.home),
                                      .offsets = to.out<float>(size)},
                                     {.query_count = size,
                                      .cell_count = c.cells,
                                      .radius = c.radius,
                                      .reach2 = reach * reach,
                                      .least_cosine = random.uniform(0, 1)});
}

void normal_cluster(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t groups = rounded_up(size, 1024) / 1024, axes = 1 + random.below(32);
    to.queue.add<kernels::NormalCluster>(
        groups,
        {.nx = to.in(reals(random, size, 1)),
         .ny = to.in(reals(random, size, 1)),
         .nz = to.in(reals(random, size, 1)),
         .weight = to.in(positive(random, size, 1)),
         .axes = to.in(reals(random, 3 * axes, 1)),
         .partial = to.out<std::int32_t>(std::size_t{4} * groups * axes),
         .cluster = to.out<std::uint32_t>(size)},
        {.count = size, .cluster_count = axes});
}

// Blocks of a map, and steps that stay on it.
struct Blocks {
    static constexpr std::int32_t margin = 200;
    static constexpr std::uint32_t map_cells = 3000;
    std::uint32_t cells, rows;
    Words starts;

    Blocks(Random& random, std::uint32_t size)
        : cells(rounded_up(size, 64)),
          rows(1 + random.below(20)),
          starts(naturals(random, cells / 64, map_cells - 2 * margin - 64)) {
        for (auto& start : starts) start += margin;
    }
};

void disturbance_reach(RandomBatch& to, Random& random, std::uint32_t size) {
    const Blocks b(random, size);
    const Words first = beginnings(random, b.rows, 12);
    const auto steps = [&] { return integers(random, first.back(), -b.margin, b.margin); };
    Words solid = naturals(random, b.map_cells);
    for (auto& word : solid) word &= random.word() & random.word();
    to.queue.add<kernels::DisturbanceReach>(
        std::uint64_t{b.rows} * b.cells,
        {.block_start = to.in(b.starts),
         .solid = to.in(solid),
         .row_first = to.in(first),
         .step_a = to.in(steps()),
         .step_b = to.in(steps()),
         .blocked = to.out<std::uint32_t>(std::size_t{b.rows} * b.cells)},
        {.cell_count = b.cells, .row_count = b.rows});
}

void disturbance(RandomBatch& to, Random& random, std::uint32_t size) {
    const Blocks b(random, size);
    const std::uint32_t directions = 1 + random.below(3), bands = 1 + random.below(8),
                        part = random.below(3), skipped = random.below(70);
    const Words first = beginnings(random, part + directions, 40);
    const std::uint32_t entries = first.back();
    to.queue.add<kernels::Disturbance>(
        std::uint64_t{directions} * ((bands + 3) / 4) * b.cells,
        {.block_start = to.in(b.starts),
         .primary = to.in(positive(random, std::size_t{directions} * b.map_cells, large)),
         .blocked = to.in(naturals(random, std::size_t{b.rows} * b.cells)),
         .entry_first = to.in(first),
         .entry_delta = to.in(integers(random, entries, -b.margin, b.margin)),
         .entry_row = to.in(naturals(random, entries, b.rows)),
         .entry_weight = to.in(positive(random, entries, large)),
         .density = to.out<float>(skipped + std::size_t{directions} * bands * b.cells)},
        {.cell_count = b.cells,
         .row_count = b.rows,
         .plane_cells = b.map_cells,
         .direction_count = directions,
         .footprint_first = part,
         .band_first = random.below(33 - bands),
         .band_count = bands,
         .output_first = skipped});
}

void dense_layer(RandomBatch& to, Random& random, std::uint32_t size) {
    constexpr std::uint32_t table_rows = 17;
    const std::uint32_t outputs = 32 * (1 + random.below(2)), skipped = random.below(100);
    const std::array<std::uint32_t, 3> width{1 + random.below(20), random.below(20),
                                             random.below(20)};
    // A rectifier compares, and NaN comes of infinities, too.
    const bool rectified = random.below(2);
    const auto any = [&](std::size_t count) {
        return rectified ? reals(random, count, large) : unbounded(random, count, true);
    };
    const auto table = [&](std::uint32_t columns) {
        return to.in(any(std::size_t{table_rows} * columns));
    };
    const auto rows = [&] { return to.in(naturals(random, size, table_rows)); };
    const std::size_t weights = outputs * (1 + width[0] + width[1] + width[2]);
    to.queue.add<kernels::DenseLayer>(std::uint64_t{size} * outputs,
                                      {.a = table(width[0]),
                                       .b = table(width[1]),
                                       .c = table(width[2]),
                                       .of_a = rows(),
                                       .of_b = rows(),
                                       .of_c = rows(),
                                       .weight = to.in(any(skipped + weights)),
                                       .y = to.inout(any(std::size_t{size} * outputs))},
                                      {.rows = size,
                                       .outputs = outputs,
                                       .width_a = width[0],
                                       .width_b = width[1],
                                       .width_c = width[2],
                                       .weight_first = skipped,
                                       .rectified = rectified,
                                       .added = random.below(2)});
}

void neighbour_pool(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t width = 32 * (1 + random.below(2)), edges = 1 + random.below(50);
    const Words first = beginnings(random, size, 6);
    const auto messages = [&] {
        return to.in(positive(random, std::size_t{edges} * width, large * large));
    };
    to.queue.add<kernels::NeighbourPool>(std::uint64_t{size} * width,
                                         {.to_small = messages(),
                                          .to_big = messages(),
                                          .first = to.in(first),
                                          .edge = to.in(naturals(random, first.back(), 2 * edges)),
                                          .y = to.out<float>(std::size_t{2} * size * width)},
                                         {.nodes = size, .width = width});
}

void group_stance(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t directions = 16 * (1 + random.below(4)), footings = 1 + random.below(30);
    const Words first = beginnings(random, size, 8);
    const auto some = [&](std::uint32_t count) { return to.in(reals(random, count, large)); };
    to.queue.add<kernels::GroupStance>(size,
                                       {.reach = some(footings * directions),
                                        .ux = some(directions),
                                        .uy = some(directions),
                                        .first = to.in(first),
                                        .footing = to.in(naturals(random, first.back(), footings)),
                                        .cx = some(size),
                                        .cy = some(size),
                                        .margin = to.out<float>(size)},
                                       {.groups = size, .directions = directions});
}

void rocking(RandomBatch& to, Random& random, std::uint32_t size) {
    constexpr std::uint32_t bodies = 9, planes = 7, steps = 32;
    const std::uint32_t events = rounded_up(size, 64);
    const Words first = beginnings(random, 3, 3);
    const std::uint32_t chunks = first.back();
    std::vector<float> shaking = random.floats(std::size_t{3} * steps * chunks, -8, 8), strongest;
    for (std::size_t n = 0; n < shaking.size(); n += steps) {
        const auto chunk = std::span(shaking).subspan(n, steps);
        if (random.below(3) == 0) std::ranges::fill(chunk, 0.0f);
        const auto [least, greatest] = std::ranges::minmax(chunk);
        const bool up = n >= std::size_t{2} * steps * chunks;
        strongest.push_back(up ? std::min(least, 0.0f) : std::max(-least, greatest));
    }
    const kernels::Rocking::Args arrays{
        .body = to.in(random.floats(bodies * planes, 0.02f, 1)),
        .event_body = to.in(naturals(random, events, bodies)),
        .event_scale = to.in(random.floats(std::size_t{4} * events, 0.3f, 1.2f)),
        .block_record = to.in(naturals(random, events / 64, first.size() - 1)),
        .record_first = to.in(first),
        .record_step = to.in(random.floats(first.size() - 1, 0.005f, 0.02f)),
        .shaking = to.in(shaking),
        .strongest = to.in(strongest),
        .outcome = to.out<float>(std::size_t{10} * events)};
    const float longest_s = random.uniform(0.1f, 1);
    constexpr std::uint32_t turns[] = {0, 2, 1000};
    for (std::size_t n = 0; n < 2; ++n) {
        to.queue.add<kernels::Rocking>(events, arrays,
                                       {.event_count = events,
                                        .body_count = bodies,
                                        .chunk_count = chunks,
                                        .gravity = 9.80665f,
                                        .longest_s = longest_s,
                                        .chunk_first = turns[n],
                                        .chunk_last = turns[n + 1]});
    }
}

void dialect_probe(RandomBatch& to, Random& random, std::uint32_t size) {
    to.queue.add<kernels::DialectProbe>(size,
                                        {.a = to.in(unbounded(random, size, false)),
                                         .b = to.in(unbounded(random, size, false)),
                                         .m = to.in(naturals(random, size)),
                                         .n = to.in(naturals(random, size)),
                                         .f = to.out<float>(10 * size),
                                         .w = to.out<std::uint32_t>(10 * size),
                                         .line = to.out<std::uint32_t>(size)},
                                        {.count = size});
}

void barrier_probe(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t groups = rounded_up(size, 64) / 64;
    to.queue.add<kernels::BarrierProbe>(groups,
                                        {.src = to.in(naturals(random, size)),
                                         .sums = to.out<std::uint32_t>(groups),
                                         .counts = to.inout(Words(8)),
                                         .extremes = to.inout(Words{0xffffffffu, 0})},
                                        {.count = size});
}

void triad(RandomBatch& to, Random& random, std::uint32_t size) {
    to.queue.add<kernels::Triad>(size,
                                 {.a = to.in(unbounded(random, size, true)),
                                  .b = to.in(unbounded(random, size, true)),
                                  .dst = to.out<float>(size)},
                                 {.count = size, .scale = random.uniform(-3, 3)});
}

// The probes of arithmetic, which change whole work-items of an array in place.
constexpr std::uint32_t probed = 256;
template <class Kernel>
void in_place(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t count = rounded_up(size, probed);
    to.queue.add<Kernel>(count, {.x = to.inout(unbounded(random, count, true))},
                         {.count = count, .rounds = random.below(20)});
}

void gather(RandomBatch& to, Random& random, std::uint32_t size) {
    const std::uint32_t count = rounded_up(size, probed), table_bits = 1 + random.below(8);
    to.queue.add<kernels::Gather>(
        count,
        {.table = to.in(naturals(random, std::size_t{1} << table_bits)),
         .sum = to.out<std::uint32_t>(count)},
        {.count = count, .rounds = random.below(20), .shift = 32 - table_bits});
}

}  // namespace random_kernel

std::span<const RandomCase> random_kernels() {
    using namespace random_kernel;
    static constexpr RandomCase cases[] = {
        {"support_function", 3000, support_function},
        {"voxel_normals", 200, voxel_normals},
        {"plane_mean", 200, plane_mean},
        {"normal_cluster", 3000, normal_cluster},
        {"disturbance_reach", 1000, disturbance_reach},
        {"disturbance", 500, disturbance},
        {"dense_layer", 100, dense_layer},
        {"neighbour_pool", 200, neighbour_pool},
        {"group_stance", 1000, group_stance},
        {"rocking", 129, rocking},
        {"dialect_probe", 3000, dialect_probe},
        {"barrier_probe", 3000, barrier_probe},
        {"triad", 3000, triad},
        {"multiply_add", 3000, in_place<kernels::MultiplyAdd>},
        {"divide", 3000, in_place<kernels::Divide>},
        {"gather", 3000, gather},
    };
    return cases;
}

}  // namespace topple::test
