// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/solid_scene.h"
#include "physics/bodies.h"
#include "physics/body_errors.h"

// Cabinets, wardrobes, chests of drawers and fridges are filled by completion, since nobody saw
// into them, but they are no solid wood: boards around what they hold.
namespace topple::physics {

// Of what fills less of its box no wall behind it makes a cupboard.
inline constexpr double least_furniture_fill = 0.2;

// What closed furniture looks like from outside. Grid frame.
struct FurnitureLooks {
    double height_m = 0;
    double fill = 0;  // share of the smallest upright box around it that is solid
    // Of that one of the four upright sides of that box which most of is near the room: the share
    // of what the object has near it that has something of the room within 8 cm of that. 0 for what
    // fills less than a fifth of its box.
    double backing = 0;
    double box_side_m2 = 0;         // of all six sides of that box
    std::array<double, 2> box_m{};  // its level sides, the shorter one first
    // Backing within a voxel less than 8 cm, and within a voxel more: where the voxels' borders
    // fall is chance, and moves what lies between two surfaces by as much.
    std::array<double, 2> backing_range{};
    std::array<double, 2> front{};  // from that side to the one across: level, unit
    double deep_m = 0;              // from one to the other
};

// Of each object, without what of it is of the room's shell. volumes_m3: by object.
std::vector<FurnitureLooks> furniture_looks(const SolidScene& solids,
                                            std::span<const std::int32_t> object_of_primitive,
                                            std::span<const double> volumes_m3);

// The probability that such an object is closed furniture: a logistic function of height x fill x
// backing, fitted on objects of generated rooms (docs/algorithms.md). What stands free in a room is
// taken to be solid: nothing tells a block from a box of boards there.
double probability_closed(const FurnitureLooks& looks);

// Its log-odds, from one of these backings.
double log_odds_closed(const FurnitureLooks& looks, double backing);

// The share of the objects that it was fitted on that are closed furniture: 26 of 231.
inline constexpr double closed_share = 0.11;

// Boards of 18 mm, as most furniture is made of, around contents.
struct ClosedBody {
    static constexpr double board_m = 0.018;
    double density_kg_m3 = 0;          // mass over the volume of all of it
    double inertia_density_kg_m3 = 0;  // of an even solid with the same inertia
    double contents_share = 0;         // of the mass
    BodyError error;                   // by what is not known of the contents alone
};

// volume_m3: its outer volume. board_kg_m3: of what it is made of. contents_kg_m3: of what it holds
// over its inner volume, evenly spread; known to be anything from 0 to twice that, and its centre
// to lie anywhere in the middle half of the height.
ClosedBody closed_body(const FurnitureLooks& looks, double volume_m3, double board_kg_m3,
                       double contents_kg_m3);

// What can be drawn out of a thing, all at once: its drawers with what they hold, as furniture is
// tested (16 CFR 1261, 2022; ASTM F2057-23).
struct Drawers {
    double probability = 0;       // that it has any
    std::array<double, 2> way{};  // level, unit
    double out_m = 0;             // how far
    double mass_share = 0;        // of the thing's
};

// Of furniture that is closed with such a probability. Its contents are in drawers, if it has any.
Drawers drawers_of(const FurnitureLooks& looks, double closed, const ClosedBody& body);

}  // namespace topple::physics
