// SPDX-License-Identifier: MIT
#include "scale/estimate.h"

#include <chrono>
#include <thread>

#include "core/process_memory.h"
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "pipeline/whole_progress.h"
#include "points/budget.h"
#include "points/parse_memory.h"
#include "points/scan_look.h"

namespace topple::test {
namespace {

class Estimates : public Files {
  protected:
    Estimate of(const Scan& scan, const char* name) const {
        scenes::write_sequence(path(name), scan.world, scan.sequence);
        return estimate(path(name), on(device::open_device("native")));
    }
};

TEST_F(Estimates, readings_that_one_frame_shows_are_no_space) {
    Scan scan = scan_of_room(3, 6);
    const Estimate clean = of(scan, "clean");
    const auto far = static_cast<std::uint16_t>(60 * scan.sequence.intrinsics.depth_scale);
    // Every third pixel is looked at.
    for (std::size_t n = 0; n < 3; ++n) scan.sequence.frames[2].depth[30 * n + 3] = far;
    const Estimate stray = of(scan, "stray");
    EXPECT_LT(static_cast<double>(stray.memory_bytes),
              1.05 * static_cast<double>(clean.memory_bytes));
    EXPECT_LT(static_cast<double>(stray.least_bytes),
              1.05 * static_cast<double>(clean.least_bytes));
}

TEST(ParseMemory, grows_with_points_and_with_the_surfaces_voxels) {
    const Bounds<float> room{{0, 0, 0}, {5, 4, 3}};
    const auto asked = [&](double points, double voxel_m) {
        return static_cast<double>(one_piece_bytes(points, 80, room, voxel_m));
    };
    EXPECT_GT(asked(1e5, 0.01), 2.5 * asked(1e5, 0.02));
    EXPECT_GT(asked(4e6, 0.02), 2 * asked(1e5, 0.02));
    const OnePiece parse{1e5, 80 / (0.02 * 0.02), 60 / (0.02 * 0.02 * 0.02), 20, 50, true};
    EXPECT_GT(asked(1e5, 0.02), 1.4 * one_piece_peak(parse));
}

// A level square of 4 m with a box of 0.5 m on it, turned by `degrees` about an upright axis.
PointCloud box_on_floor(double degrees, bool box) {
    const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
    PointCloud out;
    const auto add = [&](double x, double y, double z) {
        test::add(out, c * x - s * y, s * x + c * y, z);
    };
    const auto each = [](double edge, const auto& use) {
        for (double u = 0.01; u < edge; u += 0.02)
            for (double v = 0.01; v < edge; v += 0.02) use(u, v);
    };
    each(4, [&](double u, double v) { add(u - 2, v - 2, 0); });
    if (!box) return out;
    each(0.5, [&](double u, double v) {
        add(u, v, 0.5);
        for (const double side : {0.0, 0.5}) {
            add(side, u, v);
            add(u, side, v);
        }
    });
    return out;
}

TEST(ScanLook, spans_the_scene_along_its_own_axes) {
    const auto device = device::open_device("native");
    for (const double degrees : {0.0, 30.0}) {
        const ScanLook look = look_at_scan(*device, box_on_floor(degrees, true), 0.02, 17, {});
        EXPECT_NEAR(look.box.ground_m2, 16, 0.5) << degrees;
        EXPECT_NEAR(look.box.m3(), 8, 0.5) << degrees;
    }
}

TEST(ScanLook, counts_what_stands_there) {
    const auto device = device::open_device("native");
    const double floor = look_at_scan(*device, box_on_floor(0, false), 0.02, 16, {}).patches_m,
                 both = look_at_scan(*device, box_on_floor(0, true), 0.02, 17, {}).patches_m;
    EXPECT_NEAR(floor, 4, 0.5);
    EXPECT_NEAR(both, 4 + 5 * 0.5, 1);
}

}  // namespace
}  // namespace topple::test

