// SPDX-License-Identifier: MIT
#include "device/devices.h"
#include "host/pipeline/assessed_room.h"
#include "host/safety/random_shaking.h"
#include "physics/directions.h"
#include "safety/columns.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"
#include "safety/objects.h"
#include "safety/wind/wind_field.h"
#include "simulation/simulation.h"
#include "testing.h"

// Which things fall under which disturbance (the paper's Fig. 18): topple's fields and S(W), and a
// simulator that shakes, blows at and strikes the same things.
namespace topple::simulation {
namespace {

constexpr double mu = 0.3, voxel_m = 0.025, short_step_s = 1.0 / 960;

double whole(double metres) {
    return voxel_m * std::round(metres / voxel_m);
}

// A floor to walk on, a table, a shelf, and twelve things on them.
struct Layout {
    test::Room room{voxel_m};
    std::vector<std::string> name;                           // of each object
    std::map<std::int32_t, std::set<std::int32_t>> carries;  // what stands on a thing

    explicit Layout(std::uint64_t seed) {
        Random random(seed);
        const auto some = [&](double low, double high) { return whole(random.uniform(low, high)); };
        add("floor", room.floor(-2.2, 2.2, -2.2, 2.2));
        const double x = some(-1.4, -0.9), y = some(-0.9, 0), wide = some(0.9, 1.3);
        const double deep = some(0.6, 0.8), top = some(0.65, 0.8);
        const auto table = room.box(x, x + wide, y, y + deep, top - 0.05, top);
        add("table", table);
        for (const double i : {x, x + wide - 0.05}) {
            for (const double j : {y, y + deep - 0.05})
                room.part(table, i, i + 0.05, j, j + 0.05, 0, top - 0.05);
        }
        thing("cup at the edge", x + 0.025, y + deep / 2, top, 0.075, 0.075, 0.1);
        thing("cup in the middle", x + wide / 2, y + deep / 2, top, 0.075, 0.075, 0.1);
        thing("bottle", x + wide - some(0.15, 0.3), y + deep - some(0.15, 0.3), top, 0.075, 0.075,
              some(0.25, 0.35));
        thing("low box", x + some(0.25, 0.35), y + 0.05, top, some(0.2, 0.3), some(0.15, 0.2),
              some(0.05, 0.1));
        // A shelf of three boards between two sides.
        const double sx = some(0.7, 1.0), sy = some(-0.3, 0.6), board = some(0.35, 0.45);
        const auto shelf = room.box(sx, sx + 0.05, sy, sy + 0.3, 0, 3 * board + 0.05);
        add("shelf", shelf);
        room.part(shelf, sx + 0.85, sx + 0.9, sy, sy + 0.3, 0, 3 * board + 0.05);
        for (int n = 1; n <= 3; ++n)
            room.part(shelf, sx + 0.05, sx + 0.85, sy, sy + 0.3, n * board, n * board + 0.05);
        thing("vase at a board's edge", sx + some(0.2, 0.4), sy + 0.025, board + 0.05, 0.1, 0.1,
              whole(board - 0.1));
        thing("books", sx + 0.5, sy + 0.1, 2 * board + 0.05, some(0.15, 0.25), 0.15,
              whole(board - 0.1));
        thing("jar on top", sx + some(0.2, 0.5), sy + 0.1, 3 * board + 0.05, 0.1, 0.1,
              some(0.15, 0.25));
        // On the floor.
        thing("cabinet", some(-0.6, -0.4), some(1.2, 1.5), 0, some(0.2, 0.3), 0.2, some(1.0, 1.4));
        thing("crate", some(0.1, 0.4), some(-1.4, -1.1), 0, 0.4, some(0.3, 0.4), some(0.25, 0.3));
        const double lx = some(-1.6, -1.4), ly = some(1.2, 1.5), foot = some(0.2, 0.3);
        const auto lamp = thing("lamp", lx, ly, 0, foot, foot, 0.05);
        const double mid = whole(foot / 2 - 0.025), pole = some(0.8, 1.2);
        room.part(lamp, lx + mid, lx + mid + 0.05, ly + mid, ly + mid + 0.05, 0.05, pole);
        room.part(lamp, lx + mid - 0.05, lx + mid + 0.1, ly + mid - 0.05, ly + mid + 0.1, pole,
                  pole + 0.15);
        const double bx = some(1.2, 1.5), by = some(-1.4, -1.1);
        const auto lower = thing("lower of a stack", bx, by, 0, 0.3, 0.25, some(0.15, 0.25));
        const double under = room.objects[lower].height_m;
        const auto upper =
            thing("upper of a stack", bx + 0.05, by + 0.05, under, 0.15, 0.15, some(0.2, 0.4));
        carries[lower] = {upper};
    }

