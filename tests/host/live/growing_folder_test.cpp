// SPDX-License-Identifier: MIT
#include "live/growing_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/pipeline/scan.h"
#include "host/pipeline/small_walk.h"
#include "io/file_writer.h"
#include "lab/scan/files.h"
#include "points/formats/frame_sequence.h"

// A folder of frames that another program is writing.
namespace topple::test {
namespace {

class GrowingFolders : public Files {
  protected:
    GrowingFolders() : walk_(small_walk()) { scenes::make_folder(path("scan/depth")); }
    void write_frame(std::size_t n) const {
        scenes::write_depth_png(path("scan/depth/" + std::to_string(n) + ".png"), 96,
                                walk_.frames[n].depth);
    }
    void write_poses(std::size_t count, double x_m = 0) const {
        std::string text;
        for (std::size_t n = 0; n < count; ++n)
            for (std::size_t k = 0; k < 12; ++k)
                text += std::to_string(walk_.frames[n].camera_to_world[k] + (k == 3 ? x_m : 0)) +
                        (k == 11 ? "\n" : " ");
        io::write_file(path("scan/poses.txt"), text);
    }
    bool read(std::size_t most = 100) {
        return folder_.read(session_, {most, false, [&](const auto& line) { told_ += line; }});
    }
    bool read_last() {
        return folder_.read(session_, {100, true, [&](const auto& line) { told_ += line; }});
    }

