// SPDX-License-Identifier: MIT
#include "api/c_result.h"

#include "host/api/c_api.h"
#include "host/pipeline/small_walk.h"
#include "points/formats/read_cloud.h"
#include "topple/ask.h"
#include "topple/frame_labels.h"
#include "topple/parse.h"

namespace topple::test {
namespace {

TEST_F(CApi, TakesCorrections) {
    const std::string text = R"({"schema": "topple.corrections/1", "corrections": [
        {"do": "one_thing", "at_m": [[1.0, 1.2, 0.25], [1.2, 1.2, 0.7]]},
        {"do": "name", "at_m": [[1.0, 1.2, 0.25]], "name": "chest"},
        {"do": "fixed", "at_m": [[0.5, 0.5, 0.9]]}]})";
    const auto file = write("corrections.json", text);
    options.corrections_json = text.c_str();
    options.corrections_file = file.c_str();
    EXPECT_EQ(parsed(), TOPPLE_ERROR_USAGE);
    for (const bool by_file : {true, false}) {
        topple_result_release(result);
        options.corrections_json = by_file ? nullptr : text.c_str();
        options.corrections_file = by_file ? file.c_str() : nullptr;
        ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
        ASSERT_EQ(scene().corrections, 3u);
        topple_correction named = get(topple_result_correction, 1);
        EXPECT_STREQ(named.what, "name");
        EXPECT_STREQ(named.outcome, "held");
        EXPECT_TRUE(named.held);
        ASSERT_EQ(named.object_count, 1u);
        const topple_object chest = object(static_cast<std::uint64_t>(named.objects[0]));
        EXPECT_STREQ(chest.name, "chest");
        ASSERT_EQ(chest.corrected_count, 2u);
        EXPECT_EQ(chest.corrected[1], 2);
        EXPECT_FALSE(get(topple_result_correction, 2).held);
        EXPECT_EQ(topple_result_correction(result, 3, &named, &status), TOPPLE_ERROR_USAGE);
    }
    options.corrections_json = "{}";
    topple_result_release(result);
    EXPECT_EQ(parsed(), TOPPLE_ERROR_INPUT);
    EXPECT_THAT(status.message, testing::HasSubstr("schema"));
}

