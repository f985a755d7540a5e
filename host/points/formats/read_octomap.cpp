// SPDX-License-Identifier: MIT
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "points/formats/octomap.h"
#include "points/formats/octomap_file.h"

namespace topple::io {
namespace {

constexpr std::uint64_t leaves_between_polls = 4096;

using Tree = octomap::OcTree;
using Voxel = std::array<std::int32_t, 3>;

std::int32_t side_of(const Tree::leaf_iterator& leaf) {
    return 1 << (octomap_depth - static_cast<int>(leaf.getDepth()));
}

Voxel lowest_voxel(const Tree::leaf_iterator& leaf, std::int32_t side) {
    Voxel v{};
    for (unsigned a = 0; a < 3; ++a) v[a] = (leaf.getKey()[a] & ~(side - 1)) - octomap_middle;
    return v;
}

enum class Known : std::uint8_t { unknown, free, occupied };

Known known(const Tree& tree, const Voxel& v) {
    octomap::OcTreeKey key;
    for (unsigned a = 0; a < 3; ++a) {
        const std::int32_t k = v[a] + octomap_middle;
        if (k < 0 || k >= 2 * octomap_middle) return Known::unknown;
        key[a] = static_cast<octomap::key_type>(k);
    }
    const octomap::OcTreeNode* node = tree.search(key);
    if (!node) return Known::unknown;
    return tree.isNodeOccupied(node) ? Known::occupied : Known::free;
}

// Sum of the directions to the free ones of the 26 voxels around; 0 where none is.
std::array<double, 3> towards_free(const Tree& tree, const Voxel& v) {
    std::array<double, 3> sum{};
    for (int n = 0; n < 27; ++n) {
        const std::array<int, 3> step{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
        if (n == 13 || known(tree, {v[0] + step[0], v[1] + step[1], v[2] + step[2]}) != Known::free)
            continue;
        const double length = std::hypot(step[0], step[1], step[2]);
        for (std::size_t a = 0; a < 3; ++a) sum[a] += step[a] / length;
    }
    return sum;
}

// Occupied leaves: what of them is surface becomes points, the rest is solid.
class Occupied {
  public:
    Occupied(const Tree& tree, CloudBuilder& cloud, SpaceMap& space)
        : tree_(tree), cloud_(cloud), space_(space) {}

    // The inside of a leaf has nothing but the leaf around.
    static std::uint64_t border_voxels(std::uint64_t side) {
        const std::uint64_t within = side > 2 ? side - 2 : 0;
        return side * side * side - within * within * within;
    }

    void add(const Voxel& low, std::int32_t side) {
        const Voxel high{low[0] + side - 1, low[1] + side - 1, low[2] + side - 1};
        if (side > 2) {
            space_.solid.push_back(
                {{low[0] + 1, low[1] + 1, low[2] + 1}, {high[0] - 1, high[1] - 1, high[2] - 1}});
        }
        for (std::int32_t x = low[0]; x <= high[0]; ++x) {
            for (std::int32_t y = low[1]; y <= high[1]; ++y) {
                const bool column = x == low[0] || x == high[0] || y == low[1] || y == high[1];
                const std::int32_t step = column ? 1 : std::max(1, side - 1);
                for (std::int32_t z = low[2]; z <= high[2]; z += step)
                    add_voxel({x, y, z}, low, high);
            }
        }
    }

  private:
    void add_voxel(const Voxel& v, const Voxel& low, const Voxel& high) {
        if (!at_surface(v, low, high)) return add_solid(v);
        FilePoint point{.normal = towards_free(tree_, v)};
        for (std::size_t a = 0; a < 3; ++a) point.at[a] = (v[a] + 0.5) * space_.voxel_m;
        cloud_.add(point);
    }
    bool at_surface(const Voxel& v, const Voxel& low, const Voxel& high) const {
        for (std::size_t a = 0; a < 3; ++a) {
            for (const std::int32_t step : {-1, 1}) {
                Voxel next = v;
                next[a] += step;
                const bool in_leaf = next[a] >= low[a] && next[a] <= high[a];
                if (!in_leaf && known(tree_, next) != Known::occupied) return true;
            }
        }
        return false;
    }
    void add_solid(const Voxel& v) {
        if (!space_.solid.empty()) {
            SpaceMap::Box& last = space_.solid.back();
            if (last.low[0] == v[0] && last.high[0] == v[0] && last.low[1] == v[1] &&
                last.high[1] == v[1] && last.high[2] == v[2] - 1) {
                last.high[2] = v[2];
                return;
            }
        }
        space_.solid.push_back({v, v});
    }

    const Tree& tree_;
    CloudBuilder& cloud_;
    SpaceMap& space_;
};

Tree read_tree(const std::filesystem::path& file, const OctomapFile& stored) {
    Tree tree(stored.resolution_m);
    std::istringstream stream{std::string(stored.tree)};
    stream.imbue(std::locale::classic());
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

ScannedMap read_octomap(const std::filesystem::path& file, double unit_m,
                        const std::function<void()>& poll, std::uint64_t most_occupied) {
    const auto bytes = read_file(file);
    const OctomapFile stored = open_octomap(file, bytes.text());
    poll();
    const Tree tree = read_tree(file, stored);
    std::uint64_t leaves = 0;
    const auto poll_at_times = [&] {
        if (leaves++ % leaves_between_polls == 0) poll();
    };
    ScannedMap map;
    map.space.voxel_m = stored.resolution_m * unit_m;
    std::uint64_t occupied = 0, border = 0;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        poll_at_times();
        const std::int32_t side = side_of(leaf);
        if (tree.isNodeOccupied(*leaf)) {
            const auto edge = static_cast<std::uint64_t>(side);
            occupied += saturating_multiply(edge * edge, edge);
            if (occupied > most_occupied) {
                fail(file, "has more than " + std::to_string(most_occupied) +
                               " occupied voxels at its finest resolution; thin the map");
            }
            border += Occupied::border_voxels(edge);
        } else {
            const Voxel low = lowest_voxel(leaf, side);
            map.space.free.push_back(
                {low, {low[0] + side - 1, low[1] + side - 1, low[2] + side - 1}});
        }
    }
    if (occupied == 0) fail(file, "has no occupied leaf: there is nothing to parse");
    CloudBuilder cloud(file, border, {.normals = true});
    Occupied parts(tree, cloud, map.space);
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        poll_at_times();
        const std::int32_t side = side_of(leaf);
        if (tree.isNodeOccupied(*leaf)) parts.add(lowest_voxel(leaf, side), side);
    }
    map.cloud = cloud.finish();
    return map;
}

}  // namespace topple::io
