// SPDX-License-Identifier: MIT
#include "clouds.h"
#include "core/random.h"
#include "core/vectors.h"
#include "device/devices.h"
#include "host/pipeline/scan.h"

// Bare points a centimetre apart, or at random, of things whose measures are known.
namespace topple::test {
namespace {

constexpr double spacing_m = 0.01, noise_m = 0.001;

class SparseCloud : public ::testing::Test {
  protected:
    // A rectangle across `axis` at `at`; a tenth of the points is left out.
    void face(std::size_t axis, double at, const Vec3& from, const Vec3& to) {
        const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (double u = from[a]; u < to[a] + spacing_m / 2; u += spacing_m) {
            for (double v = from[b]; v < to[b] + spacing_m / 2; v += spacing_m) {
                Vec3 p{};
                p[a] = u, p[b] = v, p[axis] = at;
                // The sum of twelve is as good as normal.
                for (double& x : p) {
                    double sum = -6;
                    for (int n = 0; n < 12; ++n) sum += random.uniform();
                    x += noise_m * sum;
                }
                if (random.uniform() >= 0.1) test::add(cloud, p);
            }
        }
    }
    void box(const Vec3& low, const Vec3& high) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const Vec3& at : {low, high}) face(axis, at[axis], low, high);
        const Vec3 size = minus(high, low);
        volume_m3 += size[0] * size[1] * size[2];
    }
    // Points at random on a rectangle across `axis` at `at`.
    void scatter(std::size_t axis, double at, const Vec3& from, const Vec3& to, double per_m2) {
        const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double count = per_m2 * (to[a] - from[a]) * (to[b] - from[b]);
        for (int n = 0; n < static_cast<int>(count); ++n) {
            Vec3 p{};
            p[a] = random.uniform(from[a], to[a]);
            p[b] = random.uniform(from[b], to[b]);
            p[axis] = at;
            test::add(cloud, p);
        }
    }
    // All sides but the underside.
    void scatter_box(const Vec3& low, const Vec3& high, double per_m2) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const Vec3& at : {low, high})
                if (axis < 2 || at[2] > low[2]) scatter(axis, at[axis], low, high, per_m2);
    }
    static Scene parsed(const PointCloud& cloud) {
        ParseOptions options;
        options.device = device::open_native(2);
        options.disturbances = {};
        return parse(cloud, options).scene;
    }
    Random random{5};
    PointCloud cloud;
    double volume_m3 = 0;
};

// Both faces of its top are seen, of which each needs its own side.
TEST_F(SparseCloud, ATableHasItsMass) {
    face(2, 0, {0, 0, 0}, {2.4, 2, 0});
    face(0, 0, {0, 0, 0}, {0, 2, 1.5});
    face(1, 0, {0, 0, 0}, {2.4, 0, 1.5});
    box({0.8, 0.7, 0.56}, {1.6, 1.3, 0.6});
    for (const double x : {0.8, 1.55})
        for (const double y : {0.7, 1.25}) box({x, y, 0}, {x + 0.05, y + 0.05, 0.56});
    const Scene scene = parsed(cloud);
    EXPECT_TRUE(noted(scene, "mm apart"));
    const Object* table = nullptr;
    for (const Object& object : scene.objects)
        if (!object.grounded && (!table || object.mass_kg > table->mass_kg)) table = &object;
    ASSERT_TRUE(table);
    const double mass = volume_m3 * scene.density_kg_m3;
    EXPECT_NEAR(table->mass_kg, mass, 0.05 * mass);
    EXPECT_NEAR(table->mass_kg, mass, 2 * table->mass_error_kg);
}

