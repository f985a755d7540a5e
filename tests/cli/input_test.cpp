// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/program.h"
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
    // Parses; nothing on either stream, and OUT whole.
    void parsed(const std::string& file) const {
        SCOPED_TRACE(file);
        const Finished finished = run({"parse", file, "-o", "out", "--quiet"});
        EXPECT_EQ(finished.code, 0);
        EXPECT_EQ(finished.out, "");
        EXPECT_EQ(finished.err, "");
        for (const char* name : {"points.ply", "solid.ply", "volume.vdb", "report.html",
                                 "landscapes.json", "scene.json"}) {
            EXPECT_TRUE(std::filesystem::exists(in("out") / name)) << name;
        }
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

std::string pcd_header(const std::string& points) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
           points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA binary\n";
}

std::string floats(std::size_t count, float value) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) append(bytes, value);
    return bytes;
}

TEST_F(Input, missing_or_of_no_known_kind) {
    refused("missing.ply", {"No such file"});
    put("scan.doc", "v 0 0 0\n");
    refused("scan.doc", {".ply"});
    put("scan.obj", "v 0 0 0\n");
    refused("scan.obj", {"1 point was found"});
    std::filesystem::create_directory(in("folder"));
    refused("folder", {"depth"});
}

TEST_F(Input, empty) {
    for (const char* name : {"empty.ply", "empty.pcd", "empty.xyz"}) {
        put(name, "");
        refused(name, {"empty"});
    }
}

TEST_F(Input, truncated) {
    put("cut.ply", ply_header("1000") + floats(3 * 999 + 2, 1.0f));
    refused("cut.ply", {"1000"});
    put("cut-header.ply", ply_header("1000").substr(0, 60));
    refused("cut-header.ply");
    put("cut.pcd", pcd_header("1000") + floats(3 * 999 + 2, 1.0f));
    refused("cut.pcd", {"1000"});
    put("cut-header.pcd", pcd_header("1000").substr(0, 60));
    refused("cut-header.pcd");
}

TEST_F(Input, wrong_magic) {
    put("image.ply", "\x89PNG\r\n\x1a\n and more");
    refused("image.ply", {"ply"});
    put("image.pcd", std::string("\x89PNG\r\n\x1a\n\0\1\2", 11));
    refused("image.pcd");
    put("image.xyz", std::string("\x89PNG\r\n\x1a\n\0\1\2", 11));
    refused("image.xyz");
}

TEST_F(Input, a_header_that_promises_a_million_million_points) {
    put("huge.ply", ply_header("1000000000000") + floats(3, 1.0f));
    refused("huge.ply", {"1000000000000"});
    put("huge.pcd", pcd_header("1000000000000") + floats(3, 1.0f));
    refused("huge.pcd");
    put("overflow.ply", ply_header("99999999999999999999999") + floats(3, 1.0f));
    refused("overflow.ply");
}

TEST_F(Input, no_finite_point) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    put("nan.ply", ply_header("100") + floats(300, nan));
    refused("nan.ply", {"finite"});
    put("inf.pcd", pcd_header("100") + floats(300, std::numeric_limits<float>::infinity()));
    refused("inf.pcd", {"finite"});
}

// Said before the first stage: a path may be mistyped.
TEST_F(Input, missing_is_told_before_the_parse_begins) {
    expect_failure(1, {"parse", "missing.ply", "-o", "out"}, {"missing.ply", "No such file"});
    expect_failure(1, {"parse", "folder/", "-o", "out"}, {"folder/", "No such file"});
}

TEST_F(Input, words_instead_of_numbers) {
    put("words.xyz", "a b c\na b c\n");
    refused("words.xyz", {"line 2: \"a\" is not a number", "expected x y z"});
    put("words.xyz", "# no numbers\na b c\n");
    refused("words.xyz", {"line 2: \"a\" is not a number", "x y z"});
}

TEST_F(Input, hardly_any_point) {
    put("none.xyz", "# x y z\n");
    refused("none.xyz", {"has no points"});
    put("one.xyz", "1 2 3\n");
    refused("one.xyz", {"1 point was found", "takes 8"});
    put("two.xyz", "1 2 3\n1.5 2 3\n");
    refused("two.xyz", {"2 points were found", "takes 8"});
    put("far.xyz", "0 0 0\n100000 0 0\n");
    refused("far.xyz", {"2 points"});
}

