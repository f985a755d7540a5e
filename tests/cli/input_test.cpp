// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "host/io/mesh_files.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"

// Inputs that are damaged, or odd, or hardly there.
namespace topple::test {
namespace {

class Input : public Program {
  protected:
    // Fails with 1 and names the file and what is wrong with it.
    void refused(const std::string& file, std::vector<std::string> parts = {}) const {
        parts.push_back(file);
        expect_failure(1, {"parse", file, "-o", "out", "--quiet"}, parts);
    }
    // A small sequence of depth images of a room.
    void put_sequence(const std::string& name, unsigned frames) const {
        scenes::CameraOptions camera;
        camera.intrinsics = {80, 60, 69, 69, 39.5, 29.5, 1000};
        camera.frames = frames;
        const auto world = scenes::furnished_room({});
        scenes::write_sequence(in(name), world, scenes::walk(world, camera));
    }
    std::filesystem::path depth_image(const std::string& sequence, std::size_t n) const {
        std::vector<std::filesystem::path> images;
        for (const auto& entry : std::filesystem::directory_iterator(in(sequence) / "depth"))
            images.push_back(entry.path());
        std::sort(images.begin(), images.end());
        return images.at(n);
    }
};

std::string ply_header(const std::string& vertices) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
}

std::string floats(std::size_t count, float value) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) append(bytes, value);
    return bytes;
}

// One of each kind; the readers' own tests have the rest.
TEST_F(Input, that_is_none_is_refused) {
    const std::string cut = ply_header("1000") + floats(3 * 999 + 2, 1);
    const std::pair<const char*, BadFile> cases[] = {
        {"scan.doc", {"v 0 0 0\n", {".ply"}}},
        {"scan.obj", {"v 0 0 0\n", {"1 point was found"}}},
        {"empty.ply", {"", {"empty"}}},
        {"cut.ply", {cut, {"1000"}}},
        {"cut-header.pcd", {"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4", {}}},
        {"image.xyz", {std::string("\x89PNG\r\n\x1a\n\0\1\2", 11), {}}},
        {"huge.ply", {ply_header("1000000000000") + floats(3, 1), {"1000000000000"}}},
        {"nan.ply", {ply_header("100") + floats(300, NAN), {"finite"}}},
        {"words.xyz", {"a b c\na b c\n", {"line 2: \"a\" is not a number", "expected x y z"}}},
        {"none.xyz", {"# x y z\n", {"has no points"}}},
        {"one.xyz", {"1 2 3\n", {"1 point was found", "takes 8"}}},
        {"far.xyz", {"0 0 0\n100000 0 0\n", {"2 points"}}},
        {"same.ply",
         {ply_header("5000") + floats(15000, 0.7f), {"5000 points", "no surface", "8 voxels"}}},
    };
    for (const auto& [name, bad] : cases) {
        put(name, bad.bytes);
        refused(name, {bad.says.begin(), bad.says.end()});
    }
    std::filesystem::create_directory(in("folder"));
    refused("folder", {"depth"});
    // Not quiet: said before the first stage, for a path may be mistyped.
    fails(1, "parse missing.ply -o out", {"missing.ply", "No such file"});
    fails(1, "parse missing/ -o out", {"missing/", "No such file"});
}

// A box of 4 x 3 x 2.5 m in steps of 5 cm: floor and walls, in the unit given.
std::string room_in(double unit_m) {
    std::string text;
    const auto point = [&](int i, int j, int k) {
        for (const int at : {i, j, k}) text += std::to_string(0.04 * at / unit_m) + " ";
        text += "\n";
    };
    for (int i = 0; i <= 80; ++i) {
        for (int j = 0; j <= 60; ++j) {
            point(i, j, 0);
            if (i % 80 != 0 && j % 60 != 0) continue;
            for (int k = 1; k <= 50; ++k) point(i, j, k);
        }
    }
    return text;
}

TEST_F(Input, in_another_unit_than_metres) {
    for (const auto& [unit, unit_m] :
         {std::pair<std::string, double>("mm", 0.001), {"in", 0.0254}}) {
        put("room.xyz", room_in(unit_m));
        const std::vector<std::string> told{"extend over", "apart", "--unit " + unit};
        refused("room.xyz", told);
        fails(1, "estimate room.xyz --quiet", told);
        succeeds("parse room.xyz -o out --quiet --disturbance wind --unit " + unit);
        // Metres again.
        const auto scene = nlohmann::json::parse(bytes_of_file(in("out/scene.json")));
        double farthest = 0;
        for (const auto& p : scene.at("primitives"))
            farthest = std::max(farthest, p.at("center_of_mass_m").at(0).get<double>());
        EXPECT_GT(farthest, 1.9);
        EXPECT_LT(farthest, 4.1);
        std::filesystem::remove_all(in("out"));
    }
    put("room.xyz", room_in(1));
    EXPECT_THAT(topple("parse room.xyz -o out --unit cm").out,
                HasSubstr("Note: It all extends over 0.032 m: check unit_m (--unit).\n"));
    put_sequence("frames", 2);
    fails(2, "parse frames -o other --quiet --unit mm", {"--unit", "depth_scale"});
}

