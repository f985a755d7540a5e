// SPDX-License-Identifier: MIT
#pragma once

#include "safety/fields.h"
#include "standard.h"

namespace topple::test {

// Scenes of boxes as solid cells, in metres. Each box is a primitive and an object of its own, or a
// part of an earlier one; where boxes overlap, the later one holds the cells.
class Room {
  public:
    explicit Room(double voxel_m) { cells_.voxel_m = voxel_m; }
    // With a floor from `low` to `high`.
    Room(double voxel_m, const std::array<double, 2>& low, const std::array<double, 2>& high)
        : Room(voxel_m) {
        floor(low[0], high[0], low[1], high[1]);
    }

    // Returns the object's id.
    std::int32_t box(double x0, double x1, double y0, double y1, double z0, double z1,
                     bool grounded = true, double density = 700) {
        const auto id = static_cast<std::int32_t>(objects.size());
        safety::RiskObject object;
        object.grounded = grounded;
        object.height_m = z1 - z0;
        object.base_width_m = std::min(x1 - x0, y1 - y0);
        object.barrier_J = 0.05;
        object.curve = {{0.05, 1.0}, {5.0, 2.0}};
        objects.push_back(object);
        part(id, x0, x1, y0, y1, z0, z1, density);
        return id;
    }
    // One more primitive of an object.
    void part(std::int32_t object, double x0, double x1, double y0, double y1, double z0, double z1,
              double density = 700) {
        const auto primitive = static_cast<std::int32_t>(object_of_primitive.size());
        const auto index = [&](double v) {
            return static_cast<std::int32_t>(std::lround(v / cells_.voxel_m));
        };
        for (std::int32_t i = index(x0); i < index(x1); ++i) {
            for (std::int32_t j = index(y0); j < index(y1); ++j) {
                for (std::int32_t k = index(z0); k < index(z1); ++k) owner_[{i, j, k}] = primitive;
            }
        }
        object_of_primitive.push_back(object);
        density_kg_m3.push_back(density);
        floor_.push_back(false);
        objects[object].mass_kg += density * (x1 - x0) * (y1 - y0) * (z1 - z0);
    }
    std::int32_t thing(double x, double y, double z, double size = 0.08, double height = 0.12) {
        return box(x - size / 2, x + size / 2, y - size / 2, y + size / 2, z, z + height, false);
    }
    std::int32_t floor(double x0, double x1, double y0, double y1, double z = 0) {
        const std::int32_t id = box(x0, x1, y0, y1, z - cells_.voxel_m, z);
        floor_.back() = true;
        return id;
    }
    void remove(double x0, double x1, double y0, double y1, double z0, double z1) {
        std::erase_if(owner_, [&](const auto& entry) {
            const auto& [i, j, k] = entry.first;
            const double v = cells_.voxel_m, x = (i + 0.5) * v, y = (j + 0.5) * v,
                         z = (k + 0.5) * v;
            return x > x0 && x < x1 && y > y0 && y < y1 && z > z0 && z < z1;
        });
    }

    // Valid until the next call.
    safety::Surroundings surroundings() {
        const double voxel_m = cells_.voxel_m;
        cells_ = {};
        cells_.voxel_m = voxel_m;
        safety::Surroundings out;
        for (const auto& [place, primitive] : owner_) {
            cells_.i.push_back(std::get<0>(place));
            cells_.j.push_back(std::get<1>(place));
            cells_.k.push_back(std::get<2>(place));
            cells_.primitive.push_back(primitive);
            cells_.basis.push_back(Basis::surface);
            out.object.push_back(object_of_primitive[primitive]);
        }
        out.cells = &cells_;
        out.is_floor_primitive = floor_;
        out.density_kg_m3 = density_kg_m3;
        return out;
    }
    const SolidCells& cells() const { return cells_; }

    std::vector<safety::RiskObject> objects;
    std::vector<std::int32_t> object_of_primitive;
    std::vector<double> density_kg_m3;  // by primitive

  private:
    SolidCells cells_;
    std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::int32_t> owner_;
    std::vector<bool> floor_;
};

inline double total_probability(const std::vector<safety::WorkSample>& work) {
    double sum = 0;
    for (const auto& sample : work) sum += sample.probability;
    return sum;
}

}  // namespace topple::test
