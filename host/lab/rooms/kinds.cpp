// SPDX-License-Identifier: MIT
#include "lab/rooms/kinds.h"

#include <utility>

#include "lab/rooms/furnish.h"
#include "lab/rooms/furnished_room.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

using Shell = Composer::Shell;

struct Range {
    double low, high;
};

struct Family {
    const char* name;
    std::uint64_t stream;  // of random numbers
    void (*furnish)(Composer&);
    Range width, depth, height;  // inside, metres
    Shell shell{};
    double fitted = 1;  // chance of fittings, where the shell has them
};

const Family families[] = {
    {"kitchen", 201, furnish_kitchen, {2.2, 5.5}, {2.0, 5.0}, {2.3, 2.8}},
    {"bathroom",
     202,
     furnish_bathroom,
     {1.6, 3.2},
     {1.8, 3.6},
     {2.2, 2.7},
     {.windows = 1, .doors = 1}},
    {"bedroom", 203, furnish_bedroom, {2.6, 5}, {2.6, 4.6}, {2.3, 2.8}},
    {"living", 204, furnish_living_room, {3.2, 6.5}, {3, 5.5}, {2.3, 3.0}},
    {"office", 205, furnish_office, {2.6, 7}, {2.6, 5.5}, {2.4, 3.0}},
    {"shop", 207, furnish_shop, {4.5, 9}, {4, 8}, {2.5, 3.6}},
    {"storage", 208, furnish_storage, {3, 5}, {2.5, 4.5}, {2.3, 2.9}},
    {"corridor",
     206,
     furnish_corridor,
     {3.5, 9},
     {0.95, 1.7},
     {2.2, 2.8},
     {.missing = 0.1, .doors = 4}},
    {"precarious", 209, furnish_precarious, {2.5, 5}, {2.5, 4.5}, {2.3, 2.8}, {.missing = 0.4}},
    {"tabletop", 210, furnish_tabletop, {2.4, 4}, {2.4, 4}, {2.3, 2.8}, {.missing = 0.6}, 0.4},
    {"library", 211, furnish_library, {4, 13}, {4, 12}, {2.5, 4.2}, {.ceiling = 0.35}},
    {"meeting", 212, furnish_meeting, {3.5, 10}, {3, 8}, {2.4, 3.6}},
    {"lounge", 213, furnish_lounge, {3.2, 9}, {3, 7}, {2.4, 3.4}},
    {"laundry", 214, furnish_laundry, {2.0, 8}, {1.8, 6}, {2.3, 3.2}},
    {"depot", 215, furnish_depot, {6, 14}, {5, 11}, {3, 7}, {.missing = 0.6, .ceiling = 0}, 0.5},
};

// Half of the storage rooms are halls instead.
const Family hall{"", 0, nullptr, {3, 11}, {2.5, 9}, {3.2, 6}, {.ceiling = 0.2}};

World make(const Family& family, std::uint64_t seed) {
    Composer room(seed, family.stream);
    Random& random = room.random();
    const Family& like = family.furnish == furnish_storage && random.chance(0.5) ? hall : family;
    Shell shell = like.shell;
    shell.size = {random(like.width.low, like.width.high), random(like.depth.low, like.depth.high),
                  random(like.height.low, like.height.high)};
    if (like.fitted < 1) shell.fittings = random.chance(like.fitted);
    room.build(shell);
    family.furnish(room);
    return std::move(room.world());
}

World furnished(std::uint64_t seed, bool varied) {
    RoomOptions options;
    options.seed = seed;
    options.varied = varied;
    options.clutter = Random(seed, 31)(0.5, 2.5);
    return furnished_room(options);
}

}  // namespace

const std::vector<std::string>& kinds() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> out{"plain", "varied"};
        for (const Family& family : families) out.emplace_back(family.name);
        return out;
    }();
    return names;
}

World make_world(const std::string& kind, std::uint64_t seed) {
    const auto painted = [seed](World world) {
        world.seed = seed;
        paint(world, Random(seed, 32));
        return world;
    };
    if (kind == "plain" || kind == "varied") return painted(furnished(seed, kind == "varied"));
    for (const Family& family : families) {
        if (kind == family.name) return painted(make(family, seed));
    }
    std::string all;
    for (const std::string& name : kinds()) all += (all.empty() ? "" : ", ") + name;
    throw Error(ErrorKind::usage, "--kind " + kind + ": expected one of " + all);
}

}  // namespace topple::scenes
