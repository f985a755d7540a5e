// SPDX-License-Identifier: MIT
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "lab/rooms/building.h"
#include "lab/temporary_folder.h"

// topple-mpi as a job of several ranks on this machine.
namespace topple::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// A room, sparse enough for seconds, and what one process makes of it.
const fs::path& room() {
    static const scenes::TemporaryFolder folder("topple_mpi");
    static const fs::path cloud = [] {
        const fs::path file = folder.path() / "room.ply";
        scenes::write_building(file, {.points = 170'000, .spacing_m = 0.05},
                               [](std::size_t, std::size_t) { return true; });
        return file;
    }();
    return cloud;
}

class Job : public Program {
  protected:
    void SetUp() override {
#ifndef TOPPLE_MPI
        const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");
        if (required && std::string(required) == "1") FAIL() << "topple-mpi was not built";
        GTEST_SKIP() << "topple-mpi was not built: MPI is missing";
#endif
    }

    static Words ranks(int count, const Words& arguments, const Words& for_mpirun = {}) {
        Words words{"-n", std::to_string(count)};
        words.insert(words.end(), for_mpirun.begin(), for_mpirun.end());
#ifdef TOPPLE_MPI
        words.emplace_back(TOPPLE_MPI);
#endif
        words.insert(words.end(), arguments.begin(), arguments.end());
        return words;
    }
    static Words parse(const std::string& out, const std::string& tile = "5") {
        return {"parse", room().string(), "-o", out,         "--tile",
                tile,    "--walks",       "20", "--backend", "native"};
    }
    // The first words run beside the second ones, as one job.
    Finished job(const Words& first, const Words& second = {},
                 const std::function<int(const std::string&)>& interrupt = {}) const {
        Words words{"--allow-run-as-root", "--oversubscribe", "--bind-to", "none"};
        words.insert(words.end(), first.begin(), first.end());
        if (!second.empty()) words.emplace_back(":");
        words.insert(words.end(), second.begin(), second.end());
        return run(words, interrupt);
    }

    // All that must not depend on who did what.
    struct Output {
        nlohmann::json scene;
        std::string points, solid;
        bool operator==(const Output&) const = default;
    };
    Output output(const std::string& out) const {
        Output result{nlohmann::json::parse(bytes_of_file(in(out) / "scene.json")),
                      bytes_of_file(in(out) / "points.ply"), bytes_of_file(in(out) / "solid.ply")};
        result.scene.erase("timings_s");
        return result;
    }
    // Of one process. TOPPLE_ALONE knows nothing of MPI, but can be a job's only rank.
    const Output& alone() const {
        static const Output result = [&] {
            Words words{"-n", "1", TOPPLE_ALONE};
            const Words arguments = parse("alone");
            words.insert(words.end(), arguments.begin(), arguments.end());
            EXPECT_EQ(job(words).code, 0);
            return output("alone");
        }();
        return result;
    }

    // The failure's one line, once; the rest of stderr is mpirun's.
    static void expect_told(const Finished& job, int code, const Words& parts) {
        EXPECT_EQ(job.code, code) << job.err;
        const auto first = job.err.find("topple: ");
        ASSERT_NE(first, std::string::npos) << job.err;
        EXPECT_EQ(job.err.find("topple: ", first + 1), std::string::npos) << job.err;
        const std::string line = job.err.substr(first, job.err.find('\n', first) - first);
        for (const auto& part : parts) EXPECT_THAT(line, testing::HasSubstr(part));
    }

    fs::path work() const {
        return in(".out.topple-work");
    }
    std::vector<fs::path> files(const std::string& beginning) const {
        std::vector<fs::path> found;
        std::error_code error;
        for (fs::directory_iterator at(work(), error), end; !error && at != end;
             at.increment(error)) {
            const std::string name = at->path().filename().string();
            if (name.starts_with(beginning) && !name.ends_with(".part"))
                found.push_back(at->path());
        }
        std::ranges::sort(found);
        return found;
    }

    // The process of this test's job that is this rank, or 0.
    pid_t process_of(int rank) const {
        std::error_code error;
        const std::string wanted = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
        for (fs::directory_iterator at("/proc", error), end; !error && at != end;
             at.increment(error)) {
            const std::string name = at->path().filename().string();
            if (name.find_first_not_of("0123456789") != std::string::npos) continue;
            std::error_code gone;
            if (fs::read_symlink(at->path() / "cwd", gone) != path("work")) continue;
            const std::string all = bytes_of_file(at->path() / "environ");
            for (std::size_t from = 0; from < all.size(); from += std::strlen(&all[from]) + 1)
                if (wanted == &all[from]) return static_cast<pid_t>(std::stol(name));
        }
        return 0;
    }
};

TEST_F(Job, ranks_give_what_one_process_gives) {
    const Finished finished = job(ranks(3, parse("out")));
    EXPECT_EQ(finished.code, 0) << finished.err;
    // Only the leader speaks.
    const auto once = finished.out.find("Report: ");
    EXPECT_NE(once, std::string::npos) << finished.out;
    EXPECT_EQ(finished.out.find("Report: ", once + 1), std::string::npos) << finished.out;
    EXPECT_EQ(finished.err.find("blocks: "), finished.err.rfind("blocks: ")) << finished.err;
    EXPECT_TRUE(output("out") == alone());
    EXPECT_FALSE(fs::exists(work()));
}

TEST_F(Job, wrong_usage_is_told_once) {
    expect_told(job(ranks(3, parse("out", "0.1"))), 2, {"tile_m (--tile) 0.1"});
    expect_told(job(ranks(2, {"parse", "missing.ply", "--quiet"})), 1, {"missing.ply"});
}

TEST_F(Job, a_rank_of_other_options_ends_it) {
    Words finer = parse("out");
    finer.insert(finer.end(), {"--voxel", "0.04"});
    expect_told(job(ranks(1, parse("out")), ranks(1, finer)), 2, {"rank 1: ", "other options"});
    EXPECT_FALSE(fs::exists(in("out")));
}

TEST_F(Job, a_rank_without_the_device_ends_it) {
    Words vulkan = parse("out");
    vulkan.back() = "vulkan";
    const Words no_driver{"-x", "VK_ICD_FILENAMES=/missing", "-x", "VK_DRIVER_FILES=/missing"};
    expect_told(job(ranks(1, parse("out")), ranks(1, vulkan, no_driver)), 3,
                {"rank 1: ", "Vulkan"});
    EXPECT_FALSE(fs::exists(in("out")));
}

TEST_F(Job, a_killed_rank_ends_it_and_the_next_job_goes_on) {
    // Stopped while there are blocks to do, which nobody can finish without it, and killed when the
    // other has done two. Where the machine is so busy that this comes late, once more.
    Finished broken;
    for (int attempt = 0; attempt < 5; ++attempt) {
        fs::remove_all(in("out"));
        pid_t rank = 0;
        bool stopped = false;
        broken = job(ranks(2, parse("out")), {}, [&](const std::string&) {
            if (rank == 0) rank = process_of(1);
            if (rank > 0 && !stopped && !files("layout").empty())
                stopped = kill(rank, SIGSTOP) == 0;
            if (stopped && files("block-").size() >= 2) kill(rank, SIGKILL);
            return 0;
        });
        if (!fs::exists(in("out"))) break;
    }
    EXPECT_NE(broken.code, 0);
    EXPECT_THAT(broken.err, testing::HasSubstr("signal 9"));
    EXPECT_FALSE(fs::exists(in("out")));
    std::vector<fs::path> blocks = files("block-");
    const std::vector<fs::path> cells = files("cells-");
    ASSERT_GE(blocks.size(), 2);
    ASSERT_FALSE(cells.empty());
    // By the time of the kill a fast machine may have finished them all.
    fs::remove(blocks.back());
    blocks.pop_back();

    // What both ranks now read is damaged, and so is one of the blocks that were finished: that is
    // told, and made anew.
    for (const fs::path& file : cells) fs::resize_file(file, 9);
    fs::resize_file(blocks[0], fs::file_size(blocks[0]) / 2);
    const Finished next = job(ranks(2, parse("out")));
    EXPECT_EQ(next.code, 0) << next.err;
    for (const std::string& name : {cells[0].filename().string(), blocks[0].filename().string()})
        EXPECT_THAT(next.err, testing::HasSubstr(name + " is damaged"));
    EXPECT_TRUE(output("out") == alone());
    EXPECT_FALSE(fs::exists(work()));
}

}  // namespace
}  // namespace topple::test
