// SPDX-License-Identifier: MIT
#include "geometry/surfel_graph.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/sort_unique.h"
#include "geometry/cell_grid.h"

namespace topple::geometry {
namespace {

constexpr std::uint64_t graph_chunk = 1 << 10;  // surfels handed to a thread at once

// The surfels in blocks of 2^level cells a side.
class Blocks {
  public:
    Blocks(const Surfels& s, int level) {
        const auto block = [&](std::size_t i) {
            return GridCell{s.cx[i] >> level, s.cy[i] >> level, s.cz[i] >> level};
        };
        pack_ = CellPacking::of(s.size(), block, 1);
        keys_.resize(s.size());
        for (std::size_t i = 0; i < s.size(); ++i) keys_[i] = pack_(block(i));
        groups_ = group_keys(keys_);
        for (std::size_t g = 0; g < groups_.size(); ++g)
            key_of_group_.push_back(keys_[groups_.group(g)[0]]);
    }

    // Calls visit(j) for the surfels in the blocks at and around that of a surfel.
    template <class Visit>
    void around(std::size_t i, const Visit& visit) const {
        for (std::int64_t dx = -1; dx <= 1; ++dx)
            for (std::int64_t dy = -1; dy <= 1; ++dy) {
                const std::uint64_t low = keys_[i] + pack_.offset(dx, dy, -1);
                const std::uint64_t high = keys_[i] + pack_.offset(dx, dy, 1);
                auto at = std::lower_bound(key_of_group_.begin(), key_of_group_.end(), low);
                for (; at != key_of_group_.end() && *at <= high; ++at)
                    for (const std::uint32_t j :
                         groups_.group(static_cast<std::size_t>(at - key_of_group_.begin())))
                        visit(j);
            }
    }

  private:
    CellPacking pack_{{0, 0, 0}, {0, 0, 0}};
    std::vector<std::uint64_t> keys_, key_of_group_;
    KeyGroups groups_;
};

struct Tie {
    float distance2 = 0;
    std::uint32_t i = 0, j = 0;  // i < j
    auto operator<=>(const Tie&) const = default;
};

float distance2(const Surfels& s, std::size_t i, std::size_t j) {
    const float dx = s.x[i] - s.x[j], dy = s.y[i] - s.y[j], dz = s.z[i] - s.z[j];
    return dx * dx + dy * dy + dz * dz;
}

// For each of the surfels its ties to the nearest others.
std::vector<Tie> nearest_ties(const Surfels& s, std::vector<std::uint32_t> left, double reach_m,
                              ThreadPool& threads) {
    std::vector<Tie> out;
    for (int level = 1; !left.empty(); ++level) {
        const double block_m = s.cell_m * static_cast<double>(1 << level);
        const bool last = block_m >= reach_m;
        const double within_m = std::min(block_m, reach_m);
        const Blocks blocks(s, level);
        std::vector<std::vector<Tie>> ties(left.size());
        threads.each(left.size(), graph_chunk, [&](std::size_t n) {
            const std::uint32_t i = left[n];
            std::vector<Tie>& mine = ties[n];
            blocks.around(i, [&](std::uint32_t j) {
                const float d = distance2(s, i, j);
                if (j != i && d <= within_m * within_m)
                    mine.push_back({d, std::min(i, j), std::max(i, j)});
            });
            if (mine.size() < plane_neighbours && !last) {
                mine.clear();
                return;
            }
            const std::size_t kept = std::min(mine.size(), plane_neighbours);
            std::partial_sort(mine.begin(), mine.begin() + static_cast<std::ptrdiff_t>(kept),
                              mine.end());
            mine.resize(kept);
        });
        std::vector<std::uint32_t> next;
        for (std::size_t n = 0; n < left.size(); ++n) {
            if (ties[n].empty() && !last) next.push_back(left[n]);
            out.insert(out.end(), ties[n].begin(), ties[n].end());
        }
        left.swap(next);
    }
    sort_unique(out);
    return out;
}

}  // namespace

void connect_surfels(Surfels& s, double reach_m, ThreadPool& threads) {
    cell_neighbours(s.cx, s.cy, s.cz, threads, s.neighbour_first, s.neighbours);
    std::vector<std::uint32_t> lonely;
    for (std::uint32_t i = 0; i < s.size(); ++i)
        if (s.around(i).size() < plane_neighbours) lonely.push_back(i);
    const std::vector<Tie> ties = nearest_ties(s, std::move(lonely), reach_m, threads);
    std::vector<std::size_t> count(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) count[i] = s.around(i).size();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> added;
    for (const Tie& t : ties) {
        if (std::max(count[t.i], count[t.j]) >= most_neighbours ||
            std::ranges::binary_search(s.around(t.i), t.j))
            continue;
        ++count[t.i], ++count[t.j];
        added.emplace_back(t.i, t.j);
        added.emplace_back(t.j, t.i);
    }
    if (added.empty()) return;
    std::sort(added.begin(), added.end());
    std::vector<std::uint32_t> first(1, 0), all;
    auto next = added.begin();
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        const auto begin = static_cast<std::ptrdiff_t>(all.size());
        all.insert(all.end(), s.around(i).begin(), s.around(i).end());
        const auto middle = static_cast<std::ptrdiff_t>(all.size());
        for (; next != added.end() && next->first == i; ++next) all.push_back(next->second);
        std::inplace_merge(all.begin() + begin, all.begin() + middle, all.end());
        first.push_back(static_cast<std::uint32_t>(all.size()));
    }
    s.neighbour_first = std::move(first);
    s.neighbours = std::move(all);
}

}  // namespace topple::geometry
