// SPDX-License-Identifier: MIT
#include "scale/work_folder.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clouds.h"
#include "errors.h"
#include "host/io/files.h"
#include "lab/temporary_folder.h"
#include "scale/binary_file.h"
#include "scale/point_spill.h"
#include "scale/thinned_bin.h"
#include "scale/work_files.h"

namespace topple::tiles {
namespace {

namespace fs = std::filesystem;

class WorkFolders : public ::testing::Test {
  protected:
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
    }
    void put_block(const std::string& name) const {
        BinaryWriter out(path_ / name);
        out(std::vector<int>{1, 2, 3});
        out.finish();
    }
    // Makes the folder as a run leaves it that was killed.
    void leave(const std::string& manifest) const {
        const WorkFolder work(path_, manifest);
        put_block("block-0");
    }
    // The folder is refused, and all in it stays.
    void expect_refused(const std::string& says) const {
        const std::set<std::string> before = names_in(path_);
        test::expect_input_error([&] { const WorkFolder work(path_, "cloud"); }, {says});
        EXPECT_EQ(names_in(path_), before);
    }

    const scenes::TemporaryFolder outer_{"topple_tiles"};
    const fs::path path_ = outer_.path() / "work";
};

TEST_F(WorkFolders, AreTakenUpByTheSameManifestOnly) {
    leave("cloud 1");
    {
        const WorkFolder again(path_, "cloud 1");
        EXPECT_TRUE(again.taken_up());
        EXPECT_TRUE(again.has("block-0"));
        EXPECT_TRUE(again.damaged().empty());
    }
    WorkFolder other(path_, "cloud 2");
    EXPECT_FALSE(other.taken_up());
    EXPECT_FALSE(other.has("block-0"));
    other.finished();
}

TEST_F(WorkFolders, GoWhenAllIsWritten) {
    {
        WorkFolder work(path_, "cloud");
        work.finished();
    }
    EXPECT_FALSE(fs::exists(path_));
    fs::path temporary;
    {
        const WorkFolder work({}, "cloud");
        temporary = work.path();
        EXPECT_TRUE(fs::exists(temporary));
    }
    EXPECT_FALSE(fs::exists(temporary));
}

TEST_F(WorkFolders, AreNobodyElses) {
    leave("cloud");
    EXPECT_EQ(fs::status(path_).permissions(), fs::perms::owner_all);
}

TEST_F(WorkFolders, LeaveWhatIsNotOurs) {
    fs::create_directory(path_);
    put("thesis.tex", "x");
    expect_refused("thesis.tex");
    // Whatever the manifest says.
    fs::remove(path_ / "thesis.tex");
    leave("other cloud");
    put("thesis.tex", "x");
    expect_refused("thesis.tex");
    EXPECT_EQ(test::bytes_of_file(path_ / "thesis.tex"), "x");
}

// By their names alone files without a manifest are not ours.
TEST_F(WorkFolders, LeaveFilesWithoutOurMark) {
    fs::create_directory(path_);
    put("block-3", "my own notes on block 3");
    expect_refused("block-3");
    EXPECT_EQ(test::bytes_of_file(path_ / "block-3"), "my own notes on block 3");
}

TEST_F(WorkFolders, LeaveLinksAlone) {
    const fs::path elsewhere = outer_.path() / "elsewhere";
    fs::create_directory(elsewhere);
    std::ofstream(elsewhere / "block-0") << "x";
    fs::create_directory_symlink(elsewhere, path_);
    EXPECT_THROW(WorkFolder(path_, "cloud"), Error);
    EXPECT_TRUE(fs::exists(elsewhere / "block-0"));
    fs::remove(path_);
    leave("cloud");
    fs::create_symlink(elsewhere / "block-0", path_ / "block-1");
    expect_refused("block-1");
    EXPECT_EQ(test::bytes_of_file(elsewhere / "block-0"), "x");
}

// As a full disk leaves it, or a bit that turned.
TEST_F(WorkFolders, BeginAnewWhereTheManifestIsDamaged) {
    for (const char* manifest : {"", "topple.wor", "Topple.work/2\ncloud\n"}) {
        leave("cloud");
        put(manifest_name, manifest);
        WorkFolder work(path_, "cloud");
        EXPECT_FALSE(work.taken_up());
        EXPECT_FALSE(work.has("block-0"));
        work.finished();
    }
}

TEST_F(WorkFolders, AreWorkedInByOneProcessAtATime) {
    const WorkFolder mine(path_, "cloud");
    expect_refused("(process " + std::to_string(::getpid()) + ")");
    // Who is killed leaves no lock.
    const fs::path path = outer_.path() / "killed";
    const pid_t child = ::fork();
    if (child == 0) {
        const WorkFolder theirs(path, "cloud");
        ::raise(SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_TRUE(WorkFolder(path, "cloud").taken_up());
}

// Bytes all over every file in turn: what is damaged is told, and gone with what belongs to it; all
// else stays, and none is read as if nothing were.
TEST_F(WorkFolders, TellWhatIsDamaged) {
    {
        const WorkFolder work(path_, "cloud");
        put_block("block-0");
        PointSpill spill(path_, 1 << 20);
        PointCloud cloud;
        for (int n = 0; n < 20; ++n) {
            test::add(cloud, 0.1f * static_cast<float>(n), 1, 2);
            cloud.red.push_back(static_cast<std::uint8_t>(n + 1));
            cloud.green.push_back(2);
            cloud.blue.push_back(3);
        }
        spill.add(cloud, "cloud");
        spill.finish();
        thin_bin(SpilledPoints(path_), 0, 0.5, path_);
    }
    const fs::path whole = outer_.path() / "whole";
    fs::copy(path_, whole);
    const std::set<std::string> all = names_in(whole);
    ASSERT_EQ(all.size(), 8u);
    for (const std::string& name : all) {
        if (name == manifest_name || name == FolderLock::file_name) continue;
        const std::string text = test::bytes_of_file(whole / name);
        const bool of_bin = name.find("0_0_0") != std::string::npos;
        const std::string told = of_bin                   ? "cells-0_0_0"
                                 : name.ends_with(".bin") ? "bins.bin"
                                                          : name;
        // One bit of a byte, a byte too few, a byte too many.
        for (std::size_t n = 0; n < text.size() + 2; n += n < text.size() - 9 ? 7 : 1) {
            std::string bad = text;
            if (n < text.size()) {
                bad[n] = static_cast<char>(bad[n] ^ (1 << n % 8));
            } else if (n == text.size()) {
                bad.pop_back();
            } else {
                bad += "x";
            }
            fs::remove_all(path_);
            fs::copy(whole, path_);
            put(name, bad);
            const WorkFolder work(path_, "cloud");
            ASSERT_TRUE(work.taken_up());
            ASSERT_EQ(work.damaged(), std::vector<std::string>{told}) << name << " byte " << n;
            ASSERT_FALSE(work.has(told));
            ASSERT_EQ(work.has("block-0"), told != "block-0");
            ASSERT_EQ(work.has("cells-0_0_0"), !of_bin);
        }
        // The reader sees it, too, where the damage comes later.
        fs::remove_all(path_);
        fs::copy(whole, path_);
        std::string bad = text;
        bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
        put(name, bad);
        if (!name.ends_with(".bin")) {
            EXPECT_THROW(BinaryReader(path_ / name), Error);
        } else {
            EXPECT_THROW(
                SpilledPoints(path_).read(0, [](std::span<const Point>, std::span<const Rgb8>) {}),
                Error)
                << name;
        }
    }
}

// What a killed run was just writing is no damage.
TEST_F(WorkFolders, SayNothingOfUnfinishedFiles) {
    leave("cloud");
    put("block-1.part", "topple.w half");
    put("numbers-1_0_0", "topple.w half");
    const WorkFolder again(path_, "cloud");
    EXPECT_TRUE(again.damaged().empty());
    EXPECT_FALSE(again.has("block-1.part"));
    EXPECT_TRUE(again.has("block-0"));
}

}  // namespace
}  // namespace topple::tiles
