// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "files.h"
#include "points/formats/read_cloud.h"

namespace topple::io {
namespace {

using test::append;
using test::expect_input_error;

class Ply : public test::Files {};

std::string header(const std::string& format, const std::string& rest) {
    return "ply\nformat " + format + " 1.0\ncomment made by a test\n" + rest + "end_header\n";
}

TEST_F(Ply, ascii_with_comments_blank_ends_and_carriage_returns) {
    const auto file =
        write("a.ply",
              "ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement vertex 2\r\n"
              "property float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n"
              "1 2 3\r\n-4.5e-1 +5 6\r\n");
    const auto cloud = read_cloud(file);
    EXPECT_EQ(cloud.x, (std::vector<float>{1, -0.45f}));
    EXPECT_EQ(cloud.y, (std::vector<float>{2, 5}));
    EXPECT_EQ(cloud.z, (std::vector<float>{3, 6}));
    EXPECT_TRUE(cloud.nx.empty());
    EXPECT_EQ(cloud.dropped, 0u);
    EXPECT_EQ(cloud.width, 0u);
    EXPECT_EQ(cloud.source, file.string());
}

TEST_F(Ply, each_vertex_may_have_a_viewpoint) {
    const std::string rest =
        "element vertex 2\nproperty float vp_x\nproperty float x\nproperty float y\nproperty float "
        "z\n"
        "property double vp_y\nproperty float vp_z\n";
    const auto cloud =
        read_cloud(write("a.ply", header("ascii", rest) + "7 1 2 3 8 9\n4 1 2 4 5 1e30\n"));
    EXPECT_EQ(cloud.viewpoint_x, (std::vector<float>{7, 4}));
    EXPECT_EQ(cloud.viewpoint_y, (std::vector<float>{8, 5}));
    EXPECT_EQ(cloud.viewpoint_z[0], 9);
    EXPECT_TRUE(std::isnan(cloud.viewpoint_z[1])) << "no metres";
    std::string bytes = header("binary_little_endian", rest);
    for (const float v : {7.0f, 1.0f, 2.0f, 3.0f}) append<float>(bytes, v);
    append<double>(bytes, 8);
    for (const float v : {9.0f, 4.0f, 1.0f, 2.0f, 4.0f}) append<float>(bytes, v);
    append<double>(bytes, 5);
    append<float>(bytes, 6);
    const auto binary = read_cloud(write("b.ply", bytes));
    EXPECT_EQ(binary.viewpoint_y, (std::vector<float>{8, 5}));
    EXPECT_EQ(binary.viewpoint_z, (std::vector<float>{9, 6}));
}

TEST_F(Ply, properties_in_any_order_with_lists_and_elements_to_skip) {
    const auto text =
        header("ascii",
               "element camera 1\nproperty list uchar int ids\nproperty float f\n"
               "element vertex 2\nproperty uchar red\nproperty double z\n"
               "property list uint8 int32 tags\nproperty float nx\nproperty float ny\n"
               "property float nz\nproperty int16 x\nproperty float64 y\n"
               "element face 1\nproperty list uchar int vertex_indices\n");
    const auto cloud = read_cloud(write("a.ply", text + "3 7 8 9 0.5\n"
                                                        "255 3 2 100 200 0 0 2 1 2\n"
                                                        "0 6 0 0 3 4 -1 5.25\n"
                                                        "3 0 1 0\n"));
    EXPECT_EQ(cloud.x, (std::vector<float>{1, -1}));
    EXPECT_EQ(cloud.y, (std::vector<float>{2, 5.25f}));
    EXPECT_EQ(cloud.z, (std::vector<float>{3, 6}));
    EXPECT_EQ(cloud.nz, (std::vector<float>{1, 0.8f})) << "normals are made unit length";
    EXPECT_EQ(cloud.ny, (std::vector<float>{0, 0.6f}));
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
            auto bytes = header(big ? "binary_big_endian" : "binary_little_endian",
                                "element vertex 3\nproperty uchar a\nproperty " + t +
                                    " x\nproperty short b\nproperty " + t + " y\nproperty " + t +
                                    " z\nproperty double c\n");
            put(bytes, big);
            const auto cloud = read_cloud(write("a.ply", bytes));
            EXPECT_EQ(cloud.x, (std::vector<float>{1, 11, 21})) << t << " big " << big;
            EXPECT_EQ(cloud.y, (std::vector<float>{2, 12, 22})) << t << " big " << big;
            EXPECT_EQ(cloud.z, (std::vector<float>{3, 13, 23})) << t << " big " << big;
        }
    }
}

