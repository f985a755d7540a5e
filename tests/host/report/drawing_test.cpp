// SPDX-License-Identifier: MIT
#include "report/drawing.h"

#include <zlib.h>

#include "report/embedded.h"
#include "report/open_sides.h"
#include "report/scene_image.h"
#include "synthetic_scene.h"
#include "testing.h"

namespace topple::report {
namespace {

// A box of 0.3 x 0.2 x 0.5 m, 1 kg, upright, that slides off its support at 2 J. Poses and passes
// are its closed forms, on 9.80665 m/s^2.
Scene scene_of_a_box() {
    Scene scene;
    scene.manhattan_from_input = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Object object;
    object.id = 0;
    object.mass_kg = 1;
    object.mode = "slide";
    object.instability = {{2, 7}, {3, 9}};
    object.why.W_J = 2;
    object.why.S_J = 7;
    object.why.drop_m = 0.7;
    Landscape& l = object.landscape;
    for (const double x : {-0.15, 0.15}) {
        for (const double y : {-0.1, 0.1}) {
            for (const double z : {-0.25, 0.25}) l.hull_m.push_back({x, y, z});
        }
    }
    const auto joules = [](double height_m) { return 9.80665 * (height_m - 0.25); };
    const double inf = std::numeric_limits<double>::infinity();
    const double over_15_10 = joules(std::hypot(0.15, 0.1)),
                 over_25_10 = joules(std::hypot(0.25, 0.1));
    l.poses = {{{0, 1, 0}, joules(0.1), inf, -1, 0.3},
               {{0, -1, 0}, joules(0.1), over_15_10, 0, 0.3},
               {{1, 0, 0}, joules(0.15), over_15_10, 0, 0.15},
               {{-1, 0, 0}, joules(0.15), over_15_10, 0, 0.15},
               {{0, 0, 1}, 0, over_25_10, 0, 0.05},
               {{0, 0, -1}, 0, over_25_10, 0, 0.05}};
    const double side = 0.25 / std::hypot(0.25, 0.1), top = 0.1 / std::hypot(0.25, 0.1);
    l.passes = {{{0, top, side}, over_25_10, {4, 0}, {{0.1, 0.2, 0.97}, {0, top, side}}}};
    l.now = 4;
    l.places = {3,
                0.1,
                {0, 1, 2, std::numeric_limits<float>::quiet_NaN(), 0, 1, -7, -7,
                 std::numeric_limits<float>::infinity()}};
    scene.objects = {object};
    return scene;
}

const Drawing& titled(const std::vector<Drawing>& all, const std::string& start) {
    return *std::ranges::find_if(all, [&](const Drawing& d) { return d.title.starts_with(start); });
}

TEST(SphereMap, KeepsAreasAndTurnsBack) {
    EXPECT_EQ(map_of({0, 0, 1}), (Point{0, 0}));
    // Leaning east is up going west, and is drawn to the right; north is at the top.
    const Point east = map_of({-0.6, 0, 0.8}), north = map_of({0, -0.6, 0.8});
    EXPECT_GT(east[0], 0.2);
    EXPECT_NEAR(east[1], 0, 1e-12);
    EXPECT_LT(north[1], -0.2);
    // A cap of half the sphere takes half the disc.
    const Point equator = map_of({1, 0, 0});
    EXPECT_NEAR(equator[0] * equator[0] + equator[1] * equator[1], 0.5, 1e-12);
    EXPECT_NEAR(std::hypot(map_of({0, 0, -1})[0], map_of({0, 0, -1})[1]), 1, 1e-12);
    for (const Vec3& d : {Vec3{0.6, 0, 0.8}, Vec3{0, -0.8, -0.6}, Vec3{0.48, 0.64, 0.6}}) {
        const Vec3 back = direction_at(map_of(d));
        for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(back[a], d[a], 1e-12);
    }
}

TEST(Drawings, ShowPosesTreePlacesAndCurve) {
    const Scene scene = scene_of_a_box();
    const std::vector<Drawing> all = landscape_drawings(scene, scene.objects[0]);
    ASSERT_EQ(all.size(), 4u);
    for (const Drawing& d : all) {
        for (const Drawing::Stroke& stroke : d.strokes) {
            for (const Point& p : stroke.points) {
                EXPECT_TRUE(p[0] >= 0 && p[0] <= d.width && p[1] >= 0 && p[1] <= d.height)
                    << d.title;
            }
        }
        for (const Drawing::Dot& dot : d.dots)
            EXPECT_TRUE(dot.at[0] >= 0 && dot.at[0] <= d.width && dot.at[1] <= d.height) << d.title;
    }
    const Drawing& poses = titled(all, "Poses");
    ASSERT_TRUE(poses.sphere);
    EXPECT_EQ(poses.sphere->corners.size(), 8u);
    EXPECT_NEAR(poses.sphere->lowest_m, 0.1, 1e-12);
    EXPECT_NEAR(poses.sphere->highest_m, std::hypot(0.15, 0.1, 0.25), 1e-12);
    const auto count = [](const Drawing& d, Drawing::Style style) {
        return std::ranges::count(d.dots, style, &Drawing::Dot::style);
    };
    EXPECT_EQ(count(poses, Drawing::Style::pose), 5);
    EXPECT_EQ(count(poses, Drawing::Style::now), 1);
    EXPECT_EQ(count(poses, Drawing::Style::lowest), 1) << "the pass that is its barrier";
    const auto now = std::ranges::find(poses.dots, Drawing::Style::now, &Drawing::Dot::style);
    EXPECT_EQ(now->at, poses.sphere->middle);

    const Drawing& tree = titled(all, "Disconnectivity");
    EXPECT_EQ(count(tree, Drawing::Style::pose), 6) << "five other poses and the fall";
    EXPECT_TRUE(
        std::ranges::any_of(tree.labels, [](const auto& l) { return l.text == "fallen: -7 J"; }));
    // Deeper leaves are drawn lower: the fall, to -7 J, lowest of all.
    const auto lowest =
        std::ranges::max_element(tree.dots, {}, [](const auto& d) { return d.at[1]; });
    for (const Drawing::Dot& dot : tree.dots)
        EXPECT_EQ(dot.at[1] == lowest->at[1], &dot == &*lowest);

    const Drawing& places = titled(all, "Places");
    ASSERT_TRUE(places.raster);
    const auto& code = places.raster->code;
    ASSERT_EQ(code.size(), 9u);
    // Rows from above, that is from the north: the last of the input's comes first.
    EXPECT_EQ(code[0], code[1]);
    EXPECT_NE(code[0], code[2]) << "a fall is no wall";
    EXPECT_NE(code[3], code[4]) << "what is unknown is not 0 J";
    EXPECT_EQ(code[4], code[6]) << "0 J both";
    EXPECT_LT(code[7], code[8]) << "more work";
    for (const std::uint8_t c : code) EXPECT_LT(c, places.raster->palette.size());
    EXPECT_TRUE(titled(all, "Instability").labels.size() >= 4);
}

TEST(Drawings, OfWhatIsNotKnownAreLeftOut) {
    Scene scene = scene_of_a_box();
    Object& object = scene.objects[0];
    object.landscape = {};
    EXPECT_EQ(landscape_drawings(scene, object).size(), 1u);
    object.instability.clear();
    EXPECT_TRUE(landscape_drawings(scene, object).empty());
    object = scene_of_a_box().objects[0];
    object.grounded = true;
    EXPECT_TRUE(landscape_drawings(scene, object).empty());
}

// A body with ever so many poses: the deepest are drawn, and what it is in.
TEST(Drawings, OfManyPosesShowTheDeepest) {
    Scene scene = scene_of_a_box();
    Landscape& l = scene.objects[0].landscape;
    const double inf = std::numeric_limits<double>::infinity();
    l.poses.clear();
    l.passes.clear();
    for (int n = 0; n < 60; ++n) {
        const double angle = 2 * std::numbers::pi * n / 60;
        l.poses.push_back({{std::cos(angle), std::sin(angle), 0},
                           0.1 * n,
                           n == 0 ? inf : 6 + 0.01 * n,
                           n == 0 ? -1 : n / 2,
                           1.0 / 60});
    }
    l.now = 59;
    const std::vector<Drawing> all = landscape_drawings(scene, scene.objects[0]);
    const Drawing& poses = titled(all, "Poses");
    EXPECT_EQ(poses.dots.size(), 10u);
    EXPECT_EQ(std::ranges::count(poses.dots, Drawing::Style::now, &Drawing::Dot::style), 1);
}

// Of base64 and zlib's format.
std::string inflated(const std::string& text, std::size_t size) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned held = 0, bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        held = held << 6 | static_cast<unsigned>(digits.find(c));
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(held >> bits);
    }
    std::string out(size + 1, '\0');
    uLongf length = out.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                         reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
              Z_OK);
    out.resize(length);
    return out;
}

