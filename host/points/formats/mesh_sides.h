// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "topple/input.h"

namespace topple::io {

// Triangles whose corners were taken for the same where their places are.
class TriangleMesh {
  public:
    void add(const std::array<Vec3, 3>& corners);
    std::size_t size() const { return triangle_.size(); }
    const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangle_; }
    const std::vector<std::array<float, 3>>& places() const { return place_; }

  private:
    std::vector<std::array<std::uint32_t, 3>> triangle_;
    std::vector<std::array<float, 3>> place_;
    std::vector<std::uint32_t> bucket_;  // open addressing: 1 + number of a place, 0: none
    void grow();
    std::uint32_t number_of(const std::array<float, 3>& place);
};

// Which triangles' corners go round the wrong way.
struct MeshSides {
    std::vector<bool> turned;  // of each triangle; or empty: none
    std::uint64_t against_neighbours = 0, bodies = 0;

    std::vector<std::string> notes() const;
};

// Triangles that share an edge with one other go round the same way as it: where they don't, those
// of less area in a piece are turned. A closed piece then has its outside out: one that is inside
// out is turned, unless it is as large as a room, which is seen from within, or lies in another,
// whose hollow it may be. unit_m: metres of the places' unit.
MeshSides find_sides(const TriangleMesh& mesh, double unit_m);

}  // namespace topple::io
