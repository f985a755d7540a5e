// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "physics/bodies.h"
#include "topple/scene.h"

namespace topple::physics {

inline constexpr double gravity = 9.80665;  // m/s^2

// Of an edge.
using Ends = std::array<Vec3, 2>;

// One way in which a body leaves its pose. Heights are of its centre of mass: times M g, joules.
struct TippingWay {
    double climb_m = 0;
    double release_m = 0;  // from the top of the climb; 0: nothing there is deeper
    Vec3 direction{};      // horizontal way that it goes, unit, grid frame; zero: any, or none
    // The edge that it turns over, where it is as it stands, grid frame; nothing where it falls or
    // rolls without one.
    std::optional<Ends> edge{};
    double drop_m = 0;  // what it falls beyond where its support ends, part of release_m
};

// What a group of primitives can do when pushed. Heights are known to a resolution: a descent
// behind a pass counts from M g resolution, and a minimum is deeper than the start from half of
// that. A body that can turn by 90 degrees within the former (a ball, a lying cylinder) has barrier
// 0.
struct Stability {
    // Least energy that takes it out of its basin; 0: it falls or rolls by itself.
    double barrier_J = 0;
    // Largest release behind that barrier, counted from the pass; 0: nothing there is deeper.
    double release_J = 0;
    // Distance of the centre of mass inside the support polygon; < 0 outside; minus the body's
    // radius where nothing holds it.
    double margin_m = 0;
    TippingWay easiest;                   // the way with that barrier and release
    std::optional<TippingWay> releasing;  // the easiest that releases anything: the first step
    std::vector<InstabilityStep> curve;   // S(W), ascending in W
    std::vector<TippingWay> ways;         // all that the curve is of
};

// One candidate rigid body: its primitives, its mass properties, and the hull of the points on
// which it is held up (x, y pairs, metres, counter-clockwise; empty: nothing below holds it).
struct Candidate {
    std::vector<std::int32_t> primitives;
    MassProperties body;
    std::vector<std::array<double, 2>> support_polygon;
    double support_height_m = 0;
    double border_error_m = 0;  // of the polygon's border: one standard error
    // How far it falls below that height where it tips over each of the polygon's edges
    // (drops_when_tipped_m); empty: nowhere.
    std::vector<double> edge_drop_m = {};
    // Whether it was seen to stand as it is: then its hull is flat underneath, at the height of its
    // support and as wide as its polygon, whatever noise left there. Otherwise it may rock.
    bool stood = false;
};

// Merge tree of a landscape over a graph (paper, 3.2): the disconnectivity graph, by sorting and
// union-find.
struct MergeTree {
    struct Basin {
        std::uint32_t minimum = 0;  // node of the graph
        double energy = 0;          // of the minimum
        double pass = 0;  // energy at which it joins a deeper basin; infinity for the deepest
        std::uint32_t saddle = 0;  // node of that pass
        std::int32_t parent = -1;  // basin that it joins
    };
    std::vector<Basin> basins;           // by rising energy
    std::vector<std::int32_t> basin_of;  // basin of each node: the deepest one that its component
                                         // holds at its own level
    // The basin that joins another last on the way from a to b: its pass is the highest on the way.
    // -1 where both are in one basin, and no pass between them.
    std::int32_t last_join(std::uint32_t a, std::uint32_t b) const;
};
// Of any graph, which need not hang together: the neighbours of each node, both ways. Basins no
// deeper than plateau_tolerance (in the energies' unit) below their pass are merged into the basin
// they join: a rolling ball has one basin, not one per facet.
MergeTree disconnectivity_graph(std::span<const double> energy,
                                std::span<const std::vector<std::uint32_t>> neighbours,
                                double plateau_tolerance);

}  // namespace topple::physics
