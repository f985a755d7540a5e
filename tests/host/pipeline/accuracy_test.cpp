// SPDX-License-Identifier: MIT
#include <clocale>
#include <locale>

#include "core/number_text.h"
#include "errors.h"
#include "host/pipeline/scan.h"
#include "io/text.h"
#include "result/scene_json.h"
#include "small_room.h"
#include "topple/kernel_testing/each_backend.h"

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

// Up may be given, and then counts instead of what the scan looks like.
TEST_F(SingleFrame, is_parsed_with_a_note_and_the_up_that_is_given) {
    const Scan scan = scan_of_room(2, 1);
    scenes::write_sequence(path("scan"), scan.world, scan.sequence);
    ASSERT_FALSE(std::filesystem::exists(path("scan/trajectory.txt")));
    ParseOptions options = on(device::open_device("native"));
    const Vec3 up = scan.world.to_input({0, 0, 1});
    options.up = up;
    const Scene scene = parse(path("scan"), options).scene;
    EXPECT_GT(scene.objects.size(), 1u);
    EXPECT_GT(scene.solid.x.size(), 1000u);
    EXPECT_THAT(scene.notes, testing::Contains(testing::HasSubstr("single")));
    EXPECT_EQ(scene.up_method, "given");
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(scene.up[c], up[c], 1e-6);
}

TEST(Options, out_of_range_are_named) {
    check_options({});
    const std::pair<const char*, std::function<void(ParseOptions&)>> cases[] = {
        {"voxel_m (--voxel)", [](ParseOptions& o) { o.voxel_m = -1; }},
        {"voxel_m (--voxel)", [](ParseOptions& o) { o.voxel_m = NAN; }},
        {"density_kg_m3 (--density)", [](ParseOptions& o) { o.density_kg_m3 = 0; }},
        {"friction (--friction)", [](ParseOptions& o) { o.friction = -1; }},
        {"wind_m_s (--wind)", [](ParseOptions& o) { o.wind_m_s = 1e9; }},
        {"grouping_time_s (--grouping-time)", [](ParseOptions& o) { o.grouping_time_s = -1; }},
        {"wind_from_deg (--wind-from)", [](ParseOptions& o) { o.wind_from_deg = NAN; }},
        {"pga_m_s2 (--pga)", [](ParseOptions& o) { o.pga_m_s2 = NAN; }},
        {"accelerogram (--accelerogram)", [](ParseOptions& o) { o.accelerogram.emplace(); }},
        {"accelerogram (--accelerogram)",
         [](ParseOptions& o) {
             o.accelerogram.emplace().step_s = 0.02;
             o.accelerogram->m_s2 = {0, NAN, 1};
         }},
        {"disturbances (--disturbance) flood", [](ParseOptions& o) {
             o.disturbances = {"human", "flood"};
         }}};
    for (const auto& [named, spoil] : cases) {
        ParseOptions options;
        spoil(options);
        EXPECT_THAT(message_of([&] { check_options(options); }, ErrorKind::usage),
                    testing::StartsWith(named));
    }
}

// A host program may have set any locale: what topple writes is the same.

// Of a language that writes 1.234,5, for C++'s streams and, where the system has it, for C.
class Abroad {
  public:
    Abroad()
        : before_(std::locale::global(std::locale(std::locale::classic(), new Punctuation))),
          c_(std::setlocale(LC_ALL, nullptr)) {
        for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "de_DE@euro"})
            if (std::setlocale(LC_ALL, name)) return;
    }
    ~Abroad() {
        std::locale::global(before_);
        std::setlocale(LC_ALL, c_.c_str());
    }
    Abroad(const Abroad&) = delete;
    Abroad& operator=(const Abroad&) = delete;

  private:
    struct Punctuation : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    std::locale before_;
    std::string c_;
};

std::string parsed() {
    ParseOptions options;
    options.device = device::open_device("native");
    options.walks = 20;
    Scene scene = parse(SmallRoom::scattered().cloud, options).scene;
    scene.timings_s.clear();
    return io::scene_json(scene);
}

TEST(Locale, OfTheHostDoesNotReachTheResult) {
    const std::string at_home = parsed();
    const Abroad abroad;
    EXPECT_EQ(parsed(), at_home);
    EXPECT_EQ(io::bytes_text(1'600'000'000), "1.49 GiB");
    EXPECT_EQ(io::two_digits(0.25), "0.25");
    EXPECT_EQ(to_places(1234.5, 1) + " " + to_digits(0.125, 2), "1234.5 0.12");
    double value = 0;
    EXPECT_TRUE(io::parse_number("1.5e-400", value));
    EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace topple::test
