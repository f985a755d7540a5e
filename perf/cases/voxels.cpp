// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>

#include "carve.hpp"
#include "carve_leaves.hpp"
#include "cell_share.hpp"
#include "core/boundary_cells.h"
#include "lab/random.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "perf/cases/cases.h"
#include "segmented_sum.hpp"
#include "six_fill_sweep.hpp"
#include "six_fill_vote.hpp"
#include "vdb/depth_pyramid.h"

namespace topple::perf {
namespace {

using Words = std::vector<std::uint32_t>;
using Ints = std::vector<std::int32_t>;

// 32 frames of a furnished room, and all leaves of its box at 2 cm.
struct RoomLeaves {
    Ints x, y, z;
    std::vector<float> camera;
    Words points;  // 1 where the leaf holds points
    Words pyramid;
    kernels::CarveParams params{};
};

RoomLeaves room_leaves() {
    const scenes::World world = scenes::furnished_room({.seed = 1});
    scenes::CameraOptions options;
    options.frames = 32;
    const scenes::Sequence sequence = scenes::walk(world, options);
    RoomLeaves out;
    const vdb::VoxelFrame grid{0.02, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    std::array<std::int32_t, 3> leaves{};
    for (std::size_t k = 0; k < 3; ++k)
        leaves[k] = static_cast<std::int32_t>(world.room[k] / (8 * grid.voxel_m)) + 1;
    for (std::int32_t a = 0; a < leaves[0]; ++a) {
        for (std::int32_t b = 0; b < leaves[1]; ++b) {
            for (std::int32_t c = 0; c < leaves[2]; ++c) {
                out.x.push_back(8 * a);
                out.y.push_back(8 * b);
                out.z.push_back(8 * c);
            }
        }
    }
    out.points.resize(out.x.size());
    for (std::size_t n = 0; n < sequence.cloud.size(); ++n) {
        const double at[3] = {sequence.cloud.x[n], sequence.cloud.y[n], sequence.cloud.z[n]};
        std::int64_t leaf[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto index = static_cast<std::int64_t>(std::floor(at[k] / (8 * grid.voxel_m)));
            leaf[k] = std::clamp<std::int64_t>(index, 0, leaves[k] - 1);
        }
        out.points[(leaf[0] * leaves[1] + leaf[1]) * leaves[2] + leaf[2]] = 1;
    }
    const std::uint64_t words = vdb::pyramid_words(options.intrinsics);
    out.pyramid.resize(words * sequence.frames.size());
    for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
        vdb::build_pyramid(options.intrinsics, sequence.frames[n].depth,
                           {out.pyramid.data() + n * words, words});
        const auto rows = vdb::camera_rows(grid, {0, 0, 0}, options.intrinsics,
                                           sequence.frames[n].camera_to_world);
        out.camera.insert(out.camera.end(), rows.begin(), rows.end());
    }
    out.params = {.leaf_count = static_cast<std::uint32_t>(out.x.size()),
                  .frame_count = static_cast<std::uint32_t>(sequence.frames.size()),
                  .width = options.intrinsics.width - 1,
                  .height = options.intrinsics.height - 1,
                  .frame_words = static_cast<std::uint32_t>(words),
                  .near_m = 0.02f,
                  .metres_per_unit = 0.001f,
                  .margin_m = static_cast<float>(grid.voxel_m * std::sqrt(3.0) / 2),
                  .noise_base_m = 0.003f,
                  .noise_growth = 0.005f,
                  .noise_from_m = 0.4f,
                  .slack_m = 0.0004f};
    return out;
}

struct LeafBuffers {
    device::Buffer<std::int32_t> x, y, z;
    device::Buffer<std::uint32_t> points;
    device::Buffer<float> camera;
    device::Buffer<std::uint32_t> pyramid, mixed, front;
    kernels::CarveParams params{};
};

std::shared_ptr<LeafBuffers> leaf_buffers(device::Device& device, const RoomLeaves& room) {
    return std::make_shared<LeafBuffers>(LeafBuffers{upload(device, room.x, "leaf_x"),
                                                     upload(device, room.y, "leaf_y"),
                                                     upload(device, room.z, "leaf_z"),
                                                     upload(device, room.points, "points"),
                                                     upload(device, room.camera, "camera"),
                                                     upload(device, room.pyramid, "pyramid"),
                                                     {device, room.x.size(), "mixed"},
                                                     {device, room.x.size(), "front"},
                                                     room.params});
}

void enqueue_leaves(device::Queue& queue, const LeafBuffers& on) {
    queue.add<kernels::CarveLeaves>(on.params.leaf_count,
                                    {.leaf_x = on.x,
                                     .leaf_y = on.y,
                                     .leaf_z = on.z,
                                     .points = on.points,
                                     .camera = on.camera,
                                     .pyramid = on.pyramid,
                                     .mixed = on.mixed,
                                     .front = on.front},
                                    on.params);
}

}  // namespace

Prepared carve_leaves(device::Device& device) {
    const RoomLeaves room = room_leaves();
    auto on = leaf_buffers(device, room);
    // Eight corners of 40 operations, two of them divisions, and 40 more for each leaf and frame.
    const double asked = static_cast<double>(room.params.leaf_count) * room.params.frame_count;
    return {{asked, "leaf frames",
             4.0 * (static_cast<double>(room.pyramid.size()) + 6.0 * room.params.leaf_count),
             360 * asked, 16 * asked},
            [on](device::Queue& queue) { enqueue_leaves(queue, *on); },
            {},
            [on] { return Hash().add(on->mixed.download()).add(on->front.download()).value(); }};
}

// The first 8,192 leaves that carve_leaves calls mixed, as it hands them on.
Prepared carve(device::Device& device) {
    RoomLeaves room = room_leaves();
    Words mixed;
    {
        auto on = leaf_buffers(device, room);
        device::Queue queue(device);
        enqueue_leaves(queue, *on);
        queue.run();
        const Words all = on->mixed.download();
        RoomLeaves kept = room;
        kept.x.clear();
        kept.y.clear();
        kept.z.clear();
        kept.points.clear();
        for (std::size_t n = 0; n < all.size() && mixed.size() < 8192; ++n) {
            if (all[n] == 0) continue;
            kept.x.push_back(room.x[n]);
            kept.y.push_back(room.y[n]);
            kept.z.push_back(room.z[n]);
            kept.points.push_back(room.points[n]);
            mixed.push_back(all[n]);
        }
        room = std::move(kept);
        room.params.leaf_count = static_cast<std::uint32_t>(mixed.size());
    }
    struct Buffers {
        std::shared_ptr<LeafBuffers> leaves;
        device::Buffer<std::uint32_t> evidence;
    };
    auto on = std::make_shared<Buffers>(
        Buffers{leaf_buffers(device, room), {device, 512 * mixed.size(), "evidence"}});
    on->leaves->mixed.upload(std::span<const std::uint32_t>(mixed));
    double asked = 0;
    for (const std::uint32_t bits : mixed) asked += 512.0 * std::popcount(bits);
    const double voxels = 512.0 * static_cast<double>(mixed.size());
    // 35 operations where a frame is asked about a voxel, two of them divisions, and a word of the
    // frame; 3 where it isn't.
    return {{asked, "voxel frames", 8 * voxels + 4.0 * static_cast<double>(room.pyramid.size()),
             35 * asked + 3 * (32 * voxels - asked), 2 * asked, asked},
            [on](device::Queue& queue) {
                const LeafBuffers& l = *on->leaves;
                queue.add<kernels::Carve>(std::uint64_t{512} * l.params.leaf_count,
                                          {.leaf_x = l.x,
                                           .leaf_y = l.y,
                                           .leaf_z = l.z,
                                           .mixed = l.mixed,
                                           .camera = l.camera,
                                           .pyramid = l.pyramid,
                                           .evidence = on->evidence},
                                          l.params);
            },
            [on] { on->evidence.fill(0); },
            [on] { return Hash().add(on->evidence.download()).value(); }};
}

// A dense block of 24 x 24 x 16 leaves, swept along all three axes: 4.7 million voxels.
Prepared six_fill_sweep(device::Device& device) {
    constexpr std::array<std::uint32_t, 3> size{24, 24, 16};
    constexpr std::uint32_t leaves = size[0] * size[1] * size[2];
    scenes::Random random(6);
    Words cells(std::size_t{512} * leaves);
    for (std::uint32_t& cell : cells) {
        const int kind = random.integer(0, 29);
        const auto label = static_cast<std::uint32_t>(random.integer(4, 63));
        cell = kind == 0   ? 0u
               : kind == 1 ? label | static_cast<std::uint32_t>(random.integer(0, 63)) << 16
                           : 1u;
    }
    struct Axis {
        device::Buffer<std::uint32_t> first, length, leaf, ends;
        std::uint32_t runs;
    };
    struct Buffers {
        device::Buffer<std::uint32_t> cells;
        std::vector<Axis> axes;
        device::Buffer<std::uint32_t> entries;
    };
    auto on = std::make_shared<Buffers>();
    on->cells = upload(device, cells, "cells");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Words first, length, order;
        const std::size_t p = axis == 0 ? 1 : 0, q = axis == 2 ? 1 : 2;
        for (std::uint32_t a = 0; a < size[p]; ++a) {
            for (std::uint32_t b = 0; b < size[q]; ++b) {
                first.push_back(static_cast<std::uint32_t>(order.size()));
                length.push_back(size[axis]);
                for (std::uint32_t n = 0; n < size[axis]; ++n) {
                    std::array<std::uint32_t, 3> at{};
                    at[axis] = n, at[p] = a, at[q] = b;
                    order.push_back((at[0] * size[1] + at[1]) * size[2] + at[2]);
                }
            }
        }
        on->axes.push_back({upload(device, first, "first"), upload(device, length, "length"),
                            upload(device, order, "leaf"),
                            upload(device, Words(first.size(), 3), "ends"),
                            static_cast<std::uint32_t>(first.size())});
    }
    on->entries = {device, std::size_t{6} * 64 * leaves, "entries"};
    const double voxels = 3.0 * static_cast<double>(cells.size());
    return {{voxels, "voxels", 5 * voxels, 2 * 5 * voxels},
            [on](device::Queue& queue) {
                for (std::uint32_t a = 0; a < 3; ++a) {
                    const Axis& axis = on->axes[a];
                    queue.add<kernels::SixFillSweep>(std::uint64_t{64} * axis.runs,
                                                     {.run_first = axis.first,
                                                      .run_length = axis.length,
                                                      .run_leaf = axis.leaf,
                                                      .run_ends = axis.ends,
                                                      .cells = on->cells,
                                                      .entries = on->entries},
                                                     {.run_count = axis.runs, .direction = 2 * a});
                }
            },
            {},
            [on] { return Hash().add(on->entries.download()).value(); }};
}

