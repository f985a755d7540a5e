// SPDX-License-Identifier: MIT
#include <numbers>

#include "lab/furniture/varied.h"

namespace topple::scenes {
namespace {

Blueprint picture(Random& random) {
    Blueprint b("picture");
    const double w = random(0.35, 1.0);
    b.wall_parts = {b.box("picture", 0, 0, 0, {w, random(0.02, 0.045), w * random(0.6, 1.2)})};
    return b;
}

// A disc whose axis points into the room: a clock or a mirror.
Blueprint disc(Random& random) {
    Blueprint b("wall disc");
    const double d = random(0.28, 0.6), t = random(0.03, 0.05);
    b.wall_parts = {b.bar("disc", {0, 0, d / 2}, {0, t, d / 2}, d)};
    return b;
}

// A panel on two brackets, clear of the wall.
Blueprint radiator(Random& random) {
    Blueprint b("radiator");
    const double w = random(0.6, 1.3), h = random(0.45, 0.6), t = random(0.05, 0.1), off = 0.05;
    const int panel = b.box("panel", 0, off + t / 2, 0, {w, t, h});
    for (const double side : {-1.0, 1.0}) {
        const int bracket =
            b.join(panel, b.box("bracket", side * 0.35 * w, off / 2, 0.08, {0.06, off, h - 0.16}));
        b.wall_parts.push_back(bracket);
    }
    return b;
}

Blueprint television(Random& random) {
    Blueprint b("television");
    const double w = random(0.8, 1.3), h = 0.57 * w, off = 0.06;
    const int bracket = b.box("bracket", 0, off / 2, 0.3 * h, {0.3 * w, off, 0.4 * h});
    b.join(bracket, b.box("panel", 0, off + 0.02, 0, {w, 0.04, h}));
    b.wall_parts = {bracket};
    return b;
}

// A board with pegs that point into the room.
Blueprint coat_rack(Random& random) {
    Blueprint b("coat rack");
    const double w = random(0.5, 1.0), t = 0.03;
    const int board = b.box("board", 0, t / 2, 0, {w, t, 0.12});
    b.wall_parts = {board};
    const int pegs = random.integer(3, 5);
    for (int k = 0; k < pegs; ++k) {
        const double x = w * ((k + 0.5) / pegs - 0.5);
        b.join(board, b.bar("peg", {x, t, 0.06}, {x, t + 0.09, 0.06}, 0.028));
    }
    return b;
}

// A board on two uprights that are fixed to the wall, too.
Blueprint bracket_shelf(Random& random) {
    Blueprint b("bracket shelf");
    const double w = random(0.6, 1.1), d = random(0.2, 0.28), t = 0.03, low = 0.18;
    const int board = b.box("board", 0, d / 2, low, {w, d, t});
    b.wall_parts = {board};
    for (const double side : {-1.0, 1.0}) {
        const int bracket =
            b.join(board, b.box("bracket", side * 0.35 * w, 0.6 * d / 2, 0, {0.03, 0.6 * d, low}));
        b.wall_parts.push_back(bracket);
    }
    b.stand_on(board, 0.35, "wall-shelf");
    return b;
}

Blueprint wall_lamp(Random& random) {
    Blueprint b("wall lamp");
    const double ball = random(0.16, 0.24), arm = random(0.06, 0.12), t = 0.03;
    const double z = ball / 2;
    const int plate = b.box("plate", 0, t / 2, z - 0.08, {0.1, t, 0.16});
    const int bar = b.join(plate, b.bar("arm", {0, t, z}, {0, t + arm, z}, 0.03));
    b.join(bar, b.sphere("shade", 0, t + arm + ball / 2, 0, ball));
    b.wall_parts = {plate};
    return b;
}

}  // namespace

WallThing make_wall_thing(Random& random) {
    struct Habit {
        BlueprintMake make;
        double lowest, highest;
    };
    constexpr std::array<Habit, 8> habits{{{disc, 1.2, 1.7},
                                           {radiator, 0.1, 0.2},
                                           {television, 0.9, 1.2},
                                           {coat_rack, 1.4, 1.7},
                                           {bracket_shelf, 0.9, 1.4},
                                           {wall_lamp, 1.3, 1.7},
                                           {picture, 0.9, 1.5},
                                           {picture, 0.9, 1.5}}};
    const Habit& habit = habits[random.index(habits.size())];
    return {habit.make(random), habit.lowest, habit.highest};
}

Blueprint make_hanging_lamp(Random& random) {
    Blueprint b("hanging lamp");
    const double rod = random(0.2, 0.4), shade = random(0.18, 0.28);
    const int stem = b.cylinder("rod", 0, 0, -rod, 0.025, rod);
    b.join(stem, b.cone("shade", 0, 0, -rod - shade, random(0.3, 0.45), shade, random(0.2, 0.7)));
    b.wall_parts = {stem};
    return b;
}

}  // namespace topple::scenes
