// SPDX-License-Identifier: MIT
#include "geometry/building.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/room_measures.h"
#include "core/vectors.h"
#include "geometry/storeys.h"

namespace topple::geometry {
namespace {

constexpr double histogram_step_m = 0.025;
// A kilometre of steps: no building is higher.
constexpr double most_height_m = 1000;
// A storey's floor lies within this much of its height.
constexpr double floor_off_m = 0.1;
constexpr double horizontal_cos = 0.9;  // within 26 degrees of up: allows for noisy normals
constexpr double vertical_sin = 0.3;    // within 17 degrees of level
constexpr double flat = 0.85;           // of a plane, the least length of the mean normal
// In maps of thin walls and floors, cells behind the surface are free where the sensor erred. Share
// of a plane's surfels that may face the other way, and how even the plane must be but for those.
constexpr double most_against = 0.25, even_sheet = 0.95;
// A smaller plane bounds no room.
constexpr double least_ceiling_m2 = 0.3;
// A wall's two faces: how thin and how thick it is, how well they look away from each other, the
// widest door between them, and the area of each where they end so little below a ceiling; without
// one, where a shelf between two parts of a room may be as high, more.
constexpr double thinnest_wall_m = 0.03, thickest_wall_m = 0.5, opposite_cos = 0.97, door_m = 1.5;
constexpr double below_ceiling_m = 0.2, wall_m2 = 3, open_wall_m2 = 6, open_wall_m = 2.2;

Vec3 normal_of(const Surfels& s, std::size_t n) {
    return {s.nx[n], s.ny[n], s.nz[n]};
}
Vec3 place_of(const Surfels& s, std::size_t n) {
    return {s.x[n], s.y[n], s.z[n]};
}

std::vector<Storey> storeys_of(const Surfels& s, const Vec3& up) {
    double low = INFINITY, high = -INFINITY;
    const auto height = [&](std::size_t n) { return dot(up, place_of(s, n)); };
    for (std::size_t n = 0; n < s.size(); ++n) {
        low = std::min(low, height(n));
        high = std::max(high, height(n));
    }
    // Without a surfel it is negative.
    if (!(high - low >= 0 && high - low <= most_height_m))
        return find_storeys({}, 0, histogram_step_m);
    std::vector<double> area(static_cast<std::size_t>((high - low) / histogram_step_m) + 1, 0.0);
    for (std::size_t n = 0; n < s.size(); ++n)
        area[(height(n) - low) / histogram_step_m] += s.area_m2;
    return find_storeys(area, low, histogram_step_m);
}

// Area-weighted mean plane of one region: normal, point, and how much of it agrees.
struct MeanPlane {
    double area_m2 = 0;  // of all its surfels
    Vec3 normal{}, point{};
    double flatness = 0;  // length of the mean normal: 1 for a plane, less for a box
    // The same where each normal counts by its axis: of a sheet of which both sides were seen it is
    // 1, too. The share of the surfels that face against the rest.
    double sheetness = 0, against = 0;
    double lowest_m = INFINITY, highest_m = -INFINITY;  // along up
    double from_m = INFINITY, to_m = -INFINITY;         // along level_axis()
    // A plane with one side, or so even a sheet that the few surfels against it only have their
    // sides confused.
    bool is_plane() const {
        return flatness > flat || (sheetness > even_sheet && against < most_against);
    }
    // Level, along an upright face.
    Vec3 level_axis(const Vec3& up) const { return unit_or_zero(cross(up, normal)); }
};

// The normals of each plane become unit means, of what was seen from both sides those along its
// axis.
void find_normals(const Surfels& s, const std::vector<std::int32_t>& label,
                  std::vector<MeanPlane>& planes) {
    using Eigen::Vector3d;
    const auto normal = [&](std::size_t n) { return Vector3d(s.nx[n], s.ny[n], s.nz[n]); };
    const auto sum_of = [](const MeanPlane& p) { return Vector3d(p.normal.data()); };
    std::vector<Eigen::Matrix3d> moment(planes.size(), Eigen::Matrix3d::Zero());
    for (std::size_t n = 0; n < s.size(); ++n)
        if (label[n] >= 0) moment[label[n]] += normal(n) * normal(n).transpose();
    std::vector<Vector3d> axis(planes.size()), folded(planes.size(), Vector3d::Zero());
    for (std::size_t k = 0; k < planes.size(); ++k) {
        axis[k] = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moment[k]).eigenvectors().col(2);
        if (axis[k].dot(sum_of(planes[k])) < 0) axis[k] = -axis[k];
    }
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] < 0) continue;
        const auto k = static_cast<std::size_t>(label[n]);
        const bool against = normal(n).dot(axis[k]) < 0;
        folded[k] += against ? -normal(n) : normal(n);
        planes[k].against += against;
    }
    for (std::size_t k = 0; k < planes.size(); ++k) {
        MeanPlane& p = planes[k];
        const double surfels = std::max(1.0, p.area_m2 / s.area_m2);
        p.flatness = sum_of(p).norm() / surfels;
        p.sheetness = folded[k].norm() / surfels;
        p.against /= surfels;
        const bool two_sided = p.flatness <= flat && p.sheetness > flat;
        Eigen::Map<Vector3d>(p.normal.data()) =
            (two_sided ? folded[k] : sum_of(p)).normalized().eval();
        for (double& v : p.point) v /= surfels;
    }
}

