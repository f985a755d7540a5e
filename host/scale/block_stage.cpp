// SPDX-License-Identifier: MIT
#include "scale/block_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/field_rules.h"
#include "device/cancelling.h"
#include "points/observation.h"
#include "scale/binary_file.h"
#include "scale/work_files.h"
#include "solids/find_solids.h"

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
        if (!core.holds({all.x[n], all.y[n], all.z[n]})) continue;
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
    using namespace rules;
    io(parts.primitives, of_all([](const BlockParts::Primitive& p, const auto& must) {
           must(p.role, up_to(Role::fixture)), must(p.shell_log_odds, finite);
       }));
    const std::size_t count = parts.primitives.size();
    auto& c = parts.cells;
    for (auto* values : {&c.i, &c.j, &c.k}) io(*values, tiles::voxels);
    io(c.primitive, labels(count));
    const std::size_t cells = c.primitive.size();
    for (const auto* values : {&c.i, &c.j, &c.k}) io.expect(values->size() == cells);
    io(c.basis, length(cells), up_to(Basis{basis_count - 1}));
    io(c.unseen_below, length(cells));
    io(seams, of_all([count](const SeamRecord& seam, const auto& must) {
           must(seam.b, ids(count)), must(seam.a, ids(static_cast<std::size_t>(seam.b) + 1));
           must(seam.variation, finite);
       }));
    auto& samples = parts.samples;
    io(samples.edge_m, finite);
    io(samples.spacing_m, finite);
    io(samples.primitive, ids(count));
    const std::size_t size = samples.primitive.size();
    for (auto* values : {&samples.x, &samples.y, &samples.z, &samples.nx, &samples.ny, &samples.nz})
        io(*values, length(size), finite);
    io(samples.lab_l, length_or_none(size));
    for (auto* values : {&samples.lab_a, &samples.lab_b}) io(*values, length(samples.lab_l.size()));
    for (auto* leaves : {&parts.empty_leaves, &parts.leaves})
        io(*leaves, tiles::voxels, [](const auto& at) { return at.size() % 3 == 0; });
    io(parts.states, length(parts.leaves.size() / 3 * 512), within(0, 3));
    list_fields(io, parts.labels, [count](auto& each, auto& of_bin) {
        each(of_bin.bin);
        each(of_bin.primitive, labels(count));
        each(of_bin.cells, length(of_bin.primitive.size()));
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
    Observation input = ingest_part(device, points.cloud, layout.cell_m);
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
        return block.core.holds(layout.voxel_at(s.x[n], s.y[n], s.z[n]));
    });
    const geometry::SurfaceSamples all = numbered(geometry.samples, voxels.number);
    out.samples = geometry::samples_where(all, [&](std::size_t n) {
        const auto voxel = [&](float v) {
            return static_cast<std::int32_t>(std::floor(v / layout.voxel_m));
        };
        return all.primitive[n] >= 0 &&
               block.core.holds({voxel(all.x[n]), voxel(all.y[n]), voxel(all.z[n])});
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
        const geometry::Seam& s = parts.seams.inside[p];
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
    BlockParts out;
    std::vector<SeamRecord> seams;
    try {
        tiles::BinaryReader in(block_file(folder, block));
        block_fields(in, out, seams);
        for (std::size_t n = 1; n < out.cells.size(); ++n)
            in.expect(place_of(out.cells, n - 1) < place_of(out.cells, n));
    } catch (const Error&) {
        // What its checksum does not tell no later run would find before it is here.
        std::error_code error;
        std::filesystem::remove(block_file(folder, block), error);
        throw;
    }
    out.seams.inside.resize(out.primitives.size());
    for (const SeamRecord& s : seams) {
        const geometry::Seam seam{s.variation, s.pairs, s.flush, s.ledge};
        if (s.a == s.b) {
            out.seams.inside[s.a] = seam;
        } else {
            out.seams.between[{s.a, s.b}] = seam;
        }
    }
    return out;
}

}  // namespace topple
