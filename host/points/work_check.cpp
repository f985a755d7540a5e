// SPDX-License-Identifier: MIT
#include "points/work_check.h"

#include <algorithm>

#include "core/short_number.h"
#include "core/solid_cells.h"
#include "io/text.h"
#include "points/scale_checks.h"
#include "points/scan_look.h"
#include "points/surface_extent.h"
#include "points/voxel_size.h"

namespace topple {
namespace {

// Of three parses in four the memory is within a quarter of what is foreseen: where the bound is
// below this share of it a parse is refused. One that takes more than it was foreseen to ends at
// the bound.
constexpr double sure_share = 0.7;

OnePiece with_voxels(OnePiece piece, double times_as_large) {
    piece.surface_voxels /= times_as_large * times_as_large;
    piece.box_voxels /= times_as_large * times_as_large * times_as_large;
    return piece;
}

std::string count_text(double count) {
    if (count < 1e6) return io::two_digits(std::max(1.0, count / 1e3)) + " thousand";
    return io::two_digits(count / 1e6) + " million";
}

std::string voxels_text(const OnePiece& piece, double voxel_m) {
    return count_text(piece.surface_voxels) + " voxels of " + short_number(voxel_m) +
           " m on surfaces";
}

std::uint64_t sure_bytes(const OnePiece& piece) {
    return static_cast<std::uint64_t>(sure_share * one_piece_peak(piece));
}

// The finest of voxels, coarser than these, with which the parse keeps to its budget.
std::string mend(const OnePiece& piece, double voxel_m, const Budget& budget) {
    for (const double h : {0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.075, 0.1, 0.15, 0.2, 0.3, 0.5}) {
        const OnePiece then = with_voxels(piece, h / voxel_m);
        if (h > 1.2 * voxel_m && one_piece_peak(then) <= static_cast<double>(budget.bytes()) &&
            one_piece_seconds(then) <= 2 * budget.seconds())
            return "use voxel_m (--voxel) = " + short_number(h);
    }
    return "give a smaller part";
}

OnePiece piece_of(const Observation& input, const FramedSurfels& surfels, double voxel_m) {
    const GridBox box = grid_box(input.cloud, surfels.frame.axes);
    // Of sparse points more than their own cells: gaps between them are closed.
    const double area_m2 = static_cast<double>(surfels.surfels.size()) * surfels.surfels.area_m2;
    double space_m3 = box.m3();
    if (input.frames && input.frames->size() == 1)
        space_m3 = std::min(space_m3, seen_m3(input.frames->load(0), input.frames->intrinsics()));
    return {static_cast<double>(input.cloud.size()),
            area_m2 / (voxel_m * voxel_m),
            space_m3 / (voxel_m * voxel_m * voxel_m),
            box.ground_m2,
            0,
            input.frames != nullptr};
}

}  // namespace

void check_work(const std::string& source, const OnePiece& piece, double voxel_m, Budget& budget) {
    const std::string what =
        voxels_text(piece, voxel_m) + ", in a space of " + count_text(piece.box_voxels) + ",";
    const std::string less = mend(piece, voxel_m, budget);
    budget.check(source + ": " + what + " need about", sure_bytes(piece), less);
    budget.begin_work(what, less, one_piece_seconds(piece));
}

void check_surface(const Observation& input, double pitch_m, const ParseOptions& options,
                   Budget& budget) {
    const CloudView& cloud = input.cloud;
    if (budget.asked()) return;  // find_solids() asks more strictly
    const auto piece = [&](double area_m2, double voxel_m) {
        const double voxels = area_m2 / (voxel_m * voxel_m);  // no fewer in the box
        return OnePiece{static_cast<double>(cloud.size()), voxels, voxels};
    };
    // Nearly always the least voxels, and the most surface that so many points may show, will do.
    const double finest = options.voxel_m > 0
                              ? options.voxel_m
                              : std::min(voxel_for_cell(input.cell_m), room_voxel_m);
    const double most_m2 = static_cast<double>(cloud.size()) * pitch_m * pitch_m;
    if (one_piece_peak(piece(most_m2, finest)) <= static_cast<double>(budget.bytes())) return;
    const double voxel_m = voxel_for_input(input, options);
    const double area_m2 = extent_of(cloud).area_m2(pitch_m);
    budget.check(
        cloud.source + ": " + voxels_text(piece(area_m2, voxel_m), voxel_m) + " need about",
        sure_bytes(piece(area_m2, voxel_m)), mend(piece(area_m2, voxel_m), voxel_m, budget));
}

void check_work(const Observation& input, const FramedSurfels& surfels, double voxel_m,
                Budget& budget) {
    check_work(input.cloud.source, piece_of(input, surfels, voxel_m), voxel_m, budget);
}

void check_memory_of(const Observation& input, double voxel_m, const ParseOptions& options) {
    const CloudView& cloud = input.cloud;
    if (options.max_memory_bytes == 0) return;
    const std::uint64_t need = one_piece_bytes(
        static_cast<double>(cloud.size()), extent_of(cloud).area_m2(), bounds_of(cloud), voxel_m);
    check_memory(std::to_string(cloud.size()) + " points at voxels of " + short_number(voxel_m) +
                     " m may need",
                 need, options,
                 std::string("use a larger voxel_m (--voxel)") +
                     (input.origin == ScanOrigin::cloud_file
                          ? ", or tile_m = 5 (--tile 5) to have it parsed in blocks"
                          : ""));
}

void fail_without_surface(const Observation& input, const std::string& source, double extent_m) {
    const std::string scale = of_frames(input.origin) && input.frames
                                  ? depth_scale_hint(*input.frames, input.origin)
                                  : small_extent_hint(extent_m, input.origin);
    throw Error(
        ErrorKind::input,
        source + ": " + io::counted(input.cloud.size(), "point") +
            (input.cloud.size() == 1 ? " was" : " were") +
            " found, but no surface of them fills the " + std::to_string(least_voxels) +
            " voxels that a solid takes; give a denser scan, or a smaller voxel_m (--voxel)" +
            (scale.empty() ? "" : "; " + scale));
}

}  // namespace topple
