// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "api/arrays.h"
#include "core/number_options.h"
#include "core/ranked.h"
#include "core/room_measures.h"
#include "geometry/surfels.h"
#include "io/text.h"
#include "points/caller_points.h"
#include "points/scale_checks.h"
#include "points/sensor_places.h"
#include "vdb/completion.h"
#include "vdb/voxel_scene.h"

namespace topple::stages {
namespace {

// The points that can be worked with, in the caller's memory or copied.
class Usable {
  public:
    explicit Usable(const CloudView& cloud) : view_(cloud) {
        if (view_.source.empty()) view_.source = "cloud";
        if ((finite_ = finite_points(view_))) view_ = finite_->cloud;
    }
    const CloudView& view() const { return view_; }
    // Where the point lies in the caller's arrays.
    std::size_t place(std::size_t i) const { return finite_ ? finite_->index[i] : i; }

  private:
    CloudView view_;
    std::optional<FinitePoints> finite_;
};

constexpr double large_m = 30;  // of rooms; the spacing of their points need not be measured

// Who gives millimetres for metres would get nothing but cells of one point each. cell_m: into
// which the points are sorted; what they are further apart than shows no surface.
void check_metres(const CloudView& view, double cell_m) {
    if (extent_m({view.x, view.y, view.z}) <= large_m) return;
    const double spacing_m = geometry::point_spacing(view).nearest_m;
    if (spacing_m > cell_m) check_spacing(view, spacing_m, ScanOrigin::cloud_in_memory);
}

// Where the sensor that saw each point was, as far as that is known.
geometry::SensorPlaces eyes_of(const CloudView& view, const Vec3* eye_m) {
    if (eye_m) return {{*eye_m}, {}};
    geometry::SensorPlaces out = geometry::sensor_places(view);
    if (out.places.empty() && view.has_viewpoint) out.places = {view.viewpoint};
    return out;
}

// Frames are copied in batches of this many bytes of depth.
constexpr std::uint64_t batch_bytes = 16u << 20;

// Buildings stay below this; rooms in millimetres start above, and no depth camera reads so far.
constexpr double farthest_apart_m = 300;

double beyond_box_m(const std::array<Vec3, 2>& box, const Vec3& at) {
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const double off = std::max({0.0, box[0][a] - at[a], at[a] - box[1][a]});
        square += off * off;
    }
    return std::sqrt(square);
}

std::array<Vec3, 2> box_around(const CloudView& cloud) {
    std::array<Vec3, 2> box{};
    if (cloud.size() == 0) return box;
    const std::array<const FloatColumn*, 3> axes{&cloud.x, &cloud.y, &cloud.z};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [low, high] = std::minmax_element(axes[a]->begin(), axes[a]->end());
        box[0][a] = *low;
        box[1][a] = *high;
    }
    return box;
}

// Cameras in another unit than the points see nothing of them, and readings in another carve all.
void check_cameras(const std::array<Vec3, 2>& box, const Intrinsics& intrinsics,
                   std::span<const DepthView> frames) {
    std::vector<Vec3> places;
    std::vector<double> beyond, readings;
    for (const DepthView& frame : frames) {
        const Mat4& pose = frame.camera_to_world;
        places.push_back({pose[3], pose[7], pose[11]});
        beyond.push_back(beyond_box_m(box, places.back()));
        for (std::size_t i = 0; i < frame.depth.size(); i += 37)
            if (frame.depth[i] > 0) readings.push_back(frame.depth[i] / intrinsics.depth_scale);
    }
    check_camera_steps(places, "carve");
    if (const double off = upper_median(beyond); off > farthest_apart_m)
        throw Error(ErrorKind::input,
                    "carve: the cameras are " + io::short_number(off) +
                        " m from the points: places of poses are metres, in the points' frame; if "
                        "these are mm, multiply them by 0.001");
    if (const double typical = upper_median(readings); typical > farthest_apart_m)
        throw Error(ErrorKind::input,
                    "carve: " + depth_scale_hint(frames.size(), intrinsics.depth_scale, typical,
                                                 ScanOrigin::frames_in_memory));
}

}  // namespace

double point_spacing(const CloudView& cloud) {
    const Usable usable(cloud);
    const double spacing_m = geometry::point_spacing(usable.view()).nearest_m;
    const CloudView& view = usable.view();
    if (extent_m({view.x, view.y, view.z}) > large_m)
        check_spacing(view, spacing_m, ScanOrigin::cloud_in_memory);
    return spacing_m;
}

