// SPDX-License-Identifier: MIT
#include "geometry/shell.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/room_measures.h"
#include "fitted/boosted_trees.h"
#include "geometry/primitive_shapes.h"
#include "geometry/shell_features.h"
#include "geometry/sight_lines.h"
#include "geometry/upright_box.h"

namespace topple::geometry {
namespace {

// What is flat has normals whose mean is no shorter, and a wall even: a cupboard's front and one of
// its sides are none, and are filled, while the floor of a coarse scan is rough. What is level is
// no more than 45 degrees from it; and a floor no higher above the lowest than a platform is, or as
// large as that of a room, a gallery.
constexpr double flat_face = 0.7, wall_face = 0.9, level_cos = 0.7, platform_m = 0.5;

// A box that stands by itself is the room's, as a kitchen's island is, no oftener than this; the
// model was fitted on rooms that have few such things, and takes large ones for walls.
constexpr double box_shell = 0.1;

Role role_of_shape(const PrimitiveShape& p, double floor_m, double top_m) {
    const double level = p.face()[2];
    if (p.normal.norm() < flat_face) return Role::fixture;
    if (std::abs(level) < level_cos)
        return p.normal.norm() < wall_face ? Role::fixture : Role::wall;
    const double height = p.center[2] - floor_m;
    // Of a sheet whose sides are confused, the nearer end of the room tells.
    if (level < 0 && top_m - p.center[2] < height) return Role::ceiling;
    if (height < platform_m || (level > 0 && p.area_m2 >= least_floor_m2)) return Role::floor;
    return Role::fixture;
}

void judge(const SurfaceSamples& samples, const StoreyHint& storey, ThreadPool& threads,
           Shell& out) {
    PrimitiveShapes shapes = primitive_shapes(samples, out.log_odds.size());
    if (std::isfinite(storey.floor_m)) shapes.low[2] = storey.floor_m;
    const std::vector<float> rows = shell_features(samples, shapes, SightLines(samples), threads);
    const fitted::BoostedTrees& model = fitted::shell_model(shell_feature_names());
    const std::size_t width = shell_feature_names().size();
    threads.each(shapes.of.size(), 16, [&](std::size_t p) {
        const double height = shapes.of[p].center[2];
        if (shapes.of[p].samples() == 0 || height < storey.below_m || height >= storey.top_m)
            return;
        const auto row = std::span(rows).subspan(p * width, width);
        double shell = fitted::probability(model.log_odds(row));
        if (is_upright_box(samples, shapes.of[p], shapes.low[2]))
            shell = std::min(shell, box_shell);
        out.log_odds[p] = fitted::log_odds(shell);
        if (out.log_odds[p] > 0)
            out.role[p] = role_of_shape(shapes.of[p], shapes.low[2], shapes.high[2]);
    });
}

}  // namespace

Shell find_shell(const SurfaceSamples& samples, std::size_t primitives, ThreadPool& threads,
                 std::span<const StoreyHint> storeys) {
    Shell out;
    out.log_odds.assign(primitives, fitted::log_odds(0));
    out.role.assign(primitives, Role::none);
    constexpr StoreyHint all{.floor_m = std::numeric_limits<double>::quiet_NaN()};
    if (storeys.empty()) judge(samples, all, threads, out);
    for (const StoreyHint& storey : storeys) {
        const bool whole = std::isinf(storey.below_m) && std::isinf(storey.top_m);
        judge(whole ? samples
                    : samples_where(samples,
                                    [&](std::size_t n) {
                                        return samples.z[n] >= storey.below_m &&
                                               samples.z[n] < storey.top_m;
                                    }),
              storey, threads, out);
    }
    return out;
}

}  // namespace topple::geometry
