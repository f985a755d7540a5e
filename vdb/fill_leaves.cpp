// SPDX-License-Identifier: MIT
#include "vdb/fill_leaves.h"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>
#include <utility>

namespace topple::vdb {
namespace {

using Leaf = LeafTable::Leaf;

using Bits = std::array<std::uint64_t, 8>;
constexpr std::uint64_t whole = ~std::uint64_t{0};
constexpr Bits all{whole, whole, whole, whole, whole, whole, whole, whole};

// Of the 64 lines of voxels of a leaf along an axis: those all of whose voxels can be filled, and
// those whose first or last one can.
struct Lines {
    std::uint64_t through = 0, first = 0, last = 0;
};
Lines lines_of(const Bits& bits, int axis) {
    Lines out;
    if (axis == 0) {
        out = {whole, bits[0], bits[7]};
        for (const std::uint64_t word : bits) out.through &= word;
        return out;
    }
    for (std::uint32_t x = 0; x < 8; ++x) {
        std::uint64_t through = 0xff, first = bits[x] & 0xff, last = bits[x] >> 56;
        if (axis == 2) through = first = last = 0;
        for (std::uint32_t y = 0; y < 8; ++y) {
            const std::uint64_t row = bits[x] >> (8 * y) & 0xff;  // by z
            if (axis == 1) {
                through &= row;
            } else {
                through |= std::uint64_t{row == 0xff} << y;
                first |= (row & 1) << y;
                last |= (row >> 7) << y;
            }
        }
        out.through |= through << (8 * x);
        out.first |= first << (8 * x);
        out.last |= last << (8 * x);
    }
    return out;
}

class FillLeaves {
  public:
    FillLeaves(const VoxelScene::Grids& grids, std::int32_t lowest)
        : g_(grids),
          table_(grids.leaves),
          state_(grids.state->getConstAccessor()),
          lowest_(lowest),
          kind_(table_.box_size(), Kind::unknown),
          candidate_(table_.box_size(), false),
          wanted_(table_.box_size(), false) {
        for (std::uint64_t n = 0; n < kind_.size(); ++n) {
            const Leaf leaf = table_.leaf_at(n);
            const auto* states = state_.probeConstLeaf(origin_of(leaf));
            kind_[n] = states                          ? Kind::mixed
                       : uniformly_empty(state_, leaf) ? Kind::empty
                                                       : Kind::unknown;
            if (states) mixed_.emplace(n, fillable(leaf, states));
        }
    }

    // Where enough rays may hit the same primitive: its own leaves, and those from which it lies in
    // as many directions.
    void add_voters(const std::vector<bool>& fills, unsigned votes) {
        std::vector<std::pair<std::int32_t, Leaf>> at = surfaces(fills);
        for (std::size_t first = 0; first < at.size();) {
            std::size_t end = first;
            while (end < at.size() && at[end].first == at[first].first) ++end;
            add_surrounded({at.data() + first, end - first}, votes);
            first = end;
        }
    }

    // Where the ray upwards may hit a primitive.
    void add_columns(const std::vector<bool>& fills) {
        std::vector<bool> surface(kind_.size(), false);
        for (const auto& [p, leaf] : surfaces(fills)) surface[index(leaf)] = true;
        for (std::int32_t x = 0; x < table_.count[0]; ++x) {
            for (std::int32_t y = 0; y < table_.count[1]; ++y) {
                bool below = false;
                for (std::int32_t z = table_.count[2]; z-- > 0;) {
                    const std::size_t n = place({x, y, z});
                    below = kind_[n] != Kind::empty && (below || surface[n]);
                    if (below) add(n);
                }
            }
        }
    }

    std::vector<Leaf> leaves() {
        for (int axis = 0; axis < 3; ++axis) add_lines(axis);
        std::vector<Leaf> out;
        for (std::uint64_t n = 0; n < wanted_.size(); ++n)
            if (wanted_[n]) out.push_back(table_.leaf_at(n));
        for (const Leaf& leaf : table_.beyond)
            if (!uniformly_empty(state_, leaf)) out.push_back(leaf);
        std::ranges::sort(out);
        return out;
    }

