// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "topple/scene.h"

// How people rate objects' unsafety, beside what a parse says of it (paper, 6.5 and Fig. 20).
namespace topple::evaluation {

// A table of ratings, a person a column: how unsafe each object is, 1 (safe) to 10.
struct Ratings {
    std::vector<std::string> people;
    // By object the ratings of those people; NaN: none. Objects that nobody rated are left out.
    std::map<std::int32_t, std::vector<double>> of;
};

// Comma-separated, as ratings_sheet() begins it: a line of names, then one for each object. Throws
// Error(input) that names the file, the line and what is wrong there.
Ratings read_ratings(const std::filesystem::path& file);

// A sheet for people to fill in: the objects that a parse has judged, by their place, not by their
// risk, which nobody shall see before.
std::string ratings_sheet(const Scene& scene);

// A correlation and its 95 % interval.
struct Correlation {
    double value = 0, low = -1, high = 1;
};
// Of ranks, equal ones at their mean (Spearman 1904; interval of Bonett and Wright 2000), and of
// values (Pearson; Fisher 1921). Four pairs at least; NaN where all of one side are equal.
Correlation rank_correlation(const std::vector<double>& a, const std::vector<double>& b);
Correlation linear_correlation(const std::vector<double>& a, const std::vector<double>& b);

struct RatedObject {
    std::int32_t object = 0;
    double unsafety = 0, mean = 0;  // of the parse; of all people
    std::vector<double> ratings;    // by person; NaN: none
};
struct Person {
    std::string name;
    std::size_t rated = 0;
    double with_parse = 0, with_others = 0;  // rank correlations; NaN: of fewer than four objects
};
struct RatingComparison {
    std::vector<RatedObject> objects;  // the most unsafe by people first
    std::vector<Person> people;
    Correlation ranks, values;  // of the parse and the mean of people, by object
};
// Throws Error(input) where an object is none that was judged, or fewer than four were rated.
RatingComparison compare_ratings(const Scene& scene, const Ratings& ratings,
                                 const std::filesystem::path& file);

// Fig. 20 (b) as SVG: people's ratings over the parse's.
std::string ratings_picture(const RatingComparison& comparison);

}  // namespace topple::evaluation
