// SPDX-License-Identifier: MIT
#include "pipeline/estimate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <vector>

#include "core/scene_bounds.h"
#include "core/thread_pool.h"
#include "device/device.h"
#include "geometry/surfels.h"
#include "io/frame_sequence.h"
#include "io/octomap.h"
#include "io/read_cloud.h"
#include "pipeline/cancelling.h"
#include "pipeline/ingest.h"
#include "pipeline/parse_memory.h"
#include "pipeline/scale_checks.h"
#include "pipeline/surface_extent.h"
#include "pipeline/tiled_parse.h"
#include "pipeline/voxel_size.h"

namespace topple {
namespace {

// Measured on machines whose probe takes probe_reference_s, or as much longer or shorter: of a
// parse in blocks seconds a point (sorting, thinning, writing) and a square metre of surface,
// whatever its resolution; of one in one piece those of a point, a voxel of the surface, a voxel of
// the box, a frame's pixel; and what every run takes. tests/estimates/estimates.py fits those in
// one piece.
constexpr double probe_reference_s = 0.075;
constexpr double tiled_point_s = 0.27e-6, tiled_m2_s = 0.033, tiled_fixed_s = 1;
constexpr double point_s = 2.9e-6, surface_voxel_s = 4.7e-5, voxel_s = 2.3e-7, pixel_s = 2.8e-7,
                 fixed_s = 0.89;
// Of the cells that a surface passes, those in which frames are fused to a point that stays.
constexpr double fused_share = 0.66;
// Cells of a block of a furnished building.
constexpr std::uint64_t block_cells = 450'000;
constexpr double work_point_bytes = 16, work_thinned_bytes = 40;
constexpr double output_point_bytes = 35, tiled_output_point_bytes = 23, output_fixed = 15e6;
// Of a surface whose noise is about a seventh of the cell, cells a patch of a cell's size.
constexpr double layers = 2.3;

// Seconds of the work that parses are full of, on a wavy sheet: least of three runs.
void probe(device::Device& device, Estimate& out) {
    PointCloud cloud;
    for (int i = 0; i < 300; ++i) {
        for (int j = 0; j < 300; ++j) {
            cloud.x.push_back(0.01f * static_cast<float>(i));
            cloud.y.push_back(0.01f * static_cast<float>(j));
            cloud.z.push_back(0.1f * std::sin(0.05f * static_cast<float>(i + 2 * j)));
        }
    }
    out.probe_s = out.probe_processor_s = INFINITY;
    for (int run = 0; run < 3; ++run) {
        const std::clock_t spent = std::clock();
        const auto start = std::chrono::steady_clock::now();
        geometry::make_surfels(device, cloud, 0.018, {}, {});
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
        out.probe_s = std::min(out.probe_s, passed.count());
        out.probe_processor_s = std::min(
            out.probe_processor_s, static_cast<double>(std::clock() - spent) / CLOCKS_PER_SEC);
    }
}

void tell(const ParseOptions& options, double done) {
    end_if_cancelled(options);
    if (options.progress) options.progress("estimate", done);
}

// Beside the surface of what is no sequence of frames: its points, as far as they may be parsed in
// one piece, and the voxels that it brings.
struct Looked {
    SurfaceExtent surface;
    PointCloud cloud;
    double voxel_m = 0;
    double spacing_m = 0;  // of the points, or of what the map has for them
};

Looked look_at_cloud(const std::filesystem::path& input, const ParseOptions& options,
                     Estimate& out) {
    Looked looked;
    const auto add = [&](const PointCloud& portion) {
        out.points += portion.size();
        for (std::size_t n = 0; n < portion.size(); ++n)
            looked.surface.add(portion.x[n], portion.y[n], portion.z[n]);
        if (out.points <= most_points_at_once) {
            const auto append = [](std::vector<float>& to, const std::vector<float>& from) {
                to.insert(to.end(), from.begin(), from.end());
            };
            append(looked.cloud.x, portion.x);
            append(looked.cloud.y, portion.y);
            append(looked.cloud.z, portion.z);
        }
        tell(options, 0);
    };
    if (io::can_stream(input)) {
        io::stream_cloud(input, options.unit_m, add);
        out.tiled = options.tile_m > 0 || out.points > most_points_at_once;
        if (out.tiled || !io::is_mesh(input)) return looked;
        looked = {};  // of a mesh in one piece its faces count, not its vertices
        out.points = 0;
    }
    const ScannedMap map = read_input(input, options);
    add(map.cloud);
    if (io::looks_like_octomap(input)) looked.voxel_m = map.space.voxel_m;
    return looked;
}

// Refuses what a parse would refuse: figures of a room that is a thousand times too large are of no
// use. Of more points than are held those are the first, in whatever order they come: the spacing
// of all is at least what it were if these were strewn over the whole.
void check_scale(const std::filesystem::path& input, const Estimate& out, Looked& looked) {
    looked.spacing_m =
        looked.voxel_m > 0 ? looked.voxel_m : geometry::point_spacing(looked.cloud).nearest_m;
    const auto held = static_cast<double>(looked.cloud.size());
    const double share = std::min(1.0, held / static_cast<double>(out.points));
    CloudView view = looked.cloud;
    view.source = input.string();
    check_spacing(view, std::sqrt(share) * looked.spacing_m);
}

// The voxels and cells of a parse in one piece, as it finds them itself.
void find_resolution(const Looked& looked, const ParseOptions& options, Estimate& out) {
    if (out.frames == 0) {
        out.cell_m = looked.voxel_m > 0
                         ? looked.voxel_m / surfel_cells
                         : std::clamp(1.25 * looked.spacing_m, least_cell_m, largest_cell_m);
    }
    if (options.voxel_m > 0)
        out.voxel_m = options.voxel_m;
    else if (looked.voxel_m > 0)
        out.voxel_m = looked.voxel_m;
    else
        out.voxel_m = voxel_for_scan(out.cell_m, looked.surface, static_cast<double>(out.points),
                                     options.max_memory_bytes);
}

// Calls use(x, y, z) for every third pixel each way that has a reading.
template <class Use>
void each_reading(const DepthFrame& frame, const Intrinsics& k, const Use& use) {
    const Mat4& m = frame.camera_to_world;
    for (std::uint32_t v = 0; v < k.height; v += 3) {
        for (std::uint32_t u = 0; u < k.width; u += 3) {
            const double z = frame.depth[std::size_t{v} * k.width + u] / k.depth_scale;
            if (z <= 0) continue;
            const double x = (u - k.cx) / k.fx * z, y = (v - k.cy) / k.fy * z;
            use(m[0] * x + m[1] * y + m[2] * z + m[3], m[4] * x + m[5] * y + m[6] * z + m[7],
                m[8] * x + m[9] * y + m[10] * z + m[11]);
        }
    }
}

// Each frame of a sample covers what its neighbours cover, too: their union grows as that of all.
// `bounds`: of what more than one of them shows, for strays are shown once.
void look_at_frames(const std::filesystem::path& input, const ParseOptions& options,
                    SurfaceExtent& surface, Bounds<float>& bounds, Estimate& out) {
    const io::FrameSequence frames = io::FrameSequence::open(input);
    const Intrinsics& k = frames.intrinsics();
    constexpr std::size_t most_frames = 100;
    const std::size_t step = std::max<std::size_t>(1, frames.size() / most_frames);
    SurfaceExtent again;
    for (std::size_t f = 0; f < frames.size(); f += step) {
        const DepthFrame frame = frames.load(f);
        each_reading(frame, k, [&](double x, double y, double z) {
            if (surface.has(x, y, z)) again.add(x, y, z);
        });
        each_reading(frame, k, [&](double x, double y, double z) { surface.add(x, y, z); });
        tell(options, static_cast<double>(f) / static_cast<double>(frames.size()));
    }
    bounds = (again.area_m2() > 0 ? again : surface).bounds();
    out.frames = frames.size();
    out.cell_m = cell_for_frames(k, frames.size(), [&](std::size_t f) { return frames.load(f); });
    out.pixels = out.frames * k.width * k.height;
}

}  // namespace

Estimate estimate(const std::filesystem::path& input, const ParseOptions& options) {
    check_options(options);
    const auto device = options.device ? options.device : device::open_device("auto");
    tell(options, 0);
    Estimate out;
    Looked looked;
    Bounds<float> bounds;
    if (io::looks_like_sequence(input)) {
        look_at_frames(input, options, looked.surface, bounds, out);
    } else {
        looked = look_at_cloud(input, options, out);
        if (out.points > 0) check_scale(input, out, looked);
        bounds = looked.surface.bounds();
    }
    out.surface_m2 = looked.surface.area_m2();
    probe(*device, out);
    const double slower = out.probe_s / probe_reference_s;
    const auto points = static_cast<double>(out.points);
    const double asked_cell_m = options.voxel_m / voxel_cells;  // 0: not asked
    if (out.tiled) {
        const double finest = points > 0 ? 1.25 * std::sqrt(out.surface_m2 / points) : 0;
        out.cell_m = std::min(largest_cell_m,
                              std::max(finest, asked_cell_m > 0 ? asked_cell_m : building_cell_m));
        const double thinned =
            std::min(0.95 * points, layers * out.surface_m2 / (out.cell_m * out.cell_m));
        out.seconds = tiled_fixed_s + tiled_point_s * points + tiled_m2_s * out.surface_m2;
        const double block = block_bytes(
            static_cast<std::uint64_t>(std::min(thinned, static_cast<double>(block_cells))));
        double lanes =
            device->info().backend == device::Backend::native ? device->threads().threads() : 1;
        lanes = std::clamp(std::ceil(thinned / static_cast<double>(block_cells)), 1.0, lanes);
        if (options.max_memory_bytes > 0)
            lanes = std::clamp(std::floor(static_cast<double>(options.max_memory_bytes) / block),
                               1.0, lanes);
        const double blocks = block * lanes;
        out.least_bytes = static_cast<std::uint64_t>(std::max(block, whole_bytes(thinned)));
        out.memory_bytes = static_cast<std::uint64_t>(std::max(blocks, whole_bytes(thinned)));
        out.work_bytes =
            static_cast<std::uint64_t>(work_point_bytes * points + work_thinned_bytes * thinned);
        out.output_bytes =
            static_cast<std::uint64_t>(tiled_output_point_bytes * points + 15 * thinned);
    } else {
        if (out.frames > 0) {
            out.points = static_cast<std::uint64_t>(fused_share * out.surface_m2 /
                                                    (out.cell_m * out.cell_m));
        }
        const auto looked_at = static_cast<double>(out.points);
        if (looked_at > 0) {
            find_resolution(looked, options, out);
            const double h = out.voxel_m;
            double box = 1;
            for (std::size_t a = 0; a < 3; ++a) box *= (bounds.high[a] - bounds.low[a]) / h;
            out.box_voxels = box;
            out.seconds = fixed_s + point_s * looked_at +
                          pixel_s * static_cast<double>(out.pixels) +
                          surface_voxel_s * out.surface_m2 / (h * h) + voxel_s * box;
            out.memory_bytes = static_cast<std::uint64_t>(
                one_piece_peak(looked_at, out.surface_m2, bounds, h, out.frames == 0));
            out.least_bytes = one_piece_bytes(looked_at, out.surface_m2, bounds, h);
        }
        out.output_bytes =
            static_cast<std::uint64_t>(output_fixed + output_point_bytes * looked_at);
    }
    out.seconds *= slower;
    return out;
}

}  // namespace topple
