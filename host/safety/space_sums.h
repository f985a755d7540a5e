// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "topple/space_field.h"

namespace topple::safety {

// What passes a cell in one event, of all sources that were added up.
struct Passing {
    float passes = 0;
    std::array<float, 3> velocity{};  // times passes, m/s
    float energy = 0;                 // times passes
    void add(const Passing& other, float share = 1) {
        passes += share * other.passes;
        for (std::size_t a = 0; a < 3; ++a) velocity[a] += share * other.velocity[a];
        energy += share * other.energy;
    }
};

// Sums up what passes the cells of a lattice of cubes along the grid frame's axes.
class SpaceSums {
  public:
    SpaceSums() = default;
    SpaceSums(const Vec3& corner_m, double cell_m) : corner_m_(corner_m), cell_m_(cell_m) {}
    bool made() const { return cell_m_ > 0; }
    const Vec3& corner_m() const { return corner_m_; }
    double cell_m() const { return cell_m_; }
    // Nothing is kept of what does not pass.
    void add(const std::array<std::int32_t, 3>& cell, const Passing& passing);
    // A field of the same lattice, of which so much counts.
    void add(const SpaceField& field, float share);
    // Means of what passes, in the grid frame. Empties it.
    SpaceField take();

  private:
    struct Entry {
        std::array<std::int32_t, 3> cell{};
        Passing passing;
    };
    Vec3 corner_m_{};
    double cell_m_ = 0;
    std::vector<Entry> entries_;
};

}  // namespace topple::safety