Prepared six_fill_vote(device::Device& device) {
    constexpr std::uint32_t leaves = 1u << 13, count = 512 * leaves;
    scenes::Random random(7);
    struct Buffers {
        device::Buffer<std::uint32_t> cells, entries, filled;
    };
    auto on = std::make_shared<Buffers>();
    const auto any = [&] {
        const auto cell = static_cast<std::uint32_t>(random.integer(2, 11));
        return random.chance(0.3) ? 0u
               : cell < 4u        ? cell
                                  : cell | static_cast<std::uint32_t>(random.integer(0, 63)) << 16;
    };
    Words words(count);
    for (std::uint32_t& w : words) w = random.chance(0.9) ? 1u : any();
    on->cells = upload(device, words, "cells");
    words.resize(std::size_t{6 * 64} * leaves);
    for (std::uint32_t& w : words)
        w = (any() & 131071u) | static_cast<std::uint32_t>(random.integer(0, 300)) << 17;
    on->entries = upload(device, words, "entries");
    on->filled = {device, count, "filled"};
    return {{count, "voxels", 11.0 * count, 6 * 40.0 * count},
            [on](device::Queue& queue) {
                queue.add<kernels::SixFillVote>(
                    count, {.cells = on->cells, .entries = on->entries, .filled = on->filled},
                    {.count = count, .votes = 2, .columns = 1});
            },
            {},
            [on] { return Hash().add(on->filled.download()).value(); }};
}

