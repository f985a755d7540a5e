// SPDX-License-Identifier: MIT
#pragma once

#include "core/solid_cells.h"
#include "graph/contact_graph.h"
#include "host/physics/solids.h"

namespace topple::test {

inline Inside cylinder(double x0, double y0, double r, double low, double high) {
    return [=](double x, double y, double z) {
        return std::hypot(x - x0, y - y0) < r && z > low && z < high;
    };
}

// A room's floor is primitive 0; the others follow.
struct FloorScene {
    std::vector<Solid> solids{{0, box({-1, -1, -0.04}, {1, 1, 0})}};
    SolidCells cells;
    std::int32_t count = 1;

    std::int32_t add(const Inside& inside) {
        solids.push_back({count, inside});
        return count++;
    }
    void voxelise() { cells = test::voxelise(solids, {-1, -1, -0.04}, {1, 1, 1.2}, 0.02); }
    graph::ContactGraph contacts(device::Device& device) {
        if (cells.size() == 0) voxelise();
        return graph::build_contact_graph(device, cells, count);
    }
    std::vector<physics::MassProperties> bodies(device::Device& device) const {
        const std::vector<double> density(static_cast<std::size_t>(count), 700);
        return physics::mass_properties(device, cells, count, density);
    }
};

}  // namespace topple::test
