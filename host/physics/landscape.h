// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "device/device.h"
#include "physics/bodies.h"
#include "topple/scene.h"

namespace topple::physics {

inline constexpr double gravity = 9.80665;  // m/s^2

// A geodesic mesh of the unit sphere: 10 f^2 + 2 directions for frequency f, six neighbours each
// (the twelve of valence five repeat themselves once). Direction 0 is exactly +z.
struct SphereMesh {
    std::vector<float> x, y, z;
    std::vector<std::uint32_t> neighbour;  // 6 per direction
    std::size_t size() const { return x.size(); }
};
SphereMesh geodesic_sphere(unsigned frequency);

// Support functions of all primitives over the mesh, tabulated once on the device: the landscape of
// any group of primitives is then a minimum over its rows (paper-exact: U(d) = M g (c.d - min s)).
class SupportTable {
  public:
    // Vertices: the corners of each primitive's extreme cells, reduced to their convex hull (Qhull).
    SupportTable(device::Device& device, const SolidCells& cells, std::int32_t primitives,
                 const SphereMesh& mesh);
    ~SupportTable();
    SupportTable(SupportTable&&) noexcept;
    std::int32_t primitives() const;
    const SphereMesh& mesh() const;
    struct Rows;
    const Rows& rows() const { return *rows_; }

  private:
    std::unique_ptr<Rows> rows_;
};

// What a group of primitives can do when pushed.
struct Stability {
    double barrier_J = 0;   // least energy that takes it out of its basin; 0: it falls by itself
    double release_J = 0;   // largest release behind that barrier
    double margin_m = 0;    // distance of the centre of mass inside the support polygon; < 0 outside
    Vec3 direction{};       // horizontal way it goes, unit, grid frame
    std::vector<InstabilityStep> curve;  // S(W), ascending in W
};

// One candidate rigid body: its primitives, its mass properties, and the hull of the points on which
// it is held up (x, y pairs, metres, counter-clockwise; empty: nothing below holds it).
struct Candidate {
    std::vector<std::int32_t> primitives;
    Body body;
    std::vector<std::array<double, 2>> support_polygon;
    double support_height_m = 0;
};

// Pose landscapes and barriers of many candidates in one batch (kernels group_landscape,
// barrier_flood). Order as given; deterministic.
std::vector<Stability> evaluate(device::Device& device, const SupportTable& table,
                                std::span<const Candidate> candidates);

// Merge tree of one landscape (paper, 3.2): the disconnectivity graph, by sorting and union-find.
struct MergeTree {
    struct Basin {
        std::uint32_t minimum = 0;  // direction of the mesh
        double energy = 0;          // of the minimum
        double pass = 0;            // energy at which it joins a deeper basin; infinity for the deepest
        std::uint32_t saddle = 0;   // direction of that pass
        std::int32_t parent = -1;   // basin that it joins
    };
    std::vector<Basin> basins;  // by rising energy
};
MergeTree disconnectivity_graph(std::span<const float> energy, const SphereMesh& mesh,
                                double plateau_tolerance);

}  // namespace topple::physics
