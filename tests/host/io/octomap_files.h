// SPDX-License-Identifier: MIT
#pragma once

#include <octomap/OcTree.h>

#include "standard.h"

namespace topple::test {

// The voxels of an OctoMap at its finest resolution, by key.
struct OctomapVoxels {
    std::set<std::array<int, 3>> free, occupied;
};

inline OctomapVoxels voxels_of(octomap::OcTree& tree) {
    OctomapVoxels out;
    tree.expand();
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        const auto key = leaf.getKey();
        (tree.isNodeOccupied(*leaf) ? out.occupied : out.free).insert({key[0], key[1], key[2]});
    }
    return out;
}

inline OctomapVoxels voxels_of(const std::filesystem::path& file) {
    octomap::OcTree tree(0.1);
    std::ifstream stream(file, std::ios::binary);
    tree.readBinary(stream);
    return voxels_of(tree);
}

// A room of 3 x 2.5 x 2 m with a table in it, seen from inside: walls and floor occupied, what the
// rays cross free, the inside of the table and what is behind the walls unknown.
inline octomap::OcTree room_map(double resolution_m = 0.05) {
    octomap::OcTree tree(resolution_m);
    const auto n = [&](double metres) { return static_cast<int>(metres / resolution_m + 0.5); };
    const int x = n(3), y = n(2.5), z = n(2);
    for (int i = 0; i <= x; ++i) {
        for (int j = 0; j <= y; ++j) {
            for (int k = 0; k <= z; ++k) {
                const bool shell = i == 0 || i == x || j == 0 || j == y || k == 0;
                const bool above = i >= n(1) && i <= n(2) && j >= n(1) && j <= n(1.6);
                const bool table = above && k >= n(0.7) && k <= n(0.8);
                const bool inside = above && k > n(0.7) && k < n(0.8) && i > n(1) && i < n(2) &&
                                    j > n(1) && j < n(1.6);
                if (inside) continue;
                const octomap::OcTreeKey key(static_cast<octomap::key_type>(32768 - 7 + i),
                                             static_cast<octomap::key_type>(32768 + 3 + j),
                                             static_cast<octomap::key_type>(32768 - 1 + k));
                tree.setNodeValue(
                    key,
                    shell || table ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog(),
                    true);
            }
        }
    }
    // Free space that reaches far beyond: through a door.
    for (int i = x + 1; i < x + 80; ++i) {
        tree.setNodeValue(octomap::OcTreeKey(static_cast<octomap::key_type>(32768 - 7 + i),
                                             32768 + 20, 32768 + 10),
                          tree.getClampingThresMinLog(), true);
    }
    tree.updateInnerOccupancy();
    tree.prune();
    return tree;
}

// A file of a cube of 2^depth voxels a side, every other one occupied and the rest free: surface
// throughout, in a few bytes a voxel.
inline std::string chequered_map(int depth) {
    const auto add = [](auto& self, std::string& to, int left) -> void {
        if (left == 1) {
            to.append("\x66\x99");
            return;
        }
        to.append("\xff\xff");
        for (int child = 0; child < 8; ++child) self(self, to, left - 1);
    };
    std::string out = "# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0.1\ndata\n";
    for (int n = depth; n < 16; ++n) out.append("\x03").push_back('\0');
    add(add, out, depth);
    return out;
}

// Makes a cube of voxels occupied throughout, `low` being its lowest key.
inline void add_solid_cube(octomap::OcTree& tree, const octomap::OcTreeKey& low, int side) {
    for (int n = 0; n < side * side * side; ++n) {
        tree.setNodeValue(
            octomap::OcTreeKey(static_cast<octomap::key_type>(low[0] + n / side / side),
                               static_cast<octomap::key_type>(low[1] + n / side % side),
                               static_cast<octomap::key_type>(low[2] + n % side)),
            tree.getClampingThresMaxLog(), true);
    }
    tree.updateInnerOccupancy();
    tree.prune();
}

inline std::string binary_map(const octomap::OcTree& tree) {
    std::ostringstream out;
    tree.writeBinaryConst(out);
    return out.str();
}
inline std::string full_map(const octomap::OcTree& tree) {
    std::ostringstream out;
    tree.write(out);
    return out.str();
}

}  // namespace topple::test
