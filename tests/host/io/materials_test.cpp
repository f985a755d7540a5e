// SPDX-License-Identifier: MIT
#include "topple/materials.h"

#include <cmath>
#include <limits>
#include <random>

#include "files.h"
#include "objects/density_prior.h"

namespace topple {
namespace {

std::string kinds_in(const std::string& kinds) {
    return R"({"schema": "topple.materials/1", "kinds": [)" + kinds + "]}";
}

class MaterialFiles : public test::Files {};

TEST_F(MaterialFiles, HaveKinds) {
    const Materials kinds = read_materials(write("m.json", kinds_in(R"(
        {"name": "kg\u00fchl", "size_m": [0.3, 0.1, 0.2], "fill": 0.5, "density_kg_m3": 200, "spread": 0.4, "x": 1},
        {"name": "cup", "size_m": [1, 1, 1], "fill": 1, "density_kg_m3": 700, "spread": 0, "friction": 0.6})")));
    ASSERT_EQ(kinds.size(), 2u);
    EXPECT_EQ(kinds[0].name, "kg\u00fchl");
    EXPECT_EQ(kinds[0].size_m, (Vec3{0.1, 0.2, 0.3})) << "the shortest edge first";
    EXPECT_EQ(kinds[0].density_kg_m3, 200);
    EXPECT_EQ(kinds[1].spread, 0);
    EXPECT_EQ(kinds[0].friction, 0) << "that of all";
    EXPECT_EQ(kinds[1].friction, 0.6);
    EXPECT_EQ(read_materials("household").size(), household_materials().size());
}

TEST_F(MaterialFiles, ThatAreNone) {
    const std::string kind = R"("size_m": [1, 1, 1], "fill": 1, "density_kg_m3": 700)";
    const std::vector<test::BadFile> bad = {
        {"{}", {"its \"schema\" is not"}},
        {R"({"schema": "topple.materials/1"})", {"has no list \"kinds\""}},
        {kinds_in(""), {"there are 0 kinds", "1 to 1000"}},
        {kinds_in("7"), {"kind 1: is number"}},
        {kinds_in(R"({"name": "cup", )" + kind + "}"), {"kind 1", "has no \"spread\""}},
        {kinds_in(R"({"name": "cup", "size_m": [1, 2], "spread": 1})"),
         {"kind 1", "three lengths"}},
        {kinds_in(R"({"name": "Cup", "spread": 1, )" + kind + "}"), {"kind 1", "small letters"}},
        {kinds_in(R"({"name": "cup", "spread": "a", )" + kind + "}"), {"\"spread\" is string"}},
        {kinds_in(R"({"name": "cup", "spread": 3.5, )" + kind + "}"),
         {"kind 1: spread is 3.5", "from 0 to 3"}},
        {kinds_in(R"({"name": "cup", "spread": 1, "friction": -1, )" + kind + "}"),
         {"kind 1: friction is -1", "from 0 to 10"}},
    };
    expect_refused("m.json", bad, [](const auto& file) { read_materials(file); });
    test::expect_input_error([] { read_materials("/no/such/file"); }, {"/no/such/file"});
}

TEST(Materials, OfHouseholdsCanBeUsed) {
    EXPECT_FALSE(fault_of(household_materials()));
    Materials kinds{household_materials().front()};
    kinds[0].size_m[2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(fault_of(kinds)) << "not a number";
}

const Materials two{{"table", {0.7, 0.8, 1.5}, 0.1, 600, 0.3},
                    {"coffee table", {0.4, 0.6, 1}, 0.1, 400, 0.2}};

TEST(DensityPriors, GoByTheLongestNameThatIsAWord) {
    const auto density = [](const char* name) {
        return density_prior(two, name, {9, 9, 9}, 1).median_kg_m3;
    };
    EXPECT_EQ(density("Table"), 600);
    EXPECT_EQ(density("my old tables"), 600);
    EXPECT_EQ(density("Coffee table, left"), 400);
    for (const char* none : {"", "tablet", "stable", "tab le",
                             "t\xC3\xA4"
                             "table"})
        EXPECT_NEAR(density(none), 450, 1e-9) << none << ": of that size there is nothing";
}

// The mixture by its own definition, of log-normal parts.
TEST(DensityPriors, MixKindsByLikeness) {
    const Vec3 size_m{1.2, 0.5, 0.6};  // in any order
    const double fill = 0.2;
    double weight[3], mean[3] = {std::log(600), std::log(400), std::log(450)};
    const double spread[3] = {0.3, 0.2, 0.9}, sorted[3] = {0.5, 0.6, 1.2};
    for (int n = 0; n < 2; ++n) {
        double log_weight =
            -std::pow(std::log(fill / two[static_cast<std::size_t>(n)].fill), 2) / (2 * 0.25);
        for (int a = 0; a < 3; ++a)
            log_weight -=
                std::pow(std::log(sorted[a] / two[static_cast<std::size_t>(n)].size_m[a]), 2) /
                (2 * 0.09);
        weight[n] = std::exp(log_weight);
    }
    weight[2] = std::exp(-2);
    double all = 0, middle = 0, around = 0;
    for (int n = 0; n < 3; ++n) all += weight[n];
    for (int n = 0; n < 3; ++n) middle += weight[n] / all * mean[n];
    for (int n = 0; n < 3; ++n)
        around += weight[n] / all * (std::pow(mean[n] - middle, 2) + std::pow(spread[n], 2));
    const DensityPrior found = density_prior(two, "thing", size_m, fill);
    EXPECT_NEAR(found.median_kg_m3, std::exp(middle), 1e-9);
    EXPECT_NEAR(found.spread, std::sqrt(around), 1e-12);
}

TEST(DensityPriors, HaveErrorsThatTwoInThreeThingsKeep) {
    std::mt19937 random(1);
    for (const double spread : {0.05, 0.3, 0.75, 1.5}) {
        const double error = DensityPrior{700, spread}.error_share();
        std::normal_distribution<double> log_of(0, spread);
        int within = 0;
        for (int n = 0; n < 100000; ++n) within += std::abs(std::exp(log_of(random)) - 1) <= error;
        EXPECT_NEAR(within / 1e5, 0.6827, 0.006) << spread;
    }
    EXPECT_EQ((DensityPrior{700, 0}.error_share()), 0);
}

TEST(DensityPriors, OfWhatHasNoVolumeAreThoseOfAnything) {
    EXPECT_NEAR(density_prior(two, "", {0, 0, 0}, 0).median_kg_m3, 450, 1e-9);
    EXPECT_NEAR(density_prior(two, "", {0, 0, 0}, 0).spread, 0.9, 1e-9);
}

}  // namespace
}  // namespace topple