  private:
    void add(const char* what, std::int32_t id) {
        name.resize(static_cast<std::size_t>(id) + 1);
        name.back() = what;
    }
    std::int32_t thing(const char* what, double x, double y, double z, double wide, double deep,
                       double high) {
        x = whole(x);
        y = whole(y);
        const auto id = room.box(x, x + wide, y, y + deep, z, z + high, false);
        add(what, id);
        return id;
    }
};

// One object among the others, which stay where they are; what it carries is left out.
Simulation of_object(const Layout& layout, const safety::Surroundings& around, std::int32_t id,
                     double step_s) {
    const SolidCells& cells = *around.cells;
    std::map<std::int32_t, std::vector<Cell>> parts;
    std::vector<Cell> fixed;
    const auto carried = layout.carries.find(id);
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const Cell cell{cells.i[c], cells.j[c], cells.k[c]};
        if (around.object[c] == id)
            parts[cells.primitive[c]].push_back(cell);
        else if (carried == layout.carries.end() || !carried->second.contains(around.object[c]))
            fixed.push_back(cell);
    }
    LooseBody body{voxel_m, 700, {}};
    for (auto& [primitive, part] : parts) body.parts.push_back(std::move(part));
    return {body, fixed, mu, step_s};
}

double at_time(const Accelerogram& record, double seconds) {
    const double at = seconds / record.step_s;
    const auto n = static_cast<std::size_t>(at);
    if (n + 1 >= record.m_s2.size()) return 0;
    const double share = at - static_cast<double>(n);
    return (1 - share) * record.m_s2[n] + share * record.m_s2[n + 1];
}

// What slides on the floor would come to its end, where no room ends; what is tall falls farther.
double far(const Body& object) {
    return object.lowest_m < voxel_m ? std::max(0.6, 2 * object.highest_m) : 3;
}

struct Tally {
    int both = 0, neither = 0, topple_alone = 0, simulator_alone = 0;
    void add(bool topple, bool simulator) {
        ++(topple ? simulator ? both : topple_alone : simulator ? simulator_alone : neither);
    }
    int all() const { return both + neither + topple_alone + simulator_alone; }
    double agreement() const { return static_cast<double>(both + neither) / all(); }
    void print(const char* what) const {
        std::printf(
            "%-24s %4d fall in both, %4d in neither, %3d in topple, %3d in the simulator "
            "alone: %.1f %%\n",
            what, both, neither, topple_alone, simulator_alone, 100 * agreement());
    }
};

class SlowDisturbances : public ::testing::Test {
  protected:
    static constexpr std::uint64_t layouts = 3;

    // Each event of each object, or every second: what topple says of it, and the simulator.
    template <typename Fields, typename Falls>
    Tally compare(const char* what, double step_s, std::size_t every, const Fields& fields,
                  const Falls& falls) {
        Tally all, objects, whatever_way;
        std::map<std::string, Tally> by_name;
        for (std::uint64_t seed = 1; seed <= layouts; ++seed) {
            Layout layout(seed);
            const test::AssessedRoom scene(*device, layout.room, mu);
            for (const safety::Disturbance& field : fields(scene, seed)) {
                for (std::size_t o = 0; o < scene.at_risk.size(); ++o) {
                    const safety::RiskObject& object = scene.at_risk[o];
                    if (object.grounded) continue;
                    Simulation simulation =
                        of_object(layout, scene.around, static_cast<std::int32_t>(o), step_s);
                    bool own_ever = false, theirs_ever = false;
                    for (std::size_t e = o % every; e < field.work[o].size(); e += every) {
                        const safety::WorkSample& event = field.work[o][e];
                        simulation.reset();
                        const bool own = safety::instability(object, event) > 0;
                        const bool theirs = falls(simulation, scene, o, e, event, seed);
                        all.add(own, theirs);
                        // Work of pushes and shaking is relative to the barrier of their way.
                        if (std::isfinite(event.height_m))
                            whatever_way.add(safety::instability(object.curve, event.W_J) > 0,
                                             theirs);
                        by_name[layout.name[o]].add(own, theirs);
                        own_ever = own_ever || own;
                        theirs_ever = theirs_ever || theirs;
                    }
                    objects.add(own_ever, theirs_ever);
                }
            }
        }
        for (const auto& [name, tally] : by_name) tally.print(name.c_str());
        objects.print("objects, in any event");
        if (whatever_way.all() > 0) whatever_way.print("by S(W) whatever the way");
        all.print(what);
        std::printf("of those that fall in either: %.1f %%\n",
                    100.0 * all.both / (all.all() - all.neither));
        return all;
    }

