// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "geometry/coarse_grid.h"
#include "geometry/surface_samples.h"

namespace topple::geometry {

// How far one gets from a place before something seen is met: the scene's samples in a coarse grid
// of cells. Metres, z up.
class SightLines {
  public:
    explicit SightLines(const SurfaceSamples& samples);

    double cell_m() const { return grid_.cell_m(); }
    // Distance from `from` along a unit direction to the first occupied cell at least `start_m`
    // away; infinite where there is none within `reach_m`.
    double met_m(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double start_m,
                 double reach_m) const;

  private:
    CoarseGrid grid_;
    std::vector<bool> occupied_;  // by cell
};

}  // namespace topple::geometry
