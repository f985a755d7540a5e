// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "lab/furniture/blueprint.h"
#include "lab/solids/pose.h"

// Things unlike those of the plain rooms: turned, hollow, rounded, leaning and splayed ones, and
// groups that stand askew. The frame and rules are those of Blueprint.
namespace topple::scenes {

// Seats.
Blueprint make_splayed_stool(Random& random);  // three or four legs
Blueprint make_splayed_chair(Random& random);
Blueprint make_swivel_chair(Random& random);
Blueprint make_rounded_sofa(Random& random);
Blueprint make_bolster_armchair(Random& random);
Blueprint make_pouf(Random& random);

// Tables, beds and what holds things.
Blueprint make_splayed_table(Random& random);
Blueprint make_drum_table(Random& random);
Blueprint make_made_bed(Random& random);
Blueprint make_loft_bed(Random& random);
Blueprint make_wardrobe(Random& random);
Blueprint make_cube_shelf(Random& random);

// Levels to stand on.
Blueprint make_podium(Random& random);
Blueprint make_stairs(Random& random);

// On the floor.
Blueprint make_topiary(Random& random);
Blueprint make_leafy_plant(Random& random, double scale);
Blueprint make_arc_lamp(Random& random);
Blueprint make_coat_stand(Random& random);
Blueprint make_barrel(Random& random);
Blueprint make_open_bin(Random& random);
Blueprint make_bag(Random& random);
Blueprint make_dumbbell(Random& random);
Blueprint make_rug(Random& random);

// Against a wall: what is in `leans` touches it, the feet stand on the floor.
Blueprint make_leaning_thing(Random& random);  // board, picture, pole or ladder
// On a wall, its back in the wall's plane, and how high its origin goes.
struct WallThing {
    Blueprint blueprint;
    double lowest, highest;
};
WallThing make_wall_thing(Random& random);
// From the ceiling: its wall part's top is at z = 0.
Blueprint make_hanging_lamp(Random& random);

// Several things that stand on a surface, or on one another: the frame of the poses has its origin
// on the surface.
struct Member {
    Blueprint blueprint;
    Pose pose;
    int on = -1;  // which member carries it with its first part; -1: the surface
};
using Group = std::vector<Member>;

double height(const Group& group);
// How far what stands on the surface goes from the group's origin along x and y, turned by yaw.
std::array<double, 2> reach(const Group& group, double yaw);

// A single thing or a group that is at most `height` high and within `radius` of its origin; empty
// where chance offers none.
Group make_varied_item(Random& random, double height, double radius);
Group make_pillow(Random& random);
// Boxes askew on one another, each with its center over the one below, the whole pile balanced.
Group make_pile(Random& random, const Vec3& lowest_size, int count);

}  // namespace topple::scenes