TEST(Deflated, is_what_zlib_inflates) {
    for (const std::string& text : {std::string(), std::string("a"), std::string(70000, 'x')})
        EXPECT_EQ(inflated(deflated(text), text.size()), text);
}

// As recordsOf() of the page has it.
TEST(Deflated, records_are_their_steps) {
    const std::vector<std::array<std::uint16_t, 2>> records{
        {0, 65535}, {65535, 0}, {300, 7}, {299, 8}};
    const std::string bytes = inflated(deflated(records), 16);
    ASSERT_EQ(bytes.size(), 16u);
    for (std::size_t c = 0; c < 2; ++c) {
        std::uint16_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto byte = [&](std::size_t n) {
                return static_cast<unsigned char>(bytes[8 * c + n]);
            };
            const unsigned step = byte(i) | unsigned{byte(4 + i)} << 8;
            const unsigned sign = step & 1 ? 0xffffu : 0u;
            value = static_cast<std::uint16_t>(value + ((step >> 1) ^ sign));
            EXPECT_EQ(value, records[i][c]) << i << ' ' << c;
        }
    }
    const std::vector<std::array<std::int8_t, 1>> small{{-128}, {127}, {-1}};
    EXPECT_EQ(inflated(deflated(small), 3), "\x80\xff\x80");
}

