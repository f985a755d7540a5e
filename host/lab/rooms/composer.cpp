// SPDX-License-Identifier: MIT
#include "lab/rooms/composer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace topple::scenes {
namespace {

using std::numbers::pi;

using Contact = std::pair<const Part*, Part>;  // what carries, and a foot on it

// Whether the middle of the mass lies over what the feet touch: in each of 16 directions some
// contact is further out, by 3 mm.
bool balanced(const Blueprint& blueprint, const Pose& pose, const std::vector<Contact>& contacts) {
    std::vector<std::array<double, 2>> touched;
    for (const auto& [below, foot] : contacts) {
        const auto box = foot.bounds();
        constexpr int steps = 10;
        for (int i = 0; i <= steps * steps + 2 * steps; ++i) {
            const double u = static_cast<double>(i % (steps + 1)) / steps,
                         v = static_cast<double>(i / (steps + 1)) / steps;
            const Vec3 p{box[0][0] + u * (box[1][0] - box[0][0]),
                         box[0][1] + v * (box[1][1] - box[0][1]), box[0][2]};
            if (foot.distance(p) < 0.003 && below->distance(p) < 0.003)
                touched.push_back({p[0], p[1]});
        }
    }
    double mass = 0, x = 0, y = 0;
    for (const Part& local : blueprint.parts) {
        const Part part = moved(pose, local);
        const Vec3 c = part.center_of_mass();
        mass += part.volume();
        x += part.volume() * c[0];
        y += part.volume() * c[1];
    }
    for (int k = 0; k < 16; ++k) {
        const double c = std::cos(pi * k / 8), s = std::sin(pi * k / 8);
        const bool held = std::any_of(touched.begin(), touched.end(), [&](const auto& p) {
            return c * (p[0] - x / mass) + s * (p[1] - y / mass) > 0.003;
        });
        if (!held) return false;
    }
    return true;
}

}  // namespace

bool Composer::fits(const Blueprint& blueprint, const Pose& pose) const {
    for (const Part& local : blueprint.parts) {
        const Part part = moved(pose, local);
        const auto box = part.bounds();
        for (const auto& free : free_) {
            if (overlap(box, free, 0)) return false;
        }
        for (std::size_t other = 0; other < boxes_.size(); ++other) {
            if (overlap(box, boxes_[other], -sunk) &&
                gap(part, world_.parts[other], 2e-4) < -sunk) {
                return false;
            }
        }
    }
    return true;
}

bool Composer::stand(const Blueprint& blueprint, const Pose& pose,
                     const std::vector<std::int32_t>& supporters, const std::string& where) {
    std::vector<std::pair<std::int32_t, int>> carried;  // by what, which foot
    std::vector<Contact> contacts;
    for (const int foot : blueprint.feet) {
        const Part part = moved(pose, blueprint.parts[foot]);
        const auto box = part.bounds();
        for (const std::int32_t below : supporters) {
            if (!overlap(boxes_[below], box, 0.002)) continue;
            carried.emplace_back(below, foot);
            contacts.emplace_back(&world_.parts[below], part);
        }
        // Nothing stands on the floor's outer edge.
        for (std::size_t a = 0; a < 2 && where == "floor"; ++a) {
            if (box[0][a] < 0 || box[1][a] > world_.room[a]) return false;
        }
    }
    if (carried.empty() || !fits(blueprint, pose)) return false;
    if (blueprint.leans.empty() && where != "floor" && !balanced(blueprint, pose, contacts))
        return false;
    const std::int32_t first = add(blueprint, pose, where);
    for (const auto& [below, foot] : carried) world_.support.emplace_back(below, first + foot);
    return true;
}

bool Composer::fix(const Blueprint& blueprint, const Pose& pose) {
    if (!fits(blueprint, pose)) return false;
    world_.fixed.emplace_back(0, add(blueprint, pose, "wall"));
    return true;
}

bool Composer::along_wall(const Blueprint& blueprint, bool built_in, int attempts) {
    const auto box = blueprint.bounds();
    for (int attempt = 0; attempt < attempts; ++attempt) {
        const int wall = any_wall();
        const double length = wall_length(wall);
        const bool mirrored = wall == 1 || wall == 2;  // where its x runs against the wall's
        const double low = mirrored ? -box[1][0] : box[0][0],
                     high = mirrored ? -box[0][0] : box[1][0];
        if (high - low > length) continue;
        double along = random_(-low, length - high);
        if (random_.chance(0.15)) along = random_.chance(0.5) ? -low : length - high;
        double turn = 0, off = skirting_ + (random_.chance(0.5) ? 0 : random_(0, 0.04));
        if (!built_in && random_.chance(0.12)) {
            turn = random_(-0.15, 0.15);
            off += std::abs(turn) * (box[1][0] - box[0][0]) / 2 + 0.02;
        } else if (random_.chance(0.5) && !placed_.empty()) {  // flush with a neighbour
            const Placed& next = placed_[random_.index(placed_.size())];
            const auto its = next.blueprint.bounds();
            const double at = wall < 2 ? next.pose.x : next.pose.y;
            const double reach = mirrored ? -its[0][0] : its[1][0];
            along = at + reach - low + (random_.chance(0.5) ? 0.0002 : random_(0, 0.01));
            if (along + high > length) continue;
        }
        if (built_in) off = 0;
        const Pose pose = against_wall(wall, along, off - blueprint.back(), 0, turn);
        if (built_in ? fix(blueprint, pose) : stand(blueprint, pose, {0}, "floor")) return true;
    }
    return false;
}

