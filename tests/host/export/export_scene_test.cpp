// SPDX-License-Identifier: MIT
#include "core/json.h"
#include "export/formats.h"
#include "export/summary.h"
#include "host/export/blocks.h"
#include "host/io/files.h"
#include "result/scene_json.h"
#include "result/solids_file.h"
#include "topple/export.h"

namespace topple::exports::test {
namespace {

using topple::test::message_of;

// A crate of 20 x 20 x 30 cm on a slab.
class ExportScene : public topple::test::Files {
  protected:
    ExportScene() {
        result_.solids = std::make_shared<const SolidScene>(
            solids_of({{{0, 0, -10}, {100, 100, 0}, 0}, {{40, 40, 0}, {60, 60, 30}, 1}}, 2));
        Scene& scene = result_.scene;
        scene.source = "crate";
        for (unsigned n = 0; n < 16; n += 5) scene.manhattan_from_input[n] = 1;
        for (std::int32_t id = 0; id < 2; ++id) {
            Primitive primitive;
            primitive.id = primitive.object = id;
            primitive.volume_m3 = id == 0 ? 0.1 : 0.012;
            scene.primitives.push_back(primitive);
            Object object;
            object.id = id;
            object.primitives = {id};
            object.grounded = id == 0;
            object.mass_kg = 700 * primitive.volume_m3;
            object.center_of_mass_m = {0.5, 0.5, id == 0 ? -0.05 : 0.15};
            for (unsigned a = 0; a < 9; a += 4) object.inertia_kg_m2[a] = 0.1;
            scene.objects.push_back(object);
        }
        scene.supports.push_back({0, 1, 0.04, 1});
    }

    // As an output's folder holds it, which is what is read of it.
    void put_output(const Scene& scene) const {
        std::filesystem::create_directories(path("out"));
        io::write_scene_json(path("out/scene.json"), scene);
        io::write_solids(path("out/solids.bin"), *result_.solids);
    }
    ExportOptions to(const std::string& name) const {
        ExportOptions options;
        options.mjcf = path(name);
        return options;
    }
    std::string refused(const ExportOptions& options, ErrorKind kind) const {
        return message_of([&] { export_output(path("out"), options); }, kind);
    }