TEST_F(Ply, binary_with_lists_before_and_in_the_vertices) {
    for (const bool big : {false, true}) {
        auto bytes =
            header(big ? "binary_big_endian" : "binary_little_endian",
                   "element face 2\nproperty list uchar int vertex_indices\nproperty float area\n"
                   "element vertex 2\nproperty list ushort float weights\nproperty float x\n"
                   "property float y\nproperty float z\n");
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
        const auto cloud = read_cloud(write("a.ply", bytes));
        EXPECT_EQ(cloud.x, (std::vector<float>{1, 301}));
        EXPECT_EQ(cloud.z, (std::vector<float>{3, 303}));
    }
}

TEST_F(Ply, what_is_not_finite_is_dropped_and_counted) {
    const auto text =
        header("ascii",
               "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
               "property float nx\nproperty float ny\nproperty float nz\n");
    const auto cloud =
        read_cloud(write("a.ply", text + "nan 0 0 0 0 1\n1 2 3 nan 0 0\n0 inf 0 0 0 1\n"
                                         "0 0 -inf 0 0 1\n4 5 6 0 0 -2\n"));
    EXPECT_EQ(cloud.x, (std::vector<float>{1, 4}));
    EXPECT_EQ(cloud.dropped, 3u);
    EXPECT_EQ(cloud.nz, (std::vector<float>{0, -1})) << "a normal that is not finite is none";
}

