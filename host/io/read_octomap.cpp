// SPDX-License-Identifier: MIT
#include <octomap/OcTree.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "io/cloud_builder.h"
#include "io/octomap.h"
#include "io/octomap_file.h"
#include "io/text.h"

namespace topple::io {
namespace {

constexpr std::uint64_t most_occupied = std::uint64_t{1} << 23;

using Tree = octomap::OcTree;
using Voxel = std::array<std::int32_t, 3>;

Voxel lowest_voxel(const Tree::leaf_iterator& leaf, std::int32_t side) {
    Voxel v{};
    for (unsigned a = 0; a < 3; ++a) v[a] = (leaf.getKey()[a] & ~(side - 1)) - octomap_middle;
    return v;
}

// Sum of the directions to the free ones of the 26 voxels around; 0 where none is.
std::array<double, 3> towards_free(const Tree& tree, const Voxel& v) {
    std::array<double, 3> sum{};
    for (int n = 0; n < 27; ++n) {
        const std::array<int, 3> step{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
        octomap::OcTreeKey key;
        bool within = n != 13;
        for (unsigned a = 0; a < 3; ++a) {
            const std::int32_t k = v[a] + step[a] + octomap_middle;
            within = within && k >= 0 && k < 2 * octomap_middle;
            key[a] = static_cast<octomap::key_type>(k);
        }
        if (!within) continue;
        const octomap::OcTreeNode* node = tree.search(key);
        if (!node || tree.isNodeOccupied(node)) continue;
        const double length = std::hypot(step[0], step[1], step[2]);
        for (std::size_t a = 0; a < 3; ++a) sum[a] += step[a] / length;
    }
    return sum;
}

Tree read_tree(const std::filesystem::path& file, const OctomapFile& stored) {
    Tree tree(stored.resolution_m);
    std::istringstream stream{std::string(stored.tree)};
    if (stored.binary) {
        tree.readBinaryData(stream);
    } else {
        tree.readData(stream);
    }
    if (stream.fail()) fail(file, "its tree can't be read; the file is damaged");
    return tree;
}

}  // namespace

bool looks_like_octomap(const std::filesystem::path& path) {
    const auto extension = path.extension();
    return extension == ".bt" || extension == ".ot";
}

ScannedMap read_octomap(const std::filesystem::path& file, double unit_m) {
    const auto bytes = read_file(file);
    const OctomapFile stored = open_octomap(file, bytes.text());
    const Tree tree = read_tree(file, stored);
    ScannedMap map;
    map.space.voxel_m = stored.resolution_m * unit_m;
    std::uint64_t occupied = 0;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        const std::int32_t side = 1 << (octomap_depth - static_cast<int>(leaf.getDepth()));
        if (tree.isNodeOccupied(*leaf)) {
            occupied +=
                saturating_multiply(std::uint64_t(side) * std::uint64_t(side), std::uint64_t(side));
            if (occupied > most_occupied) {
                fail(file, "has more than " + std::to_string(most_occupied) +
                               " occupied voxels at its finest resolution; thin the map");
            }
        } else {
            const Voxel low = lowest_voxel(leaf, side);
            map.space.free.push_back(
                {low, {low[0] + side - 1, low[1] + side - 1, low[2] + side - 1}});
        }
    }
    if (occupied == 0) fail(file, "has no occupied leaf: there is nothing to parse");
    CloudBuilder cloud(file, occupied, true);
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        if (!tree.isNodeOccupied(*leaf)) continue;
        const std::int32_t side = 1 << (octomap_depth - static_cast<int>(leaf.getDepth()));
        const Voxel low = lowest_voxel(leaf, side);
        for (std::int32_t n = 0; n < side * side * side; ++n) {
            const Voxel v{low[0] + n / side / side, low[1] + n / side % side, low[2] + n % side};
            std::array<double, 3> centre{};
            for (std::size_t a = 0; a < 3; ++a) centre[a] = (v[a] + 0.5) * map.space.voxel_m;
            // Inside of a leaf there is nothing free around.
            bool at_border = false;
            for (std::size_t a = 0; a < 3; ++a)
                at_border = at_border || v[a] == low[a] || v[a] == low[a] + side - 1;
            cloud.add(centre, at_border ? towards_free(tree, v) : std::array<double, 3>{});
        }
    }
    map.cloud = cloud.finish();
    return map;
}

}  // namespace topple::io
