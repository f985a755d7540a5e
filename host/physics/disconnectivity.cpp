// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "physics/landscape.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

// The full tree, a basin for every local minimum, in the order in which the minima appear: by
// energy, equal ones by number.
MergeTree full_tree(std::span<const double> energy,
                    std::span<const std::vector<std::uint32_t>> neighbours) {
    const auto n = static_cast<std::uint32_t>(energy.size());
    std::vector<std::uint32_t> order(n), parent(n), elder(n);  // elder: basin of a component's root
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return energy[a] != energy[b] ? energy[a] < energy[b] : a < b;
    });
    constexpr std::uint32_t absent = std::numeric_limits<std::uint32_t>::max();
    std::fill(parent.begin(), parent.end(), absent);
    MergeTree tree;
    tree.basin_of.assign(n, -1);
    for (const std::uint32_t v : order) {
        std::uint32_t deepest = absent;  // of the components around
        for (const std::uint32_t w : neighbours[v]) {
            if (parent[w] == absent) continue;
            const std::uint32_t r = root(parent, w);
            if (deepest == absent || elder[r] < elder[deepest]) deepest = r;
        }
        parent[v] = v;
        if (deepest == absent) {
            elder[v] = static_cast<std::uint32_t>(tree.basins.size());
            tree.basins.push_back({v, energy[v], std::numeric_limits<double>::infinity(), v, -1});
        } else {
            const std::uint32_t basin = elder[deepest];
            for (const std::uint32_t w : neighbours[v]) {
                if (parent[w] == absent) continue;
                const std::uint32_t r = root(parent, w);
                if (elder[r] != basin && r != v) {
                    MergeTree::Basin& joins = tree.basins[elder[r]];
                    joins.pass = energy[v];
                    joins.saddle = v;
                    joins.parent = static_cast<std::int32_t>(basin);
                }
                parent[r] = v;
            }
            elder[v] = basin;
        }
        tree.basin_of[v] = static_cast<std::int32_t>(elder[v]);
    }
    return tree;
}

// A shallow basin counts as part of the one that it joins. Parents come before their children.
MergeTree without_shallow(MergeTree tree, double plateau_tolerance) {
    std::vector<std::int32_t> kept_as(tree.basins.size());
    std::vector<MergeTree::Basin> kept;
    for (std::size_t b = 0; b < tree.basins.size(); ++b) {
        MergeTree::Basin basin = tree.basins[b];
        const std::int32_t parent = basin.parent < 0 ? -1 : kept_as[basin.parent];
        if (parent >= 0 && basin.pass - basin.energy <= plateau_tolerance) {
            kept_as[b] = parent;
            continue;
        }
        basin.parent = parent;
        kept_as[b] = static_cast<std::int32_t>(kept.size());
        kept.push_back(basin);
    }
    tree.basins = std::move(kept);
    for (std::int32_t& basin : tree.basin_of) basin = kept_as[basin];
    return tree;
}

}  // namespace

MergeTree disconnectivity_graph(std::span<const double> energy,
                                std::span<const std::vector<std::uint32_t>> neighbours,
                                double plateau_tolerance) {
    if (energy.size() != neighbours.size()) {
        throw Error(ErrorKind::usage, "disconnectivity_graph: " + std::to_string(energy.size()) +
                                          " energies for " + std::to_string(neighbours.size()) +
                                          " nodes");
    }
    return without_shallow(full_tree(energy, neighbours), plateau_tolerance);
}

std::int32_t MergeTree::last_join(std::uint32_t a, std::uint32_t b) const {
    std::int32_t p = basin_of[a], q = basin_of[b], last = -1;
    const auto pass = [&](std::int32_t n) { return basins[n].pass; };
    // The later basin is never an ancestor of the earlier: climb from it.
    while (p != q) {
        std::int32_t& later = p > q ? p : q;
        if (last < 0 || pass(later) > pass(last)) last = later;
        later = basins[later].parent;
    }
    return last;
}

}  // namespace topple::physics
