// SPDX-License-Identifier: MIT
#include "geometry/shell.h"

#include <initializer_list>

#include "core/thread_pool.h"
#include "geometry/shell_features.h"
#include "host/geometry/sampled_faces.h"
#include "testing.h"

namespace topple::geometry::shell_of_a_room {
namespace {

using Eigen::Vector3d;

// A room of 4 x 3.4 x 2.5 m with a cupboard at a wall, a table's top with a box on it, and a crate
// in the middle. What the tests leave out of it is not seen.
enum Part : std::int32_t { floor, west, south, east, north, ceiling, cupboard, table, box, crate };
constexpr std::size_t parts = 10;

constexpr std::size_t at(Part part) {
    return static_cast<std::size_t>(part);
}

ThreadPool& threads() {
    static ThreadPool pool(2);
    return pool;
}

SurfaceSamples room(const std::set<std::int32_t>& without = {}, double spacing_m = 0.03,
                    double lift_m = 0) {
    test::SampledFaces faces(spacing_m);
    const Vector3d x(4, 0, 0), y(0, 3.4, 0), z(0, 0, 2.5), up(0, 0, lift_m);
    const auto seen = [&](Part part) { return !without.contains(part); };
    if (seen(floor)) faces.face(floor, up, x, y);
    if (seen(west)) faces.face(west, up, y, z);
    if (seen(south)) faces.face(south, up, z, x);
    if (seen(east)) faces.face(east, up + x, z, y);
    if (seen(north)) faces.face(north, up + y, x, z);
    if (seen(ceiling)) faces.face(ceiling, up + z, y, x);
    if (seen(cupboard))
        faces.box(cupboard, up + Vector3d(0.02, 1, 0), up + Vector3d(0.5, 1.9, 1.6));
    if (seen(table)) faces.box(table, up + Vector3d(2.4, 2, 0.7), up + Vector3d(3.6, 2.8, 0.75));
    if (seen(box)) faces.box(box, up + Vector3d(2.9, 2.3, 0.75), up + Vector3d(3.2, 2.5, 0.95));
    if (seen(crate)) faces.box(crate, up + Vector3d(1.8, 1, 0), up + Vector3d(2.3, 1.4, 0.45));
    return faces.samples;
}

void expect_shell(const Shell& shell, std::initializer_list<Part> of_the_room,
                  std::initializer_list<Part> things) {
    for (const Part p : of_the_room) EXPECT_GT(shell.log_odds[at(p)], 0) << p;
    for (const Part p : things) {
        EXPECT_LT(shell.log_odds[at(p)], 0) << p;
        EXPECT_EQ(shell.role[at(p)], Role::none) << p;
    }
}

TEST(Shell, IsTheRoomAndNotWhatStandsInIt) {
    for (const double spacing_m : {0.03, 0.05}) {
        const Shell shell = find_shell(room({}, spacing_m), parts, threads());
        expect_shell(shell, {floor, west, south, east, north, ceiling}, {table, box, crate});
        EXPECT_EQ(shell.role[at(floor)], Role::floor);
        EXPECT_EQ(shell.role[at(ceiling)], Role::ceiling);
        for (const Part wall : {west, south, east, north})
            EXPECT_EQ(shell.role[at(wall)], Role::wall);
    }
}

// In a coarse scan each normal comes from few points. Mean length of the normals: 0.8.
TEST(Shell, OfARoughFloorIsAFloor) {
    SurfaceSamples samples = room();
    const double lean = std::acos(0.8);
    for (std::size_t n = 0; n < samples.size(); ++n) {
        if (samples.primitive[n] != floor) continue;
        const double heading = 2.4 * static_cast<double>(n);  // the golden angle: all ways alike
        samples.nx[n] = static_cast<float>(std::sin(lean) * std::cos(heading));
        samples.ny[n] = static_cast<float>(std::sin(lean) * std::sin(heading));
        samples.nz[n] = static_cast<float>(std::cos(lean));
    }
    const Shell shell = find_shell(samples, parts, threads());
    expect_shell(shell, {floor}, {table, box, crate});
    EXPECT_EQ(shell.role[at(floor)], Role::floor);
}

TEST(Shell, NeedsNoCeiling) {
    const Shell shell = find_shell(room({ceiling}), parts, threads());
    expect_shell(shell, {floor, west, south, east, north}, {table, box, crate, ceiling});
    EXPECT_EQ(shell.role[at(floor)], Role::floor);
}

// As one camera in a corner sees it.
TEST(Shell, OfACornerIsFloorAndTwoWalls) {
    const Shell shell = find_shell(room({ceiling, west, south}), parts, threads());
    expect_shell(shell, {floor, east, north}, {table, box, crate});
    EXPECT_EQ(shell.role[at(north)], Role::wall);
}

TEST(Shell, WhatHasNoSamplesIsNoShell) {
    const Shell shell = find_shell(room({crate}), parts + 2, threads());
    ASSERT_EQ(shell.role.size(), parts + 2);
    for (const std::size_t p : {at(crate), parts, parts + 1}) {
        EXPECT_EQ(shell.role[p], Role::none);
        EXPECT_LT(shell.log_odds[p], -6);
    }
    EXPECT_TRUE(find_shell({}, 0, threads()).role.empty());
}

TEST(Shell, IsAsSureAsTheModelCanBe) {
    for (const double odds : find_shell(room(), parts, threads()).log_odds)
        EXPECT_LE(std::abs(odds), std::log(999) + 1e-9);
}

// Each storey by itself: the same room twice, one above the other, is the shell twice.
TEST(Shell, OfTwoStoreysIsFoundInEach) {
    const SurfaceSamples below = room({}, 0.05), above = room({}, 0.05, 2.8);
    SurfaceSamples both = below;
    const auto into = columns_of(both);
    const auto from = columns_of(above);
    for (std::size_t c = 0; c < into.size(); ++c)
        into[c]->insert(into[c]->end(), from[c]->begin(), from[c]->end());
    for (const std::int32_t p : above.primitive)
        both.primitive.push_back(p + static_cast<std::int32_t>(parts));
    const std::vector<StoreyHint> storeys{{.floor_m = 0, .top_m = 2.65},
                                          {.floor_m = 2.8, .below_m = 2.65}};
    const Shell one = find_shell(below, parts, threads(), {}),
                two = find_shell(both, 2 * parts, threads(), storeys);
    for (std::size_t p = 0; p < parts; ++p) {
        EXPECT_NEAR(two.log_odds[p], one.log_odds[p], 0.5) << p;
        EXPECT_EQ(two.role[p], one.role[p]) << p;
        EXPECT_EQ(two.role[p + parts], one.role[p]) << p;
    }
}

double shell_feature(const std::vector<float>& rows, Part part, std::string_view name) {
    const auto names = shell_feature_names();
    const auto column = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    EXPECT_LT(column, names.size()) << name;
    return rows.at(at(part) * names.size() + column);
}

TEST(ShellFeatures, SayWhatIsBehindAndBefore) {
    const SurfaceSamples samples = room();
    const PrimitiveShapes shapes = primitive_shapes(samples, parts);
    const std::vector<float> rows = shell_features(samples, shapes, SightLines(samples), threads());
    const auto names = shell_feature_names();
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    ASSERT_EQ(rows.size(), parts * names.size());
    for (const Part wall : {west, south, east, north}) {
        EXPECT_LT(shell_feature(rows, wall, "behind_share"), 0.05);
        EXPECT_NEAR(shell_feature(rows, wall, "height_share"), 1, 0.05);
        EXPECT_LT(shell_feature(rows, wall, "rim_distance"), 0.1);
        EXPECT_LT(shell_feature(rows, wall, "back_met_400"), 0.05);
        EXPECT_GT(shell_feature(rows, wall, "front_met_400"), 0.2);
    }
    EXPECT_NEAR(shell_feature(rows, west, "level_length"), 3.4, 0.1);
    EXPECT_NEAR(shell_feature(rows, west, "filled"), 1, 0.05);
    EXPECT_NEAR(shell_feature(rows, table, "low_above_floor"), 0.7, 0.05);
    EXPECT_GT(shell_feature(rows, table, "down_met_300"), 0.9);
    EXPECT_NEAR(shell_feature(rows, crate, "low_above_floor"), 0, 0.05);
    EXPECT_GT(shell_feature(rows, crate, "rim_distance"), 0.9);
}

}  // namespace
}  // namespace topple::geometry::shell_of_a_room