void normals(device::Device& device, const CloudView& cloud, double cell_m, const Vec3* eye_m,
             std::span<float> nx, std::span<float> ny, std::span<float> nz) {
    const device::InUse in_use(device);
    for (const std::span<float>& out : {nx, ny, nz}) {
        require(out.size() == cloud.size(), "normals",
                std::to_string(out.size()) + " values of output for " +
                    std::to_string(cloud.size()) + " points");
    }
    require(cell_m > 0 && cell_m <= largest_voxel_m, "normals",
            "cell_m " + io::short_number(cell_m) + ": expected metres above 0 and at most " +
                io::short_number(largest_voxel_m) + ", about twice the points' spacing");
    for (int axis = 0; eye_m && axis < 3; ++axis) {
        require(std::abs((*eye_m)[axis]) <= farthest_m, "normals",
                "eye_m " + io::short_number((*eye_m)[axis]) + ": expected metres up to " +
                    io::short_number(farthest_m));
    }
    const Usable usable(cloud);
    check_metres(usable.view(), cell_m);
    const geometry::SensorPlaces eyes = eyes_of(usable.view(), eye_m);
    const geometry::Surfels s =
        geometry::make_surfels(device, usable.view(), cell_m, eyes.places, eyes.of_point);
    if (usable.view().size() < cloud.size()) {
        for (const std::span<float>& out : {nx, ny, nz}) std::fill(out.begin(), out.end(), 0.0f);
    }
    for (std::size_t i = 0; i < s.of_point.size(); ++i) {
        const std::size_t at = usable.place(i);
        nx[at] = s.nx[s.of_point[i]];
        ny[at] = s.ny[s.of_point[i]];
        nz[at] = s.nz[s.of_point[i]];
    }
}

Volume::Volume(const CloudView& cloud, std::span<const std::int32_t> label, double voxel_m) {
    require(
        label.size() == cloud.size(), "Volume",
        std::to_string(label.size()) + " labels for " + std::to_string(cloud.size()) + " points");
    require(voxel_m >= least_voxel_m && voxel_m <= largest_voxel_m, "Volume",
            "voxel_m " + io::short_number(voxel_m) + ": expected metres from " +
                io::short_number(least_voxel_m) + " to " + io::short_number(largest_voxel_m));
    const Usable usable(cloud);
    check_metres(usable.view(), voxel_m);
    box_m_ = box_around(usable.view());
    std::vector<std::int32_t> kept;
    for (std::size_t i = 0; i < usable.view().size(); ++i) {
        kept.push_back(label[usable.place(i)]);
        // The kernels keep labels in 16 bits beside three states.
        constexpr std::int32_t most = 64998;
        require(kept.back() >= -1 && kept.back() <= most, "Volume",
                "a label of " + std::to_string(kept.back()) + ": they count from 0 to " +
                    std::to_string(most) + ", or are -1");
        labels_ = std::max(labels_, kept.back() + 1);
    }
    vdb::VoxelFrame frame;
    frame.voxel_m = voxel_m;
    scene_ = std::make_unique<vdb::VoxelScene>(frame, usable.view(), kept);
}
Volume::~Volume() = default;
Volume::Volume(Volume&&) noexcept = default;
Volume& Volume::operator=(Volume&&) noexcept = default;

void Volume::carve(device::Device& device, const Intrinsics& intrinsics,
                   std::span<const DepthView> frames) {
    const device::InUse in_use(device);
    const std::uint64_t pixels = std::uint64_t{intrinsics.width} * intrinsics.height;
    std::vector<DepthFrame> batch;
    for (std::size_t f = 0; f < frames.size(); ++f)
        require(frames[f].depth.size() == pixels, "carve",
                "frame " + std::to_string(f) + " has " + std::to_string(frames[f].depth.size()) +
                    " pixels, not " + std::to_string(pixels));
    check_cameras(box_m_, intrinsics, frames);
    for (std::size_t f = 0; f < frames.size(); ++f) {
        batch.push_back(
            {{frames[f].depth.begin(), frames[f].depth.end()}, frames[f].camera_to_world});
        if (f + 1 < frames.size() && batch.size() < 64 && batch.size() * pixels * 2 < batch_bytes)
            continue;
        scene_->carve(device, intrinsics, batch);
        batch.clear();
    }
}

std::uint64_t Volume::fill(device::Device& device, unsigned votes,
                           std::span<const std::int32_t> hollow) {
    const device::InUse in_use(device);
    require(votes >= 1 && votes <= 6, "fill", std::to_string(votes) + " votes: from 1 to 6");
    vdb::FillOptions options;
    options.votes = votes;
    options.roles.assign(static_cast<std::size_t>(labels_), Role::none);
    for (const std::int32_t label : hollow) {
        require(
            label >= 0 && label < labels_, "fill",
            "hollow label " + std::to_string(label) + " is none of the " + std::to_string(labels_));
        options.roles[label] = Role::wall;
    }
    return vdb::fill(device, *scene_, options);
}

int Volume::state_at(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<int>(scene_->state_at(i, j, k));
}

Voxels Volume::solid() const {
    SolidCells cells = scene_->solid_cells();
    Voxels out;
    for (const Basis b : cells.basis)
        out.state.push_back(static_cast<std::uint8_t>(b == Basis::surface ? vdb::State::surface
                                                                          : vdb::State::completed));
    out.i = std::move(cells.i);
    out.j = std::move(cells.j);
    out.k = std::move(cells.k);
    out.label = std::move(cells.primitive);
    return out;
}

}  // namespace topple::stages