std::vector<std::size_t> Composer::row(int wall, double from, double to, double loose,
                                       const std::function<Blueprint()>& make) {
    std::vector<std::size_t> found;
    const bool mirrored = wall == 1 || wall == 2;
    const double off = skirting_ + (random_.chance(0.6) ? 0 : random_(0, 0.05));
    for (double at = from; at < to;) {
        const Blueprint one = make();
        const auto box = one.bounds();
        const double wide = box[1][0] - box[0][0];
        if (at + wide > to) break;
        const double low = mirrored ? -box[1][0] : box[0][0];
        if (stand(one, against_wall(wall, at - low, off - one.back(), 0, 0), {0}, "floor")) {
            found.push_back(placed_.size() - 1);
            at += wide + (random_.chance(loose) ? random_(0.003, 0.06) : 0.0002);
        } else {
            at += 0.25;
        }
    }
    return found;
}

bool Composer::on_wall(const Blueprint& blueprint, double height) {
    const auto box = blueprint.bounds();
    for (int attempt = 0; attempt < 25; ++attempt) {
        const int wall = any_wall();
        if (wall_part_[wall] < 0) continue;
        const double half = std::max(box[1][0], -box[0][0]), length = wall_length(wall);
        if (2 * half > length || height + box[1][2] > world_.room[2]) continue;
        const Pose pose =
            against_wall(wall, random_(half, length - half), -blueprint.back(), height, 0);
        // Only where there is wall behind: a nail's hole into it must end in a solid.
        const Vec3 nail =
            moved(pose, Vec3{0, blueprint.back() - 0.02, (box[0][2] + box[1][2]) / 2});
        const bool backed =
            std::any_of(world_.parts.begin(), world_.parts.end(),
                        [&](const Part& p) { return p.object == 0 && p.inside(nail); });
        if (backed && fix(blueprint, pose)) return true;
    }
    return false;
}

bool Composer::anywhere(const Blueprint& blueprint, int attempts) {
    const auto box = blueprint.bounds();
    const double reach = std::max({box[1][0], -box[0][0], box[1][1], -box[0][1]});
    for (int attempt = 0; attempt < attempts; ++attempt) {
        const double r = std::min({reach, world_.room[0] / 2, world_.room[1] / 2});
        const double yaw = random_.chance(0.4) ? random_.integer(0, 3) * pi / 2 : random_(-pi, pi);
        const Pose pose{random_(r, world_.room[0] - r), random_(r, world_.room[1] - r), 0, yaw};
        if (stand(blueprint, pose, {0}, "floor")) return true;
    }
    return false;
}

bool Composer::before(std::size_t table, int side, const Blueprint& chair) {
    const Placed at = placed_[table];
    const auto box = at.blueprint.bounds(), its = chair.bounds();
    for (int attempt = 0; attempt < 25; ++attempt) {
        // The chair's back is at its low y: it faces the table, pushed in from the side.
        const double in = random_(-0.35, 0.75) * (its[1][1] - its[0][1]);
        const double most = random_.chance(0.3) ? 1.4 : 0.4;
        const double turn = random_.chance(0.4) ? 0 : random_(-most, most);
        const bool ends = side >= 2, low = side % 2 == 1;
        const std::size_t a = ends ? 1 : 0;
        const double s = random_(0.75 * box[0][a], 0.75 * box[1][a]);
        const double edge = (low ? -box[0][1 - a] : box[1][1 - a]) + its[1][1] - std::max(0.0, in) +
                            (in < 0 ? -in : 0);
        const double out = low ? -edge : edge;
        const double yaw = ends ? (low ? -pi / 2 : pi / 2) : (low ? 0 : pi);
        Pose pose = moved(at.pose, ends ? Pose{out, s, 0, yaw} : Pose{s, out, 0, yaw});
        pose.z = 0;
        pose.yaw += turn;
        if (stand(chair, pose, {0}, "floor")) return true;
    }
    return false;
}

