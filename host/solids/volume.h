// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/solid_scene.h"
#include "device/stage_clock.h"
#include "geometry/surface_samples.h"
#include "points/observation.h"
#include "solids/space_carving.h"
#include "solids/surfaces.h"
#include "solids/taken_away.h"
#include "topple/kernels/device.h"
#include "vdb/completion.h"
#include "vdb/voxel_scene.h"

// Section 2.2 of the paper: from labelled points to solid voxels.
namespace topple {

struct Volume {
    std::shared_ptr<vdb::VoxelScene> scene;
    std::shared_ptr<const SolidScene> solids;
    // Solid of each of the geometry's primitives; -1: it is a fragment, whose voxels are solid, but
    // no primitive's. Solids keep the order of the primitives.
    std::vector<std::int32_t> number;
    // What would make it what is likely (vdb/completion.h), for take_likely().
    std::vector<vdb::Claim> likely;
    std::vector<bool> sheet;  // by solid: of the shell, and seen from one side only
    bool by_sensors = false;  // as Observation::by_sensors
};

// How finely solids are told: by what bounds them within their voxels, or by whole voxels.
enum class SolidDetail { within_voxels, whole_voxels };

// Voxels, what is left of carving, and completion. In whole voxels the solids have no boundary
// cells, and the scene no field of fractions.
Volume fill_volume(device::Device& device, const Observation& input, const Surfaces& geometry,
                   SpaceCarving& carving, StageClock& stage,
                   SolidDetail detail = SolidDetail::within_voxels);

// How it fills: down to where most of the lowest storey's floor lies, which ends at top_m.
vdb::FillOptions fill_options(const SolidCells& cells, std::span<const Role> roles,
                              double top_m = std::numeric_limits<double>::infinity());

// Makes the volume, in one piece and within voxels, what is likely: once joints are judged, whose
// models were fitted to volumes that are filled as in the paper.
void take_likely(Volume& volume);

// What of the solids is found to be no primitive's, the same cells being solid.
void clear_lost_labels(const SolidScene& before, const SolidScene& now, vdb::VoxelScene& scene);

// What is taken away by hand: voxels that are empty, or others'; primitives have other numbers.
void take_away(const TakenAway& taken, vdb::VoxelScene& scene);

// Adds the field of how much of each voxel is solid, which the scene does not have yet.
void store_fractions(const SolidScene& solids, vdb::VoxelScene& volume);

// Labels by primitive as labels by solid.
std::vector<std::int32_t> numbered(std::span<const std::int32_t> primitive,
                                   std::span<const std::int32_t> number);
geometry::SurfaceSamples numbered(geometry::SurfaceSamples samples,
                                  std::span<const std::int32_t> number);

}  // namespace topple
