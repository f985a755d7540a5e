// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "core/vectors.h"
#include "host/pipeline/scan.h"

// Plain boxes on a floor, as cabinets are, in bare clouds as phones hand them over.
namespace topple::test {
namespace {

struct FaceCloud {
    PointCloud cloud;
    // Points at random on the parallelogram from `at` along a and b.
    void face(const Vec3& at, const Vec3& a, const Vec3& b) {
        const double area = length(cross(a, b));
        for (double n = 0; n < per_m2 * area; ++n) {
            const double u = next(), v = next();
            cloud.x.push_back(static_cast<float>(at[0] + u * a[0] + v * b[0]));
            cloud.y.push_back(static_cast<float>(at[1] + u * a[1] + v * b[1]));
            cloud.z.push_back(static_cast<float>(at[2] + u * a[2] + v * b[2]));
        }
    }
    void box(double x, double y, const Vec3& size) {
        const Vec3 w{size[0], 0, 0}, d{0, size[1], 0}, h{0, 0, size[2]};
        face({x, y, size[2]}, w, d);
        for (const double far : {0.0, 1.0}) {
            face({x, y + far * size[1], 0}, w, h);
            face({x + far * size[0], y, 0}, d, h);
        }
    }

  private:
    static constexpr double per_m2 = 1000;
    std::uint64_t state_ = 5;
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state_ >> 11) * 0x1p-53;
    }
};

const Object* object_at(const Scene& scene, const Vec3& center) {
    for (const Object& o : scene.objects)
        if (!o.grounded && length(minus(o.center_of_mass_m, center)) < 0.2) return &o;
    return nullptr;
}

TEST(StandingBox, IsAThingOrTold) {
    for (const double gap_m : {0.9, 0.4}) {
        FaceCloud scan;
        scan.face({0, 0, 0}, {2.4, 0, 0}, {0, 2, 0});
        if (gap_m < 0.5) scan.face({0, 0, 0}, {2.4, 0, 0}, {0, 0, 2.2});
        scan.box(0.5, gap_m, {0.8, 0.35, 1.8});
        const Scene scene = parse(scan.cloud, on(device::open_device("native"))).scene;
        const bool told = std::ranges::any_of(scene.notes, [](const std::string& note) {
            return note.find("upright piece that may be a thing") != std::string::npos;
        });
        EXPECT_TRUE(told || object_at(scene, {0.9, gap_m + 0.175, 0.9}) != nullptr) << gap_m;
    }
}

// Ten centimetres from a wall: by a voxel it has one behind it, as closed furniture has.
TEST(StandingBox, WeighsAsMuchFromAnotherOrigin) {
    FaceCloud scan;
    scan.face({0, 0, 0}, {2.4, 0, 0}, {0, 2, 0});
    scan.face({0, 0, 0}, {2.4, 0, 0}, {0, 0, 1.6});
    scan.box(0.5, 0.1, {0.3, 0.3, 1.2});
    double low_kg = 0, high_kg = INFINITY;
    for (const double shift_m : {0.0, 0.005, 0.013}) {
        PointCloud moved = scan.cloud;
        for (float& y : moved.y) y += static_cast<float>(shift_m);
        const Scene scene = parse(moved, on(device::open_device("native"))).scene;
        const Object* box = object_at(scene, {0.65, 0.25 + shift_m, 0.6});
        ASSERT_NE(box, nullptr) << shift_m;
        low_kg = std::max(low_kg, box->mass_kg - 2 * box->mass_error_kg);
        high_kg = std::min(high_kg, box->mass_kg + 2 * box->mass_error_kg);
    }
    EXPECT_LT(low_kg, high_kg) << "errors cover all";
}

}  // namespace
}  // namespace topple::test
