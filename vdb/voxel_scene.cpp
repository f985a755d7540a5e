// SPDX-License-Identifier: MIT
#include "vdb/voxel_scene.h"

#include <execinfo.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "core/ranked.h"
#include "core/scene_bounds.h"
#include "core/short_number.h"
#include "core/sorted_order.h"
#include "topple/error.h"
#include "vdb/grids.h"

namespace topple::vdb {
namespace {

// The C library's unwinder, TBB and OpenVDB load or register things at their first use, and end the
// program where there is no memory for that: each is used once when the program or a host loads
// this, while there is. Where there is none even then, their next use says so.
[[maybe_unused]] const bool used_once = [] {
    void* frame = nullptr;
    ::backtrace(&frame, 1);
    try {
        tbb::parallel_for(0, 1, [](int) {});
        openvdb::initialize();
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    }
}();

constexpr std::int32_t window = 1 << 20;  // voxels from the points' median, either way

void check(const CloudView& cloud, std::span<const std::int32_t> label,
           std::span<const std::uint8_t> seen_side) {
    const auto need = [&](std::size_t count, const char* what) {
        if (count != cloud.size())
            throw Error(ErrorKind::usage, "voxel scene: " + std::to_string(count) + " " + what +
                                              " for " + std::to_string(cloud.size()) + " points");
    };
    need(label.size(), "labels");
    if (!seen_side.empty()) need(seen_side.size(), "seen sides");
}

constexpr std::size_t point_chunk = std::size_t{1} << 14;  // points handed to a thread at once

template <class Work>
void each_point(std::size_t count, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, point_chunk),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t n = range.begin(); n < range.end(); ++n) work(n);
                      });
}

// The upper median of whole numbers.
double median(const std::vector<double>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    if (!(*high - *low < window)) {
        std::vector<double> sorted = values;
        return upper_median(sorted);
    }
    std::vector<std::size_t> count(static_cast<std::size_t>(*high - *low) + 1);
    for (const double value : values) ++count[value - *low];
    std::size_t at = 0, below = 0;
    while ((below += count[at]) <= middle) ++at;
    return *low + static_cast<double>(at);
}

// The points' voxels, wherever they lie, and their median.
struct Placed {
    std::array<std::vector<double>, 3> at;
    std::array<double, 3> median{0, 0, 0};
};
Placed place(const VoxelFrame& frame, const CloudView& cloud) {
    Placed placed;
    for (auto& values : placed.at) values.resize(cloud.size());
    each_point(cloud.size(), [&](std::size_t n) {
        for (std::size_t a = 0; a < 3; ++a) {
            const Vec3& row = frame.grid_from_input[a];
            placed.at[a][n] = std::floor(
                (row[0] * cloud.x[n] + row[1] * cloud.y[n] + row[2] * cloud.z[n]) / frame.voxel_m);
        }
    });
    if (cloud.size() == 0) return placed;
    tbb::parallel_for(std::size_t{0}, std::size_t{3},
                      [&](std::size_t a) { placed.median[a] = median(placed.at[a]); });
    return placed;
}

// The leaves of the scene's bounds, with a margin of two voxels for noise.
LeafTable box_of(const VoxelFrame& frame, const std::array<std::vector<std::int32_t>, 3>& index) {
    constexpr std::int32_t margin = 2, leaf = 8;
    const Bounds<std::int32_t> bounds =
        scene_bounds<std::int32_t>({index[0], index[1], index[2]}, leaf);
    LeafTable chosen;
    for (int a = 0; a < 3; ++a) {
        chosen.low[a] = (bounds.low[a] - margin) >> 3;
        chosen.count[a] = ((bounds.high[a] + margin) >> 3) - chosen.low[a] + 1;
    }
    if (chosen.box_size() > max_leaves) {
        const double scale =
            std::cbrt(static_cast<double>(chosen.box_size()) / static_cast<double>(max_leaves));
        std::string size;
        for (int a = 0; a < 3; ++a) {
            size += (a ? " x " : "") + short_number(chosen.count[a] * 8 * frame.voxel_m);
        }
        throw Error(
            ErrorKind::input,
            "the scene's bounds, " + size + " m, hold " + std::to_string(chosen.box_size()) +
                " blocks of 8x8x8 voxels, more than the limit of " + std::to_string(max_leaves) +
                "; use voxel_m (--voxel) = " +
                short_number(std::ceil(frame.voxel_m * scale * 1100) / 1000) + " or larger");
    }
    return chosen;
}

// The points that voxel indices reach, by leaf of the table and voxel of the leaf; those of one
// voxel in their order.
struct SortedPoints {
    LeafTable leaves;
    std::vector<std::uint64_t> voxel;  // leaf * 512 + offset, ascending
    std::vector<std::size_t> point;
};

LeafTable::Leaf leaf_of(const std::array<std::vector<std::int32_t>, 3>& index, std::size_t n) {
    return {index[0][n] >> 3, index[1][n] >> 3, index[2][n] >> 3};
}

