// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

// What a peak acceleration of the ground means to people: the scale of instrumental intensity (Wald
// and others 1999, Earthquake Spectra 15, table 1).
namespace topple::safety {

struct Intensity {
    double up_to_g;  // the end of its range, included; infinity for the last
    const char *word, *number;
};

// From weak to strong.
std::span<const Intensity> intensities();

// "very strong shaking, intensity VII"
std::string shaking_text(double pga_g);

// What to say of a peak so weak that it was meant in g, perhaps, or so strong that it was meant in
// hundredths of g; "" of others.
std::string unlikely_peak_note(double pga_m_s2);

}  // namespace topple::safety
