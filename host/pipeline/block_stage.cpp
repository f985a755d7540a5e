// SPDX-License-Identifier: MIT
#include "pipeline/block_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "pipeline/cancelling.h"
#include "pipeline/ingest.h"
#include "pipeline/solid_stage.h"
#include "tiles/binary_file.h"
#include "tiles/work_files.h"

namespace topple {
namespace {

// Fewer points show no surface: a patch of ten by ten cells.
constexpr std::size_t least_points = 100;

void add_labels(const tiles::BlockPoints& points, const std::vector<std::int32_t>& primitive,
                BlockParts& out) {
    std::size_t n = 0;
    for (const tiles::BlockPoints::Part& part : points.parts) {
        BlockParts::Labels labels;
        labels.bin = part.bin;
        for (std::size_t m = 0; m < part.cells.size(); ++m, ++n) {
            if (!part.in_core[m]) continue;
            labels.cells.push_back(part.cells[m]);
            labels.primitive.push_back(primitive[n]);
        }
        if (!labels.cells.empty()) out.labels.push_back(std::move(labels));
    }
}

void add_states(const vdb::VoxelScene& scene, const tiles::VoxelBox& core, BlockParts& out) {
    vdb::Tiles all = scene.tiles(true), inside;
    for (std::size_t n = 0; n < all.size(); ++n) {
        if (!core.holds(all.x[n], all.y[n], all.z[n])) continue;
        inside.x.push_back(all.x[n]);
        inside.y.push_back(all.y[n]);
        inside.z.push_back(all.z[n]);
    }
    const std::vector<std::uint8_t> states = scene.states(inside);
    for (std::size_t n = 0; n < inside.size(); ++n) {
        const auto first = states.begin() + static_cast<std::ptrdiff_t>(n * 512);
        const auto all_are = [&](vdb::State s) {
            return std::all_of(first, first + 512,
                               [&](std::uint8_t v) { return v == static_cast<std::uint8_t>(s); });
        };
        if (all_are(vdb::State::invisible)) continue;
        const bool empty = all_are(vdb::State::empty);
        auto& leaves = empty ? out.empty_leaves : out.leaves;
        leaves.insert(leaves.end(), {inside.x[n], inside.y[n], inside.z[n]});
        if (!empty) out.states.insert(out.states.end(), first, first + 512);
    }
}

// What seams are written as.
struct SeamRecord {
    std::int32_t a = -1, b = -1;
    double variation = 0;
    std::uint64_t pairs = 0, flush = 0, ledge = 0;
};

template <class Io, class Parts, class Seams>
void block_fields(Io& io, Parts& parts, Seams& seams) {
    io(parts.primitives);
    auto& c = parts.cells;
    for (auto* values : {&c.i, &c.j, &c.k, &c.primitive}) io(*values);
    io(c.basis);
    io(c.unseen_below);
    io(seams);
    auto& samples = parts.samples;
    io(samples.edge_m);
    io(samples.spacing_m);
    for (auto* values : geometry::columns_of(samples)) io(*values);
    io(samples.primitive);
    io(parts.empty_leaves);
    io(parts.leaves);
    io(parts.states);
    list_fields(io, parts.labels, [](auto& each, auto& labels) {
        each(labels.bin);
        each(labels.cells);
        each(labels.primitive);
    });
}

}  // namespace

BlockParts parse_block(device::Device& device, const tiles::BlockPoints& points,
                       const tiles::Layout& layout, const tiles::Block& block,
                       const ParseOptions& options) {
    BlockParts out;
    const std::vector<std::int32_t> none(points.cloud.size(), -1);
    if (points.cloud.size() < least_points) {
        add_labels(points, none, out);
        return out;
    }
    ParseOptions quiet = options;  // progress is told by the block, not by its stages
    quiet.progress = nullptr;
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, quiet);
    const Cancelling cancelling(device, quiet);
    Ingested input = ingest_part(device, points.cloud, layout.cell_m);
    input.frame = layout.frame;
    constexpr double below = -std::numeric_limits<double>::infinity();
    input.storeys = {{block.floor_m, below, block.top_m}};
    const auto [geometry, voxels] =
        find_solids(device, input, layout.voxel_m, quiet, stage, SolidDetail::whole_voxels);
    for (std::size_t p = 0; p < voxels.number.size(); ++p) {
        if (voxels.number[p] < 0) continue;
        out.primitives.push_back({geometry.primitives.model[p].front(), geometry.role[p],
                                  static_cast<float>(geometry.shell_log_odds[p])});
    }
    out.cells = voxels.solids->cells();
    const geometry::Surfels& s = geometry.surfels;
    out.seams = surface_seams(geometry, voxels.number, [&](std::size_t n) {
        const auto at = tiles::voxel_at(layout.frame, layout.voxel_m, s.x[n], s.y[n], s.z[n]);
        return block.core.holds(at[0], at[1], at[2]);
    });
    const geometry::SurfaceSamples all = numbered(geometry.samples, voxels.number);
    out.samples = geometry::samples_where(all, [&](std::size_t n) {
        const auto voxel = [&](float v) {
            return static_cast<std::int32_t>(std::floor(v / layout.voxel_m));
        };
        return all.primitive[n] >= 0 &&
               block.core.holds(voxel(all.x[n]), voxel(all.y[n]), voxel(all.z[n]));
    });
    add_states(*voxels.scene, block.core, out);
    add_labels(points, numbered(geometry.primitive_of_point, voxels.number), out);
    return out;
}

