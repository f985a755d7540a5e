// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "safety/human/body_parts.h"
#include "safety/human/human_field.h"
#include "safety/human/secondary_motion.h"

namespace topple::safety {
namespace {

double part_weight(const BodyPart& part, const HumanOptions& options, double ahead, double aside,
                   double spacing) {
    const double height = options.body_height_m;
    const double low = -part.back * height, high = part.front * height, reach = part.reach * height;
    const double covered = std::min(ahead + spacing / 2, high) - std::max(ahead - spacing / 2, low);
    if (covered <= 0) return 0;
    const double stray = std::fabs(aside) - reach;
    if (stray >= options.wander_m && stray > 0) return 0;
    return part.share * covered / (high - low) * (stray > 0 ? 1 - stray / options.wander_m : 1.0);
}

// The bands whose middle lies within the part.
Bands bands_of(const BodyPart& part) {
    Bands bands;
    for (unsigned b = 0; b < band_count; ++b) {
        const double middle = (b + 0.5) / band_count;
        if (middle < part.low || middle >= part.high) continue;
        if (bands.count++ == 0) bands.first = b;
    }
    return bands;
}

}  // namespace

void add_part(SecondaryMotion& motion, const BodyPart& part, const HumanOptions& options) {
    const double speed = part.speed * options.walking_speed_m_s;
    MotionLayer layer;
    layer.level = motion.energy_J.size();
    layer.bands = bands_of(part);
    layer.speed_m_s = speed;
    layer.ways.push_back({0, [part, options](double ahead, double aside, double spacing) {
                              return part_weight(part, options, ahead, aside, spacing);
                          }});
    motion.mass_kg.push_back(part.mass * options.body_mass_kg);
    motion.energy_J.push_back(0.5 * motion.mass_kg.back() * speed * speed);
    motion.layers.push_back(std::move(layer));
    motion.reach_m = std::max(motion.reach_m,
                              std::hypot(part.reach * options.body_height_m + options.wander_m,
                                         std::max(part.back, part.front) * options.body_height_m));
}

SecondaryMotion table_motion(const HumanOptions& options) {
    SecondaryMotion out;
    for (const BodyPart& part : options.parts) add_part(out, part, options);
    return out;
}

}  // namespace topple::safety