  private:
    enum class Kind : std::uint8_t { empty, unknown, mixed };  // all empty, all invisible, else

    std::size_t index(const Leaf& leaf) const {
        return static_cast<std::size_t>(table_.index_of(leaf));
    }
    // By its number of leaves from the corner of the table's box.
    std::size_t place(const Leaf& n) const {
        return index({table_.low[0] + n[0], table_.low[1] + n[1], table_.low[2] + n[2]});
    }

    // The voxels of a leaf that can be filled: bit y * 8 + z of word x. states: null where nobody
    // saw any of it.
    Bits fillable(const Leaf& leaf, const StateLeaf* states) const {
        Bits bits{};
        for (std::uint32_t v = 0; v < 512; ++v) {
            const bool unseen =
                !states || states->getValue(v) == static_cast<std::int32_t>(State::invisible);
            if (unseen && leaf[2] * 8 + static_cast<std::int32_t>(v & 7) >= lowest_)
                bits[v >> 6] |= std::uint64_t{1} << (v & 63);
        }
        return bits;
    }
    Bits fillable(std::size_t n) const {
        if (kind_[n] == Kind::mixed) return mixed_.at(n);
        const Leaf leaf = table_.leaf_at(n);
        if (leaf[2] * 8 >= lowest_) return all;
        return fillable(leaf, nullptr);
    }

    void add(std::size_t n) {
        if (kind_[n] == Kind::empty || fillable(n) == Bits{}) return;
        candidate_[n] = wanted_[n] = true;
    }

    // The leaves within the box in which primitives that fill have voxels, by primitive.
    std::vector<std::pair<std::int32_t, Leaf>> surfaces(const std::vector<bool>& fills) const {
        std::vector<std::pair<std::int32_t, Leaf>> out;
        for (auto leaf = g_.state->tree().cbeginLeaf(); leaf; ++leaf) {
            const Leaf at = leaf_of(leaf->origin());
            if (leaf->isEmpty() || !table_.in_box(at)) continue;
            const auto* label = g_.primitive->tree().probeConstLeaf(leaf->origin());
            std::int32_t last = -1;
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
                const std::int32_t p = label->getValue(voxel.pos());
                if (p < 0 || p == last || !fills[p]) continue;
                out.emplace_back(p, at);
                last = p;
            }
        }
        sort_unique(out);
        return out;
    }

    // The leaves of one primitive, and all those within their bounds from which it lies in `votes`
    // of the six directions.
    void add_surrounded(std::span<const std::pair<std::int32_t, Leaf>> own, unsigned votes) {
        Leaf low = own.front().second, high = low;
        for (const auto& [p, leaf] : own) {
            add(index(leaf));
            for (std::size_t a = 0; a < 3; ++a) {
                low[a] = std::min(low[a], leaf[a]);
                high[a] = std::max(high[a], leaf[a]);
            }
        }
        if (votes == 1) {  // a ray may come from anywhere along the primitive's lines
            low = table_.low;
            for (std::size_t a = 0; a < 3; ++a) high[a] = low[a] + table_.count[a] - 1;
        }
        Leaf size;
        for (std::size_t a = 0; a < 3; ++a) size[a] = high[a] - low[a] + 1;
        // Its extent along each line of leaves, by axis.
        constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
        std::array<std::vector<std::pair<std::int32_t, std::int32_t>>, 3> extent;
        const auto line = [&](const Leaf& leaf, std::size_t axis) {
            const std::size_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
            return static_cast<std::size_t>(leaf[u] - low[u]) * static_cast<std::size_t>(size[v]) +
                   static_cast<std::size_t>(leaf[v] - low[v]);
        };
        for (std::size_t a = 0; a < 3; ++a) {
            const std::size_t u = a == 0 ? 1 : 0, v = a == 2 ? 1 : 2;
            extent[a].assign(static_cast<std::size_t>(size[u]) * static_cast<std::size_t>(size[v]),
                             {most, -most});
            for (const auto& [p, leaf] : own) {
                auto& [first, last] = extent[a][line(leaf, a)];
                first = std::min(first, leaf[a]);
                last = std::max(last, leaf[a]);
            }
        }
        for (std::int32_t x = low[0]; x <= high[0]; ++x) {
            for (std::int32_t y = low[1]; y <= high[1]; ++y) {
                for (std::int32_t z = low[2]; z <= high[2]; ++z) {
                    const Leaf leaf{x, y, z};
                    unsigned directions = 0;
                    for (std::size_t a = 0; a < 3; ++a) {
                        const auto& [first, last] = extent[a][line(leaf, a)];
                        directions += (first < leaf[a]) + (last > leaf[a]);
                    }
                    if (directions >= votes) add(index(leaf));
                }
            }
        }
    }

