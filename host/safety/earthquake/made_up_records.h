// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "topple/input.h"

namespace topple::safety {

// Records that no earthquake has made, for scenes whose earthquakes nobody has recorded: white
// noise that swells and fades, through the ground as a damped oscillator and a filter that takes
// out what is too slow for ground that comes to rest (Kanai 1957; Tajimi 1960; Clough and Penzien
// 1975). With noise n(t), ground frequency f, damping d, and those of the slow filter, f' and d':
//     x'' + 2 d f x' + f^2 x = -n,  y'' + 2 d' f' y' + f'^2 y = 2 d f x' + f^2 x,  a = y''
// The five ground types of Eurocode 8 (EN 1998-1, table 3.1) in turn, A to E, with f, d, f', d' and
// the swell t exp(-b t / 2) of its type 1 spectra as Giaralis and Spanos (2009) fitted them. Both
// level components are of independent noise, with peaks of 1 m/s^2; so is the vertical one, with
// frequencies half as high again and a peak of two thirds (Newmark, Blume and Kapur 1973).
// They last 30 s in steps of 0.01 s. The first records don't depend on the count.
std::vector<Accelerogram> made_up_records(std::size_t count, std::uint64_t seed);

// Peak velocity, m/s, of the integral of the acceleration from rest: of two level components the
// geometric mean, as of Accelerogram::peak_m_s2().
double peak_velocity_m_s(const Accelerogram& record);

}  // namespace topple::safety
