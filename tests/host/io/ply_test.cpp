// SPDX-License-Identifier: MIT
#include "clouds.h"
#include "files.h"
#include "points/formats/read_cloud.h"

namespace topple::io {
namespace {

using namespace test;

class Ply : public test::Files {};

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

std::string header(const std::string& format, const std::string& rest) {
    return "ply\nformat " + format + " 1.0\ncomment made by a test\n" + rest + "end_header\n";
}
std::string ascii(const std::string& rest) {
    return header("ascii", rest);
}
std::string binary(const std::string& rest, bool big = false) {
    return header(big ? "binary_big_endian" : "binary_little_endian", rest);
}
// The header of `count` points as text.
std::string points(int count) {
    return ascii("element vertex " + std::to_string(count) + "\n" + xyz);
}

TEST_F(Ply, ascii_with_comments_blank_ends_and_carriage_returns) {
    const auto file =
        write("a.ply",
              "ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement vertex 2\r\n"
              "property float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n"
              "1 2 3\r\n-4.5e-1 +5 6\r\n");
    const auto cloud = read_cloud(file);
    EXPECT_EQ(points_of(cloud), (Points{{1, 2, 3}, {-0.45f, 5, 6}}));
    EXPECT_TRUE(cloud.nx.empty());
    EXPECT_EQ(cloud.dropped, 0u);
    EXPECT_EQ(cloud.width, 0u);
    EXPECT_EQ(cloud.source, file.string());
}

TEST_F(Ply, each_vertex_may_have_a_viewpoint) {
    const std::string rest = "element vertex 2\nproperty float vp_x\n" + xyz +
                             "property double vp_y\nproperty float vp_z\n";
    const auto cloud = read_cloud(write("a.ply", ascii(rest) + "7 1 2 3 8 9\n4 1 2 4 5 1e30\n"));
    EXPECT_EQ(viewpoints_of(cloud)[0], (std::array<float, 3>{7, 8, 9}));
    EXPECT_TRUE(std::isnan(cloud.viewpoint_z[1])) << "no metres";
    std::string bytes = binary(rest);
    for (const float v : {7.0f, 1.0f, 2.0f, 3.0f}) append<float>(bytes, v);
    append<double>(bytes, 8);
    for (const float v : {9.0f, 4.0f, 1.0f, 2.0f, 4.0f}) append<float>(bytes, v);
    append<double>(bytes, 5);
    append<float>(bytes, 6);
    EXPECT_EQ(viewpoints_of(read_cloud(write("b.ply", bytes))), (Points{{7, 8, 9}, {4, 5, 6}}));
}

TEST_F(Ply, properties_in_any_order_with_lists_and_elements_to_skip) {
    const auto text = ascii(
        "element camera 1\nproperty list uchar int ids\nproperty float f\n"
        "element vertex 2\nproperty uchar red\nproperty double z\n"
        "property list uint8 int32 tags\nproperty float nx\nproperty float ny\n"
        "property float nz\nproperty int16 x\nproperty float64 y\n"
        "element face 1\nproperty list uchar int vertex_indices\n");
    const auto cloud = read_cloud(write("a.ply", text + "3 7 8 9 0.5\n"
                                                        "255 3 2 100 200 0 0 2 1 2\n"
                                                        "0 6 0 0 3 4 -1 5.25\n"
                                                        "3 0 1 0\n"));
    EXPECT_EQ(points_of(cloud), (Points{{1, 2, 3}, {-1, 5.25f, 6}}));
    EXPECT_EQ(normals_of(cloud), (Points{{0, 0, 1}, {0, 0.6f, 0.8f}})) << "made unit length";
}

// Every number type, in both byte orders, before, between and after the coordinates.
template <class T>
void put_vertices(std::string& bytes, bool big) {
    for (int i = 0; i < 3; ++i) {
        append<std::uint8_t>(bytes, 7, big);
        append(bytes, static_cast<T>(10 * i + 1), big);
        append<std::int16_t>(bytes, -7, big);
        append(bytes, static_cast<T>(10 * i + 2), big);
        append(bytes, static_cast<T>(10 * i + 3), big);
        append<double>(bytes, 1e30, big);
    }
}

TEST_F(Ply, binary_in_every_type_and_byte_order) {
    using Put = void (*)(std::string&, bool);
    const std::pair<const char*, Put> types[] = {
        {"char", put_vertices<std::int8_t>},     {"int8", put_vertices<std::int8_t>},
        {"uchar", put_vertices<std::uint8_t>},   {"uint8", put_vertices<std::uint8_t>},
        {"short", put_vertices<std::int16_t>},   {"int16", put_vertices<std::int16_t>},
        {"ushort", put_vertices<std::uint16_t>}, {"uint16", put_vertices<std::uint16_t>},
        {"int", put_vertices<std::int32_t>},     {"int32", put_vertices<std::int32_t>},
        {"uint", put_vertices<std::uint32_t>},   {"uint32", put_vertices<std::uint32_t>},
        {"int64", put_vertices<std::int64_t>},   {"uint64", put_vertices<std::uint64_t>},
        {"float", put_vertices<float>},          {"float32", put_vertices<float>},
        {"double", put_vertices<double>},        {"float64", put_vertices<double>},
    };
    for (const bool big : {false, true}) {
        for (const auto& [type, put] : types) {
            const std::string t = type;
            auto bytes = binary("element vertex 3\nproperty uchar a\nproperty " + t +
                                    " x\nproperty short b\nproperty " + t + " y\nproperty " + t +
                                    " z\nproperty double c\n",
                                big);
            put(bytes, big);
            EXPECT_EQ(points_of(read_cloud(write("a.ply", bytes))),
                      (Points{{1, 2, 3}, {11, 12, 13}, {21, 22, 23}}))
                << t << " big " << big;
        }
    }
}

TEST_F(Ply, binary_with_lists_before_and_in_the_vertices) {
    for (const bool big : {false, true}) {
        auto bytes = binary(
            "element face 2\nproperty list uchar int vertex_indices\nproperty float area\n"
            "element vertex 2\nproperty list ushort float weights\n" +
                xyz,
            big);
        for (const int corners : {3, 4}) {
            append(bytes, static_cast<std::uint8_t>(corners), big);
            for (int i = 0; i < corners; ++i) append<std::int32_t>(bytes, i, big);
            append<float>(bytes, 0.5f, big);
        }
        for (const int weights : {0, 300}) {
            append(bytes, static_cast<std::uint16_t>(weights), big);
            for (int i = 0; i < weights; ++i) append<float>(bytes, 9, big);
            for (const float value : {1.0f, 2.0f, 3.0f}) append(bytes, value + float(weights), big);
        }
        EXPECT_EQ(points_of(read_cloud(write("a.ply", bytes))),
                  (Points{{1, 2, 3}, {301, 302, 303}}));
    }
}

TEST_F(Ply, what_is_not_finite_is_dropped_and_counted) {
    const auto text = ascii("element vertex 5\n" + xyz +
                            "property float nx\nproperty float ny\nproperty float nz\n");
    const auto cloud =
        read_cloud(write("a.ply", text + "nan 0 0 0 0 1\n1 2 3 nan 0 0\n0 inf 0 0 0 1\n"
                                         "0 0 -inf 0 0 1\n4 5 6 0 0 -2\n"));
    EXPECT_EQ(points_of(cloud), (Points{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(cloud.dropped, 3u);
    EXPECT_EQ(cloud.nz, (std::vector<float>{0, -1})) << "a normal that is not finite is none";
}

TEST_F(Ply, bad_files_are_refused_with_their_reason) {
    const std::string any = "ply\nformat ascii 1.0\n";
    const std::string zeros(24, '\0');
    const auto vertices = [](const char* count) {
        return "element vertex " + std::string(count) + "\n" + xyz;
    };
    const auto face = [&](const char* count, const char* length) {
        return binary("element face " + std::string(count) + "\nproperty list " + length +
                      " int a\n" + vertices("1"));
    };
    const BadFile cases[] = {
        {"solid cube\n", {"\"solid cu\"", "starts with \"ply\""}},
        {std::string("\x00\xff\x1b[31m", 7), {"\\x00\\xff\\x1b"}},
        {any + "element vertex 1\n", {"no end_header", "3 lines"}},
        {"ply\nelement vertex 0\nend_header\n", {"no format"}},
        {"ply\nformat middle_endian 1.0\nend_header\n", {"line 2", "middle_endian"}},
        {"ply\nformat ascii 2.0\nend_header\n", {"line 2", "2.0"}},
        {any + "format binary_little_endian 1.0\nend_header\n", {"line 3", "two format lines"}},
        {binary("element vertex 1\nproperty float x y\n"), {"line 5", "\"y\" stands after"}},
        {binary(std::string("comment a\0b\n", 12)), {"line 4", "control character"}},
        {any + "vertices 3\nend_header\n", {"line 3", "vertices"}},
        {binary("element vertex 1\nproperty half x\n"), {"line 5", "half"}},
        {binary("element face 1\nproperty list float int a\n"), {"line 5"}},
        {binary("element face 0\nproperty uchar x\n"), {"no element vertex"}},
        {binary("element vertex 1\nproperty float x\nproperty float y\n") + zeros,
         {"no property z"}},
        {binary("element vertex 1\nproperty float x\n" + xyz) + zeros, {"two properties x"}},
        {binary("element vertex 1\nproperty list uchar float x\nproperty float y\n") + zeros,
         {"property x is a list"}},
        {any + "property float x\nend_header\n", {"before the first element"}},
        {binary(vertices("-1")), {"needs a count", "-1"}},
        {binary(vertices("99999999999999999999")), {"needs a count"}},
        {binary(vertices("0")), {"no points"}},
        {binary(vertices("2")) + zeros.substr(1), {"24 bytes", "23"}},
        {binary(vertices("1000000000000")) + zeros, {"1000000000000", "12000000000000 bytes"}},
        {ascii(vertices("1000000000000")) + "1 2 3\n", {"1000000000000", "are left"}},
        {binary(vertices("18446744073709551615")) + zeros, {"18446744073709551615", "24"}},
        {face("1000000000000", "uchar") + zeros, {"face", "1000000000000"}},
        {face("1", "uint") + "\xff\xff\xff\xff" + zeros, {"face", "17179869180 more bytes", "24"}},
        {face("1", "char") + "\xff" + zeros, {"length -1"}},
        {points(3) + "1.0000000 2.0000000 3.000000\n4 5 6\n", {"promises 3", "has 2"}},
        {points(2) + "1 2 3\n1 two 3\n", {"line 10", "\"two\""}},
        {points(1) + "1 2 3x\n", {"line 9", "\"3x\""}},
        {points(2) + "1.00 2.00\n3 4 5\n", {"line 9", "2 of the 3 values"}},
        {points(1) + "1 2 3 4\n", {"line 9", "more than"}},
        {points(2) + "nan 2 3\n1e999 2 3\n", {"none of its 2 points"}},
        {points(1) + "1 2 2e6\n", {"point 0", "2e+06", "1e+06 m", "units"}},
    };
    expect_refused("a.ply", cases, [](const auto& file) { read_cloud(file); });
}

// All vertices are there, and yet it is no whole file.
TEST_F(Ply, cut_within_its_faces) {
    const std::string elements =
        "element vertex 4\n" + xyz + "element face 2\nproperty list uchar int vertex_indices\n";
    const std::string text = ascii(elements) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    EXPECT_NO_THROW(read_cloud(write("a.ply", text)));
    std::string bytes = binary(elements);
    for (const float c : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) append(bytes, c);
    for (const std::int32_t third : {2, 3}) {
        append<std::uint8_t>(bytes, 3);
        for (const std::int32_t v : {0, third - 1, third}) append(bytes, v);
    }
    EXPECT_NO_THROW(read_cloud(write("b.ply", bytes)));
    std::vector<BadFile> cut{{text.substr(0, text.size() - 8), {"face"}}};
    for (const std::size_t less : {1u, 13u, 20u, 26u})
        cut.push_back({bytes.substr(0, bytes.size() - less), {"face"}});
    expect_refused("a.ply", cut, [](const auto& file) { read_cloud(file); });
    cut.erase(cut.begin());
    expect_refused("b.ply", cut,
                   [](const auto& file) { stream_cloud(file, 1, [](const PointCloud&) {}); });
}

TEST_F(Ply, is_known_by_its_first_bytes_whatever_its_name) {
    EXPECT_EQ(read_cloud(write("scan.dat", points(1) + "1 2 3\n")).size(), 1u);
    EXPECT_EQ(read_cloud(write("scan.pcd", points(1) + "1 2 3\n")).size(), 1u);
}

TEST_F(Ply, notes_what_looks_like_millimetres_unless_the_unit_is_given) {
    const auto notes = [&](const char* last, double unit_m = 1) {
        std::string out;
        for (const auto& note : read_cloud(write("a.ply", points(2) + last), unit_m).notes)
            out += note;
        return out;
    };
    const std::string millimetres = notes("0 0 0\n4000 2500 3000\n");
    EXPECT_THAT(millimetres, testing::HasSubstr("4000 m"));
    EXPECT_THAT(millimetres, testing::HasSubstr("unit_m = 0.001 (--unit mm)"));
    EXPECT_THAT(notes("500000 0 0\n500004 2 3\n"), testing::HasSubstr("offset"));
    EXPECT_EQ(notes("0 0 0\n4 2.5 3\n"), "");
    EXPECT_EQ(notes("0 0 0\n4000 2500 3000\n", 0.001), "");
    EXPECT_EQ(points_of(read_cloud(path("a.ply"), 0.001))[1], (std::array{4.0f, 2.5f, 3.0f}));
}

TEST_F(Ply, points_without_a_header_are_told_from_damage) {
    for (const char* name : {"a.ply", "a.pcd"}) {
        expect_input_error([&] { read_cloud(write(name, "\n0.5 1 2\n3 4 5\n")); },
                           {name, "no header", ".xyz"});
    }
    expect_input_error([&] { read_cloud(write("a.ply", "1 2 three\n")); }, {"damaged"});
    expect_input_error([&] { read_cloud(write("a.ply", "1 2\n")); }, {"damaged"});
}

TEST_F(Ply, files_that_can_not_be_read) {
    expect_input_error([&] { read_cloud(path("missing.ply")); }, {"missing.ply", "No such file"});
    expect_input_error([&] { read_cloud(write("empty.ply", "")); },
                       {"empty.ply", "empty", "0 bytes"});
    expect_input_error([&] { read_cloud(folder_); }, {"folder"});
    expect_input_error([&] { read_cloud(write("a.png", "\x89PNG")); }, {"\".png\"", ".ply"});
    for (const char* name : {"a.e57", "b.mcap", "c.R3D"}) {
        expect_input_error([&] { read_cloud(write(name, "abc")); },
                           {name, "python3 -m topple.formats convert"});
    }
    expect_input_error([&] { read_cloud(write("two\nlines.xyz", "a")); }, {"two\\x0alines.xyz"});
}

std::string coloured_header(const std::string& format, const std::string& type,
                            const std::string& prefix = "") {
    std::string rest = "element vertex 3\n" + xyz;
    for (const char* channel : {"red", "green", "blue"})
        rest += "property " + type + " " + prefix + channel + "\n";
    return header(format, rest + "property uchar alpha\n");
}

TEST_F(Ply, colours_of_every_type_and_brightness) {
    const struct {
        const char *type, *prefix, *values[3];
    } cases[] = {
        {"uchar", "", {"255 0 51", "0 0 0", "1 2 3"}},
        {"uchar", "diffuse_", {"255 0 51", "0 0 0", "1 2 3"}},
        {"int", "", {"255 0 51", "0 0 0", "1 2 3"}},
        {"ushort", "", {"255 0 51", "0 0 0", "1 2 3"}},
        {"ushort", "", {"65535 0 13107", "0 0 0", "257 514 771"}},
        {"float", "", {"1 0 0.2", "0 0 0", "0.0039 0.0079 0.0118"}},
        {"float", "", {"255 0 51", "0 0 0", "1 2 3"}},
        {"double", "", {"65535 0 13107", "nan 1 1", "257 514 771"}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(std::string(c.type) + " " + c.values[0]);
        std::string text = coloured_header("ascii", c.type, c.prefix);
        for (const char* values : c.values) text += std::string("1 2 3 ") + values + " 255\n";
        EXPECT_EQ(colours_of(read_cloud(write("a.ply", text))),
                  (Colours{{255, 0, 51}, {0, 0, 0}, {1, 2, 3}}));
    }
}

TEST_F(Ply, binary_colours_in_both_byte_orders) {
    for (const bool big : {false, true}) {
        std::string bytes =
            coloured_header(big ? "binary_big_endian" : "binary_little_endian", "ushort");
        for (int i = 0; i < 3; ++i) {
            for (const float v : {1.0f, 2.0f, i == 1 ? NAN : 3.0f}) append(bytes, v, big);
            for (const int v : {65535, 257 * i, 0})
                append(bytes, static_cast<std::uint16_t>(v), big);
            append<std::uint8_t>(bytes, 255, big);
        }
        const auto cloud = read_cloud(write("a.ply", bytes));
        EXPECT_EQ(cloud.dropped, 1u);
        EXPECT_EQ(colours_of(cloud), (Colours{{255, 0, 0}, {255, 2, 0}})) << "of what is kept";
    }
}

TEST_F(Ply, colours_that_are_none) {
    const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const auto red_of = [&](const std::string& properties, const std::string& values) {
        const auto text = ascii("element vertex 1\n" + xyz + properties) + "1 2 3 " + values;
        return read_cloud(write("a.ply", text)).red;
    };
    EXPECT_TRUE(red_of(rgb, "0 0 0\n").empty()) << "nothing was written there";
    EXPECT_TRUE(red_of("property uchar red\nproperty uchar green\n", "7 7\n").empty());
    const std::string labels = "property int primitive\nproperty int object\n";
    EXPECT_TRUE(red_of(labels + rgb, "1 1 7 7 7\n").empty()) << "the palette of points.ply";
    EXPECT_EQ(red_of(rgb, "7 7 7\n"), std::vector<std::uint8_t>{7});
    expect_input_error([&] { red_of(rgb, "7 x 7\n"); }, {"a.ply", "\"x\" is not a number"});
    expect_input_error([&] { red_of(rgb + rgb, "7 7 7 7 7 7\n"); }, {"two properties red"});
}

using test::append;
using test::expect_input_error;

struct Splat {
    float x, y, z, opacity;  // a logit
    float red, green, blue;  // the constant terms of the spherical harmonics
};

// As trainers write them: normals of 0, higher terms of the colour, then opacity, scale and turn.
std::string splats_ply(const std::vector<Splat>& splats, bool ascii, bool with_rotation = true) {
    std::string names =
        "x y z nx ny nz f_dc_0 f_dc_1 f_dc_2 f_rest_0 f_rest_1 f_rest_2 opacity "
        "scale_0 scale_1 scale_2";
    if (with_rotation) names += " rot_0 rot_1 rot_2 rot_3";
    std::string out = std::string("ply\nformat ") + (ascii ? "ascii" : "binary_little_endian") +
                      " 1.0\nelement vertex " + std::to_string(splats.size()) + "\n";
    std::size_t fields = 0;
    for (std::size_t at = 0; at < names.size(); ++fields) {
        const auto end = std::min(names.find(' ', at), names.size());
        out += std::string("property float ") + names.substr(at, end - at) + "\n";
        at = end + 1;
    }
    out += "end_header\n";
    for (const Splat& s : splats) {
        std::vector<float> values{s.x, s.y, s.z,       0,  0,  0,  s.red, s.green, s.blue, 9,
                                  9,   9,   s.opacity, -4, -4, -4, 1,     0,       0,      0};
        values.resize(fields);
        for (const float value : values) {
            if (ascii) {
                out += std::to_string(value) + " ";
            } else {
                append(out, value);
            }
        }
        if (ascii) out += "\n";
    }
    return out;
}

class Splats : public test::Files {};

TEST_F(Splats, centres_of_what_is_opaque_become_points_with_colours) {
    const float y00 = static_cast<float>(0.5 / std::sqrt(3.14159265358979323846));
    const std::vector<Splat> splats{{1, 2, 3, 4, 0.5f / y00, -0.5f / y00, 0},
                                    {4, 5, 6, -0.1f, 0, 0, 0},
                                    {7, 8, 9, 0.1f, 9, -9, NAN}};
    for (const bool ascii : {true, false}) {
        SCOPED_TRACE(ascii);
        const auto cloud = read_cloud(write("splats.ply", splats_ply(splats, ascii)));
        EXPECT_EQ(cloud.x, (std::vector<float>{1, 7}));
        EXPECT_EQ(cloud.z, (std::vector<float>{3, 9}));
        EXPECT_EQ(cloud.red, (std::vector<std::uint8_t>{255, 0}));  // one term of the last is NaN
        EXPECT_EQ(cloud.green, (std::vector<std::uint8_t>{1, 0}));  // 0, 0, 0 would be unknown
        EXPECT_EQ(cloud.blue, (std::vector<std::uint8_t>{128, 0}));
        EXPECT_TRUE(cloud.nx.empty());
        EXPECT_EQ(cloud.dropped, 0u);
        ASSERT_EQ(cloud.notes.size(), 1u);
        EXPECT_THAT(cloud.notes[0], testing::HasSubstr("2 splats of 3"));
    }
}

TEST_F(Splats, come_in_portions_like_any_cloud) {
    write("splats.ply", splats_ply({{1, 2, 3, 4, 0, 0, 0}, {4, 5, 6, -4, 0, 0, 0}}, false));
    std::size_t points = 0;
    const auto rest =
        stream_cloud(path("splats.ply"), 1, [&](PointCloud portion) { points += portion.size(); });
    EXPECT_EQ(points, 1u);
    ASSERT_EQ(rest.notes.size(), 1u);
    EXPECT_THAT(rest.notes[0], testing::HasSubstr("1 splat of 2"));
}

TEST_F(Splats, a_cloud_with_an_opacity_is_none) {
    const auto cloud = read_cloud(
        write("cloud.ply", splats_ply({{1, 2, 3, -5, 0, 0, 0}}, true, /*with_rotation=*/false)));
    EXPECT_EQ(cloud.size(), 1u);
    EXPECT_TRUE(cloud.notes.empty());
}

TEST_F(Splats, that_show_no_surface_or_are_packed_are_refused) {
    expect_input_error(
        [&] {
            read_cloud(write("haze.ply",
                             splats_ply({{1, 2, 3, -1, 0, 0, 0}, {1, 2, 4, NAN, 0, 0, 0}}, false)));
        },
        {"haze.ply", "2 Gaussian splats", "half opaque"});
    expect_input_error(
        [&] {
            read_cloud(write("packed.ply",
                             "ply\nformat ascii 1.0\nelement vertex 1\nproperty uint "
                             "packed_position\nproperty uint packed_color\nend_header\n1 2\n"));
        },
        {"packed.ply", "Gaussian splats", "not compressed"});
    expect_input_error(
        [&] {
            const auto whole = splats_ply({{1, 2, 3, 1, 0, 0, 0}}, false);
            read_cloud(write("cut.ply", whole.substr(0, whole.size() - 3)));
        },
        {"cut.ply"});
}

}  // namespace
}  // namespace topple::io
