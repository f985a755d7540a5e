// SPDX-License-Identifier: MIT
#include "physics/inertia.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "device/devices.h"
#include "host/physics/solids.h"
#include "host/solids/boxes.h"
#include "solids/boundary.h"

namespace topple::physics {
namespace {

constexpr double wood_kg_m3 = 500;

// Of boxes as one object.
std::vector<Symmetric> inertia_of(const std::vector<solids::Box>& boxes, double voxel) {
    const auto device = device::open_native();
    const solids::Scanned scanned = solids::scan(boxes, voxel);
    const auto count = static_cast<std::int32_t>(boxes.size());
    const BoundaryCells boundary =
        solids::find_boundary(*device, scanned.cells, scanned.seen(), scanned.patches,
                              std::vector<bool>(boxes.size(), false));
    const std::vector<double> densities(boxes.size(), wood_kg_m3);
    const auto bodies = mass_properties(*device, scanned.cells, count, densities, boundary);
    return inertia_of_objects(second_moments(scanned.cells, count, boundary), bodies,
                              std::vector<std::int32_t>(boxes.size(), 0), std::vector{wood_kg_m3});
}

// Of a box about its own middle, in the axes of the world.
Eigen::Matrix3d of_box(const solids::Box& box) {
    const Eigen::Vector3d side = 2 * box.half;
    const double mass = wood_kg_m3 * box.volume();
    Eigen::Vector3d own;
    for (int a = 0; a < 3; ++a) {
        const double b = side[(a + 1) % 3], c = side[(a + 2) % 3];
        own[a] = mass * (b * b + c * c) / 12;
    }
    return box.axes * own.asDiagonal() * box.axes.transpose();
}

Eigen::Matrix3d full(const Symmetric& s) {
    Eigen::Matrix3d out;
    out << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    return out;
}

TEST(Inertia, OfABoxAskewToTheGridIsItsClosedForm) {
    const solids::Box box{{2.31, -1.2, 0.5}, {0.1, 0.15, 0.3}, solids::turned(0.4, 0.1, -0.05)};
    const Eigen::Matrix3d truth = of_box(box);
    for (const double voxel : {0.02, 0.01}) {
        const auto found = inertia_of({box}, voxel);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_LT((full(found[0]) - truth).norm() / truth.norm(), 0.01) << voxel;
    }
}

// Two boxes far apart: their own moments, and those of their masses about the middle between them.
TEST(Inertia, OfTwoPartsFollowsSteiner) {
    const solids::Box a{{0.5, 0.5, 0.5}, {0.1, 0.1, 0.1}}, b{{1.5, 0.5, 0.5}, {0.1, 0.1, 0.1}};
    const auto found = inertia_of({a, b}, 0.02);
    Eigen::Matrix3d truth = of_box(a) + of_box(b);
    const double mass = wood_kg_m3 * a.volume();
    truth(1, 1) += 2 * mass * 0.25;
    truth(2, 2) += 2 * mass * 0.25;
    EXPECT_LT((full(found[0]) - truth).norm() / truth.norm(), 0.01);
}

TEST(Inertia, WholeVoxelsAreCubes) {
    const SolidCells cells =
        test::voxelise({{0, test::box({0, 0, 0}, {0.2, 0.4, 0.6})}}, {0, 0, 0}, {1, 1, 1}, 0.1);
    const auto device = device::open_native();
    const auto bodies = mass_properties(*device, cells, 1, std::vector{wood_kg_m3});
    const auto found = inertia_of_objects(second_moments(cells, 1, {}), bodies,
                                          std::vector<std::int32_t>{0}, std::vector{wood_kg_m3});
    const Eigen::Matrix3d truth = of_box({{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}});
    EXPECT_LT((full(found[0]) - truth).norm() / truth.norm(), 1e-12);
}

TEST(Inertia, OfNothingIsNothing) {
    EXPECT_TRUE(second_moments({}, 0, {}).empty());
    const auto found = inertia_of_objects(std::vector<Symmetric>(1), std::vector<MassProperties>(1),
                                          std::vector<std::int32_t>{0}, std::vector{wood_kg_m3});
    EXPECT_EQ(found[0], Symmetric{});
}

}  // namespace
}  // namespace topple::physics
