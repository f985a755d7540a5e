// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "safety/fields.h"
#include "safety/human/body_parts.h"
#include "safety/human/human_field.h"

// Secondary motion (paper, 5.1.2 and Fig. 10): what strikes, and how hard, around a body that
// walks.
namespace topple::safety {

// Height bands: the body's height in 32 equal parts, so that one word holds a bit for each.
inline constexpr unsigned band_count = 32;
struct Bands {
    unsigned first = 0, count = 0;
};

// What moves in some bands at one energy.
struct MotionLayer {
    std::size_t level = 0;  // of energy, below
    Bands bands;
    double speed_m_s = 0;  // mean
    // Passes, per walk past a place, of what moves `turn` directions to the left of the walker's
    // heading.
    struct Way {
        unsigned turn = 0;
        // The share of them that happens while the walker is between spacing_m / 2 before and
        // behind where the place lies `ahead_m` of and `aside_m` to the left of the body's centre.
        std::function<double(double ahead_m, double aside_m, double spacing_m)> passes;
    };
    std::vector<Way> ways;
};

// The distribution of velocities by height and offset around the walking body: p(W, direction) is
// its convolution with the primary motion.
struct SecondaryMotion {
    std::vector<double> energy_J;  // m v^2 / 2 of each level (paper, 5.2)
    std::vector<double> mass_kg;   // m of each level
    std::vector<MotionLayer> layers;
    double reach_m = 0;  // beyond it, in any direction, no layer has passes
    std::vector<std::string> notes;
};

// From the table of the options' parts: a level for each part. A part that reaches l to the
// side passes everything up to l, and with a chance that falls linearly to 0 what lies up to
// wander_m further out, since walkers stray from their path. One walk past a place is `share`
// passes.
SecondaryMotion table_motion(const HumanOptions& options);
// Adds one part, as a level of its own.
void add_part(SecondaryMotion& motion, const BodyPart& part, const HumanOptions& options);

// From the recordings of the options. The walk as a whole is taken out, and that of the options put
// in: what the joints do relative to the body's centre is the secondary motion. Limbs are as wide
// as limbs are across the way that they move, the trunk is a plate. What covers a place in band b
// for the share p of the time, at a speed v, passes it p v / v_walk times per walk. The body is as
// likely seen in a mirror, and strays by up to wander_m to either side. Levels are 8 ranges of
// energy, logarithmic; segments have the masses of Winter 2009, Table 4.1, and half of what they
// hang on moves along. A segment moves in each recording that has it as often as in the others.
// Where no hand reaches out, as in a short walk, that of the table is added. Throws Error(input)
// naming the source where no segment, or no heading, can be found.
SecondaryMotion recorded_motion(const HumanOptions& options);

}  // namespace topple::safety
