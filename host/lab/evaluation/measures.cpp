// SPDX-License-Identifier: MIT
#include "lab/evaluation/measures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/ranked.h"
#include "core/vectors.h"
#include "lab/evaluation/text.h"
#include "lab/scan/depth_camera.h"
#include "lab/temporary_folder.h"
#include "physics/hull_landscape.h"
#include "physics/landscape.h"

namespace topple::evaluation {
namespace {

// How far points of a scan may lie off the shape that they are of.
constexpr double reach_m = 0.02;

double distance(const scenes::World& world, std::int32_t object, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const scenes::Part& part : world.parts)
        if (part.object == object) least = std::min(least, std::abs(part.distance(p)));
    return least;
}

// Of each found object, the points that are the shape's, and all.
const Object* find_object(const scenes::World& world, const Scene& scene) {
    std::map<std::int32_t, std::size_t> of_shape, all;
    std::size_t points = 0;
    for (std::size_t n = 0; n < scene.points.x.size(); ++n) {
        const std::int32_t object = scene.points.object[n];
        const Vec3 p = world.to_room({scene.points.x[n], scene.points.y[n], scene.points.z[n]});
        const double off = distance(world, scenes::measured_object, p);
        bool shape = off < reach_m;
        for (std::int32_t other = 0; shape && other < 3; ++other)
            shape = other == scenes::measured_object || distance(world, other, p) > off;
        points += shape;
        ++all[object];
        if (shape) ++of_shape[object];
    }
    const Object* best = nullptr;
    for (const Object& o : scene.objects) {
        if (o.grounded || 2 * of_shape[o.id] < points || 2 * of_shape[o.id] < all[o.id]) continue;
        best = &o;
    }
    return best;
}

ParseResult scan_and_parse(const scenes::World& world, const MeasureOptions& options) {
    if (!options.frames)
        return parse(scenes::clean_points(world, options.spacing_m), options.parse);
    scenes::CameraOptions camera;
    camera.seed = world.seed;
    const scenes::TemporaryFolder folder("topple_measure");
    scenes::write_sequence(folder.path(), world,
                           scenes::film(world, camera, scenes::poses_around(world, camera.frames)));
    return parse(folder.path(), options.parse);
}

double share_within(const std::vector<double>& values, double middle, double most) {
    const auto in =
        std::ranges::count_if(values, [&](double v) { return std::abs(v - middle) <= most; });
    return values.empty() ? MeasureScore::none
                          : static_cast<double>(in) / static_cast<double>(values.size());
}

void add_spread(const std::vector<double>& ratios, const char* name, std::string& text) {
    std::vector<double> off;
    for (const double r : ratios) off.push_back(std::abs(r - 1));
    append(text, "  %-8s median off by %s, mean bias %+.1f %%, within 6 %%: %s, 15 %%: %s\n", name,
           percent(off.empty() ? MeasureScore::none : upper_median(off)).c_str(),
           100 * (mean(ratios) - 1), percent(share_within(ratios, 1, 0.06)).c_str(),
           percent(share_within(ratios, 1, 0.15)).c_str());
}

void add_sigmas(const std::vector<double>& sigmas, const char* name, std::string& text) {
    append(text, "  %-8s within one standard error: %s, within two: %s\n", name,
           percent(share_within(sigmas, 0, 1)).c_str(),
           percent(share_within(sigmas, 0, 2)).c_str());
}

}  // namespace

TrueMeasures true_measures(const scenes::World& world, std::int32_t object, double density_kg_m3) {
    TrueMeasures out;
    for (const scenes::Part& part : world.parts) {
        if (part.object != object) continue;
        const double mass = density_kg_m3 * part.volume();
        const Vec3 center = part.center_of_mass();
        out.mass_kg += mass;
        for (std::size_t a = 0; a < 3; ++a) out.center_of_mass_m[a] += mass * center[a];
    }
    for (double& a : out.center_of_mass_m) a /= out.mass_kg;
    // So that the side of a round body is one pose.
    const physics::HullLandscape landscape = physics::hull_landscape(
        scenes::hull_points(world, object), out.center_of_mass_m, {.resolution_m = 1e-5});
    out.barrier_J = out.mass_kg * physics::gravity * landscape.poses[landscape.now].barrier_m;
    return out;
}