std::filesystem::path block_file(const std::filesystem::path& folder, std::size_t block) {
    return folder / (tiles::block_prefix + std::to_string(block));
}

void write_block(const std::filesystem::path& folder, std::size_t block, const BlockParts& parts) {
    std::vector<SeamRecord> seams;
    for (std::size_t p = 0; p < parts.seams.inside.size(); ++p) {
        const graph::Seam& s = parts.seams.inside[p];
        const auto id = static_cast<std::int32_t>(p);
        seams.push_back({id, id, s.variation, s.pairs, s.flush, s.ledge});
    }
    for (const auto& [pair, s] : parts.seams.between)
        seams.push_back({pair.first, pair.second, s.variation, s.pairs, s.flush, s.ledge});
    tiles::BinaryWriter out(block_file(folder, block));
    block_fields(out, parts, seams);
    out.finish();
}

BlockParts read_block(const std::filesystem::path& folder, std::size_t block) {
    tiles::BinaryReader in(block_file(folder, block));
    BlockParts out;
    std::vector<SeamRecord> seams;
    block_fields(in, out, seams);
    const auto count = static_cast<std::int32_t>(out.primitives.size());
    const SolidCells& c = out.cells;
    if (c.j.size() != c.size() || c.k.size() != c.size() || c.primitive.size() != c.size() ||
        c.basis.size() != c.size() || c.unseen_below.size() != c.size())
        in.damaged();
    const auto is_basis = [](Basis b) { return static_cast<std::uint8_t>(b) < basis_count; };
    if (!std::ranges::all_of(c.basis, is_basis)) in.damaged();
    const auto is_primitive = [&](std::int32_t p) { return p >= -1 && p < count; };
    if (!std::ranges::all_of(c.primitive, is_primitive)) in.damaged();
    out.seams.inside.resize(out.primitives.size());
    for (const SeamRecord& s : seams) {
        if (s.a < 0 || s.b < s.a || s.b >= count) in.damaged();
        const graph::Seam seam{s.variation, s.pairs, s.flush, s.ledge};
        if (s.a == s.b) {
            out.seams.inside[static_cast<std::size_t>(s.a)] = seam;
        } else {
            out.seams.between[{s.a, s.b}] = seam;
        }
    }
    const geometry::SurfaceSamples& samples = out.samples;
    for (const auto* values : geometry::columns_of(samples)) {
        if (!values->empty() && values->size() != samples.primitive.size()) in.damaged();
    }
    if (!std::ranges::all_of(samples.primitive,
                             [&](std::int32_t p) { return p >= 0 && p < count; }))
        in.damaged();
    if (out.empty_leaves.size() % 3 || out.states.size() != out.leaves.size() / 3 * 512)
        in.damaged();
    for (const BlockParts::Labels& labels : out.labels) {
        if (labels.primitive.size() != labels.cells.size() ||
            !std::ranges::all_of(labels.primitive, is_primitive))
            in.damaged();
    }
    return out;
}

}  // namespace topple
