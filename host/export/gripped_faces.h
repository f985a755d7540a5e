// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/colour_space.h"
#include "topple/scene.h"

namespace topple::exports {

// What sticks out of an upright face as a handle does. u, z: its middle, along the face and up.
struct Grip {
    enum class Form : std::uint8_t { knob, level_bar, upright_bar };
    Form form = Form::knob;
    double u = 0, z = 0, wide_m = 0, high_m = 0, out_m = 0;
    double probability = 0;
};

// A flat upright face of an object that has grips. World frame: z up, metres.
struct GrippedFace {
    Vec3 out{}, across{};        // unit and level; seen from inside, across points to the left
    Rgb8 colour{204, 194, 178};  // of its points, where known
    double at_m = 0;             // out . p of its points
    double low_u = 0, high_u = 0, low_z = 0, high_z = 0;  // the rectangle that it is
    double deep_m = 0;        // so deep was seen what goes back from its edges
    std::vector<Grip> grips;  // by u

    double wide_m() const { return high_u - low_u; }
    double high_m() const { return high_z - low_z; }
    Vec3 place(double u, double z, double out_m = 0) const {
        return {u * across[0] + (at_m + out_m) * out[0], u * across[1] + (at_m + out_m) * out[1],
                z};
    }
};

// Of each object, by id. Finds them in maps of what was seen before each face, of a centimetre:
// where points lie further apart, there are none.
std::vector<std::vector<GrippedFace>> gripped_faces(const Scene& scene);

}  // namespace topple::exports
