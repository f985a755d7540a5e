// SPDX-License-Identifier: MIT
// topple_features SCAN OUT: what the fitted models see of a scan, for fit.py. Writes into the
// folder OUT: table.json (names, counts, axes), and arrays of little-endian numbers: nodes.f32,
// pairs.i32, joints.f32, log_odds.f32 (of the joints' own model, with and without colours),
// judged.f32 and judged_shell.f32 (log-odds that grouping starts from), samples.f32 (x y z, grid
// frame) and primitive.i32.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "device/stage_clock.h"
#include "fitted/boosted_trees.h"
#include "geometry/primitive_shapes.h"
#include "geometry/shell_features.h"
#include "geometry/sight_lines.h"
#include "geometry/surface_samples.h"
#include "graph/joint_features.h"
#include "objects/object_stage.h"
#include "physics/closed_furniture.h"
#include "points/observation.h"
#include "points/voxel_size.h"
#include "solids/find_solids.h"
#include "solids/solid_parts.h"
#include "topple/error.h"
#include "topple/kernels/device.h"

namespace {

using namespace topple;

template <class T>
void write(const std::filesystem::path& file, const std::vector<T>& values) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(T)));
    out.close();
    if (!out) throw Error(ErrorKind::input, file.string() + ": can't be written");
}

// Of each joint by the fitted model, with what its colours tell and without.
std::vector<float> log_odds(std::vector<float> rows) {
    const auto names = graph::joint_feature_names();
    const fitted::BoostedTrees& model = fitted::joint_model(names);
    std::vector<float> out;
    for (std::size_t at = 0; at < rows.size(); at += names.size()) {
        const std::span row = std::span(rows).subspan(at, names.size());
        const auto add = [&] {
            const double p = fitted::probability(model.log_odds(row));
            out.push_back(static_cast<float>(fitted::log_odds(p)));
        };
        add();
        for (std::size_t k = 0; k < names.size(); ++k)
            if (names[k].find("colour") != std::string_view::npos) row[k] = NAN;
        add();
    }
    return out;
}

// What tells closed furniture, of each object that can move: height, fill, backing; and the object
// of each primitive, -1 for the room.
void write_objects(device::Device& device, SolidParts parts, const ParseOptions& options,
                   StageClock& stage, const std::filesystem::path& folder) {
    const ObjectStage found = find_objects(device, options, stage, parts);
    std::vector<double> volume;
    for (const Body& o : found.objects) volume.push_back(o.candidate.body.volume_m3);
    std::vector<std::int32_t> object = found.object_of_primitive;
    std::vector<float> rows;
    for (const physics::FurnitureLooks& looks :
         physics::furniture_looks(*parts.solids, object, volume))
        for (const double v : {looks.height_m, looks.fill, looks.backing})
            rows.push_back(static_cast<float>(v));
    for (std::int32_t& o : object)
        if (found.objects[o].grounded) o = -1;
    write(folder / "looks.f32", rows);
    write(folder / "object.i32", object);
}

void run(const std::filesystem::path& scan, const std::filesystem::path& folder) {
    const auto device = device::open_device("native");
    ParseOptions options;
    std::vector<std::pair<std::string, double>> timings;
    StageClock stage(timings, options);
    Observation input = observe(*device, scan, options);
    const double voxel_m = voxel_for_input(input, options);
    const auto [geometry, voxels] = find_solids(*device, input, voxel_m, options, stage);
    const SolidParts parts = solid_parts(geometry, voxels);
    const PartStage weighed = weigh_parts(*device, parts, options, stage);
    const geometry::SurfaceSamples& samples = parts.samples;
    const geometry::PrimitiveShapes shapes =
        geometry::primitive_shapes(samples, parts.model.size());
    const std::vector<float> nodes =
        geometry::shell_features(samples, shapes, geometry::SightLines(samples), device->threads());
    std::vector<float> shell;
    for (const double odds : parts.shell_log_odds)
        shell.push_back(static_cast<float>(fitted::probability(odds)));
    const graph::JointTable joints = graph::joint_features(
        samples, shapes, weighed.contacts, weighed.bodies, parts.seams, shell, device->threads());
    std::filesystem::create_directories(folder);
    std::vector<std::int32_t> pairs;
    for (const auto& [a, b] : joints.pairs) pairs.insert(pairs.end(), {a, b});
    std::vector<float> places;
    for (std::size_t n = 0; n < samples.size(); ++n)
        places.insert(places.end(), {samples.x[n], samples.y[n], samples.z[n]});
    write(folder / "nodes.f32", nodes);
    write(folder / "pairs.i32", pairs);
    write(folder / "joints.f32", joints.rows);
    write(folder / "log_odds.f32", log_odds(joints.rows));
    std::vector<float> judged, judged_shell;
    for (const graph::Joint& j : weighed.joints) judged.push_back(static_cast<float>(j.log_odds));
    for (const double odds : weighed.shell.log_odds)
        judged_shell.push_back(static_cast<float>(odds));
    write(folder / "judged.f32", judged);
    write(folder / "judged_shell.f32", judged_shell);
    write(folder / "samples.f32", places);
    write(folder / "primitive.i32", samples.primitive);
    std::vector<int> structure;
    for (std::size_t p = 0; p < parts.model.size(); ++p)
        structure.push_back(static_cast<int>(parts.solids->role(static_cast<std::int32_t>(p))));
    write_objects(*device, parts, options, stage, folder);
    nlohmann::json about;
    about["node_names"] = geometry::shell_feature_names();
    about["joint_names"] = graph::joint_feature_names();
    about["axes"] = geometry.frame.axes;
    about["origin"] = geometry.frame.origin_m;
    about["offset"] = input.own.offset_m;
    about["structure"] = structure;
    about["edge"] = samples.spacing_m;
    about["voxel"] = voxel_m;
    about["timings"] = timings;
    std::ofstream(folder / "table.json") << about.dump(1);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: topple_features SCAN OUT\n");
        return 2;
    }
    try {
        run(argv[1], argv[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
