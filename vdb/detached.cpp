// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/union_find.h"
#include "vdb/completion.h"

namespace topple::vdb {
namespace {

// Cells that hang together: by corners at least, or up and down across a hidden gap within one
// primitive. What is of the room, or of no primitive, hangs together with nothing.
class Pieces {
  public:
    Pieces(const VolumeView& view, std::int32_t longest_gap)
        : view_(view), cells_(view.cells()), sets_(cells_.size()), seen_(cells_.size(), false) {
        join_neighbours();
        join_across_gaps(longest_gap);
        for (std::size_t n = 0; n < cells_.size(); ++n)
            if (cells_.basis[n] == Basis::surface) seen_[sets_.root(n)] = true;
    }

    bool is_thing(std::size_t cell) const {
        const std::int32_t p = cells_.primitive[cell];
        return p >= 0 && !view_.in_shell(p);
    }
    // Whether a cell hangs together with one that was seen.
    bool seen(std::size_t cell) { return seen_[sets_.root(cell)]; }

  private:
    Voxel place(std::size_t n) const { return {cells_.i[n], cells_.j[n], cells_.k[n]}; }

    void join_neighbours() {
        constexpr std::array<std::array<std::int32_t, 2>, 4> rows{
            {{0, -1}, {-1, -1}, {-1, 0}, {-1, 1}}};
        std::array<std::size_t, 4> first{};
        for (std::size_t n = 0; n < cells_.size(); ++n) {
            const Voxel at = place(n);
            if (n > 0 && place(n - 1) == Voxel{at[0], at[1], at[2] - 1}) join(n - 1, n);
            for (std::size_t r = 0; r < rows.size(); ++r) {
                const Voxel low{at[0] + rows[r][0], at[1] + rows[r][1], at[2] - 1};
                while (first[r] < n && place(first[r]) < low) ++first[r];
                for (std::size_t m = first[r]; m < n; ++m) {
                    const Voxel other = place(m);
                    if (other[0] != low[0] || other[1] != low[1] || other[2] > low[2] + 2) break;
                    join(m, n);
                }
            }
        }
    }

    void join_across_gaps(std::int32_t longest) {
        for (std::size_t n = 1; n < cells_.size(); ++n) {
            for (std::size_t m = n; m-- > 0;) {
                if (cells_.i[m] != cells_.i[n] || cells_.j[m] != cells_.j[n] ||
                    cells_.k[n] - cells_.k[m] > longest + 1)
                    break;
                if (cells_.primitive[m] == cells_.primitive[n]) join(m, n);
            }
        }
    }

    void join(std::size_t a, std::size_t b) {
        if (is_thing(a) && is_thing(b)) sets_.join(a, b);
    }

    const VolumeView& view_;
    const SolidCells& cells_;
    UnionFind sets_;
    std::vector<bool> seen_;
};

}  // namespace

std::vector<Claim> detached(const VolumeView& view, std::int32_t longest_gap) {
    const SolidCells& cells = view.cells();
    Pieces pieces(view, longest_gap);
    std::vector<Claim> out;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (pieces.is_thing(n) && !pieces.seen(n))
            out.push_back({{cells.i[n], cells.j[n], cells.k[n]}, -1, cells.basis[n], false});
    return out;
}

}  // namespace topple::vdb
