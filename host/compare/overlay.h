// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "compare/side.h"

namespace topple::comparing {

// Of the surfaces of both, those whose place the other saw: surface there, too, or free.
struct Overlay {
    std::size_t all = 0, both = 0, free = 0;
    double agreeing() const {
        return both + free == 0 ? 0 : static_cast<double>(both) / static_cast<double>(both + free);
    }
    double seen() const {
        return all == 0 ? 0 : static_cast<double>(both + free) / static_cast<double>(all);
    }
    // From -1 to 1: what agrees, less what contradicts.
    double score() const {
        return all == 0 ? -1
                        : (static_cast<double>(both) - static_cast<double>(free)) /
                              static_cast<double>(all);
    }
};

Overlay overlay(const Side& a, const Side& b, const Eigen::Isometry3d& a_from_b);

}  // namespace topple::comparing
