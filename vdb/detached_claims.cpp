// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/scan_gaps.h"
#include "core/touching_cells.h"
#include "core/union_find.h"
#include "vdb/completion.h"

namespace topple::vdb {
namespace {

// Cells that hang together: by corners at least, or up and down across a hidden gap within one
// primitive. What is of the room, or of no primitive, hangs together with nothing.
class Pieces {
  public:
    explicit Pieces(const VolumeView& view)
        : view_(view), cells_(view.cells()), sets_(cells_.size()), seen_(cells_.size(), false) {
        each_touching(cells_, [&](std::size_t m, std::size_t n) { join(m, n); });
        each_across_gaps(cells_, noise_gap, [&](std::size_t m, std::size_t n) {
            if (cells_.primitive[m] == cells_.primitive[n]) join(m, n);
        });
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
    void join(std::size_t a, std::size_t b) {
        if (is_thing(a) && is_thing(b)) sets_.join(a, b);
    }

    const VolumeView& view_;
    const SolidCells& cells_;
    UnionFind sets_;
    std::vector<bool> seen_;
};

}  // namespace

std::vector<Claim> detached_claims(const VolumeView& view) {
    const SolidCells& cells = view.cells();
    Pieces pieces(view);
    std::vector<Claim> out;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (pieces.is_thing(n) && !pieces.seen(n))
            out.push_back({place_of(cells, n), -1, cells.basis[n], false});
    return out;
}

}  // namespace topple::vdb
