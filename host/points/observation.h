// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/space_map.h"
#include "core/thread_pool.h"
#include "geometry/manhattan.h"
#include "geometry/storeys.h"
#include "points/frame_stream.h"
#include "points/scale_checks.h"
#include "topple/cloud_view.h"
#include "topple/kernels/device.h"
#include "topple/parse.h"

namespace topple {

// Working resolution stays within what indoor sensors deliver and what furniture needs. Points
// farther apart than five of the coarsest cells show no surface.
inline constexpr double least_cell_m = 0.003, largest_cell_m = 0.05;
inline constexpr double sparsest_m = 5 * largest_cell_m;

// Of a cloud or frames without: grouping goes by colours, too, where there are any
// (graph/borders.h).
inline constexpr const char* no_colours_note =
    "No colours were given: things that touch are told apart less well than with them.";

// Throws Error(usage) for the path of an input that is empty, of which messages could name nothing.
void check_path(const std::filesystem::path& input);

// Calls use(frame, i) for each frame, or every step-th one, in order. Frames are decoded by all
// threads, as many at once, unless they must be loaded one by one.
struct WhichFrames {
    bool coloured = false;
    std::size_t step = 1;
};
void for_each_frame(const FrameStream& frames, ThreadPool& threads,
                    const std::function<void(DepthFrame, std::size_t)>& use,
                    const WhichFrames& which = {});

// Surfels are larger than the cells of the cloud: a surface then has no holes at their resolution
// even where it is sparsely seen, and each averages the noise of several points. Measured: part
// mIoU on generated rooms is highest at about twice the point spacing.
constexpr double surfel_cells = 1.85;

// What every later stage starts from, whatever the input was.
struct Observation {
    ScanOrigin origin = ScanOrigin::cloud_file;
    // Where all coordinates but those of `own` are reckoned from, in the input's frame
    // (working_origin.h).
    Vec3 origin_m{};
    // The points, in the caller's memory or in `own`: what came from a file or from frames, or lost
    // points that were not finite; then `index` holds the place of each in the arrays or the file.
    CloudView cloud;
    PointCloud own;
    std::array<ByteColumn, 3> given_colours;  // the caller's, which `cloud` may lack
    std::vector<std::uint64_t> index;
    std::uint32_t image_width = 0, image_height = 0;  // as in ParseResult
    std::vector<Vec3> viewpoints;                     // where the sensor was
    std::vector<std::uint32_t> viewpoint_of_point;  // of each point, or empty: viewpoint 0 for all
    std::unique_ptr<FrameStream> frames;            // what carves the free space; null: nothing can
    // Whether that is from where sensors were: what stays unseen none of them saw.
    bool by_sensors = false;
    std::optional<Vec3> camera_up;
    bool sides_guessed = false;     // as FrameHints::sides_guessed
    std::optional<Vec3> format_up;  // as FrameHints::format_up
    // Where it was found already: from all of a building, or as the axes of a map.
    std::optional<geometry::SceneFrame> frame;
    std::vector<geometry::StoreyHint> storeys;  // of a part of a building
    std::optional<SpaceMap> space;              // what a map says to be free
    double voxel_m = 0;        // voxels' edge that the input brings; 0: from cell_m
    double cell_m = 0;         // working resolution, from the point spacing and the sensor's noise
    double sparse_cell_m = 0;  // the same for the sparser parts of the surface; 0: no other
    std::optional<geometry::SurfelScale> surfels;  // none: cells of surfel_cells * cell_m
    // What of the input may mean something else than it was taken for, and what is to be known of
    // it beside.
    std::vector<std::string> doubts, notes;
};

// The working resolution that suits a depth camera: about the spacing of its pixels at the scene's
// typical depth, but not below its noise there, which only smears points over more cells.
double cell_for_frames(const Intrinsics& intrinsics, double typical_depth_m);
// That depth: the median of readings of some frames, metres; 0 where there are none.
double typical_depth(const FrameStream& frames, ThreadPool& threads);

// From then on the normals that the cloud brought count as not given.
void leave_out_normals(Observation& input);

// Says that what is seen is of one frame, or that it has no colours.
void note_single_frame(Observation& out);
void note_colours(bool given, Observation& out);

// What to look at where frames show nothing that makes sense; see scale_checks.h.
std::string depth_scale_hint(const FrameStream& frames, ScanOrigin origin);

// A file that is no sequence of frames: its points, and of a map its free space. What libraries of
// others read, they read in a process of their own, unless options.isolate is off.
ScannedMap read_input(const std::filesystem::path& file, const ParseOptions& options);

Observation observe(device::Device& device, const std::filesystem::path& input,
                    const ParseOptions& options);
Observation observe_cloud(device::Device& device, PointCloud cloud, const ParseOptions& options,
                          ScanOrigin origin = ScanOrigin::cloud_file);
// The cloud must stay as long as what is returned. Without points that are not finite, no copy of
// it is made.
Observation observe_view(device::Device& device, const CloudView& cloud,
                         const ParseOptions& options);

// A folder of depth frames.
Observation observe_folder(device::Device& device, const std::filesystem::path& folder,
                           const ParseOptions& options);

// The frames must stay as long as what is returned.
Observation observe_frames(device::Device& device, const FramesView& frames,
                           const ParseOptions& options);

// A part of a larger cloud, thinned to one point a cell, whose sides are not known.
Observation ingest_part(device::Device& device, PointCloud cloud, double cell_m);

}  // namespace topple
