// SPDX-License-Identifier: MIT
#include "scale/tiled_result.h"

#include <algorithm>
#include <map>
#include <span>

#include "core/colour_space.h"
#include "core/field_rules.h"
#include "io/text.h"
#include "points/formats/read_cloud.h"
#include "result/write_ply.h"
#include "scale/block_stage.h"

namespace topple {

TiledResult::TiledResult(std::unique_ptr<tiles::WorkFolder> work, std::filesystem::path input,
                         double unit_m, std::vector<tiles::Bin> bins, tiles::Layout layout,
                         BlockNumbers number)
    : work_(std::move(work)),
      input_(std::move(input)),
      unit_m_(unit_m),
      bins_(std::move(bins)),
      layout_(std::move(layout)),
      number_(std::move(number)) {
    for (const tiles::Bin& bin : bins_)
        label_.emplace_back(tiles::read_thinned(work_->path(), bin).size(), -1);
    for (std::size_t b = 0; b < layout_.blocks.size(); ++b) {
        for (const BlockParts::Labels& labels : read_block(work_->path(), b).labels) {
            if (labels.bin >= label_.size()) tiles::damaged_file(block_file(work_->path(), b));
            std::vector<std::int32_t>& of_bin = label_[labels.bin];
            if (!rules::ids(of_bin.size())(labels.cells))
                tiles::damaged_file(block_file(work_->path(), b));
            for (std::size_t n = 0; n < labels.cells.size(); ++n) {
                const std::int32_t p = labels.primitive[n];
                of_bin[labels.cells[n]] = p < 0 ? -1 : number_[b][p];
            }
        }
    }
}

void TiledResult::take_away(const TakenAway& taken) {
    for (auto& of_bin : label_)
        for (std::int32_t& p : of_bin)
            if (p >= 0) p = taken.number[p];
    for (const TakenAway::Voxel& v : taken.changed)
        if (v.primitive < 0) empty_.push_back(v.at);
}

std::vector<std::uint64_t> TiledResult::count_points(std::size_t primitives) const {
    std::vector<std::uint64_t> out(primitives, 0);
    for (std::size_t b = 0; b < bins_.size(); ++b) {
        const tiles::ThinnedBin bin = tiles::read_thinned(work_->path(), bins_[b]);
        for (std::size_t n = 0; n < bin.size(); ++n) {
            if (label_[b][n] >= 0) out[label_[b][n]] += bin.points[n];
        }
    }
    return out;
}

ScenePoints TiledResult::sample(std::size_t most) const {
    std::size_t all = 0;
    for (const auto& of_bin : label_) all += of_bin.size();
    const std::size_t step = std::max<std::size_t>(1, (all + most - 1) / most);
    ScenePoints out;
    std::size_t at = 0;
    for (std::size_t b = 0; b < bins_.size(); ++b) {
        const tiles::ThinnedBin bin = tiles::read_thinned(work_->path(), bins_[b]);
        for (std::size_t n = 0; n < bin.size(); ++n) {
            if (at++ % step) continue;
            tiles::add_cell(bin, n, out);
            out.primitive.push_back(label_[b][n]);
            out.object.push_back(object_of(label_[b][n]));
        }
    }
    return out;
}

void TiledResult::write_points(const std::filesystem::path& file,
                               const std::function<void()>& poll) const {
    const tiles::SpilledPoints points(work_->path());
    const bool coloured = points.coloured();
    io::PointsPlyWriter writer(file, points.points(), coloured);
    struct Open {
        tiles::CellsOfPoints cells;
        const std::vector<std::int32_t>& label;
    };
    std::map<tiles::Bin, Open> open;
    const auto changed = [&] { io::fail(input_, "changed while it was parsed"); };
    const auto opened = [&](const tiles::Bin& bin) {
        const auto at = open.find(bin);
        if (at != open.end()) return at;
        const auto place = std::ranges::lower_bound(bins_, bin);
        if (place == bins_.end() || *place != bin) changed();
        return open
            .emplace(bin, Open{{work_->path(), bin, layout_.cell_m}, label_[place - bins_.begin()]})
            .first;
    };
    auto last = open.end();  // most points lie where the one before them does
    io::stream_cloud(input_, unit_m_, [&](const PointCloud& portion) {
        poll();
        for (std::size_t n = 0; n < portion.size(); ++n) {
            const tiles::Bin bin = tiles::bin_of(portion.x[n], portion.y[n], portion.z[n]);
            if (last == open.end() || last->first != bin) last = opened(bin);
            const auto cell = last->second.cells.find({portion.x[n], portion.y[n], portion.z[n]});
            if (!cell) changed();
            const std::int32_t primitive = last->second.label.at(*cell);
            const Rgb8 own = coloured
                                 ? Rgb8{portion.red.at(n), portion.green.at(n), portion.blue.at(n)}
                                 : Rgb8{};
            writer.add({portion.x[n], portion.y[n], portion.z[n]}, primitive, object_of(primitive),
                       own);
        }
    });
    writer.close();
}

vdb::VoxelScene TiledResult::load_voxels() const {
    vdb::VoxelScene scene(vdb::VoxelFrame{layout_.voxel_m, layout_.frame.axes});
    for (std::size_t b = 0; b < layout_.blocks.size(); ++b) {
        const BlockParts block = read_block(work_->path(), b);
        const std::vector<std::uint8_t> empty(512, static_cast<std::uint8_t>(vdb::State::empty));
        const auto lowest = [](const std::vector<std::int32_t>& leaves, std::size_t n) {
            return std::array<std::int32_t, 3>{leaves[3 * n], leaves[3 * n + 1], leaves[3 * n + 2]};
        };
        for (std::size_t n = 0; n < block.empty_leaves.size() / 3; ++n)
            scene.put_leaf(lowest(block.empty_leaves, n), empty);
        for (std::size_t n = 0; n < block.leaves.size() / 3; ++n)
            scene.put_leaf(lowest(block.leaves, n), std::span(block.states).subspan(n * 512, 512));
    }
    scene.set_empty(empty_);
    const SolidCells& cells = solids_->cells();
    for (std::size_t n = 0; n < cells.size(); ++n)
        scene.put_label(cells.i[n], cells.j[n], cells.k[n], cells.primitive[n]);
    scene.set_objects(object_of_primitive_);
    for (const Exposure& e : exposures_)
        scene.add_field(e.name, cells.i, cells.j, cells.k, e.values);
    return scene;
}

}  // namespace topple
