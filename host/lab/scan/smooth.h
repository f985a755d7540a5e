// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "lab/random.h"

namespace topple::scenes {

// Normally distributed numbers smoothed with a Gaussian of `sigma` samples, then scaled to the
// standard deviation `size`.
std::vector<double> smooth_noise(std::size_t count, double sigma, double size, Random& random);

// The same as an image: `height` rows of `width`.
std::vector<float> smooth_noise_image(std::size_t width, std::size_t height, double sigma,
                                      double size, Random& random);

}  // namespace topple::scenes