TEST_F(Ply, bad_files_are_refused_with_their_reason) {
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const auto little = [&](const std::string& rest) {
        return header("binary_little_endian", rest);
    };
    const struct {
        const char* what;
        std::string bytes;
        std::initializer_list<std::string_view> message;
    } cases[] = {
        {"another format", "solid cube\n", {"a.ply", "\"solid cu\"", "starts with \"ply\""}},
        {"not text", std::string("\x00\xff\x1b[31m", 7), {"\\x00\\xff\\x1b"}},
        {"no end of the header",
         "ply\nformat ascii 1.0\nelement vertex 1\n",
         {"no end_header", "3 lines"}},
        {"no format", "ply\nelement vertex 0\nend_header\n", {"no format"}},
        {"unknown format",
         "ply\nformat middle_endian 1.0\nend_header\n",
         {"line 2", "middle_endian"}},
        {"unknown version", "ply\nformat ascii 2.0\nend_header\n", {"line 2", "2.0"}},
        {"two formats",
         "ply\nformat ascii 1.0\nformat binary_little_endian 1.0\nend_header\n",
         {"line 3", "two format lines"}},
        {"more in a line",
         little("element vertex 1\nproperty float x y\n"),
         {"line 5", "\"y\" stands after"}},
        {"a control character",
         little(std::string("comment a\0b\n", 12)),
         {"line 4", "control character"}},
        {"unknown keyword",
         "ply\nformat ascii 1.0\nvertices 3\nend_header\n",
         {"line 3", "vertices"}},
        {"unknown type", little("element vertex 1\nproperty half x\n"), {"line 5", "half"}},
        {"list of float length", little("element face 1\nproperty list float int a\n"), {"line 5"}},
        {"no vertex", little("element face 0\nproperty uchar x\n"), {"no element vertex"}},
        {"no z",
         little("element vertex 1\nproperty float x\nproperty float y\n") + "01234567",
         {"no property z"}},
        {"two x",
         little("element vertex 1\nproperty float x\n" + xyz) + std::string(16, '\0'),
         {"two properties x"}},
        {"x is a list",
         little("element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float "
                "z\n") +
             "123456789",
         {"property x is a list"}},
        {"property first",
         "ply\nformat ascii 1.0\nproperty float x\nend_header\n",
         {"before the first element"}},
        {"negative count", little("element vertex -1\n" + xyz), {"needs a count", "-1"}},
        {"count beyond 64 bits",
         little("element vertex 99999999999999999999\n" + xyz),
         {"needs a count"}},
        {"no points", little("element vertex 0\n" + xyz), {"no points"}},
        {"cut short",
         little("element vertex 2\n" + xyz) + std::string(23, '\0'),
         {"24 bytes", "23"}},
        {"10^12 points",
         little("element vertex 1000000000000\n" + xyz) + std::string(24, '\0'),
         {"1000000000000", "12000000000000 bytes", "24"}},
        {"10^12 points in ascii",
         header("ascii", "element vertex 1000000000000\n" + xyz) + "1 2 3\n",
         {"1000000000000", "are left"}},
        {"overflowing size",
         little("element vertex 18446744073709551615\n" + xyz) + std::string(24, '\0'),
         {"18446744073709551615", "24"}},
        {"10^12 faces before",
         little("element face 1000000000000\nproperty list uchar int a\nelement vertex 1\n" + xyz) +
             std::string(24, '\0'),
         {"face", "1000000000000"}},
        {"a list longer than the file",
         little("element face 1\nproperty list uint int a\nelement vertex 1\n" + xyz) +
             "\xff\xff\xff\xff" + std::string(12, '\0'),
         {"face", "17179869180 more bytes", "12"}},
        {"a list of negative length",
         little("element face 1\nproperty list char int a\nelement vertex 1\n" + xyz) + "\xff" +
             std::string(12, '\0'),
         {"length -1"}},
        {"fewer lines",
         header("ascii", "element vertex 3\n" + xyz) + "1.0000000 2.0000000 3.000000\n4 5 6\n",
         {"promises 3", "has 2"}},
        {"a word for a number",
         header("ascii", "element vertex 2\n" + xyz) + "1 2 3\n1 two 3\n",
         {"line 10", "\"two\""}},
        {"half a number",
         header("ascii", "element vertex 1\n" + xyz) + "1 2 3x\n",
         {"line 9", "\"3x\""}},
        {"too few values",
         header("ascii", "element vertex 2\n" + xyz) + "1.00 2.00\n3 4 5\n",
         {"line 9", "2 of the 3 values"}},
        {"too many values",
         header("ascii", "element vertex 1\n" + xyz) + "1 2 3 4\n",
         {"line 9", "more than"}},
        {"nothing finite",
         header("ascii", "element vertex 2\n" + xyz) + "nan 2 3\n1e999 2 3\n",
         {"none of its 2 points"}},
        {"far away",
         header("ascii", "element vertex 1\n" + xyz) + "1 2 2e6\n",
         {"point 0", "2e+06", "1e+06 m", "units"}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        const auto file = write("a.ply", c.bytes);
        expect_input_error([&] { read_cloud(file); }, c.message);
    }
}

// All vertices are there, and yet it is no whole file.
TEST_F(Ply, cut_within_its_faces) {
    const std::string elements =
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\n";
    const std::string text =
        header("ascii", elements) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    EXPECT_NO_THROW(read_cloud(write("a.ply", text)));
    expect_input_error([&] { read_cloud(write("a.ply", text.substr(0, text.size() - 8))); },
                       {"a.ply", "face"});
    std::string bytes = header("binary_little_endian", elements);
    for (const float c : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) append(bytes, c);
    for (const std::int32_t third : {2, 3}) {
        append<std::uint8_t>(bytes, 3);
        for (const std::int32_t v : {0, third - 1, third}) append(bytes, v);
    }
    EXPECT_NO_THROW(read_cloud(write("b.ply", bytes)));
    for (const std::size_t less : {1u, 13u, 20u, 26u}) {
        expect_input_error(
            [&] { read_cloud(write("b.ply", bytes.substr(0, bytes.size() - less))); },
            {"b.ply", "face"});
        // And where it is read in portions.
        expect_input_error(
            [&] {
                stream_cloud(write("b.ply", bytes.substr(0, bytes.size() - less)), 1,
                             [](const PointCloud&) {});
            },
            {"b.ply", "face"});
    }
}

TEST_F(Ply, is_known_by_its_first_bytes_whatever_its_name) {
    const auto text =
        header("ascii", "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n");
    EXPECT_EQ(read_cloud(write("scan.dat", text + "1 2 3\n")).size(), 1u);
    EXPECT_EQ(read_cloud(write("scan.pcd", text + "1 2 3\n")).size(), 1u);
}

TEST_F(Ply, notes_what_looks_like_millimetres) {
    const auto text =
        header("ascii", "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n");
    const auto millimetres = read_cloud(write("a.ply", text + "0 0 0\n4000 2500 3000\n"));
    ASSERT_EQ(millimetres.notes.size(), 1u);
    EXPECT_NE(millimetres.notes[0].find("4000 m"), std::string::npos);
    EXPECT_NE(millimetres.notes[0].find("ParseOptions::unit_m = 0.001"), std::string::npos);
    const auto shifted = read_cloud(write("a.ply", text + "500000 0 0\n500004 2 3\n"));
    ASSERT_EQ(shifted.notes.size(), 1u);
    EXPECT_NE(shifted.notes[0].find("offset"), std::string::npos);
    EXPECT_TRUE(read_cloud(write("a.ply", text + "0 0 0\n4 2.5 3\n")).notes.empty());
}

TEST_F(Ply, takes_the_unit_that_is_given) {
    const auto text =
        header("ascii", "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n");
    const auto cloud = read_cloud(write("a.ply", text + "0 0 0\n4000 2500 3000\n"), 0.001);
    EXPECT_TRUE(cloud.notes.empty());
    EXPECT_FLOAT_EQ(cloud.x[1], 4);
    EXPECT_FLOAT_EQ(cloud.y[1], 2.5);
    EXPECT_FLOAT_EQ(cloud.z[1], 3);
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

using Bytes = std::vector<std::uint8_t>;

std::string coloured_header(const std::string& format, const std::string& type,
                            const std::string& prefix = "") {
    std::string rest = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
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
        const auto cloud = read_cloud(write("a.ply", text));
        EXPECT_EQ(cloud.red, (Bytes{255, 0, 1}));
        EXPECT_EQ(cloud.green, (Bytes{0, 0, 2}));
        EXPECT_EQ(cloud.blue, (Bytes{51, 0, 3}));
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
        EXPECT_EQ(cloud.red, (Bytes{255, 255})) << "one for each point that is kept";
        EXPECT_EQ(cloud.green, (Bytes{0, 2}));
        EXPECT_EQ(cloud.blue, (Bytes{0, 0}));
    }
}

TEST_F(Ply, colours_that_are_none) {
    const std::string points =
        "element vertex 1\nproperty float x\nproperty float y\n"
        "property float z\n";
    const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const auto red_of = [&](const std::string& properties, const std::string& values) {
        return read_cloud(write("a.ply", header("ascii", points + properties) + "1 2 3 " + values))
            .red;
    };
    EXPECT_TRUE(red_of(rgb, "0 0 0\n").empty()) << "nothing was written there";
    EXPECT_TRUE(red_of("property uchar red\nproperty uchar green\n", "7 7\n").empty());
    const std::string labels = "property int primitive\nproperty int object\n";
    EXPECT_TRUE(red_of(labels + rgb, "1 1 7 7 7\n").empty()) << "the palette of points.ply";
    EXPECT_EQ(red_of(rgb, "7 7 7\n"), Bytes{7});
    expect_input_error([&] { red_of(rgb, "7 x 7\n"); }, {"a.ply", "\"x\" is not a number"});
    expect_input_error([&] { red_of(rgb + rgb, "7 7 7 7 7 7\n"); }, {"two properties red"});
}

}  // namespace
}  // namespace topple::io
