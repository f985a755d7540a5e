// SPDX-License-Identifier: MIT
#include "lab/rooms/building.h"

#include <nlohmann/json.hpp>

#include "core/vectors.h"
#include "host/io/files.h"
#include "lab/temporary_folder.h"
#include "points/formats/read_cloud.h"
#include "topple/error.h"
#include "topple/input.h"

namespace topple::scenes {
namespace {

struct Scanned {
    float x, y, z;
    std::int32_t object;
};

bool go_on(std::size_t, std::size_t) {
    return true;
}

std::vector<Scanned> points_of(const std::string& ply) {
    const std::string end = "end_header\n";
    const std::size_t start = ply.find(end) + end.size();
    std::vector<Scanned> points((ply.size() - start) / sizeof(Scanned));
    std::memcpy(points.data(), ply.data() + start, points.size() * sizeof(Scanned));
    return points;
}

// Two rooms, each point 6 cm from the next.
constexpr BuildingOptions small{.seed = 3, .points = 61'000, .spacing_m = 0.06, .noise_m = 0};

struct Files {
    std::string cloud;
    nlohmann::json truth;
};
Files written(const BuildingOptions& options) {
    const TemporaryFolder folder("topple_building");
    const auto file = folder.path() / "b.ply";
    write_building(file, options, go_on);
    return {test::bytes_of_file(file), nlohmann::json::parse(test::bytes_of_file(truth_of(file)))};
}

const Files& small_building() {
    static const Files files = written(small);
    return files;
}

Vec3 in_room(const Building::Room& room, const Scanned& p) {
    return minus({p.x, p.y, p.z}, room.origin);
}

// The room whose part of the building, up to the middle of its walls, holds a point.
const Building::Room& room_of(const std::vector<Building::Room>& rooms, const Scanned& p) {
    for (const Building::Room& room : rooms) {
        const Vec3 q = in_room(room, p), &size = room.world.room;
        const double e = Building::wall_m / 2 + 1e-5;
        if (q[0] > -e && q[1] > -e && q[0] < size[0] + e && q[1] < size[1] + e) return room;
    }
    ADD_FAILURE() << "a point is in no room";
    return rooms.front();
}

std::vector<Building::Room> rooms_of(const BuildingOptions& options) {
    const Building building(options);
    std::vector<Building::Room> rooms;
    for (std::size_t k = 0; k < building.rooms(); ++k) rooms.push_back(building.room(k));
    return rooms;
}

TEST(Building, HoldsTheAskedNumberOfPoints) {
    const Files& files = small_building();
    EXPECT_NE(files.cloud.find("element vertex 61000\n"), std::string::npos);
    const auto points = points_of(files.cloud);
    ASSERT_EQ(points.size(), small.points);
    EXPECT_NEAR(files.truth.at("spacing").get<double>(), small.spacing_m, 0.008);
    std::vector<std::uint64_t> counts(files.truth.at("objects").size(), 0);
    for (const Scanned& p : points) ++counts.at(static_cast<std::size_t>(p.object));
    for (std::size_t k = 1; k < counts.size(); ++k) {
        const auto& object = files.truth.at("objects").at(k);
        EXPECT_EQ(object.at("id"), k);
        EXPECT_EQ(object.at("points"), counts[k]);
    }
}

// Without noise: on a part of its object, and clear of all others.
TEST(Building, PointsLieOnTheirObjectsAndInNothing) {
    const auto rooms = rooms_of(small);
    const Files& files = small_building();
    for (const Scanned& p : points_of(files.cloud)) {
        const Building::Room& room = room_of(rooms, p);
        const auto& truth = files.truth.at("rooms").at(room.id);
        const Vec3 q = in_room(room, p);
        std::array<double, 2> nearest{1, 1};
        std::int32_t object = -1;
        for (const Part& part : room.world.parts) {
            if (!overlap(part.bounds(), Bounds{q, q}, 0.01)) continue;
            const double distance = part.distance(q);
            if (distance < nearest[0]) {
                nearest = {distance, nearest[0]};
                object = part.object;
            } else {
                nearest[1] = std::min(nearest[1], distance);
            }
        }
        ASSERT_NEAR(nearest[0], 0, 1e-5);
        ASSERT_GT(nearest[1], 0.00299);
        const auto first = truth.at("first_object").get<std::int32_t>();
        ASSERT_EQ(p.object, object == 0 ? 0 : first + object - 1);
    }
}

// A patch is looked at in its middle, so that points at its rim may be hidden.
TEST(Building, TheScannerSeesThePoints) {
    const auto rooms = rooms_of(small);
    const auto points = points_of(small_building().cloud);
    std::size_t asked = 0, hidden = 0;
    for (std::size_t k = 0; k < points.size(); k += 37, ++asked) {
        const Building::Room& room = room_of(rooms, points[k]);
        const Vec3 q = in_room(room, points[k]);
        const bool seen =
            std::any_of(room.stations.begin(), room.stations.end(), [&](const Vec3& from) {
                const Vec3 way = minus(q, from);
                return std::ranges::all_of(room.world.parts, [&](const Part& part) {
                    return part.hit(from, unit(way)) > length(way) - 1e-4;
                });
            });
        if (!seen) ++hidden;
    }
    EXPECT_LT(hidden, asked / 50);
}

TEST(Building, NoiseIsNormalAndMovesNothingElse) {
    BuildingOptions noisy = small;
    noisy.noise_m = 0.002;
    const auto exact = points_of(small_building().cloud), moved = points_of(written(noisy).cloud);
    ASSERT_EQ(exact.size(), moved.size());
    double squares = 0, most = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
        ASSERT_EQ(exact[k].object, moved[k].object);
        const double error =
            std::hypot(exact[k].x - moved[k].x, exact[k].y - moved[k].y, exact[k].z - moved[k].z);
        squares += error * error;
        most = std::max(most, error);
    }
    const double deviation = std::sqrt(squares / static_cast<double>(exact.size()));
    EXPECT_NEAR(deviation, 0.002, 3e-5);  // six standard deviations
    EXPECT_LT(most, 6.01 * 0.002);
}

TEST(Building, SameFilesWithAnyNumberOfThreads) {
    BuildingOptions options = small;
    options.points = 30'333;  // a single room
    options.threads = 1;
    const Files one = written(options);
    options.threads = 3;
    const Files three = written(options);
    EXPECT_TRUE(one.cloud == three.cloud);
    EXPECT_EQ(one.truth, three.truth);
    options.seed = 4;
    EXPECT_FALSE(one.cloud == written(options).cloud);
}

class BuildingOf : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Furniture, BuildingOf, ::testing::Bool(),
                         [](const auto& kind) { return kind.param ? "varied" : "plain"; });

BuildingOptions twelve_rooms(bool varied) {
    BuildingOptions options = small;
    options.points = 366'000;
    options.storeys = 2;
    options.varied = varied;
    return options;
}

// At 1 m, straight from the middle of each room to that of the wall; both rooms' openings meet
// there.
TEST_P(BuildingOf, DoorsAreOpen) {
    const auto rooms = rooms_of(twelve_rooms(GetParam()));
    ASSERT_EQ(rooms.size(), 12u);
    std::size_t doors = 0;
    for (const Building::Room& room : rooms) {
        for (const Building::Door& door : room.doors) {
            ++doors;
            const std::size_t along = door.wall <= 2 ? 0 : 1, across = 1 - along;
            Vec3 p{};
            p[along] = (door.opening[0][along] + door.opening[1][along]) / 2;
            p[2] = 1;
            const double end =
                door.wall % 2 == 0 ? door.opening[1][across] : door.opening[0][across];
            for (int k = 0; k <= 100; ++k) {
                p[across] =
                    room.world.room[across] / 2 + k / 100.0 * (end - room.world.room[across] / 2);
                ASSERT_GT(room.world.distance(p).first, 0.3)
                    << "room " << room.id << " to " << door.to;
            }
            const auto& back = rooms[door.to].doors;
            const auto match = std::find_if(back.begin(), back.end(),
                                            [&](const auto& other) { return other.to == room.id; });
            ASSERT_NE(match, back.end());
            const std::size_t side = door.wall % 2 == 0 ? 1 : 0;
            EXPECT_NEAR(room.origin[across] + door.opening[side][across],
                        rooms[door.to].origin[across] + match->opening[1 - side][across], 1e-9);
            for (const std::size_t k : {along, std::size_t{2}}) {
                for (std::size_t c = 0; c < 2; ++c) {
                    EXPECT_NEAR(room.origin[k] + door.opening[c][k],
                                rooms[door.to].origin[k] + match->opening[c][k], 1e-9);
                }
            }
        }
    }
    EXPECT_EQ(doors, 2u * 2 * 7);  // two storeys of three by two rooms
}

TEST_P(BuildingOf, SolidsNeverOverlap) {
    for (const Building::Room& room : rooms_of(twelve_rooms(GetParam()))) {
        const auto& parts = room.world.parts;
        for (std::size_t a = 0; a < parts.size() && parts[a].object == 0; ++a) {
            for (std::size_t b = a + 1; b < parts.size(); ++b) {
                if (!overlap(parts[a].bounds(), parts[b].bounds(), -1e-9)) continue;
                EXPECT_GT(gap(parts[a], parts[b]), -1e-6)
                    << "room " << room.id << ": " << parts[a].name << " and " << parts[b].name;
            }
        }
    }
}

TEST_P(BuildingOf, StationsAreFree) {
    for (const Building::Room& room : rooms_of(twelve_rooms(GetParam()))) {
        for (const Vec3& station : room.stations)
            EXPECT_GT(room.world.distance(station).first, 0.05) << "room " << room.id;
    }
}

TEST(Building, StoreysStandOnOneAnother) {
    const auto rooms = rooms_of(twelve_rooms(false));
    for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_EQ(rooms[k].storey, 0u);
        EXPECT_EQ(rooms[k + 6].storey, 1u);
        EXPECT_EQ(rooms[k].origin[0], rooms[k + 6].origin[0]);
        EXPECT_DOUBLE_EQ(rooms[k + 6].origin[2], Building::storey_m);
        // The ceiling reaches up to the slab under the next floor.
        EXPECT_DOUBLE_EQ(rooms[k].world.parts[1].top(),
                         Building::storey_m + rooms[k + 6].world.parts[0].bottom());
    }
    BuildingOptions large = small;
    large.points = 2'750'000;  // 90 rooms
    EXPECT_EQ(Building(large).rooms(), 90u);
    EXPECT_EQ(Building(large).storeys(), 3u);
}

