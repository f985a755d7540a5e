// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <openvdb/openvdb.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>

#include "core/random.h"
#include "host/io/mesh_files.h"
#include "host/io/octomap_files.h"
#include "points/apart/read_scan.h"
#include "points/apart/scan_message.h"
#include "topple/device.h"

namespace topple::reader {
namespace {

using test::expect_input_error;

class Apart : public test::Files {
  protected:
    Apart() {
        if (const char* readers = std::getenv("TOPPLE_READERS")) readers_ = readers;
    }
    ~Apart() override { setenv("TOPPLE_READERS", readers_.c_str(), 1); }

    // The readers are a script from here on.
    void take_script(const std::string& script) {
        for (const char* name : {"topple-reader", "topple-volume-reader"}) {
            write(name, "#!/bin/sh\n" + script + "\n");
            std::filesystem::permissions(path(name), std::filesystem::perms::owner_all);
        }
        setenv("TOPPLE_READERS", folder_.c_str(), 1);
    }
    std::filesystem::path volume() const {
        openvdb::initialize();
        auto grid = openvdb::FloatGrid::create(1);
        for (int i = 0; i < 8; ++i) grid->tree().setValueOn({i, i, 0}, i < 4 ? -0.5f : 0.5f);
        grid->tree().setValueOn({4, 3, 0}, 0.5f);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
        openvdb::io::File file(path("a.vdb").string());
        file.write({grid});
        file.close();
        return path("a.vdb");
    }
    std::string readers_;
};

bool same(const std::vector<SpaceMap::Box>& a, const std::vector<SpaceMap::Box>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& two) {
        return one.low == two.low && one.high == two.high;
    });
}

TEST_F(Apart, the_same_comes_as_from_here) {
    const std::filesystem::path files[] = {write("a.obj", test::box_obj()),
                                           write("a.ply", test::box_ply()),
                                           write("a.glb", test::box_glb()),
                                           write("a.stl", test::box_stl()),
                                           write("a.bt", test::binary_map(test::room_map())),
                                           volume()};
    for (const auto& file : files) {
        SCOPED_TRACE(file);
        EXPECT_TRUE(takes_others(file));
        const ScannedMap here = read_scan(file, 0.7, [] {}), apart = read_scan_apart(file, 0.7, {});
        EXPECT_EQ(apart.cloud.x, here.cloud.x);
        EXPECT_EQ(apart.cloud.y, here.cloud.y);
        EXPECT_EQ(apart.cloud.z, here.cloud.z);
        EXPECT_EQ(apart.cloud.nx, here.cloud.nx);
        EXPECT_EQ(apart.cloud.red, here.cloud.red);
        EXPECT_EQ(apart.cloud.source, here.cloud.source);
        EXPECT_EQ(apart.cloud.notes, here.cloud.notes);
        EXPECT_EQ(apart.space.voxel_m, here.space.voxel_m);
        EXPECT_EQ(apart.space.corner_m, here.space.corner_m);
        EXPECT_TRUE(same(apart.space.free, here.space.free));
        EXPECT_TRUE(same(apart.space.solid, here.space.solid));
    }
}

TEST_F(Apart, errors_come_as_from_here) {
    expect_input_error([&] { read_scan_apart(write("a.glb", "glTF"), 1, {}); }, {"no GLB"});
    expect_input_error([&] { read_scan_apart(write("a.vdb", "no"), 1, {}); }, {"magic number"});
    expect_input_error([&] { read_scan_apart(path("none.obj"), 1, {}); }, {"No such file"});
}

TEST_F(Apart, clouds_take_no_other_process) {
    take_script("kill -SEGV $$");
    EXPECT_EQ(read_scan_apart(write("a.xyz", "1 2 3\n4 5 6\n"), 1, {}).cloud.size(), 2u);
}

