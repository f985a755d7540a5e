// SPDX-License-Identifier: MIT
#include "lab/rooms/kinds.h"

#include <functional>
#include <utility>

#include "lab/rooms/furnished_room.h"
#include "lab/rooms/paint.h"
#include "lab/rooms/plans.h"
#include "topple/error.h"

namespace topple::scenes {
namespace {

World furnished(std::uint64_t seed, bool varied) {
    RoomOptions options;
    options.seed = seed;
    options.varied = varied;
    options.clutter = Random(seed, 31).uniform(0.5, 2.5);
    return furnished_room(options);
}

using Make = World (*)(std::uint64_t);
const std::vector<std::pair<std::string, Make>>& families() {
    static const std::vector<std::pair<std::string, Make>> list{
        {"plain", [](std::uint64_t seed) { return furnished(seed, false); }},
        {"varied", [](std::uint64_t seed) { return furnished(seed, true); }},
        {"kitchen", make_kitchen},
        {"bathroom", make_bathroom},
        {"bedroom", make_bedroom},
        {"living", make_living_room},
        {"office", make_office},
        {"shop", make_shop},
        {"storage", make_storage},
        {"corridor", make_corridor},
        {"precarious", make_precarious},
        {"tabletop", make_tabletop},
        {"library", make_library},
        {"meeting", make_meeting},
        {"lounge", make_lounge},
        {"laundry", make_laundry},
        {"depot", make_depot},
    };
    return list;
}

}  // namespace

const std::vector<std::string>& kinds() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> out;
        for (const auto& family : families()) out.push_back(family.first);
        return out;
    }();
    return names;
}

World make_world(const std::string& kind, std::uint64_t seed) {
    for (const auto& [name, make] : families()) {
        if (name != kind) continue;
        World world = make(seed);
        world.seed = seed;
        paint(world, Random(seed, 32));
        return world;
    }
    std::string all;
    for (const std::string& name : kinds()) all += (all.empty() ? "" : ", ") + name;
    throw Error(ErrorKind::usage, "--kind " + kind + ": expected one of " + all);
}

}  // namespace topple::scenes