    ParseResult result_;
};

TEST_F(ExportScene, SaysWhatBecameOfEachBody) {
    const ExportSummary made = export_scene(result_, to("made"));
    ASSERT_EQ(made.bodies.size(), 2u);
    const ExportedBody& crate = made.bodies[1];
    EXPECT_EQ(crate.name, "object_1");
    EXPECT_EQ(crate.object, 1);
    EXPECT_FALSE(crate.fixed);
    EXPECT_TRUE(made.bodies[0].fixed);
    EXPECT_EQ(crate.parts, 1u);
    EXPECT_NEAR(crate.mass_kg, 8.4, 1e-9);
    EXPECT_NEAR(crate.solid_m3, 0.012, 1e-9);
    EXPECT_NEAR(crate.parts_m3, 0.012, 1e-6);
    EXPECT_LT(made.deepest_overlap_m, 1e-6);

    const auto json = Json::parse(topple::test::bytes_of_file(path("made/bodies.json")));
    EXPECT_EQ(json.at("schema"), "topple.bodies/1");
    EXPECT_EQ(json.at("bodies").at(1).at("name"), "object_1");
    EXPECT_NEAR(json.at("bodies").at(1).at("excess_share").get<double>(), 0, 1e-3);
}

// What is fixed has its mass, too, and not what MuJoCo makes of its parts.
TEST_F(ExportScene, EachBodyHasTheMassThatItWasParsedWith) {
    export_scene(result_, to("made"));
    const std::string xml = topple::test::bytes_of_file(path("made/scene.xml"));
    EXPECT_NE(xml.find("<!-- For MuJoCo 2.3 or later."), std::string::npos);
    EXPECT_NE(xml.find("mass=\"70\""), std::string::npos) << xml;
    EXPECT_NE(xml.find("mass=\"8.4\""), std::string::npos) << xml;
}

TEST(ExportNotes, NameWhatWasCutToHalf) {
    ExportSummary made;
    made.bodies.resize(8);
    for (std::size_t n = 0; n < made.bodies.size(); ++n) {
        ExportedBody& body = made.bodies[n];
        body.name = "object_" + std::to_string(n);
        body.solid_m3 = 0.02;
        body.lost_m3 = n == 0 ? 0.01 : 0.01 * static_cast<double>(n + 1);
    }
    made.bodies[7].solid_m3 = 0;  // a pad
    EXPECT_EQ(notes_of(made),
              std::vector<std::string>{"6 lay in others so deep that what was cut off their hulls, "
                                       "which fill hollows, is more than half of their solids: "
                                       "object_6 350 %, object_5 300 %, "
                                       "object_4 250 %, object_3 200 %, object_2 150 %, ..."});
    made.bodies.resize(1);
    EXPECT_EQ(notes_of(made), std::vector<std::string>{});
    made.bodies[0].held = true;
    EXPECT_NE(notes_of(made).at(0).find("1 are held where they are (object_0); 0 struts"),
              std::string::npos);
}

TEST_F(ExportScene, OfAFolderIsTheSameAsOfTheResult) {
    put_output(result_.scene);
    export_scene(result_, to("direct"));
    ExportOptions options = to("read");
    options.threads = 1;
    export_output(path("out"), options);
    for (const char* name : {"/scene.xml", "/bodies.json"})
        EXPECT_EQ(topple::test::bytes_of_file(path("direct") += name),
                  topple::test::bytes_of_file(path("read") += name));
    // Over an earlier one.
    EXPECT_EQ(export_output(path("out"), options).bodies.size(), 2u);
}

TEST_F(ExportScene, WithoutAFormatOrSolidsIsRefused) {
    EXPECT_THROW(export_scene(result_, {}), Error);
    result_.solids = nullptr;
    EXPECT_THAT(message_of([&] { export_scene(result_, to("made")); }, std::nullopt),
                testing::HasSubstr("crate: was parsed in blocks"));
    EXPECT_FALSE(std::filesystem::exists(path("made")));
}

TEST_F(ExportScene, AnothersFilesStay) {
    put_output(result_.scene);
    write("a/scene.xml", "<mujoco/>");
    write("b/bodies.json", "{}");
    write("e/scene_asleep.xml", "<mujoco/>");
    EXPECT_NE(refused(to("a"), ErrorKind::input).find("a/scene.xml: exists"), std::string::npos);
    EXPECT_NE(refused(to("b"), ErrorKind::input).find("b/bodies.json: exists"), std::string::npos);
    EXPECT_NE(refused(to("e"), ErrorKind::input).find("e/scene_asleep.xml: exists"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("b/scene.xml")));
    // A scan's own folder.
    write("scan/intrinsics.json", "{}");
    EXPECT_NE(refused(to("scan"), ErrorKind::input).find("scan: holds a scan's depth frames"),
              std::string::npos);
    ExportOptions beside;
    beside.usd = path("scan/scene.usda");
    EXPECT_NE(refused(beside, ErrorKind::input).find("scan: holds"), std::string::npos);
    write("d/other.txt", "by someone");
    result_.scene.source = path("d");
    EXPECT_THROW(export_scene(result_, to("d")), Error);
    EXPECT_FALSE(std::filesystem::exists(path("d/scene.xml")));
    write("c", "no folder");
    EXPECT_NE(refused(to("c"), ErrorKind::input).find("can't be written: Not a dir"),
              std::string::npos);
}

TEST_F(ExportScene, OfADamagedFolderIsRefused) {
    EXPECT_NE(refused(to("made"), ErrorKind::input).find("No such file"), std::string::npos);
    std::filesystem::create_directories(path("out"));
    EXPECT_NE(refused(to("made"), ErrorKind::input).find("no scene.json"), std::string::npos);
    const auto damage = [&](auto change, const char* said) {
        Scene scene = result_.scene;
        change(scene);
        put_output(scene);
        EXPECT_NE(refused(to("made"), ErrorKind::input).find(said), std::string::npos) << said;
    };
    damage([](Scene& s) { s.supports[0].supporter = 7; }, "a support names an object");
    damage([](Scene& s) { s.supports[0].supported = -1; }, "a support names an object");
    damage([](Scene& s) { s.objects[1].primitives = {2}; }, "object 1 names a primitive");
    damage([](Scene& s) { s.objects[1].id = 5; }, "object 1 has another id");
    damage([](Scene& s) { s.primitives[1].object = 2; }, "primitive 1 names an object");
    damage([](Scene& s) { s.objects[1].mass_kg = 0; }, "object 1 has no mass");
    damage([](Scene& s) { s.objects[1].inertia_kg_m2[4] = NAN; }, "object 1 has no mass");
    damage([](Scene& s) { s.manhattan_from_input[3] = NAN; }, "manhattan_from_input");
    damage([](Scene& s) { s.primitives.pop_back(), s.objects.pop_back(), s.supports.clear(); },
           "primitives");
    put_output(result_.scene);
    std::filesystem::resize_file(path("out/solids.bin"), 100);
    EXPECT_NE(refused(to("made"), ErrorKind::input).find("solids.bin"), std::string::npos);
    std::filesystem::remove(path("out/solids.bin"));
    EXPECT_NE(refused(to("made"), ErrorKind::input).find("solids.bin: is missing"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("made")));
}

TEST_F(ExportScene, EndsWhereItIsCancelled) {
    ExportOptions options = to("made");
    options.cancelled = [] { return true; };
    EXPECT_THROW(export_scene(result_, options), Error);
    EXPECT_FALSE(std::filesystem::exists(path("made")));
}

TEST(Formats, HaveFilesBesideThem) {
    ExportOptions options;
    for (const Format& format : formats()) {
        set_path(options, format.name, "x.usda");
        EXPECT_EQ(options.*format.path, "x.usda");
    }
    Format file{"usd", &ExportOptions::mjcf, nullptr, "", nullptr};
    EXPECT_EQ(scene_file(file, "a/x.usda"), "a/x.usda");
    EXPECT_EQ(bodies_file(file, "a/x.usda"), "a/x.bodies.json");
    EXPECT_THROW(set_path(options, "obj", "x"), Error);
    EXPECT_THROW(set_path(options, "mjcf", ""), Error);
}

}  // namespace
}  // namespace topple::exports::test
