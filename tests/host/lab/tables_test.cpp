// SPDX-License-Identifier: MIT
#include "lab/evaluation/tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

namespace topple::evaluation {
namespace {

std::vector<RoomScore> three_rooms() {
    std::vector<RoomScore> rooms(3);
    for (std::size_t n = 0; n < rooms.size(); ++n) {
        rooms[n].seed = n + 1;
        const double v = 0.1 * static_cast<double>(n);
        rooms[n].parts_by_primitive = {0.01 + v, 0, 0.02, 0.125 + v, 0.9 - v, 0, 5};
        rooms[n].completed = {{0.95 - v, 100}, {0.80 + v, 100}};
    }
    rooms[0].relations.fixed_recall = {0.5, 10};  // the other rooms have no joints
    return rooms;
}

TEST(Spread, MedianAndRange) {
    auto rooms = three_rooms();
    const auto hamming = [](const RoomScore& r) { return r.parts_by_primitive.hamming; };
    const Spread odd = spread(rooms, hamming);
    EXPECT_DOUBLE_EQ(odd.median, 0.11);
    EXPECT_DOUBLE_EQ(odd.least, 0.01);
    EXPECT_DOUBLE_EQ(odd.greatest, 0.21);
    rooms.pop_back();
    EXPECT_DOUBLE_EQ(spread(rooms, hamming).median, 0.06);
    EXPECT_TRUE(std::isnan(spread({}, hamming).median));
}

TEST(Spread, LeavesOutWhatIsNoNumber) {
    const Spread s =
        spread(three_rooms(), [](const RoomScore& r) { return r.relations.fixed_recall.value; });
    EXPECT_EQ(s.median, 0.5);
    EXPECT_EQ(s.least, 0.5);
}

// The line that starts with `name`, its words.
std::vector<std::string> row(const std::string& text, const std::string& name) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t at = line.find_first_not_of(' ');
        if (at == std::string::npos || line.compare(at, name.size(), name) != 0) continue;
        std::istringstream words(line.substr(at + name.size()));
        return {std::istream_iterator<std::string>(words), {}};
    }
    return {};
}

TEST(Tables, ShowMedianWorstAndThePaper) {
    const std::string text = tables(three_rooms());
    using Row = std::vector<std::string>;
    EXPECT_EQ(row(text, "after filling"), (Row{"85.0", "75.0", "94.1", "90.0", "80.0", "87.4"}));
    EXPECT_EQ(row(text, "surface alone"), (Row{"-", "-", "98.5", "-", "-", "7.8"}));
    EXPECT_EQ(row(text, "fixed joints"), (Row{"50.0", "50.0", "-", "-", "81.8", "66.0"}));
    // Worst is the greatest error, but the least intersection over union.
    EXPECT_EQ(row(text, "primitives"), (Row{"0.225", "0.325", "0.110", "0.210", "0.000", "0.000",
                                            "0.020", "0.020", "0.800", "0.700"}));
    EXPECT_EQ(row(text, "2").at(0), "0");  // a line for each room
    EXPECT_EQ(row(text, "3").at(2), "70.0");
}

TEST(Csv, HasALineForEachRoomAndAsManyFieldsAsNames) {
    std::istringstream lines(csv(three_rooms()));
    std::size_t names = 0, count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        const auto fields = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
        if (count == 0) names = fields;
        EXPECT_EQ(fields, names) << line;
        const std::string seed = count == 0 ? "seed," : std::to_string(count) + ",";
        EXPECT_TRUE(line.starts_with(seed)) << line;
    }
    EXPECT_EQ(count, 4u);
    EXPECT_GT(names, 30u);
}

}  // namespace
}  // namespace topple::evaluation