// A corner of a room, and in it a crate and a box on that, which were scanned half as densely: no
// sight leads through their faces and empties them.
TEST_F(SparseCloud, WhatIsScannedSparselyIsSolidAllTheSame) {
    scatter(2, 0, {0, 0, 0}, {2, 2, 0}, 8000);
    scatter(0, 0, {0, 0, 0}, {0, 2, 1}, 8000);
    scatter(1, 0, {0, 0, 0}, {2, 0, 1}, 8000);
    scatter_box({0.7, 0.7, 0}, {1.3, 1.2, 0.4}, 4000);
    scatter_box({0.8, 0.8, 0.4}, {1.05, 1, 0.7}, 4000);
    const Scene scene = parsed(cloud);
    std::vector<double> masses;
    for (const Object& object : scene.objects)
        if (!object.grounded) masses.push_back(object.mass_kg / scene.density_kg_m3);
    std::ranges::sort(masses);
    ASSERT_EQ(masses.size(), 2u);
    EXPECT_NEAR(masses[0], 0.25 * 0.2 * 0.3, 0.05 * 0.25 * 0.2 * 0.3);
    // Below the other box's edge rays tell of a hollow where there is none.
    EXPECT_NEAR(masses[1], 0.6 * 0.5 * 0.4, 0.08 * 0.6 * 0.5 * 0.4);
}

// Plain boxes on a floor, as cabinets are, in bare clouds as phones hand them over.
constexpr double phone_per_m2 = 1000;

TEST_F(SparseCloud, AStandingBoxIsAThingOrTold) {
    for (const double gap_m : {0.9, 0.4}) {
        cloud = {};
        scatter(2, 0, {0, 0, 0}, {2.4, 2, 0}, phone_per_m2);
        if (gap_m < 0.5) scatter(1, 0, {0, 0, 0}, {2.4, 0, 2.2}, phone_per_m2);
        scatter_box({0.5, gap_m, 0}, {1.3, gap_m + 0.35, 1.8}, phone_per_m2);
        const Scene scene = parsed(cloud);
        const bool told = std::ranges::any_of(scene.possible_things, [](const PossibleThing& t) {
            return t.size_m[2] > 1.5 && t.unsafety_category == "high";
        });
        EXPECT_TRUE(told || movable_at(scene, {0.9, gap_m + 0.175, 0.9}, 0.2) != nullptr) << gap_m;
    }
}

// Ten centimetres from a wall: by a voxel it has one behind it, as closed furniture has.
TEST_F(SparseCloud, AStandingBoxIsTheSameFromAnotherOrigin) {
    scatter(2, 0, {0, 0, 0}, {2.4, 2, 0}, phone_per_m2);
    scatter(1, 0, {0, 0, 0}, {2.4, 0, 1.6}, phone_per_m2);
    scatter_box({0.5, 0.1, 0}, {0.8, 0.4, 1.2}, phone_per_m2);
    std::optional<Object> first;
    for (const Vec3& shift : {Vec3{}, Vec3{0, 0.005, 0}, Vec3{-3.1, 0.013, 0.007}}) {
        PointCloud moved = cloud;
        for (std::size_t n = 0; n < moved.x.size(); ++n) {
            moved.x[n] += static_cast<float>(shift[0]);
            moved.y[n] += static_cast<float>(shift[1]);
            moved.z[n] += static_cast<float>(shift[2]);
        }
        const Scene scene = parsed(moved);
        const Object* box = movable_at(scene, plus({0.65, 0.25, 0.6}, shift), 0.2);
        ASSERT_NE(box, nullptr) << shift[0];
        if (!first) first = *box;
        EXPECT_NEAR(box->mass_kg, first->mass_kg, 0.01 * first->mass_kg) << shift[0];
        EXPECT_NEAR(box->barrier_J, first->barrier_J, 0.02 * first->barrier_J) << shift[0];
        EXPECT_EQ(box->mass_model, first->mass_model) << shift[0];
        // What is known within the cells is in the input's frame again.
        EXPECT_NEAR(box->support_height_m, shift[2], 0.01) << shift[0];
        const Vec3 off = minus(minus(box->center_of_mass_m, shift), first->center_of_mass_m);
        EXPECT_LT(length(off), 0.002) << shift[0];
    }
}

}  // namespace
}  // namespace topple::test
