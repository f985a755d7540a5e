// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "lab/random.h"
#include "lab/solids/scene.h"

// Objects before they stand anywhere: in their own frame, resting on z = 0, front towards +y. Parts
// touch where they are joined and never overlap, so that volumes add up.
namespace topple::scenes {

// A level rectangle that other objects may stand on.
struct Surface {
    int part = -1;
    double x = 0, y = 0, half_x = 0, half_y = 0;
    double clearance = 0;  // free height above
    std::string where;
};

// The signs of x and y at the corners of a rectangle about the middle.
inline constexpr std::array<std::array<double, 2>, 4> corners{{{-1, -1}, {-1, 1}, {1, -1}, {1, 1}}};

struct Blueprint {
    explicit Blueprint(std::string object_name) : name(std::move(object_name)) {}

    std::string name;
    std::vector<Part> parts;
    std::vector<std::pair<int, int>> joints;  // fixed to one another
    std::vector<int> feet;                    // what rests on the supporter
    std::vector<int> wall_parts;              // what is fixed to the wall behind (at y = back())
    std::vector<int> leans;                   // what touches that wall without being fixed
    bool underfoot = false;                   // may lie where people walk
    bool pile = false;                        // see TrueObject
    std::vector<Surface> surfaces;

    int add(Part part);  // returns its index, as all that follow
    // Each adds a part whose lowest point is at `bottom`.
    int box(const char* part, double x, double y, double bottom, const Vec3& size, double yaw = 0);
    int cylinder(const char* part, double x, double y, double bottom, double diameter,
                 double height);
    int lying(const char* part, double x, double y, double bottom, double length, double diameter,
              double yaw = 0);
    int sphere(const char* part, double x, double y, double bottom, double diameter);
    int cone(const char* part, double x, double y, double bottom, double diameter, double height,
             double top_ratio);
    int rounded(const char* part, double x, double y, double bottom, const Vec3& size,
                double rounding);
    // The profile's heights are above `bottom`.
    int revolved(const char* part, double x, double y, double bottom, solids::Profile profile);
    // A box with its top towards -y (before the yaw); (x, y) is the middle of its lowest edge.
    int leaning(const char* part, double x, double y, double bottom, const Vec3& size, double lean,
                double yaw = 0);
    // A rounded slab that leans, as a chair's back does: by its middle.
    int cushion(const char* part, const Vec3& middle, const Vec3& size, double lean,
                double rounding);
    // A round bar whose axis runs between two points.
    int bar(const char* part, const Vec3& from, const Vec3& to, double diameter);
    // A round leg that reaches from z = `bottom` to `top`, its upper end's middle at (x, y), its
    // foot further on by `heading` (0: towards +x), `lean` from the vertical.
    int leg(const char* part, double x, double y, double bottom, double top, double diameter,
            double lean, double heading);
    // Four upright ones to stand on, at (x, y) and its like about the middle, square or round;
    // fixed to the part `under`, unless that is -1.
    void legs(const char* part, double x, double y, double thickness, double height,
              bool round = false, int under = -1);
    // Round rungs from one leaning box to another beside it, evenly up their length.
    void rungs(int left, int right, int count, double diameter);
    // A lamp's arm: from a ball that stands at `from` on part `base`, bars with a ball after each,
    // and a shade that hangs from the last. Bars lean towards +y.
    struct Segment {
        double length, lean;
    };
    void arm(int base, const Vec3& from, const std::vector<Segment>& segments, double thickness,
             double shade);
    // Fixes the second to the first, and returns it.
    int join(int a, int b) {
        joints.emplace_back(a, b);
        return b;
    }
    // Lets a part rest on what carries the thing, and returns it.
    int foot(int part) {
        feet.push_back(part);
        return part;
    }
    // The whole top of a part, less a rim.
    void stand_on(int part, double clearance, const char* where, double rim = 0.01);

    Bounds bounds() const;
    double height() const { return bounds()[1][2]; }
    double back() const { return bounds()[0][1]; }
};

// Things of one part, on which they stand.
Blueprint lone_box(const char* name, const char* part, const Vec3& size);
Blueprint lone_rounded(const char* name, const char* part, const Vec3& size, double rounding);
Blueprint lone_revolved(const char* name, const char* part, solids::Profile profile);

using Stack = std::vector<Blueprint>;  // things on one another, lowest first

inline double stack_height(const Stack& stack) {
    double high = 0;
    for (const Blueprint& b : stack) high += b.height();
    return high;
}

// What one of these makes, each as likely.
using BlueprintMake = Blueprint (*)(Random&);
inline Blueprint one_of(Random& random, std::initializer_list<BlueprintMake> makes) {
    return makes.begin()[random.index(makes.size())](random);
}

// Furniture.
Blueprint make_table(Random& random);
Blueprint make_pedestal_table(Random& random);
Blueprint make_desk(Random& random);
Blueprint make_chair(Random& random);
Blueprint make_stool(Random& random);
Blueprint make_bench(Random& random);
Blueprint make_shelf(Random& random);
Blueprint make_dresser(Random& random);
Blueprint make_sofa(Random& random);
Blueprint make_bed(Random& random);
Blueprint make_wall_cabinet(Random& random);
Blueprint make_wall_shelf(Random& random);
Blueprint make_floor_lamp(Random& random);
Blueprint make_plant(Random& random);
Blueprint make_bin(Random& random);
Blueprint make_crate(Random& random);
Blueprint make_roll(Random& random);
Blueprint make_marker(Random& random);

// Things that stand on other things, at most `height` high and with a footprint radius of at most
// `radius`.
Stack make_item(Random& random, double height, double radius);

}  // namespace topple::scenes
