// SPDX-License-Identifier: MIT
#include "scale/join_blocks.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include "core/union_find.h"
#include "scale/block_stage.h"

namespace topple {
namespace {

// Of what two blocks have both seen, half of the halo on each side of the border is compared:
// further out a block sees things cut off.
tiles::VoxelBox compared(const tiles::Block& block) {
    tiles::VoxelBox out;
    for (std::size_t a = 0; a < 3; ++a) {
        out.low[a] = block.core.low[a] - (block.core.low[a] - block.seen.low[a]) / 2;
        out.high[a] = block.core.high[a] + (block.seen.high[a] - block.core.high[a]) / 2;
    }
    return out;
}

// Voxels that two primitives share at least, and their share of the smaller one.
constexpr std::uint64_t least_shared = 6;
constexpr double least_share = 0.5;

// What is kept of a block while its neighbours are read: its voxels near its border.
struct Border {
    std::vector<tiles::Voxel> at;  // ascending
    std::vector<std::int32_t> primitive;
};

// halo: of the layout, which no neighbour sees further than.
Border border_of(const BlockParts& parts, const tiles::Block& block, std::int32_t halo) {
    const tiles::VoxelBox outer = compared(block), inner = block.core.grown(-halo / 2);
    Border out;
    const SolidCells& c = parts.cells;
    for (std::size_t n = 0; n < c.size(); ++n) {
        const tiles::Voxel at = place_of(c, n);
        if (c.primitive[n] < 0 || !outer.holds(at) || inner.holds(at)) continue;
        out.at.push_back(at);
        out.primitive.push_back(c.primitive[n]);
    }
    return out;
}

// Pairs of primitives (of a, of b) that are one.
std::vector<std::pair<std::int32_t, std::int32_t>> matches(const Border& a, const Border& b,
                                                           const tiles::VoxelBox& region) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t> shared;
    std::map<std::int32_t, std::uint64_t> of_a, of_b;
    for (std::size_t n = 0; n < a.at.size(); ++n)
        if (region.holds(a.at[n])) ++of_a[a.primitive[n]];
    std::size_t m = 0;
    for (std::size_t n = 0; n < b.at.size(); ++n) {
        if (!region.holds(b.at[n])) continue;
        ++of_b[b.primitive[n]];
        while (m < a.at.size() && a.at[m] < b.at[n]) ++m;
        if (m < a.at.size() && a.at[m] == b.at[n]) ++shared[{a.primitive[m], b.primitive[n]}];
    }
    struct Best {
        std::int32_t other = -1;
        std::uint64_t count = 0;
        void take(std::int32_t by, std::uint64_t many) {
            if (many > count) *this = {by, many};
        }
    };
    std::map<std::int32_t, Best> best_of_a, best_of_b;
    for (const auto& [pair, count] : shared) {
        best_of_a[pair.first].take(pair.second, count);
        best_of_b[pair.second].take(pair.first, count);
    }
    std::vector<std::pair<std::int32_t, std::int32_t>> out;
    for (const auto& [p, best] : best_of_a) {
        if (best_of_b[best.other].other != p || best.count < least_shared) continue;
        const std::uint64_t smaller = std::min(of_a[p], of_b[best.other]);
        if (static_cast<double>(best.count) >= least_share * static_cast<double>(smaller))
            out.emplace_back(p, best.other);
    }
    return out;
}

const char* model_named(char initial) {
    return initial == 'p' ? "plane" : initial == 'q' ? "quadric" : "merged";
}

// Sorts the voxels of all cores, which come block by block, by (i, j, k): one i at a time, so that
// what sorting takes beside them is little.
void sort_cells(SolidCells& cells) {
    if (cells.size() == 0) return;
    const auto [low, high] = std::ranges::minmax(cells.i);
    std::vector<std::size_t> first(static_cast<std::size_t>(std::int64_t{high} - low) + 2, 0);
    const auto slice = [low = low](std::int32_t i) {
        return static_cast<std::size_t>(std::int64_t{i} - low);
    };
    for (const std::int32_t i : cells.i) ++first[slice(i) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> order(cells.size());
    auto next = first;
    for (std::size_t n = 0; n < cells.size(); ++n)
        order[next[slice(cells.i[n])]++] = static_cast<std::uint32_t>(n);
    for (std::size_t s = 0; s + 1 < first.size(); ++s)
        std::ranges::sort(std::span(order).subspan(first[s], first[s + 1] - first[s]), {},
                          [&](std::uint32_t n) { return std::pair(cells.j[n], cells.k[n]); });
    const auto sort = [&](auto& values) {
        auto sorted = values;
        for (std::size_t n = 0; n < order.size(); ++n) sorted[n] = values[order[n]];
        values = std::move(sorted);
    };
    SolidCells::each_array(sort, cells);
    sort(cells.unseen_below);
}

class Joiner {
  public:
    Joiner(const std::filesystem::path& folder, const tiles::Layout& layout)
        : folder_(folder), layout_(layout) {}

    JoinedBlocks join(StageClock& stage) {
        const std::size_t blocks = layout_.blocks.size();
        std::vector<Border> border(blocks);
        for (std::size_t b = 0; b < blocks; ++b) {
            const BlockParts parts = read_block(folder_, b);
            const SolidCells& c = parts.cells;
            const tiles::VoxelBox& core = layout_.blocks[b].core;
            border[b] = border_of(parts, layout_.blocks[b], layout_.halo);
            first_.push_back(about_.size());
            about_.insert(about_.end(), parts.primitives.begin(), parts.primitives.end());
            voxels_.resize(about_.size());
            for (std::size_t n = 0; n < c.size(); ++n) {
                if (!core.holds(place_of(c, n))) continue;
                ++cells_;
                if (c.primitive[n] >= 0) ++voxels_[member(b, c.primitive[n])];
            }
            samples_ += parts.samples.size();
            stage.progress("joining",
                           0.5 * static_cast<double>(b + 1) / static_cast<double>(blocks));
        }
        unite(border);
        border = {};
        JoinedBlocks out = collect(stage);
        geometry::sort_by_primitive(out.parts.samples);
        return out;
    }

  private:
    // Of all members, which are the primitives of all blocks, that one.
    std::size_t member(std::size_t block, std::int32_t primitive) const {
        return first_[block] + static_cast<std::size_t>(primitive);
    }

    void unite(const std::vector<Border>& border) {
        UnionFind sets(about_.size());
        for (std::size_t a = 0; a < border.size(); ++a) {
            for (std::size_t b = a + 1; b < border.size(); ++b) {
                const tiles::VoxelBox region =
                    compared(layout_.blocks[a]).common(compared(layout_.blocks[b]));
                if (region.empty()) continue;
                for (const auto& [p, q] : matches(border[a], border[b], region))
                    sets.join(member(a, p), member(b, q));
            }
        }
        number(sets);
    }

    // Numbers the sets that have voxels in a core, by their first member.
    void number(UnionFind& sets) {
        std::vector<std::uint64_t> voxels(about_.size(), 0);  // by root
        for (std::size_t m = 0; m < about_.size(); ++m) voxels[sets.root(m)] += voxels_[m];
        for (std::size_t m = 0; m < about_.size(); ++m) {
            const std::size_t root = sets.root(m);  // the first of its set
            const bool counts = root == m && voxels[root] >= least_voxels;
            number_.push_back(root == m ? (counts ? count_++ : -1) : number_[root]);
        }
    }

    JoinedBlocks collect(StageClock& stage) {
        JoinedBlocks out;
        SolidParts& parts = out.parts;
        parts.frame = layout_.frame;
        SolidCells cells;
        cells.voxel_m = layout_.voxel_m;
        SolidCells::each_array([&](auto& values) { values.reserve(cells_); }, cells);
        cells.unseen_below.reserve(cells_);
        std::vector<Role> roles = name(parts);
        parts.points.resize(parts.model.size());
        parts.seams.inside.resize(parts.model.size());
        for (std::size_t b = 0; b < layout_.blocks.size(); ++b) {
            const BlockParts block = read_block(folder_, b);
            std::vector<std::int32_t> numbers;
            for (std::size_t p = 0; p < block.primitives.size(); ++p)
                numbers.push_back(number_[first_[b] + p]);
            add_cells(block, layout_.blocks[b].core, numbers, cells);
            add_seams(block.seams, numbers, parts.seams);
            add_samples(block.samples, numbers, samples_, parts.samples);
            out.number.push_back(std::move(numbers));
            stage.progress("joining", 0.5 + 0.5 * static_cast<double>(b + 1) /
                                                static_cast<double>(layout_.blocks.size()));
        }
        sort_cells(cells);
        parts.solids = std::make_shared<const SolidScene>(std::move(cells), std::move(roles));
        return out;
    }

    // What most of a primitive's voxels lie in decides what it is.
    std::vector<Role> name(SolidParts& parts) const {
        const auto count = static_cast<std::size_t>(count_);
        std::vector<std::map<char, std::uint64_t>> model(count);
        std::vector<std::map<Role, std::uint64_t>> role(count);
        std::vector<double> odds(count), voxels(count);
        for (std::size_t m = 0; m < about_.size(); ++m) {
            if (number_[m] < 0) continue;
            const auto p = static_cast<std::size_t>(number_[m]);
            model[p][about_[m].model] += voxels_[m];
            role[p][about_[m].role] += voxels_[m];
            odds[p] += static_cast<double>(voxels_[m]) * double{about_[m].shell_log_odds};
            voxels[p] += static_cast<double>(voxels_[m]);
        }
        const auto most = [](const auto& votes) {
            return std::ranges::max_element(votes, {}, [](const auto& v) { return v.second; })
                ->first;
        };
        std::vector<Role> roles;
        for (std::size_t p = 0; p < count; ++p) {
            parts.model.emplace_back(model_named(most(model[p])));
            roles.push_back(most(role[p]));
            parts.shell_log_odds.push_back(odds[p] / std::max(voxels[p], 1.0));
        }
        return roles;
    }

    static void add_cells(const BlockParts& block, const tiles::VoxelBox& core,
                          const std::vector<std::int32_t>& numbers, SolidCells& to) {
        for (std::size_t n = 0; n < block.cells.size(); ++n) {
            const std::int32_t p = block.cells.primitive[n];
            if (core.holds(place_of(block.cells, n)))
                to.add(block.cells, n, p < 0 ? -1 : numbers[p]);
        }
    }

    static void add_seams(const geometry::SurfaceSeams& from,
                          const std::vector<std::int32_t>& numbers, geometry::SurfaceSeams& to) {
        const auto add = [](geometry::Seam& seam, const geometry::Seam& more) {
            seam.variation += more.variation;
            seam.pairs += more.pairs;
            seam.flush += more.flush;
            seam.ledge += more.ledge;
        };
        for (std::size_t p = 0; p < from.inside.size(); ++p) {
            if (numbers[p] >= 0) add(to.inside[numbers[p]], from.inside[p]);
        }
        for (const auto& [pair, seam] : from.between) {
            const std::int32_t a = numbers[pair.first], b = numbers[pair.second];
            if (a < 0 || b < 0) continue;
            if (a == b) {
                add(to.inside[a], seam);
            } else {
                add(to.between[std::minmax(a, b)], seam);
            }
        }
    }

    // Of primitives that are kept, of `all` at most. The spacing is the mean over all.
    static void add_samples(const geometry::SurfaceSamples& from,
                            const std::vector<std::int32_t>& numbers, std::size_t all,
                            geometry::SurfaceSamples& to) {
        const auto count = static_cast<double>(to.size()), more = static_cast<double>(from.size());
        if (from.size() == 0) return;
        to.edge_m = from.edge_m;
        to.spacing_m = (count * to.spacing_m + more * from.spacing_m) / (count + more);
        const auto columns = geometry::columns_of(to);
        const auto sources = geometry::columns_of(from);
        for (std::size_t c = 0; c < columns.size(); ++c)
            if (!sources[c]->empty()) columns[c]->reserve(all);
        to.primitive.reserve(all);
        for (std::size_t n = 0; n < from.size(); ++n) {
            const std::int32_t p = numbers[from.primitive[n]];
            if (p < 0) continue;
            for (std::size_t c = 0; c < columns.size(); ++c)
                if (!sources[c]->empty()) columns[c]->push_back((*sources[c])[n]);
            to.primitive.push_back(p);
        }
    }

    const std::filesystem::path& folder_;
    const tiles::Layout& layout_;
    std::vector<std::size_t> first_;            // member that is a block's primitive 0
    std::vector<BlockParts::Primitive> about_;  // by member
    std::vector<std::uint64_t> voxels_;         // of each member in its block's core
    std::size_t cells_ = 0, samples_ = 0;       // of all cores
    std::vector<std::int32_t> number_;          // by member
    std::int32_t count_ = 0;
};

}  // namespace

JoinedBlocks join_blocks(const std::filesystem::path& folder, const tiles::Layout& layout,
                         StageClock& stage) {
    return Joiner(folder, layout).join(stage);
}

}  // namespace topple
