// SPDX-License-Identifier: MIT
#include "core/checksum.h"
#include "export/colour_texture.h"
#include "export/export_folder.h"
#include "export/formats.h"
#include "export/text.h"
#include "export/write_obj.h"
#include "export/writers.h"
#include "host/export/shapes_scene.h"
#include "host/io/files.h"
#include "io/text.h"
#include "result/solids_file.h"

namespace topple::exports::test {
namespace {

namespace fs = std::filesystem;

class WriteExports : public topple::test::Files {
  protected:
    // What a format's writer takes to write into a folder.
    fs::path in(const std::string& folder, const Format& format) const {
        return format.file ? path(folder) : path(folder) / "scene.usda";
    }
    void write_all(const SimScene& scene) const {
        for (const Format& format : formats()) format.write(in("out", format), scene);
    }
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
    write_all(scene);
    const auto first = files_in(path("out"));
    EXPECT_TRUE(first.contains("scene_urdf/object_1.urdf"));
    EXPECT_TRUE(first.contains("scene_sdf/object_5_part_0.obj"));  // the ramp
    EXPECT_FALSE(first.contains("scene_sdf/object_1_part_0.obj"));
    EXPECT_TRUE(first.contains("scene_mjcf/object_1.obj"));
    EXPECT_TRUE(first.contains("scene_mjcf/colours.png"));
    write_all(scene);
    EXPECT_EQ(files_in(path("out")), first);
}

TEST_F(WriteExports, AnEarlierOneIsReplacedAsAWhole) {
    SimScene scene = shapes_scene();
    write_all(scene);
    scene.bodies.resize(2);
    scene.bodies[1].visual = {};
    write_all(scene);
    EXPECT_FALSE(fs::exists(path("out/scene_urdf/object_5_part_0.obj")));
    EXPECT_FALSE(fs::exists(path("out/scene_mjcf/object_1.obj")));
    scene.bodies[0].visual = {};
    write_all(scene);
    EXPECT_FALSE(fs::exists(path("out/scene_mjcf")));
    EXPECT_FALSE(fs::exists(path("out/scene_sdf")));
}

TEST_F(WriteExports, FilesOfOthersStay) {
    const SimScene scene = shapes_scene();
    for (const Format& format : formats()) {
        const fs::path file = scene_file(format, in("other", format));
        write("other/" + file.filename().string(), "by someone");
        EXPECT_THROW(format.write(in("other", format), scene), Error);
        EXPECT_EQ(topple::test::bytes_of_file(file), "by someone");
        if (!format.file) continue;
        const std::string within = "out/" + name_beside(format.name) + "/notes.txt";
        format.write(path("out"), scene);
        write(within, "by someone");
        topple::test::expect_input_error([&] { format.write(path("out"), scene); }, {"notes.txt"});
        EXPECT_TRUE(fs::exists(path("out") / format.file));
        EXPECT_EQ(topple::test::bytes_of_file(path(within)), "by someone");
    }
}

TEST_F(WriteExports, WhatFailsLeavesTheEarlierOneAndNothingElse) {
    SimScene scene = shapes_scene();
    write_all(scene);
    const auto before = files_in(path("out"));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double mass : {0.0, nan}) {
        scene.bodies[1].mass_kg = mass;
        for (const Format& format : formats())
            topple::test::expect_input_error([&] { format.write(in("out", format), scene); },
                                             {"object_1", "mass"});
    }
    scene = shapes_scene();
    scene.bodies[2].inertia_kg_m2[4] = -1;
    for (const Format& format : formats())
        topple::test::expect_input_error([&] { format.write(in("out", format), scene); },
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

class SolidsFile : public topple::test::Files {
  protected:
    static SolidScene scene() {
        const SolidScene plain =
            solids_of({{{0, 0, 0}, {6, 5, 4}, 0}, {{0, 0, 4}, {2, 2, 6}, 1}}, 2);
        BoundaryCells boundary;
        SurfacePatch patch;
        patch.origin = {0.1, 0.2, 0.3};
        patch.c = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0.5};
        patch.noise_m = 0.001;
        patch.primitive = 1;
        boundary.patches = {patch};
        boundary.i = {0, 1};
        boundary.j = {0, 1};
        boundary.k = {5, 5};
        boundary.primitive = {1, 1};
        for (auto& slot : boundary.slot) slot = {0, 0};
        boundary.form = {1, 1};
        boundary.share = {4096, 17};
        for (auto& moment : boundary.moment) moment = {3, -4};
        return {plain.cells(), {Role::floor, Role::none}, {}, boundary};
    }
    std::string written() const {
        io::write_solids(path("solids.bin"), scene());
        return std::string(io::read_file(path("solids.bin")).text());
    }
};

TEST_F(SolidsFile, ComesBackAsItWas) {
    written();
    const auto back = io::read_solids(path("solids.bin"));
    const SolidScene was = scene();
    EXPECT_EQ(back->cells().i, was.cells().i);
    EXPECT_EQ(back->cells().primitive, was.cells().primitive);
    EXPECT_EQ(back->voxel_m(), was.voxel_m());
    EXPECT_EQ(back->role(0), Role::floor);
    EXPECT_EQ(back->boundary().share, was.boundary().share);
    EXPECT_EQ(back->boundary().moment, was.boundary().moment);
    EXPECT_EQ(back->boundary().patches[0].c, was.boundary().patches[0].c);
    EXPECT_EQ(back->boundary().patches[0].primitive, 1);
}

TEST_F(SolidsFile, EveryFlippedByteAndEveryCutIsTold) {
    const std::string whole = written();
    for (std::size_t n = 0; n < whole.size(); ++n) {
        std::string bytes = whole;
        bytes[n] = static_cast<char>(bytes[n] ^ 0x40);
        write("flipped", bytes);
        EXPECT_THROW(io::read_solids(path("flipped")), Error) << n;
    }
    for (std::size_t n = 1; n < whole.size(); n += 7) {
        write("cut", whole.substr(0, n));
        EXPECT_THROW(io::read_solids(path("cut")), Error) << n;
    }
    EXPECT_THROW(io::read_solids(path("missing")), Error);
}

// Who changes a file can give it a right checksum, too.
TEST_F(SolidsFile, WhatNoParseWritesIsRefusedWhateverItsChecksum) {
    const std::string whole = written();
    const SolidScene was = scene();
    const std::size_t cells = was.cells().size(), below = was.cells().unseen_below.size();
    constexpr std::size_t at_voxel = 16, head = 72;
    const std::size_t at_i = head, at_j = at_i + 4 * cells, at_k = at_j + 4 * cells,
                      at_primitive = at_k + 4 * cells, at_basis = at_primitive + 4 * cells,
                      at_boundary = at_basis + cells + below, at_slot = at_boundary + 4 * 8,
                      at_form = at_slot + 4 * 8, at_share = at_form + 8,
                      at_patch = at_share + 8 + 3 * 8, at_patch_primitive = at_patch + 120,
                      at_role = at_patch_primitive + 4;
    const auto forged = [&](std::size_t at, const auto& value) {
        std::string bytes = whole;
        std::memcpy(bytes.data() + at, &value, sizeof(value));
        const std::size_t summed = bytes.size() - sizeof(Checksum::Value);
        const Checksum::Value sum = Checksum::of(bytes.data(), summed);
        std::memcpy(bytes.data() + summed, &sum, sizeof(sum));
        write("forged", bytes);
    };
    forged(at_share, std::uint32_t{4095});
    EXPECT_EQ(io::read_solids(path("forged"))->boundary().share[0], 4095U);
    const auto refused = [&](std::size_t at, const auto& value) {
        forged(at, value);
        topple::test::expect_input_error([&] { io::read_solids(path("forged")); },
                                         {"forged", "damaged", "parse the scan again"});
    };
    using Limits = std::numeric_limits<std::int32_t>;
    const std::size_t last = 4 * (cells - 1);
    const struct {
        const char* what;
        std::size_t at;
        std::vector<std::int32_t> words;
    } tables[] = {
        {"first cell", at_i, {5, 1 << 29, Limits::max(), Limits::min()}},
        {"last cell", at_i + last, {-1, 1 << 22, 1 << 29, Limits::max(), Limits::min()}},
        {"columns", at_j, {5, Limits::max()}},
        {"levels", at_k + last, {0, 1 << 22, Limits::max(), Limits::min()}},
        {"primitives", at_primitive, {-2, 2, Limits::max(), Limits::min()}},
        {"boundary's place", at_boundary, {2, Limits::max(), Limits::min()}},
        {"boundary's primitive", at_boundary + 3 * 8, {-1, 2, Limits::max(), Limits::min()}},
        {"slots", at_slot, {1, -1, Limits::max()}},
        {"form", at_form, {7}},
        {"share", at_share, {4097, -1}},
        {"patch's primitive", at_patch_primitive, {-2, 2, Limits::max(), Limits::min()}},
    };
    for (const auto& [what, at, words] : tables) {
        for (const std::int32_t word : words) {
            SCOPED_TRACE(std::string(what) + ' ' + std::to_string(word));
            refused(at, word);
        }
    }
    refused(at_basis, std::uint8_t{basis_count});
    refused(at_role, std::uint8_t{9});
    for (const double number : {std::nan(""), HUGE_VAL, -1.0}) refused(at_voxel, number);
    for (const double number : {std::nan(""), HUGE_VAL, 1e300}) refused(at_patch, number);
    for (std::size_t count = 0; count < 6; ++count)
        for (const std::uint64_t many : {std::uint64_t{1} << 40, ~std::uint64_t{0}})
            refused(at_voxel + 8 + 8 * count, many);
}

TEST_F(SolidsFile, SaysTheSameEachTime) {
    EXPECT_EQ(written(), written());
}

}  // namespace
}  // namespace topple::exports::test
