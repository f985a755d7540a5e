// SPDX-License-Identifier: MIT
#include "geometry/plane_mean.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace topple::geometry {
namespace {

constexpr float least_cosine = 0.8f;  // of the angle between normals of one surface
constexpr std::uint32_t none = ~0u;
constexpr std::uint64_t chunk = 1 << 13;

}  // namespace

std::vector<float> mean_offsets(const CellGrid& grid, const PlaneQueries& queries,
                                const PlaneFit& fit, ThreadPool& pool) {
    const std::size_t count = queries.cell.size();
    std::vector<std::uint32_t> query_of(grid.size(), none);
    for (std::size_t q = 0; q < count; ++q)
        query_of[queries.cell[q]] = static_cast<std::uint32_t>(q);
    constexpr int radius = PlaneFitter::default_radius;
    constexpr float reach = radius + 0.5f;
    const ColumnSweep sweep(grid.x, grid.y, grid.z, radius);
    std::vector<float> out(count);
    pool.run(count, chunk, [&](std::uint64_t first, std::uint64_t last) {
        std::vector<std::array<float, 2>> sums(last - first);  // weight, weight * offset
        const auto cell_of = [&](std::size_t q) { return queries.cell[q]; };
        sweep.run(first, last, cell_of,
                  [&](std::size_t q, std::size_t, std::size_t lo, std::size_t hi) {
                      const std::uint32_t home = queries.cell[q];
                      for (std::size_t cell = lo; cell < hi; ++cell) {
                          const std::uint32_t other = query_of[cell];
                          if (other == none) continue;
                          float along = 0, square = 0, cosine = 0;
                          const std::array<float, 3> step{
                              static_cast<float>(grid.x[cell] - grid.x[home]),
                              static_cast<float>(grid.y[cell] - grid.y[home]),
                              static_cast<float>(grid.z[cell] - grid.z[home])};
                          for (std::size_t a = 0; a < 3; ++a) {
                              const float way = step[a] + queries.at[a][other] - queries.at[a][q];
                              along += fit.normal[a][other] * way;
                              square += way * way;
                              cosine += fit.normal[a][other] * fit.normal[a][q];
                          }
                          const float taper = 1 - square / (reach * reach);
                          if (taper <= 0 || std::abs(cosine) < least_cosine) continue;
                          const float weight = grid.weight[cell] * taper * taper;
                          sums[q - first][0] += weight;
                          sums[q - first][1] +=
                              weight * std::copysign(1.0f, cosine) * (fit.offset[other] + along);
                      }
                  });
        for (std::size_t q = first; q < last; ++q) {
            const auto& [weight, sum] = sums[q - first];
            out[q] = weight > 0 ? sum / weight : fit.offset[q];
        }
    });
    return out;
}

}  // namespace topple::geometry
