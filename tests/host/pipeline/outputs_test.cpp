// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "clouds.h"
#include "core/vectors.h"
#include "host/pipeline/scan.h"
#include "parses/invariants.h"
#include "points/formats/read_cloud.h"

// The files of a whole parse.
namespace topple::test {
namespace {

using Json = nlohmann::json;

// What users read scene.json by: these stay, whatever else there is.
const std::map<std::string, std::set<std::string>>& fixed_keys() {
    static const std::map<std::string, std::set<std::string>> keys{
        {"",
         {"source", "topple_version", "backend", "device", "seed", "voxel_size_m", "up",
          "manhattan_from_input", "density_kg_m3", "friction", "timings_s"}},
        {"primitives",
         {"id", "object", "model", "points", "solid_voxels", "volume_m3", "mass_kg",
          "center_of_mass_m"}},
        {"objects",
         {"id", "primitives", "grounded", "mass_kg", "center_of_mass_m", "barrier_J",
          "barrier_error_J", "release_J", "mode", "direction", "instability", "risk_J",
          "seen_enough", "unsafety"}},
        {"contacts", {"a", "b", "area_m2", "normal", "relation", "probability"}},
        {"supports", {"supporter", "supported", "area_m2"}}};
    return keys;
}

void expect_keys(const Json& scene) {
    EXPECT_EQ(scene.at("schema"), "topple.scene/1");
    for (const auto& [list, keys] : fixed_keys()) {
        const Json items = list.empty() ? Json::array({scene}) : scene.at(list);
        EXPECT_FALSE(items.empty()) << list;
        for (const Json& item : items)
            for (const std::string& key : keys)
                EXPECT_TRUE(item.contains(key)) << list << " " << key;
    }
    EXPECT_EQ(scene.at("manhattan_from_input").size(), 4u);
    EXPECT_EQ(scene.at("manhattan_from_input")[3], Json({0.0, 0.0, 0.0, 1.0}));
    for (const Json& object : scene.at("objects")) {
        // What was not seen enough has no rank.
        EXPECT_EQ(object.at("unsafety").is_null(), !object.at("seen_enough").get<bool>());
        for (const Json& step : object.at("instability")) EXPECT_GE(step.at("S_J"), 0.0);
    }
}

// The floor: of the large primitives the one whose centre lies lowest along up.
void expect_grounded_floor(const Scene& scene) {
    std::uint64_t most = 0;
    for (const Primitive& p : scene.primitives) most = std::max(most, p.points);
    const Primitive* floor = nullptr;
    for (const Primitive& p : scene.primitives) {
        if (p.points < most / 4) continue;
        if (!floor || dot(scene.up, p.center_of_mass_m) < dot(scene.up, floor->center_of_mass_m))
            floor = &p;
    }
    ASSERT_NE(floor, nullptr);
    EXPECT_TRUE(scene.objects[floor->object].grounded);
    EXPECT_EQ(scene.objects[floor->object].unsafety, 1.0);
}

class Outputs : public Files {
  protected:
    Scene written(const char* input, const std::vector<std::string>& disturbances) const {
        ParseOptions options = on(device::open_device("native"));
        options.seed = 5;
        options.disturbances = disturbances;
        const ParseResult result = parse(path(input), options);
        write_outputs(result, path("out"));
        EXPECT_EQ(parses::what_is_wrong(result.scene), "");
        EXPECT_EQ(parses::what_is_wrong(result.scene, path("out")), "");
        const Json scene = Json::parse(bytes_of_file(path("out/scene.json")));
        EXPECT_EQ(scene.at("seed"), 5);
        expect_keys(scene);
        std::map<std::int32_t, std::uint64_t> voxels;  // fragments belong to no primitive
        for (const std::int32_t p : result.scene.solid.primitive) ++voxels[p];
        for (const Primitive& p : result.scene.primitives) EXPECT_EQ(p.solid_voxels, voxels[p.id]);
        return result.scene;
    }
};

TEST_F(Outputs, of_depth_frames_obey_their_description) {
    const Scan scan = scan_of_room(5, 12);
    scenes::write_sequence(path("scan"), scan.world, scan.sequence);
    const Scene scene = written("scan", {"human", "wind", "earthquake"});
    for (const char* name :
         {"points.ply", "solid.ply", "volume.vdb", "report.html", "landscapes.json", "scene.json"})
        EXPECT_GT(std::filesystem::file_size(path("out") / name), 100u) << name;
    EXPECT_FALSE(std::filesystem::is_empty(path("scan"))) << "the input stays";
    EXPECT_FALSE(scene.supports.empty());
    expect_grounded_floor(scene);
    for (const Object& o : scene.objects)
        EXPECT_EQ(std::isnan(o.fall.people_share), o.grounded) << o.id;
}

// A cloud's finite points come back one by one, in the order of the input.
TEST_F(Outputs, of_a_bare_cloud_keep_its_points) {
    const PointCloud cloud = cloud_of_room(2);
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(cloud.size() + cloud.size() / 100) +
                      "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        for (const float c : {cloud.x[n], cloud.y[n], cloud.z[n]}) append(ply, c);
        if (n % 100 != 99) continue;
        for (const float c : {cloud.x[n], std::numeric_limits<float>::quiet_NaN(), cloud.z[n]})
            append(ply, c);
    }
    write("cloud.ply", ply);
    const Scene scene = written("cloud.ply", {"wind"});
    EXPECT_TRUE(points_of(io::read_cloud(path("out/points.ply"))) == points_of(cloud));
    for (const Object& o : scene.objects) EXPECT_TRUE(std::isnan(o.fall.people_share)) << o.id;
}

}  // namespace
}  // namespace topple::test
