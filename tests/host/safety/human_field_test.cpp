// SPDX-License-Identifier: MIT
#include "safety/human/human_field.h"

#include "core/random.h"
#include "errors.h"
#include "oracle/disturbance_oracle.h"
#include "room.h"
#include "safety/human/body_parts.h"
#include "safety/human/convolution.h"
#include "safety/human/walkable_map.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::safety {
namespace {

class HumanField : public test::EachBackend {
  protected:
    Disturbance field(test::Room& room) {
        return human_field(*device, room.surroundings(), room.objects, {});
    }
};

double struck(const Disturbance& field, std::int32_t object) {
    return test::total_probability(field.work[object]);
}

// The five cases of the paper's Fig. 11, in two rooms joined by a door.
TEST_P(HumanField, FiveTypicalPlaces) {
    test::Room room(0.025, {0, 0}, {5, 6});
    room.box(-0.1, 0, -0.1, 6.1, 0, 2);
    room.box(5, 5.1, -0.1, 6.1, 0, 2);
    room.box(0, 5, -0.1, 0, 0, 2);
    room.box(0, 5, 6, 6.1, 0, 2);
    room.box(0, 2.0, 4.2, 4.3, 0, 2);
    room.box(3.0, 5, 4.2, 4.3, 0, 2);
    room.box(1.5, 3.5, 1.5, 3.5, 0.725, 0.75);  // a table, two metres wide
    const auto middle = room.thing(2.5, 2.5, 0.75);
    const auto edge = room.thing(1.55, 2.5, 0.75);
    const auto passage = room.thing(1.95, 4.15, 0, 0.1, 0.9);  // beside the door
    const auto corner = room.thing(0.05, 0.05, 0, 0.1, 0.9);
    const auto below = room.thing(2.5, 2.5, 0, 0.1, 0.5);
    const Disturbance f = field(room);
    EXPECT_EQ(struck(f, middle), 0) << "a: in the middle of a wide table";
    EXPECT_EQ(struck(f, below), 0) << "e: below the table";
    EXPECT_GT(struck(f, edge), 0.02) << "b: on the table's edge";
    EXPECT_GT(struck(f, passage), 0.02) << "c: along the passage";
    EXPECT_LT(struck(f, corner), struck(f, edge)) << "d: in a concave corner";
    EXPECT_LT(struck(f, corner), struck(f, passage));
    for (const auto& work : f.work) {
        EXPECT_LE(test::total_probability(work), 1 + 1e-12);
        for (const auto& s : work) {
            EXPECT_GT(s.W_J, 0);
            EXPECT_NEAR(std::hypot(s.direction[0], s.direction[1]), 1, 1e-6);
        }
    }
    EXPECT_GT(f.samples.x.size(), 1000u);
    EXPECT_LE(f.samples.x.size(), max_samples);
    const auto r = risk(f, room.objects);
    EXPECT_EQ(r[middle].mean_J, 0);
    EXPECT_GT(r[edge].mean_J, 0);
}

// What passes at a place, of a field along the grid's axes.
struct PassesThere {
    double frequency = 0, speed_m_s = 0, energy_J = 0;
};
PassesThere passes_at(const SpaceField& field, const Vec3& at) {
    std::array<std::int32_t, 3> cell{};
    for (std::size_t a = 0; a < 3; ++a)
        cell[a] = static_cast<std::int32_t>(
            std::floor((at[a] - field.corner_m[a]) / field.along_m[a][a]));
    const auto found = std::ranges::lower_bound(field.cell, cell);
    if (found == field.cell.end() || *found != cell) return {};
    const auto n = static_cast<std::size_t>(found - field.cell.begin());
    const auto& v = field.velocity_m_s[n];
    return {field.frequency[n], std::hypot(v[0], v[1], v[2]), field.energy[n]};
}

// "The distribution of velocity above the table center, or any unreachable points, is zero"
// (5.1.2).
TEST_P(HumanField, OverSpaceIsNothingAboveTheMiddleOfATable) {
    test::Room room(0.025, {0, 0}, {5, 5});
    room.box(1.5, 3.5, 1.5, 3.5, 0.725, 0.75);  // two metres wide
    room.thing(1.55, 2.5, 0.75);
    const Surroundings around = room.surroundings();
    EXPECT_FALSE(human_field(*device, around, room.objects, {}).space);
    HumanOptions options;
    options.over_space = true;
    const std::optional<SpaceField> field =
        human_field(*device, around, room.objects, options).space;
    ASSERT_TRUE(field);
    EXPECT_TRUE(std::ranges::is_sorted(field->cell));
    for (double z = 0.8; z < 1.1; z += 0.05)
        EXPECT_EQ(passes_at(*field, {2.5, 2.5, z}).frequency, 0) << z;
    EXPECT_EQ(passes_at(*field, {0.75, 2.5, 1.9}).frequency, 0) << "above their heads";
    const PassesThere beside = passes_at(*field, {0.75, 2.5, 0.9});
    EXPECT_GT(beside.frequency, 0.05);
    const SecondaryMotion motion = table_motion(options);
    double fastest = 0;
    for (const MotionLayer& layer : motion.layers) fastest = std::max(fastest, layer.speed_m_s);
    for (std::size_t n = 0; n < field->size(); ++n) {
        const auto& v = field->velocity_m_s[n];
        ASSERT_LE(std::hypot(v[0], v[1]), fastest * 1.0001);
        ASSERT_GE(field->energy[n], 0.999 * std::ranges::min(motion.energy_J));
        ASSERT_LE(field->energy[n], 1.001 * std::ranges::max(motion.energy_J));
    }
    // Of two kinds that are alike, each comes half as often.
    const std::array two{options, options};
    const auto both = people_field(*device, around, room.objects, two).space;
    ASSERT_TRUE(both && both->cell == field->cell);
    for (std::size_t n = 0; n < both->size(); ++n)
        ASSERT_NEAR(both->frequency[n], field->frequency[n], 1e-6);
}

TEST_P(HumanField, NoArmReachesThroughAWall) {
    for (const bool wall : {false, true}) {
        test::Room room(0.025, {0, 0}, {3, 2});
        room.box(0, 3, 2.2, 2.6, 0.95, 1.0);  // a shelf
        const auto cup = room.thing(1.5, 2.3, 1.0);
        if (wall) room.box(0, 3, 2.1, 2.125, 0, 2);
        const Disturbance f = field(room);
        EXPECT_EQ(struck(f, cup) == 0, wall);
    }
}

// Asked what it would meet elsewhere, the field tells what it tells of a thing that stands there.
TEST_P(HumanField, ElsewhereIsAsIfItStoodThere) {
    const double inside[] = {0.95, 0.45, 0.25, 0.05};
    std::vector<double> moved, there;
    for (const double at : inside) {
        test::Room room(0.025, {0, 0}, {4, 4});
        room.box(1, 3, 1, 3, 0.7, 0.75);
        const auto cup = room.thing(1 + at, 2, 0.75);
        const Surroundings s = room.surroundings();
        const Disturbance walkers = human_field(*device, s, room.objects, {});
        there.push_back(struck(walkers, cup));
        if (at != inside[0]) continue;
        std::vector<Placement> placements;
        for (const double to : inside) {
            placements.push_back({static_cast<std::size_t>(cup),
                                  static_cast<std::int32_t>(std::lround((to - at) / 0.025)), 0,
                                  room.objects[cup]});
        }
        // Each of its cups falls at any strike, and releases as much.
        for (const Risk& risk : walkers.risk_at(placements)) moved.push_back(risk.chance);
    }
    for (std::size_t n = 0; n < there.size(); ++n)
        EXPECT_NEAR(moved[n], there[n], 1e-6 + 0.02 * there[n]) << inside[n];
    EXPECT_EQ(moved[0], 0);
    EXPECT_GT(moved[3], 0.05);
}

// Floors at different heights are walked on alike: a gallery beside a floor.
TEST_P(HumanField, EachFloorIsWalkedOn) {
    test::Room room(0.05, {0, 0}, {3, 3});
    room.floor(4, 7, 0, 3, 2.5);
    const auto low = room.thing(1.5, 1.5, 0, 0.1, 0.9), high = room.thing(5.5, 1.5, 2.5, 0.1, 0.9);
    const auto under = room.thing(5.5, 1.5, 0.5, 0.1, 0.5);
    const Disturbance f = field(room);
    EXPECT_GT(struck(f, low), 0.05);
    EXPECT_GT(struck(f, high), 0.05);
    EXPECT_NEAR(struck(f, low), struck(f, high), 0.5 * struck(f, low));
    EXPECT_EQ(struck(f, under), 0) << "nobody walks where there is no floor";
}

// A thin thing on a table is struck by hands that pass just above the table's top.
TEST_P(HumanField, ThinThingsOnTablesAreWithinReach) {
    for (const double table : {0.65, 0.70, 0.75, 0.80, 0.85}) {
        test::Room room(0.025, {0, 0}, {3, 3});
        room.box(1, 2, 1, 2, table - 0.025, table);
        const auto book = room.box(1, 1.2, 1.4, 1.6, table, table + 0.025, false);
        EXPECT_GT(struck(field(room), book), 0.01) << "table of " << table << " m";
    }
}

// Exposure of every object's voxel against the double-precision scatter over the same walks.
TEST_P(HumanField, MatchesTheOracle) {
    test::Room room(0.025, {0, 0}, {1.6, 1.5});
    room.box(0.6, 0.7, 0.1, 0.8, 0, 1.2);
    room.box(1.0, 1.6, 1.1, 1.5, 0.7, 0.75);
    room.thing(1.1, 1.2, 0.75);
    room.thing(0.85, 0.3, 0, 0.1, 0.4);
    room.thing(1.45, 1.4, 0.75, 0.1, 0.3);
    HumanOptions options;
    options.paths = 60;
    const Surroundings s = room.surroundings();
    const Disturbance f = human_field(*device, s, room.objects, options);

    const WalkableMap map = walkable_map(s, options);
    const PrimaryMotion motion = primary_motion(map, options);
    const SolidCells& cells = *s.cells;
    oracle::Grid grid{static_cast<int>(map.nx), static_cast<int>(map.ny),
                      std::vector<std::uint32_t>(map.size())};
    const double band_m = options.body_height_m / 32;
    for (std::size_t v = 0; v < cells.size(); ++v) {
        if (s.is_floor_primitive[cells.primitive[v]]) continue;
        for (unsigned b = 0; b < 32; ++b) {
            const double middle = (b + 0.5) * band_m;
            if (cells.k[v] * cells.voxel_m <= middle && middle < (cells.k[v] + 1) * cells.voxel_m)
                grid.solid[map.cell_of(cells.i[v], cells.j[v])] |= 1u << b;
        }
    }
    // density[part][direction][band] of every cell
    std::vector<double> exposure(cells.size(), 0.0);
    const double height = options.body_height_m;
    for (const BodyPart& part : body_parts) {
        for (unsigned d = 0; d < direction_count; ++d) {
            std::vector<double> primary(map.size());
            for (std::size_t c = 0; c < map.size(); ++c)
                primary[c] = motion.visits[d * map.size() + c] / 120.0;
            const double angle = d * 2 * std::acos(-1.0) / 16, dx = std::cos(angle),
                         dy = std::sin(angle);
            const double step = 1 / std::max(std::fabs(dx), std::fabs(dy)) * map.cell_m;
            std::vector<std::vector<double>> bands(33);
            for (unsigned b = 0; b < 32; ++b) {
                if ((b + 0.5) / 32 < part.low || (b + 0.5) / 32 >= part.high) continue;
                bands[b] =
                    oracle::scatter(grid, primary, b, dx, dy, 20, [&](double ahead, double aside) {
                        const double at = ahead * map.cell_m;
                        const double from = std::max(at - step / 2, -part.back * height);
                        const double to = std::min(at + step / 2, part.front * height);
                        const double side = std::max(0.0, aside * map.cell_m - part.reach * height);
                        return std::max(0.0, to - from) / ((part.front + part.back) * height) *
                               part.share * std::max(0.0, 1 - side / options.wander_m);
                    });
            }
            for (std::size_t v = 0; v < cells.size(); ++v) {
                const auto b =
                    static_cast<std::size_t>((cells.k[v] + 0.5) * cells.voxel_m / band_m);
                if (b >= 32 || cells.k[v] < 0) continue;
                double most = 0;
                for (const std::size_t at : {b, b + 1}) {
                    if (!bands[at].empty())
                        most = std::max(most, bands[at][map.cell_of(cells.i[v], cells.j[v])]);
                }
                exposure[v] += most;
            }
        }
    }
    double worst = 0;
    std::size_t compared = 0, zeros = 0;
    for (std::size_t v = 0; v < cells.size(); ++v) {
        if (room.objects[s.object[v]].grounded) {
            EXPECT_EQ(f.exposure[v], 0);
        } else if (exposure[v] == 0) {
            ++zeros;
            EXPECT_EQ(f.exposure[v], 0) << "cell " << v;
        } else {
            ++compared;
            worst = std::max(worst, std::fabs(double{f.exposure[v]} - exposure[v]) / exposure[v]);
        }
    }
    EXPECT_LE(worst, 1e-4);
    EXPECT_GT(compared, 50u);
    EXPECT_GT(zeros, 20u);
}

TEST_P(HumanField, EmptyScenesGiveEmptyFields) {
    test::Room room(0.025);
    const Disturbance nothing = field(room);
    EXPECT_TRUE(nothing.work.empty());
    EXPECT_FALSE(nothing.notes.empty());
    room.thing(0.5, 0.5, 0);
    const Disturbance floating = field(room);
    ASSERT_EQ(floating.work.size(), 1u);
    EXPECT_TRUE(floating.work[0].empty());
    EXPECT_FALSE(floating.notes.empty());
    test::Room bare(0.025);
    bare.floor(0, 1, 0, 1);
    const Disturbance walked = human_field(*device, bare.surroundings(), {}, {});
    EXPECT_TRUE(walked.work.empty());
    EXPECT_FALSE(walked.samples.x.empty());
}

TOPPLE_ON_EACH_BACKEND(HumanField);

}  // namespace
}  // namespace topple::safety
