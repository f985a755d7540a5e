// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/pipeline/scan.h"
#include "lab/solids/ray_caster.h"

// Laser stations that don't see all of what carries things.
namespace topple::test {
namespace {

scenes::Part block(const Vec3& low, const Vec3& high) {
    scenes::Part part;
    for (std::size_t a = 0; a < 3; ++a) {
        part.center[a] = (low[a] + high[a]) / 2;
        part.size[a] = high[a] - low[a];
    }
    return part;
}

constexpr double thick_m = 0.04, under_m = 0.43, top_m = 0.47;

// A corner of a room; a low table with a carton on it, before which both stations stand: its top
// hides a leg from them, and the carton hides some of its top.
std::vector<scenes::Part> room() {
    std::vector<scenes::Part> out{
        block({0, 0, -0.1}, {2.4, 2, 0}), block({-0.1, 0, 0}, {0, 2, 1.7}),
        block({0, -0.1, 0}, {2.4, 0, 1.7}), block({1.18, 0.6, under_m}, {2.02, 1.1, top_m}),
        block({1.5, 0.74, top_m}, {1.7, 0.9, top_m + 0.3})};
    for (const double x : {1.2, 1.96})
        for (const double y : {0.62, 1.04})
            out.push_back(block({x, y, 0}, {x + thick_m, y + thick_m, under_m}));
    return out;
}

PointCloud scanned(const std::vector<scenes::Part>& parts) {
    const scenes::RayCaster caster(parts);
    constexpr double step = 0.5 * std::numbers::pi / 180;
    PointCloud out;
    for (const Vec3& eye : {Vec3{0.3, 1.6, 1.3}, Vec3{2, 1.7, 1.4}}) {
        for (double azimuth = 0; azimuth < 2 * std::numbers::pi; azimuth += step) {
            for (double up = -1.4; up < 0.8; up += step) {
                const Vec3 d{std::cos(azimuth) * std::cos(up), std::sin(azimuth) * std::cos(up),
                             std::sin(up)};
                const auto hit = caster.cast(eye, d);
                if (hit.part < 0) continue;
                out.x.push_back(static_cast<float>(eye[0] + hit.distance * d[0]));
                out.y.push_back(static_cast<float>(eye[1] + hit.distance * d[1]));
                out.z.push_back(static_cast<float>(eye[2] + hit.distance * d[2]));
                out.viewpoint_x.push_back(static_cast<float>(eye[0]));
                out.viewpoint_y.push_back(static_cast<float>(eye[1]));
                out.viewpoint_z.push_back(static_cast<float>(eye[2]));
            }
        }
    }
    return out;
}

const Object* object_at(const Scene& scene, double x, double y, double z) {
    for (const Object& o : scene.objects) {
        const Vec3& c = o.center_of_mass_m;
        if (!o.grounded && std::hypot(c[0] - x, c[1] - y, c[2] - z) < 0.15) return &o;
    }
    return nullptr;
}

double tipping_J(double mass_kg, double height_m, double margin_m) {
    return mass_kg * 9.80665 * (std::hypot(height_m, margin_m) - height_m);
}

TEST(UnseenLeg, WhatNoStationSawMayCarry) {
    const Scene scene = parse(scanned(room()), on(device::open_device("native"))).scene;
    const Object* table = object_at(scene, 1.6, 0.85, 0.4);
    const Object* carton = object_at(scene, 1.6, 0.82, 0.62);
    ASSERT_NE(table, nullptr);
    ASSERT_NE(carton, nullptr);
    const double of_top = 0.84 * 0.5 * thick_m, of_legs = 4 * thick_m * thick_m * under_m;
    const double height =
        (of_top * (under_m + thick_m / 2) + of_legs * under_m / 2) / (of_top + of_legs);
    const double right = tipping_J(700 * (of_top + of_legs), height, 0.22);
    EXPECT_NEAR(table->barrier_J, right, 2 * table->barrier_error_J) << table->why.sentence;
    EXPECT_GT(table->barrier_J, right / 2) << "of three legs: a fifteenth";
    EXPECT_NE(table->advice.kind, "fix") << table->advice.sentence;
    EXPECT_NEAR(carton->barrier_J, tipping_J(700 * 0.2 * 0.16 * 0.3, 0.15, 0.08), 0.3)
        << carton->why.sentence;
    EXPECT_EQ(carton->mode, "tip");
}

}  // namespace
}  // namespace topple::test