    // What the rays of candidates cross along an axis.
    void add_lines(int axis) {
        const auto a = static_cast<std::size_t>(axis);
        const std::size_t u = a == 0 ? 1 : 0, v = a == 2 ? 1 : 2;
        for (std::int32_t m = 0; m < table_.count[u]; ++m) {
            for (std::int32_t n = 0; n < table_.count[v]; ++n) {
                Leaf first;
                first[a] = table_.low[a];
                first[u] = table_.low[u] + m;
                first[v] = table_.low[v] + n;
                add_line(first, axis, 1);
                first[a] += table_.count[a] - 1;
                add_line(first, axis, -1);
            }
        }
    }

    // Of one line of leaves, one way. Leaves that nobody saw count only if something follows.
    void add_line(Leaf leaf, int axis, std::int32_t way) {
        const auto a = static_cast<std::size_t>(axis);
        passed_.clear();
        const auto take_passed = [&] {
            for (const std::size_t n : passed_) wanted_[n] = true;
            passed_.clear();
        };
        std::uint64_t rays = 0;  // by line of voxels
        for (; table_.in_box(leaf); leaf[a] += way) {
            const std::size_t n = index(leaf);
            if (kind_[n] == Kind::empty) {
                take_passed();
                rays = 0;
                continue;
            }
            if (rays == 0 && !candidate_[n]) continue;
            if (rays != 0) passed_.push_back(n);
            const Lines lines = lines_of(fillable(n), axis);
            if ((rays & ~lines.through) != 0) take_passed();
            rays &= lines.through;
            if (!candidate_[n]) continue;
            take_passed();
            rays |= way > 0 ? lines.last : lines.first;
        }
        if (uniformly_empty(state_, leaf) || table_.index_of(leaf) >= 0) take_passed();
    }

    const VoxelScene::Grids& g_;
    const LeafTable& table_;
    openvdb::Int32Grid::ConstAccessor state_;
    std::int32_t lowest_;
    std::vector<Kind> kind_;                       // of the leaves in the table's box
    std::unordered_map<std::size_t, Bits> mixed_;  // what can be filled of leaves of that kind
    std::vector<bool> candidate_, wanted_;
    std::vector<std::size_t> passed_;
};

}  // namespace

bool uniformly_empty(const openvdb::Int32Grid::ConstAccessor& state, const Leaf& leaf) {
    return !state.probeConstLeaf(origin_of(leaf)) &&
           state.getValue(origin_of(leaf)) == static_cast<std::int32_t>(State::empty);
}

std::vector<Leaf> leaves_to_fill(const VoxelScene::Grids& grids, const std::vector<bool>& fills,
                                 unsigned votes, std::int32_t lowest) {
    FillLeaves leaves(grids, lowest);
    leaves.add_voters(fills, votes);
    leaves.add_columns(fills);
    return leaves.leaves();
}

}  // namespace topple::vdb