std::vector<std::int32_t> Composer::deck(std::size_t index, const Surface& surface) const {
    const Placed& base = placed_[index];
    const Part& carrier = world_.parts[base.first_part + surface.part];
    std::vector<std::int32_t> deck;
    for (std::size_t k = 0; k < base.blueprint.parts.size(); ++k) {
        const auto id = base.first_part + static_cast<std::int32_t>(k);
        const Part& part = world_.parts[id];
        if (part.name == carrier.name && std::abs(part.top() - carrier.top()) < 1e-6)
            deck.push_back(id);
    }
    return deck;
}

bool Composer::on_surface(std::size_t index, const Surface& surface,
                          const std::vector<Blueprint>& stack) {
    if (stack.empty()) return false;
    if (stack_height(stack) > surface.clearance) return false;
    const Placed base = placed_[index];
    const std::vector<std::int32_t> supporters = deck(index, surface);
    const double top = world_.parts[base.first_part + surface.part].top();
    for (int attempt = 0; attempt < 12; ++attempt) {
        const double yaw = random_.chance(0.45)  ? 0
                           : random_.chance(0.5) ? random_(-0.25, 0.25)
                                                 : random_(-pi, pi);
        Bounds feet = no_bounds();
        for (const int foot : stack.front().feet)
            extend(feet, moved({0, 0, 0, yaw}, stack.front().parts[foot]).bounds());
        const auto& [low, high] = feet;
        const double room_x = 2 * surface.half_x - (high[0] - low[0]),
                     room_y = 2 * surface.half_y - (high[1] - low[1]);
        if (room_x < 0 || room_y < 0) continue;
        const double u = surface.x - surface.half_x - low[0] + random_.uniform() * room_x;
        double v = surface.y - surface.half_y - low[1] + random_.uniform() * room_y;
        if (random_.chance(0.25)) v = surface.y - surface.half_y - low[1];  // at the back
        Pose pose = moved(base.pose, Pose{u, v, 0, yaw});
        pose.z = top;
        // Side by side with the last thing here.
        if (random_.chance(0.3) && placed_.size() > index + 1 && yaw == 0) {
            const Placed& last = placed_.back();
            const auto its = last.blueprint.bounds(), ours = stack.front().bounds();
            if (std::abs(last.pose.z - top) < 1e-9) {
                const double side = random_.chance(0.5) ? 1 : -1;
                const double off = side > 0 ? its[1][0] - ours[0][0] : its[0][0] - ours[1][0];
                const double slack = random_.chance(0.5) ? 0.0003 : random_(0, 0.006);
                const Vec3 beside = moved(last.pose, Vec3{off + side * slack, 0, 0});
                const Pose back{-base.pose.x, -base.pose.y, 0, 0};
                const Vec3 local = moved(Pose{0, 0, 0, -base.pose.yaw}, moved(back, beside));
                if (std::abs(local[0] - surface.x) + (high[0] - low[0]) / 2 < surface.half_x &&
                    std::abs(local[1] - surface.y) + (high[1] - low[1]) / 2 < surface.half_y)
                    pose = {beside[0], beside[1], top, last.pose.yaw};
            }
        }
        if (!stand(stack.front(), pose, supporters, surface.where)) continue;
        for (std::size_t k = 1; k < stack.size(); ++k) {
            const std::int32_t below = placed_.back().first_part;
            pose.z += stack[k - 1].height();
            const Pose turned{pose.x, pose.y, pose.z, pose.yaw + random_(-0.1, 0.1)};
            if (!stand(stack[k], turned, {below}, surface.where)) break;
        }
        return true;
    }
    return false;
}

void Composer::fill(std::size_t index, double per_m2, const Make& make) {
    const std::vector<Surface> surfaces = placed_[index].blueprint.surfaces;
    for (const Surface& surface : surfaces) {
        if (surface.half_x <= 0 || surface.half_y <= 0) continue;
        const double expected = per_m2 * 4 * surface.half_x * surface.half_y;
        const int count = static_cast<int>(expected * random_(0.3, 1.5) + random_.uniform());
        for (int k = 0; k < std::min(count, 40); ++k)
            on_surface(index, surface, make(random_, surface.clearance));
    }
}

void Composer::fill_all(double per_m2, const Make& make) {
    const std::size_t count = placed_.size();
    for (std::size_t k = 0; k < count; ++k) fill(k, per_m2, make);
}

bool Composer::leaning(const Blueprint& blueprint) {
    if (skirting_ > 0) return false;
    for (int attempt = 0; attempt < 25; ++attempt) {
        const int wall = any_wall();
        const double along = random_(0.2, wall_length(wall) - 0.2);
        const Pose pose = against_wall(wall, along, -blueprint.back(), 0, 0);
        if (wall_part_[wall] < 0) continue;
        if (stand(blueprint, pose, {0}, "wall")) return true;
    }
    return false;
}

}  // namespace topple::scenes