// One primitive, one object, and nothing that it could rest on.
TEST_F(Input, one_plane_only) {
    put_plane("plane.xyz");
    EXPECT_EQ(succeeds("parse plane.xyz -o out --quiet").out, "");
    const auto scene = nlohmann::json::parse(bytes_of_file(in("out/scene.json")));
    EXPECT_EQ(scene.at("primitives").size(), 1u);
    EXPECT_EQ(scene.at("objects").size(), 1u);
    EXPECT_TRUE(scene.at("supports").empty());
}

TEST_F(Input, sequences_that_are_damaged) {
    put_sequence("scan", 4);
    for (const std::string scale : {"1", "1e6"}) {
        auto intrinsics = nlohmann::json::parse(bytes_of_file(in("scan/intrinsics.json")));
        intrinsics["depth_scale"] = std::stod(scale);
        put("scan/intrinsics.json", intrinsics.dump());
        refused("scan", {"depth_scale of intrinsics.json", scale == "1" ? "1, the" : "1e+06"});
    }
    const auto image = depth_image("scan", 2);
    std::ofstream(image, std::ios::binary) << "no image";
    refused("scan", {image.filename().string()});
    std::filesystem::remove(image);
    refused("scan", {"trajectory.txt", "3"});
    std::filesystem::remove(in("scan/trajectory.txt"));
    refused("scan", {"trajectory.txt"});
    put("scan/intrinsics.json", "{\"width\": 80,\n \"height\" 60}");
    refused("scan", {"intrinsics.json: is no JSON: line 2, column 12: "});
    EXPECT_THAT(topple("parse scan -o out").err, Not(HasSubstr("json.exception")));
    std::filesystem::remove(in("scan/intrinsics.json"));
    refused("scan", {"intrinsics.json"});
}

TEST_F(Input, a_scan_that_needs_too_much_memory) {
    put_plane("plane.xyz");
    for (const auto& [limit, told] : {std::pair<std::string, const char*>("1K", "the 1 KiB of"),
                                      {"1MB", "the 977 KiB of"},
                                      {"1 --tile 5", "MiB, more than the 1 B of"}})
        fails(1, "parse plane.xyz -o out --quiet --max-memory " + limit,
              {"need", told, "--max-memory"});
}

// What the program leaves to processes of its own: foreign formats and drivers.

class Readers : public Program {
  protected:
    ~Readers() override {
        unsetenv("OCL_ICD_VENDORS");
        unsetenv("TOPPLE_READERS");
    }
};

TEST_F(Readers, a_driver_that_ends_whoever_loads_it_is_not_usable) {
    put("drivers/aborting.icd", TOPPLE_ABORTING_DRIVER "\n");
    setenv("OCL_ICD_VENDORS", in("drivers").c_str(), 1);
    const Finished listed = succeeds("devices");
    EXPECT_THAT(listed.out, HasSubstr("native"));
    EXPECT_THAT(listed.out, HasSubstr("not usable: its driver crashed (Aborted)"));
    put("box.obj", box_obj());
    fails(3, "estimate box.obj --backend opencl", {"crashed (Aborted)"});
    succeeds("estimate box.obj --backend auto --quiet");
}

TEST_F(Readers, that_of_points_does_not_load_openvdb) {
    const auto beside = std::filesystem::path(TOPPLE_PROGRAM).parent_path();
    const auto loads = [&](const char* reader) {
        return bytes_of_file(beside / reader).find("libopenvdb.so") != std::string::npos;
    };
    EXPECT_TRUE(loads("topple-volume-reader"));
    EXPECT_FALSE(loads("topple-reader"));
}

TEST_F(Readers, without_them_it_says_what_to_do) {
    put("box.obj", box_obj());
    put("empty/x", "x");
    setenv("TOPPLE_READERS", in("empty").c_str(), 1);
    fails(2, "estimate box.obj --backend native --quiet", {"TOPPLE_READERS", "topple-reader"});
    succeeds("estimate box.obj --backend native --quiet --no-isolate");
}

TEST_F(Readers, hostile_meshes_are_refused_in_a_line) {
    const std::string head = R"({"asset": {"version": "2.0"}, "nodes": [)";
    const struct {
        std::string nodes, message;
    } cases[] = {
        {R"({"children": [1, 1]}, {})", "twice"},
        {R"({"children": [1]}, {"children": [0]})", "cycle"},
        {R"({"children": [0]})", "cycle"},
        {R"({"children": [5]})", "no node"},
    };
    for (const auto& c : cases) {
        put("a.gltf", head + c.nodes + "]}");
        for (const char* command : {"estimate", "parse"})
            expect_failure(1, {command, "a.gltf", "--backend", "native", "--quiet"},
                           {"a.gltf", c.message});
    }
    for (const char* uri : {"../a.bin", "/etc/hostname", "%2e%2e/a.bin", "file:///etc/hostname"}) {
        put("a.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": ")" +
                          std::string(uri) + "\"}]}");
        fails(1, "parse a.gltf --quiet", {"a.gltf", "folder"});
    }
}

}  // namespace
}  // namespace topple::test
