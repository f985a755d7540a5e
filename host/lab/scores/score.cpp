// SPDX-License-Identifier: MIT
#include "lab/scores/score.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/thread_pool.h"
#include "lab/solids/ray_caster.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

constexpr double nearest_m = 0.05;
constexpr double cut_cell_m = 0.02;

void check(const Scene& parse) {
    const ScenePoints& points = parse.points;
    const std::size_t n = points.x.size();
    if (n == 0 || points.primitive.size() != n || points.object.size() != n ||
        !(parse.voxel_size_m > 0)) {
        throw Error(ErrorKind::input,
                    "score: the parse has " + std::to_string(n) + " points, labels of " +
                        std::to_string(points.primitive.size()) + " and voxels of " +
                        std::to_string(parse.voxel_size_m) + " m");
    }
}

}  // namespace

std::vector<std::int32_t> true_parts(const World& truth, const ScenePoints& points) {
    const RayCaster parts(truth.parts);
    std::vector<std::int32_t> label(points.x.size(), -1);
    ThreadPool(0).each(label.size(), 256, [&](std::size_t n) {
        const Vec3 p = truth.to_room({points.x[n], points.y[n], points.z[n]});
        double best = nearest_m;
        parts.each_near(p, nearest_m, [&](std::int32_t part, double distance) {
            const double d = std::abs(distance);
            if (d > best || d >= nearest_m || (d == best && part > label[n])) return;
            best = d;
            label[n] = part;
        });
    });
    return label;
}

std::vector<std::int32_t> true_objects(const World& truth, const std::vector<std::int32_t>& part) {
    std::vector<std::int32_t> object;
    for (const std::int32_t p : part) object.push_back(p < 0 ? -1 : truth.parts[p].object);
    return object;
}

SegmentationScore segmentation_score(const ScenePoints& points, std::span<const std::int32_t> truth,
                                     std::span<const std::int32_t> predicted) {
    SegmentationScore out = segmentation_score(truth, predicted);
    out.cut_discrepancy =
        cut_discrepancy({points.x, points.y, points.z}, truth, predicted, cut_cell_m);
    return out;
}

double gravity_error_deg(const World& truth, const Scene& parse) {
    const Vec3 a = truth.to_input({0, 0, 1}), &b = parse.up;
    const double cosine = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / std::hypot(b[0], b[1], b[2]);
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

Score score(const World& truth, const Scene& parse) {
    check(parse);
    const ScenePoints& points = parse.points;
    const auto part = true_parts(truth, points);
    Score out;
    out.parts = segmentation_score(points, part, points.primitive);
    out.objects = segmentation_score(points, true_objects(truth, part), points.object);
    out.volume = volume_score(truth, parse.solid, parse.voxel_size_m);
    out.relations = relation_score(truth, parse, part);
    out.gravity_deg = gravity_error_deg(truth, parse);
    return out;
}

}  // namespace topple::scenes
