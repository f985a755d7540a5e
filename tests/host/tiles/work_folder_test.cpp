// SPDX-License-Identifier: MIT
#include "tiles/work_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenes/temporary_folder.h"
#include "topple/error.h"

namespace topple::tiles {
namespace {

TEST(WorkFolder, IsTakenUpByTheSameManifestOnly) {
    scenes::TemporaryFolder outer("topple_tiles");
    const auto path = outer.path() / "work";
    {
        const WorkFolder first(path, "cloud 1");
        EXPECT_FALSE(first.taken_up());
        std::ofstream(path / "done") << "x";
    }
    {
        const WorkFolder again(path, "cloud 1");
        EXPECT_TRUE(again.taken_up());
        EXPECT_TRUE(again.has("done"));
    }
    WorkFolder other(path, "cloud 2");
    EXPECT_FALSE(other.taken_up());
    EXPECT_FALSE(other.has("done"));
    other.finished();
}

TEST(WorkFolder, GoesWhenAllIsWritten) {
    scenes::TemporaryFolder outer("topple_tiles");
    const auto path = outer.path() / "work";
    {
        WorkFolder work(path, "cloud");
        work.finished();
    }
    EXPECT_FALSE(std::filesystem::exists(path));
    std::filesystem::path temporary;
    {
        const WorkFolder work({}, "cloud");
        temporary = work.path();
        EXPECT_TRUE(std::filesystem::exists(temporary));
    }
    EXPECT_FALSE(std::filesystem::exists(temporary));
}

TEST(WorkFolder, LeavesWhatIsNotOurs) {
    scenes::TemporaryFolder folder("topple_tiles");
    std::ofstream(folder.path() / "thesis.tex") << "x";
    EXPECT_THROW(WorkFolder(folder.path(), "cloud"), Error);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "thesis.tex"));
}

}  // namespace
}  // namespace topple::tiles
