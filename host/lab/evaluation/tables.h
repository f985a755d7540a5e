// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/evaluation/room.h"

// The scores of several rooms as text.
namespace topple::evaluation {

// Over the rooms where a measure is a number: the median (the mean of the middle two of an even
// count), the least and the greatest; NaN of none.
struct Spread {
    double median, least, greatest;
};
Spread spread(const std::vector<RoomScore>& rooms,
              const std::function<double(const RoomScore&)>& measure);

// What the paper's Tables 2 and 3 say, shares of 1.
struct PaperFigures {
    struct Volume {
        double precision, recall;
    };
    static constexpr Volume surface{0.985, 0.078}, invisible{0.477, 0.951}, completed{0.941, 0.874};
    static constexpr double fixed_joints = 0.818, support = 0.781;
    static constexpr double greedy_fixed_joints = 0.66, greedy_support = 0.603;
    static constexpr double discriminative_fixed_joints = 0.205, discriminative_support = 0.422;
};

// Segmentation (Fig. 14), volume (Table 2) and relations (Table 3) with median and worst, beside
// the paper's figures, and a line for each room.
std::string tables(const std::vector<RoomScore>& rooms);

// Every measure of every room, one line each, comma-separated, under a line of names.
std::string csv(const std::vector<RoomScore>& rooms);

}  // namespace topple::evaluation