TEST(Deflated, plain_numbers_by_low_and_high_bytes) {
    const std::vector<std::array<std::uint16_t, 3>> records{{1, 2, 0x1203}, {4, 5, 6}};
    EXPECT_EQ(inflated(deflated_plain(records), 12),
              std::string("\x01\x02\x03\x04\x05\x06\0\0\x12\0\0\0", 12));
}

// Scans that are parsed in blocks have no normals.
Scene without_normals() {
    Scene scene = test::SyntheticScene(0.05, 0).make();
    scene.points.nx.clear();
    scene.points.ny.clear();
    scene.points.nz.clear();
    return scene;
}

TEST(OpenSides, floors_face_up_and_walls_and_ceilings_inwards) {
    const auto view = pack_view(without_normals());
    const auto check = [&](const Records& records) {
        int checked = 0;
        for (std::size_t i = 0; i < records.cell.size(); ++i) {
            if (view.groups[records.cell[i][3]].second != 0) continue;
            Vec3 p;
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[axis] = view.origin_m[axis] + view.step_m[axis] * records.cell[i][axis];
            const auto& normal = records.aux[i];
            const bool amid_x = p[0] > 0.2 && p[0]<3.8, amid_y = p[1]> 0.2 && p[1] < 4.8;
            const bool amid_z = p[2] >= 0.2 && p[2] <= 2.3;
            const struct {
                const char* what;
                bool there;
                int facing;
            } sides[] = {{"floor", p[2] < 0 && amid_x && amid_y, normal[2]},
                         {"ceiling", p[2] > 2.5 && amid_x && amid_y, -normal[2]},
                         {"wall to the west", p[0] < 0 && amid_y && amid_z, normal[0]},
                         {"wall to the east", p[0] > 4 && amid_y && amid_z, -normal[0]},
                         {"wall to the south", p[1] < 0 && amid_x && amid_z, normal[1]},
                         {"wall to the north", p[1] > 5 && amid_x && amid_z, -normal[1]}};
            for (const auto& [what, there, facing] : sides)
                EXPECT_TRUE(!there || facing > 100) << "the " << what;
            checked += amid_z;
        }
        EXPECT_GT(checked, 5000);
    };
    check(view.voxels);
    check(view.points);
}

