// SPDX-License-Identifier: MIT
#include "host/pipeline/scan.h"
#include "host/pipeline/small_room.h"
#include "points/scale_checks.h"
#include "points/voxel_size.h"
#include "safety/earthquake/intensity.h"
#include "scale/estimate.h"
#include "topple/frame_labels.h"

// Options that make no sense are told before anything is parsed, and doubtful ones with the result.
namespace topple::test {
namespace {

template <class Call>
std::string refusal_of(const Call& call) {
    return message_of(call, ErrorKind::usage);
}

// `began`: what would show that a stage had begun.
template <class Input>
std::string refusal_before(const Input& input, ParseOptions options) {
    bool began = false;
    options.progress = [&](const std::string&, double) { began = true; };
    const std::string refused = refusal_of([&] { parse(input, options); });
    EXPECT_FALSE(began) << refused;
    return refused;
}

TEST(Options, WhatIsGivenTwiceOrIsNothingIsRefused) {
    const PointCloud cloud = SmallRoom::scattered().cloud;
    ParseOptions options;
    options.motions = {std::make_shared<BodyMotion>(), nullptr};
    EXPECT_EQ(refusal_before(cloud, options),
              "motion (--motion): number 1 is null; give what read_motion() returns, or leave "
              "it out");
    options.motions.clear();
    options.disturbances = {"human", "wind", "human"};
    const std::string twice = "disturbances (--disturbance): human is given twice; name each once";
    EXPECT_EQ(refusal_before(cloud, options), twice);
    EXPECT_EQ(refusal_of([&] { check_options(options); }), twice);
}

TEST(Options, AnEmptyPathIsNamed) {
    const std::string expected =
        "the path of the input is empty; give that of a file, or of a folder of depth frames";
    EXPECT_EQ(refusal_before(std::filesystem::path(), {}), expected);
    EXPECT_EQ(refusal_of([] { estimate("", {}); }), expected);
    EXPECT_EQ(refusal_of([] { FrameLabeller(ParseResult{}).label(std::filesystem::path(), 0); }),
              expected);
}

TEST(Options, AResultOfNoParseIsRefused) {
    EXPECT_EQ(refusal_of([] { write_outputs(ParseResult{}, "out"); }),
              "write_outputs: the result was read from a folder, which has no voxel grids, or no "
              "parse returned it: "
              "parse the scan again, or copy that folder");
}

TEST(Options, WhatIsForFilesIsRefusedOfWhatIsInMemory) {
    ParseOptions options;
    options.work_folder = "work";
    const std::string expected =
        "work_folder work: only clouds in files are parsed in blocks, which are kept there, and "
        "the "
        "scan is in memory; leave it out";
    EXPECT_EQ(refusal_before(FramesView{}, options), expected);
    EXPECT_EQ(refusal_before(CloudView{}, options), expected);
}

// Once, and of what is reckoned with alone. A peak of 0.3 m/s^2 was meant in g, perhaps.
TEST(Options, APeakInAnotherUnitIsAskedAbout) {
    const std::string weak = safety::unlikely_peak_note(0.3);
    EXPECT_EQ(weak,
              "pga_m_s2 (--pga) = 0.3 is 0.031 g (light shaking, intensity IV): for 0.3 g give "
              "pga_m_s2 (--pga) = 2.94.");
    EXPECT_EQ(safety::unlikely_peak_note(30),
              "pga_m_s2 (--pga) = 30 is 3.1 g (extreme shaking, intensity X or more), stronger "
              "than nearly all that were recorded; for 30 % of g give pga_m_s2 (--pga) = 2.94.");
    EXPECT_EQ(safety::unlikely_peak_note(3), "");
    PointCloud plane;
    for (int n = 0; n < 3600; ++n) test::add(plane, n % 60 / 30.0, n / 60 / 30.0, 0);
    ParseOptions options = on(device::open_device("native"));
    options.pga_m_s2 = 0.3;
    for (const char* disturbance : {"earthquake", "wind"}) {
        options.disturbances = {disturbance};
        const std::vector<std::string> notes = parse(plane, options).scene.notes;
        EXPECT_EQ(std::ranges::count(notes, weak), options.disturbances[0] == "earthquake");
    }
}

}  // namespace
}  // namespace topple::test

