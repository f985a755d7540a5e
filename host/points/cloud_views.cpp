// SPDX-License-Identifier: MIT
#include "points/cloud_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/number_text.h"
#include "core/vectors.h"
#include "io/text.h"
#include "points/frame_stream.h"
#include "points/sensor_places.h"
#include "points/virtual_views.h"

namespace topple {
namespace {

// Virtual views are drawn with surfels of so many cells, coarse enough that noise does not blur
// which side of a surface is which. But both faces of a board in one of them would have one side,
// so that they are finer where points allow it, down to half a board of that thickness, or to what
// holds two of points that are scattered at random.
constexpr double view_cells = 3, board_m = 0.02, view_pitches = 1.5;
// Gaps of this radius are no surface: of points at random, one place in 26,000 has none within 1.8
// of their mean distances, so that parts of a sixth of the density still hide what is behind them.
constexpr double gap_pitches = 4;

geometry::SurfelScale view_surfels(const geometry::PointSpacing& spacing, double cell_m) {
    const double pitch_m = spacing.around_m;
    return {std::min(view_cells * cell_m, std::max(board_m / 2, view_pitches * pitch_m)), pitch_m,
            2 * spacing.surface_m};
}

// Of the places that sensors are known to have been at, those looked from.
constexpr std::size_t most_sensors = 24;
// Of points that say where they were seen from, how many may be hidden from there: by the discs
// that surfels are drawn as, a third in a hall full of thin things; places in another frame hide
// two thirds and more.
constexpr double most_hidden = 0.5;

std::string position_text(const Vec3& p) {
    return std::string("(") + to_places(p[0], 2) + ", " + to_places(p[1], 2) + ", " +
           to_places(p[2], 2) + ")";
}

constexpr auto places_must = "places of sensors must be in the points' frame, and in metres.";

// Whether one of the places is farther outside of the surfels' box than that is long.
bool lie_far_off(const std::vector<Vec3>& places, const geometry::Surfels& surfels) {
    Vec3 low{}, high{};
    double longest = 0;
    const std::array<const std::vector<float>*, 3> axes{&surfels.x, &surfels.y, &surfels.z};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [least, most] = std::ranges::minmax(*axes[a]);
        low[a] = least;
        high[a] = most;
        longest = std::max(longest, high[a] - low[a]);
    }
    return std::ranges::any_of(places, [&](const Vec3& place) {
        double outside = 0;
        for (std::size_t a = 0; a < 3; ++a)
            outside = std::max({outside, low[a] - place[a], place[a] - high[a]});
        return outside > longest;
    });
}

// What was given, but is no place: not finite, or so far off that it is not metres.
void note_unknown(const geometry::SensorPlaces& sensors, std::size_t points,
                  std::vector<std::string>& notes) {
    if (sensors.unknown == 0) return;
    notes.push_back(
        sensors.places.empty()
            ? "The places that the points are said to have been seen from are not finite: they "
              "count as not known."
            : "Of " + io::counted(points, "point") + " " + std::to_string(sensors.unknown) +
                  (sensors.unknown == 1 ? " has" : " have") +
                  " no finite place to have been seen from: of the places of the others the "
                  "nearest one was taken.");
}

// scale, gap_m: of surfels in views.
void look_around(device::Device& device, const std::optional<geometry::SingleScan>& scan,
                 const geometry::SurfelScale& scale, double gap_m,
                 const std::function<void(double)>& tell, Observation& out) {
    geometry::VirtualViewOptions options;
    options.tell = tell;
    geometry::SensorPlaces sensors = geometry::sensor_places(out.cloud);
    const bool posed = !sensors.places.empty();
    note_unknown(sensors, out.cloud.size(), out.notes);
    std::vector<std::uint32_t> eye_of_place(sensors.places.size(), geometry::no_eye);
    if (posed) {
        options.eyes = 1;  // what no sensor saw may hold a leg, or be a thing's shadow
        for (const std::uint32_t place : geometry::places_apart(sensors, most_sensors)) {
            eye_of_place[place] = static_cast<std::uint32_t>(options.known_eyes.size());
            options.known_eyes.push_back(sensors.places[place]);
        }
    } else if (scan) {
        options.known_eyes = {scan->eye};
        options.eyes = 1;
        out.camera_up = scan->up;
        out.notes.push_back(out.cloud.has_viewpoint
                                ? "The cloud was seen from " +
                                      position_text(plus(scan->eye, out.origin_m)) + ", as it says."
                                : "The cloud has no sensor poses, but hides nothing from " +
                                      position_text(plus(scan->eye, out.origin_m)) +
                                      ": it was taken for a single scan from there.");
    } else if (out.cloud.has_viewpoint) {
        options.known_eyes = {out.cloud.viewpoint};
    }
    options.sides_known = !options.known_eyes.empty() || !out.cloud.nx.empty();
    options.gap_m = gap_m;
    const geometry::Surfels surfels = geometry::make_surfels(
        device, out.cloud, scale, posed ? sensors.places : options.known_eyes, sensors.of_point);
    if (posed) {
        options.seen_from.assign(surfels.size(), geometry::no_eye);
        for (std::size_t p = 0; p < surfels.of_point.size(); ++p)
            options.seen_from[surfels.of_point[p]] = eye_of_place[sensors.of_point[p]];
    }
    geometry::VirtualViews views = geometry::virtual_views(surfels, options, device.threads());
    if (views.frames.empty()) {
        out.notes.push_back(
            posed ? std::string("Nothing could be seen from the sensors' places that were given, "
                                "and nothing was carved: ") +
                        places_must
                  : "No free space could be seen from inside of the cloud; nothing was carved.");
        return;
    }
    if (views.hidden_share > most_hidden) {
        out.notes.push_back(std::to_string(std::lround(100 * views.hidden_share)) +
                            " % of the points would be hidden from where they are said to have "
                            "been seen from: " +
                            places_must);
    } else if (lie_far_off(options.known_eyes, surfels)) {
        out.notes.push_back(
            std::string("A sensor is said to have been farther from the points than they are "
                        "from one another: ") +
            places_must);
    }
    const std::size_t eyes = views.eyes.size();
    if (options.sides_known && options.known_eyes.empty() && !views.sides_believed) {
        leave_out_normals(out);
        out.notes.emplace_back(
            "By the normals that were given most of the surface would be seen from behind, from "
            "wherever there is room: they were left out, and the sides of surfaces estimated.");
    }
    if (posed) {
        out.viewpoints = std::move(sensors.places);
        out.viewpoint_of_point = std::move(sensors.of_point);
    } else if (scan) {
        out.viewpoints = {scan->eye};
    } else if (out.cloud.has_viewpoint) {
        out.viewpoints = {out.cloud.viewpoint};
    } else if (out.cloud.nx.empty()) {
        out.sides_guessed = true;
        out.viewpoints = std::move(views.viewpoints);
        for (const std::uint32_t s : surfels.of_point)
            out.viewpoint_of_point.push_back(views.viewpoint_of_surfel[s]);
    }
    if (!scan && !posed) {
        const std::string views_text = std::to_string(eyes) +
                                       " virtual views within it, and is less certain than from "
                                       "depth frames.";
        out.notes.push_back(
            out.cloud.has_viewpoint
                ? "From the sensor's place that was given, " +
                      position_text(plus(out.cloud.viewpoint, out.origin_m)) +
                      ", points would hide others: it is off by some centimetres, or not all of "
                      "the scan is from there. It tells the sides of surfaces, but free space was "
                      "estimated from " +
                      views_text
                : "The cloud has no sensor poses: free space was estimated from " + views_text);
    }
    out.by_sensors = scan || (posed && views.hidden_share <= most_hidden);
    out.frames = std::make_unique<MemoryStream>(views.intrinsics, std::move(views.frames));
}

}  // namespace

void look_from_free_places(device::Device& device, const std::optional<geometry::SingleScan>& scan,
                           const geometry::PointSpacing& spacing,
                           const std::function<void(double)>& tell, Observation& out) {
    look_around(device, scan, view_surfels(spacing, out.cell_m), gap_pitches * spacing.surface_m,
                tell, out);
}

void look_from_free_places(device::Device& device, Observation& out) {
    look_around(device, std::nullopt, view_cells * out.cell_m, gap_pitches * out.cell_m, {}, out);
}

}  // namespace topple
