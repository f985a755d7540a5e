// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "lab/furniture/things.h"
#include "lab/furniture/varied.h"
#include "lab/rooms/furnish.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

Blueprint block(const char* name, const Vec3& size) {
    return lone_box(name, "box", size);
}

// Builds things that just about stand, each from a place on a level carrier on.
class Balancer {
  public:
    Balancer(Composer& room, double scale) : room_(room), random_(room.random()), scale_(scale) {}

    void build_at(const Pose& pose, std::int32_t carrier) {
        using Build = void (Balancer::*)(const Pose&, std::int32_t);
        constexpr std::array<Build, 7> builds{
            &Balancer::cap, &Balancer::lean_on_box, &Balancer::bridge, &Balancer::tower,
            &Balancer::row, &Balancer::dominoes,    &Balancer::tripod};
        (this->*builds[random_.index(builds.size())])(pose, carrier);
    }

    // Over a carrier's edge, the smaller part of it: `edge` is half of the carrier along its y.
    void overhang(const Pose& middle, double edge, std::int32_t carrier) {
        const Vec3 size = any_size(1, 0.8);
        const double out = random_(0.1, 0.42) * size[1];
        const Pose pose = at(middle, random_(-0.3, 0.3) * edge, edge + out - size[1] / 2, 0);
        put(block("box", size), pose, {carrier});
    }

  private:
    double any(double low, double high) { return scale_ * random_(low, high); }
    Vec3 any_size(double flat, double high) {
        return {flat * any(0.14, 0.4), flat * any(0.12, 0.32), high * any(0.08, 0.32)};
    }

    std::int32_t put(const Blueprint& b, const Pose& pose, const std::vector<std::int32_t>& on) {
        if (!room_.stand(b, pose, on, "stack")) return -1;
        return room_.placed().back().first_part;
    }
    static Pose at(const Pose& base, double x, double y, double z, double yaw = 0) {
        return moved(base, {x, y, z, yaw});
    }

    // A wide box on an upright narrow one, off its middle; perhaps another on it.
    void cap(const Pose& base, std::int32_t carrier) {
        const Vec3 low{any(0.08, 0.2), any(0.07, 0.16), any(0.3, 0.75)};
        const std::int32_t foot = put(block("carton", low), base, {carrier});
        if (foot < 0) return;
        const Vec3 size = any_size(1.1, 0.8);
        const double x = random_(-0.4, 0.4) * low[0], y = random_(-0.4, 0.4) * low[1];
        const std::int32_t top = put(block("box", size), at(base, x, y, low[2]), {foot});
        if (top < 0 || !random_.chance(0.5)) return;
        const Vec3 third = any_size(0.7, 0.7);  // over the lowest's middle
        put(block("box", third), at(base, 0.6 * x, 0.6 * y, low[2] + size[2], random_(-0.5, 0.5)),
            {top});
    }

    // A book or board that leans against a box's upper edge.
    void lean_on_box(const Pose& base, std::int32_t carrier) {
        const Vec3 size = any_size(1, 1);
        const std::int32_t box = put(block("box", size), base, {carrier});
        if (box < 0) return;
        const double lean = random_(0.12, 0.6), h = size[2];
        const double length = h / std::cos(lean) * random_(1.04, 1.6);
        Blueprint b(length > 0.35 ? "board" : "book");
        b.foot(b.leaning("board", 0, size[1] / 2 + h * std::tan(lean), 0,
                         {random_(0.4, 0.95) * size[0], any(0.015, 0.04), length}, lean));
        b.leans = b.feet;
        put(b, base, {carrier, box});
    }

    // A board on two equal boxes, further out on one side, and something on it.
    void bridge(const Pose& base, std::int32_t carrier) {
        const Vec3 size{any(0.1, 0.2), any(0.12, 0.25), any(0.1, 0.4)};
        const double apart = size[0] + any(0.1, 0.5);
        const std::int32_t left = put(block("box", size), at(base, -apart / 2, 0, 0), {carrier});
        const std::int32_t right = put(block("box", size), at(base, apart / 2, 0, 0), {carrier});
        if (left < 0 || right < 0) return;
        const double t = any(0.015, 0.04), length = (apart + size[0]) * random_(1, 1.5);
        const double off = random_(-0.3, 0.3) * (length - apart - size[0]);
        const std::int32_t board = put(block("board", {length, any(0.15, 0.25), t}),
                                       at(base, off, 0, size[2]), {left, right});
        if (board < 0) return;
        const Stack stack = make_turned_item(random_, 0.4);
        if (!stack.empty())
            put(stack.front(),
                at(base, random_(-0.3, 0.3) * apart, 0, size[2] + t, random_(-pi, pi)), {board});
    }

    // Boxes with each middle well over the one below: whatever lies on top stays over all of them.
    void tower(const Pose& base, std::int32_t carrier) {
        Vec3 size = any_size(1.2, 0.7);
        double x = 0, y = 0, z = 0, yaw = 0;
        const Vec3 first = size;
        for (int k = random_.integer(3, 6); k > 0 && carrier >= 0; --k) {
            carrier = put(block(random_.chance(0.5) ? "box" : "carton", size),
                          at(base, x, y, z, yaw), {carrier});
            z += size[2];
            size = {size[0] * random_(0.75, 1.08), size[1] * random_(0.75, 1.08), any(0.04, 0.22)};
            const double away = 0.16 * std::min({size[0], size[1], first[0], first[1]});
            x = random_(-away, away);
            y = random_(-away, away);
            yaw = random_.chance(0.4) ? 0 : random_(-0.6, 0.6);
        }
    }

