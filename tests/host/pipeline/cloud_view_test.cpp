// SPDX-License-Identifier: MIT
#include "topple/cloud_view.h"

#include <thread>

#include "device/devices.h"
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
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        out.push_back({cloud.x[i], cloud.y[i], cloud.z[i], {}});
        if (cloud.red.empty()) continue;
        std::ranges::copy(std::array{cloud.red[i], cloud.green[i], cloud.blue[i]},
                          out.back().colour);
    }
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

class CloudViewFiles : public Files {};

// Two parses at once, each on a device of its own, share nothing that they write: of coloured
// arrays, and of records of the same, among them points that are left out, which keep their
// coordinates to themselves.
TEST_F(CloudViewFiles, TwoDevicesParseArraysAndRecordsAtOnce) {
    SmallRoom room = SmallRoom::scattered();
    for (std::size_t n = 0; n < room.cloud.size(); ++n)
        room.cloud.red.push_back(static_cast<std::uint8_t>(1 + n % 200));
    room.cloud.green.assign(room.cloud.size(), 2);
    room.cloud.blue.assign(room.cloud.size(), 3);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<Record> records = records_of(room.cloud);
    records.insert(records.begin() + 100, {nan, 0, 0, {}});
    records.push_back({0, std::numeric_limits<float>::infinity(), 0, {}});
    CloudView view = view_of(records);
    view.red = {&records[0].colour[0], records.size(), sizeof(Record)};
    view.green = {&records[0].colour[1], records.size(), sizeof(Record)};
    view.blue = {&records[0].colour[2], records.size(), sizeof(Record)};

    ParseResult whole, spoilt;
    std::thread other([&] { whole = parse(room.cloud, quick()); });
    ParseOptions options = quick();
    options.coordinates = false;
    spoilt = parse(view, options);
    other.join();
    const ScenePoints &expected = whole.scene.points, &found = spoilt.scene.points;
    EXPECT_FALSE(whole.scene.objects.empty());
    EXPECT_EQ(expected.x, room.cloud.x);
    EXPECT_EQ(expected.red, room.cloud.red);
    EXPECT_TRUE(expected.index.empty());
    EXPECT_EQ(found.primitive, expected.primitive);
    EXPECT_EQ(found.object, expected.object);
    EXPECT_EQ(found.nz, expected.nz);
    ASSERT_EQ(found.index.size(), room.cloud.size());
    EXPECT_EQ(found.index[99], 99u);
    EXPECT_EQ(found.index[100], 101u);

    EXPECT_TRUE(found.x.empty());
    EXPECT_TRUE(found.red.empty());
    EXPECT_THROW(write_outputs(spoilt, path("out")), Error);
    EXPECT_THROW(add_coordinates(CloudView::of_records(&records[0].x, 5, sizeof(Record)), spoilt),
                 Error);
    add_coordinates(view, spoilt);
    EXPECT_EQ(found.y, room.cloud.y);
    EXPECT_EQ(found.red, room.cloud.red);
    OutputOptions with_meshes;
    with_meshes.glb = true;
    write_outputs(spoilt, path("out"), with_meshes);
    const PointCloud written = io::read_cloud(path("out/points.ply"));
    EXPECT_EQ(written.red, room.cloud.red);
    EXPECT_EQ(written.blue, room.cloud.blue);
    view.green = {&records[0].colour[1], 7, sizeof(Record)};
    EXPECT_THROW(add_coordinates(view, spoilt), Error);
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
    const ParseOptions options = quick();
    EXPECT_NO_THROW(observe_view(*options.device, row, options));
}

// Rather than two that get in one another's way; and serves the next once it has ended.
TEST(CloudView, ADeviceServesOneParseAtATime) {
    const SmallRoom room = SmallRoom::scattered();
    ParseOptions options = quick();
    options.device = device::open_native(2);
    const auto ended = [&](const ParseOptions& how) {
        return message_of([&] { parse(room.cloud, how); }, std::nullopt);
    };
    std::string refused;
    options.progress = [&](const std::string&, double) {
        ParseOptions second = quick();
        second.device = options.device;
        if (refused.empty()) refused = ended(second);
    };
    options.cancelled = [&] { return !refused.empty(); };
    EXPECT_EQ(ended(options), "cancelled");
    EXPECT_EQ(refused, "the device is in use by another parse or stage; open one for each thread");
    EXPECT_EQ(ended(options), "cancelled");
    options.cache_file = "parse.cache";
    EXPECT_THAT(ended(options), testing::HasSubstr("the scan is in memory"));
}

// Whoever says where each point was seen from has it so of all that are finite, and no free space
// is guessed.
TEST(CloudView, EachPointMayHaveAViewpoint) {
    const SmallRoom room = SmallRoom::scattered();
    const std::array<Vec3, 2> eyes{{{0.4, 0.4, 1.2}, {1.4, 0.5, 0.9}}};
    PointCloud cloud = room.cloud;
    for (auto* axis : {&cloud.x, &cloud.y, &cloud.z}) axis->insert(axis->begin() + 7, NAN);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3& eye = eyes[i % 2];
        cloud.viewpoint_x.push_back(static_cast<float>(eye[0]));
        cloud.viewpoint_y.push_back(static_cast<float>(eye[1]));
        cloud.viewpoint_z.push_back(static_cast<float>(eye[2]));
    }
    const Scene scene = parse(CloudView(cloud), quick()).scene;
    for (const std::string& note : scene.notes)
        EXPECT_EQ(note.find("virtual views"), std::string::npos);
    std::size_t turned = 0;
    const ScenePoints& points = scene.points;
    ASSERT_EQ(points.index.size(), room.cloud.size());
    for (std::size_t n = 0; n < points.nx.size(); ++n) {
        const Vec3& eye = eyes[points.index[n] % 2];
        turned += points.nx[n] * (eye[0] - points.x[n]) + points.ny[n] * (eye[1] - points.y[n]) +
                      points.nz[n] * (eye[2] - points.z[n]) <
                  -0.05;
    }
    EXPECT_LT(turned, points.nx.size() / 50);
}

// What is in memory has no option of a unit.
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
    EXPECT_NE(large.find("of max_memory_bytes (--max-memory): allow that much"), std::string::npos)
        << large;
    options = quick();
    SmallRoom tiny = room;
    for (auto* axis : {&tiny.cloud.x, &tiny.cloud.y, &tiny.cloud.z})
        for (float& value : *axis) value *= 0.1f;
    const std::string small = said(tiny.cloud);
    EXPECT_NE(small.find("check that the coordinates are metres"), std::string::npos) << small;
    EXPECT_EQ(small.find("unit_m"), std::string::npos) << small;
}

}  // namespace
}  // namespace topple::test
