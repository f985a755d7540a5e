// SPDX-License-Identifier: MIT
#include "lab/evaluation/bases.h"

#include <gtest/gtest.h>

#include <utility>

namespace topple::evaluation {
namespace {

// A box on a floor; what is inside is right, what is above it is not, and the floor is not judged.
TEST(Bases, AreJudgedByTheTruth) {
    scenes::World world;
    world.room = {4, 3, 2.5};
    world.objects = {{"room", "room"}, {"box", "floor"}};
    world.parts.push_back({scenes::Shape::box, {2, 1.5, -0.05}, {4, 3, 0.1}, 0, 0, 0, "floor"});
    world.parts.push_back({scenes::Shape::box, {2, 1.5, 0.2}, {0.4, 0.4, 0.4}, 0, 0, 1, "box"});
    SolidCells cells;
    cells.voxel_m = 0.02;
    const auto add = [&](std::int32_t k, Basis basis) {
        cells.i.push_back(100);
        cells.j.push_back(75);
        cells.k.push_back(k);
        cells.primitive.push_back(0);
        cells.basis.push_back(basis);
    };
    add(-2, Basis::surface);
    for (std::int32_t k = 5; k < 10; ++k) add(k, Basis::two_votes);
    add(30, Basis::two_votes);
    add(40, Basis::column);
    BasisCounts counts;
    add_voxels(world, SolidScene(std::move(cells), {Role::none}),
               {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, counts);
    const auto of = [&](Basis b) { return counts.basis[static_cast<std::size_t>(b)]; };
    EXPECT_EQ(of(Basis::surface).of, 0u);
    EXPECT_EQ(of(Basis::two_votes).of, 6u);
    EXPECT_EQ(of(Basis::two_votes).right, 5u);
    EXPECT_EQ(of(Basis::column).of, 1u);
    EXPECT_EQ(of(Basis::column).right, 0u);
    EXPECT_NE(table_of(counts).find("0.8333"), std::string::npos);
}

}  // namespace
}  // namespace topple::evaluation
