// SPDX-License-Identifier: MIT
#include "points/scale_checks.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/number_text.h"
#include "core/ranked.h"
#include "core/vectors.h"
#include "io/text.h"
#include "points/observation.h"
#include "points/surface_extent.h"
#include "topple/error.h"

namespace topple {
namespace {

// What a scan of rooms extends over, for guesses at its unit; and what not even that of a table
// full of things stays below.
constexpr double largest_room_m = 30, least_scan_m = 0.5;
// The smallest that a scan may be for its unit to be guessed at: some things on a table.
constexpr double least_table_m = 0.2;

// To three digits, or all before the point.
std::string text_of(double value) {
    return value >= 1000 && value < 1e9 ? to_places(value, 0) : to_digits(value, 3);
}

// "if the coordinates are in mm, multiply them by 0.001 (0.94 m), in cm by 0.01 (9.4 m)": the units
// in which points that extend so far would be those of a table or a room; "" where there is none.
std::string other_units(double extent_m, bool from_file, double least_m = least_table_m) {
    std::string out;
    for (const auto& [unit, unit_m, option] :
         {std::tuple("mm", 0.001, "unit_m = 0.001 (--unit mm)"),
          {"cm", 0.01, "unit_m = 0.01 (--unit cm)"},
          {"inches", 0.0254, "unit_m = 0.0254 (--unit in)"},
          {"feet", 0.3048, "unit_m = 0.3048 (--unit ft)"}}) {
        const double then_m = extent_m * unit_m;
        if (then_m < least_m || then_m > largest_room_m) continue;
        const bool first = out.empty();
        out += first ? "if the coordinates are in " : ", in ";
        out += unit;
        if (from_file)
            out.append(first ? ", say " : " ").append(option);
        else
            out.append(first ? ", multiply them by " : " by ").append(io::short_number(unit_m));
        out += " (" + io::two_digits(then_m) + " m)";
    }
    return out;
}

// The lowest and the highest; of none these are the wrong way round.
std::pair<double, double> range_of(const FloatColumn& axis) {
    double low = INFINITY, high = -INFINITY;
    for (const float value : axis) {
        low = std::min(low, double{value});
        high = std::max(high, double{value});
    }
    return {low, high};
}

}  // namespace

double extent_m(const std::array<FloatColumn, 3>& axes) {
    double extent = 0;
    for (const FloatColumn& axis : axes) {
        const auto [low, high] = range_of(axis);
        extent = std::max(extent, high - low);
    }
    return extent;
}

void check_spacing(const CloudView& cloud, double spacing_m, ScanOrigin origin) {
    if (spacing_m <= sparsest_m) return;
    const double extent = extent_m({cloud.x, cloud.y, cloud.z});
    const std::string units = other_units(extent, !in_memory(origin));
    throw Error(ErrorKind::input,
                cloud.source + ": the points extend over " + text_of(extent) + " m and are " +
                    text_of(spacing_m) + " m apart, more than the " + text_of(sparsest_m) +
                    " m at which surfaces can be found; " +
                    (units.empty() ? units : units + ", else ") + "give a denser scan");
}

void check_viewpoint_distance(const CloudView& cloud) {
    // What a scanner sees across a hall; and what was cut out of its scan lies far off, as well.
    constexpr double far_m = 30, far_sizes = 10;
    if (!cloud.has_viewpoint) return;
    double off = 0, size = 0;
    const std::array<const FloatColumn*, 3> axes{&cloud.x, &cloud.y, &cloud.z};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [low, high] = range_of(*axes[a]);
        off = std::max({off, low - cloud.viewpoint[a], cloud.viewpoint[a] - high});
        size = std::max(size, high - low);
    }
    if (off <= std::max(far_m, far_sizes * size)) return;
    throw Error(ErrorKind::input,
                cloud.source + ": its viewpoint lies " + text_of(off) +
                    " m off the points, which extend over " + text_of(size) +
                    " m: it must be in metres, in their frame; if it is in mm, multiply it by "
                    "0.001");
}

std::string large_extent_hint(double extent_m, ScanOrigin origin) {
    if (extent_m <= largest_room_m || of_frames(origin)) return {};
    const std::string units = other_units(extent_m, !in_memory(origin));
    return units.empty() ? units : "it all extends over " + text_of(extent_m) + " m: " + units;
}

