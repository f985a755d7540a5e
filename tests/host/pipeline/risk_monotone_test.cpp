// SPDX-License-Identifier: MIT
#include "assessed_room.h"
#include "device/devices.h"
#include "host/safety/random_shaking.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"
#include "safety/wind/wind_field.h"
#include "testing.h"

// What makes a thing less safe raises its risk, from voxels to joules: barriers and S(W) of the
// parse's own physics, fields, risk. Each in many rooms of random sizes and places.
namespace topple::test {
namespace {

constexpr double mu = 0.3, voxel_m = 0.025;
constexpr int variants = 24;

double whole(double metres) {
    return voxel_m * std::round(metres / voxel_m);
}

class SlowRisk : public ::testing::Test {
  protected:
    safety::Risk of(Room& room, std::int32_t id, const std::string& field) {
        const AssessedRoom scene(*device, room, mu);
        const auto disturbance = [&] {
            if (field == "human") {
                safety::HumanOptions options;
                options.seed = seed;
                options.paths = 100;
                return safety::human_field(*device, scene.around, scene.at_risk, options);
            }
            if (field == "wind") {
                safety::WindOptions options;
                options.speed_m_s = wind_m_s;
                return safety::wind_field(*device, scene.around, scene.at_risk, options);
            }
            safety::EarthquakeOptions options;
            options.seed = seed;
            options.pga_m_s2 = pga_m_s2;
            options.record = record;
            return safety::earthquake_field(*device, scene.around, scene.at_risk, options);
        }();
        return safety::risk(disturbance, scene.at_risk)[id];
    }

    enum class Of { both, risk, chance };
    // What it is never falls from one step of a series to the next, and the last is above the first
    // where it `matters`.
    void expect_rises(const std::vector<safety::Risk>& series, const std::string& what,
                      Of which = Of::both, bool matters = true) {
        std::string all;
        for (const safety::Risk& r : series) {
            all.append(" ").append(std::to_string(r.mean_J)).append("/");
            all.append(std::to_string(r.chance));
        }
        const auto never_falls = [&](double safety::Risk::*figure) {
            for (std::size_t n = 1; n < series.size(); ++n)
                EXPECT_GE(series[n].*figure, series[n - 1].*figure - 1e-9) << what << ":" << all;
            if (matters) {
                EXPECT_GT(series.back().*figure, series.front().*figure) << what << ":" << all;
            }
        };
        if (which != Of::chance) never_falls(&safety::Risk::mean_J);
        // Where all of its sides fall from the beginning, more of them can't.
        if (which != Of::risk) {
            matters = matters && which == Of::chance;
            never_falls(&safety::Risk::chance);
        }
    }

    // So many rooms, each by chance.
    template <class Try>
    void vary(std::uint64_t first_seed, const Try& attempt) {
        for (int n = 0; n < variants; ++n) {
            topple::Random random(first_seed + static_cast<std::uint64_t>(n));
            seed = static_cast<std::uint64_t>(n + 1);
            attempt(n, random);
        }
    }

