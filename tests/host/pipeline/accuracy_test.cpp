// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <ostream>

#include "host/pipeline/scan.h"

// How much of a room a parse must understand. The bounds lie well below what is reached, and well
// above what a parse that has gone wrong somewhere can reach.
namespace topple::test {
namespace {

struct RoomCase {
    std::uint64_t seed;
    double tilt_deg;
};
void PrintTo(const RoomCase& room, std::ostream* out) {
    *out << "seed " << room.seed << " tilt " << room.tilt_deg << " deg";
}

class SlowAccuracy : public Files, public ::testing::WithParamInterface<RoomCase> {};

TEST_P(SlowAccuracy, of_a_walk_through_a_room) {
    const Scan scan = scan_of_room(GetParam().seed, 30, GetParam().tilt_deg);
    scenes::write_sequence(path("scan"), scan.world, scan.sequence);
    const ParseResult result = parse(path("scan"), on(device::open_device("native")));
    const scenes::Score score = scenes::score(scan.world, result.scene);
    std::printf("part mIoU %.3f, object mIoU %.3f, gravity %.3f deg, volume %.3f / %.3f\n",
                score.parts.miou, score.objects.miou, score.gravity_deg,
                score.volume.precision.value, score.volume.recall.value);
    EXPECT_GE(score.parts.miou, 0.5);
    EXPECT_LE(score.gravity_deg, 2);
}

INSTANTIATE_TEST_SUITE_P(Rooms, SlowAccuracy, ::testing::Values(RoomCase{1, 0}, RoomCase{4, 12}),
                         [](const auto& room) { return "seed" + std::to_string(room.param.seed); });

using SingleFrame = Files;

TEST_F(SingleFrame, is_parsed_with_a_note) {
    const Scan scan = scan_of_room(2, 1);
    scenes::write_sequence(path("scan"), scan.world, scan.sequence);
    ASSERT_FALSE(std::filesystem::exists(path("scan/trajectory.txt")));
    const Scene scene = parse(path("scan"), on(device::open_device("native"))).scene;
    EXPECT_GT(scene.objects.size(), 1u);
    EXPECT_GT(scene.solid.x.size(), 1000u);
    bool noted = false;
    for (const std::string& note : scene.notes) noted |= note.find("single") != std::string::npos;
    EXPECT_TRUE(noted);
}

// Up may be given, and then counts instead of what the scan looks like.
TEST_F(SingleFrame, takes_the_up_that_is_given) {
    const Scan scan = scan_of_room(2, 1);
    ParseOptions options = on(device::open_device("native"));
    const Vec3 up = scan.world.to_input({0, 0, 1});
    options.up = up;
    const Scene scene = parse(scan.sequence.cloud, options).scene;
    EXPECT_EQ(scene.up_method, "given");
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(scene.up[c], up[c], 1e-6);
}

TEST(Options, out_of_range_are_named) {
    const auto named = [](const std::string& option, const auto& spoil) {
        ParseOptions options;
        spoil(options);
        try {
            check_options(options);
            ADD_FAILURE() << "no error for " << option;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            EXPECT_EQ(std::string(error.what()).find("ParseOptions::" + option), 0u)
                << error.what();
        }
    };
    check_options({});
    named("voxel_m", [](ParseOptions& o) { o.voxel_m = -1; });
    named("voxel_m", [](ParseOptions& o) { o.voxel_m = NAN; });
    named("density_kg_m3", [](ParseOptions& o) { o.density_kg_m3 = 0; });
    named("friction", [](ParseOptions& o) { o.friction = -1; });
    named("wind_m_s", [](ParseOptions& o) { o.wind_m_s = 1e9; });
    named("wind_from_deg", [](ParseOptions& o) { o.wind_from_deg = NAN; });
    named("pga_m_s2", [](ParseOptions& o) { o.pga_m_s2 = NAN; });
    named("accelerogram", [](ParseOptions& o) { o.accelerogram.emplace(); });
    named("accelerogram", [](ParseOptions& o) {
        o.accelerogram.emplace().m_s2 = {0, NAN, 1};
        o.accelerogram->step_s = 0.02;
    });
    named("grouping_time_s", [](ParseOptions& o) { o.grouping_time_s = -1; });
    named("disturbances flood", [](ParseOptions& o) { o.disturbances = {"human", "flood"}; });
}

}  // namespace
}  // namespace topple::test