// The skin of boxes: seven in eight voxels have one patch, the others two that meet at an edge.
Prepared cell_share(device::Device& device) {
    constexpr std::uint32_t count = 1u << 19, patches = 6 * 1024;
    constexpr std::size_t numbers = 13;  // of a patch
    const double voxel_m = 0.02;
    scenes::Random random(9);
    std::vector<float> surface;
    for (std::uint32_t n = 0; n < patches * numbers; ++n) {
        const std::size_t at = n % numbers;
        const double v = at < 3 ? random(-5, 5) : at < 7 ? random(-1, 1) : 0;
        surface.push_back(static_cast<float>(v));
    }
    Ints c[3];
    Words slot(BoundaryCells::slots * std::size_t{count}), form;
    for (std::uint32_t n = 0; n < count; ++n) {
        // Cells of a patch lie together.
        const std::uint32_t patch = n / (count / patches) % patches;
        const float* origin = &surface[patch * numbers];
        for (std::size_t a = 0; a < 3; ++a)
            c[a].push_back(static_cast<std::int32_t>(std::floor(double{origin[a]} / voxel_m)) +
                           static_cast<std::int32_t>(n % 7) - 3);
        const std::size_t used = n % 8 == 0 ? 2 : 1;
        slot[n] = patch;
        slot[count + n] = patch ^ 1U;
        form.push_back(make_form(false, {SlotUse{.last = true}, SlotUse{.last = true}}, used));
    }
    struct Buffers {
        device::Buffer<std::int32_t> i, j, k;
        device::Buffer<std::uint32_t> slot, form;
        device::Buffer<float> surface;
        device::Buffer<std::uint32_t> share;
        device::Buffer<std::int32_t> moment;
    };
    auto on = std::make_shared<Buffers>(Buffers{upload(device, c[0], "i"),
                                                upload(device, c[1], "j"),
                                                upload(device, c[2], "k"),
                                                upload(device, slot, "slot"),
                                                upload(device, form, "form"),
                                                upload(device, surface, "surface"),
                                                {device, count, "share"},
                                                {device, 3 * count, "moment"}});
    // Of a slot 64 samples of 21 operations, a division, a root, and its patch's numbers; of a
    // voxel 64 of 11.
    const double slots = 1.125 * count, operations = 64 * 21 * slots + 64.0 * 11 * count;
    return {{count, "voxels", 4 * ((5 + 4.0) * count + 4 * slots), operations, 2 * slots,
             numbers * slots},
            [on, voxel_m](device::Queue& queue) {
                queue.add<kernels::CellShare>(
                    count,
                    {.ci = on->i,
                     .cj = on->j,
                     .ck = on->k,
                     .slot = on->slot,
                     .form = on->form,
                     .surface = on->surface,
                     .share = on->share,
                     .moment = on->moment},
                    {.cell_count = count, .voxel_m = static_cast<float>(voxel_m)});
            },
            {},
            [on] { return Hash().add(on->share.download()).add(on->moment.download()).value(); }};
}

