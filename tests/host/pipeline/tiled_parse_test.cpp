// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/read_cloud.h"
#include "scenes/building.h"
#include "scenes/temporary_folder.h"
#include "topple/parse.h"

namespace topple {
namespace {

namespace fs = std::filesystem;

// Two rooms with a door, sparse enough that the test takes seconds.
const fs::path& building() {
    static const scenes::TemporaryFolder folder;
    static const fs::path cloud = [] {
        const fs::path file = folder.path() / "building.ply";
        scenes::write_building(file, {.seed = 4, .points = 350'000, .spacing_m = 0.025},
                               [](std::size_t, std::size_t) { return true; });
        return file;
    }();
    return cloud;
}

ParseOptions coarse() {
    ParseOptions options;
    options.voxel_m = 0.05;
    options.tile_m = 3.2;
    options.disturbances = {"human", "wind"};
    options.walks = 50;
    return options;
}

// What must be the same: all but times and where the work was done.
struct Output {
    std::string points, solid;
    std::vector<double> figures;
    std::vector<std::int32_t> object_of_primitive;
    bool operator==(const Output&) const = default;
};

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

Output output_of(const ParseResult& result) {
    scenes::TemporaryFolder folder;
    write_outputs(result, folder.path() / "out");
    Output out{text_of(folder.path() / "out/points.ply"),
               text_of(folder.path() / "out/solid.ply"),
               {},
               {}};
    for (const Primitive& p : result.scene.primitives) out.object_of_primitive.push_back(p.object);
    for (const Object& o : result.scene.objects) {
        out.figures.insert(out.figures.end(), {o.mass_kg, o.barrier_J, o.release_J});
        for (const auto& [name, risk] : o.risk_J) out.figures.push_back(risk);
    }
    return out;
}

class SlowTiles : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        result_ = new ParseResult(parse(building(), coarse()));
        output_ = new Output(output_of(*result_));
    }
    static void TearDownTestSuite() {
        delete result_;
        delete output_;
    }
    static inline const ParseResult* result_ = nullptr;
    static inline const Output* output_ = nullptr;
};

TEST_F(SlowTiles, EveryPointComesBackInItsPlace) {
    scenes::TemporaryFolder folder;
    write_outputs(parse(building(), coarse()), folder.path() / "out");
    const PointCloud in = io::read_cloud(building());
    const PointCloud out = io::read_cloud(folder.path() / "out/points.ply");
    EXPECT_EQ(in.x, out.x);
    EXPECT_EQ(in.y, out.y);
    EXPECT_EQ(in.z, out.z);
    std::uint64_t labelled = 0;
    for (const Primitive& p : result_->scene.primitives) labelled += p.points;
    EXPECT_GT(static_cast<double>(labelled), 0.97 * static_cast<double>(in.size()));
    EXPECT_LE(labelled, in.size());
    EXPECT_TRUE(fs::exists(folder.path() / "out/volume.vdb"));
    EXPECT_TRUE(fs::exists(folder.path() / "out/report.html"));
}

TEST_F(SlowTiles, MemoryAndThreadsChangeNothing) {
    ParseOptions options = coarse();
    options.device = device::open_device("native", 1);
    options.max_memory_bytes = std::uint64_t{700} << 20;
    EXPECT_TRUE(output_of(parse(building(), options)) == *output_);
}

TEST_F(SlowTiles, AStoppedRunGoesOnWhereItWas) {
    scenes::TemporaryFolder folder;
    ParseOptions options = coarse();
    options.work_folder = folder.path() / "work";
    // Stops within the blocks: the next run finds some of them done.
    std::string stage;
    double done = 0;
    options.progress = [&](const std::string& name, double share) { stage = name, done = share; };
    options.cancelled = [&] { return stage == "blocks" && done > 0.3; };
    EXPECT_THROW(parse(building(), options), Error);
    const auto blocks = [&] {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(options.work_folder))
            if (entry.path().filename().string().starts_with("block-")) found.push_back(entry);
        std::ranges::sort(found);
        return found;
    };
    const std::vector<fs::path> before = blocks();
    ASSERT_FALSE(before.empty());
    const auto written = fs::last_write_time(before.front());
    options.cancelled = nullptr;
    const ParseResult resumed = parse(building(), options);
    EXPECT_GT(blocks().size(), before.size());
    EXPECT_EQ(fs::last_write_time(before.front()), written);
    EXPECT_TRUE(output_of(resumed) == *output_);
    EXPECT_FALSE(fs::exists(options.work_folder));
}

// Objects by the scanned points that they hold: those of one parse that another has as well.
double share_found(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b,
                   std::uint64_t least_points) {
    std::map<std::int32_t, std::uint64_t> of_a, of_b;
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t> both;
    for (std::size_t n = 0; n < a.size(); ++n) {
        ++of_a[a[n]];
        ++of_b[b[n]];
        ++both[{a[n], b[n]}];
    }
    std::uint64_t objects = 0, found = 0;
    for (const auto& [object, points] : of_a) {
        if (object < 0 || points < least_points) continue;
        ++objects;
        for (const auto& [pair, shared] : both) {
            if (pair.first != object) continue;
            const std::uint64_t all = points + of_b[pair.second] - shared;
            if (static_cast<double>(shared) > 0.7 * static_cast<double>(all)) {
                ++found;
                break;
            }
        }
    }
    return objects ? static_cast<double>(found) / static_cast<double>(objects) : 0;
}

TEST_F(SlowTiles, OneTileAndManyFindTheSameObjects) {
    ParseOptions options = coarse();
    options.tile_m = 100;
    const ParseResult whole = parse(building(), options);
    ASSERT_EQ(whole.scene.points.x, result_->scene.points.x);
    EXPECT_GE(share_found(whole.scene.points.object, result_->scene.points.object, 300), 0.8);
    EXPECT_GE(share_found(result_->scene.points.object, whole.scene.points.object, 300), 0.8);
}

}  // namespace
}  // namespace topple
