// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "vdb/completion.h"

namespace topple::vdb {
namespace {

// Cells of one primitive that hang together: by corners, or up and down across a hidden gap.
class Pieces {
  public:
    Pieces(const SolidCells& cells, std::int32_t longest_gap)
        : cells_(cells), longest_gap_(longest_gap), parent_(cells.size()) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
        each_pair([&](std::size_t a, std::size_t b) {
            if (cells_.primitive[a] == cells_.primitive[b]) join(a, b);
        });
        across_gaps();
        for (std::size_t n = 0; n < parent_.size(); ++n) parent_[n] = root(n);
        seen_.assign(cells.size(), false);
        for (std::size_t n = 0; n < cells.size(); ++n)
            if (cells.basis[n] == Basis::surface) seen_[piece_of(n)] = true;
    }

    // The first of its cells stands for a piece.
    std::size_t piece_of(std::size_t cell) const { return parent_[cell]; }
    bool seen(std::size_t piece) const { return seen_[piece]; }

    // Each two cells that touch, by corners at least.
    template <class Use>
    void each_pair(const Use& use) const {
        constexpr std::array<std::array<std::int32_t, 2>, 4> rows{
            {{0, -1}, {-1, -1}, {-1, 0}, {-1, 1}}};
        std::array<std::size_t, 4> first{};
        for (std::size_t n = 0; n < cells_.size(); ++n) {
            const Voxel at = place(n);
            if (n > 0 && place(n - 1) == Voxel{at[0], at[1], at[2] - 1}) use(n - 1, n);
            for (std::size_t r = 0; r < rows.size(); ++r) {
                const Voxel low{at[0] + rows[r][0], at[1] + rows[r][1], at[2] - 1};
                while (first[r] < n && place(first[r]) < low) ++first[r];
                for (std::size_t m = first[r]; m < n; ++m) {
                    const Voxel other = place(m);
                    if (other[0] != low[0] || other[1] != low[1] || other[2] > low[2] + 2) break;
                    use(m, n);
                }
            }
        }
    }

  private:
    Voxel place(std::size_t n) const { return {cells_.i[n], cells_.j[n], cells_.k[n]}; }

    void across_gaps() {
        for (std::size_t n = 1; n < cells_.size(); ++n) {
            for (std::size_t m = n; m-- > 0;) {
                if (cells_.i[m] != cells_.i[n] || cells_.j[m] != cells_.j[n] ||
                    cells_.k[n] - cells_.k[m] > longest_gap_ + 1)
                    break;
                if (cells_.primitive[m] == cells_.primitive[n]) join(m, n);
            }
        }
    }

    std::size_t root(std::size_t cell) {
        while (parent_[cell] != cell) {
            parent_[cell] = parent_[parent_[cell]];
            cell = parent_[cell];
        }
        return cell;
    }
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const SolidCells& cells_;
    std::int32_t longest_gap_;
    std::vector<std::size_t> parent_;
    std::vector<bool> seen_;
};

}  // namespace

std::vector<Claim> detached(const VolumeView& view, std::int32_t longest_gap) {
    const SolidCells& cells = view.cells();
    const Pieces pieces(cells, longest_gap);
    const auto loose = [&](std::size_t cell) {
        const std::int32_t p = cells.primitive[cell];
        return p >= 0 && !view.in_shell(p) && !pieces.seen(pieces.piece_of(cell));
    };
    // How much each loose piece touches others that are not the room's.
    std::map<std::size_t, std::map<std::size_t, std::uint64_t>> touches;
    pieces.each_pair([&](std::size_t a, std::size_t b) {
        if (cells.primitive[a] == cells.primitive[b]) return;
        for (const auto& [own, other] : {std::pair(a, b), std::pair(b, a)}) {
            const std::int32_t p = cells.primitive[other];
            if (p >= 0 && !view.in_shell(p) && loose(own))
                ++touches[pieces.piece_of(own)][pieces.piece_of(other)];
        }
    });
    // Rounds: what touches something that was seen is of that, and so on.
    std::map<std::size_t, std::int32_t> taken;
    for (bool changed = true; changed;) {
        std::map<std::size_t, std::int32_t> more;
        for (const auto& [piece, others] : touches) {
            if (taken.contains(piece)) continue;
            std::uint64_t most = 0;
            for (const auto& [other, count] : others) {
                const auto at = taken.find(other);
                if (count <= most || (!pieces.seen(other) && at == taken.end())) continue;
                most = count;
                more[piece] = at == taken.end() ? cells.primitive[other] : at->second;
            }
        }
        changed = !more.empty();
        taken.merge(more);
    }
    std::vector<Claim> out;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (!loose(n)) continue;
        const auto at = taken.find(pieces.piece_of(n));
        const bool solid = at != taken.end();
        out.push_back(
            {{cells.i[n], cells.j[n], cells.k[n]}, solid ? at->second : -1, cells.basis[n], solid});
    }
    return out;
}

}  // namespace topple::vdb
