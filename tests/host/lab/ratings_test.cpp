// SPDX-License-Identifier: MIT
#include "lab/evaluation/ratings.h"

#include <cmath>

#include "host/io/files.h"

namespace topple::evaluation {
namespace {

// By other ways than the code's: ranks counted pair by pair, and sums of products.
double rank_by_counting(const std::vector<double>& values, double value) {
    double less = 0, equal = 0;
    for (const double v : values) {
        less += v < value;
        equal += v == value;
    }
    return less + (equal - 1) / 2;
}
double spearman_by_counting(const std::vector<double>& a, const std::vector<double>& b) {
    const auto n = static_cast<double>(a.size());
    double ab = 0, aa = 0, bb = 0, sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double ra = rank_by_counting(a, a[i]), rb = rank_by_counting(b, b[i]);
        sum_a += ra;
        sum_b += rb;
        ab += ra * rb;
        aa += ra * ra;
        bb += rb * rb;
    }
    return (n * ab - sum_a * sum_b) /
           std::sqrt((n * aa - sum_a * sum_a) * (n * bb - sum_b * sum_b));
}

TEST(RatingCorrelations, AreThoseOfTheDefinition) {
    const std::vector<double> a{1, 2, 2, 5, 7, 10, 10, 3}, b{2, 1, 4, 4, 9, 8, 10, 3};
    const Correlation ranks = rank_correlation(a, b);
    EXPECT_NEAR(ranks.value, spearman_by_counting(a, b), 1e-12);
    // Bonett and Wright: atanh r +- 1.96 sqrt((1 + r^2 / 2) / (n - 3)).
    const double reach = 1.959964 * std::sqrt((1 + ranks.value * ranks.value / 2) / 5);
    EXPECT_NEAR(ranks.low, std::tanh(std::atanh(ranks.value) - reach), 1e-12);
    EXPECT_NEAR(ranks.high, std::tanh(std::atanh(ranks.value) + reach), 1e-12);
    EXPECT_NEAR(linear_correlation({1, 2, 3, 4}, {2, 4, 6, 9}).value, 0.9943, 1e-4);
    EXPECT_EQ(rank_correlation({1, 2, 3, 4}, {1, 4, 9, 16}).value, 1) << "in the same order";
    EXPECT_EQ(rank_correlation({1, 2, 3, 4}, {4, 3, 2, 1}).value, -1);
    EXPECT_TRUE(std::isnan(rank_correlation({1, 2, 3, 4}, {5, 5, 5, 5}).value));
}

// Four things and the building; the last was not seen enough.
Scene five_things() {
    Scene scene;
    scene.objects.resize(6);
    for (std::size_t n = 0; n < scene.objects.size(); ++n) {
        Object& o = scene.objects[n];
        o.id = static_cast<std::int32_t>(n);
        o.unsafety = static_cast<double>(n * n) / 3 + 1;
        o.size_m = {0.5, 0.25, 1};
        o.box_middle_m = {1.234, 0, 0.5};
    }
    scene.objects[0].grounded = true;
    scene.objects[5].seen_enough = false;
    scene.objects[2].name = "a \"big\" lamp, red";
    return scene;
}

class RatingFiles : public test::Files {};

TEST_F(RatingFiles, AreComparedWithTheParse) {
    const auto file = write("r.csv",
                            "\xEF\xBB\xBFobject,name,Ann,Bo,\"C, Dr.\"\r\n1,x,1,,2\r\n"
                            "2,\"a, b\",3,2,3\r\n4,,10,8,\r\n\r\n3,,5,9,4\r\n5,,,,\r\n");
    const Scene scene = five_things();
    const RatingComparison found = compare_ratings(scene, read_ratings(file), file);
    ASSERT_EQ(found.objects.size(), 4u) << "nobody rated the fifth";
    EXPECT_EQ(found.objects[0].object, 4) << "the most unsafe first";
    EXPECT_EQ(found.objects[0].mean, 9);
    EXPECT_EQ(found.objects[1].mean, 6);
    ASSERT_EQ(found.people.size(), 3u);
    EXPECT_EQ(found.people[2].name, "C, Dr.");
    EXPECT_EQ(found.people[0].rated, 4u);
    EXPECT_EQ(found.people[0].with_parse, 1);
    EXPECT_TRUE(std::isnan(found.people[1].with_parse)) << "three are too few";
    EXPECT_EQ(found.ranks.value, 1);
    EXPECT_NEAR(
        found.values.value,
        linear_correlation({16 / 3. + 1, 9 / 3. + 1, 4 / 3. + 1, 1 / 3. + 1}, {9, 6, 8 / 3., 1.5})
            .value,
        1e-12);
    const std::string picture = ratings_picture(found);
    EXPECT_THAT(picture, testing::StartsWith("<svg"));
    EXPECT_THAT(picture, testing::HasSubstr(">4</text>"));
}

TEST_F(RatingFiles, BeginAsSheets) {
    const Scene scene = five_things();
    const std::string sheet = ratings_sheet(scene);
    EXPECT_THAT(sheet,
                testing::HasSubstr("2,\"a \"\"big\"\" lamp, red\",1.23,0,1,0.5 x 0.25 x 1,"));
    const auto file = write("sheet.csv", sheet);
    const Ratings none = read_ratings(file);
    EXPECT_EQ(none.people.size(), 3u);
    EXPECT_TRUE(none.of.empty());
    test::expect_input_error([&] { compare_ratings(scene, none, file); },
                             {"sheet.csv", "rates 0 objects", "4 at least"});
}

TEST_F(RatingFiles, ThatAreNone) {
    const std::vector<test::BadFile> bad = {
        {"", {"is empty"}},
        {"\n", {"first column", "--sheet"}},
        {"id,Ann\n", {"line 1", "\"id\"", "not \"object\""}},
        {"object,name\n1,x\n", {"line 1", "0 columns of people"}},
        {"object,Ann\n1,2\nx,3\n", {"line 3", "\"x\" is no number of an object"}},
        {"object,Ann\n1,11\n", {"line 2", "\"11\" by \"Ann\"", "1 to 10"}},
        {"object,Ann\n1,nan\n", {"line 2", "no rating"}},
        {"object,Ann\n1,2\n1,3\n", {"line 3", "object 1 comes twice"}},
        {"object,Ann\n1,\"2\n", {"line 2", "no end"}},
    };
    expect_refused("r.csv", bad, [](const auto& file) { read_ratings(file); });
    const auto of_room = write("r.csv", "object,Ann\n0,2\n1,1\n2,1\n3,1\n");
    test::expect_input_error(
        [&] { compare_ratings(five_things(), read_ratings(of_room), of_room); },
        {"object 0 is the building", "leave it out"});
    const auto beyond = write("r.csv", "object,Ann\n6,2\n");
    test::expect_input_error([&] { compare_ratings(five_things(), read_ratings(beyond), beyond); },
                             {"object 6", "has 6 objects"});
}

}  // namespace
}  // namespace topple::evaluation
