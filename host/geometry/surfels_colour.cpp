// SPDX-License-Identifier: MIT
#include "geometry/surfels_colour.h"

#include <array>
#include <limits>

#include "core/colour_space.h"

namespace topple::geometry {

void set_colours(const CloudView& cloud, Surfels& s) {
    if (cloud.red.empty()) return;
    // Whole numbers, so that the order of the points does not matter.
    struct Sum {
        std::array<std::uint64_t, 3> channel{};
        std::uint64_t points = 0;
    };
    std::vector<Sum> sums(s.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Rgb8 colour{cloud.red[i], cloud.green[i], cloud.blue[i]};
        if (colour == Rgb8{0, 0, 0}) continue;
        Sum& sum = sums[s.of_point[i]];
        for (std::size_t c = 0; c < 3; ++c) sum.channel[c] += colour[c];
        ++sum.points;
    }
    for (auto* values : {&s.lab_l, &s.lab_a, &s.lab_b})
        values->assign(s.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (sums[i].points == 0) continue;
        std::array<double, 3> mean{};
        for (std::size_t c = 0; c < 3; ++c) {
            mean[c] = static_cast<double>(sums[i].channel[c]) /
                      (255.0 * static_cast<double>(sums[i].points));
        }
        const std::array<double, 3> lab = lab_of_srgb(mean);
        s.lab_l[i] = static_cast<float>(lab[0]);
        s.lab_a[i] = static_cast<float>(lab[1]);
        s.lab_b[i] = static_cast<float>(lab[2]);
    }
}

}  // namespace topple::geometry