MeasureScore measure(const scenes::MeasuredShape& shape, std::uint64_t seed,
                     const MeasureOptions& options) {
    const scenes::World world = scenes::measured_world(shape, seed);
    const TrueMeasures truth =
        true_measures(world, scenes::measured_object, options.parse.density_kg_m3);
    MeasureScore out;
    out.name = shape.name;
    out.seed = seed;
    const Scene scene = scan_and_parse(world, options).scene;
    for (const auto& [stage, seconds] : scene.timings_s) out.parse_s += seconds;
    const Object* found = find_object(world, scene);
    if (!found) return out;
    out.mass = found->mass_kg / truth.mass_kg;
    out.barrier = found->barrier_J / truth.barrier_J;
    out.mass_sigmas = (found->mass_kg - truth.mass_kg) / found->mass_error_kg;
    out.barrier_sigmas = (found->barrier_J - truth.barrier_J) / found->barrier_error_J;
    const Vec3 center = world.to_room(found->center_of_mass_m);
    const Vec3 off = minus(center, truth.center_of_mass_m);
    out.center_m = std::hypot(off[0], off[1], off[2]);
    for (std::size_t a = 0; a < 3; ++a) {
        Vec3 along = found->center_of_mass_m;
        along[a] += 1;
        const Vec3 axis = minus(world.to_room(along), center);
        out.center_sigmas[a] = dot(off, axis) / found->center_of_mass_error_m[a];
    }
    return out;
}

std::string measures_table(const std::vector<MeasureScore>& scores) {
    std::string text =
        "Mass and barrier over the true ones, means over places; how far the centre of mass is "
        "off\n";
    append(text, "  %-28s %6s %8s %8s %8s\n", "", "found", "mass", "barrier", "off, mm");
    std::vector<std::string> names;
    for (const MeasureScore& s : scores)
        if (std::ranges::find(names, s.name) == names.end()) names.push_back(s.name);
    for (const std::string& name : names) {
        const auto mine = scores_of(scores, &MeasureScore::name, name);
        const auto mass = known(mine, &MeasureScore::mass);
        append(text, "  %-28s %3zu/%-2zu %8.3f %8.3f %8.1f\n", name.c_str(), mass.size(),
               mine.size(), mean(mass), mean(known(mine, &MeasureScore::barrier)),
               1000 * mean(known(mine, &MeasureScore::center_m)));
    }
    add_spread(known(scores, &MeasureScore::mass), "mass", text);
    add_spread(known(scores, &MeasureScore::barrier), "barrier", text);
    add_sigmas(known(scores, &MeasureScore::mass_sigmas), "mass", text);
    std::vector<double> centers;
    for (const MeasureScore& s : scores)
        for (const double v : s.center_sigmas)
            if (std::isfinite(v)) centers.push_back(v);
    add_sigmas(centers, "center", text);
    add_sigmas(known(scores, &MeasureScore::barrier_sigmas), "barrier", text);
    return text;
}

std::string measures_csv(const std::vector<MeasureScore>& scores) {
    std::string text =
        "name,seed,mass,barrier,center_m,mass_sigmas,center_sigmas_x,center_sigmas_y,center_sigmas_"
        "z,barrier_sigmas,parse_s\n";
    for (const MeasureScore& s : scores) {
        append(text, "%s,%llu,%.5f,%.5f,%.5f,%.3f,%.3f,%.3f,%.3f,%.3f,%.2f\n", s.name.c_str(),
               static_cast<unsigned long long>(s.seed), s.mass, s.barrier, s.center_m,
               s.mass_sigmas, s.center_sigmas[0], s.center_sigmas[1], s.center_sigmas[2],
               s.barrier_sigmas, s.parse_s);
    }
    return text;
}

}  // namespace topple::evaluation