    scenes::Sequence walk_;
    live::GrowingFolder folder_{path("scan"), live::GrowingFolder::Clock::duration::zero()};
    Session session_{walk_.intrinsics};
    std::string told_;
};

TEST_F(GrowingFolders, FramesComeAndPosesAreCorrected) {
    EXPECT_FALSE(folder_.intrinsics());
    EXPECT_FALSE(folder_.waits_for().empty());
    write_frame(0);
    write_frame(1);
    io::write_file(path("scan/intrinsics.json"), scenes::intrinsics_text(walk_.intrinsics));
    EXPECT_FALSE(read());  // poses are missing
    write_poses(2);
    ASSERT_TRUE(folder_.intrinsics());
    EXPECT_EQ(folder_.intrinsics()->width, 96u);
    EXPECT_TRUE(read());
    EXPECT_EQ(session_.frames(), (std::vector<FrameId>{0, 1}));
    EXPECT_FALSE(read());  // nothing new
    EXPECT_TRUE(folder_.waits_for().empty());

    // An image that is being written, a pose that is missing: not yet.
    write_frame(2);
    EXPECT_FALSE(read());
    EXPECT_NE(folder_.waits_for().find("2 poses for 3 depth images"), std::string::npos);
    write_poses(3);
    io::write_file(path("scan/depth/2.png"), "\x89PNG");
    EXPECT_FALSE(read());
    EXPECT_FALSE(folder_.waits_for().empty());
    write_frame(2);
    for (std::size_t n = 3; n < 6; ++n) write_frame(n);
    write_poses(6);
    EXPECT_TRUE(read(2));
    EXPECT_EQ(session_.frames().size(), 4u);
    EXPECT_TRUE(read());
    EXPECT_EQ(session_.frames().size(), 6u);
    write_poses(6, 0.5);
    EXPECT_TRUE(read());
    EXPECT_FALSE(read());
    EXPECT_EQ(told_, "");
}

TEST_F(GrowingFolders, ADarkFrameIsLeftOutAndNoneMayGo) {
    io::write_file(path("scan/intrinsics.json"), scenes::intrinsics_text(walk_.intrinsics));
    for (const std::size_t n : {0, 1, 2}) write_frame(n);
    scenes::write_depth_png(path("scan/depth/1.png"), 96,
                            std::vector<std::uint16_t>(std::size_t{96} * 72));
    write_poses(3);
    EXPECT_TRUE(read());
    EXPECT_NE(told_.find("depth/1.png: frame 1: it has no readings"), std::string::npos) << told_;
    EXPECT_EQ(folder_.missing_from("out"), "");
    EXPECT_EQ(session_.frames().size(), 2u);
    std::filesystem::remove(path("scan/depth/2.png"));
    write_poses(2);
    EXPECT_THROW(read(), Error);
}

// One that is still being written grows, or is the last one.
TEST_F(GrowingFolders, ADamagedImageIsLeftOutAndThoseBehindItKeepTheirPoses) {
    io::write_file(path("scan/intrinsics.json"), scenes::intrinsics_text(walk_.intrinsics));
    for (const std::size_t n : {0, 1}) write_frame(n);
    const std::string whole = bytes_of_file(path("scan/depth/1.png"));
    const auto cut_to = [&](std::size_t bytes) {
        io::write_file(path("scan/depth/1.png"), whole.substr(0, bytes));
    };
    cut_to(500);
    write_poses(2);
    EXPECT_TRUE(read());
    for (int looks = 0; looks < 3; ++looks) EXPECT_FALSE(read()) << "none is behind it";
    write_frame(2);
    write_poses(3);
    cut_to(600);
    EXPECT_FALSE(read()) << "it has grown";
    EXPECT_NE(folder_.waits_for().find("1.png"), std::string::npos);
    EXPECT_EQ(told_, "");
    EXPECT_TRUE(read());
    EXPECT_EQ(session_.frames(), (std::vector<FrameId>{0, 2}));
    EXPECT_NE(told_.find("depth/1.png: is cut short"), std::string::npos) << told_;
    EXPECT_TRUE(folder_.waits_for().empty());
    EXPECT_TRUE(folder_.missing_from("out").ends_with("; 1 damaged image of 3 left out of out"));
    told_.clear();
    EXPECT_FALSE(read());
    EXPECT_EQ(told_, "") << "it is told once";
    // The third image has the third line.
    const std::vector<Mat4> poses = io::FrameSequence::open(path("scan")).poses();
    FramesView same = frames_view_of(walk_);
    same.images = {same.images[0], same.images[2]};
    same.camera_to_world = {poses[0], poses[2]};
    EXPECT_EQ(session_.update()->result->scene.points.x, parse(same).scene.points.x);
}

TEST_F(GrowingFolders, NobodyWritesAnyMoreWhereItEnds) {
    io::write_file(path("scan/intrinsics.json"), scenes::intrinsics_text(walk_.intrinsics));
    for (const std::size_t n : {0, 1, 2}) write_frame(n);
    for (const char* name : {"scan/depth/0.png", "scan/depth/2.png"})
        io::write_file(path(name), "\x89PNG");
    write_poses(3);
    EXPECT_TRUE(read_last());
    EXPECT_FALSE(read_last());
    EXPECT_EQ(session_.frames().size(), 1u);
    const std::string missing = folder_.missing_from("out");
    EXPECT_NE(missing.find("0.png"), std::string::npos) << missing;
    EXPECT_TRUE(missing.ends_with("; 2 damaged images of 3 left out of out")) << missing;
}

TEST_F(GrowingFolders, GoOnFromACheckpointWithTheSameNumbersAndIds) {
    io::write_file(path("scan/intrinsics.json"), scenes::intrinsics_text(walk_.intrinsics));
    for (const std::size_t n : {0, 1, 2, 3}) write_frame(n);
    scenes::write_depth_png(path("scan/depth/1.png"), 96,
                            std::vector<std::uint16_t>(std::size_t{96} * 72));
    write_poses(4);
    SessionOptions options;
    options.parse.disturbances.clear();
    const auto file = path("room.session");
    const auto first = folder_.begin(options, file);
    ASSERT_TRUE(first);
    folder_.read(*first, {});
    const auto before = first->update();
    first->checkpoint(file);

    // Poses were corrected, and another frame came, meanwhile.
    write_frame(4);
    write_poses(5, 0.5);
    live::GrowingFolder again(path("scan"));
    const auto second = again.begin(options, file);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->frames(), (std::vector<FrameId>{0, 2, 3}));
    EXPECT_TRUE(again.read(*second, {}));
    EXPECT_FALSE(again.read(*second, {}));
    EXPECT_EQ(second->frames(), (std::vector<FrameId>{0, 2, 3, 4}));
    std::set<ThingId> known, kept;
    for (const Thing& thing : before->things) known.insert(thing.id);
    for (const Thing& thing : second->update()->things)
        if (thing.change == Change::none) kept.insert(thing.id);
    EXPECT_GE(kept.size(), 2u);
    EXPECT_TRUE(std::ranges::includes(known, kept));

    Intrinsics other = walk_.intrinsics;
    other.fx += 1;
    io::write_file(path("scan/intrinsics.json"), scenes::intrinsics_text(other));
    expect_input_error([&] { again.begin(options, file); },
                       {"room.session: is of another camera than what comes now"});
}

}  // namespace
}  // namespace topple::test
