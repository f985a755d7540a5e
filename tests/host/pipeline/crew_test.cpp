// SPDX-License-Identifier: MIT
#include "topple/crew.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "lab/rooms/building.h"
#include "lab/temporary_folder.h"
#include "scale/task_list.h"
#include "topple/error.h"
#include "topple/parse.h"

namespace topple {
namespace {

// What the members of a crew have in common where they are threads of one process.
struct Meeting {
    std::mutex mutex;
    std::condition_variable changed;
    TaskList tasks;
    std::string order;
    std::size_t members = 1, left = 0, stages = 0;
    std::map<std::size_t, std::size_t> done;  // tasks by member
    bool over = false;
    std::exception_ptr failed;
};

class ThreadCrew final : public Crew {
  public:
    ThreadCrew(Meeting& meeting, std::size_t member) : meeting_(meeting), member_(member) {}

    void begin(const std::string& order, std::vector<Task> tasks) override {
        const std::lock_guard lock(meeting_.mutex);
        meeting_.tasks.begin(std::move(tasks));
        meeting_.order = order;
        meeting_.left = 0;
        ++meeting_.stages;
        meeting_.changed.notify_all();
    }
    std::uint64_t finished() const override { return meeting_.tasks.finished(); }
    std::optional<std::string> wait() override {
        std::unique_lock lock(meeting_.mutex);
        meeting_.changed.wait(lock, [&] { return meeting_.over || meeting_.stages > stages_; });
        if (meeting_.stages == stages_) return std::nullopt;
        stages_ = meeting_.stages;
        return meeting_.order;
    }
    std::optional<std::uint64_t> next(std::optional<std::uint64_t> finished) override {
        if (finished) {
            const std::lock_guard lock(meeting_.mutex);
            ++meeting_.done[member_];
        }
        return meeting_.tasks.next(finished);
    }
    void end(std::exception_ptr failed, const std::function<void()>& poll) override {
        std::unique_lock lock(meeting_.mutex);
        if (failed && !meeting_.failed) meeting_.failed = failed;
        if (failed) meeting_.tasks.close();
        ++meeting_.left;
        meeting_.changed.notify_all();
        if (member_ > 0) return;
        meeting_.changed.wait(lock, [&] { return meeting_.left == meeting_.members; });
        if (meeting_.failed) std::rethrow_exception(meeting_.failed);
        poll();
    }

  private:
    Meeting& meeting_;
    std::size_t member_, stages_ = 0;
};

std::string bytes_in(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class Crews : public ::testing::Test {
  protected:
    Crews() : folder_("topple_crew"), cloud_(folder_.path() / "room.ply") {
        scenes::write_building(cloud_, {.points = 20'000, .spacing_m = 0.03},
                               [](std::size_t, std::size_t) { return true; });
        options_.tile_m = 5;
        options_.walks = 20;
        options_.work_folder = folder_.path() / "work";
    }

    // points.ply and solid.ply.
    std::pair<std::string, std::string> written(const ParseResult& result) const {
        const auto out = folder_.path() / "out";
        write_outputs(result, out);
        return {bytes_in(out / "points.ply"), bytes_in(out / "solid.ply")};
    }

    // A parse by so many members; `helpers` are the options of all but the leader.
    std::pair<std::string, std::string> parsed_by(std::size_t members,
                                                  const ParseOptions& helpers) {
        meeting_.members = members;
        std::vector<std::thread> threads;
        for (std::size_t m = 1; m < members; ++m)
            threads.emplace_back([&, m] {
                ThreadCrew crew(meeting_, m);
                ParseOptions own = helpers;
                own.device = device::open_device("native", 1);
                help_parse(crew, own);
            });
        struct Rejoin {
            Meeting& meeting;
            std::vector<std::thread>& threads;
            ~Rejoin() {
                {
                    const std::lock_guard lock(meeting.mutex);
                    meeting.over = true;
                }
                meeting.changed.notify_all();
                for (std::thread& thread : threads) thread.join();
            }
        } rejoin{meeting_, threads};
        ParseOptions own = options_;
        own.device = device::open_device("native", 2);
        own.crew = std::make_shared<ThreadCrew>(meeting_, 0);
        return written(parse(cloud_, own));
    }

    scenes::TemporaryFolder folder_;
    std::filesystem::path cloud_;
    ParseOptions options_;
    Meeting meeting_;
};

TEST_F(Crews, ManyFindWhatOneFinds) {
    const auto together = parsed_by(3, options_);
    EXPECT_EQ(meeting_.stages, 2u);
    std::size_t tasks = 0;
    for (const auto& [member, count] : meeting_.done) tasks += count;
    EXPECT_GT(tasks, meeting_.done[0]) << "the leader did everything";
    EXPECT_TRUE(together == written(parse(cloud_, options_)));
}

TEST_F(Crews, TheFailureOfOneIsTheLeaders) {
    ParseOptions other = options_;
    other.voxel_m = 0.07;
    try {
        parsed_by(2, other);
        FAIL() << "should have failed";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find("other options"), std::string::npos);
    }
    EXPECT_EQ(meeting_.stages, 1u);
}

TEST_F(Crews, AnOrderOfAnotherVersionIsRefused) {
    ThreadCrew leader(meeting_, 0), helper(meeting_, 1);
    meeting_.members = 2;
    // Other backends' compilers leave a signal stack behind in the thread that asks for them.
    ParseOptions options = options_;
    options.device = device::open_device("native", 1);
    std::thread thread([&] { help_parse(helper, options); });
    leader.begin("no order at all", {{0, 1}});
    EXPECT_THROW(leader.end(nullptr, [] {}), Error);
    {
        const std::lock_guard lock(meeting_.mutex);
        meeting_.over = true;
    }
    meeting_.changed.notify_all();
    thread.join();
}

}  // namespace
}  // namespace topple