    // Different things side by side, touching.
    void row(const Pose& base, std::int32_t carrier) {
        double x = 0;
        const Vec3 like = any_size(0.8, 1.2);
        for (int k = random_.integer(2, 5); k > 0; --k) {
            const bool equal = random_.chance(0.4);
            const Vec3 size = equal ? like : any_size(0.8, 1.2);
            put(block(equal ? "carton" : "box", size),
                at(base, x + size[0] / 2, random_.chance(0.5) ? 0 : any(-0.05, 0.05), 0),
                {carrier});
            x += size[0] + (random_.chance(0.7) ? 0.0002 : random_(0.001, 0.008));
        }
    }

    // Upright books that stand by themselves.
    void dominoes(const Pose& base, std::int32_t carrier) {
        double x = 0;
        for (int k = random_.integer(2, 5); k > 0; --k) {
            const Vec3 size{any(0.02, 0.06), any(0.12, 0.22), any(0.18, 0.34)};
            put(block("book", size), at(base, x, 0, 0, random_(-0.2, 0.2)), {carrier});
            x += any(0.05, 0.2);
        }
    }

    // One thing carried by two or three of the same height.
    void tripod(const Pose& base, std::int32_t carrier) {
        const double h = any(0.1, 0.25), d = any(0.06, 0.1), r = any(0.12, 0.2);
        std::vector<std::int32_t> on;
        for (int k = 0; k < 3; ++k) {
            Blueprint can("can");
            can.foot(can.cylinder("can", 0, 0, 0, d, h));
            const double a = 2 * pi * k / 3;
            on.push_back(put(can, at(base, r * std::cos(a), r * std::sin(a), 0), {carrier}));
            if (on.back() < 0) return;
        }
        const double side = 2 * r + d;
        const std::int32_t tray =
            put(block("tray", {side, side, any(0.02, 0.15)}), at(base, 0, 0, h), on);
        if (tray >= 0 && random_.chance(0.6)) {
            const double high = room_.placed().back().blueprint.height();
            put(block("box", any_size(0.6, 0.8)), at(base, 0, 0, h + high, random_(-1, 1)), {tray});
        }
    }

    Composer& room_;
    Random& random_;
    double scale_;
};

// Boxes, or what lies about in a kitchen or on a desk.
Stack table_item(Random& random, double clearance) {
    if (random.chance(0.35)) {
        Stack stack;
        const Vec3 size{random(0.06, 0.3), random(0.05, 0.24), random(0.03, 0.26)};
        for (int k = random.chance(0.3) ? random.integer(2, 3) : 1; k > 0; --k)
            stack.push_back(block("box", size));
        return stack;
    }
    return random.chance(0.5) ? make_kitchen_item(random, clearance)
                              : make_desk_item(random, clearance);
}

}  // namespace

void furnish_precarious(Composer& room) {
    Random& random = room.random();
    for (int k = random.integer(1, 3); k > 0; --k) {
        const Blueprint table =
            random.chance(0.7) ? make_work_table(random) : make_drawer_unit(random);
        if (!(random.chance(0.5) ? room.along_wall(table) : room.anywhere(table))) continue;
        const Composer::Placed at = room.placed().back();
        const Surface surface = at.blueprint.surfaces.back();
        const std::int32_t carrier = at.first_part + surface.part;
        const double top = table.height();
        Balancer small(room, random(0.45, 0.8));
        for (int n = random.integer(2, 6); n > 0; --n) {
            const Pose pose{surface.x + random(-0.75, 0.75) * surface.half_x,
                            surface.y + random(-0.6, 0.6) * surface.half_y, top,
                            random.chance(0.5) ? 0 : random(-pi, pi)};
            small.build_at(moved(at.pose, pose), carrier);
        }
        if (random.chance(0.6))
            small.overhang(moved(at.pose, Pose{surface.x, surface.y, top}), surface.half_y + 0.005,
                           carrier);
    }
    Balancer large(room, random(0.9, 1.7));
    const Vec3& size = room.world().room;
    for (int n = random.integer(4, 12); n > 0; --n) {
        const double yaw = random.chance(0.4) ? 0 : random(-pi, pi);
        large.build_at({random(0.4, size[0] - 0.4), random(0.4, size[1] - 0.4), 0, yaw}, 0);
    }
    for (int k = random.integer(0, 2); k > 0; --k) room.leaning(make_leaning_thing(random));
}

void furnish_tabletop(Composer& room) {
    Random& random = room.random();
    const bool at_wall = random.chance(0.4);
    bool stands = false;
    for (int attempt = 0; attempt < 40 && !stands; ++attempt) {
        const Blueprint one =
            random.chance(0.7) ? make_work_table(random) : make_splayed_table(random);
        if (one.height() < 0.5) continue;
        stands = at_wall ? room.along_wall(one) : room.anywhere(one);
    }
    if (!stands) return;
    const std::size_t table = room.last();
    for (int k = random.integer(0, 2); k > 0; --k)
        room.before(table, random.integer(0, 3), make_rail_chair(random));
    const Composer::Placed at = room.placed()[table];
    const Surface surface = at.blueprint.surfaces.back();
    if (random.chance(0.5)) {
        Balancer small(room, random(0.35, 0.7));
        for (int n = random.integer(1, 4); n > 0; --n) {
            const Pose pose{surface.x + random(-0.7, 0.7) * surface.half_x,
                            surface.y + random(-0.6, 0.6) * surface.half_y, at.blueprint.height(),
                            random(-1, 1)};
            small.build_at(moved(at.pose, pose), at.first_part + surface.part);
        }
    }
    room.fill(table, random(6, 26), table_item);
}

}  // namespace topple::scenes
