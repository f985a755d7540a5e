// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "host/io/files.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "simulation/simulation.h"
#include "topple/parse.h"

// Whether what a parse says to stand stays where it was found, in a simulator.
namespace topple::test {
namespace {

Scene parsed_room(const std::filesystem::path& folder, std::uint64_t seed, bool varied) {
    scenes::RoomOptions room;
    room.seed = seed;
    room.varied = varied;
    scenes::CameraOptions camera;
    camera.seed = seed;
    camera.frames = 20;
    const scenes::World world = scenes::furnished_room(room);
    scenes::write_sequence(folder, world, scenes::walk(world, camera));
    ParseOptions options;
    options.device = device::open_device("native");
    options.disturbances.clear();
    return parse(folder, options).scene;
}

// The solid voxels of a scene, by primitive, in the frame in which z is up.
struct Solids {
    std::map<std::int32_t, std::vector<simulation::Cell>> of_primitive;  // -1: of none
};
Solids solids_of(const Scene& scene) {
    Solids solids;
    const Mat4& m = scene.manhattan_from_input;
    for (std::size_t n = 0; n < scene.solid.x.size(); ++n) {
        const Vec3 p{scene.solid.x[n], scene.solid.y[n], scene.solid.z[n]};
        simulation::Cell cell{};
        for (std::size_t r = 0; r < 3; ++r) {
            const double x =
                m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
            cell[r] = static_cast<std::int32_t>(std::floor(x / scene.voxel_size_m));
        }
        solids.of_primitive[scene.solid.primitive[n]].push_back(cell);
    }
    return solids;
}

double moved(simulation::Simulation simulation, double far_m) {
    simulation.run(2, far_m);
    const Vec3 by = simulation.moved_m();
    return std::sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
}

// The object as found, all others fixed; or without what of these lies below its middle.
simulation::Simulation let_go(const Scene& scene, const Solids& solids, const Object& object,
                              bool supported) {
    simulation::LooseBody body{scene.voxel_size_m, scene.density_kg_m3, {}};
    simulation::Cell low{}, high{};
    bool any = false;
    std::vector<simulation::Cell> fixed;
    for (const auto& [primitive, cells] : solids.of_primitive) {
        if (primitive < 0 || scene.primitives[primitive].object != object.id) continue;
        body.parts.push_back(cells);
        for (const simulation::Cell& c : cells) {
            for (std::size_t a = 0; a < 3; ++a) {
                low[a] = any ? std::min(low[a], c[a]) : c[a];
                high[a] = any ? std::max(high[a], c[a]) : c[a];
            }
            any = true;
        }
    }
    // Far enough around for whatever stays.
    const auto reach = static_cast<std::int32_t>(std::ceil(0.1 / scene.voxel_size_m));
    for (const auto& [primitive, cells] : solids.of_primitive) {
        if (primitive >= 0 && scene.primitives[primitive].object == object.id) continue;
        for (const simulation::Cell& c : cells) {
            bool near = true;
            for (std::size_t a = 0; a < 3; ++a)
                near = near && c[a] >= low[a] - reach && c[a] <= high[a] + reach;
            if (near) fixed.push_back(c);
        }
    }
    body = simulation::without_rough_underside(std::move(body), fixed);
    if (!supported)
        std::erase_if(fixed, [&](const auto& c) { return 2 * c[2] < low[2] + high[2]; });
    return {body, fixed, scene.friction};
}

class SlowRooms : public Files, public ::testing::WithParamInterface<bool> {};

TEST_P(SlowRooms, what_has_a_barrier_stays_and_falls_without_support) {
    int stable = 0, stay = 0, fall = 0, free = 0, free_fall = 0;
    std::string moving, held;
    for (const std::uint64_t seed : {1, 2}) {
        const Scene scene = parsed_room(path("room" + std::to_string(seed)), seed, GetParam());
        const Solids solids = solids_of(scene);
        const double enough = 0.01 + scene.voxel_size_m;
        for (const Object& object : scene.objects) {
            if (object.grounded) continue;
            if (!(object.barrier_J > 0)) {
                ++free;
                free_fall += moved(let_go(scene, solids, object, true), enough) >= enough;
            }
            // What holds the others up is inferred, and not there for the simulator.
            if (barrier_within_error(object) || object.rests_by != "seen") continue;
            ++stable;
            const bool stays = moved(let_go(scene, solids, object, true), enough) < enough;
            stay += stays;
            const bool falls = moved(let_go(scene, solids, object, false), enough) >= enough;
            fall += falls;
            const std::string name = " " + std::to_string(seed) + "/" + std::to_string(object.id);
            if (!stays) moving += name;
            if (!falls) held += name;
        }
    }
    std::printf("%d of %d stay (room/object that doesn't:%s), %d fall without support (not:%s)\n",
                stay, stable, moving.c_str(), fall, held.c_str());
    std::printf("of %d with barrier 0 %d move\n", free, free_fall);
    EXPECT_GE(stable, 10);
    EXPECT_GE(stay, 0.95 * stable);
    // Pieces of one thing that were not joined may hold each other, and walls what stands at them.
    EXPECT_GE(fall, 0.8 * stable);
}

INSTANTIATE_TEST_SUITE_P(Furniture, SlowRooms, ::testing::Values(false, true),
                         [](const auto& varied) { return varied.param ? "varied" : "plain"; });

}  // namespace
}  // namespace topple::test
