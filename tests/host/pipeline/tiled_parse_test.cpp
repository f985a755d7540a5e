// SPDX-License-Identifier: MIT
#include <condition_variable>
#include <mutex>
#include <thread>

#include "host/io/files.h"
#include "lab/rooms/building.h"
#include "lab/temporary_folder.h"
#include "points/formats/read_cloud.h"
#include "scale/task_list.h"
#include "topple/crew.h"
#include "topple/error.h"
#include "topple/parse.h"

namespace topple {
namespace {

namespace fs = std::filesystem;

// Four rooms with doors, sparse enough that the test takes seconds.
const fs::path& building() {
    static const scenes::TemporaryFolder folder("topple_tiles");
    static const fs::path cloud = [] {
        const fs::path file = folder.path() / "building.ply";
        scenes::write_building(file, {.seed = 4, .points = 275'000, .spacing_m = 0.04},
                               [](std::size_t, std::size_t) { return true; });
        return file;
    }();
    return cloud;
}

ParseOptions coarse() {
    ParseOptions options;
    options.voxel_m = 0.05;
    options.tile_m = 5;
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

Output output_of(const ParseResult& result, const fs::path& written) {
    write_outputs(result, written);
    Output out{test::bytes_of_file(written / "points.ply"),
               test::bytes_of_file(written / "solid.ply"),
               {},
               {}};
    for (const Primitive& p : result.scene.primitives) out.object_of_primitive.push_back(p.object);
    for (const Object& o : result.scene.objects) {
        out.figures.insert(out.figures.end(), {o.mass_kg, o.barrier_J, o.release_J});
        for (const auto& [name, risk] : o.risk_J) out.figures.push_back(risk);
    }
    return out;
}

Output output_of(const ParseResult& result) {
    const scenes::TemporaryFolder folder("topple_tiles");
    return output_of(result, folder.path() / "out");
}

// Of the blocks' progress: the shares of the whole at which they begin and end.
struct Blocks {
    double first = 1, last = 0;
    void tell(const std::string& stage, double done) {
        if (stage != "blocks") return;
        first = std::min(first, done);
        last = done;
    }
};

class SlowTiles : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new scenes::TemporaryFolder("topple_tiles");
        ParseOptions options = coarse();
        options.device = device::open_device("native", 3);
        options.progress = [&](const std::string& name, double done) {
            callers_.insert(std::this_thread::get_id());
            blocks_.tell(name, done);
        };
        options.cancelled = [&] {
            callers_.insert(std::this_thread::get_id());
            return false;
        };
        result_ = new ParseResult(parse(building(), options));
        output_ = new Output(output_of(*result_, first_output()));
    }
    static void TearDownTestSuite() {
        delete result_;
        delete output_;
        delete folder_;
    }
    static fs::path first_output() { return folder_->path() / "out"; }
    static inline const scenes::TemporaryFolder* folder_ = nullptr;
    static inline const ParseResult* result_ = nullptr;
    static inline const Output* output_ = nullptr;
    static inline std::set<std::thread::id> callers_;  // of another's calls, it would be a race
    static inline Blocks blocks_;
};

TEST_F(SlowTiles, EveryPointComesBackInItsPlace) {
    const PointCloud in = io::read_cloud(building());
    const PointCloud out = io::read_cloud(first_output() / "points.ply");
    EXPECT_EQ(in.x, out.x);
    EXPECT_EQ(in.y, out.y);
    EXPECT_EQ(in.z, out.z);
    std::uint64_t labelled = 0;
    for (const Primitive& p : result_->scene.primitives) labelled += p.points;
    EXPECT_GT(static_cast<double>(labelled), 0.97 * static_cast<double>(in.size()));
    EXPECT_LE(labelled, in.size());
    EXPECT_TRUE(fs::exists(first_output() / "volume.vdb"));
    EXPECT_TRUE(fs::exists(first_output() / "report.html"));
}

TEST_F(SlowTiles, CallbacksAreCalledOnTheCallersThread) {
    EXPECT_EQ(callers_, std::set{std::this_thread::get_id()});
    EXPECT_GT(blocks_.last, blocks_.first + 0.1);
}

// Of many blocks, of few and of one.
TEST_F(SlowTiles, TilesMemoryAndThreadsChangeNothing) {
    ParseOptions options = coarse();
    options.device = device::open_device("native", 1);
    options.max_memory_bytes = std::uint64_t{700} << 20;
    options.tile_m = 10;
    EXPECT_TRUE(output_of(parse(building(), options)) == *output_);
    options = coarse();
    options.tile_m = 100;
    EXPECT_TRUE(output_of(parse(building(), options)) == *output_);
}

TEST_F(SlowTiles, AStoppedRunGoesOnWhereItWas) {
    scenes::TemporaryFolder folder("topple_tiles");
    ParseOptions options = coarse();
    options.work_folder = folder.path() / "work";
    // Stops within the blocks: the next run finds some of them done.
    Blocks stopped;
    options.progress = [&](const std::string& name, double done) { stopped.tell(name, done); };
    options.cancelled = [&] { return stopped.last > stopped.first + 0.1; };
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
    {
        const ParseResult resumed = parse(building(), options);
        EXPECT_GT(blocks().size(), before.size());
        EXPECT_EQ(fs::last_write_time(before.front()), written);
        EXPECT_TRUE(output_of(resumed) == *output_);
    }
    EXPECT_FALSE(fs::exists(options.work_folder));
}

// Of the records of 23 bytes: x, y, z, primitive, object, colour.
std::vector<std::int32_t> objects_in(const std::string& points_ply) {
    std::vector<std::int32_t> out;
    for (std::size_t at = points_ply.find("end_header\n") + 11; at < points_ply.size(); at += 23) {
        std::int32_t object = 0;
        std::memcpy(&object, points_ply.data() + at + 16, sizeof(object));
        out.push_back(object);
    }
    return out;
}

// Share of the points that lie together in both: of each object of one parse, those in the object
// of the other that has most of them.
double share_together(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
    std::map<std::int32_t, std::map<std::int32_t, std::uint64_t>> both;
    for (std::size_t n = 0; n < a.size(); ++n) ++both[a[n]][b[n]];
    std::uint64_t together = 0;
    for (const auto& [object, others] : both) {
        std::uint64_t most = 0;
        for (const auto& [other, points] : others) most = std::max(most, points);
        together += most;
    }
    return static_cast<double>(together) / static_cast<double>(a.size());
}

// Growing of surfaces and estimates of free space reach as far as a block sees: what is found near
// its edge is not bit for bit what is found in the middle, and small parts may differ.
TEST_F(SlowTiles, InOnePieceTheSameObjectsAreFound) {
    ParseOptions options = coarse();
    options.tile_m = 0;
    const ParseResult whole = parse(building(), options);
    ASSERT_EQ(whole.tiled, nullptr);
    const std::vector<std::int32_t>& one = whole.scene.points.object;
    const std::vector<std::int32_t> many = objects_in(output_->points);
    ASSERT_EQ(one.size(), many.size());
    EXPECT_GE(share_together(one, many), 0.95);
    EXPECT_GE(share_together(many, one), 0.95);
}

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
        return {test::bytes_of_file(out / "points.ply"), test::bytes_of_file(out / "solid.ply")};
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
    EXPECT_THAT(test::message_of([&] { parsed_by(2, other); }, ErrorKind::usage),
                testing::HasSubstr("other options"));
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