std::string unit_hint(const CloudView& cloud, double spacing_m, ScanOrigin origin) {
    // What rooms and halls are thinner than, which is their height mostly; and points that nobody
    // sets out for a scan so large.
    constexpr double high_m = 5, wide_m = 0.02, least_part_m = 0.005;
    if (origin == ScanOrigin::map_file || of_frames(origin) || spacing_m <= wide_m) return {};
    const Bounds<float> bounds = bounds_of(cloud);
    double longest = 0, thinnest = INFINITY;
    for (std::size_t a = 0; a < 3; ++a) {
        const double edge = double{bounds.high[a]} - bounds.low[a];
        longest = std::max(longest, edge);
        thinnest = std::min(thinnest, edge);
    }
    if (longest <= largest_room_m && thinnest <= high_m) return {};
    const std::string units = other_units(longest, !in_memory(origin), least_part_m);
    return units.empty()
               ? units
               : "It all extends over " + text_of(longest) + " m, and " + text_of(thinnest) +
                     " m at its thinnest, more than rooms do: " + units + ".";
}

std::string small_extent_hint(double extent_m, ScanOrigin origin) {
    if (extent_m <= 0 || extent_m >= least_scan_m) return {};
    const char* check = origin == ScanOrigin::frames_folder      ? "depth_scale in intrinsics.json"
                        : origin == ScanOrigin::frames_in_memory ? "depth_scale of the intrinsics"
                        : origin == ScanOrigin::cloud_in_memory
                            ? "that the coordinates are metres, which they must be in memory"
                            : "unit_m (--unit)";
    return "it all extends over " + text_of(extent_m) + " m: check " + check;
}

void note_small_extent(double extent_m, ScanOrigin origin, std::vector<std::string>& notes) {
    std::string note = small_extent_hint(extent_m, origin);
    if (note.empty()) return;
    note[0] = 'I';
    notes.push_back(note + ".");
}

void check_camera_steps(std::span<const Vec3> places, const std::string& source) {
    constexpr double longest_step_m = 10;
    if (places.size() < 2) return;
    std::vector<double> steps;
    for (std::size_t n = 1; n < places.size(); ++n)
        steps.push_back(length(minus(places[n], places[n - 1])));
    const double step = upper_median(steps);
    if (step <= longest_step_m) return;
    throw Error(ErrorKind::input,
                source + ": the camera moves by " + text_of(step) +
                    " m from one frame to the next: places of poses are metres; if these are mm, "
                    "multiply them by 0.001" +
                    (step * 0.01 <= longest_step_m ? ", by 0.01 if cm" : ""));
}

void check_readings(const Intrinsics& k, std::size_t frames, double typical_depth_m,
                    const std::string& source, ScanOrigin origin) {
    const double pixel_m = typical_depth_m / std::max(k.fx, k.fy);
    if (!(pixel_m > sparsest_m)) return;
    throw Error(ErrorKind::input,
                source + ": " + depth_scale_hint(frames, k.depth_scale, typical_depth_m, origin) +
                    "; there its pixels are " + text_of(pixel_m) + " m apart, more than the " +
                    text_of(sparsest_m) + " m at which surfaces can be found");
}

void note_spacing(double spacing_m, std::vector<std::string>& notes) {
    // Boards of fewer distances are seen with one side or with both now here, now there; a foot of
    // fewer has a border of a few points (docs/limits.md has figures). Closer points leave open
    // what is thinner than boards of furniture.
    constexpr double thin = 2.5, narrow = 10, board_m = 0.018;
    if (thin * spacing_m <= board_m) return;
    const auto mm = [](double metres) {
        return std::to_string(static_cast<long>(std::lround(1000 * metres))) + " mm";
    };
    notes.push_back("The points are about " + mm(spacing_m) + " apart: boards thinner than " +
                    mm(thin * spacing_m) +
                    " may come out too thick or too thin, and what stands on less than " +
                    mm(narrow * spacing_m) +
                    " more or less firmly, by more than their errors say. A denser scan tells.");
}

std::string depth_scale_hint(std::size_t frames, double depth_scale, double typical_depth_m,
                             ScanOrigin origin) {
    const std::string of = io::counted(frames, "depth frame");
    if (typical_depth_m <= 0) return of + " without any reading";
    return std::string("at the depth_scale of ") +
           (origin == ScanOrigin::frames_folder ? "intrinsics.json, " : "the intrinsics, ") +
           io::short_number(depth_scale) + ", the readings of " + of + " lie about " +
           text_of(typical_depth_m) + " m away: check it (metres = stored value / depth_scale)";
}

}  // namespace topple