namespace topple {
namespace {

// The voxels of a level square of this edge.
double voxel_for_square(double cell_m, double edge_m, double points,
                        std::uint64_t max_memory_bytes) {
    const auto edge = static_cast<float>(edge_m);
    return voxel_for_scan(cell_m, edge_m * edge_m, {{0, 0, 0}, {edge, edge, 0.05f}}, points,
                          max_memory_bytes);
}

TEST(VoxelSize, DenseScansGetFinerVoxelsThanRooms) {
    EXPECT_DOUBLE_EQ(voxel_for_square(0.002, 5, 1e6, 0), 0.005);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.01, 5, 1e6, 0), 0.02);
}

TEST(VoxelSize, SparseRoomsGetThoseOfRooms) {
    for (const double cell : {0.02, 0.03, 0.06})
        EXPECT_DOUBLE_EQ(voxel_for_square(cell, 8, 1e4, 0), 0.02) << cell;
}

TEST(VoxelSize, HallsGetLargerOnesButNoneWithoutGaps) {
    // 45 x 45 m: five million voxels of 2 cm, two of 3 cm.
    EXPECT_DOUBLE_EQ(voxel_for_square(0.04, 45, 1e6, 0), 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.012, 45, 1e6, 0), 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.01, 45, 1e6, 0), 0.02);
}

TEST(VoxelSize, MemoryMakesThemLarger) {
    const double free = voxel_for_square(0.06, 8, 1e5, 0),
                 tight = voxel_for_square(0.06, 8, 1e5, 550 << 20);
    EXPECT_DOUBLE_EQ(free, 0.02);
    EXPECT_DOUBLE_EQ(tight, 0.03);
    EXPECT_DOUBLE_EQ(voxel_for_square(0.06, 8, 1e5, 1), voxel_for_cell(0.06));
}

TEST(VoxelSize, WhatIsAskedForOrKnownWins) {
    Observation input;
    input.cell_m = 0.02;
    ParseOptions options;
    EXPECT_DOUBLE_EQ(voxel_for_input(input, options), 0.02);
    input.voxel_m = 0.08;
    EXPECT_DOUBLE_EQ(voxel_for_input(input, options), 0.08);
    options.voxel_m = 0.05;
    EXPECT_DOUBLE_EQ(voxel_for_input(input, options), 0.05);
}

// Corners and middles of a box.
PointCloud box(double x, double y, double z) {
    PointCloud out;
    for (int n = 0; n < 27; ++n)
        test::add(out, x * (n % 3) / 2, y * (n / 3 % 3) / 2, z * (n / 9) / 2);
    return out;
}

// Rooms and small parts in other units than metres are told before the work; those in metres, and
// buildings as dense as scans are, are not.
TEST(UnitHint, by_size_and_spacing) {
    const struct {
        const char* what;
        Vec3 size;
        double spacing;
        ScanOrigin origin;
        const char* hint;  // null: none
    } cases[] = {
        {"a cube of 20 mm",
         {20, 20, 20},
         INFINITY,
         ScanOrigin::mesh_file,
         "unit_m = 0.001 (--unit mm) (0.020 m)"},
        {"a room in mm",
         {4000, 3000, 2500},
         INFINITY,
         ScanOrigin::mesh_file,
         "unit_m = 0.001 (--unit mm) (4.0 m)"},
        {"in cm", {400, 300, 250}, INFINITY, ScanOrigin::mesh_file, "(--unit cm) (4.0 m)"},
        {"in inches", {157, 118, 98}, 0.2, ScanOrigin::cloud_file, "(--unit in) (4.0 m)"},
        {"in feet", {13, 10, 8.2}, 0.03, ScanOrigin::cloud_file, "(--unit ft) (4.0 m)"},
        {"in memory", {13, 10, 8.2}, 0.03, ScanOrigin::cloud_in_memory, "by 0.3048 (4.0 m)"},
        {"a room", {4, 3, 2.5}, INFINITY, ScanOrigin::mesh_file, nullptr},
        {"a hall", {25, 20, 4.5}, 0.03, ScanOrigin::cloud_file, nullptr},
        {"a building", {60, 40, 12}, 0.01, ScanOrigin::cloud_file, nullptr},
        {"a map", {60, 40, 12}, 0.05, ScanOrigin::map_file, nullptr},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        const PointCloud cloud = box(c.size[0], c.size[1], c.size[2]);
        const std::string hint = unit_hint(cloud, c.spacing, c.origin);
        if (c.hint)
            EXPECT_NE(hint.find(c.hint), std::string::npos) << hint;
        else
            EXPECT_EQ(hint, "");
    }
}

}  // namespace
}  // namespace topple
