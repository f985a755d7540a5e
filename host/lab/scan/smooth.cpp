// SPDX-License-Identifier: MIT
#include "lab/scan/smooth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace topple::scenes {
namespace {

std::vector<double> gaussian(double sigma) {
    const int reach = std::max(1, static_cast<int>(std::ceil(3 * sigma)));
    std::vector<double> weights;
    double sum = 0;
    for (int k = -reach; k <= reach; ++k) {
        weights.push_back(std::exp(-0.5 * (k / sigma) * (k / sigma)));
        sum += weights.back();
    }
    for (double& w : weights) w /= sum;
    return weights;
}

// What averaging leaves of the standard deviation of independent numbers.
double left(const std::vector<double>& weights) {
    double squares = 0;
    for (const double w : weights) squares += w * w;
    return std::sqrt(squares);
}

// `count` values, `step` apart.
void smooth_line(float* values, std::size_t count, std::size_t step,
                 const std::vector<double>& weights, std::vector<float>& line) {
    const auto reach = static_cast<std::int64_t>(weights.size() / 2);
    const auto last = static_cast<std::int64_t>(count) - 1;
    line.resize(count);
    for (std::int64_t n = 0; n <= last; ++n) {
        double sum = 0;
        for (std::int64_t k = -reach; k <= reach; ++k) {
            const auto at = static_cast<std::size_t>(std::clamp<std::int64_t>(n + k, 0, last));
            sum += weights[k + reach] * values[at * step];
        }
        line[n] = static_cast<float>(sum);
    }
    for (std::size_t n = 0; n < count; ++n) values[n * step] = line[n];
}

}  // namespace

std::vector<double> smooth_noise(std::size_t count, double sigma, double size, Random& random) {
    std::vector<float> noise(count);
    for (float& n : noise) n = static_cast<float>(random.normal());
    const auto weights = gaussian(sigma);
    std::vector<float> line;
    smooth_line(noise.data(), count, 1, weights, line);
    std::vector<double> out;
    for (const float n : noise) out.push_back(size / left(weights) * n);
    return out;
}

std::vector<float> smooth_noise_image(std::size_t width, std::size_t height, double sigma,
                                      double size, Random& random) {
    std::vector<float> noise(width * height);
    for (float& n : noise) n = static_cast<float>(random.normal());
    // Along rows and columns; beyond its border the image is continued by its edge.
    const auto weights = gaussian(sigma);
    std::vector<float> line;
    for (std::size_t v = 0; v < height; ++v)
        smooth_line(noise.data() + v * width, width, 1, weights, line);
    for (std::size_t u = 0; u < width; ++u)
        smooth_line(noise.data() + u, height, width, weights, line);
    const double kept = left(weights);
    for (float& n : noise) n *= static_cast<float>(size / (kept * kept));
    return noise;
}

}  // namespace topple::scenes