TEST(Building, IsReadAsACloud) {
    const TemporaryFolder folder("topple_building");
    std::ofstream(folder.path() / "b.ply", std::ios::binary) << small_building().cloud;
    const PointCloud cloud = io::read_cloud(folder.path() / "b.ply");
    const auto points = points_of(small_building().cloud);
    ASSERT_EQ(cloud.size(), points.size());
    EXPECT_EQ(cloud.y[1234], points[1234].y);
}

TEST(Building, LeavesNothingWhenItStops) {
    const TemporaryFolder folder("topple_building");
    std::size_t asked = 0;
    write_building(folder.path() / "b.ply", small,
                   [&](std::size_t, std::size_t) { return ++asked < 4; });
    EXPECT_EQ(asked, 4u);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    EXPECT_THROW(write_building(folder.path() / "none" / "b.ply", small, go_on), Error);
    std::filesystem::create_directory(folder.path() / "b.ply");
    EXPECT_THROW(write_building(folder.path() / "b.ply", small, go_on), Error);
}

TEST(Building, RefusesWhatMakesNoSense) {
    const auto message = [](const BuildingOptions& options) {
        return test::message_of([&] { const Building building(options); }, ErrorKind::usage);
    };
    BuildingOptions options;
    options.points = 0;
    EXPECT_THAT(message(options), ::testing::HasSubstr("--points 0"));
    options.points = 1;
    options.spacing_m = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(message(options), ::testing::HasSubstr("--spacing"));
    options.spacing_m = 0.005;
    options.storeys = 2;
    EXPECT_THAT(message(options), ::testing::HasSubstr("--storeys 2"));
    options = {};
    options.points = 1'000'000'000'000;
    EXPECT_THAT(message(options), ::testing::HasSubstr("rooms"));
}

}  // namespace
}  // namespace topple::scenes
