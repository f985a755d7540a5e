// SPDX-License-Identifier: MIT
#include "live/growing_folder.h"

#include <gtest/gtest.h>

#include "host/pipeline/scan.h"
#include "host/pipeline/small_walk.h"
#include "io/file_writer.h"
#include "lab/scan/files.h"

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
        return folder_.read(session_, most, [&](const char* line) { told_ = line; });
    }

    scenes::Sequence walk_;
    live::GrowingFolder folder_{path("scan")};
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
    EXPECT_NE(told_.find("no readings"), std::string::npos);
    EXPECT_EQ(session_.frames().size(), 2u);
    std::filesystem::remove(path("scan/depth/2.png"));
    write_poses(2);
    EXPECT_THROW(read(), Error);
}

}  // namespace
}  // namespace topple::test
