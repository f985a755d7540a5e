// SPDX-License-Identifier: MIT
#include <octomap/OcTree.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string>

#include "io/file_writer.h"
#include "io/text.h"
#include "points/formats/octomap.h"
#include "points/formats/octomap_file.h"

namespace topple::io {
namespace {

constexpr std::uint8_t empty = 0, surface = 1;
constexpr unsigned block_depth = octomap_depth - 3;  // of nodes of 8x8x8 voxels

using Tree = octomap::OcTree;

octomap::OcTreeKey key_of(std::int32_t x, std::int32_t y, std::int32_t z) {
    const auto shifted = [](std::int32_t v) {
        return static_cast<octomap::key_type>(v + octomap_middle);
    };
    return {shifted(x), shifted(y), shifted(z)};
}

// Makes a block free as one node. The tree must have a root, and nothing in the block.
void free_block(Tree& tree, const octomap::OcTreeKey& key) {
    octomap::OcTreeNode* node = tree.getRoot();
    for (unsigned depth = 0; depth < block_depth; ++depth) {
        const unsigned child = octomap::computeChildIdx(key, octomap_depth - 1 - int(depth));
        node = tree.nodeChildExists(node, child) ? tree.getNodeChild(node, child)
                                                 : tree.createNodeChild(node, child);
    }
    node->setLogOdds(tree.getClampingThresMinLog());
}

void add_block(Tree& tree, const std::array<std::int32_t, 3>& low,
               std::span<const std::uint8_t> states) {
    const bool all_free =
        std::all_of(states.begin(), states.end(), [](std::uint8_t s) { return s == empty; });
    if (all_free && tree.getRoot()) return free_block(tree, key_of(low[0], low[1], low[2]));
    for (std::int32_t n = 0; n < 512; ++n) {
        const std::uint8_t state = states[n];
        if (state != empty && state != surface) continue;
        tree.setNodeValue(
            key_of(low[0] + (n >> 6), low[1] + (n >> 3 & 7), low[2] + (n & 7)),
            state == surface ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog(), true);
    }
}

}  // namespace

void write_octomap(const std::filesystem::path& file, double voxel_m, const OctomapLeaves& leaves) {
    Tree tree(voxel_m);
    for (std::size_t n = 0; n < leaves.x.size(); ++n) {
        const std::array<std::int32_t, 3> low{leaves.x[n], leaves.y[n], leaves.z[n]};
        for (const std::int32_t v : low) {
            if (v < -octomap_middle || v > octomap_middle - 8) {
                fail(file,
                     "an OctoMap's voxels lie within " + short_number(octomap_middle * voxel_m) +
                         " m of the origin, but the scene's reach " + short_number(v * voxel_m) +
                         " m; move the scan to the origin, or use a larger voxel_m (--voxel)");
            }
        }
        add_block(tree, low, leaves.states.subspan(n * 512, 512));
    }
    if (tree.getRoot()) {
        tree.updateInnerOccupancy();
        tree.prune();
    }
    // The library's own way to write a file prints.
    std::ostringstream nodes;
    tree.writeBinaryData(nodes);
    std::array<char, 32> resolution{};
    std::to_chars(resolution.data(), resolution.data() + resolution.size() - 1, voxel_m);
    FileWriter writer(file);
    writer.write("# Octomap OcTree binary file\n# written by topple\nid OcTree\nsize ");
    writer.write(std::to_string(tree.size()));
    writer.write(std::string("\nres ").append(resolution.data()).append("\ndata\n"));
    writer.write(nodes.view());
    writer.close();
}

}  // namespace topple::io
