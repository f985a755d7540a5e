// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>

#include "export/colour_texture.h"
#include "export/export_folder.h"
#include "export/text.h"
#include "export/write_obj.h"
#include "export/writers.h"
#include "host/export/shapes_scene.h"
#include "host/io/files.h"

namespace topple::exports::test {
namespace {

namespace fs = std::filesystem;

class WriteExports : public topple::test::Files {
  protected:
    struct Format {
        std::string top, beside;
        std::function<void(const fs::path&, const SimScene&)> write;
    };
    const std::vector<Format> formats{
        {"scene.xml", "scene_mjcf", write_mjcf},
        {"scene.urdf", "scene_urdf", write_urdf},
        {"scene.sdf", "scene_sdf", write_sdf},
        {"scene.usda", "", [](const fs::path& folder, const SimScene& scene) {
             write_usd(folder / "scene.usda", scene);
         }}};

    std::map<std::string, std::string> files_in(const fs::path& folder) const {
        std::map<std::string, std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.is_regular_file())
                out[fs::relative(entry.path(), folder)] = topple::test::bytes_of_file(entry.path());
        return out;
    }
};

TEST_F(WriteExports, AllFormatsShareAFolderAndAreTheSameAgain) {
    const SimScene scene = shapes_scene();
    for (const Format& format : formats) format.write(path("out"), scene);
    const auto first = files_in(path("out"));
    EXPECT_TRUE(first.contains("scene_urdf/object_1.urdf"));
    EXPECT_TRUE(first.contains("scene_sdf/object_5_part_0.obj"));  // the ramp
    EXPECT_FALSE(first.contains("scene_sdf/object_1_part_0.obj"));
    EXPECT_TRUE(first.contains("scene_mjcf/object_1.obj"));
    EXPECT_TRUE(first.contains("scene_mjcf/colours.png"));
    for (const Format& format : formats) format.write(path("out"), scene);
    EXPECT_EQ(files_in(path("out")), first);
}

TEST_F(WriteExports, AnEarlierOneIsReplacedAsAWhole) {
    SimScene scene = shapes_scene();
    for (const Format& format : formats) format.write(path("out"), scene);
    scene.bodies.resize(2);
    scene.bodies[1].visual = {};
    for (const Format& format : formats) format.write(path("out"), scene);
    EXPECT_FALSE(fs::exists(path("out/scene_urdf/object_5_part_0.obj")));
    EXPECT_FALSE(fs::exists(path("out/scene_mjcf/object_1.obj")));
    scene.bodies[0].visual = {};
    for (const Format& format : formats) format.write(path("out"), scene);
    EXPECT_FALSE(fs::exists(path("out/scene_mjcf")));
    EXPECT_FALSE(fs::exists(path("out/scene_sdf")));
}

TEST_F(WriteExports, FilesOfOthersStay) {
    const SimScene scene = shapes_scene();
    for (const Format& format : formats) {
        const std::string other = "other/" + format.top;
        write(other, "by someone");
        EXPECT_THROW(format.write(path("other"), scene), Error);
        EXPECT_EQ(topple::test::bytes_of_file(path(other)), "by someone");
        fs::remove_all(path("other"));
        if (format.beside.empty()) continue;
        const std::string within = "out/" + format.beside + "/notes.txt";
        format.write(path("out"), scene);
        write(within, "by someone");
        topple::test::expect_input_error([&] { format.write(path("out"), scene); }, {"notes.txt"});
        EXPECT_TRUE(fs::exists(path("out/" + format.top)));
        EXPECT_EQ(topple::test::bytes_of_file(path(within)), "by someone");
    }
}

TEST_F(WriteExports, WhatFailsLeavesTheEarlierOneAndNothingElse) {
    SimScene scene = shapes_scene();
    for (const Format& format : formats) format.write(path("out"), scene);
    const auto before = files_in(path("out"));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double mass : {0.0, nan}) {
        scene.bodies[1].mass_kg = mass;
        for (const Format& format : formats)
            topple::test::expect_input_error([&] { format.write(path("out"), scene); },
                                             {"object_1", "mass"});
    }
    scene = shapes_scene();
    scene.bodies[2].inertia_kg_m2[4] = -1;
    for (const Format& format : formats)
        topple::test::expect_input_error([&] { format.write(path("out"), scene); },
                                         {"object_2", "inertia"});
    EXPECT_EQ(files_in(path("out")), before);
}

TEST_F(WriteExports, UsdIsToldByItsName) {
    EXPECT_THROW(write_usd(path("scene.usd"), shapes_scene()), Error);
}

TEST(ExportText, NumbersAreShortAndRound) {
    EXPECT_EQ(number(0.1), "0.1");
    EXPECT_EQ(number(-0.0), "0");
    EXPECT_EQ(numbers({1, 2.5, -3e-7}), "1 2.5 -3e-07");
    const auto fixed = [](double value, int digits) {
        std::string out;
        append_fixed(out, value, digits);
        return out;
    };
    EXPECT_EQ(fixed(1.23456, 3), "1.235");
    EXPECT_EQ(fixed(-0.0501, 3), "-0.05");
    EXPECT_EQ(fixed(12, 5), "12");
    EXPECT_EQ(fixed(-1e-9, 5), "0");
}

TEST(ColourTexture, EachTexelIsFoundByItsColour) {
    const std::string png = colour_texture();
    EXPECT_TRUE(png.starts_with("\x89PNG"));
    EXPECT_EQ(texel_of({0, 0, 0}), 0u);
    EXPECT_EQ(texel_of({255, 255, 255}), 4095u);
    EXPECT_EQ(texel_of({17, 34, 51}), 256u + 2 * 16 + 3);
    const auto [u, v] = middle_of_texel(65);  // the second of the second row
    EXPECT_DOUBLE_EQ(u, 1.5 / 64);
    EXPECT_DOUBLE_EQ(v, 1 - 1.5 / 64);
}

TEST(WriteObj, ASurfaceHasItsColourOnAllOfATriangle) {
    const std::string obj = visual_obj(painted_block({0, 0, 0}, {1, 1, 1}, {17, 34, 51}));
    EXPECT_NE(obj.find("\nvt "), std::string::npos);
    EXPECT_EQ(obj.find("\nvt "), obj.rfind("\nvt "));
    EXPECT_NE(obj.find("\nf 1/1/1 3/1/3 2/1/2\n"), std::string::npos) << obj;
}

}  // namespace
}  // namespace topple::exports::test
