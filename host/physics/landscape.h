// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
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
    std::vector<std::uint32_t> neighbour;            // 6 per direction
    std::vector<std::array<std::uint32_t, 2>> edge;  // each pair of neighbours once, rising
    std::size_t size() const { return x.size(); }
};
SphereMesh geodesic_sphere(unsigned frequency);

// Support functions of all primitives over the mesh, tabulated once on the device: the landscape of
// any group of primitives is then a minimum over its rows (paper-exact: U(d) = M g (c.d - min s)).
class SupportTable {
  public:
    // Vertices: the corners of each primitive's extreme cells, reduced to their convex hull
    // (Qhull).
    SupportTable(device::Device& device, const SolidCells& cells, std::int32_t primitives,
                 const SphereMesh& mesh);
    // From vertices (metres, grid frame), one set per primitive, that are exact to resolution_m.
    SupportTable(device::Device& device, std::span<const std::vector<Vec3>> vertices,
                 double resolution_m, const SphereMesh& mesh);
    ~SupportTable();
    SupportTable(SupportTable&&) noexcept;
    std::int32_t primitives() const;
    const SphereMesh& mesh() const;
    struct Rows;
    const Rows& rows() const { return *rows_; }

  private:
    std::unique_ptr<Rows> rows_;
};

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

// What a group of primitives can do when pushed. Heights are known to one voxel, so a descent
// behind a pass counts from M g (voxel + what the mesh misses, if passes are sampled: half its
// spacing times the body's radius), and a minimum is deeper than the start from M g voxel / 2. A
// body that can turn by 90 degrees within the former (a ball, a lying cylinder) has barrier 0.
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
    std::vector<TippingWay> ways;         // all that the curve is of; of exact passes alone
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

// Where the passes of the hull's landscape come from.
enum class Passes {
    sampled,  // the mesh, made exact by a search of the hull's edges nearby: for many candidates
    // The convex hull of the members' vertices (hull_landscape.h): no descent is too small for the
    // mesh, so that only the voxel limits what counts. Half a millisecond for each candidate.
    // Where a candidate stood, or that hull would fall though the footing holds the candidate, it
    // is cut at the height of the support, and made as wide there as the footing. Those stay
    // sampled whose vertices span no volume about the centre of mass.
    exact,
};

// Pose landscapes and barriers of many candidates in one batch (kernels group_landscape,
// steepest_descent). Order as given; deterministic. The barrier is the least of
//   - M g (sqrt(h^2 + m^2) - h) over the edges of the support polygon, m the distance of the centre
//   of
//     mass to the edge's line, h its height above the support (paper-exact for rigid tipping), and
//   - the lowest pass of the hull's landscape on a plane.
// A centre of mass outside the polygon, or no polygon: barrier 0. The curve counts what the pose
// releases on a plane at the support's height, and the candidate's drops. Throws Error(usage) for a
// primitive that the table doesn't hold, and for drops that are not one for each edge.
std::vector<Stability> evaluate(device::Device& device, const SupportTable& table,
                                std::span<const Candidate> candidates,
                                Passes passes = Passes::sampled);

// Merge tree of one landscape (paper, 3.2): the disconnectivity graph, by sorting and union-find.
struct MergeTree {
    struct Basin {
        std::uint32_t minimum = 0;  // direction of the mesh, or node of the graph
        double energy = 0;          // of the minimum
        double pass = 0;  // energy at which it joins a deeper basin; infinity for the deepest
        std::uint32_t saddle = 0;  // direction or node of that pass
        std::int32_t parent = -1;  // basin that it joins
    };
    std::vector<Basin> basins;           // by rising energy
    std::vector<std::int32_t> basin_of;  // basin of each direction: the deepest one that its
                                         // component holds at its own level
    // The basin that joins another last on the way from a to b: its pass is the highest on the way.
    // -1 where both are in one basin, and no pass between them.
    std::int32_t last_join(std::uint32_t a, std::uint32_t b) const;
    // The least, over all paths from a to b, of the highest energy on the way; exact where the tree
    // was built with plateau_tolerance 0.
    double minimax(std::span<const float> energy, std::uint32_t a, std::uint32_t b) const;
};
// Basins no deeper than plateau_tolerance (in the energies' unit) below their pass are merged into
// the basin they join: a rolling ball has one basin, not one per facet.
MergeTree disconnectivity_graph(std::span<const float> energy, const SphereMesh& mesh,
                                double plateau_tolerance);
// The same of any graph, which need not hang together: the neighbours of each node, both ways.
MergeTree disconnectivity_graph(std::span<const double> energy,
                                std::span<const std::vector<std::uint32_t>> neighbours,
                                double plateau_tolerance);

}  // namespace topple::physics
