// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "lab/scan/files.h"

// topple live follows a folder of frames, and writes what a parse of it would.
namespace topple::test {
namespace {

using nlohmann::json;

class Live : public Program {
  protected:
    Live() {
        scenes::CameraOptions camera;
        camera.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
        camera.frames = 8;
        const auto world = scenes::furnished_room({});
        const scenes::Sequence walk = scenes::walk(world, camera);
        scenes::write_sequence(in("scan"), world, walk);
        // Poses to few digits, as programs print them, which are made rotations.
        std::string poses;
        char number[32];
        for (const DepthFrame& frame : walk.frames)
            for (std::size_t k = 0; k < 12; ++k) {
                std::snprintf(number, sizeof(number), "%.6f%c", frame.camera_to_world[k],
                              k == 11 ? '\n' : ' ');
                poses += number;
            }
        put("scan/trajectory.txt", poses);
        walk_ = walk;
    }
    scenes::Sequence walk_;
    json read(const std::string& name) const { return json::parse(bytes_of_file(in(name))); }
};

constexpr const char* follow = "live scan -o live --idle 0.3 --backend native --threads 2";

TEST_F(Live, writes_what_a_parse_of_the_folder_does) {
    const Finished done = succeeds(std::string(follow) + " --keep-gone");
    EXPECT_TRUE(done.out.starts_with(
        "following scan, with results in live; it ends after 0.3 s without anything new\n"))
        << done.out;
    EXPECT_THAT(done.out, HasSubstr("8 frames, "));
    succeeds("parse scan -o parsed --backend native --threads 2 --no-cache --quiet");
    for (const std::string name :
         {"points.ply", "solid.ply", "volume.vdb", "landscapes.json", "solids.bin"})
        EXPECT_TRUE(bytes_of_file(in("live/" + name)) == bytes_of_file(in("parsed/" + name)))
            << name;
    json live = read("live/scene.json"), parsed = read("parsed/scene.json");
    live.erase("timings_s");
    parsed.erase("timings_s");
    EXPECT_EQ(json::diff(live, parsed).dump(), "[]");

    const json things = read("live/things.json");
    EXPECT_EQ(things["schema"], "topple.things/1");
    EXPECT_EQ(things["frames"], json({0, 1, 2, 3, 4, 5, 6, 7}));
    ASSERT_EQ(things["things"].size(), live["objects"].size());
    EXPECT_EQ(things["things"][0]["id"], 0);
    for (std::size_t n = 0; n < things["things"].size(); ++n) {
        EXPECT_EQ(things["things"][n]["object"], n);
        EXPECT_EQ(things["things"][n]["change"], "found");
        EXPECT_EQ(things["things"][n]["moved_m"], 0.0);
    }
    // A parse into the same folder has no things.
    succeeds("parse scan -o live --backend native --no-cache --quiet");
    EXPECT_FALSE(std::filesystem::exists(in("live/things.json")));
}

TEST_F(Live, goes_on_from_a_checkpoint) {
    const std::string keeps = std::string(follow) + " --checkpoint room.session";
    succeeds(keeps);
    const json before = read("live/things.json");
    const Finished again = succeeds(keeps);
    EXPECT_THAT(again.out, HasSubstr("going on from room.session: 8 frames\n"));
    const json after = read("live/things.json");
    ASSERT_EQ(after["things"].size(), before["things"].size());
    for (std::size_t n = 0; n < after["things"].size(); ++n) {
        EXPECT_EQ(after["things"][n]["id"], before["things"][n]["id"]);
        EXPECT_EQ(after["things"][n]["change"], "none");
    }
    fails(2, std::string(follow) + " --checkpoint live/room.session",
          {"is the output folder live, which is replaced"});
    put("other.session", "mine");
    fails(1, std::string(follow) + " --quiet --checkpoint other.session",
          {"other.session: is no checkpoint of"});
    EXPECT_EQ(bytes_of_file(in("other.session")), "mine");
}

TEST_F(Live, takes_messages_on_standard_input) {
    std::string stream =
        json{{"intrinsics", json::parse(bytes_of_file(in("scan/intrinsics.json")))}}.dump();
    std::istringstream poses(bytes_of_file(in("scan/trajectory.txt")));
    for (const DepthFrame& frame : walk_.frames) {
        std::string line;
        std::getline(poses, line);
        std::ranges::replace(line, ' ', ',');
        const json message{{"add", "frame"}, {"pose", json::parse("[" + line + ",0,0,0,1]")}};
        stream += "\n" + message.dump() + "\n";
        stream.append(reinterpret_cast<const char*>(frame.depth.data()), 2 * frame.depth.size());
    }
    input_ = put("stream", stream);
    const Finished done = succeeds("live - -o live --keep-gone --backend native --threads 2");
    EXPECT_TRUE(done.out.starts_with(
        "following standard input, with results in live; it ends where that does\n"))
        << done.out;
    succeeds("parse scan -o parsed --backend native --threads 2 --no-cache --quiet");
    for (const std::string name : {"points.ply", "solid.ply", "solids.bin"})
        EXPECT_TRUE(bytes_of_file(in("live/" + name)) == bytes_of_file(in("parsed/" + name)))
            << name;

    put("stream", stream.substr(0, stream.size() - 1));
    const Finished cut = topple("live - -o cut --backend native --quiet");
    EXPECT_EQ(cut.code, 1);
    EXPECT_EQ(cut.err,
              "topple: standard input: message 8: is cut short: 1 of 13824 bytes are missing; what "
              "came since is not in cut\n");
    EXPECT_EQ(json::parse(bytes_of_file(in("cut/things.json")))["frames"].size(), 7u);
    input_ = "/dev/null";
    EXPECT_EQ(topple("live - -o none").err, "topple: standard input: no frame came\n");
}

TEST_F(Live, says_what_is_damaged_and_goes_on_with_what_is_behind_it) {
    const std::string name = "scan/depth/0003.png", whole = bytes_of_file(in(name));
    ASSERT_GT(whole.size(), 1000u);
    put(name, whole.substr(0, 1000));
    const Finished done = topple(std::string(follow) + " --quiet");
    EXPECT_EQ(done.code, 1);
    EXPECT_TRUE(done.err.starts_with(name + ": is cut short")) << done.err;
    EXPECT_THAT(done.err, HasSubstr("; it is left out\n"));
    EXPECT_TRUE(done.err.ends_with("; 1 damaged image of 8 left out of live\n")) << done.err;
    EXPECT_EQ(read("live/things.json")["frames"].size(), 7u);
    EXPECT_TRUE(std::filesystem::exists(in("live/report.html")));
}

TEST_F(Live, a_signal_ends_it_with_what_it_has_written) {
    const Finished done = topple("live scan -o live --backend native", [&](const std::string&) {
        return bytes_of_file(path("stdout")).find("8 frames") == std::string::npos ? 0 : SIGINT;
    });
    EXPECT_EQ(done.code, 128 + SIGINT);
    EXPECT_EQ(done.err, "topple: interrupted; live is of 8 frames\n");
    EXPECT_TRUE(std::filesystem::exists(in("live/scene.json")));
}

}  // namespace
}  // namespace topple::test
