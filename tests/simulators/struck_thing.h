// SPDX-License-Identifier: MIT
#pragma once

#include "core/random.h"
#include "host/pipeline/assessed_room.h"

// Things of boxes that a simulator strikes and pulls at.
namespace topple::exports::test {

inline constexpr double blow_voxel_m = 0.0125, blow_friction = 0.3;

using BlowBox = std::array<double, 6>;  // x0, x1, y0, y1, z0, z1

// Boxes, thin boards, L shapes, lamps and steps in turn, every other one near a table's edge.
struct StruckThing {
    std::vector<BlowBox> parts, fixed;

    StruckThing(Random& random, int number) {
        const auto some = [&](double low, double high) {
            return blow_voxel_m * std::round(random.uniform(low, high) / blow_voxel_m);
        };
        const bool table = number % 2 == 1;
        const double top = table ? 0.5 : 0;
        fixed.push_back({-1, 1, -1, 1, -0.0125, 0});
        if (table) fixed.push_back({-0.4, 0.4, -0.3, 0.3, 0.4, top});
        const double x = table ? some(-0.38, 0.1) : 0, y = table ? some(-0.28, 0.1) : 0;
        const double wide = some(0.06, 0.16), deep = some(0.06, 0.16), high = some(0.15, 0.4);
        const auto add = [&](double x0, double x1, double y0, double y1, double z0, double z1) {
            parts.push_back({x + x0, x + x1, y + y0, y + y1, top + z0, top + z1});
        };
        const double middle = blow_voxel_m * std::round(high / 2 / blow_voxel_m);
        switch (number / 2 % 5) {
            case 0:
                add(0, wide, 0, deep, 0, high);
                break;
            case 1:  // flat on the table, upright on the floor
                if (table)
                    add(0, 2 * wide, 0, deep, 0, 0.025);
                else
                    add(0, 0.05, 0, deep, 0, high);
                break;
            case 2:
                add(0, wide + 0.05, 0, deep, 0, 0.05);
                add(0, 0.05, 0, deep, 0.05, high);
                break;
            case 3:
                add(0, 0.15, 0, 0.15, 0, 0.025);
                add(0.05, 0.1, 0.05, 0.1, 0.025, high);
                add(0.025, 0.125, 0.025, 0.125, high, high + 0.075);
                break;
            default:
                add(0, wide + 0.1, 0, deep, 0, middle);
                add(0.05, wide + 0.05, 0, deep, middle, high);
        }
    }
};

// Alone in a room with what it stands on, by topple.
struct StruckRoom {
    topple::test::Room room{blow_voxel_m};
    std::int32_t id = 0;

    explicit StruckRoom(const StruckThing& thing) {
        room.floor(-1, 1, -1, 1);
        for (std::size_t f = 1; f < thing.fixed.size(); ++f) {
            const BlowBox& b = thing.fixed[f];
            room.box(b[0], b[1], b[2], b[3], b[4], b[5]);
        }
        const BlowBox& b = thing.parts.front();
        id = room.box(b[0], b[1], b[2], b[3], b[4], b[5], false);
        for (std::size_t p = 1; p < thing.parts.size(); ++p) {
            const BlowBox& part = thing.parts[p];
            room.part(id, part[0], part[1], part[2], part[3], part[4], part[5]);
        }
    }
};

}  // namespace topple::exports::test