namespace topple {
namespace {

TEST(Budget, IsByTheOptionsElseByTheInputAndTheMachine) {
    ParseOptions options;
    const std::uint64_t free = memory_left();
    EXPECT_GT(free, 0U);
    EXPECT_EQ(Budget::current(), nullptr);
    for (const auto& [input, most] :
         {std::pair{std::uint64_t{134}, 2e9}, {1'000'000, 2e9}, {1'000'001, 4e9}}) {
        const Budget budget("scan", input, options);
        EXPECT_EQ(Budget::current(), &budget);
        EXPECT_LE(static_cast<double>(budget.bytes()), most);
        EXPECT_FALSE(budget.asked());
    }
    options.max_memory_bytes = 1 << 20;
    const Budget asked("scan", 134, options);
    EXPECT_EQ(asked.bytes(), options.max_memory_bytes);
    EXPECT_TRUE(asked.asked());
    EXPECT_EQ(memory_bound_text(options), "1 MiB of max_memory_bytes (--max-memory)");
    EXPECT_NO_THROW(asked.check("it takes", 1 << 20, "take less"));
    EXPECT_THROW(asked.check("it takes", (1 << 20) + 1, "take less"), Error);
}

TEST(Budget, EndsWhatTakesMoreWhereItPolls) {
    ParseOptions options;
    options.max_memory_bytes = Budget::least_bytes;
    Budget budget("scan", 134, options);
    const ParseOptions polled = budget.polled();
    const auto poll = [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return polled.cancelled();
    };
    polled.progress("filling", 0);
    EXPECT_FALSE(poll());
    const std::vector<char> taken(2 * Budget::least_bytes, 1);
    EXPECT_THAT(test::message_of(poll, std::nullopt),
                testing::StartsWith("scan: in the stage \"filling\" its points take more than the "
                                    "256 MiB of max_memory_bytes (--max-memory)"))
        << taken.size();
}

TEST(Budget, TellsOnceOfWorkThatIsLongForItsInput) {
    std::vector<std::string> told;
    ParseOptions options;
    options.notice = [&](const std::string& line) { told.push_back(line); };
    Budget budget("scan", 134, options);
    budget.begin_work("9 voxels", "use fewer", 5);
    EXPECT_TRUE(told.empty());
    for (int n = 0; n < 2; ++n) budget.begin_work("9 voxels", "use fewer", 630);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NE(told[0].find("scan: 9 voxels take about 11 min of"), std::string::npos) << told[0];
}

}  // namespace
}  // namespace topple

namespace topple::test {
namespace {

using Told = std::vector<std::pair<std::string, double>>;

void expect_rising(const Told& told) {
    ASSERT_FALSE(told.empty());
    for (std::size_t n = 1; n < told.size(); ++n)
        EXPECT_GE(told[n].second, told[n - 1].second) << told[n].first;
    EXPECT_GE(told.front().second, 0);
    EXPECT_EQ(told.back().second, 1);
}

ParseOptions telling(Told& told) {
    ParseOptions options;
    options.device = device::open_device("native", 2);
    options.progress = [&](const std::string& stage, double done) {
        told.emplace_back(stage, done);
    };
    return options;
}

TEST(WholeProgress, RisesOverTheStagesOfAParse) {
    Told told;
    ParseOptions options = telling(told);
    options.disturbances = {"wind"};
    const ParseResult result = parse(SmallRoom::scattered().cloud, options);
    expect_rising(told);
    // A stage takes the share that it takes of typical parses: most are seen to have some.
    std::size_t moved = 0;
    for (std::size_t n = 1; n < told.size(); ++n) moved += told[n].second > told[n - 1].second;
    EXPECT_GT(moved, result.scene.timings_s.size() / 2);
    for (const auto& [stage, seconds] : result.scene.timings_s)
        EXPECT_TRUE(std::ranges::find(told, stage, &Told::value_type::first) != told.end());
}

TEST(WholeProgress, GoesOnWhereStagesAreSkippedOrUnknown) {
    ParseOptions options;
    options.disturbances = {};
    WholeProgress whole(WholeProgress::Input::frames, options);
    const double early = whole("cache", 1), grouping = whole("grouping", 0);
    EXPECT_LT(early, 0.1);
    EXPECT_EQ(grouping, early);
    const double half = whole("grouping", 0.5);
    EXPECT_GT(half, grouping);
    EXPECT_EQ(whole("grouping", 0.2), half);
    EXPECT_EQ(whole("grouping", -1e9), half);
    EXPECT_GE(whole("polishing", 0.9), half);
    const double late = whole("risk", 0);
    EXPECT_GT(late, half);
    EXPECT_LT(late, 1);
    const double again = whole("grouping", 0);  // risk is done by now
    EXPECT_GE(again, late);
    EXPECT_EQ(whole("grouping", 1), again);
    EXPECT_EQ(whole("assembly", 0), again);
    EXPECT_NEAR(whole("assembly", 7), 1, 1e-12);
}

// Of a cloud that turns out to be small after it was sorted, and of one that is parsed in blocks.
TEST(WholeProgress, CloudsInBlocksHaveStagesOfTheirOwn) {
    WholeProgress small(WholeProgress::Input::cloud, {}), large(WholeProgress::Input::cloud, {});
    EXPECT_EQ(small("sorting", 0), 0);
    const double sorted = large("sorting", 1);
    EXPECT_GT(sorted, 0);
    EXPECT_EQ(small("sorting", 1), sorted);
    EXPECT_GT(small("ingest", 0.5), sorted);
    EXPECT_GT(large("blocks", 1) - sorted, 0.3);
    EXPECT_LT(large("bodies", 0), 1);
}

}  // namespace
}  // namespace topple::test
