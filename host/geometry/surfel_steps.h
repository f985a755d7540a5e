// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/cell_grid.h"
#include "geometry/plane_fit.h"
#include "geometry/surfels.h"
#include "topple/cloud_view.h"
#include "topple/kernels/device.h"

// The steps of make_surfels(), in their order.
namespace topple::geometry {

// Weight of a cell of `count` points in a plane fit. A cell's mean has the variance
// noise^2 / count + (what no plane explains)^2: many points soon stop helping.
inline float fit_weight(double count) {
    return static_cast<float>(count / (count + 4.0));
}

// Moves each cell's mean onto the plane of its neighbourhood and bins anew, so that a surface whose
// noise is thicker than a cell becomes one layer of cells (moving least squares, one step). Only
// where a plane fits as well as it does in most of the scene, and by no more than noise explains:
// edges and small things stay. count: points per cell; of_point: cell of each point; both follow
// the new cells. Returns the planes that were fitted, of each new cell that of its heaviest part.
PlaneFit flatten_noise(device::Device& device, CellGrid& grid, std::vector<float>& count,
                       std::vector<std::uint32_t>& of_point);

// Where the sensor of each point was: at the viewpoint, or, where there are none, where the stored
// normals point to. The arguments must outlive it.
class SensorSides {
  public:
    SensorSides(const CloudView& cloud, std::span<const Vec3> viewpoints,
                std::span<const std::uint32_t> viewpoint_of_point);
    bool known() const { return known_; }
    // The way from a point to its sensor, of any length.
    std::array<double, 3> way(std::size_t point) const;
    // Its unit direction, rounded so that sums are exact, whatever their
    // order; 0 where it is not known.
    std::array<float, 3> towards(std::size_t point) const;

  private:
    const CloudView& cloud_;
    std::span<const Vec3> viewpoints_;
    std::span<const std::uint32_t> viewpoint_of_point_;
    bool known_;
};

// Parts the cells that hold both sides of a wall thinner than themselves, as of a cup, in two, one
// after the other: together they would lie within the wall, and know one side of it. Whose sensor
// was on the other side of the cell's plane is of the other side of the wall, if it lies apart from
// the rest by more than these scatter. count: points per cell; of_point: cell of each point;
// planes: of each cell.
void part_sides(const CloudView& cloud, const SensorSides& sides, ThreadPool& threads,
                CellGrid& grid, std::vector<float>& count, std::vector<std::uint32_t>& of_point,
                PlaneFit& planes);

// Which side of each surfel the sensor was on: the sum of unit directions from the surfel's points
// to their sensors; empty where these are not known.
struct Orientation {
    std::array<std::vector<double>, 3> towards;
};
Orientation sensor_side(const Surfels& surfels, const SensorSides& sides, ThreadPool& threads);

// Flips normals to the known side. Where no side is known, signs spread over each connected piece
// from neighbour to neighbour, the most parallel first (Hoppe et al. 1992), and the piece as a
// whole faces the middle of the cloud, as the inside of a room does.
void orient(Surfels& surfels, const Orientation& orientation);

}  // namespace topple::geometry
