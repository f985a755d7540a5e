// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/solid_scene.h"
#include "scale/blocks.h"
#include "scale/join_blocks.h"
#include "scale/work_folder.h"
#include "solids/taken_away.h"
#include "topple/scene.h"
#include "vdb/voxel_scene.h"

namespace topple {

// What of a cloud that was parsed in blocks stays on disk until it is written out.
class TiledResult {
  public:
    // Reads the blocks' labels. input, unit_m: the cloud, which is read once more for its points.
    TiledResult(std::unique_ptr<tiles::WorkFolder> work, std::filesystem::path input, double unit_m,
                std::vector<tiles::Bin> bins, tiles::Layout layout, BlockNumbers number);

    // Points of each primitive, of all `primitives`; and a sample of about `most` thinned points
    // with their primitives.
    std::vector<std::uint64_t> count_points(std::size_t primitives) const;
    ScenePoints sample(std::size_t most) const;

    // What is taken away by hand, before what follows.
    void take_away(const TakenAway& taken);
    // A field's strength at each of the cells, for the volume.
    struct Exposure {
        std::string name;
        std::vector<float> values;
    };
    // What sample(), write_points() and load_voxels() take from the whole scene.
    void set_scene(std::shared_ptr<const SolidScene> solids,
                   std::vector<std::int32_t> object_of_primitive, std::vector<Exposure> exposures) {
        solids_ = std::move(solids);
        object_of_primitive_ = std::move(object_of_primitive);
        exposures_ = std::move(exposures);
    }

    // points.ply: all points of the input, in its order. Throws Error(input) where the input has
    // changed since it was parsed.
    // poll: called now and then; what it throws ends the writing.
    void write_points(const std::filesystem::path& file, const std::function<void()>& poll) const;
    // The voxels of all blocks, with their objects and the exposures.
    vdb::VoxelScene load_voxels() const;
    // All is written: the work folder may go.
    void finished() const { work_->finished(); }

  private:
    std::int32_t object_of(std::int32_t primitive) const {
        return primitive < 0 ? -1 : object_of_primitive_[primitive];
    }

    std::unique_ptr<tiles::WorkFolder> work_;
    std::filesystem::path input_;
    double unit_m_;
    std::vector<tiles::Bin> bins_;
    tiles::Layout layout_;
    BlockNumbers number_;
    std::vector<std::vector<std::int32_t>> label_;  // by bin, of its thinned points
    std::vector<std::int32_t> object_of_primitive_;
    std::vector<vdb::Voxel> empty_;  // what is taken away of the blocks' voxels
    std::shared_ptr<const SolidScene> solids_;
    std::vector<Exposure> exposures_;
};

}  // namespace topple
