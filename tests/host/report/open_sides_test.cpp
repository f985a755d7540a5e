// SPDX-License-Identifier: MIT
#include "report/open_sides.h"

#include <gtest/gtest.h>

#include "report/scene_image.h"
#include "synthetic_scene.h"

namespace topple::report {
namespace {

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
            if (p[2] < 0 && amid_x && amid_y) {
                EXPECT_GT(normal[2], 100) << "the floor";
            }
            if (p[2] > 2.5 && amid_x && amid_y) {
                EXPECT_LT(normal[2], -100) << "the ceiling";
            }
            if (p[2] < 0.2 || p[2] > 2.3) continue;
            if (p[0] < 0 && amid_y) {
                EXPECT_GT(normal[0], 100) << "the wall to the west";
            }
            if (p[0] > 4 && amid_y) {
                EXPECT_LT(normal[0], -100) << "the wall to the east";
            }
            if (p[1] < 0 && amid_x) {
                EXPECT_GT(normal[1], 100) << "the wall to the south";
            }
            if (p[1] > 5 && amid_x) {
                EXPECT_LT(normal[1], -100) << "the wall to the north";
            }
            ++checked;
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

// Layers of 4 m x 4 m of cells of 10 cm at the given heights, and their normals' third component.
std::vector<float> facing(const std::vector<std::int32_t>& heights) {
    std::vector<Cell> cells;
    for (const std::int32_t z : heights) {
        for (std::int32_t n = 0; n < 1600; ++n)
            cells.push_back({.index = {n % 40, n / 40, z}, .background = true});
    }
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
    std::vector<Cell> cells;
    for (const std::int32_t z : {0, 25}) {
        for (std::int32_t n = 0; n < 1600; ++n)
            cells.push_back({.index = {n % 40, n / 40, z}, .background = true});
    }
    const std::size_t ceiling = 1600;
    for (std::int32_t n = 0; n < 60; ++n)
        cells.push_back({.index = {10 + n % 12, n / 12, 20}, .background = true});
    face_all(cells);
    for (std::size_t n = 0; n < 1600; ++n) EXPECT_EQ(cells[ceiling + n].normal[2], -1) << n;
}

TEST(OpenSides, of_what_stands_out_of_a_ceiling_are_the_ceilings) {
    std::vector<Cell> cells;
    for (const std::int32_t z : {0, 25}) {
        for (std::int32_t n = 0; n < 1600; ++n)
            cells.push_back({.index = {n % 40, n / 40, z}, .background = true});
    }
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