TEST_F(Apart, what_crashes_there_is_an_error_here) {
    const auto file = write("a.obj", test::box_obj());
    const struct {
        const char *script, *message;
    } cases[] = {
        {"kill -SEGV $$", "crashed (Segmentation fault)"},
        {"kill -XCPU $$", "took more than the 8 s"},
        {"exit 7", "ended without an answer (exit code 7)"},
        {"exit 0", "ended without an answer"},
        {"head -c 1000 /dev/zero >&3", "ended without an answer"},
        // A head that fits, and nothing of a scan behind it.
        {"printf 'topwe1\\0\\0\\100\\0\\0\\0\\0\\0\\0\\0' >&3; head -c 48 /dev/zero >&3", "answer"},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.script);
        take_script(c.script);
        expect_input_error([&] { read_scan_apart(file, 1, {}); },
                           {"a.obj", c.message, "isolate = false (--no-isolate)"});
    }
}

// As the dynamic loader ends a program that lacks a library; the file is not to blame.
TEST_F(Apart, a_reader_that_does_not_start_says_so) {
    const auto file = write("a.obj", test::box_obj());
    const auto message = [&] {
        return test::message_of([&] { read_scan_apart(file, 1, {}); }, ErrorKind::input);
    };
    for (const char* code : {"126", "127"}) {
        take_script("exit " + std::string(code));
        const std::string program = path("topple-reader").string();
        EXPECT_THAT(message(), testing::HasSubstr(program + " did not start (exit code " + code +
                                                  "): a shared library that it needs is missing "
                                                  "here (ldd " +
                                                  program + ")"));
        EXPECT_THAT(message(), testing::Not(testing::HasSubstr("damaged")));
    }
    std::ofstream(path("topple-reader")) << "no program";
    EXPECT_THAT(message(), testing::HasSubstr("did not start: Exec format error"));
}