    std::unique_ptr<device::Device> device = device::open_native(2);
    std::uint64_t seed = 1;
    double wind_m_s = 12, pga_m_s2 = 3;
    std::optional<Accelerogram> record;
};

std::string named(const char* what, int n) {
    return std::string(what) + " " + std::to_string(n);
}

// A table in the middle of a floor to walk on; a cup from its middle to its edge.
TEST_F(SlowRisk, RisesFromTheMiddleOfATableToItsEdge) {
    vary(100, [&](int n, topple::Random& random) {
        const double half = whole(random.uniform(0.5, 0.8)), top = whole(random.uniform(0.6, 0.85));
        const double side = whole(random.uniform(0.075, 0.1));
        const double high = whole(random.uniform(0.175, 0.25));
        const double along = whole(random.uniform(-0.2, 0.2));
        std::vector<safety::Risk> human;
        for (const double share : {0.0, 0.5, 0.8, 1.0}) {
            Room room(voxel_m, {-1.5, -1.5}, {1.5, 1.5});
            room.box(-half, half, -half, half, top - 0.05, top);
            const double x = whole(share * (half - side)), y = along;
            const auto cup = room.box(x, x + side, y, y + side, top, top + high, false);
            human.push_back(of(room, cup, "human"));
        }
        expect_rises(human, named("cup towards the edge", n));
    });
}

// A corridor, and a table beside it, nearer and nearer: not so near that people keep away from it,
// as they do from what is within 20 cm.
TEST_F(SlowRisk, RisesTowardsWhereOneWalks) {
    vary(200, [&](int n, topple::Random& random) {
        const double wide = whole(random.uniform(0.7, 1.2)), top = whole(random.uniform(0.6, 0.9));
        const double side = whole(random.uniform(0.075, 0.1));
        const double high = whole(random.uniform(0.175, 0.25)), inside = n % 2 ? 0.0 : voxel_m;
        const double x = whole(random.uniform(0.5, 1.5));
        std::vector<safety::Risk> human;
        for (const double apart : {1.2, 0.45, 0.375, 0.3}) {
            Room room(voxel_m, {0, 0}, {2, wide});
            const double from = whole(wide + apart);
            room.box(0.3, 1.9, from, from + 0.5, top - 0.05, top);
            room.box(0.3, 1.9, from + 0.2, from + 0.3, 0, top - 0.05);
            const auto cup =
                room.box(x, x + side, from + inside, from + inside + side, top, top + high, false);
            human.push_back(of(room, cup, "human"));
        }
        expect_rises(human, named("cup towards the corridor", n));
    });
}

struct Column {
    double width = 0, depth = 0, height = 0;
};
Column random_column(topple::Random& random) {
    return {whole(random.uniform(0.1, 0.15)), whole(random.uniform(0.1, 0.2)),
            whole(random.uniform(0.5, 0.9))};
}

// The chance that people strike it may be a little less: over a low box a knee reaches to the far
// side, too, and strikes count where they are most.
// At the same mass: at the same density a taller box is also heavier, and takes a little more
// energy.
TEST_F(SlowRisk, RisesWithHeight) {
    for (const char* field : {"wind", "earthquake", "human"}) {
        vary(300, [&](int n, topple::Random& random) {
            const Column column = random_column(random);
            wind_m_s = random.uniform(14, 20);
            pga_m_s2 = random.uniform(2.5, 4);
            std::vector<safety::Risk> series;
            for (const double height : {0.15, 0.3, 0.6, 1.0}) {
                Room room(voxel_m, {-0.8, -0.8}, {1, 1});
                const auto id = room.box(0, column.width, 0, column.depth, 0, height, false,
                                         700 * 0.4 / height);
                series.push_back(of(room, id, field));
            }
            expect_rises(series, named(field, n),
                         std::string(field) == "human" ? Of::risk : Of::both);
        });
    }
}

// A pole on a plate, of the same mass together, more and more of it in the plate.
TEST_F(SlowRisk, FallsWithTheWeightOfTheBase) {
    for (const char* field : {"wind", "earthquake"}) {
        vary(400, [&](int n, topple::Random& random) {
            const double pole = n % 2 ? 0.1 : 0.15, foot = pole + 0.1;
            const double high = whole(random.uniform(1.2, 1.6)), to = 0.05 + pole;
            wind_m_s = random.uniform(20, 26);
            pga_m_s2 = random.uniform(4, 7);
            const double plate_m3 = foot * foot * 0.1, pole_m3 = pole * pole * high;
            const double mass = 700 * (plate_m3 + pole_m3);
            std::vector<safety::Risk> series;
            for (const double share : {0.95, 0.8, 0.6, 0.4, 0.1}) {  // of the mass, in the plate
                Room room(voxel_m, {-1, -1}, {1.5, 1.5});
                const auto id = room.box(0, foot, 0, foot, 0, 0.1, false, mass * share / plate_m3);
                room.part(id, 0.05, to, 0.05, to, 0.1, 0.1 + high, mass * (1 - share) / pole_m3);
                series.push_back(of(room, id, field));
            }
            // Wind at what is high up no longer tips what slides away before it.
            expect_rises(series, named(field, n),
                         std::string(field) == "wind" ? Of::risk : Of::both);
        });
    }
}

TEST_F(SlowRisk, FallsWithTheWidthOfTheBase) {
    for (const char* field : {"wind", "earthquake"}) {
        vary(500, [&](int n, topple::Random& random) {
            const double high = whole(random.uniform(0.5, 0.9));
            wind_m_s = random.uniform(14, 25);
            pga_m_s2 = random.uniform(1.5, 4);
            std::vector<safety::Risk> series;
            for (const double width : {0.4, 0.3, 0.2, 0.1}) {
                Room room(voxel_m, {-1, -1}, {1.5, 1.5});
                // A pole on a plate of more and more width, which weighs the same.
                const double at = whole(0.5 - width / 2);
                const auto id = room.box(at, at + width, at, at + width, 0, 0.05, false,
                                         700 * 0.04 / (width * width));
                room.part(id, 0.45, 0.55, 0.45, 0.55, 0.05, 0.05 + high);
                series.push_back(of(room, id, field));
            }
            expect_rises(series, named(field, n));
        });
    }
}

// For people below something wider, that hides it from them: a wide plate on the floor catches more
// feet, and no strike is told from another by where it meets the object. The plate weighs the same.
// The chance alone: what falls anyway releases more from the higher pass over a wider base.
TEST_F(SlowRisk, FallsWithTheWidthOfAHiddenBase) {
    vary(800, [&](int n, topple::Random& random) {
        const double high = whole(random.uniform(0.5, 0.8)), density = random.uniform(100, 300);
        std::vector<safety::Risk> series;
        for (const double width : {0.4, 0.3, 0.2, 0.1}) {
            Room room(voxel_m, {-0.8, -0.8}, {1.8, 1.8});
            const double at = whole(0.5 - width / 2);
            const auto id = room.box(at, at + width, at, at + width, 0, 0.05, false,
                                     700 * 0.01 / (width * width));
            room.part(id, 0.3, 0.7, 0.3, 0.7, 0.05, 0.05 + high, density);
            series.push_back(of(room, id, "human"));
        }
        expect_rises(series, named("hidden base", n), Of::chance);
    });
}

TEST_F(SlowRisk, RisesWithTheWind) {
    vary(600, [&](int n, topple::Random& random) {
        const Column column = random_column(random);
        std::vector<safety::Risk> series;
        for (const double speed : {3.0, 8.0, 12.0, 16.0, 24.0, 40.0}) {
            Room room(voxel_m, {-1, -1}, {1, 1});
            const auto id = room.box(0, column.width, 0, column.depth, 0, column.height, false);
            wind_m_s = speed;
            series.push_back(of(room, id, "wind"));
        }
        expect_rises(series, named("wind", n));
    });
}

// By pulses for each column. Rocking under a record is not monotone (a stronger quake may catch a
// column the other way), so by records for the mean of all.
TEST_F(SlowRisk, RisesWithThePeakOfTheGround) {
    const std::vector<double> peaks{0.2, 1.0, 2.0, 4.0, 8.0};
    std::vector<safety::Risk> mean(peaks.size());
    vary(700, [&](int n, topple::Random& random) {
        const Column column = random_column(random);
        Room room(voxel_m, {-1, -1}, {1, 1});
        const auto id = room.box(0, column.width, 0, column.depth, 0, column.height, false);
        std::vector<safety::Risk> series;
        for (std::size_t p = 0; p < peaks.size(); ++p) {
            pga_m_s2 = peaks[p];
            record.reset();
            series.push_back(of(room, id, "earthquake"));
            record = test::random_shaking(seed);
            for (double& a : record->m_s2) a *= peaks[p];
            const safety::Risk shaken = of(room, id, "earthquake");
            mean[p].mean_J += shaken.mean_J / variants;
            mean[p].chance += shaken.chance / variants;
        }
        // What slides nearly as early as it rocks does not fall.
        const double slender = std::min(column.width, column.depth) / column.height;
        expect_rises(series, named("pulses", n), Of::both, slender < 0.6 * mu);
    });
    expect_rises(mean, "records, mean");
    EXPECT_EQ(mean.front().chance, 0);
    EXPECT_GT(mean.back().chance, 0.3);
}

// Over many seeds, a risk strays from its mean by about as much as its standard error says.
TEST(RiskSpread, IsWhatSeedsDifferBy) {
    const auto device = device::open_native(2);
    Room room(0.025, {-1.5, -1.5}, {1.5, 1.5});
    room.box(-0.6, 0.6, -0.4, 0.4, 0.7, 0.75);
    const auto cup = static_cast<std::size_t>(room.box(0.5, 0.6, 0, 0.1, 0.75, 0.95, false));
    const AssessedRoom scene(*device, room, 0.3);
    constexpr std::uint64_t seeds = 30;
    const auto strays = [&](const std::function<safety::Disturbance(std::uint64_t)>& field) {
        double sum = 0, square = 0, told = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const safety::Risk r = safety::risk(field(seed), scene.at_risk)[cup];
            sum += r.mean_J;
            square += r.mean_J * r.mean_J;
            told += r.spread_J / seeds;
        }
        const double mean = sum / seeds;
        EXPECT_GT(mean, 0);
        return std::sqrt((square / seeds - mean * mean) * seeds / (seeds - 1)) / told;
    };
    const double walks = strays([&](std::uint64_t seed) {
        safety::HumanOptions options;
        options.seed = seed;
        options.paths = 100;
        return safety::human_field(*device, scene.around, scene.at_risk, options);
    });
    EXPECT_GT(walks, 0.45);
    EXPECT_LT(walks, 1.4);
    const double shakes = strays([&](std::uint64_t seed) {
        safety::EarthquakeOptions options;
        options.seed = seed;
        return safety::earthquake_field(*device, scene.around, scene.at_risk, options);
    });
    EXPECT_GT(shakes, 0.7);
    EXPECT_LT(shakes, 1.4);
}

}  // namespace
}  // namespace topple::test