// Names are those of scene.json, of what is nested with a dot.
TEST_F(CApi, GivesNumbersByTheirNames) {
    ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
    const topple_object crate = object(1);
    std::vector<double> values(100);
    std::uint64_t count = 0;
    const auto code = [&](const char* of, std::uint64_t index, const char* field) {
        return topple_result_numbers(result, of, index, field, values.data(), values.size(), &count,
                                     &status);
    };
    ASSERT_EQ(code("object", 1, "mass_kg"), TOPPLE_OK) << status.message;
    EXPECT_EQ(count, 1u);
    EXPECT_EQ(values[0], crate.mass_kg);
    ASSERT_EQ(code("object", 1, "overturning.direction"), TOPPLE_OK);
    EXPECT_EQ(count, 3u);
    EXPECT_EQ(values[1], crate.overturning_direction[1]);
    ASSERT_EQ(code("object", 1, "why.stands_on"), TOPPLE_OK);
    EXPECT_EQ(count, crate.stands_on_count);
    EXPECT_EQ(values[0], crate.stands_on[0]);
    ASSERT_EQ(code("object", 1, "seen_enough"), TOPPLE_OK) << "no struct has it";
    EXPECT_EQ(values[0], 1);
    ASSERT_EQ(code("support", 0, "probability"), TOPPLE_OK) << "nor this";
    EXPECT_TRUE(values[0] > 0 && values[0] <= 1);
    ASSERT_EQ(code("scene", 0, "manhattan_from_input"), TOPPLE_OK);
    EXPECT_EQ(count, 16u);
    values.assign(2, 7);
    ASSERT_EQ(
        topple_result_numbers(result, "object", 1, "size_m", values.data(), 1, &count, nullptr),
        TOPPLE_OK);
    EXPECT_EQ(count, 3u);
    EXPECT_TRUE(values[0] == crate.size_m[0] && values[1] == 7) << "no more than there is room for";
    for (const auto& [of, field] : {std::pair{"object", "mode"},
                                    {"object", "mass"},
                                    {"object", "fall."},
                                    {"body", "mass_kg"}}) {
        EXPECT_EQ(code(of, 1, field), TOPPLE_ERROR_USAGE) << of << " " << field;
        EXPECT_THAT(status.message, testing::HasSubstr(field));
    }
    EXPECT_EQ(code("object", 99, "mass_kg"), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(code(nullptr, 0, "mass_kg"), TOPPLE_ERROR_USAGE);
}

TEST_F(CApi, SaysWhatMayBeTouched) {
    options.disturbances = 0;
    ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
    const topple_object crate = object(1);
    ASSERT_FALSE(crate.grounded);
    const double level[3] = {1, 0, 0}, upwards[3] = {0, 0, 1};
    const auto asked = [&](const double* way, double force_N, double impulse_Ns) {
        int stays = -1;
        const int code = topple_result_stays(result, 1, crate.center_of_mass_m, way, force_N,
                                             impulse_Ns, 0.02, &stays, &status);
        return code == TOPPLE_OK ? stays : -code;
    };
    EXPECT_EQ(asked(level, 1, 0.1), 1);
    EXPECT_EQ(asked(nullptr, 1, 0.1), 1);
    EXPECT_EQ(asked(nullptr, 2 * crate.slide_N, 0), 0);
    EXPECT_EQ(asked(nullptr, 0, crate.mass_kg), 0);
    EXPECT_EQ(asked(upwards, 1, 0), -TOPPLE_ERROR_USAGE);
    EXPECT_THAT(status.message, testing::HasSubstr("expected a level way"));
    EXPECT_EQ(asked(level, -1, 0), -TOPPLE_ERROR_USAGE);
    int stays = -1;
    EXPECT_EQ(topple_result_stays(result, 1, nullptr, level, 1, 0, 0.02, &stays, &status),
              TOPPLE_ERROR_USAGE);
    EXPECT_STREQ(status.message, "place_m is NULL");
    EXPECT_EQ(topple_result_stays(result, 99, level, level, 1, 0, 0.02, &stays, &status),
              TOPPLE_ERROR_USAGE);
}

TEST_F(CApi, SaysWhatHoldsWhatAndHowFirmly) {
    options.disturbances = 0;
    ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
    const topple_object crate = object(1);
    double least = -1;
    ASSERT_EQ(
        topple_result_stays_up_to(result, 1, crate.center_of_mass_m, nullptr, &least, &status),
        TOPPLE_OK);
    EXPECT_GT(least, 0);
    ASSERT_GT(crate.instability_count, 0u);
    const topple_step last = crate.instability[crate.instability_count - 1];
    double released = -1;
    for (const double energy : {last.W_J, 2 * last.W_J}) {
        ASSERT_EQ(topple_result_released(result, 1, energy, &released, &status), TOPPLE_OK);
        EXPECT_EQ(released, last.S_J);
    }
    ASSERT_EQ(topple_result_released(result, 1, 0.5 * crate.barrier_J, &released, &status),
              TOPPLE_OK);
    EXPECT_EQ(released, 0);
    EXPECT_EQ(topple_result_released(result, 1, -1, &released, &status), TOPPLE_ERROR_USAGE);
    for (const auto& [share, expected] : {std::pair{0.99, 1}, {1.01, 0}}) {
        int stays = -1;
        ASSERT_EQ(topple_result_stays(result, 1, crate.center_of_mass_m, nullptr, share * least, 0,
                                      0.02, &stays, &status),
                  TOPPLE_OK);
        EXPECT_EQ(stays, expected) << share;
    }
    const Scene& scene = result->result.scene;
    std::uint64_t count = 0;
    std::vector<std::int32_t> ids(scene.objects.size(), -7);
    const std::int32_t taken = 1;
    ASSERT_EQ(
        topple_result_falls_without(result, &taken, 1, ids.data(), ids.size(), &count, &status),
        TOPPLE_OK);
    EXPECT_EQ(count, falls_without(scene, {1}).falls.size());
    ASSERT_EQ(topple_result_removal_order(result, -1, ids.data(), 1, &count, &status), TOPPLE_OK);
    EXPECT_EQ(count, scene.objects.size() - 1) << "all but the building";
    EXPECT_EQ(ids[0], removal_steps(scene)[0][0]);
    EXPECT_EQ(ids[1], -7) << "no more than there is room for";
    double likely[8] = {};
    ASSERT_EQ(topple_result_held_by(result, 1, ids.data(), likely, 8, &count, &status), TOPPLE_OK);
    ASSERT_GE(count, 1u);
    EXPECT_EQ(ids[0], held_by(scene, 1)[0].object);
    EXPECT_EQ(likely[0], held_by(scene, 1)[0].probability);
    EXPECT_EQ(topple_result_held_by(result, 99, ids.data(), nullptr, 8, &count, &status),
              TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_falls_without(result, nullptr, 1, ids.data(), 8, &count, &status),
              TOPPLE_ERROR_USAGE);
}

// The structs are filled from the same list of fields as scene.json: one member of each kind.
TEST_F(CApi, ParsesAsTheLibraryDoes) {
    ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
    EXPECT_STREQ(status.message, "");
    ParseOptions cpp;
    cpp.device = device::open_device("native");
    cpp.disturbances = {"wind"};
    const Scene expected = parse(room.cloud, cpp).scene;
    const topple_scene scene = this->scene();
    ASSERT_EQ(scene.objects, expected.objects.size());
    ASSERT_EQ(scene.points, room.cloud.size());
    EXPECT_EQ(scene.notes, expected.notes.size());
    EXPECT_STREQ(scene.backend, "native");
    EXPECT_EQ(std::memcmp(topple_result_point_objects(result), expected.points.object.data(),
                          4 * scene.points),
              0);
    EXPECT_EQ(topple_result_point_normals(result, 2)[3], expected.points.nz[3]);
    EXPECT_EQ(topple_result_point_index(result), nullptr);
    for (std::size_t n = 0; n < scene.objects; ++n) {
        const topple_object object = this->object(n);
        const Object& o = expected.objects[n];
        EXPECT_EQ(object.barrier_J, o.barrier_J);
        double risk = 0, chance = 0;
        EXPECT_EQ(topple_result_risk(result, n, "wind", &risk, &chance, &status), TOPPLE_OK);
        EXPECT_EQ(risk, o.risk_J.at("wind"));
        double error = 0, spread = 0;
        EXPECT_EQ(topple_result_risk_error(result, n, "wind", &error, &spread, &status), TOPPLE_OK);
        EXPECT_EQ(error, o.risk_error_J.at("wind"));
        EXPECT_EQ(spread, o.risk_spread_J.at("wind"));
        EXPECT_EQ(topple_result_risk_error(result, n, "flood", &error, nullptr, &status),
                  TOPPLE_ERROR_USAGE);
        EXPECT_EQ(topple_result_risk(result, n, "human", &risk, nullptr, &status), TOPPLE_OK);
        EXPECT_TRUE(std::isnan(risk)) << "not asked for";
        EXPECT_EQ(object.unsafety_category, o.unsafety_category);
        EXPECT_EQ(object.unsafety_certain != 0, o.unsafety_certain);
        EXPECT_EQ(object.falls != 0, o.fall.falls);
        EXPECT_TRUE(std::isnan(object.people_share)) << "nobody was asked for";
        EXPECT_EQ(chance, o.fall_chance.at("wind"));
        EXPECT_EQ(topple_result_risk(result, n, "flood", &risk, nullptr, &status),
                  TOPPLE_ERROR_USAGE);
        EXPECT_THAT(status.message, testing::HasSubstr("earthquake"));
        EXPECT_EQ(object.advice_kind, o.advice.kind);
        EXPECT_EQ(object.why, o.why.sentence);
        EXPECT_EQ(object.action, o.advice.action);
        EXPECT_EQ(object.push_by_direction_N == nullptr, o.barrier_by_direction.push_N.empty());
        ASSERT_EQ(object.instability_count, o.instability.size());
        if (!o.instability.empty()) {
            EXPECT_EQ(object.instability[0].S_J, o.instability[0].S_J);
        }
        EXPECT_EQ(object.lands_m[0], o.fall.lands_m[0]);
        EXPECT_EQ(object.lands_on, o.fall.lands_on);
        ASSERT_EQ(object.stands_on_count, o.why.stands_on.size());
        EXPECT_TRUE(std::ranges::equal(std::span(object.stands_on, object.stands_on_count),
                                       o.why.stands_on));
        const topple::DirectedBarrier& directed = o.barrier_by_direction;
        ASSERT_EQ(object.blow_heights, directed.height_m.size());
        EXPECT_TRUE(
            std::equal(directed.blow_Ns.begin(), directed.blow_Ns.end(), object.blow_barrier_Ns));
        EXPECT_TRUE(
            std::equal(directed.push_N.begin(), directed.push_N.end(), object.push_by_direction_N));
    }
    EXPECT_EQ(get(topple_result_primitive, 0).mass_kg, expected.primitives[0].mass_kg);
    EXPECT_EQ(get(topple_result_contact, 0).relation, expected.contacts[0].relation);
    EXPECT_EQ(get(topple_result_support, 0).area_m2, expected.supports[0].area_m2);
    EXPECT_EQ(topple_result_write(result, path("map").c_str(), TOPPLE_WRITE_OCTOMAP, &status),
              TOPPLE_OK);
    EXPECT_TRUE(std::filesystem::exists(path("map/map.bt")));
    EXPECT_EQ(topple_result_write(result, path("map").c_str(), 8, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_write(result, path("out").c_str(), 0, &status), TOPPLE_OK);
    EXPECT_TRUE(std::filesystem::exists(path("out/scene.json")));
    const std::string exported = path("mjcf").string();
    EXPECT_EQ(topple_result_export(result, "mjcf", exported.c_str(), &status), TOPPLE_OK)
        << status.message;
    EXPECT_TRUE(std::filesystem::exists(path("mjcf/scene.xml")));
    EXPECT_TRUE(std::filesystem::exists(path("mjcf/bodies.json")));
    EXPECT_EQ(topple_result_export(result, "blend", exported.c_str(), &status), TOPPLE_ERROR_USAGE);
    EXPECT_THAT(status.message, testing::HasSubstr("\"blend\" is no format"));
    EXPECT_EQ(topple_result_export(result, "mjcf", "", &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_export(result, nullptr, exported.c_str(), &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_export(nullptr, "mjcf", exported.c_str(), &status), TOPPLE_ERROR_USAGE);
    write("others/scene.xml", "<mujoco/>");
    EXPECT_EQ(topple_result_export(result, "mjcf", path("others").c_str(), &status),
              TOPPLE_ERROR_INPUT);
    // The caller's colours, interleaved.
    std::vector<std::uint8_t> rgb(3 * room.cloud.size(), 50);
    cloud.red = &rgb[0];
    cloud.green = &rgb[1];
    cloud.blue = &rgb[2];
    cloud.colour_stride_bytes = 3;
    rgb[3] = 200;
    topple_result* coloured = nullptr;
    ASSERT_EQ(topple_parse_cloud(&cloud, &options, &coloured, &status), TOPPLE_OK)
        << status.message;
    EXPECT_EQ(topple_result_write(coloured, path("coloured").c_str(), 0, &status), TOPPLE_OK);
    const PointCloud back = io::read_cloud(path("coloured/points.ply"));
    ASSERT_EQ(back.red.size(), room.cloud.size());
    EXPECT_EQ(back.red[0], 50);
    EXPECT_EQ(back.red[1], 200);
    EXPECT_EQ(back.blue[1], 50);
    topple_result_release(coloured);
    // A file that the library wrote, parsed by its path.
    topple_result* again = nullptr;
    EXPECT_EQ(topple_parse(path("out/points.ply").c_str(), &options, &again, &status), TOPPLE_OK)
        << status.message;
    topple_result_release(again);
}

TEST_F(CApi, CoordinatesMayStayOutside) {
    options.without_coordinates = 1;
    options.disturbances = 0;
    ASSERT_EQ(parsed(), TOPPLE_OK) << status.message;
    EXPECT_EQ(topple_result_write(result, path("out").c_str(), 0, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(topple_result_add_coordinates(result, &cloud, &status), TOPPLE_OK);
    EXPECT_EQ(topple_result_write(result, path("out").c_str(), 0, &status), TOPPLE_OK)
        << status.message;
}

TEST_F(CApi, FramesAreParsedAsThoseOfCpp) {
    const scenes::Sequence walk = small_walk();
    std::vector<topple_frame> images(walk.frames.size());
    std::vector<double> poses;
    const FramesView expected = frames_view_of(walk);
    for (std::size_t n = 0; n < images.size(); ++n) {
        const DepthFrame& frame = walk.frames[n];
        topple_frame_init(&images[n], sizeof(topple_frame));
        images[n].depth = frame.depth.data();
        poses.insert(poses.end(), frame.camera_to_world.begin(), frame.camera_to_world.end());
    }
    topple_frames frames;
    topple_frames_init(&frames, sizeof(frames));
    frames.intrinsics = {96, 72, 83, 83, 47.5, 35.5, 1000};
    frames.count = images.size();
    frames.camera_to_world = poses.data();
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_ERROR_USAGE);
    frames.frames = images.data();
    options.disturbances = 0;
    ASSERT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_OK)
        << status.message;
    ParseOptions same;
    same.device = device::open_device("native", 2);
    same.disturbances = {};
    const ParseResult parsed = parse(expected, same);
    const Scene& scene = parsed.scene;
    const topple_scene got = this->scene();
    ASSERT_EQ(got.points, scene.points.x.size());
    EXPECT_STREQ(got.source, "frames");
    EXPECT_TRUE(std::ranges::equal(scene.points.object,
                                   std::span(topple_result_point_objects(result), got.points)));
    // The labels of pixels, too, which need the result no more.
    topple_labeller* labeller = nullptr;
    ASSERT_EQ(topple_labeller_create(result, &labeller, &status), TOPPLE_OK) << status.message;
    topple_result_release(result);
    result = nullptr;
    std::vector<std::int32_t> primitives(std::size_t{96} * 72), objects(primitives.size(), -7);
    ASSERT_EQ(
        topple_labeller_label(labeller, &frames, 2, primitives.data(), objects.data(), &status),
        TOPPLE_OK)
        << status.message;
    const FrameLabels labels = FrameLabeller(parsed).label(expected, 2);
    EXPECT_EQ(primitives, labels.primitive);
    EXPECT_EQ(objects, labels.object);
    EXPECT_EQ(topple_labeller_label(labeller, &frames, 2, nullptr, nullptr, &status), TOPPLE_OK);
    EXPECT_EQ(topple_labeller_label(labeller, &frames, 6, nullptr, objects.data(), &status),
              TOPPLE_ERROR_USAGE);
    EXPECT_STREQ(status.message, "frames: there is no frame 6: they count from 0, and there are 6");
    topple_labeller_release(labeller);
    EXPECT_EQ(topple_labeller_create(nullptr, &labeller, &status), TOPPLE_ERROR_USAGE);
    EXPECT_EQ(labeller, nullptr);

    // One by one, up to one that can't be had.
    frames.frames = nullptr;
    frames.user = images.data();
    frames.load = [](std::uint64_t n, topple_frame* frame, void* user) {
        *frame = static_cast<topple_frame*>(user)[n];
        return n == 3 ? 7 : 0;
    };
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_ERROR_INPUT);
    EXPECT_STREQ(status.message, "frames: load() returned 7 for frame 3");
    frames.camera_to_world = nullptr;
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_ERROR_USAGE);
    frames.count = 1;
    EXPECT_EQ(topple_parse_frames(&frames, &options, &result, &status), TOPPLE_OK)
        << status.message;
}

}  // namespace
}  // namespace topple::test
