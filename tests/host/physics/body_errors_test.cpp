// SPDX-License-Identifier: MIT
#include "physics/body_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "device/devices.h"
#include "host/solids/boxes.h"
#include "solids/boundary.h"
#include "solids/cell_shape.h"

namespace topple::physics {
namespace {

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