    std::unique_ptr<device::Device> device = device::open_native(2);
};

void expect_alike(const Tally& tally, double least) {
    EXPECT_GE(tally.agreement(), least);
    EXPECT_GE(tally.both, 20);
    EXPECT_GE(tally.neither, 20);
}

// Of a record, from every second side.
TEST_F(SlowDisturbances, Earthquake) {
    const auto record = [](std::uint64_t seed) {
        Accelerogram r = test::random_shaking(seed);
        for (double& a : r.m_s2) a *= 0.5 + 2 * static_cast<double>(seed);
        return r;
    };
    const Tally tally = compare(
        "earthquake", short_step_s, 2,
        [&](const test::AssessedRoom& scene, std::uint64_t seed) {
            safety::EarthquakeOptions options;
            options.record = record(seed);
            return std::vector{
                safety::earthquake_field(*device, scene.around, scene.at_risk, options)};
        },
        [&](Simulation& simulation, const test::AssessedRoom&, std::size_t, std::size_t e,
            const safety::WorkSample&, std::uint64_t seed) {
            const Accelerogram r = record(seed);
            // Where it was shaken: where it goes, which the event names, is mostly another way.
            const auto d = safety::direction(static_cast<unsigned>(e));
            return simulation.falls(12, voxel_m, 3,
                                    {[&](double t) {
                                         const double a = at_time(r, t);
                                         return Vec3{a * d[0], a * d[1], 0};
                                     },
                                     {},
                                     {}});
        });
    expect_alike(tally, 0.92);
}

TEST_F(SlowDisturbances, Wind) {
    safety::WindOptions options;
    const Tally tally = compare(
        "wind", short_step_s, 1,
        [&](const test::AssessedRoom& scene, std::uint64_t seed) {
            options.speed_m_s = 10 + 4 * static_cast<double>(seed);
            return std::vector{safety::wind_field(*device, scene.around, scene.at_risk, options)};
        },
        [&](Simulation& simulation, const test::AssessedRoom& scene, std::size_t o, std::size_t,
            const safety::WorkSample& event, std::uint64_t) {
            const auto cells = safety::cells_of_objects(
                safety::movable_object_of_cells(scene.around, scene.at_risk), scene.at_risk.size());
            const safety::Columns columns(*scene.around.cells);
            const Vec3 d = event.direction;
            const auto front = safety::wind_frontage(*scene.around.cells, columns, cells[o],
                                                     {d[0], d[1]}, options.shelter_m);
            const auto stands = safety::stance(scene.around, cells[o], scene.at_risk[o]);
            const double force = safety::wind_force({front.area_m2, 0, 0, 0}, options);
            return simulation.falls(
                4, voxel_m, far(scene.objects[o]),
                {{}, {force * d[0], force * d[1], 0}, {0, 0, front.center_m - stands.center[2]}});
        });
    expect_alike(tally, 0.94);
}

// A strike gives its energy to the body, of motion and turning together, at its height.
TEST_F(SlowDisturbances, Human) {
    const Tally tally = compare(
        "human", 1.0 / 240, 1,
        [&](const test::AssessedRoom& scene, std::uint64_t seed) {
            safety::HumanOptions options;
            options.seed = seed;
            options.paths = 200;
            return std::vector{safety::human_field(*device, scene.around, scene.at_risk, options)};
        },
        [&](Simulation& simulation, const test::AssessedRoom& scene, std::size_t o, std::size_t,
            const safety::WorkSample& event, std::uint64_t) {
            const Body& struck = scene.objects[o];
            const Vec3 at{0, 0, struck.lowest_m + event.height_m - struck.candidate.body.center[2]};
            const double scale = std::sqrt(event.W_J / simulation.energy_J(event.direction, at));
            simulation.push({scale * event.direction[0], scale * event.direction[1], 0}, at);
            return simulation.falls(4, voxel_m, far(scene.objects[o]), {});
        });
    expect_alike(tally, 0.93);
}

}  // namespace
}  // namespace topple::simulation
