// SPDX-License-Identifier: MIT
#include "lab/rooms/kinds.h"

#include <array>
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
    std::array<Range, 3> size;  // inner width, depth and height
    Shell shell{};
    double fitted = 1;  // chance of fittings, where the shell has them
};

const std::array families{
    Family{"kitchen", 201, furnish_kitchen, {{{2.2, 5.5}, {2.0, 5.0}, {2.3, 2.8}}}},
    Family{"bathroom",
           202,
           furnish_bathroom,
           {{{1.6, 3.2}, {1.8, 3.6}, {2.2, 2.7}}},
           {.windows = 1, .doors = 1}},
    Family{"bedroom", 203, furnish_bedroom, {{{2.6, 5}, {2.6, 4.6}, {2.3, 2.8}}}},
    Family{"living", 204, furnish_living_room, {{{3.2, 6.5}, {3, 5.5}, {2.3, 3.0}}}},
    Family{"office", 205, furnish_office, {{{2.6, 7}, {2.6, 5.5}, {2.4, 3.0}}}},
    Family{"shop", 207, furnish_shop, {{{4.5, 9}, {4, 8}, {2.5, 3.6}}}},
    Family{"storage", 208, furnish_storage, {{{3, 5}, {2.5, 4.5}, {2.3, 2.9}}}},
    Family{"corridor",
           206,
           furnish_corridor,
           {{{3.5, 9}, {0.95, 1.7}, {2.2, 2.8}}},
           {.missing = 0.1, .doors = 4}},
    Family{"precarious",
           209,
           furnish_precarious,
           {{{2.5, 5}, {2.5, 4.5}, {2.3, 2.8}}},
           {.missing = 0.4}},
    Family{"tabletop",
           210,
           furnish_tabletop,
           {{{2.4, 4}, {2.4, 4}, {2.3, 2.8}}},
           {.missing = 0.6},
           0.4},
    Family{"library", 211, furnish_library, {{{4, 13}, {4, 12}, {2.5, 4.2}}}, {.ceiling = 0.35}},
    Family{"meeting", 212, furnish_meeting, {{{3.5, 10}, {3, 8}, {2.4, 3.6}}}},
    Family{"lounge", 213, furnish_lounge, {{{3.2, 9}, {3, 7}, {2.4, 3.4}}}},
    Family{"laundry", 214, furnish_laundry, {{{2.0, 8}, {1.8, 6}, {2.3, 3.2}}}},
    Family{"depot",
           215,
           furnish_depot,
           {{{6, 14}, {5, 11}, {3, 7}}},
           {.missing = 0.6, .ceiling = 0},
           0.5},
};

// A hall instead of a storage room.
constexpr std::array<Range, 3> hall{{{3, 11}, {2.5, 9}, {3.2, 6}}};
constexpr double hall_ceiling = 0.2;

World make(const Family& family, std::uint64_t seed) {
    Composer room(seed, family.stream);
    Random& random = room.random();
    Shell shell = family.shell;
    std::array<Range, 3> size = family.size;
    if (family.furnish == furnish_storage && random.chance(0.5)) {
        size = hall;
        shell.ceiling = hall_ceiling;
    }
    for (std::size_t a = 0; a < 3; ++a) shell.size[a] = random.uniform(size[a].low, size[a].high);
    if (family.fitted < 1) shell.fittings = random.chance(family.fitted);
    room.build(shell);
    family.furnish(room);
    return std::move(room.world());
}

World furnished(std::uint64_t seed, bool varied) {
    RoomOptions options;
    options.seed = seed;
    options.varied = varied;
    options.clutter = Random(seed, 31).uniform(0.5, 2.5);
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
