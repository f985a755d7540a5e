// SPDX-License-Identifier: MIT
#include "lab/rooms/building.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/short_number.h"
#include "lab/random.h"
#include "lab/rooms/furnished_room.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

// What the scanner sees of a room, on average over 40 rooms of each kind.
constexpr double seen_m2 = 110;
constexpr std::size_t most_rooms = 100'000, rooms_of_a_storey = 40;
constexpr double slab_m = 0.12, scanner_height = 1.5;
constexpr double beside_door = 0.05, before_door = 0.6, way_width = 0.7;
constexpr double half_wall = Building::wall_m / 2;

// Numbers of random streams; rooms have their ids.
enum Stream : std::uint64_t {
    columns_stream = 1ULL << 40,
    rows_stream = 2ULL << 40,
    heights_stream = 3ULL << 40,
    doors_stream = 4ULL << 40
};

// The axis along a wall, and whether it is the one at the high end of the other.
std::size_t axis_of(std::size_t wall) {
    return wall <= 2 ? 0 : 1;
}
bool is_high(std::size_t wall) {
    return wall % 2 == 0;
}

// A box from `from` to `to` along a wall and from `in` inside the room to `out` beyond its face.
std::array<Vec3, 2> at_wall(std::size_t wall, const Vec3& size, std::array<double, 2> from_to,
                            double in, double out, std::array<double, 2> up) {
    const std::size_t a = axis_of(wall), across = 1 - a;
    std::array<Vec3, 2> box{};
    box[0][a] = from_to[0];
    box[1][a] = from_to[1];
    box[0][across] = is_high(wall) ? size[across] - in : -out;
    box[1][across] = is_high(wall) ? size[across] + out : in;
    box[0][2] = up[0];
    box[1][2] = up[1];
    return box;
}

Part box_part(const char* name, const std::array<Vec3, 2>& box) {
    Part part{Shape::box, {}, {}, 0, 0, 0, name};
    for (std::size_t k = 0; k < 3; ++k) {
        part.center[k] = (box[0][k] + box[1][k]) / 2;
        part.size[k] = box[1][k] - box[0][k];
    }
    return part;
}

// Where people go from a door to the room's middle: wide before the door, then narrower.
void add_way(const Building::Door& door, const Vec3& size,
             std::vector<std::array<Vec3, 2>>& keep_free) {
    const std::size_t a = axis_of(door.wall);
    const double low = door.opening[0][a], high = door.opening[1][a], middle = (low + high) / 2;
    const std::array<double, 2> up{0, Building::door_height_m + beside_door};
    keep_free.push_back(at_wall(door.wall, size, {low - beside_door, high + beside_door},
                                before_door, half_wall, up));
    keep_free.push_back(at_wall(door.wall, size, {middle - way_width / 2, middle + way_width / 2},
                                size[1 - a] / 2, 0, up));
}

// Floor, ceiling and walls with their doors, each up to the middle of what lies between two rooms.
std::vector<Part> shell(const Vec3& size, const std::vector<Building::Door>& doors) {
    const auto [w, d, h] = size;
    const double e = half_wall;
    std::vector<Part> parts{
        box_part("floor", {Vec3{-e, -e, -slab_m}, Vec3{w + e, d + e, 0}}),
        box_part("ceiling", {Vec3{-e, -e, h}, Vec3{w + e, d + e, Building::storey_m - slab_m}})};
    for (std::size_t wall = 1; wall <= 4; ++wall) {
        // Two of the walls hold the corners.
        const double corner = wall <= 2 ? e : 0, end = size[axis_of(wall)] + corner;
        double from = -corner;
        for (const Building::Door& door : doors) {
            if (door.wall != wall) continue;
            const double low = door.opening[0][axis_of(wall)],
                         high = door.opening[1][axis_of(wall)];
            parts.push_back(box_part("wall", at_wall(wall, size, {from, low}, 0, e, {0, h})));
            parts.push_back(box_part(
                "lintel", at_wall(wall, size, {low, high}, 0, e, {Building::door_height_m, h})));
            from = high;
        }
        parts.push_back(box_part("wall", at_wall(wall, size, {from, end}, 0, e, {0, h})));
    }
    return parts;
}

// The furnished room with this shell instead of its own floor, walls and ceiling. What is fixed to
// any wall is then fixed to the first piece of a wall.
World with_shell(World room, std::vector<Part> shell) {
    std::vector<std::int32_t> place(room.parts.size(), 0);
    std::vector<Part> parts = std::move(shell);
    for (std::size_t k = 5; k < room.parts.size(); ++k) {
        if (room.parts[k].object == 0 && room.parts[k].name == "ceiling") {
            place[k] = 1;
            continue;
        }
        place[k] = static_cast<std::int32_t>(parts.size());
        parts.push_back(std::move(room.parts[k]));
    }
    for (std::size_t wall = 1; wall <= 4; ++wall) place[wall] = 2;
    for (auto* pairs : {&room.fixed, &room.support}) {
        for (auto& [a, b] : *pairs) {
            a = place[a];
            b = place[b];
        }
    }
    room.parts = std::move(parts);
    room.objects[0] = {"building", "building"};
    return room;
}

