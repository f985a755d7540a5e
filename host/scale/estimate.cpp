// SPDX-License-Identifier: MIT
#include "scale/estimate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <unordered_map>
#include <vector>

#include "core/scene_bounds.h"
#include "core/thread_pool.h"
#include "device/cancelling.h"
#include "device/devices.h"
#include "geometry/back_projection.h"
#include "geometry/surfels.h"
#include "io/text.h"
#include "points/budget.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/octomap.h"
#include "points/formats/read_cloud.h"
#include "points/frames_fusion.h"
#include "points/observation.h"
#include "points/parse_memory.h"
#include "points/scale_checks.h"
#include "points/scan_look.h"
#include "points/surface_extent.h"
#include "points/voxel_size.h"
#include "points/work_check.h"
#include "scale/tiled_parse.h"
#include "vdb/read_volume.h"

namespace topple {
namespace {

// Seconds of the processor that the stages take together in blocks where the probe takes
// probe_reference_s: of a thinned cell, and of every run. tests/estimates/estimates.py fits them
// and those of parse_memory.h.
constexpr double probe_reference_s = 0.027;
constexpr double tiled_cell_s = 6e-6, tiled_fixed_s = 1.5;
// What of that one thread does alone; threads share the rest.
constexpr double serial_share = 0.15;
// Of the cells that a surface passes, those in which frames are fused to a point that stays.
constexpr double fused_share = 0.66;
// Cells of a block of a furnished building.
constexpr std::uint64_t block_cells = 450'000;
constexpr double work_point_bytes = 12, work_thinned_bytes = 40;
// Bytes of all files of an output, its parse.cache among them: of a point of points.ply, of a voxel
// of the grid as for time, and of every run. In blocks there is no cache.
constexpr double output_point_bytes = 35, output_voxel_bytes = 63, tiled_output_point_bytes = 23,
                 output_fixed = 15e6;
// Of a surface whose noise is about a seventh of the cell, cells a patch of a cell's size.
constexpr double layers = 2.3;

// Seconds of the processor, of one thread, for the work that parses are full of, on a wavy sheet:
// least of three runs. Other work on the machine leaves them about as they are.
double probe() {
    const std::unique_ptr<device::Device> device = device::open_native(1);
    PointCloud cloud;
    for (int i = 0; i < 300; ++i) {
        for (int j = 0; j < 300; ++j) {
            cloud.x.push_back(0.01f * static_cast<float>(i));
            cloud.y.push_back(0.01f * static_cast<float>(j));
            cloud.z.push_back(0.1f * std::sin(0.05f * static_cast<float>(i + 2 * j)));
        }
    }
    double least = INFINITY;
    for (int run = 0; run < 3; ++run) {
        const std::clock_t start = std::clock();
        geometry::make_surfels(*device, cloud, 0.018, {}, {});
        least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return least;
}

void tell(const ParseOptions& options, double done) {
    end_if_cancelled(options);
    if (options.progress) options.progress("estimate", done);
}

// The surface, and, as far as it may be parsed in one piece, the points: of frames, about what they
// are fused to.
struct Looked {
    SurfaceExtent surface;
    PointCloud cloud;
    geometry::FrameHints hints;
    double voxel_m = 0;    // that the input brings
    double spacing_m = 0;  // from point to nearest point, or of what the map has for them
    bool views = false;    // a parse looks at it from virtual views
    ScanOrigin origin = ScanOrigin::cloud_file;
    double seen_m3 = INFINITY;  // of a single view: the space before what it shows
    double fused_bytes = 0;     // of frames: while they are fused
};

void add(const CloudView& portion, Looked& to) {
    for (std::size_t n = 0; n < portion.size(); ++n)
        to.surface.add(portion.x[n], portion.y[n], portion.z[n]);
}

Looked look_at_cloud(const std::filesystem::path& input, const ParseOptions& options,
                     Estimate& out) {
    Looked looked;
    if (may_be_tiled(input, options)) {
        io::stream_cloud(input, options.unit_m, [&](const PointCloud& portion) {
            out.points += portion.size();
            add(portion, looked);
            // Where they are too many, the first of them tell of the scale.
            if (out.points <= most_points_at_once) {
                const auto append = [](std::vector<float>& to, const std::vector<float>& from) {
                    to.insert(to.end(), from.begin(), from.end());
                };
                append(looked.cloud.x, portion.x);
                append(looked.cloud.y, portion.y);
                append(looked.cloud.z, portion.z);
            }
            tell(options, 0);
        });
        out.tiled = options.tile_m > 0 || out.points > most_points_at_once;
        if (out.tiled) return looked;
        looked = {};
    }
    ScannedMap map = read_input(input, options);
    looked.cloud = std::move(map.cloud);
    looked.hints.format_up = io::up_of_format(input);
    out.points = looked.cloud.size();
    add(looked.cloud, looked);
    const bool map_of_space = io::looks_like_octomap(input);
    if (map_of_space) looked.voxel_m = map.space.voxel_m;
    if (map_of_space || vdb::looks_like_volume(input))
        looked.origin = ScanOrigin::map_file;
    else if (io::is_mesh(input))
        looked.origin = ScanOrigin::mesh_file;
    DepthFrame frame;
    Intrinsics k;
    const bool depth_image =
        looked.cloud.height > 1 && geometry::frame_of_organised_cloud(looked.cloud, k, frame);
    if (depth_image) looked.seen_m3 = seen_m3(frame, k);
    looked.views = !map_of_space && !depth_image;
    return looked;
}

// Refuses what a parse would refuse: figures of a room that is a thousand times too large are of no
// use. Of more points than are held those are the first, in whatever order they come: the spacing
// of all is at least what it were if these were strewn over the whole.
void check_scale(const std::filesystem::path& input, Estimate& out, Looked& looked) {
    looked.spacing_m = out.spacing_m = looked.voxel_m;
    if (!(looked.voxel_m > 0)) {
        const geometry::PointSpacing spacing = geometry::point_spacing(looked.cloud);
        looked.spacing_m = spacing.nearest_m;
        out.spacing_m = spacing.around_m;
    }
    const auto held = static_cast<double>(looked.cloud.size());
    const double share = std::min(1.0, held / static_cast<double>(out.points));
    CloudView view = looked.cloud;
    view.source = input.string();
    check_spacing(view, std::sqrt(share) * looked.spacing_m);
    if (!out.tiled)
        out.unit_hint =
            unit_hint(view, looked.origin == ScanOrigin::mesh_file ? INFINITY : looked.spacing_m,
                      looked.origin);
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
        out.voxel_m = voxel_for_scan(out.cell_m, out.surface_m2, bounds_of(looked.cloud),
                                     static_cast<double>(out.points), options.max_memory_bytes);
}

// Calls use(key of the cell, at) for every step-th pixel each way that has a reading on a surface;
// at() is its position.
template <class Use>
void each_reading(const DepthFrame& frame, const Intrinsics& k,
                  const geometry::BackProjection& projection, double cell_m, std::uint32_t step,
                  const Use& use) {
    geometry::RowReadings row(k.width);
    for (std::uint32_t v = 0; v < k.height; v += step) {
        projection.row(frame, v, row);
        for (std::uint32_t u = 0; u < k.width; u += step) {
            if (row.kept[u] == 0 || row.inside[u] == 0) continue;
            std::uint64_t key = 0;
            for (std::size_t a = 0; a < 3; ++a)
                key = key << 21 | static_cast<std::uint64_t>(row.cell[a][u]);
            const auto at = [&] {
                Vec3 p{};
                for (std::size_t a = 0; a < 3; ++a)
                    p[a] = (static_cast<double>(row.cell[a][u] - geometry::key_bias) +
                            row.part[a][u] / geometry::cell_parts) *
                           cell_m;
                return p;
            };
            use(key, at);
        }
    }
}

// How many different cells there are, by a sixteenth of all.
class CellCount {
  public:
    void add(std::uint64_t cell) {
        if (cell * 0x9E3779B97F4A7C15u >> 60 == 0) ++readings_[cell];
    }
    double cells() const { return 16 * static_cast<double>(readings_.size()); }
    // Those with one reading only.
    double once() const {
        return 16 * static_cast<double>(std::ranges::count_if(
                        readings_, [](const auto& cell) { return cell.second == 1; }));
    }

  private:
    std::unordered_map<std::uint64_t, std::uint32_t> readings_;
};

// The mean of the readings in each cell.
class CellMeans {
  public:
    void add(std::uint64_t cell, const Vec3& at) {
        const auto [place, is_new] = place_.try_emplace(cell, sums_.size());
        if (is_new) sums_.emplace_back();
        Sum& sum = sums_[place->second];
        for (std::size_t a = 0; a < 3; ++a) sum.at[a] += at[a];
        ++sum.count;
    }
    PointCloud cloud() const {
        PointCloud out;
        for (const Sum& sum : sums_) {
            const auto mean = [&](std::size_t a) {
                return static_cast<float>(sum.at[a] / static_cast<double>(sum.count));
            };
            out.x.push_back(mean(0));
            out.y.push_back(mean(1));
            out.z.push_back(mean(2));
        }
        return out;
    }

  private:
    struct Sum {
        Vec3 at{};
        std::size_t count = 0;
    };
    std::unordered_map<std::uint64_t, std::size_t> place_;
    std::vector<Sum> sums_;
};

// Of more than one frame what only one of them shows is left out: strays are shown once.
void keep_shown_again(const SurfaceExtent& again, PointCloud& cloud) {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        if (!again.has(cloud.x[n], cloud.y[n], cloud.z[n])) continue;
        for (std::vector<float>* at : {&cloud.x, &cloud.y, &cloud.z}) (*at)[kept] = (*at)[n];
        ++kept;
    }
    for (std::vector<float>* at : {&cloud.x, &cloud.y, &cloud.z}) at->resize(kept);
}

// Each frame of a sample covers what its neighbours cover, too: their union grows as that of all.
Looked look_at_frames(const std::filesystem::path& input, const ParseOptions& options,
                      Estimate& out) {
    Looked looked;
    const io::FrameSequence frames = io::FrameSequence::open(input);
    const Intrinsics& k = frames.intrinsics();
    out.frames = frames.size();
    out.pixels = out.frames * k.width * k.height;
    ThreadPool threads(0);
    const double depth_m = typical_depth(frames, threads);
    check_readings(k, frames.size(), depth_m, input.string(), ScanOrigin::frames_folder);
    out.cell_m = cell_for_frames(k, depth_m);
    out.spacing_m = out.cell_m;
    looked.hints.camera_up = frames.mean_camera_up();
    const geometry::BackProjection projection(k, out.cell_m);
    constexpr std::size_t most_frames = 100;
    const std::size_t step = std::max<std::size_t>(1, frames.size() / most_frames);
    SurfaceExtent again;
    CellCount count;
    CellMeans means;
    for (std::size_t f = 0; f < frames.size(); f += step) {
        const DepthFrame frame = frames.load(f);
        const auto each = [&](std::uint32_t apart, const auto& use) {
            each_reading(frame, k, projection, out.cell_m, apart, use);
        };
        each(3, [&](std::uint64_t, const auto& at) {
            const Vec3 p = at();
            if (looked.surface.has(p[0], p[1], p[2])) again.add(p[0], p[1], p[2]);
        });
        each(3, [&](std::uint64_t cell, const auto& at) {
            const Vec3 p = at();
            means.add(cell, p);
            looked.surface.add(p[0], p[1], p[2]);
        });
        each(1, [&](std::uint64_t cell, const auto&) { count.add(cell); });
        if (frames.size() == 1) looked.seen_m3 = seen_m3(frame, k);
        tell(options, static_cast<double>(f) / static_cast<double>(frames.size()));
    }
    looked.cloud = means.cloud();
    const double area = looked.surface.area_m2();
    out.points = static_cast<std::uint64_t>(fused_share * area / (out.cell_m * out.cell_m));
    if (again.area_m2() > 0) keep_shown_again(again, looked.cloud);
    // Where a single frame's pixels are farther apart than its cells, some of these are empty.
    constexpr double pixels_share = 0.87;
    if (frames.size() == 1)
        out.points = std::min(out.points, static_cast<std::uint64_t>(pixels_share * count.cells()));
    // The frames left out find as many cells anew as have one reading now, at most.
    const double left_out = 1 - 1 / static_cast<double>(step);
    looked.fused_bytes =
        fusion_peak(count.cells() + left_out * count.once(), static_cast<double>(out.pixels));
    return looked;
}

// In blocks: the thinned cells decide.
void reckon_blocks(device::Device& device, const ParseOptions& options, Estimate& out) {
    const auto points = static_cast<double>(out.points);
    const double asked_cell_m = options.voxel_m / voxel_cells;  // 0: not asked
    const double finest = points > 0 ? 1.25 * std::sqrt(out.surface_m2 / points) : 0;
    out.cell_m = std::min(largest_cell_m,
                          std::max(finest, asked_cell_m > 0 ? asked_cell_m : building_cell_m));
    const double thinned =
        std::min(0.95 * points, layers * out.surface_m2 / (out.cell_m * out.cell_m));
    out.processor_s = tiled_fixed_s + tiled_cell_s * thinned;
    const double block = block_bytes(
        static_cast<std::uint64_t>(std::min(thinned, static_cast<double>(block_cells))));
    double lanes =
        device.info().backend == device::Backend::native ? device.threads().threads() : 1;
    lanes = std::clamp(std::ceil(thinned / static_cast<double>(block_cells)), 1.0, lanes);
    if (options.max_memory_bytes > 0)
        lanes = std::clamp(std::floor(static_cast<double>(options.max_memory_bytes) / block), 1.0,
                           lanes);
    out.least_bytes = static_cast<std::uint64_t>(std::max(block, whole_bytes(thinned)));
    out.memory_bytes = static_cast<std::uint64_t>(std::max(block * lanes, whole_bytes(thinned)));
    out.work_bytes =
        static_cast<std::uint64_t>(work_point_bytes * points + work_thinned_bytes * thinned);
    out.output_bytes = static_cast<std::uint64_t>(tiled_output_point_bytes * points + 15 * thinned);
}

OnePiece piece_of(const Estimate& e) {
    return {static_cast<double>(e.points),
            e.surface_voxels,
            e.box_voxels,
            e.ground_m2,
            e.patches_m,
            e.views};
}

void reckon_one_piece(device::Device& device, const ParseOptions& options, Looked& looked,
                      Estimate& out) {
    const auto points = static_cast<double>(out.points);
    out.output_bytes = static_cast<std::uint64_t>(output_fixed + output_point_bytes * points);
    if (looked.cloud.size() == 0) return;
    find_resolution(looked, options, out);
    if (options.up) looked.hints.up = options.up;
    const ScanLook look =
        look_at_scan(device, looked.cloud, out.cell_m, out.surface_m2, looked.hints);
    const double h = out.voxel_m;
    out.views = looked.views;
    out.patches_m = look.patches_m;
    out.ground_m2 = look.box.ground_m2;
    out.box_voxels = std::min(look.box.m3(), looked.seen_m3) / (h * h * h);
    out.surface_voxels = looked.surface.area_m2(out.spacing_m) / (h * h);
    const OnePiece piece = piece_of(out);
    out.output_bytes += static_cast<std::uint64_t>(output_voxel_bytes * piece.grid_voxels());
    out.processor_s = one_piece_seconds(piece);
    out.memory_bytes =
        static_cast<std::uint64_t>(std::max(looked.fused_bytes, one_piece_peak(piece)));
    out.least_bytes = std::max(one_piece_bytes(points, out.surface_m2, bounds_of(looked.cloud), h),
                               static_cast<std::uint64_t>(looked.fused_bytes));
}

// As a parse asks before its work.
void check_work(const Estimate& e, const std::filesystem::path& input, Budget& budget) {
    const std::string source = io::path_text(input);
    if (e.tiled)
        return budget.check(source + ": in blocks it would need about", e.least_bytes,
                            "use a larger voxel_m (--voxel)");
    if (e.voxel_m > 0) topple::check_work(source, piece_of(e), e.voxel_m, budget);
}

}  // namespace

Estimate estimate(const std::filesystem::path& input, const ParseOptions& options) {
    check_options(options);
    check_path(input);
    const auto device = options.device ? options.device : device::open_device("auto");
    tell(options, 0);
    Estimate out;
    Looked looked;
    if (io::looks_like_sequence(input)) {
        looked = look_at_frames(input, options, out);
    } else {
        looked = look_at_cloud(input, options, out);
        if (out.points > 0) check_scale(input, out, looked);
    }
    out.surface_m2 = looked.surface.area_m2();
    if (out.tiled)
        reckon_blocks(*device, options, out);
    else
        reckon_one_piece(*device, options, looked, out);
    out.probe_s = probe();
    out.processor_s *= out.probe_s / probe_reference_s;
    Budget budget(io::path_text(input), bytes_of_input(input), options);
    out.allowed_bytes = budget.bytes();
    try {
        check_work(out, input, budget);
    } catch (const Error& refused) {
        out.refusal = refused.what();
    }
    const double threads = device->threads().threads();
    out.seconds = out.processor_s * (serial_share + (1 - serial_share) / threads);
    return out;
}

}  // namespace topple
