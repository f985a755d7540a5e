// SPDX-License-Identifier: MIT
#include "topple/cloud_view.h"

#include <thread>

#include "device/device.h"
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "points/formats/read_cloud.h"
#include "points/observation.h"

// Clouds in the caller's memory, whatever their layout.
namespace topple::test {
namespace {

struct Record {
    float x, y, z;
    std::uint8_t colour[3];
};

std::vector<Record> records_of(const PointCloud& cloud) {
    std::vector<Record> out;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        out.push_back({cloud.x[i], cloud.y[i], cloud.z[i], {1, 2, 3}});
    return out;
}

CloudView view_of(const std::vector<Record>& records) {
    return CloudView::of_records(&records[0].x, records.size(), sizeof(Record));
}

ParseOptions quick() {
    ParseOptions options = on(device::open_device("native"));
    options.disturbances = {};
    return options;
}

TEST(CloudView, TakesNoCopyOfRecordsOrOfArrays) {
    const SmallRoom room = SmallRoom::scattered();
    const std::vector<Record> records = records_of(room.cloud);
    const ParseOptions options = quick();
    const Observation of_records = observe_view(*options.device, view_of(records), options);
    EXPECT_EQ(of_records.own.x.capacity(), 0u);
    EXPECT_EQ(of_records.cloud.y.data(), reinterpret_cast<const std::byte*>(&records[0].y));
    const Observation of_arrays = observe_view(*options.device, room.cloud, options);
    EXPECT_EQ(of_arrays.own.x.capacity(), 0u);
    EXPECT_EQ(of_arrays.cloud.z.data(), reinterpret_cast<const std::byte*>(room.cloud.z.data()));
}

TEST(CloudView, ParsesRecordsAsItParsesArrays) {
    const SmallRoom room = SmallRoom::scattered();
    const std::vector<Record> records = records_of(room.cloud);
    const Scene arrays = parse(room.cloud, quick()).scene;
    const Scene strided = parse(view_of(records), quick()).scene;
    EXPECT_EQ(strided.points.x, room.cloud.x);
    EXPECT_EQ(strided.points.primitive, arrays.points.primitive);
    EXPECT_EQ(strided.points.object, arrays.points.object);
    EXPECT_EQ(strided.points.nz, arrays.points.nz);
    EXPECT_TRUE(strided.points.index.empty());
}

TEST(CloudView, LeavesOutPointsThatAreNotFinite) {
    const SmallRoom room = SmallRoom::scattered();
    std::vector<Record> records = records_of(room.cloud);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    records.insert(records.begin() + 100, {nan, 0, 0, {}});
    records.push_back({0, std::numeric_limits<float>::infinity(), 0, {}});
    const Scene whole = parse(room.cloud, quick()).scene;
    const Scene spoilt = parse(view_of(records), quick()).scene;
    EXPECT_EQ(spoilt.points.primitive, whole.points.primitive);
    ASSERT_EQ(spoilt.points.index.size(), room.cloud.size());
    EXPECT_EQ(spoilt.points.index[99], 99u);
    EXPECT_EQ(spoilt.points.index[100], 101u);
}

class CloudViewFiles : public Files {};

TEST_F(CloudViewFiles, CoordinatesMayStayWithTheCaller) {
    const SmallRoom room = SmallRoom::scattered();
    std::vector<Record> records = records_of(room.cloud);
    records.insert(records.begin(), {std::numeric_limits<float>::quiet_NaN(), 0, 0, {}});
    ParseOptions options = quick();
    options.coordinates = false;
    ParseResult result = parse(view_of(records), options);
    EXPECT_TRUE(result.scene.points.x.empty());
    EXPECT_EQ(result.scene.points.object.size(), room.cloud.size());
    EXPECT_THROW(write_outputs(result, path("out")), Error);
    EXPECT_THROW(add_coordinates(CloudView::of_records(&records[0].x, 5, sizeof(Record)), result),
                 Error);
    add_coordinates(view_of(records), result);
    EXPECT_EQ(result.scene.points.y, room.cloud.y);
    write_outputs(result, path("out"));
    EXPECT_TRUE(std::filesystem::exists(path("out/points.ply")));
}

// Colours of records, with a point that is left out, in the result and in its files.
TEST_F(CloudViewFiles, ColoursComeAlong) {
    const SmallRoom room = SmallRoom::scattered();
    std::vector<Record> records = records_of(room.cloud);
    records.insert(records.begin() + 7, {std::numeric_limits<float>::quiet_NaN(), 0, 0, {}});
    for (std::size_t n = 0; n < records.size(); ++n)
        records[n].colour[0] = static_cast<std::uint8_t>(1 + n % 200);
    CloudView view = view_of(records);
    view.red = {&records[0].colour[0], records.size(), sizeof(Record)};
    view.green = {&records[0].colour[1], records.size(), sizeof(Record)};
    view.blue = {&records[0].colour[2], records.size(), sizeof(Record)};
    ParseOptions options = quick();
    ParseResult result = parse(view, options);
    const ScenePoints kept = result.scene.points;
    ASSERT_EQ(kept.red.size(), room.cloud.size());
    EXPECT_EQ(kept.red[6], 7);
    EXPECT_EQ(kept.red[7], 9);
    EXPECT_EQ(kept.blue[7], 3);
    options.coordinates = false;
    result = parse(view, options);
    EXPECT_TRUE(result.scene.points.red.empty());
    add_coordinates(view, result);
    EXPECT_EQ(result.scene.points.red, kept.red);
    OutputOptions with_meshes;
    with_meshes.glb = true;
    write_outputs(result, path("out"), with_meshes);
    EXPECT_EQ(io::read_cloud(path("out/points.ply")).red, kept.red);
    view.green = {&records[0].colour[1], 7, sizeof(Record)};
    EXPECT_THROW(add_coordinates(view, result), Error);
    EXPECT_THROW(parse(view, quick()), Error);
}

std::string refusal(const CloudView& view) {
    return message_of([&] { parse(view, quick()); }, ErrorKind::input);
}

TEST(CloudView, RefusesWhatIsNoCloud) {
    const SmallRoom room = SmallRoom::scattered();
    const std::string size = std::to_string(room.cloud.size());
    const auto refused = [&](const std::string& says, const auto& spoil) {
        CloudView view = room.cloud;
        spoil(view);
        EXPECT_THAT(refusal(view), testing::HasSubstr(says));
    };
    const std::vector<float> there(room.cloud.size(), 1), few(3, 1),
        none(40, std::numeric_limits<float>::quiet_NaN());
    std::vector<std::uint32_t> pixel(room.cloud.size(), 199);
    pixel[5] = 200;
    refused("room: y has 7 values, but x has " + size, [&](CloudView& v) {
        v.y = {&room.cloud.y[0], 7};
    });
    refused("room: ny has 0 values, but x has " + size, [&](CloudView& v) { v.nx = room.cloud.x; });
    refused("room: z is a null pointer", [&](CloudView& v) { v.z = {nullptr, room.cloud.size()}; });
    refused("room: pixel has 3 values, but x has " + size,
            [&](CloudView& v) { v.pixel = std::span(pixel).first(3); });
    refused("room: none of its 40 points is finite", [&](CloudView& v) { v.x = v.y = v.z = none; });
    refused("room: an organised cloud of 20 x 10 pixels has as many points, but x has " + size,
            [&](CloudView& v) { v.width = 20, v.height = 10; });
    refused("room: pixel 200 lies outside of its 20 x 10",
            [&](CloudView& v) { v.width = 20, v.height = 10, v.pixel = pixel; });
    refused("width and height are 0", [&](CloudView& v) { v.pixel = pixel; });
    for (const double wrong : {std::nan(""), double{INFINITY}, 2e6})
        refused("room: its viewpoint has a coordinate of",
                [&](CloudView& v) { v.has_viewpoint = true, v.viewpoint[2] = wrong; });
    const auto seen_from = [&](CloudView& v) {
        v.viewpoint_x = v.viewpoint_y = v.viewpoint_z = FloatColumn(there);
    };
    refused("room: viewpoint_z has 3 values, but x has " + size, [&](CloudView& v) {
        seen_from(v);
        v.viewpoint_z = FloatColumn(few);
    });
    refused("has a viewpoint for each point", [&](CloudView& v) {
        seen_from(v);
        v.width = static_cast<std::uint32_t>(room.cloud.size()), v.height = 2;
        pixel[5] = 0;
        v.pixel = pixel;
    });
    EXPECT_EQ(refusal({}), "cloud: has no points");
    SmallRoom far = room;
    far.cloud.x[8] = 3e6f;
    EXPECT_THAT(refusal(far.cloud), testing::HasSubstr("point 8 has a coordinate of 3e+06, bey"));
    // As other libraries write that it is not organised.
    CloudView row = room.cloud;
    seen_from(row);
    row.width = static_cast<std::uint32_t>(room.cloud.size()), row.height = 1;
    EXPECT_EQ(refusal(row), "nothing was thrown");
}

// Rather than two that get in one another's way.
TEST(CloudView, ADeviceServesOneParseAtATime) {
    const SmallRoom room = SmallRoom::scattered();
    ParseOptions options = quick();
    options.device = device::open_native(2);
    std::string refused;
    options.progress = [&](const std::string&, double) {
        if (!refused.empty()) return;
        ParseOptions second = quick();
        second.device = options.device;
        refused = message_of([&] { parse(room.cloud, second); }, std::nullopt);
    };
    parse(room.cloud, options);
    EXPECT_EQ(refused, "the device is in use by another parse or stage; open one for each thread");
    options.progress = {};
    EXPECT_FALSE(parse(room.cloud, options).scene.objects.empty());
    options.cache_file = "parse.cache";
    EXPECT_THROW(parse(room.cloud, options), Error);
}

// Whoever says where each point was seen from has the same of any order of the points, with or
// without points that are not finite, and no free space is guessed.
TEST(CloudView, EachPointMayHaveAViewpoint) {
    const SmallRoom room = SmallRoom::scattered();
    const std::array<Vec3, 2> eyes{{{0.4, 0.4, 1.2}, {1.4, 0.5, 0.9}}};
    PointCloud cloud = room.cloud;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3& eye = eyes[i % 2];
        cloud.viewpoint_x.push_back(static_cast<float>(eye[0]));
        cloud.viewpoint_y.push_back(static_cast<float>(eye[1]));
        cloud.viewpoint_z.push_back(static_cast<float>(eye[2]));
    }
    const ParseResult result = parse(CloudView(cloud), quick());
    for (const std::string& note : result.scene.notes)
        EXPECT_EQ(note.find("virtual views"), std::string::npos);
    std::size_t turned = 0;
    const ScenePoints& points = result.scene.points;
    for (std::size_t i = 0; i < points.nx.size(); ++i) {
        const Vec3& eye = eyes[i % 2];
        turned += points.nx[i] * (eye[0] - cloud.x[i]) + points.ny[i] * (eye[1] - cloud.y[i]) +
                      points.nz[i] * (eye[2] - cloud.z[i]) <
                  -0.05;
    }
    EXPECT_LT(turned, points.nx.size() / 50);
    PointCloud more = cloud;
    for (auto* values : {&more.x, &more.y, &more.z}) values->push_back(NAN);
    for (auto* values : {&more.viewpoint_x, &more.viewpoint_y, &more.viewpoint_z})
        values->push_back(0);
    const ParseResult same = parse(CloudView(more), quick());
    ASSERT_EQ(same.scene.objects.size(), result.scene.objects.size());
    for (std::size_t o = 0; o < same.scene.objects.size(); ++o)
        EXPECT_EQ(same.scene.objects[o].mass_kg, result.scene.objects[o].mass_kg);
}

// What is in memory has no options of the command line.
TEST(CloudView, AdviceIsOfItsOwnOptions) {
    const SmallRoom room = SmallRoom::scattered();
    ParseOptions options = quick();
    options.max_memory_bytes = 1 << 20;
    const auto said = [&](const CloudView& cloud) {
        std::string notes;
        const std::string refused = message_of(
            [&] {
                for (const std::string& note : parse(cloud, options).scene.notes) notes += note;
            },
            std::nullopt);
        return notes + refused;
    };
    const std::string large = said(room.cloud);
    EXPECT_NE(large.find("of ParseOptions::max_memory_bytes: allow that much"), std::string::npos)
        << large;
    EXPECT_EQ(large.find("--"), std::string::npos) << large;
    options = quick();
    SmallRoom tiny = room;
    for (auto* axis : {&tiny.cloud.x, &tiny.cloud.y, &tiny.cloud.z})
        for (float& value : *axis) value *= 0.1f;
    const std::string small = said(tiny.cloud);
    EXPECT_NE(small.find("check that the coordinates are metres"), std::string::npos) << small;
    EXPECT_EQ(small.find("--"), std::string::npos) << small;
}

TEST(CloudView, ACancelledParseSaysSo) {
    const SmallRoom room = SmallRoom::scattered();
    ParseOptions options = quick();
    options.cancelled = [] { return true; };
    EXPECT_EQ(message_of([&] { parse(room.cloud, options); }, ErrorKind::cancelled), "cancelled");
}

// Two parses at once, each on a device of its own, share nothing that they write.
TEST(CloudView, TwoDevicesParseAtOnce) {
    const SmallRoom room = SmallRoom::scattered();
    std::vector<Scene> scenes(2);
    std::vector<std::thread> threads;
    for (Scene& scene : scenes)
        threads.emplace_back([&] { scene = parse(room.cloud, quick()).scene; });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(scenes[0].points.object, scenes[1].points.object);
    EXPECT_FALSE(scenes[0].objects.empty());
}

}  // namespace
}  // namespace topple::test