// The middle of the room, the corners of its free middle, and inside of each door.
std::vector<Vec3> stations(const World& world, const std::vector<Building::Door>& doors) {
    const double x = world.room[0] / 2, y = world.room[1] / 2;
    std::vector<Vec3> all{{x, y, scanner_height}};
    const auto middle = free_middle(world);
    for (const double side : {-0.9, 0.9}) {
        for (const double end : {-0.9, 0.9})
            all.push_back({x + side * middle[0], y + end * middle[1], scanner_height});
    }
    for (const Building::Door& door : doors) {
        const std::size_t a = axis_of(door.wall), across = 1 - a;
        Vec3 station{0, 0, scanner_height};
        station[a] = (door.opening[0][a] + door.opening[1][a]) / 2;
        station[across] =
            is_high(door.wall) ? world.room[across] - before_door / 2 : before_door / 2;
        all.push_back(station);
    }
    return all;
}

void check(const BuildingOptions& o) {
    if (o.points < 1 || o.points > 1'000'000'000'000) {
        throw Error(ErrorKind::usage,
                    "--points " + std::to_string(o.points) + ": expected 1 to 10^12");
    }
    if (!(o.spacing_m >= 0.0005 && o.spacing_m <= 0.5)) {
        throw Error(ErrorKind::usage,
                    "--spacing " + short_number(o.spacing_m) + ": expected 0.0005 to 0.5 metres");
    }
}

}  // namespace

Building::Building(const BuildingOptions& options) : options_(options) {
    check(options);
    const double area = static_cast<double>(options.points) * options.spacing_m * options.spacing_m;
    const double rooms = std::max(1.0, std::round(area / seen_m2));
    if (rooms > static_cast<double>(most_rooms)) {
        throw Error(ErrorKind::usage,
                    "--points " + std::to_string(options.points) + " at --spacing " +
                        short_number(options.spacing_m) + " take " +
                        std::to_string(static_cast<std::uint64_t>(rooms)) + " rooms, more than " +
                        std::to_string(most_rooms) + "; choose fewer points or a smaller spacing");
    }
    rooms_ = static_cast<std::size_t>(rooms);
    if (options.storeys > rooms_) {
        throw Error(ErrorKind::usage, "--storeys " + std::to_string(options.storeys) +
                                          ": these points at this spacing "
                                          "fill " +
                                          std::to_string(rooms_) +
                                          " rooms; choose at most as many storeys");
    }
    const std::size_t asked = options.storeys != 0
                                  ? static_cast<std::size_t>(options.storeys)
                                  : (rooms_ + rooms_of_a_storey - 1) / rooms_of_a_storey;
    per_storey_ = (rooms_ + asked - 1) / asked;
    storeys_ = (rooms_ + per_storey_ - 1) / per_storey_;
    const auto columns =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(per_storey_))));
    const std::size_t rows = (per_storey_ + columns - 1) / columns;
    Random width(options.seed, columns_stream), depth(options.seed, rows_stream);
    for (std::size_t k = 0; k < columns; ++k) widths_.push_back(width(3.9, 6.2));
    for (std::size_t k = 0; k < rows; ++k) depths_.push_back(depth(3.5, 5.2));
}

Building::Cell Building::cell(std::size_t id) const {
    const std::size_t within = id % per_storey_;
    return {id / per_storey_, within / widths_.size(), within % widths_.size()};
}

bool Building::has(const Cell& c, std::size_t& id) const {
    const std::size_t within = c.row * widths_.size() + c.column;
    if (c.column >= widths_.size() || c.row >= depths_.size() || within >= per_storey_)
        return false;
    id = c.storey * per_storey_ + within;
    return id < rooms_;
}

// A door belongs to the room with the lower id: it stands at the same place for both.
std::vector<Building::Door> Building::doors(std::size_t id, const Vec3& size) const {
    const Cell at = cell(id);
    std::vector<Door> all;
    for (std::size_t wall = 1; wall <= 4; ++wall) {
        Cell beyond = at;
        // Below row or column 0 the number wraps around, and no such cell is there.
        (axis_of(wall) == 0 ? beyond.row : beyond.column) += is_high(wall) ? 1 : std::size_t(-1);
        Door door;
        if (!has(beyond, door.to)) continue;
        door.wall = wall;
        Random random(options_.seed, doors_stream + 2 * std::min(id, door.to) + axis_of(wall));
        const double middle = size[axis_of(wall)] * random(0.36, 0.64);
        door.opening = at_wall(wall, size, {middle - door_width_m / 2, middle + door_width_m / 2},
                               0, half_wall, {0, door_height_m});
        all.push_back(door);
    }
    return all;
}

Building::Room Building::room(std::size_t id) const {
    Room room;
    room.id = id;
    const Cell at = cell(id);
    room.storey = at.storey;
    for (std::size_t k = 0; k < at.column; ++k) room.origin[0] += widths_[k] + wall_m;
    for (std::size_t k = 0; k < at.row; ++k) room.origin[1] += depths_[k] + wall_m;
    room.origin[2] = static_cast<double>(at.storey) * storey_m;
    Random height(options_.seed, heights_stream + at.storey);
    const Vec3 size{widths_[at.column], depths_[at.row], height(2.6, 2.8)};
    room.doors = doors(id, size);
    RoomOptions furnished{.seed = Random(options_.seed, id).bits(), .varied = options_.varied};
    furnished.size = size;
    for (const Door& door : room.doors) add_way(door, size, furnished.keep_free);
    room.world = with_shell(furnished_room(furnished), shell(size, room.doors));
    room.stations = stations(room.world, room.doors);
    return room;
}

}  // namespace topple::scenes