// Listed, not thrown.
TEST_F(Apart, devices_are_listed_where_the_reader_does_not_start) {
    const auto problems = [] {
        std::vector<std::string> all;
        for (const device::Listing& listing : device::list_devices())
            if (listing.backend != device::Backend::native) all.push_back(listing.problem);
        return all;
    };
    take_script("exit 127");
    EXPECT_THAT(problems(), testing::AllOf(testing::SizeIs(2),
                                           testing::Each(testing::AllOf(
                                               testing::HasSubstr("topple-reader did not start"),
                                               testing::HasSubstr("ldd "),
                                               testing::Not(testing::HasSubstr("driver"))))));
    take_script("exit 7");
    EXPECT_THAT(problems(), testing::Each(testing::HasSubstr("its driver ended without")));
    // Without descriptors there is no process.
    rlimit before;
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const int lowest = ::dup(0);
    ::close(lowest);
    const rlimit none{static_cast<rlim_t>(lowest), before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    const std::vector<std::string> found = problems();
    ::setrlimit(RLIMIT_NOFILE, &before);
    EXPECT_THAT(found, testing::AllOf(testing::SizeIs(2),
                                      testing::Each(testing::HasSubstr("raise the limits"))));
}

// A file may be named from the current folder, which the reader does not get.
TEST_F(Apart, a_reader_has_another_folder_and_little_of_the_environment) {
    const auto file = write("a.obj", test::box_obj()), broken = write("b.obj", "f 1 2 9\n");
    const std::filesystem::path near = std::filesystem::relative(file);
    EXPECT_EQ(read_scan_apart(near, 1, {}).cloud.source, near.string());
    expect_input_error([&] { read_scan_apart(std::filesystem::relative(broken), 1, {}); },
                       {std::filesystem::relative(broken).string() + ": "});
    setenv("PYTHONPATH", ".", 1);
    setenv("LD_PRELOAD", "", 1);
    setenv("LANG", "C", 1);
    take_script("{ pwd; tr '\\0' '\\n' < /proc/self/environ; } > " + path("told").string());
    EXPECT_ANY_THROW(read_scan_apart(file, 1, {}));
    unsetenv("PYTHONPATH");
    unsetenv("LD_PRELOAD");
    std::ifstream told(path("told"));
    std::string folder, line;
    std::getline(told, folder);
    EXPECT_EQ(folder, "/");
    bool language = false;
    while (std::getline(told, line)) {
        language |= line == "LANG=C";
        for (const char* name : {"PYTHONPATH=", "LD_PRELOAD=", "PATH=", "HOME=", "TOPPLE_READERS="})
            EXPECT_FALSE(line.starts_with(name)) << line;
    }
    EXPECT_TRUE(language);
}

TEST_F(Apart, what_polls_ends_it) {
    take_script("exec sleep 100");
    const auto file = write("a.obj", test::box_obj());
    struct Cancelled {};
    int polls = 0;
    const auto start = std::chrono::steady_clock::now();
    EXPECT_THROW(read_scan_apart(file, 1,
                                 [&] {
                                     if (++polls == 5) throw Cancelled();
                                 }),
                 Cancelled);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST_F(Apart, says_where_a_reader_is_missing) {
    setenv("TOPPLE_READERS", folder_.c_str(), 1);
    const auto file = write("a.obj", test::box_obj());
    EXPECT_THAT(test::message_of([&] { read_scan_apart(file, 1, {}); }, ErrorKind::usage),
                testing::HasSubstr("TOPPLE_READERS"));
}

// An answer of given bytes, as a child leaves it.
child::Answer answer_of(const std::string& bytes) {
    const int memory = ::memfd_create("answer", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    EXPECT_EQ(::write(memory, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    return child::Answer(memory);
}

std::string bytes_of(const ScannedMap& map) {
    const int memory = ::memfd_create("answer", MFD_CLOEXEC);
    write_scan(map, memory);
    std::string bytes(static_cast<std::size_t>(::lseek(memory, 0, SEEK_END)), '\0');
    EXPECT_EQ(::pread(memory, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    ::close(memory);
    return bytes;
}

ScannedMap map_of_two() {
    ScannedMap map;
    PointCloud& cloud = map.cloud;
    cloud.x = {1, 2};
    cloud.y = {3, 4};
    cloud.z = {5, 6};
    cloud.nx = {1, 0};
    cloud.ny = {0, 1};
    cloud.nz = {0, 0};
    cloud.red = cloud.green = cloud.blue = {7, 8};
    cloud.source = "a.bt";
    cloud.notes = {"A note."};
    map.space.voxel_m = 0.1;
    map.space.free = {{{0, 0, 0}, {1, 1, 1}}};
    map.space.solid = {{{2, 0, 0}, {2, 1, 1}}};
    return map;
}

bool taken(const ScannedMap& map) {
    try {
        take_scan(answer_of(bytes_of(map)));
        return true;
    } catch (const child::BadAnswer&) {
        return false;
    }
}

TEST(ScanMessage, comes_back_whole) {
    const ScannedMap back = take_scan(answer_of(bytes_of(map_of_two())));
    EXPECT_EQ(back.cloud.y, (std::vector<float>{3, 4}));
    EXPECT_EQ(back.cloud.blue, (std::vector<std::uint8_t>{7, 8}));
    EXPECT_EQ(back.cloud.notes, (std::vector<std::string>{"A note."}));
    EXPECT_EQ(back.space.solid.at(0).high[2], 1);
}

TEST(ScanMessage, what_makes_no_sense_is_refused) {
    const auto changed = [](const auto& change) {
        ScannedMap map = map_of_two();
        change(map);
        return map;
    };
    EXPECT_TRUE(taken(map_of_two()));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.x.pop_back(); })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.x[1] = NAN; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.nz[1] = 2; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.ny.clear(); })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.green.pop_back(); })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.pixel = {0, 1}; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.cloud.offset_m[0] = INFINITY; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.space.voxel_m = 0; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.space.free[0].high[1] = -1; })));
    EXPECT_FALSE(taken(changed([](auto& m) { m.space.solid[0].high[1] = INT32_MAX; })));
}

// Whatever a child that was taken over writes, nothing worse comes of it than an error.
TEST(ScanMessage, damaged_answers_are_refused_or_sound) {
    const std::string good = bytes_of(map_of_two());
    Random random(1);
    for (int n = 0; n < 20000; ++n) {
        std::string bytes = good;
        for (int k = 0; k < 1 + n % 3; ++k)
            bytes[child::answer_head + random.below(bytes.size() - child::answer_head)] =
                static_cast<char>(random.below(256));
        const child::Answer answer = answer_of(bytes);
        ASSERT_TRUE(answer.whole());
        try {
            const ScannedMap map = take_scan(answer);
            ASSERT_EQ(map.cloud.x.size(), map.cloud.z.size());
        } catch (const child::BadAnswer&) {
        } catch (const Error&) {
        }
    }
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(answer_of(good.substr(0, size)).whole()) << size;
}

}  // namespace
}  // namespace topple::reader
