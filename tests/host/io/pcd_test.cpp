// SPDX-License-Identifier: MIT
#include <liblzf/lzf.h>

#include "clouds.h"
#include "files.h"
#include "points/formats/read_cloud.h"

namespace topple::io {
namespace {

using namespace test;

class Pcd : public test::Files {};

// A header of two points as text, with other values for some of its lines.
std::string head(std::map<std::string, std::string> lines = {}) {
    static const std::pair<const char*, const char*> usual[] = {{"FIELDS", "x y z"},
                                                                {"SIZE", "4 4 4"},
                                                                {"TYPE", "F F F"},
                                                                {"COUNT", "1 1 1"},
                                                                {"WIDTH", "2"},
                                                                {"HEIGHT", "1"},
                                                                {"VIEWPOINT", "0 0 0 1 0 0 0"},
                                                                {"POINTS", "2"},
                                                                {"DATA", "ascii"}};
    std::string out = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
    for (const auto& [key, value] : usual)
        out += key + (" " + lines.try_emplace(key, value).first->second) + "\n";
    return out;
}
// The same of `count` points in one row.
std::string head_of(const std::string& count, std::map<std::string, std::string> lines = {}) {
    lines.insert({{"WIDTH", count}, {"POINTS", count}});
    return head(std::move(lines));
}

std::string compressed(const std::string& raw) {
    std::string packed(raw.size() + 100, '\0');
    const auto size =
        lzf_compress(raw.data(), unsigned(raw.size()), packed.data(), unsigned(packed.size()));
    EXPECT_GT(size, 0u);
    std::string out;
    append<std::uint32_t>(out, size);
    append<std::uint32_t>(out, std::uint32_t(raw.size()));
    return out + packed.substr(0, size);
}

// Points' bytes, which come one after another, field after field, of so many bytes each.
std::string by_field(const std::string& points, const std::vector<std::size_t>& sizes) {
    std::string out;
    const std::size_t stride = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
    std::size_t offset = 0;
    for (const std::size_t size : sizes) {
        for (std::size_t at = offset; at < points.size(); at += stride)
            out += points.substr(at, size);
        offset += size;
    }
    return out;
}

TEST_F(Pcd, ascii_with_normals_vectors_and_padding) {
    const std::string fields = "rgb normal_x normal_y normal_z _ x y histogram z",
                      size = "4 4 4 4 1 4 8 4 4", type = "U F F F U F F F F",
                      count = "1 1 1 1 2 1 1 3 1";
    const std::string padded = head({{"FIELDS", "_ " + fields + " _"},
                                     {"SIZE", "1 " + size + " 1"},
                                     {"TYPE", "U " + type + " U"},
                                     {"COUNT", "0 " + count + " 0"}});
    const std::string points = "0 0 0 2 9 9 1 2 7 7 7 3\n0 0 -3 0 9 9 4 5 7 7 7 6\n";
    EXPECT_EQ(read_cloud(write("a.pcd", padded + points)).z, (std::vector<float>{3, 6}));
    const auto cloud = read_cloud(write(
        "a.pcd", head({{"FIELDS", fields}, {"SIZE", size}, {"TYPE", type}, {"COUNT", count}}) +
                     "4294967295 0 0 2 9 9 1 2 7 7 7 3\n\n# between\n0 0 -3 0 9 9 4 5 7 7 7 6\n"));
    EXPECT_EQ(points_of(cloud), (Points{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(normals_of(cloud), (Points{{0, 0, 1}, {0, -1, 0}}));
    EXPECT_FALSE(cloud.has_viewpoint);
}

TEST_F(Pcd, every_type_in_every_encoding) {
    const struct {
        std::string type, size;
        void (*put)(std::string&, int);
    } types[] = {
        {"F", "4", [](std::string& to, int v) { append<float>(to, float(v)); }},
        {"F", "8", [](std::string& to, int v) { append<double>(to, v); }},
        {"I", "1", [](std::string& to, int v) { append(to, std::int8_t(v)); }},
        {"I", "2", [](std::string& to, int v) { append(to, std::int16_t(v)); }},
        {"I", "4", [](std::string& to, int v) { append<std::int32_t>(to, v); }},
        {"I", "8", [](std::string& to, int v) { append<std::int64_t>(to, v); }},
        {"U", "1", [](std::string& to, int v) { append(to, std::uint8_t(v)); }},
        {"U", "2", [](std::string& to, int v) { append(to, std::uint16_t(v)); }},
        {"U", "4", [](std::string& to, int v) { append(to, std::uint32_t(v)); }},
        {"U", "8", [](std::string& to, int v) { append(to, std::uint64_t(v)); }},
    };
    constexpr int n = 40;
    for (const auto& t : types) {
        std::string by_point;
        for (int i = 0; i < n; ++i) {
            append<std::uint8_t>(by_point, 200);
            t.put(by_point, i);
            t.put(by_point, i + 1);
            for (int k = 0; k < 3; ++k) append<float>(by_point, -1);
            t.put(by_point, i + 2);
        }
        const std::size_t size = std::stoul(t.size);
        std::map<std::string, std::string> lines{
            {"FIELDS", "label x y tag z"},
            {"SIZE", "1 " + t.size + " " + t.size + " 4 " + t.size},
            {"TYPE", "U " + t.type + " " + t.type + " F " + t.type},
            {"COUNT", "1 1 1 3 1"}};
        for (const bool compress : {false, true}) {
            SCOPED_TRACE(t.type + t.size + (compress ? " compressed" : ""));
            lines["DATA"] = compress ? "binary_compressed" : "binary";
            const auto cloud = read_cloud(write(
                "a.pcd", head_of(std::to_string(n), lines) +
                             (compress ? compressed(by_field(by_point, {1, size, size, 12, size}))
                                       : by_point)));
            ASSERT_EQ(cloud.size(), std::size_t(n));
            for (int i = 0; i < n; ++i) {
                EXPECT_EQ(points_of(cloud)[std::size_t(i)],
                          (std::array{float(i), float(i + 1), float(i + 2)}));
            }
        }
    }
}

TEST_F(Pcd, organised_clouds_keep_their_pixels) {
    auto bytes = head({{"WIDTH", "3"},
                       {"HEIGHT", "2"},
                       {"POINTS", "6"},
                       {"VIEWPOINT", "0 0 0 0 1 0 0"},
                       {"DATA", "binary"}});
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 3; ++k) append<float>(bytes, i == 0 || i == 4 ? NAN : float(i));
    }
    const auto cloud = read_cloud(write("a.pcd", bytes));
    EXPECT_EQ(cloud.width, 3u);
    EXPECT_EQ(cloud.height, 2u);
    EXPECT_EQ(cloud.pixel, (std::vector<std::uint32_t>{1, 2, 3, 5}));
    EXPECT_EQ(cloud.dropped, 2u);
    EXPECT_TRUE(cloud.has_viewpoint);
}

TEST_F(Pcd, each_point_may_have_a_viewpoint) {
    const std::string six = head({{"FIELDS", "x y z vp_x vp_y vp_z"},
                                  {"SIZE", "4 4 4 4 4 4"},
                                  {"TYPE", "F F F F F F"},
                                  {"COUNT", "1 1 1 1 1 1"}});
    const auto cloud = read_cloud(write("a.pcd", six + "1 2 3 4 5 6\n1 2 4 nan 5 6\n"));
    EXPECT_FALSE(cloud.has_viewpoint);
    EXPECT_EQ(viewpoints_of(cloud)[0], (std::array<float, 3>{4, 5, 6}));
    EXPECT_TRUE(std::isnan(cloud.viewpoint_x[1]));
    EXPECT_EQ(read_cloud(path("a.pcd"), 0.5).viewpoint_y, (std::vector<float>{2.5f, 2.5f}));
}

TEST_F(Pcd, the_viewpoint_counts_where_it_is_not_all_default) {
    const auto cloud =
        read_cloud(write("a.pcd", head({{"VIEWPOINT", "1 -2 0.5 1 0 0 0"}}) + "1 2 3\n1 2 3\n"));
    EXPECT_TRUE(cloud.has_viewpoint);
    EXPECT_EQ(cloud.viewpoint, (Vec3{1, -2, 0.5}));
    EXPECT_EQ(cloud.size(), 2u) << "points that coincide are kept";
    EXPECT_TRUE(cloud.pixel.empty());
}

TEST_F(Pcd, old_headers_without_count_points_or_viewpoint) {
    const auto cloud =
        read_cloud(write("a.pcd",
                         "VERSION .5\nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n"
                         "DATA ascii\n1 2 3"));
    EXPECT_EQ(cloud.z, (std::vector<float>{3}));
}

TEST_F(Pcd, bad_files_are_refused_with_their_reason) {
    const std::string two(24, '\0'), many = "1000000000000", text = "1 2 3\n1 2 3\n";
    const std::string packed = head({{"DATA", "binary_compressed"}});
    std::string lies, damaged = compressed(std::string(24, 'a'));
    append<std::uint32_t>(lies, 5);
    append<std::uint32_t>(lies, 4000000000u);
    damaged.back() = '\x7f';
    damaged[8] = '\xff';
    const BadFile cases[] = {
        {"# .PCD v0.7\nFIELDS x y z\n", {"no DATA line"}},
        {"hello\n", {"line 1", "hello"}},
        {head({{"FIELDS", "x y w"}}) + text, {"no z"}},
        {head({{"FIELDS", "x y z x"},
               {"SIZE", "4 4 4 4"},
               {"TYPE", "F F F F"},
               {"COUNT", "1 1 1 1"}}),
         {"two FIELDS x"}},
        {head({{"SIZE", "4 4"}}), {"line 4", "fewer values"}},
        {head({{"TYPE", "F F F F"}}), {"line 5", "more values"}},
        {head({{"SIZE", "4 4 3"}}) + text, {"field z", "SIZE 3"}},
        {head({{"TYPE", "F F Q"}}), {"line 5", "\"Q\""}},
        {head({{"COUNT", "1 1 0"}}) + two, {"field z has COUNT 0"}},
        {head({{"COUNT", "1 1 18446744073709551615"}}) + two, {"COUNT 18446744073709551615"}},
        {head({{"COUNT", "900000 1 900000"}}) + two, {"COUNT 900000"}},
        {head({{"POINTS", "3"}}) + "1 2 3\n", {"WIDTH 2", "POINTS 3"}},
        {head({{"WIDTH", "4294967296"}, {"HEIGHT", "4294967296"}, {"POINTS", "0"}}) + text,
         {"WIDTH 4294967296"}},
        {head_of("0"), {"no points"}},
        {head_of(many, {{"DATA", "binary"}}) + two, {"12000000000000", "24"}},
        {head_of(many) + "1 2 3\n", {"1000000000000 points"}},
        {head_of(many, {{"DATA", "binary_compressed"}}) + lies, {"12000000000000", "4000000000"}},
        {head({{"DATA", "binary"}}) + two.substr(1), {"24 bytes", "23"}},
        {packed + "1234567", {"8 bytes", "7"}},
        {packed + std::string("\x64\0\0\0\x18\0\0\0abc", 11), {"100 bytes", "3"}},
        {packed + std::string("\x03\0\0\0\x19\0\0\0abc", 11), {"24 bytes", "25"}},
        {packed + damaged, {"does not unpack"}},
        {head_of("100000000", {{"DATA", "binary_compressed"}}) +
             std::string("\x03\0\0\0\x00\x8c\x86\x47"
                         "abc",
                         11),
         {"can't unpack to 1200000000"}},
        {head({{"DATA", "zipped"}}), {"zipped"}},
        {head({{"VIEWPOINT", "0 0 nan 1 0 0 0"}}), {"line 9", "VIEWPOINT"}},
        {head() + "1 2 3\n1 x 3\n", {"line 13", "\"x\""}},
        {head() + "1 2 3 \n1 2  \n", {"line 13", "2 of the 3 values"}},
        {head() + "1.0000 2.0000 3.0000\n", {"promises 2 points", "has 1"}},
        {head() + text + "1 2 3\n", {"line 14", "more than the 2 points"}},
        {head() + "nan nan nan\nnan nan nan\n", {"none of its 2 points"}},
        {head() + "1 2 3\n0 -4e7 0\n", {"point 1", "-4e+07"}},
    };
    expect_refused("a.pcd", cases, [](const auto& file) { read_cloud(file); });
}

// Real scans: counts and fields as their headers state them.
TEST_F(Pcd, real_scans) {
    const char* set = std::getenv("TOPPLE_SHARED");
    const std::filesystem::path shared = set ? set : std::string(TOPPLE_SOURCE_DIR) + "/../shared";
    const auto scans = shared / "data" / "clouds";
    if (!std::filesystem::exists(scans)) GTEST_SKIP() << "no real scans: set TOPPLE_SHARED";
    const auto fragment = read_cloud(scans / "fragment.pcd");
    EXPECT_EQ(fragment.size() + fragment.dropped, 113662u);
    EXPECT_EQ(fragment.nx.size(), fragment.size());
    const auto room = read_cloud(scans / "room_scan1.pcd");
    EXPECT_EQ(room.size() + room.dropped, 112586u);
    const auto table = read_cloud(scans / "milk_cartoon_all_small_clorox.pcd");
    EXPECT_EQ(table.size() + table.dropped, 307200u);
    EXPECT_EQ(table.width, 640u);
    EXPECT_EQ(table.pixel.size(), table.size());
}

// 0xFF010203 as a float is no number, 0x00040506 a denormal one.
TEST_F(Pcd, packed_colours_in_every_encoding) {
    const std::array<std::uint32_t, 2> packed{0xFF010203u, 0x00040506u};
    for (const char type : {'F', 'U', 'I'}) {
        for (const char* name : {"rgb", "rgba"}) {
            SCOPED_TRACE(std::string(name) + " " + type);
            std::map<std::string, std::string> lines{{"FIELDS", std::string("x ") + name + " y z"},
                                                     {"SIZE", "4 4 4 4"},
                                                     {"TYPE", std::string("F ") + type + " F F"},
                                                     {"COUNT", "1 1 1 1"}};
            std::string points;
            for (const std::uint32_t colour : packed) {
                append(points, 1.0f);
                append(points, colour);
                append(points, 2.0f);
                append(points, 3.0f);
            }
            for (const bool compress : {false, true}) {
                lines["DATA"] = compress ? "binary_compressed" : "binary";
                EXPECT_EQ(colours_of(read_cloud(write(
                              "a.pcd",
                              head(lines) + (compress ? compressed(by_field(points, {4, 4, 4, 4}))
                                                      : points)))),
                          (Colours{{1, 2, 3}, {4, 5, 6}}));
            }
        }
    }
}

TEST_F(Pcd, packed_colours_as_text) {
    const auto colours = [&](const std::string& type, const std::string& text) {
        const std::string one = head_of("1", {{"FIELDS", "x y z rgb"},
                                              {"SIZE", "4 4 4 4"},
                                              {"TYPE", "F F F " + type},
                                              {"COUNT", "1 1 1 1"}});
        return colours_of(read_cloud(write("a.pcd", one + "1 2 3 " + text + "\n")));
    };
    const Colours grey{{64, 64, 64}};
    EXPECT_EQ(colours("U", "4210752"), grey);
    EXPECT_EQ(colours("U", "4282400832"), grey) << "with alpha";
    EXPECT_EQ(colours("I", "-12566464"), grey) << "with alpha";
    EXPECT_EQ(colours("F", "4210752"), grey);
    EXPECT_EQ(colours("F", "5.900520e-39"), grey) << "the float that has its bits";
    EXPECT_EQ(colours("F", "-2.5555e+38"), (Colours{{64, 65, 36}})) << "with alpha";
    for (const char* unknown : {"nan", "0", "1e20"})
        EXPECT_EQ(colours("U", unknown), Colours{}) << unknown;
    expect_input_error([&] { colours("F", "red"); }, {"line", "\"red\" is not a number"});
}

}  // namespace
}  // namespace topple::io
