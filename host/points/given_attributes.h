// SPDX-License-Identifier: MIT
#pragma once

#include "topple/cloud_view.h"

namespace topple::geometry {

// What a cloud's points bring beside their places, against what their neighbours say; shares from 0
// to 1. Taken in cells of a few points each, a sample of them evenly over the surface.
struct GivenAttributes {
    // Of the points on flat surface: whose normal is far off its direction; and of the others,
    // whose normal faces the other side than most around it.
    double askew = 0, opposed = 0;
    // Of the colours' variance what lies between neighbours: 1 of colours at random.
    double colour_noise = 0;
    bool one_colour = false;  // all points have the same

    // Beyond what noise, edges and thin boards do; see given_attributes.cpp.
    bool normals_contradict() const;
    bool colours_tell() const;
};

// around_m: the distance of neighbouring points, as PointSpacing has it.
GivenAttributes look_at_attributes(const CloudView& cloud, double around_m);

}  // namespace topple::geometry
