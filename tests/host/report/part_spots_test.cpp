// SPDX-License-Identifier: MIT
#include "report/part_spots.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace topple::report {
namespace {

// A level sheet of cells, whose groups are told by x and y.
template <class Group>
std::vector<Cell> sheet(int width, int depth, CellTable& table, const Group& group) {
    std::vector<Cell> cells;
    for (int y = 0; y < depth; ++y) {
        for (int x = 0; x < width; ++x) {
            Cell cell;
            cell.index = {x, y, 0};
            cell.group = static_cast<std::uint16_t>(group(x, y));
            cell.exposed = 32;
            table.insert(cell.index, static_cast<std::uint32_t>(cells.size()));
            cells.push_back(cell);
        }
    }
    return cells;
}

TEST(PartSpots, lie_in_the_middle_of_what_was_seen) {
    CellTable table;
    auto cells = sheet(21, 11, table, [](int, int) { return 0; });
    EXPECT_EQ(cells[inner_cells(cells, table, 1)[0]].index,
              (std::array<std::int32_t, 3>{10, 5, 0}));
    for (Cell& cell : cells) cell.completed = cell.index[0] > 4;
    EXPECT_EQ(cells[inner_cells(cells, table, 1)[0]].index, (std::array<std::int32_t, 3>{2, 5, 0}));
    for (Cell& cell : cells) cell.completed = true;
    EXPECT_EQ(cells[inner_cells(cells, table, 1)[0]].index, (std::array<std::int32_t, 3>{10, 5, 0}))
        << "better than nothing";
}

// Around a thing that stands on its middle a part still has a place far from that.
TEST(PartSpots, keep_away_from_other_parts) {
    CellTable table;
    const auto within = [](int x, int y) { return x >= 8 && x < 13 && y >= 8 && y < 13; };
    const auto cells = sheet(21, 21, table, within);
    const auto spots = inner_cells(cells, table, 3);
    const auto& outer = cells[spots[0]].index;
    for (int x = 8; x < 13; ++x)
        for (int y = 8; y < 13; ++y) EXPECT_GE(std::abs(outer[0] - x) + std::abs(outer[1] - y), 4);
    EXPECT_EQ(cells[spots[1]].index, (std::array<std::int32_t, 3>{10, 10, 0}));
    EXPECT_EQ(spots[2], CellTable::absent) << "of a group without cells";
}

TEST(PartSpots, become_points_of_the_scan) {
    ScenePoints points;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    points.x = {0.1f, 0.2f, 0.3f, nan, 0.26f};
    points.y = points.z = {0, 0, 0, 0, 0};
    points.primitive = {7, 7, 7, 7, 3};
    const std::vector<std::pair<std::int32_t, std::int32_t>> groups{{-1, -1}, {7, 1}, {9, 2}};
    const auto places = nearest_points(points, groups, {{}, Vec3{0.25, 0.01, 0}, Vec3{1, 1, 1}});
    EXPECT_FALSE(places[0]);
    EXPECT_FLOAT_EQ(float((*places[1])[0]), 0.2f);
    EXPECT_EQ((*places[2])[0], 1) << "nothing of it was scanned";
}

}  // namespace
}  // namespace topple::report
