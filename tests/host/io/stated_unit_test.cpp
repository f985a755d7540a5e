// SPDX-License-Identifier: MIT
#include "files.h"
#include "las_files.h"
#include "points/formats/read_cloud.h"

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

}  // namespace
}  // namespace topple::io
