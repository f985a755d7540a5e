// SPDX-License-Identifier: MIT
#include "points/formats/colour_values.h"

#include <algorithm>
#include <cmath>

namespace topple::io {
namespace {

// Points with a colour that tell what full brightness is.
constexpr std::uint64_t enough = 1 << 16;

bool usable(double value) {
    return std::isfinite(value) && value >= 0;
}

double full_brightness(const std::vector<std::array<float, 3>>& colours, ColourValues values) {
    std::uint64_t bright = 0, above_1 = 0, above_255 = 0;
    for (const auto& colour : colours) {
        for (const float value : colour) {
            if (!usable(value)) continue;
            bright += value > 0;
            above_1 += value > 1;
            above_255 += value > 255;
        }
    }
    if (values == ColourValues::real && 100 * above_1 <= bright) return 1;
    return 100 * above_255 <= bright ? 255 : 65535;
}

}  // namespace

void ColourScale::put(const std::array<double, 3>& colour, PointCloud& cloud) const {
    const bool known = std::ranges::all_of(colour, usable);
    const auto byte = [&](double value) {
        return static_cast<std::uint8_t>(known ? std::lround(std::min(value / full_, 1.0) * 255)
                                               : 0);
    };
    cloud.red.push_back(byte(colour[0]));
    cloud.green.push_back(byte(colour[1]));
    cloud.blue.push_back(byte(colour[2]));
}

void ColourScale::add(const std::array<double, 3>& colour, PointCloud& cloud) {
    if (values_ == ColourValues::none) return;
    if (values_ == ColourValues::bytes) full_ = 255;
    if (full_ > 0) {
        put(colour, cloud);
        return;
    }
    waiting_.push_back({static_cast<float>(colour[0]), static_cast<float>(colour[1]),
                        static_cast<float>(colour[2])});
    bright_ += std::ranges::any_of(colour, [](double value) { return value > 0; });
    if (bright_ == enough) settle(cloud);
}

void ColourScale::settle(PointCloud& cloud) {
    if (waiting_.empty()) return;
    full_ = full_brightness(waiting_, values_);
    for (const auto& colour : waiting_) put({colour[0], colour[1], colour[2]}, cloud);
    waiting_ = {};
}

}  // namespace topple::io
