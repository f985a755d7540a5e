// SPDX-License-Identifier: MIT
#include "lab/scan/room_scan.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/thread_pool.h"
#include "core/vectors.h"

namespace topple::scenes {
namespace {

constexpr double patch_size = 0.025;
constexpr int quarterings = 2;        // of patches that are near another solid
constexpr double clearance = 0.003;   // between points and other solids
constexpr double least_cosine = 0.1;  // flatter rays give no reading (84 degrees)
constexpr double lift = 0.001;        // of a ray's end above the surface
constexpr std::uint32_t ring_columns = 512;

// Grows with the angle from +x, from 0 to 4 for a turn: without a library's arc functions.
double diamond_angle(double x, double y) {
    const double sum = std::abs(x) + std::abs(y);
    if (sum == 0) return 0;
    const double share = y / sum;
    return x < 0 ? 2 - share : share < 0 ? 4 + share : share;
}

// Whether one of the stations is in front of a sheet, where that can be told at once.
bool faces_any(const Sheet& sheet, const std::vector<Vec3>& stations) {
    return sheet.kind != Sheet::Kind::flat ||
           std::any_of(stations.begin(), stations.end(), [&](const Vec3& station) {
               return dot(minus(station, sheet.origin), sheet.axes[2]) > 0;
           });
}

}  // namespace

RoomScan::RoomScan(const World& world, const std::vector<Vec3>& stations, unsigned threads)
    : world_(world), stations_(stations) {
    std::vector<Patch> patches;
    for (std::size_t k = 0; k < world.parts.size(); ++k) {
        const Part& part = world.parts[k];
        headings_.push_back(part.heading());
        boxes_.push_back(part.bounds());
        add_sheets(part, static_cast<std::int32_t>(k), sheets_);
        if (k == 0 || part.object == 0 || part.object != world.parts[k - 1].object) {
            groups_.push_back({boxes_[k], k, k + 1});
            continue;
        }
        Group& group = groups_.back();
        group.last = k + 1;
        extend(group.box, boxes_[k]);
    }
    for (std::size_t k = 0; k < sheets_.size(); ++k) {
        if (faces_any(sheets_[k], stations_))
            add_patches(sheets_[k], static_cast<std::uint32_t>(k), patch_size, patches);
    }

    // Pieces of the patches in their order, whoever works on them.
    constexpr std::size_t piece = 1024;
    std::vector<std::vector<Seen>> found((patches.size() + piece - 1) / piece);
    ThreadPool(threads).each(found.size(), 1, [&](std::size_t n) {
        std::vector<std::size_t> blockers(stations_.size(), 0);
        const std::size_t end = std::min(patches.size(), (n + 1) * piece);
        for (std::size_t k = n * piece; k < end; ++k) look(patches[k], 0, blockers, found[n]);
    });
    for (auto& list : found) {
        seen_.insert(seen_.end(), list.begin(), list.end());
        list = {};
    }
    std::ranges::stable_sort(seen_, {}, [](const Seen& seen) {
        return std::tuple(seen.station, seen.column, seen.slope);
    });
}

std::int32_t RoomScan::object(std::size_t patch) const {
    const Sheet& sheet = sheets_[seen_[patch].patch.sheet];
    return world_.parts[sheet.part].object;
}

// Whether all within `radius` of p keeps its distance from all parts but one, none of it, or some.
RoomScan::Room RoomScan::room_at(const Vec3& p, double radius, std::int32_t part) const {
    const double reach = radius + clearance;
    const auto far = [&](const Bounds& box) {
        for (std::size_t a = 0; a < 3; ++a) {
            if (p[a] < box[0][a] - reach || p[a] > box[1][a] + reach) return true;
        }
        return false;
    };
    Room room = Room::clear;
    for (const Group& group : groups_) {
        if (far(group.box)) continue;
        for (std::size_t k = group.first; k < group.last; ++k) {
            if (static_cast<std::int32_t>(k) == part || far(boxes_[k])) continue;
            const double distance = world_.parts[k].distance(p, headings_[k]);
            if (distance < clearance - radius) return Room::none;
            if (distance < reach) room = Room::near;
        }
    }
    return room;
}

// `last`: what blocked the view the last time, tried first.
bool RoomScan::blocked(const Vec3& from, const Vec3& to, std::size_t& last) const {
    const Vec3 way = minus(to, from);
    const double distance = length(way);
    const Vec3 d{way[0] / distance, way[1] / distance, way[2] / distance};
    const Vec3 inverse{1 / d[0], 1 / d[1], 1 / d[2]};
    const auto meets = [&](const Bounds& box) {
        double in = 0, out = distance;
        for (std::size_t a = 0; a < 3; ++a) {
            if (d[a] == 0) {
                if (from[a] < box[0][a] || from[a] > box[1][a]) return false;
                continue;
            }
            const double t0 = (box[0][a] - from[a]) * inverse[a],
                         t1 = (box[1][a] - from[a]) * inverse[a];
            in = std::max(in, std::min(t0, t1));
            out = std::min(out, std::max(t0, t1));
        }
        return in <= out;
    };
    const auto stops = [&](std::size_t k) {
        return meets(boxes_[k]) && world_.parts[k].hit(from, d, headings_[k]) < distance;
    };
    if (stops(last)) return true;
    for (const Group& group : groups_) {
        if (!meets(group.box)) continue;
        for (std::size_t k = group.first; k < group.last; ++k) {
            if (!stops(k)) continue;
            last = k;
            return true;
        }
    }
    return false;
}

bool RoomScan::find_station(const Sheet::Place& place, std::vector<std::size_t>& last,
                            Seen& seen) const {
    const Vec3& p = place.point;
    const Vec3 above = along(p, lift, place.normal);
    for (std::size_t n = 0; n < stations_.size(); ++n) {
        const Vec3 way = minus(stations_[n], p);
        if (dot(way, place.normal) < least_cosine * length(way)) continue;
        if (blocked(stations_[n], above, last[n])) continue;
        seen.station = static_cast<std::uint8_t>(n);
        seen.column =
            static_cast<std::uint32_t>(diamond_angle(-way[0], -way[1]) * (ring_columns / 4));
        seen.slope = -way[2] / std::max(1e-6, std::sqrt(way[0] * way[0] + way[1] * way[1]));
        return true;
    }
    return false;
}

void RoomScan::look(const Patch& patch, int depth, std::vector<std::size_t>& last,
                    std::vector<Seen>& seen) const {
    const Sheet& sheet = sheets_[patch.sheet];
    Seen one;
    one.patch = patch;
    one.area = patch.area(sheet);
    if (!(one.area > 0)) return;
    const Sheet::Place middle = patch.middle(sheet);
    double radius = 0;
    for (const double u : patch.u) {
        for (const double v : patch.v)
            radius = std::max(radius, length(minus(sheet.at(u, v).point, middle.point)));
    }
    switch (room_at(middle.point, radius, sheet.part)) {
        case Room::none:
            return;
        case Room::near:
            if (depth < quarterings) {
                for (const Patch& quarter : patch.quarters()) look(quarter, depth + 1, last, seen);
                return;
            }
            if (room_at(middle.point, 0, sheet.part) != Room::clear) return;
            one.near = true;
            break;
        case Room::clear:
            break;
    }
    if (find_station(middle, last, one)) seen.push_back(one);
}

void RoomScan::sample(std::size_t patch, double noise_m, Random random,
                      std::span<Vec3> points) const {
    const Seen& seen = seen_[patch];
    const Sheet& sheet = sheets_[seen.patch.sheet];
    const Vec3& station = stations_[seen.station];
    // The additive recurrence of the plastic number: even for any count (Roberts 2018).
    double u = random.uniform(), v = random.uniform();
    for (Vec3& point : points) {
        u += 0.7548776662466927;
        v += 0.5698402909980532;
        u -= std::floor(u);
        v -= std::floor(v);
        point = seen.patch.spread(sheet, u, v).point;
        for (int attempt = 0; seen.near && room_at(point, 0, sheet.part) != Room::clear;
             ++attempt) {
            // The middle was found to be clear.
            point = attempt < 8 ? seen.patch.spread(sheet, random.uniform(), random.uniform()).point
                                : seen.patch.middle(sheet).point;
            if (attempt == 8) break;
        }
        const Vec3 way = minus(point, station);
        const double share = noise_m * random.normal() / length(way);
        for (std::size_t k = 0; k < 3; ++k) point[k] += share * way[k];
    }
}

}  // namespace topple::scenes
