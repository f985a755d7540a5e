// SPDX-License-Identifier: MIT
#include "report/pictures.h"

#include <png.h>

#include "host/io/files.h"
#include "report/depth_image.h"
#include "report/part_spots.h"
#include "synthetic_scene.h"
#include "topple/error.h"

namespace topple::report {
namespace {

namespace fs = std::filesystem;

// The camera at (0, 0, -2), looking along z; a metre at depth 2 is 50 pixels.
Camera level_camera() {
    return {{0, 0, -2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 100, 50, 50};
}

TEST(DepthImage, covers_each_pixel_of_a_square_once) {
    DepthImage image(100, 100);
    const Camera camera = level_camera();
    image.triangle(camera, {-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, 1);
    image.triangle(camera, {-0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}, 2);
    int count[3] = {};
    for (std::size_t at = 0; at < 10000; ++at) {
        if (image.what(at) == DepthImage::nothing) {
            EXPECT_TRUE(std::isinf(image.depth(at)));
            continue;
        }
        EXPECT_NEAR(image.depth(at), 2, 1e-6);
        ++count[image.what(at)];
    }
    // 50 x 50 pixels, half of them each.
    EXPECT_EQ(count[1] + count[2], 2500);
    EXPECT_NEAR(count[1], 1250, 25);
}

TEST(DepthImage, the_nearer_of_two_is_in_front_in_either_order) {
    const Camera camera = level_camera();
    for (const bool far_first : {true, false}) {
        DepthImage image(100, 100);
        for (int n = 0; n < 2; ++n) {
            const bool far = (n == 0) == far_first;
            // The far one leans: it comes through the near one at x = 0.
            const double left = far ? 1 : 0, right = far ? -1 : 0;
            image.triangle(camera, {-1, -1, left}, {1, -1, right}, {0, 1, 0}, far ? 7 : 8);
        }
        EXPECT_EQ(image.what(70 * 100 + 40), 8u);
        EXPECT_EQ(image.what(70 * 100 + 60), 7u);
    }
}

TEST(DepthImage, leaves_out_what_reaches_behind_the_camera) {
    DepthImage image(10, 10);
    image.triangle(level_camera(), {-1, -1, 0}, {1, -1, 0}, {0, 1, -3}, 1);
    for (std::size_t at = 0; at < 100; ++at) EXPECT_EQ(image.what(at), DepthImage::nothing);
}

TEST(Camera, the_box_fits_into_the_picture_and_fills_it) {
    for (const double tall : {0.2, 2.5, 12.0}) {
        const Extents<double> box{{-3, 1, 0}, {2, 5, tall}};
        const Camera camera = camera_on(box, 800, 500, {10, 20, 60, 30});
        double west = 1e9, east = -1e9, top = 1e9, bottom = -1e9;
        for (unsigned n = 0; n < 8; ++n) {
            if (n == 4) continue;  // the nearest upper corner, which is looked through
            const auto [x, y, depth] = camera.project(box.corners()[n]);
            EXPECT_GT(depth, 0);
            west = std::min(west, x);
            east = std::max(east, x);
            top = std::min(top, y);
            bottom = std::max(bottom, y);
        }
        EXPECT_GT(west, 10 - 2);
        EXPECT_LT(east, 780 + 2);
        EXPECT_GT(top, 60 - 2);
        EXPECT_LT(bottom, 470 + 2);
        EXPECT_TRUE(east - west > 0.97 * 770 || bottom - top > 0.97 * 410) << tall;
    }
}

class PicturesOfAScene : public test::Files {
  protected:
    fs::path drawn(const std::string& name, const Scene& scene) {
        fs::create_directory(folder_ / name);
        write_pictures(folder_ / name, scene);
        return folder_ / name;
    }
    static std::set<std::string> names(const fs::path& folder) {
        std::set<std::string> out;
        for (const auto& entry : fs::directory_iterator(folder))
            out.insert(entry.path().filename().string());
        return out;
    }
    struct Pixels {
        png_uint_32 width = 0, height = 0;
        std::vector<std::uint8_t> rgb;
    };
    static Pixels pixels(const fs::path& file) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        Pixels out;
        if (!png_image_begin_read_from_file(&image, file.c_str())) return out;
        image.format = PNG_FORMAT_RGB;
        out.width = image.width;
        out.height = image.height;
        out.rgb.resize(PNG_IMAGE_SIZE(image));
        if (!png_image_finish_read(&image, nullptr, out.rgb.data(), 0, nullptr)) out.rgb.clear();
        return out;
    }
    static std::size_t different(const Pixels& a, const Pixels& b) {
        std::size_t count = 0;
        for (std::size_t at = 0; at + 2 < std::min(a.rgb.size(), b.rgb.size()); at += 3)
            count += std::memcmp(&a.rgb[at], &b.rgb[at], 3) != 0;
        return count;
    }
};

TEST_F(PicturesOfAScene, are_drawn_the_same_each_time) {
    const Scene scene = test::SyntheticScene(0.06).make();
    const fs::path a = drawn("a", scene), b = drawn("b", scene);
    const std::set<std::string> all{"view-completed.png", "view-earthquake.png", "view-human.png",
                                    "view-objects.png",   "view-parts.png",      "view-risk.png",
                                    "view-walks.png",     "view-wind.png"};
    EXPECT_EQ(names(a), all);
    const Pixels objects = pixels(a / "view-objects.png");
    for (const std::string& name : all) {
        EXPECT_EQ(test::bytes_of_file(a / name), test::bytes_of_file(b / name)) << name;
        const Pixels picture = pixels(a / name);
        EXPECT_EQ(picture.width, 1280u);
        EXPECT_EQ(picture.height, 800u);
        ASSERT_EQ(picture.rgb.size(), 1280u * 800 * 3) << name;
        // No view is blank, and none is another's.
        if (name == "view-objects.png") continue;
        EXPECT_GT(different(picture, objects), 20000u) << name;
    }
    // Solids, shaded.
    std::set<std::array<std::uint8_t, 3>> colours;
    for (std::size_t at = 0; at < objects.rgb.size(); at += 3)
        colours.insert({objects.rgb[at], objects.rgb[at + 1], objects.rgb[at + 2]});
    EXPECT_GT(colours.size(), 500u);
}

TEST_F(PicturesOfAScene, are_only_drawn_of_what_there_is) {
    Scene scene = test::SyntheticScene(0.2).make();
    scene.walks = {};
    scene.fields.erase("wind");
    scene.fields["human"] = {};
    EXPECT_EQ(names(drawn("some", scene)),
              (std::set<std::string>{"view-completed.png", "view-earthquake.png",
                                     "view-objects.png", "view-parts.png", "view-risk.png"}));
    EXPECT_EQ(names(drawn("none", Scene{})),
              (std::set<std::string>{"view-completed.png", "view-objects.png", "view-parts.png",
                                     "view-risk.png"}));
}

TEST_F(PicturesOfAScene, show_the_scans_own_colours) {
    Scene scene = test::SyntheticScene(0.1).make();
    scene.walks = {};
    scene.fields.clear();
    auto& p = scene.points;
    p.red.assign(p.x.size(), 30);
    p.green.assign(p.x.size(), 160);
    p.blue.assign(p.x.size(), 40);
    const fs::path all = drawn("photo", scene);
    EXPECT_EQ(names(all),
              (std::set<std::string>{"view-completed.png", "view-objects.png", "view-parts.png",
                                     "view-photo.png", "view-risk.png"}));
    const Pixels picture = pixels(all / "view-photo.png");
    std::size_t green = 0;
    for (std::size_t at = 0; at + 2 < picture.rgb.size(); at += 3)
        green += picture.rgb[at + 1] > 2 * picture.rgb[at] + 20;
    EXPECT_GT(green, 1280u * 800 / 5);
}

TEST_F(PicturesOfAScene, can_not_be_written) {
    EXPECT_THROW(write_pictures(folder_ / "missing", Scene{}), Error);
}

// A level sheet of cells, whose groups are told by x and y.
template <class Group>
std::vector<Cell> sheet(int width, int depth, CellTable& table, const Group& group) {
    std::vector<Cell> cells;
    for (int y = 0; y < depth; ++y) {
        for (int x = 0; x < width; ++x) {
            Cell cell;
            cell.index = {x, y, 0};
            cell.group = static_cast<std::uint16_t>(group(x, y));
            cell.exposed = 32;
            table.insert(cell.index, static_cast<std::uint32_t>(cells.size()));
            cells.push_back(cell);
        }
    }
    return cells;
}

TEST(PartSpots, lie_in_the_middle_of_what_was_seen) {
    CellTable table;
    auto cells = sheet(21, 11, table, [](int, int) { return 0; });
    EXPECT_EQ(cells[inner_cells(cells, table, 1)[0]].index,
              (std::array<std::int32_t, 3>{10, 5, 0}));
    for (Cell& cell : cells) cell.completed = cell.index[0] > 4;
    EXPECT_EQ(cells[inner_cells(cells, table, 1)[0]].index, (std::array<std::int32_t, 3>{2, 5, 0}));
    for (Cell& cell : cells) cell.completed = true;
    EXPECT_EQ(cells[inner_cells(cells, table, 1)[0]].index, (std::array<std::int32_t, 3>{10, 5, 0}))
        << "better than nothing";
}

// Around a thing that stands on its middle a part still has a place far from that.
TEST(PartSpots, keep_away_from_other_parts) {
    CellTable table;
    const auto within = [](int x, int y) { return x >= 8 && x < 13 && y >= 8 && y < 13; };
    const auto cells = sheet(21, 21, table, within);
    const auto spots = inner_cells(cells, table, 3);
    const auto& outer = cells[spots[0]].index;
    for (int x = 8; x < 13; ++x)
        for (int y = 8; y < 13; ++y) EXPECT_GE(std::abs(outer[0] - x) + std::abs(outer[1] - y), 4);
    EXPECT_EQ(cells[spots[1]].index, (std::array<std::int32_t, 3>{10, 10, 0}));
    EXPECT_EQ(spots[2], CellTable::absent) << "of a group without cells";
}

TEST(PartSpots, become_points_of_the_scan) {
    ScenePoints points;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    points.x = {0.1f, 0.2f, 0.3f, nan, 0.26f};
    points.y = points.z = {0, 0, 0, 0, 0};
    points.primitive = {7, 7, 7, 7, 3};
    const std::vector<std::pair<std::int32_t, std::int32_t>> groups{{-1, -1}, {7, 1}, {9, 2}};
    const auto places = nearest_points(points, groups, {{}, Vec3{0.25, 0.01, 0}, Vec3{1, 1, 1}});
    EXPECT_FALSE(places[0]);
    EXPECT_FLOAT_EQ(float((*places[1])[0]), 0.2f);
    EXPECT_EQ((*places[2])[0], 1) << "nothing of it was scanned";
}

}  // namespace
}  // namespace topple::report