std::vector<MeanPlane> mean_planes(const Surfels& s, const std::vector<std::int32_t>& label,
                                   std::size_t count, const Vec3& up) {
    std::vector<MeanPlane> out(count);
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] < 0) continue;
        MeanPlane& p = out[label[n]];
        p.area_m2 += s.area_m2;
        p.normal = along(p.normal, 1, normal_of(s, n));
        p.point = along(p.point, 1, place_of(s, n));
        const double height = dot(up, place_of(s, n));
        p.lowest_m = std::min(p.lowest_m, height);
        p.highest_m = std::max(p.highest_m, height);
    }
    find_normals(s, label, out);
    std::vector<Vec3> axis;
    for (const MeanPlane& p : out) axis.push_back(p.level_axis(up));
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] < 0) continue;
        const double along = dot(axis[label[n]], place_of(s, n));
        MeanPlane& p = out[label[n]];
        p.from_m = std::min(p.from_m, along);
        p.to_m = std::max(p.to_m, along);
    }
    return out;
}

bool has_floor(const std::vector<MeanPlane>& planes, const Vec3& up, const Storey& storey) {
    double area = 0;
    for (const MeanPlane& p : planes) {
        if (p.is_plane() && dot(up, p.normal) > horizontal_cos &&
            std::abs(dot(up, p.point) - storey.floor_m) < floor_off_m)
            area += p.area_m2;
    }
    return area >= least_floor_m2;
}

// Of the highest large plane that looks down from above a person's head, but below the storey's
// top; infinite where there is none.
double ceiling_height(const std::vector<MeanPlane>& planes, const Vec3& up,
                      const StoreyHint& storey) {
    double height = -INFINITY;
    for (const MeanPlane& p : planes) {
        if (dot(up, p.normal) < -horizontal_cos && p.area_m2 >= least_ceiling_m2 &&
            p.lowest_m - storey.floor_m >= lowest_room_m && p.highest_m < storey.top_m)
            height = std::max({height, p.lowest_m, dot(up, p.point) - below_ceiling_m});
    }
    return std::isfinite(height) ? height : INFINITY;
}

// Upright planes that may be a wall's faces.
std::vector<MeanPlane> find_sides(const std::vector<MeanPlane>& planes, const Vec3& up,
                                  const StoreyHint& storey) {
    const double ceiling = ceiling_height(planes, up, storey);
    std::vector<MeanPlane> out;
    for (const MeanPlane& p : planes) {
        const bool high =
            std::isfinite(ceiling)
                ? p.area_m2 >= wall_m2 && p.highest_m >= ceiling - below_ceiling_m
                : p.area_m2 >= open_wall_m2 && p.highest_m - p.lowest_m >= open_wall_m;
        if (high && p.is_plane() && std::abs(dot(up, p.normal)) < vertical_sin) out.push_back(p);
    }
    return out;
}

bool is_wall(const MeanPlane& a, const MeanPlane& b) {
    if (dot(a.normal, b.normal) > -opposite_cos) return false;
    const double thick = -dot(minus(b.point, a.point), a.normal);
    if (thick < thinnest_wall_m || thick > thickest_wall_m) return false;
    // Their axes look away from each other, too.
    return std::max(a.from_m, -b.to_m) - std::min(a.to_m, -b.from_m) <= door_m;
}

bool has_inner_wall(const std::vector<MeanPlane>& planes, const Vec3& up,
                    const StoreyHint& storey) {
    const std::vector<MeanPlane> sides = find_sides(planes, up, storey);
    for (std::size_t a = 0; a < sides.size(); ++a) {
        for (std::size_t b = a + 1; b < sides.size(); ++b)
            if (is_wall(sides[a], sides[b])) return true;
    }
    return false;
}

}  // namespace

std::vector<StoreyHint> find_building(const Surfels& surfels, const PrimitiveSet& primitives,
                                      const Vec3& up) {
    if (surfels.size() == 0) return {};
    const Regions& regions = primitives.faces;
    const std::vector<MeanPlane> planes =
        mean_planes(surfels, regions.label, regions.regions.size(), up);
    std::vector<StoreyHint> out;
    for (const Storey& storey : storeys_of(surfels, up)) {
        // A slab without a floor on it ends no storey: a suspended ceiling, the tops of cupboards.
        if (!has_floor(planes, up, storey)) continue;
        if (!out.empty()) out.back().top_m = storey.below_m;
        out.push_back({storey.floor_m,
                       out.empty() ? -std::numeric_limits<double>::infinity() : storey.below_m});
    }
    if (out.size() == 1 && !has_inner_wall(planes, up, out.front())) out.clear();
    return out;
}

}  // namespace topple::geometry
