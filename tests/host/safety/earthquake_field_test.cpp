// SPDX-License-Identifier: MIT
#include "safety/earthquake/earthquake_field.h"

#include "device/devices.h"
#include "objects/floor_heights.h"
#include "physics/landscape.h"
#include "room.h"
#include "safety/columns.h"
#include "safety/earthquake/ground_motion.h"
#include "safety/earthquake/made_up_records.h"
#include "safety/earthquake/rocking.h"
#include "safety/objects.h"
#include "testing.h"

namespace topple::safety {
namespace {

using physics::gravity;
constexpr double mu = 0.3;  // RiskObject's

// Of acceleration `a` and length t along one axis, in steps of a hundredth of it.
Accelerogram square_pulse(double a, double t) {
    Accelerogram record;
    record.step_s = t / 100;
    record.m_s2.assign(200, 0.0);
    std::fill_n(record.m_s2.begin(), 100, a);
    return record;
}

TEST(Earthquake, RiseOfATurn) {
    const Profile body{0.1, 0.15, 0.25, 0.2};
    const auto raised = [&](float ahead, float behind) {
        return Motion{ahead, behind, 0, 0}.raised_J_kg(body);
    };
    EXPECT_EQ(raised(0, 0), 0);
    EXPECT_NEAR(21 * raised(std::atan(0.1f / 0.25f), 0), 3.96604, 1e-4);
    EXPECT_NEAR(21 * raised(1.5f, 0), 3.96604, 1e-4) << "beyond balance it comes down";
    EXPECT_NEAR(21 * raised(0, 1.5f), 8.55630, 1e-4);
    EXPECT_LT(raised(0.1f, 0), raised(0.2f, 0));
}

// What slides is held by all of its friction, whatever way it is shaken: its slips in both planes
// are those of Newmark's s = (a - mu g) a t^2 / (2 mu g) along that way.
TEST(Earthquake, SlipsFarEnoughWhateverTheWay) {
    const auto device = device::open_native(1);
    ShakenObject slab{{{{1, 0}, {0, 1}}}, {}, true, 0};
    slab.body.fill({0.5, 0.5, 0.1, 0.3, INFINITY, INFINITY});
    const double a = 4, t = 0.25 * 99.5 / 100;  // the last sample falls to 0 within a step
    Accelerogram both = square_pulse(a / std::sqrt(2.0), 0.25);
    both.across_m_s2 = both.m_s2;
    const std::vector records{square_pulse(a, 0.25), both};
    const double way = (a - mu * gravity) * a * t * t / (2 * mu * gravity);
    std::vector<GroundEvent> events = from_all_ways(0, 1);
    const std::vector<GroundEvent> of_both = from_all_ways(1, 1);
    events.insert(events.end(), of_both.begin(), of_both.end());
    const std::vector<std::size_t> which{0};
    const Motions found = shake_objects(*device, std::vector{slab}, which, records, events, true);
    ASSERT_EQ(found[0].size(), events.size());
    for (std::size_t e = 0; e < events.size(); ++e) {
        SCOPED_TRACE(e);
        const auto& [x, y] = found[0][e].in;
        const double slid_x = double{x.slid_ahead_m} - x.slid_behind_m,
                     slid_y = double{y.slid_ahead_m} - y.slid_behind_m;
        EXPECT_NEAR(std::hypot(slid_x, slid_y), way, 0.03 * way);
        const double turn = events[e].record == 0 ? 0 : M_PI / 4;
        const double towards = std::atan2(events[e].dy, events[e].dx) + turn;
        EXPECT_NEAR(slid_x, way * std::cos(towards), 0.03 * way);
        EXPECT_NEAR(slid_y, way * std::sin(towards), 0.03 * way);
        const bool one_plane = std::min(std::abs(slid_x), std::abs(slid_y)) < 0.01 * way;
        EXPECT_NEAR(found[0][e].together, one_plane ? 0 : slid_x * slid_y > 0 ? 1 : -1, 1e-9);
    }
}

// What falls in either plane falls. A slender one, one that slides off a near edge, one that does
// neither on endless support, and one that nothing holds.
TEST(Earthquake, ChancesOfFallingAreThoseOfBothPlanes) {
    const auto device = device::open_native(2);
    std::vector<ShakenObject> objects(4, {{{{1, 0}, {0, 1}}}, {}, true, 0});
    objects[0].body = {Profile{0.05, 0.08, 0.3, 0.2, INFINITY, INFINITY},
                       Profile{0.1, 0.1, 0.3, 0.2, INFINITY, INFINITY}};
    objects[1].body.fill({0.3, 0.3, 0.1, 0.2, 0.05, INFINITY});
    objects[2].body.fill({0.3, 0.3, 0.1, 0.2, INFINITY, INFINITY});
    objects[3].body.fill({0, 0.1, 0.1, 0.2, 1, 1});
    objects[3].held = false;
    const std::vector<std::size_t> which{0, 1, 2, 3};
    const std::vector records{made_up_records(2, 3)[1]};
    const auto found = fragilities(*device, objects, which, records, 1.5, nullptr);
    const double peak = records[0].peak_m_s2();
    for (const std::size_t o : which) {
        SCOPED_TRACE(o);
        std::size_t falling = 0;
        for (const auto& [pga_g, chance] : found[o].counted) {
            const auto events = from_all_ways(0, 1.5 * pga_g * gravity / peak);
            const Motions motions = shake_objects(*device, objects, which, records, events, false);
            const auto falls = std::ranges::count_if(motions[o], [&](const PlaneMotions& m) {
                const auto fell = [&](std::size_t plane) {
                    return m.in[plane].overturned() || m.in[plane].slid_off(objects[o].body[plane]);
                };
                return !objects[o].held || fell(0) || fell(1);
            });
            EXPECT_EQ(chance, static_cast<double>(falls) / 16) << pga_g;
            falling += falls > 0;
        }
        EXPECT_EQ(falling > 0, o != 2);
    }
}

class EarthquakeField : public ::testing::Test {
  protected:
    MassSpread stance_of(const Surroundings& around, const test::Room& room, std::size_t id) {
        const auto cells =
            cells_of_objects(movable_object_of_cells(around, room.objects), room.objects.size());
        return stance(around, cells[id], room.objects[id]);
    }
    std::unique_ptr<device::Device> device = device::open_native(1);
};

// A motion that does not go over an edge, or off the support, stays below the barrier, however much
// energy it has.
TEST_F(EarthquakeField, WorkReachesTheBarrierExactlyWhereItFalls) {
    test::Room room(0.02, {0, 0}, {2, 2});
    const auto id = static_cast<std::size_t>(room.box(0.8, 1.2, 0.8, 1.2, 0, 0.2, false));
    RiskObject& object = room.objects[id];
    object.barrier_J = 0.01;
    EarthquakeOptions options;
    options.record = square_pulse(8, 0.25);
    const auto surroundings = room.surroundings();
    const Disturbance field = earthquake_field(*device, surroundings, room.objects, options);
    const auto work = [&](double barrier_J, double slide_m) {
        RiskObject elsewhere = object;
        elsewhere.barrier_J = barrier_J;
        elsewhere.slide_distance_m = slide_m;
        return field.response[id](elsewhere)[0].W_J;  // along +x
    };
    // Newmark's s = (a - mu g) a t^2 / (2 mu g); the last sample falls to 0 within a step.
    const double t = 0.25 * 99.5 / 100;
    const double way = (8 - mu * gravity) * 8 * t * t / (2 * mu * gravity);
    EXPECT_NEAR(work(0, -1), mu * object.mass_kg * gravity * way, 0.02 * work(0, -1));
    EXPECT_LT(work(0.01, -1), 0.01) << "slides on a floor without an edge";
    // Its support goes on for a metre each way.
    EXPECT_GE(work(0.01, 0.3), way >= 1.0 ? 0.01 : 0.0);
    EXPECT_LT(work(0.01, 1.02 * way), 0.01);
    EXPECT_GE(work(1e9, -1), 0);
}

TEST_F(EarthquakeField, SameSeedSameEvents) {
    test::Room room(0.02, {0, 0}, {1, 1});
    room.thing(0.5, 0.5, 0);
    const auto surroundings = room.surroundings();
    EarthquakeOptions options;
    const auto a = earthquake_field(*device, surroundings, room.objects, options);
    const auto b = earthquake_field(*device, surroundings, room.objects, options);
    ASSERT_EQ(a.work[1].size(), 64u);
    EXPECT_TRUE(a.work[0].empty()) << "the floor is grounded";
    EXPECT_NEAR(test::total_probability(a.work[1]), 1, 1e-12);
    bool other = false;
    options.seed = 2;
    const auto c = earthquake_field(*device, surroundings, room.objects, options);
    for (std::size_t n = 0; n < 64; ++n) {
        EXPECT_EQ(a.work[1][n].W_J, b.work[1][n].W_J);
        other = other || a.work[1][n].W_J != c.work[1][n].W_J;
    }
    EXPECT_TRUE(other);
    EXPECT_FALSE(a.samples.x.empty());
}

TEST_F(EarthquakeField, SupportPolygonGivesTheBaseEachWay) {
    RiskObject object;
    object.base_width_m = 99;
    object.support_polygon = {{0, 0}, {0.4, 0}, {0.4, 0.2}, {0, 0.2}};
    MassSpread stands;
    stands.center = {0.1, 0.1, 0};
    EXPECT_NEAR(half_base(object, stands, 1, 0), 0.3, 1e-12);
    EXPECT_NEAR(half_base(object, stands, -1, 0), 0.1, 1e-12);
    EXPECT_NEAR(half_base(object, stands, 0, 1), 0.1, 1e-12);
    EXPECT_NEAR(half_base(object, stands, std::sqrt(0.5), std::sqrt(0.5)), 0.1 * std::sqrt(2),
                1e-12);
    stands.center = {-0.1, 0.1, 0};  // hangs over
    EXPECT_EQ(half_base(object, stands, -1, 0), 0);
}

// One of two things stands on a floor that shakes twice as strongly as the other's.
TEST_F(EarthquakeField, UpperFloorsShakeMore) {
    test::Room room(0.02, {0, 0}, {3, 3});
    const auto low = static_cast<std::size_t>(room.thing(1, 1, 0, 0.08, 0.4));
    const auto high = static_cast<std::size_t>(room.thing(2, 2, 0, 0.08, 0.4));
    room.objects[high].floor_shakes = 2;
    const auto surroundings = room.surroundings();
    EarthquakeOptions options;
    options.record = square_pulse(8, 0.25);
    options.over_space = true;
    const Disturbance field = earthquake_field(*device, surroundings, room.objects, options);
    EXPECT_NEAR(field.strongest[high].force_N, 2 * field.strongest[low].force_N, 1e-9);
    EXPECT_NEAR(field.fragility[high].pga_g, field.fragility[low].pga_g / 2,
                0.05 * field.fragility[low].pga_g);
    ASSERT_TRUE(field.space);
    const SpaceField& space = *field.space;
    const double speed = peak_velocity_m_s(*options.record);
    std::size_t strong = 0;
    for (std::size_t n = 0; n < space.size(); ++n) {
        const bool upper = space.cell[n][0] * space.along_m[0][0] > 1.5;
        strong += upper;
        EXPECT_NEAR(space.energy[n], (upper ? 4 : 1) * speed * speed / 2, 1e-4 * speed * speed);
        EXPECT_EQ(space.frequency[n], 1);
    }
    EXPECT_TRUE(strong > 0 && strong < space.size());
    EXPECT_EQ(space.energy_unit, "J/kg");
}

TEST(FloorHeights, UpperStoreysShakeMoreUpToTheRoof) {
    test::Room room(0.02, {0, 0}, {3, 3});
    room.floor(0, 1, 0, 1, 1);       // a platform
    room.floor(0, 3, 0, 3, 3);       // a storey
    room.box(0, 0.1, 0, 0.1, 3, 6);  // up to the roof
    const auto surroundings = room.surroundings();
    std::vector<Role> roles;
    for (const bool floor : surroundings.is_floor_primitive)
        roles.push_back(floor ? Role::floor : Role::none);
    const FloorHeights floors(SolidScene(*surroundings.cells, roles));
    EXPECT_EQ(floors.shaking(0), 1);
    EXPECT_EQ(floors.shaking(1), 1);
    EXPECT_NEAR(floors.shaking(3), 2, 1e-9);
    EXPECT_EQ(FloorHeights().shaking(3), 1);
}

// A box on a table, nearer to one end.
TEST_F(EarthquakeField, SupportGoesOnUntilTheTableEnds) {
    test::Room room(0.02, {0, 0}, {3, 3});
    room.box(1, 2, 1, 2, 0.68, 0.7);
    const auto id = static_cast<std::size_t>(room.thing(1.14, 1.5, 0.7));
    const auto surroundings = room.surroundings();
    const MassSpread stands = stance_of(surroundings, room, id);
    const Columns columns(*surroundings.cells);
    EXPECT_NEAR(support_reach(stands, columns, -1, 0), 0.14, 0.011);
    EXPECT_NEAR(support_reach(stands, columns, 1, 0), 0.86, 0.011);
    EXPECT_NEAR(support_reach(stands, columns, 0, 1), 0.5, 0.011);
    EXPECT_NEAR(support_reach(stands, columns, -0.6, 0.8), 0.14 / 0.6, 0.02);
}

// Its foot hides the 20 cm down to what carries it: heights count from there.
TEST_F(EarthquakeField, HeightsCountFromWhatCarriesAThing) {
    test::Room room(0.02, {0, 0}, {3, 3});
    const auto id = static_cast<std::size_t>(room.thing(1.5, 1.5, 0.2));
    const auto surroundings = room.surroundings();
    const double above_itself = stance_of(surroundings, room, id).height();
    room.objects[id].base_m = 0;
    EXPECT_NEAR(stance_of(surroundings, room, id).height(), above_itself + 0.2, 1e-6);
}

// Over the edge that the shaking takes it over it comes to rest no lower; what lies behind a pass a
// hundred times as high is none of the earthquake's doing.
TEST_F(EarthquakeField, BringsNoMoreThanItTakesToOverturn) {
    test::Room room(0.02, {0, 0}, {3, 3});
    const auto id = static_cast<std::size_t>(room.thing(1.5, 1.5, 0, 0.08, 0.4));
    RiskObject& object = room.objects[id];
    const auto earthquake = [&](double first_m) {
        physics::Candidate body;
        body.primitives = {0};
        body.body.mass_kg = object.mass_kg;
        body.body.center = {1.5, 1.5, 0.2};
        body.support_polygon = {{1.46, 1.46}, {1.54, 1.46}, {1.54, 1.54}, {1.46, 1.54}};
        const double climb_m = std::hypot(0.2, 0.04) - 0.2;
        physics::Stability tipping;
        for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
            tipping.ways.push_back({climb_m, first_m, way});
            tipping.ways.push_back({100 * climb_m, 100 * climb_m + 0.1, way});
        }
        object.support_polygon = body.support_polygon;
        object.toppling = std::make_shared<physics::Toppling>(
            body, physics::Toppling::Extent{{1, 1, 1, 0, 0, 0}, 0.4}, tipping,
            std::vector<std::array<double, 2>>{{1, 0}, {0, 1}, {-1, 0}, {0, -1}},
            physics::SlideResult{}, mu);
        EarthquakeOptions strong;
        strong.pga_m_s2 = 20;
        return earthquake_field(*device, room.surroundings(), room.objects, strong);
    };
    const Disturbance some = earthquake(0.1);
    EXPECT_GT(safety::risk_of(some.work[id], object, 1).chance, 0.5);
    const Disturbance none = earthquake(0);
    EXPECT_EQ(safety::risk_of(none.work[id], object, 1).chance, 0);
    EXPECT_GT(some.fragility[id].counted.back().chance, 0.9);
    EXPECT_EQ(none.fragility[id].counted.back().chance, 0) << "it overturns, and rests no lower";
}

TEST_F(EarthquakeField, NothingToShake) {
    test::Room room(0.02);
    auto field = earthquake_field(*device, room.surroundings(), room.objects, {});
    EXPECT_TRUE(field.work.empty());
    EXPECT_TRUE(field.notes.empty()) << "that nothing was judged is said once for all";
}

}  // namespace
}  // namespace topple::safety
