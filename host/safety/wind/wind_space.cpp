// SPDX-License-Identifier: MIT
#include "safety/wind/wind_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "safety/space_sums.h"

namespace topple::safety {
namespace {

// Cubes of whole voxels around all that is solid, about cell_m wide, wider where that were too
// many.
struct Lattice {
    std::array<std::int32_t, 3> low{};    // its lowest voxel
    std::array<std::int32_t, 3> cells{};  // along each axis
    std::int32_t step = 1;                // voxels across a cell

    explicit Lattice(const SolidCells& solid) {
        constexpr double cell_m = 0.05;
        constexpr std::int64_t most_cells = std::int64_t{1} << 22;
        const std::array<const std::vector<std::int32_t>*, 3> axes{&solid.i, &solid.j, &solid.k};
        std::array<std::int64_t, 3> wide{};
        for (std::size_t a = 0; a < 3; ++a) {
            const auto [least, greatest] = std::ranges::minmax(*axes[a]);
            low[a] = least;
            wide[a] = std::int64_t{greatest} - least + 1;
        }
        step = std::max(1, static_cast<std::int32_t>(std::lround(cell_m / solid.voxel_m)));
        const auto count = [&](std::size_t a) { return (wide[a] + step - 1) / step; };
        while (count(0) > most_cells / count(1) || count(0) * count(1) > most_cells / count(2))
            step *= 2;
        for (std::size_t a = 0; a < 3; ++a) cells[a] = static_cast<std::int32_t>(count(a));
    }
    std::int32_t middle(std::size_t axis, std::int32_t cell) const {
        return low[axis] + cell * step + step / 2;
    }
};

// The wind in one column of cells, from the lowest.
class Column {
  public:
    Column(const Columns& columns, const Lattice& lattice,
           std::span<const std::array<double, 2>> ways, const WindOptions& options)
        : columns_(columns),
          lattice_(lattice),
          ways_(ways),
          lee_(options.shelter_m / columns.voxel_m()),
          speed_(static_cast<float>(options.speed_m_s)),
          energy_(static_cast<float>(0.5 * options.air_density_kg_m3 * options.speed_m_s *
                                     options.speed_m_s)) {}

    // to: of each cell, all 0 before.
    void add(std::int32_t a, std::int32_t b, std::span<Passing> to) const {
        const std::int32_t i = lattice_.middle(0, a), j = lattice_.middle(1, b);
        // As many layers at a time as a word has bits for.
        const auto at_once = static_cast<std::size_t>(std::max(1, 64 / lattice_.step));
        for (std::size_t first = 0; first < to.size(); first += at_once) {
            const auto some = to.subspan(first, std::min(at_once, to.size() - first));
            const std::int32_t k = lattice_.middle(2, static_cast<std::int32_t>(first));
            std::uint64_t free = 0;
            for (std::size_t n = 0; n < some.size(); ++n) free |= bit(n);
            free &= ~columns_.solid(i, j, k);
            for (const std::array<double, 2>& way : ways_) {
                const std::uint64_t reached =
                    open_to_wind(columns_, i + 0.5, j + 0.5, k, free, i, j, way[0], way[1], lee_);
                for (std::size_t n = 0; n < some.size(); ++n)
                    if ((reached & bit(n)) != 0) some[n].add(gale(way), share());
            }
        }
    }

  private:
    std::uint64_t bit(std::size_t cell) const {
        return std::uint64_t{1} << (cell * static_cast<std::size_t>(lattice_.step));
    }
    float share() const { return 1.0f / static_cast<float>(ways_.size()); }
    Passing gale(const std::array<double, 2>& way) const {
        return {1,
                {static_cast<float>(way[0]) * speed_, static_cast<float>(way[1]) * speed_, 0},
                energy_};
    }

    const Columns& columns_;
    const Lattice& lattice_;
    std::span<const std::array<double, 2>> ways_;
    double lee_;  // voxels
    float speed_, energy_;
};

}  // namespace

std::uint64_t open_to_wind(const Columns& columns, double x, double y, std::int32_t k,
                           std::uint64_t layers, std::int32_t own_i, std::int32_t own_j, double dx,
                           double dy, double voxels) {
    std::int64_t last_i = own_i, last_j = own_j;
    for (double s = 0.5; s <= voxels && layers; s += 0.5) {
        const auto i = static_cast<std::int64_t>(std::floor(x - s * dx));
        const auto j = static_cast<std::int64_t>(std::floor(y - s * dy));
        if ((i == last_i && j == last_j) || (i == own_i && j == own_j)) continue;
        layers &= ~columns.solid(i, j, k);
        last_i = i;
        last_j = j;
    }
    return layers;
}

SpaceField wind_over_space(ThreadPool& threads, const SolidCells& solid, const Columns& columns,
                           std::span<const std::array<double, 2>> ways,
                           const WindOptions& options) {
    if (solid.size() == 0) return {};
    const Lattice lattice(solid);
    const Column column(columns, lattice, ways, options);
    const auto [ni, nj, nk] = lattice.cells;
    const auto tall = static_cast<std::size_t>(nk);
    std::vector<Passing> all(static_cast<std::size_t>(ni) * static_cast<std::size_t>(nj) * tall);
    const auto of_column = [&, nj = nj](std::int32_t a, std::int32_t b) {
        return std::span(all).subspan((static_cast<std::size_t>(a) * static_cast<std::size_t>(nj) +
                                       static_cast<std::size_t>(b)) *
                                          tall,
                                      tall);
    };
    threads.each(static_cast<std::size_t>(ni), 1, [&, nj = nj](std::size_t a) {
        for (std::int32_t b = 0; b < nj; ++b)
            column.add(static_cast<std::int32_t>(a), b, of_column(static_cast<std::int32_t>(a), b));
    });
    const double h = solid.voxel_m;
    SpaceSums sums({lattice.low[0] * h, lattice.low[1] * h, lattice.low[2] * h}, lattice.step * h);
    for (std::int32_t a = 0; a < ni; ++a)
        for (std::int32_t b = 0; b < nj; ++b)
            for (std::int32_t c = 0; c < nk; ++c)
                sums.add({a, b, c}, of_column(a, b)[static_cast<std::size_t>(c)]);
    SpaceField out = sums.take();
    out.energy_unit = "J/m^3";
    return out;
}

}  // namespace topple::safety