SortedPoints sort_points(const VoxelFrame& frame, const CloudView& cloud) {
    const Placed placed = place(frame, cloud);
    for (int a = 0; a < 3; ++a) {
        if (!(std::abs(placed.median[a]) < 1e9)) {
            throw Error(ErrorKind::input, "the points lie " +
                                              short_number(placed.median[a] * frame.voxel_m) +
                                              " m from the origin, too far for voxels of " +
                                              short_number(frame.voxel_m) + " m; move the cloud");
        }
    }
    std::vector<std::size_t> within;
    within.reserve(cloud.size());
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        bool all = true;
        for (int a = 0; a < 3; ++a)
            all = all && std::abs(placed.at[a][n] - placed.median[a]) < window - 16;
        if (all) within.push_back(n);
    }
    SortedPoints out;
    if (within.empty()) return out;
    if (within.size() > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorKind::input, std::to_string(within.size()) +
                                          " points: in one piece 4294967295 can be parsed");
    std::array<std::vector<std::int32_t>, 3> index;
    for (auto& axis : index) axis.resize(within.size());
    each_point(within.size(), [&](std::size_t n) {
        for (std::size_t a = 0; a < 3; ++a)
            index[a][n] = static_cast<std::int32_t>(placed.at[a][within[n]]);
    });
    out.leaves = box_of(frame, index);
    out.leaves.take_in(within.size(), [&](std::size_t n) { return leaf_of(index, n); });
    std::vector<std::uint64_t> voxel(within.size());
    each_point(within.size(), [&](std::size_t n) {
        const auto leaf = static_cast<std::uint64_t>(out.leaves.index_of(leaf_of(index, n)));
        voxel[n] =
            leaf << 9 | static_cast<std::uint64_t>((index[0][n] & 7) << 6 | (index[1][n] & 7) << 3 |
                                                   (index[2][n] & 7));
    });
    const std::vector<std::uint32_t> order = sorted_order(voxel);
    out.voxel.resize(order.size());
    out.point.resize(order.size());
    each_point(order.size(), [&](std::size_t n) {
        out.voxel[n] = voxel[order[n]];
        out.point[n] = within[order[n]];
    });
    return out;
}

// Calls enter(leaf) for each leaf of sorted points, and use(offset, points) for its voxels.
template <class Enter, class Use>
void each_voxel(const SortedPoints& points, const Enter& enter, const Use& use) {
    const std::vector<std::uint64_t>& voxel = points.voxel;
    std::uint64_t leaf = ~std::uint64_t{0};
    for (std::size_t first = 0, last = 0; first < voxel.size(); first = last) {
        while (last < voxel.size() && voxel[last] == voxel[first]) ++last;
        if (voxel[first] >> 9 != leaf) {
            leaf = voxel[first] >> 9;
            enter(leaf);
        }
        use(static_cast<openvdb::Index>(voxel[first] & 511),
            std::span(points.point).subspan(first, last - first));
    }
}

void mark_surface(const SortedPoints& points, VoxelScene::Grids& g) {
    g.leaves = points.leaves;
    StateLeaf* state = nullptr;
    openvdb::MaskTree::LeafNodeType* mask = nullptr;
    each_voxel(
        points,
        [&](std::uint64_t leaf) {
            const openvdb::Coord origin = origin_of(g.leaves.leaf_at(leaf));
            state = g.state->tree().touchLeaf(origin);
            mask = g.points.touchLeaf(origin);
        },
        [&](openvdb::Index offset, std::span<const std::size_t>) {
            state->setValueOn(offset, static_cast<std::int32_t>(State::surface));
            mask->setValueOn(offset);
        });
}

// The most frequent of some labels, the lowest of equals; -1 counts only by itself. Sorts them.
std::int32_t majority(std::vector<std::int32_t>& labels) {
    std::sort(labels.begin(), labels.end());
    std::int32_t best = -1;
    std::size_t best_count = 0;
    for (std::size_t first = 0; first < labels.size();) {
        std::size_t end = first;
        while (end < labels.size() && labels[end] == labels[first]) ++end;
        if (labels[first] >= 0 && end - first > best_count) {
            best = labels[first];
            best_count = end - first;
        }
        first = end;
    }
    return best;
}

// Of a voxel's points a quarter suffice. A wall that was seen from both sides has none.
std::uint8_t side_of(std::span<const std::size_t> points, std::span<const std::uint8_t> seen_side) {
    std::uint8_t side = 0;
    for (unsigned way = 0; way < 6; ++way) {
        std::size_t count = 0;
        for (const std::size_t point : points) count += seen_side[point] >> way & 1;
        if (4 * count >= points.size() && count > 0) side |= static_cast<std::uint8_t>(1u << way);
    }
    constexpr unsigned low_ways = 0b010101;
    const unsigned both = side & (side >> 1) & low_ways;
    return static_cast<std::uint8_t>(side & ~(both | both << 1));
}