TEST_F(Input, the_same_point_over_and_over) {
    put("same.ply", ply_header("5000") + floats(15000, 0.7f));
    refused("same.ply", {"5000 points", "no surface", "8 voxels"});
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
    const std::vector<std::pair<std::string, double>> units{
        {"mm", 0.001}, {"cm", 0.01}, {"in", 0.0254}};
    for (const auto& [unit, unit_m] : units) {
        put("room.xyz", room_in(unit_m));
        const std::vector<std::string> told{"extend over", "apart", "--unit " + unit};
        refused("room.xyz", told);
        expect_failure(1, {"estimate", "room.xyz", "--quiet"}, told);
        std::filesystem::remove_all(in("out"));
        const Finished done = run(
            {"parse", "room.xyz", "-o", "out", "--quiet", "--unit", unit, "--disturbance", "wind"});
        EXPECT_EQ(done.code, 0) << done.err;
        // Metres again.
        const auto scene = nlohmann::json::parse(bytes_of_file(in("out/scene.json")));
        ASSERT_FALSE(scene.at("primitives").empty());
        double farthest = 0;
        for (const auto& p : scene.at("primitives"))
            farthest = std::max(farthest, p.at("center_of_mass_m").at(0).get<double>());
        EXPECT_GT(farthest, 1.9);
        EXPECT_LT(farthest, 4.1);
        std::filesystem::remove_all(in("out"));
    }
    put("room.xyz", room_in(1));
    const Finished tiny = run({"parse", "room.xyz", "-o", "out", "--unit", "cm"});
    EXPECT_THAT(tiny.out, HasSubstr("Note: It all extends over 0.032 m: check --unit.\n"))
        << tiny.err;
    std::filesystem::remove_all(in("out"));
    put_sequence("frames", 2);
    expect_failure(2, {"parse", "frames", "-o", "out", "--quiet", "--unit", "mm"},
                   {"--unit", "depth_scale"});
}

TEST_F(Input, one_plane_only) {
    put_plane("plane.xyz");
    parsed("plane.xyz");
    // One primitive, one object, and nothing that it could rest on.
    const auto scene = bytes_of_file(in("out/scene.json"));
    const auto count = [&](const std::string& word) {
        std::size_t n = 0;
        for (auto at = scene.find(word); at != std::string::npos; at = scene.find(word, at + 1))
            ++n;
        return n;
    };
    EXPECT_EQ(count("\"model\":"), 1u);
    EXPECT_EQ(count("\"grounded\":"), 1u);
    EXPECT_EQ(count("\"supporter\":"), 0u);
}

TEST_F(Input, a_sequence_with_a_damaged_frame) {
    put_sequence("scan", 4);
    const auto image = depth_image("scan", 2);
    std::ofstream(image, std::ios::binary) << "no image";
    refused("scan", {image.filename().string()});
    std::filesystem::remove(image);
    refused("scan", {"trajectory.txt", "3"});
}

TEST_F(Input, a_sequence_whose_depth_scale_is_wrong) {
    for (const std::string scale : {"1", "1e6"}) {
        put_sequence("frames", 2);
        auto intrinsics = nlohmann::json::parse(bytes_of_file(in("frames/intrinsics.json")));
        intrinsics["depth_scale"] = std::stod(scale);
        put("frames/intrinsics.json", intrinsics.dump());
        refused("frames", {"depth_scale of intrinsics.json", scale == "1" ? "1, the" : "1e+06"});
    }
}

TEST_F(Input, a_sequence_without_intrinsics) {
    put_sequence("scan", 2);
    put("scan/intrinsics.json", "{\"width\": 80,\n \"height\" 60}");
    const Finished damaged = run({"parse", "scan", "-o", "out", "--quiet"});
    EXPECT_THAT(damaged.err, HasSubstr("intrinsics.json: is no JSON: line 2, column 12: "));
    EXPECT_THAT(damaged.err, Not(HasSubstr("json.exception")));
    std::filesystem::remove(in("scan/intrinsics.json"));
    refused("scan", {"intrinsics.json"});
}

TEST_F(Input, a_sequence_without_trajectory) {
    put_sequence("scan", 2);
    std::filesystem::remove(in("scan/trajectory.txt"));
    refused("scan", {"trajectory.txt"});
}

TEST_F(Input, a_scan_that_needs_too_much_memory) {
    put_plane("plane.xyz");
    expect_failure(1, {"parse", "plane.xyz", "-o", "out", "--quiet", "--max-memory", "1K"},
                   {"need", "the 1 KiB of --max-memory"});
    expect_failure(1, {"parse", "plane.xyz", "-o", "out", "--quiet", "--max-memory", "1MB"},
                   {"need", "the 977 KiB of --max-memory"});
    expect_failure(
        1, {"parse", "plane.xyz", "-o", "out", "--quiet", "--tile", "5", "--max-memory", "1"},
        {"need", "MiB, more than the 1 B of --max-memory"});
}

}  // namespace
}  // namespace topple::test
