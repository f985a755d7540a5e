// SPDX-License-Identifier: MIT
#include "core/solid_scene.h"

#include "testing.h"
#include "topple/error.h"

namespace topple {
namespace {

SolidCells cells_at(const std::vector<std::array<std::int32_t, 3>>& places,
                    std::int32_t primitive = 0) {
    SolidCells cells;
    cells.voxel_m = 0.02;
    for (const auto& [i, j, k] : places) {
        cells.i.push_back(i);
        cells.j.push_back(j);
        cells.k.push_back(k);
        cells.primitive.push_back(primitive);
        cells.basis.push_back(Basis::surface);
    }
    return cells;
}

TEST(SolidScene, HoldsCellsByColumnAndRolesByPrimitive) {
    const SolidScene scene(cells_at({{0, 0, 0}, {0, 0, 1}, {0, 2, 5}, {3, -1, 7}}),
                           {Role::floor, Role::none, Role::wall});
    EXPECT_EQ(scene.columns().at(0, 0), std::pair(std::size_t{0}, std::size_t{2}));
    EXPECT_EQ(scene.columns().at(3, -1), std::pair(std::size_t{3}, std::size_t{4}));
    EXPECT_EQ(scene.columns().at(1, 0).first, scene.columns().at(1, 0).second);
    EXPECT_EQ(scene.role(0), Role::floor);
    EXPECT_EQ(scene.role(-1), Role::none);
    EXPECT_EQ(scene.shell(), (std::vector<bool>{true, false, true}));
}

TEST(SolidScene, StraysAreShownButNoCells) {
    const SolidScene scene(cells_at({{0, 0, 0}, {5, 0, 0}}), {Role::none},
                           cells_at({{-900, 0, 0}, {2, 900, 0}, {900, 0, 0}}, -1));
    EXPECT_EQ(scene.cells().size(), 2u);
    const SolidCells all = scene.with_strays();
    EXPECT_EQ(all.i, (std::vector<std::int32_t>{-900, 0, 2, 5, 900}));
    EXPECT_EQ(all.primitive, (std::vector<std::int32_t>{-1, 0, -1, 0, -1}));
}

TEST(SolidScene, RefusesWhatIsNoScene) {
    EXPECT_THROW(SolidScene(cells_at({{0, 0, 1}, {0, 0, 0}}), {Role::none}), Error);
    EXPECT_THROW(SolidScene(cells_at({{0, 0, 0}, {0, 0, 0}}), {Role::none}), Error);
    EXPECT_THROW(SolidScene(cells_at({{0, 0, 0}}, 1), {Role::none}), Error);
    SolidCells short_of_one = cells_at({{0, 0, 0}});
    short_of_one.basis.clear();
    EXPECT_THROW(SolidScene(std::move(short_of_one), {Role::none}), Error);
}

// What is more enclosed is surer, and nothing is certain, nor, but for what is unlikely, as good as
// chance.
TEST(Basis, IsAProbability) {
    for (std::uint8_t b = 0; b < basis_count; ++b) {
        const double p = probability_solid(static_cast<Basis>(b));
        EXPECT_GT(p, static_cast<Basis>(b) == Basis::unlikely ? 0.0 : 0.5);
        EXPECT_LT(p, 1.0);
    }
    EXPECT_GT(probability_solid(Basis::enclosed), probability_solid(Basis::half_enclosed));
}

}  // namespace
}  // namespace topple