// Of cells of 10 cm.
void face_all(std::vector<Cell>& cells) {
    CellTable table;
    std::vector<std::uint32_t> all;
    for (std::uint32_t n = 0; n < cells.size(); ++n) {
        table.insert(cells[n].index, n);
        all.push_back(n);
    }
    face_open_sides(cells, table, all, {20, 20, 10}, 0.1);
}

// Layers of 4 m x 4 m of cells of 10 cm at the given heights.
std::vector<Cell> layers(const std::vector<std::int32_t>& heights) {
    std::vector<Cell> cells;
    for (const std::int32_t z : heights) {
        for (std::int32_t n = 0; n < 1600; ++n)
            cells.push_back({.index = {n % 40, n / 40, z}, .background = true});
    }
    return cells;
}

// Their normals' third component.
std::vector<float> facing(const std::vector<std::int32_t>& heights) {
    std::vector<Cell> cells = layers(heights);
    face_all(cells);
    std::vector<float> out;
    for (std::size_t layer = 0; layer < heights.size(); ++layer) {
        out.push_back(cells[1600 * layer].normal[2]);
        for (std::size_t n = 0; n < 1600; ++n)
            EXPECT_EQ(cells[1600 * layer + n].normal[2], out.back()) << heights[layer];
    }
    return out;
}

TEST(OpenSides, of_floors_and_ceilings) {
    using Faces = std::vector<float>;
    EXPECT_EQ(facing({0}), (Faces{1})) << "a floor without a ceiling";
    EXPECT_EQ(facing({0, 25}), (Faces{1, -1}));
    EXPECT_EQ(facing({0, 25, 26}), (Faces{1, -1, -1})) << "a ceiling's upper side is no floor";
    EXPECT_EQ(facing({0, 25, 27}), (Faces{1, -1, -1})) << "nor is noise above it";
    EXPECT_EQ(facing({0, 25, 27, 50}), (Faces{1, -1, 1, -1})) << "two storeys";
    EXPECT_EQ(facing({0, 25, 50}), (Faces{1, 1, -1})) << "what is both is never cut from above";
}

TEST(OpenSides, a_cupboard_on_the_wall_leaves_the_ceiling_above_it_a_ceiling) {
    std::vector<Cell> cells = layers({0, 25});
    const std::size_t ceiling = 1600;
    for (std::int32_t n = 0; n < 60; ++n)
        cells.push_back({.index = {10 + n % 12, n / 12, 20}, .background = true});
    face_all(cells);
    for (std::size_t n = 0; n < 1600; ++n) EXPECT_EQ(cells[ceiling + n].normal[2], -1) << n;
}

TEST(OpenSides, of_what_stands_out_of_a_ceiling_are_the_ceilings) {
    std::vector<Cell> cells = layers({0, 25});
    const std::size_t noise = cells.size();
    for (std::int32_t n = 5; n < 35; n += 6) {
        cells.push_back({.index = {n, n, 26}, .background = true});
        cells.push_back({.index = {n, 20, 27}, .background = true});
        cells.push_back({.index = {20, n, 24}, .background = true});
    }
    face_all(cells);
    for (std::size_t n = noise; n < cells.size(); ++n)
        EXPECT_EQ(cells[n].normal, (std::array<float, 3>{0, 0, -1})) << n - noise;
}

// From above: what stands on the floor is seen, what lies behind a wall is not.
TEST(OpenSides, show_what_stands_in_a_room) {
    Scene scene = without_normals();
    const auto sees = [&](std::int32_t object) {
        const auto view = pack_view(scene);
        return SceneImage(scene, view, 640, 400, {10, 10, 10, 10}).sees(object);
    };
    for (const std::int32_t object : {1, 2, 3, 4, 5}) EXPECT_TRUE(sees(object)) << object;
    for (std::size_t i = 0; i < scene.solid.x.size(); ++i) {
        if (scene.solid.object[i] == 5) scene.solid.y[i] += 4.6f;
    }
    EXPECT_FALSE(sees(5)) << "behind the wall to the north";
}

}  // namespace
}  // namespace topple::report
