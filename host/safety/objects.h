// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "safety/earthquake/rocking.h"
#include "safety/fields.h"

// What the three fields ask of the objects' cells.
namespace topple::safety {

// The object of each solid cell, -1 for none and for grounded objects.
std::vector<std::int32_t> movable_object_of_cells(const Surroundings& surroundings,
                                                  std::span<const RiskObject> objects);

// The cell belongs to a floor.
bool is_floor_cell(const Surroundings& surroundings, std::size_t cell);

// The cells of each object, ascending.
std::vector<std::vector<std::uint32_t>> cells_of_objects(
    std::span<const std::int32_t> object_of_cell, std::size_t objects);

// How an object stands, metres.
struct MassSpread {
    Vec3 center{};                   // of mass
    double bottom_m = 0, top_m = 0;  // its base, and the top of its highest cell
    // Mean of (x - center)^2, of (x - center_x)(y - center_y) and so on over its mass: xx, xy, yy,
    // zz.
    std::array<double, 4> spread_m2{};
    double height() const { return center[2] - bottom_m; }  // of the centre, above the base
    // Square of its radius of gyration about the level axis through the centre across (dx, dy).
    double gyration_m2(double dx, double dy) const {
        const auto& [xx, xy, yy, zz] = spread_m2;
        return dx * dx * xx + 2 * dx * dy * xy + dy * dy * yy + zz;
    }
};
MassSpread stance(const Surroundings& surroundings, std::span<const std::uint32_t> of_object,
                  const RiskObject& object);

// Half base b in horizontal direction (dx, dy): from below the centre of mass to where the support
// ends that way, 0 where it has ended already. From the support polygon, or half of base_width_m.
double half_base(const RiskObject& object, const MassSpread& stance, double dx, double dy);

// How far the support goes on along (dx, dy) below the object's centre of mass; 0 where there is
// none to begin with, as below what stands on legs; infinite beyond 3 m.
class Columns;
double support_reach(const MassSpread& stance, const Columns& columns, double dx, double dy);

// The object seen from the side, `ahead` being (dx, dy).
Profile profile(const RiskObject& object, const MassSpread& stance, const Columns& columns,
                double dx, double dy);

// Energy that lifts the centre of mass over the base's edge: m g (sqrt(h^2 + b^2) - h).
double tipping_energy(double mass_kg, double height_m, double half_base_m);

// A uniform sample of at most max_samples of the arrows offered, in their order; its own generator
// makes it the same every time.
class ArrowSample {
  public:
    ArrowSample();
    ~ArrowSample();
    void offer(const Vec3& at, const Vec3& along, double density);
    FieldSamples take();

  private:
    struct Arrow;
    std::vector<Arrow> heap_;
    std::uint64_t offered_ = 0;
};

}  // namespace topple::safety
