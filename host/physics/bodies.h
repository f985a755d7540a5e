// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary_cells.h"
#include "core/scan_gaps.h"
#include "core/solid_cells.h"
#include "topple/input.h"
#include "topple/kernels/device.h"

// Everything in this folder works in the grid frame of SolidCells.
namespace topple::physics {

// Coulomb's coefficient of a thing on what it stands on, and one standard error of it.
struct Friction {
    double coefficient = 0, error = 0;
    double error_share() const { return coefficient > 0 ? error / coefficient : 0; }
};
// Of a coefficient that nobody told of that thing, as a share of it. Set by hand: handbooks have
// most pairs of dry household surfaces between 0.2 and 0.6.
inline constexpr double unknown_friction_share = 1.0 / 3;

// Mass properties of one primitive or of a group of them.
struct MassProperties {
    std::uint64_t voxels = 0;  // that are it for the most part
    double volume_m3 = 0, mass_kg = 0;
    Vec3 center{};  // centre of mass

    // Of what has no volume 0.
    double density_kg_m3() const { return volume_m3 > 0 ? mass_kg / volume_m3 : 0; }
};

// Mass properties of `count` labels over the cells (kernel segmented_sum; exact integer sums), of
// which those of `boundary` count with their shares. Sorted by (i, j, k) where there are any.
// density_kg_m3: one value per label.
std::vector<MassProperties> mass_properties(device::Device& device, const SolidCells& cells,
                                            std::int32_t count,
                                            std::span<const double> density_kg_m3,
                                            const BoundaryCells& boundary = {});

MassProperties combine(std::span<const MassProperties> bodies);

// Two primitives with face-adjacent voxels.
struct TouchingPair {
    std::int32_t a = -1, b = -1;           // a < b
    std::array<std::uint32_t, 6> faces{};  // voxel faces of a towards b: -x +x -y +y -z +z
    double area_m2 = 0;  // area of the contact patch: the largest opposite-direction face count
    Vec3 normal{};       // from a to b, unit: the axis that carries the contact
    Vec3 center{};       // mean of the contact faces
    std::array<Vec3, 4> ends{};  // middles of the contact faces furthest along -x, +x, -y, +y
};

// All touching pairs, sorted by (a, b). Gaps of up to `gap` empty voxels along an axis count as
// contact.
std::vector<TouchingPair> touching_pairs(device::Device& device, const SolidCells& cells,
                                         std::int32_t count, unsigned gap = contact_gap);

}  // namespace topple::physics
