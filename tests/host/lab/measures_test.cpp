// SPDX-License-Identifier: MIT
#include "lab/evaluation/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace topple::evaluation {
namespace {

scenes::MeasuredShape shape(const std::string& name) {
    for (scenes::MeasuredShape& s : scenes::measured_shapes())
        if (s.name == name) return s;
    ADD_FAILURE() << name;
    return {};
}

TrueMeasures truth_of(const std::string& name, std::uint64_t seed) {
    return true_measures(scenes::measured_world(shape(name), seed), scenes::measured_object, 700);
}

// A body tips over the nearest edge of its base: m g (sqrt(d^2 + z^2) - z).
double over_edge(double mass_kg, double d, double z) {
    return mass_kg * 9.80665 * (std::hypot(d, z) - z);
}

TEST(Measures, TruthsAreThoseOfClosedForms) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const TrueMeasures box = truth_of("box 20 x 30 x 50", seed);
        EXPECT_NEAR(box.mass_kg, 21, 1e-9);
        EXPECT_NEAR(box.barrier_J, over_edge(21, 0.1, 0.25), 1e-9);
        const double can_kg = 700 * M_PI / 4 * 0.065 * 0.065 * 0.17;
        const TrueMeasures can = truth_of("can 6.5 x 17", seed);
        EXPECT_NEAR(can.mass_kg, can_kg, 1e-9);
        EXPECT_NEAR(can.barrier_J, over_edge(can_kg, 0.0325, 0.085), 1e-4 * can.barrier_J);
        const TrueMeasures cone = truth_of("cone 24 x 40", seed);
        EXPECT_NEAR(cone.barrier_J, over_edge(cone.mass_kg, 0.12, 0.1), 1e-4 * cone.barrier_J);
        // A board of 0.96 x 0.04 m^3 on four legs.
        const TrueMeasures table = truth_of("table 120 x 80 x 72", seed);
        const double board = 1.2 * 0.8 * 0.04, legs = 4 * 0.06 * 0.06 * 0.68;
        EXPECT_NEAR(table.mass_kg, 700 * (board + legs), 1e-9);
        EXPECT_NEAR(table.center_of_mass_m[2], (board * 0.7 + legs * 0.34) / (board + legs), 1e-9);
        EXPECT_NEAR(table.barrier_J, over_edge(table.mass_kg, 0.4, table.center_of_mass_m[2]),
                    1e-9);
    }
}

TEST(Measures, ShapesAreManyAndOnTheirFeet) {
    const auto shapes = scenes::measured_shapes();
    EXPECT_GE(shapes.size(), 30u);
    std::set<std::string> names;
    for (const scenes::MeasuredShape& s : shapes) {
        SCOPED_TRACE(s.name);
        names.insert(s.name);
        double lowest = 1;
        for (const scenes::Part& part : s.parts) lowest = std::min(lowest, part.bottom());
        EXPECT_NEAR(lowest, 0, 1e-12);
        // Parts touch or are apart; none reaches into another.
        for (std::size_t a = 0; a < s.parts.size(); ++a)
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_GT(scenes::gap(s.parts[a], s.parts[b]), -2e-4) << a << ' ' << b;
        const TrueMeasures truth =
            true_measures(scenes::measured_world(s, 1), scenes::measured_object, 700);
        EXPECT_GT(truth.barrier_J, 0);
    }
    EXPECT_EQ(names.size(), shapes.size());
}

TEST(Measures, PointsLieOnWhatIsInView) {
    const scenes::World world = scenes::measured_world(shape("tin 8 x 11"), 3);
    const PointCloud cloud = scenes::clean_points(world, 0.01);
    ASSERT_EQ(cloud.nx.size(), cloud.size());
    std::size_t on_tin = 0;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        const Vec3 p{cloud.x[n], cloud.y[n], cloud.z[n]};
        const auto [off, part] = world.distance(p);
        ASSERT_NEAR(off, 0, 1e-6);
        const scenes::Part& on = world.parts[part];
        if (on.object != scenes::measured_object) continue;
        ++on_tin;
        EXPECT_GT(p[2], on.bottom() + 1e-4);  // it stands on its underside
    }
    // Side and lid, a point per square centimetre or more.
    EXPECT_GT(on_tin, 1e4 * M_PI * (0.08 * 0.11 + 0.04 * 0.04));
}

TEST(Measures, OfACrateAreFound) {
    MeasureOptions options;
    options.spacing_m = 0.01;
    options.parse.device = device::open_device("native");
    options.parse.disturbances = {};
    const MeasureScore score = measure(shape("cube 40"), 1, options);
    EXPECT_GT(score.mass, 0.8);
    EXPECT_LT(score.mass, 1.6);
    EXPECT_GT(score.barrier, 0.8);
    EXPECT_LT(score.center_m, 0.05);
    EXPECT_GT(score.parse_s, 0);
}

TEST(Measures, TableCountsWhatWasFound) {
    const auto score = [](const char* name, double mass, double barrier, double sigmas) {
        MeasureScore out;
        out.name = name;
        out.mass = mass;
        out.barrier = barrier;
        out.center_m = 0.003 * mass;
        out.barrier_sigmas = sigmas;
        return out;
    };
    const double none = MeasureScore::none;
    const std::vector<MeasureScore> scores{score("a", 1.02, 1.1, 1.5), score("a", 0.98, 1.3, 0.5),
                                           score("b", none, none, none)};
    const std::string table = measures_table(scores);
    for (const char* part :
         {"a                              2/2     1.000    1.200      3.0",
          "b                              0/1       nan      nan      nan", "mean bias +0.0 %",
          "mean bias +20.0 %", "barrier  within one standard error: 50.0, within two: 100.0"})
        EXPECT_NE(table.find(part), std::string::npos) << part << '\n' << table;
    const std::string csv = measures_csv(scores);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
}

}  // namespace
}  // namespace topple::evaluation