// Four million cells whose labels lie scattered, in segments of 2,048.
Prepared segmented_sum(device::Device& device) {
    constexpr std::uint32_t count = 1u << 22, segment = 2048;
    scenes::Random random(8);
    Ints c[3];
    for (Ints& axis : c) {
        for (std::uint32_t n = 0; n < count; ++n) axis.push_back(random.integer(-500, 500));
    }
    // Each segment's cells rise through the scene in steps, as a label's do.
    Words order, first;
    constexpr std::uint32_t labels = count / segment;
    for (std::uint32_t s = 0; s < labels; ++s) {
        first.push_back(static_cast<std::uint32_t>(order.size()));
        for (std::uint32_t n = 0; n < segment; ++n)
            order.push_back((n / 16 * labels + s) * 16 + n % 16);
    }
    first.push_back(count);
    struct Buffers {
        device::Buffer<std::int32_t> ci, cj, ck;
        device::Buffer<std::uint32_t> order, first, sum;
    };
    auto on = std::make_shared<Buffers>(Buffers{upload(device, c[0], "ci"),
                                                upload(device, c[1], "cj"),
                                                upload(device, c[2], "ck"),
                                                upload(device, order, "order"),
                                                upload(device, first, "first"),
                                                {device, 3 * labels, "sum"}});
    return {{count, "cells", 16.0 * count, 6.0 * count, 0, 3.0 * count},
            [on](device::Queue& queue) {
                queue.add<kernels::SegmentedSum>(
                    labels,
                    {.ci = on->ci,
                     .cj = on->cj,
                     .ck = on->ck,
                     .order = on->order,
                     .first = on->first,
                     .sum = on->sum},
                    {.origin_i = -500, .origin_j = -500, .origin_k = -500});
            },
            {},
            [on] { return Hash().add(on->sum.download()).value(); }};
}

}  // namespace topple::perf