void mark_points(const SortedPoints& points, std::span<const std::int32_t> label,
                 std::span<const std::uint8_t> seen_side, VoxelScene::Grids& g) {
    StateLeaf* primitive = nullptr;
    std::uint64_t leaf_index = 0;
    bool stray = false;
    std::vector<std::int32_t> labels;  // of one voxel's points
    g.sided.clear();
    g.seen_side.clear();
    each_voxel(
        points,
        [&](std::uint64_t leaf) {
            leaf_index = leaf;
            stray = leaf >= points.leaves.box_size();
            primitive = g.primitive->tree().touchLeaf(origin_of(points.leaves.leaf_at(leaf)));
        },
        [&](openvdb::Index offset, std::span<const std::size_t> of_voxel) {
            labels.clear();
            for (const std::size_t point : of_voxel) labels.push_back(std::max(label[point], -1));
            primitive->setValueOn(offset, stray ? -1 : majority(labels));
            if (stray || seen_side.empty()) return;
            if (const std::uint8_t side = side_of(of_voxel, seen_side)) {
                g.sided.push_back(leaf_index << 9 | offset);
                g.seen_side.push_back(side);
            }
        });
}

}  // namespace

void check(const VoxelFrame& frame) {
    if (!(frame.voxel_m > 0) || !std::isfinite(frame.voxel_m)) {
        throw Error(ErrorKind::usage,
                    "voxel size " + short_number(frame.voxel_m) + " m: it must be positive");
    }
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
            double dot = 0;
            for (int d = 0; d < 3; ++d)
                dot += frame.grid_from_input[a][d] * frame.grid_from_input[b][d];
            if (!(std::abs(dot - (a == b)) < 1e-6)) {
                throw Error(ErrorKind::usage, "voxel frame: its rows are not orthonormal");
            }
        }
    }
}

VoxelScene::VoxelScene(const VoxelFrame& frame) : grids_(std::make_unique<Grids>()) {
    openvdb::initialize();
    grids_->frame = frame;
    grids_->state = openvdb::Int32Grid::create(static_cast<std::int32_t>(State::invisible));
    grids_->primitive = openvdb::Int32Grid::create(-1);
}

VoxelScene::VoxelScene(const VoxelFrame& frame, const CloudView& cloud) : VoxelScene(frame) {
    check(frame);
    mark_surface(sort_points(frame, cloud), *grids_);
}

VoxelScene::VoxelScene(const VoxelFrame& frame, const CloudView& cloud,
                       std::span<const std::int32_t> label, std::span<const std::uint8_t> seen_side)
    : VoxelScene(frame) {
    check(frame);
    check(cloud, label, seen_side);
    const SortedPoints points = sort_points(frame, cloud);
    mark_surface(points, *grids_);
    mark_points(points, label, seen_side, *grids_);
}

void VoxelScene::set_labels(const CloudView& cloud, std::span<const std::int32_t> label,
                            std::span<const std::uint8_t> seen_side) {
    check(cloud, label, seen_side);
    mark_points(sort_points(grids_->frame, cloud), label, seen_side, *grids_);
}

VoxelScene::~VoxelScene() = default;
VoxelScene::VoxelScene(VoxelScene&&) noexcept = default;

const VoxelFrame& VoxelScene::frame() const {
    return grids_->frame;
}
void VoxelScene::set_origin(const Vec3& origin_m) {
    grids_->frame.origin_m = origin_m;
}
bool VoxelScene::in_bounds(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return grids_->leaves.in_box({i >> 3, j >> 3, k >> 3});
}

void VoxelScene::set_objects(std::span<const std::int32_t> object_of_primitive) {
    grids_->object_of_primitive.assign(object_of_primitive.begin(), object_of_primitive.end());
}

void VoxelScene::clear_completed() {
    constexpr auto completed = static_cast<std::int32_t>(State::completed);
    for (auto leaf = grids_->state->tree().beginLeaf(); leaf; ++leaf) {
        for (auto voxel = leaf->beginValueOn(); voxel; ++voxel) {
            if (*voxel != completed) continue;
            grids_->primitive->tree().setValueOff(voxel.getCoord(), -1);
            leaf->setValueOff(voxel.pos(), static_cast<std::int32_t>(State::invisible));
        }
    }
}

void VoxelScene::relabel(std::span<const std::int32_t> number) {
    for (auto leaf = grids_->primitive->tree().beginLeaf(); leaf; ++leaf) {
        for (auto voxel = leaf->beginValueOn(); voxel; ++voxel) {
            if (*voxel < 0) continue;
            if (static_cast<std::size_t>(*voxel) >= number.size()) {
                throw Error(ErrorKind::usage, "relabel: primitive " + std::to_string(*voxel) +
                                                  " is not among the " +
                                                  std::to_string(number.size()) + " given");
            }
            voxel.setValue(number[*voxel]);
        }
    }
}

void VoxelScene::set_empty(std::span<const Voxel> voxels) {
    auto state = grids_->state->getAccessor();
    auto primitive = grids_->primitive->getAccessor();
    for (const Voxel& at : voxels) {
        state.setValueOff(coord(at), static_cast<std::int32_t>(State::empty));
        primitive.setValueOff(coord(at), -1);
    }
}

void VoxelScene::Grids::take_in(std::span<const LeafTable::Leaf> changed) {
    leaves.take_in(changed.size(), [&](std::size_t n) { return changed[n]; });
    evidence = {};  // by the table's leaves
}

}  // namespace topple::vdb
