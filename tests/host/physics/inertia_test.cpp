// SPDX-License-Identifier: MIT
#include "physics/inertia.h"

#include "device/devices.h"
#include "host/physics/solids.h"
#include "host/solids/boxes.h"
#include "physics/body_errors.h"
#include "solids/boundary.h"
#include "solids/cell_shape.h"
#include "testing.h"

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

constexpr double voxel = 0.02, density = 500;

struct Known {
    MassProperties body;
    BodyError error;
    double offset_m = 0;  // of the patches
};

// Of all boxes as one body.
Known known(const std::vector<solids::Box>& boxes) {
    const auto device = device::open_native();
    const solids::Scanned scanned = solids::scan(boxes, voxel);
    const BoundaryCells boundary =
        solids::find_boundary(*device, scanned.cells, scanned.seen(), scanned.patches,
                              std::vector<bool>(boxes.size(), false));
    const std::vector<double> densities(boxes.size(), density);
    const auto bodies = mass_properties(
        *device, scanned.cells, static_cast<std::int32_t>(boxes.size()), densities, boundary);
    std::vector<std::int32_t> all;
    for (std::size_t n = 0; n < boxes.size(); ++n) all.push_back(static_cast<std::int32_t>(n));
    Known out;
    out.body = combine(bodies);
    out.error = body_error(out.body, all, volume_errors(scanned.cells, boundary), densities);
    out.offset_m = boundary.patches[0].offset_m;
    return out;
}

const solids::Box askew{{0.31, -0.2, 0.5}, {0.1, 0.15, 0.2}, solids::turned(0.4, 0.1, -0.05)};

// What a face of a box is off: by its patch, and by as much as the box is thin, 0.06 h^2 / t, where
// t is the thickness of a board of its volume and surface.
double off(const Known& k, const std::array<double, 3>& half) {
    const double volume = 8 * half[0] * half[1] * half[2];
    const double surface = 8 * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0]);
    return std::hypot(k.offset_m, 0.06 * voxel * voxel * surface / (2 * volume));
}

// Each face moves by itself: the mass by area x offset, the centre by that on its arm.
TEST(BodyErrors, OfASeenBoxAreThoseOfItsFaces) {
    const Known k = known({askew});
    const std::array<double, 3> half{0.1, 0.15, 0.2};
    double mass = 0;
    Vec3 moment{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double area = 4 * half[(a + 1) % 3] * half[(a + 2) % 3];
        const double face = density * area * off(k, half);
        mass += 2 * face * face;
        for (std::size_t b = 0; b < 3; ++b) {
            const double arm = half[a] * askew.axes(static_cast<int>(b), static_cast<int>(a));
            moment[b] += 2 * face * face * arm * arm;
        }
    }
    EXPECT_NEAR(k.error.mass_kg / std::sqrt(mass), 1, 0.08);
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(k.error.center_m[b] / (std::sqrt(moment[b]) / k.body.mass_kg), 1, 0.1);
}

// A board of one voxel's thickness is known to a twentieth, one of five to a two-hundredth.
TEST(BodyErrors, GrowAsASolidGetsThin) {
    const auto share = [](double half) {
        const Known k =
            known({{{0.31, -0.2, 0.5}, {0.2, 0.15, half}, solids::turned(0.4, 0.1, -0.05)}});
        const double face = 2 * 0.4 * 0.3 * off(k, {0.2, 0.15, half}) / std::sqrt(2.0);
        // The area of a board of one voxel is known to a sixth from the voxels that it passes.
        EXPECT_NEAR(k.error.mass_kg / (density * face), 1, 0.17);
        return k.error.mass_kg / k.body.mass_kg;
    };
    EXPECT_GT(share(0.5 * voxel), 6 * share(2.5 * voxel));
}

// A side that nobody saw is known to half a voxel, which outweighs all others.
TEST(BodyErrors, OfAnUnseenSideAreHalfAVoxel) {
    solids::Box box{{0.31, -0.2, 0.5}, {0.1, 0.15, 0.2}};
    box.seen = 63 & ~16U;  // all but the underside
    const Known k = known({box});
    const double mass = density * 0.2 * 0.3 * solids::voxel_error * voxel;
    EXPECT_NEAR(k.error.mass_kg / mass, 1, 0.15);
    EXPECT_NEAR(k.error.center_m[2] / (mass * 0.2 / k.body.mass_kg), 1, 0.2);
    EXPECT_LT(k.error.center_m[0], 0.2 * k.error.center_m[2]);
}

// Where two parts of one body meet, one has what the other has not.
TEST(BodyErrors, WithinABodyCancel) {
    solids::Box lower{{0.3, 0.2, 0.1}, {0.1, 0.1, 0.1}}, upper{{0.3, 0.2, 0.3}, {0.1, 0.1, 0.1}};
    lower.seen = upper.seen = 63 & ~48U;
    lower.seen |= 16;
    upper.seen |= 32;
    solids::Box whole{{0.3, 0.2, 0.2}, {0.1, 0.1, 0.2}};
    const Known two = known({lower, upper}), one = known({whole});
    EXPECT_NEAR(two.body.mass_kg / one.body.mass_kg, 1, 0.02);
    EXPECT_LT(two.error.mass_kg, 1.2 * one.error.mass_kg);
}

TEST(BodyErrors, OfNothingAreNone) {
    EXPECT_TRUE(volume_errors({}, {}).empty());
    EXPECT_EQ(body_error({}, {}, {}, {}).mass_kg, 0);
}

}  // namespace
}  // namespace topple::physics
