// SPDX-License-Identifier: MIT
#include "clouds.h"
#include "las_files.h"
#include "points/formats/read_cloud.h"
#include "points/formats/scan_notes.h"

// Units that a file states.
namespace topple::io {
namespace {

using test::append;
using test::expect_input_error;

class StatedUnit : public test::Files {
  protected:
    // x and z of a point at (1000, 0, 1000), and that it is noted unless it is in metres.
    void expect_metres(const std::filesystem::path& file, double ground, double height) const {
        const auto cloud = read_cloud(file);
        EXPECT_NEAR(cloud.x[0], 1000 * ground, 1e-3);
        EXPECT_NEAR(cloud.z[0], 1000 * height, 1e-3);
        const bool noted = std::ranges::any_of(cloud.notes, [](const std::string& note) {
            return note.find("unit of the file's coordinates") != std::string::npos;
        });
        EXPECT_EQ(noted, ground != 1 || height != 1);
        // What is asked for goes first.
        EXPECT_NEAR(read_cloud(file, 0.01).z[0], 10, 1e-3);
    }
};

using Keys = std::vector<std::array<std::uint16_t, 4>>;

std::string record(std::uint16_t id, const std::string& body, bool extended) {
    std::string out(2, '\0');
    out += "LASF_Projection";
    out.push_back('\0');
    append<std::uint16_t>(out, id);
    if (extended)
        append<std::uint64_t>(out, body.size());
    else
        append<std::uint16_t>(out, static_cast<std::uint16_t>(body.size()));
    return out + std::string(32, '\0') + body;
}

std::vector<std::string> key_records(const Keys& keys, double size) {
    std::string directory, doubles;
    for (const std::uint16_t v : {std::uint16_t{1}, std::uint16_t{1}, std::uint16_t{0},
                                  static_cast<std::uint16_t>(keys.size())})
        append(directory, v);
    for (const auto& key : keys)
        for (const std::uint16_t v : key) append(directory, v);
    append(doubles, size);
    return {record(34735, directory, false), record(34736, doubles, false)};
}

TEST_F(StatedUnit, of_las_by_its_keys) {
    const double foot = 0.3048, survey = 1200.0 / 3937;
    const struct {
        Keys keys;
        double ground, height;
    } cases[] = {
        {{}, 1, 1},
        {{{3076, 0, 1, 9001}}, 1, 1},
        {{{1024, 0, 1, 1}, {3076, 0, 1, 9002}}, foot, foot},
        {{{3076, 0, 1, 9003}, {4099, 0, 1, 9003}}, survey, survey},
        {{{3076, 0, 1, 9002}, {4099, 0, 1, 9001}}, foot, 1},
        {{{3076, 0, 1, 9001}, {4099, 0, 1, 9002}}, 1, foot},
        {{{4099, 0, 1, 9003}}, survey, survey},
        {{{3076, 0, 1, 32767}, {3077, 34736, 1, 0}}, 0.5, 0.5},
        {{{3076, 0, 1, 4711}}, 1, 1},
    };
    for (const auto& c : cases) {
        test::LasFile las;
        las.points = {{1'000'000, 0, 1'000'000}, {1, 2, 3}};
        las.records = key_records(c.keys, 0.5);
        SCOPED_TRACE(c.keys.size() > 0 ? c.keys.back()[3] : 0);
        expect_metres(write("a.las", las.bytes()), c.ground, c.height);
    }
}

TEST_F(StatedUnit, of_las_by_its_wkt) {
    const std::string geographic =
        R"(GEOGCS["NAD83",DATUM["NAD",SPHEROID["GRS",6378137,298.2]],UNIT["degree",0.0174532925]])";
    const std::string projected =
        R"(PROJCS["NY [ft]",)" + geographic + R"(,PARAMETER["false_easting",984250],)";
    const struct {
        std::string wkt;
        double ground, height;
    } cases[] = {
        {projected + R"(UNIT["metre",1]])", 1, 1},
        {projected + R"(UNIT["foot",0.3048]])", 0.3048, 0.3048},
        {R"(COMPD_CS["a",)" + projected +
             R"(UNIT["US survey foot",0.3048006096,AUTHORITY["EPSG","9003"]]],)" +
             R"(VERT_CS["NAVD88",VERT_DATUM["N",2005],UNIT["metre",1.0],AXIS["Up",UP]]])",
         0.3048006096, 1},
        {R"(PROJCRS["b",BASEGEOGCRS["NAD83",DATUM["N",ELLIPSOID["G",6378137,298,LENGTHUNIT["metre",1]]]],)"
         R"(CONVERSION["c",PARAMETER["e",0,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["E",east],)"
         R"(AXIS["N",north,LENGTHUNIT["foot",0.3048]]])",
         0.3048, 0.3048},
        {geographic, 1, 1},
    };
    for (const auto& c : cases) {
        for (const bool extended : {false, true}) {
            SCOPED_TRACE(c.wkt);
            test::LasFile las;
            las.minor = 4;
            las.points = {{1'000'000, 0, 1'000'000}, {1, 2, 3}};
            (extended ? las.records_behind : las.records) = {record(2112, c.wkt, extended)};
            expect_metres(write("a.las", las.bytes()), c.ground, c.height);
        }
    }
}

TEST_F(StatedUnit, degrees_are_no_coordinates_of_rooms) {
    test::LasFile las;
    las.scale = {1e-7, 1e-7, 1e-3};
    las.points = {{100, 100, 1000}, {500, 400, 3000}};
    las.records = key_records({{1024, 0, 1, 2}}, 0);
    las.extent = {4e-5, 3e-5, 2};
    expect_input_error([&] { read_cloud(write("a.las", las.bytes())); },
                       {"a.las", "degrees", "UTM"});
}

TEST_F(StatedUnit, by_a_header) {
    const std::string ply =
        "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1000 "
        "0 1000\n";
    const struct {
        std::string name, text;
        double metres;
    } cases[] = {
        {"a.ply", "ply\nformat ascii 1.0\ncomment units: mm\n" + ply, 0.001},
        {"a.ply", "ply\nformat ascii 1.0\ncomment Unit is the parsec\n" + ply, 1},
        {"a.xyz", "# Units = Inches\n1000 0 1000\n", 0.0254},
        {"a.xyz", "# units are in cm\n1000 0 1000\n", 0.01},
        {"a.xyz", "# unit: in\n1000 0 1000\n", 0.0254},
        {"a.xyz", "# unit vectors follow, in feet\n1000 0 1000\n", 1},
        {"a.csv", "X [mm];Y [mm];Z [mm]\n1000,0;0,0;1000,0\n", 0.001},
        {"a.csv", "x_ft,y_ft,z_ft\n1000,0,1000\n", 0.3048},
        {"a.csv", "index,x (m),y (m),z (m)\n7,1000,0,1000\n", 1},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.text);
        expect_metres(write(c.name, c.text), c.metres, c.metres);
    }
    std::string stl = "CAD; UNITS=mm";
    stl.resize(80, '\0');
    append<std::uint32_t>(stl, 1);
    for (const float v : {0, 0, 1, 0, 0, 0, 1000, 0, 0, 0, 1000, 0}) append<float>(stl, v);
    append<std::uint16_t>(stl, 0);
    const auto cloud = read_cloud(write("a.stl", stl));
    EXPECT_NEAR(*std::ranges::max_element(cloud.x), 1, 0.01);
}

class ScanNotes : public test::Files {};

TEST_F(ScanNotes, AreTheLinesBesideAFileOrWithinAFolder) {
    const auto scan = write("scan.ply", "ply\n");
    EXPECT_TRUE(scan_notes(scan).empty());
    write("scan.ply.topple-notes.txt", "The phone's poses drift.\r\n\n3 frames\x01 were lost.");
    EXPECT_EQ(scan_notes(scan),
              (std::vector<std::string>{"The phone's poses drift.", "3 frames\\x01 were lost."}));
    const auto folder = scan.parent_path() / "frames";
    std::filesystem::create_directories(folder / "topple-notes.txt");
    EXPECT_TRUE(scan_notes(folder).empty()) << "a folder of that name is none";
    std::filesystem::remove(folder / "topple-notes.txt");
    write("frames/topple-notes.txt", "One.\n");
    EXPECT_EQ(scan_notes(folder), std::vector<std::string>{"One."});
}

TEST_F(ScanNotes, AreNotOfOthers) {
    write("secret.txt", "4711");
    const auto scan = write("in/scan.ply", "ply\n"), notes = path("in/scan.ply.topple-notes.txt");
    for (const char* target : {"../secret.txt", "scan.ply"}) {
        std::filesystem::create_symlink(target, notes);
        test::expect_input_error([&] { scan_notes(scan); },
                                 {"scan.ply.topple-notes.txt", "a link"});
        std::filesystem::remove(notes);
    }
}

TEST_F(ScanNotes, OfAnySizeAreFew) {
    const auto scan = write("scan.ply", "ply\n");
    std::string many;
    for (int n = 0; n < 100; ++n) many += "Note " + std::to_string(n) + ".\n";
    for (const std::string& text :
         {many, std::string(3'000'000, 'x'), many + std::string(90'000, '\n')}) {
        write("scan.ply.topple-notes.txt", text);
        const auto notes = scan_notes(scan);
        ASSERT_LE(notes.size(), 51u);
        EXPECT_TRUE(notes.back().ends_with("scan.ply.topple-notes.txt was left out."))
            << notes.back();
        for (const auto& note : notes) EXPECT_LT(note.size(), 1100u);
    }
}

using namespace test;

class Las : public test::Files {};

TEST_F(Las, points_of_every_version_and_format) {
    for (const unsigned minor : {0u, 1u, 2u, 3u, 4u}) {
        for (unsigned format = 0; format <= 10; ++format) {
            SCOPED_TRACE(std::to_string(minor) + " " + std::to_string(format));
            LasFile las;
            las.minor = minor;
            las.format = format;
            las.points = {{1000, -2000, 3000}, {1500, 2500, -3500}};
            const auto cloud = read_cloud(write("a.las", las.bytes()));
            EXPECT_EQ(points_of(cloud), (Points{{1, -2, 3}, {1.5f, 2.5f, -3.5f}}));
            EXPECT_EQ(cloud.offset_m, (Vec3{0, 0, 0}));
        }
    }
}

// A house in UTM coordinates, to the millimetre.
TEST_F(Las, coordinates_far_away_keep_their_precision) {
    LasFile las;
    las.offset = {500000, 5400000, 0};
    las.points = {{123456789, 87654321, 1234}, {123456790, 87654320, 2345}};
    const auto cloud = read_cloud(write("a.las", las.bytes()));
    ASSERT_EQ(cloud.size(), 2u);
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_NEAR(cloud.x[n] + cloud.offset_m[0], 500000 + las.points[n][0] * 1e-3, 1e-6);
        EXPECT_NEAR(cloud.y[n] + cloud.offset_m[1], 5400000 + las.points[n][1] * 1e-3, 1e-6);
        EXPECT_NEAR(cloud.z[n] + cloud.offset_m[2], las.points[n][2] * 1e-3, 1e-6);
        EXPECT_LT(std::abs(cloud.x[n]), 2);
    }
    ASSERT_EQ(cloud.notes.size(), 1u);
    EXPECT_THAT(cloud.notes[0], testing::HasSubstr("offset_m"));
    // Where its numbers begin, as a scanner that was moved there still has its own place.
    EXPECT_NEAR(cloud.origin_m[0] + cloud.offset_m[0], 500000, 1e-6);
    EXPECT_NEAR(cloud.origin_m[1] + cloud.offset_m[1], 5400000, 1e-6);
    // Feet, or what they may be.
    const auto scaled = read_cloud(path("a.las"), 0.3048);
    EXPECT_NEAR(scaled.x[0] + scaled.offset_m[0], 0.3048 * (500000 + 123456.789), 1e-6);
}

TEST_F(Las, withheld_points_are_dropped) {
    for (const unsigned format : {0u, 6u}) {
        LasFile las;
        las.minor = 4;
        las.format = format;
        las.points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
        las.withheld = {1};
        const auto cloud = read_cloud(write("a.las", las.bytes()));
        EXPECT_EQ(cloud.size(), 2u);
        EXPECT_EQ(cloud.dropped, 1u);
    }
}

TEST_F(Las, bad_files) {
    LasFile good;
    good.points = {{1, 2, 3}, {4, 5, 6}};
    const auto changed = [&](std::size_t at, int byte) {
        auto bytes = good.bytes();
        bytes[at] = static_cast<char>(byte);
        return bytes;
    };
    LasFile nan = good;
    nan.offset[1] = std::nan("");
    LasFile none = good;
    none.points = {};
    const BadFile cases[] = {
        {"LAS", {"\"LASF\""}},
        {"LASF", {"227 bytes", "the file 4"}},
        {changed(24, 2), {"LAS 2.2", "1.0 to 1.4"}},
        {changed(104, 0x80), {"LAZ", "las2las"}},
        {changed(104, 11), {"format 11"}},
        {changed(104, 3), {"20 bytes", "takes 34"}},
        {changed(108, 1), {"258 points", "cut short"}},
        {changed(99, 127), {"cut short"}},
        {good.bytes().substr(0, good.bytes().size() - 1), {"2 points", "cut short"}},
        {nan.bytes(), {"nan", "finite"}},
        {none.bytes(), {"has no points"}},
    };
    expect_refused("a.las", cases, [](const auto& file) { read_cloud(file); });
    expect_input_error([&] { read_cloud(write("a.laz", changed(104, 0x81))); }, {"LAZ"});
}

// Beyond that, coordinates a scale apart are one number.
TEST_F(Las, offsets_that_swallow_the_scale) {
    LasFile las;
    las.points = {{0, 0, 0}, {1, 2, 3}};
    las.offset = {1e12, 0, -1e12};
    EXPECT_EQ(read_cloud(write("a.las", las.bytes())).x.size(), 2u);
    for (const double offset : {1e15, -1e15, 1e300}) {
        las.offset = {0, offset, 0};
        expect_input_error([&] { read_cloud(write("a.las", las.bytes())); },
                           {"a.las", "offset", "scale of 0.001 is lost"});
    }
}

TEST_F(Las, colours_of_16_bits_or_of_8) {
    for (const unsigned format : {2u, 3u, 5u, 7u, 8u, 10u}) {
        for (const unsigned step : {1u, 257u}) {
            SCOPED_TRACE(std::to_string(format) + " " + std::to_string(step));
            LasFile las;
            las.minor = 4;
            las.format = format;
            las.points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
            las.withheld = {1};
            for (const unsigned v : {200u, 40u, 0u}) {
                las.colours.push_back(
                    {static_cast<std::uint16_t>(v * step), static_cast<std::uint16_t>(step), 0});
            }
            const auto cloud = read_cloud(write("a.las", las.bytes()));
            EXPECT_EQ(colours_of(cloud), (Colours{{200, 1, 0}, {0, 1, 0}}));
            las.colours.clear();
            EXPECT_TRUE(read_cloud(write("a.las", las.bytes())).red.empty()) << "room for them";
        }
    }
}

}  // namespace
}  // namespace topple::io
