// SPDX-License-Identifier: MIT
#include <liblzf/lzf.h>

#include <cstdlib>
#include <limits>

#include "files.h"
#include "points/formats/read_cloud.h"

namespace topple::io {
namespace {

using test::append;
using test::expect_input_error;

class Pcd : public test::Files {};

struct Head {
    std::string fields = "x y z", size = "4 4 4", type = "F F F", count = "1 1 1";
    std::string width = "2", height = "1", points = "2", viewpoint = "0 0 0 1 0 0 0",
                data = "ascii";
    std::string text() const {
        return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields +
               "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT " + count + "\nWIDTH " + width +
               "\nHEIGHT " + height + "\nVIEWPOINT " + viewpoint + "\nPOINTS " + points +
               "\nDATA " + data + "\n";
    }
};

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

TEST_F(Pcd, ascii_with_normals_vectors_and_padding) {
    Head head;
    head.fields = "rgb normal_x normal_y normal_z _ x y histogram z";
    head.size = "4 4 4 4 1 4 8 4 4";
    head.type = "U F F F U F F F F";
    head.count = "1 1 1 1 2 1 1 3 1";
    Head padded = head;
    padded.fields = "_ " + head.fields + " _";
    padded.size = "1 " + head.size + " 1";
    padded.type = "U " + head.type + " U";
    padded.count = "0 " + head.count + " 0";
    const std::string points = "0 0 0 2 9 9 1 2 7 7 7 3\n0 0 -3 0 9 9 4 5 7 7 7 6\n";
    EXPECT_EQ(read_cloud(write("a.pcd", padded.text() + points)).z, (std::vector<float>{3, 6}));
    const auto cloud =
        read_cloud(write("a.pcd", head.text() + "4294967295 0 0 2 9 9 1 2 7 7 7 3\n\n# between\n"
                                                "0 0 -3 0 9 9 4 5 7 7 7 6\n"));
    EXPECT_EQ(cloud.x, (std::vector<float>{1, 4}));
    EXPECT_EQ(cloud.y, (std::vector<float>{2, 5}));
    EXPECT_EQ(cloud.z, (std::vector<float>{3, 6}));
    EXPECT_EQ(cloud.nz, (std::vector<float>{1, 0}));
    EXPECT_EQ(cloud.ny, (std::vector<float>{0, -1}));
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
        Head head;
        head.fields = "label x y tag z";
        head.size = "1 " + t.size + " " + t.size + " 4 " + t.size;
        head.type = "U " + t.type + " " + t.type + " F " + t.type;
        head.count = "1 1 1 3 1";
        head.width = head.points = std::to_string(n);
        std::string by_point, by_field;
        for (int i = 0; i < n; ++i) {
            append<std::uint8_t>(by_point, 200);
            t.put(by_point, i);
            t.put(by_point, i + 1);
            for (int k = 0; k < 3; ++k) append<float>(by_point, -1);
            t.put(by_point, i + 2);
        }
        by_field = std::string(n, '\xc8');
        for (int i = 0; i < n; ++i) t.put(by_field, i);
        for (int i = 0; i < n; ++i) t.put(by_field, i + 1);
        for (int i = 0; i < 3 * n; ++i) append<float>(by_field, -1);
        for (int i = 0; i < n; ++i) t.put(by_field, i + 2);

        head.data = "binary";
        const auto binary = read_cloud(write("a.pcd", head.text() + by_point));
        head.data = "binary_compressed";
        const auto packed = read_cloud(write("b.pcd", head.text() + compressed(by_field)));
        for (const auto* cloud : {&binary, &packed}) {
            ASSERT_EQ(cloud->size(), std::size_t(n)) << t.type << t.size;
            for (int i = 0; i < n; ++i) {
                EXPECT_EQ(cloud->x[std::size_t(i)], float(i)) << t.type << t.size;
                EXPECT_EQ(cloud->y[std::size_t(i)], float(i + 1)) << t.type << t.size;
                EXPECT_EQ(cloud->z[std::size_t(i)], float(i + 2)) << t.type << t.size;
            }
        }
    }
}

TEST_F(Pcd, organised_clouds_keep_their_pixels) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Head head;
    head.width = "3";
    head.height = "2";
    head.points = "6";
    head.viewpoint = "0 0 0 0 1 0 0";
    head.data = "binary";
    auto bytes = head.text();
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 3; ++k) append<float>(bytes, i == 0 || i == 4 ? nan : float(i));
    }
    const auto cloud = read_cloud(write("a.pcd", bytes));
    EXPECT_EQ(cloud.width, 3u);
    EXPECT_EQ(cloud.height, 2u);
    EXPECT_EQ(cloud.pixel, (std::vector<std::uint32_t>{1, 2, 3, 5}));
    EXPECT_EQ(cloud.dropped, 2u);
    EXPECT_TRUE(cloud.has_viewpoint);
}

TEST_F(Pcd, each_point_may_have_a_viewpoint) {
    Head head;
    head.fields = "x y z vp_x vp_y vp_z";
    head.size = "4 4 4 4 4 4";
    head.type = "F F F F F F";
    head.count = "1 1 1 1 1 1";
    const auto cloud = read_cloud(write("a.pcd", head.text() + "1 2 3 4 5 6\n1 2 4 nan 5 6\n"));
    EXPECT_FALSE(cloud.has_viewpoint);
    EXPECT_EQ(cloud.viewpoint_x[0], 4);
    EXPECT_TRUE(std::isnan(cloud.viewpoint_x[1]));
    EXPECT_EQ(cloud.viewpoint_z, (std::vector<float>{6, 6}));
    EXPECT_EQ(
        read_cloud(write("b.pcd", head.text() + "1 2 3 4 5 6\n1 2 4 1 5 6\n"), 0.5).viewpoint_y,
        (std::vector<float>{2.5f, 2.5f}));
}

TEST_F(Pcd, the_viewpoint_counts_where_it_is_not_all_default) {
    Head head;
    head.viewpoint = "1 -2 0.5 1 0 0 0";
    const auto cloud = read_cloud(write("a.pcd", head.text() + "1 2 3\n1 2 3\n"));
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
    const auto with = [](auto change, const std::string& data) {
        Head head;
        change(head);
        return head.text() + data;
    };
    const std::string two_points(24, '\0');
    const auto binary = [](Head& h) { h.data = "binary"; };
    const auto packed = [](Head& h) { h.data = "binary_compressed"; };
    std::string lies;
    append<std::uint32_t>(lies, 5);
    append<std::uint32_t>(lies, 4000000000u);
    std::string damaged = compressed(std::string(24, 'a'));
    damaged.back() = '\x7f';
    damaged[8] = '\xff';
    const struct {
        const char* what;
        std::string bytes;
        std::initializer_list<std::string_view> message;
    } cases[] = {
        {"no data line", "# .PCD v0.7\nFIELDS x y z\n", {"no DATA line"}},
        {"another format", "hello\n", {"line 1", "hello"}},
        {"no z", with([](Head& h) { h.fields = "x y w"; }, "1 2 3\n1 2 3\n"), {"no z"}},
        {"two x",
         with(
             [](Head& h) {
                 h.fields = "x y z x";
                 h.size = h.count = "1 1 1 1";
                 h.size = "4 4 4 4";
                 h.type = "F F F F";
             },
             "1 2 3 4\n1 2 3 4\n"),
         {"two FIELDS x"}},
        {"few sizes", with([](Head& h) { h.size = "4 4"; }, ""), {"line 4", "fewer values"}},
        {"many types", with([](Head& h) { h.type = "F F F F"; }, ""), {"line 5", "more values"}},
        {"odd size",
         with([](Head& h) { h.size = "4 4 3"; }, "1 2 3\n1 2 3\n"),
         {"field z", "SIZE 3"}},
        {"odd type", with([](Head& h) { h.type = "F F Q"; }, ""), {"line 5", "\"Q\""}},
        {"count 0", with([](Head& h) { h.count = "1 1 0"; }, two_points), {"field z has COUNT 0"}},
        {"absurd count",
         with([](Head& h) { h.count = "1 1 18446744073709551615"; }, two_points),
         {"COUNT 18446744073709551615"}},
        {"absurd count, in sum",
         with([](Head& h) { h.count = "900000 1 900000"; }, two_points),
         {"COUNT 900000"}},
        {"sizes disagree",
         with([](Head& h) { h.points = "3"; }, "1 2 3\n"),
         {"WIDTH 2", "POINTS 3"}},
        {"overflowing size",
         with(
             [](Head& h) {
                 h.width = h.height = "4294967296";
                 h.points = "0";
             },
             "1 2 3\n"),
         {"WIDTH 4294967296"}},
        {"no points", with([](Head& h) { h.width = h.points = "0"; }, ""), {"no points"}},
        {"10^12 points",
         with(
             [](Head& h) {
                 h.data = "binary";
                 h.width = h.points = "1000000000000";
             },
             two_points),
         {"1000000000000 points", "12000000000000", "24"}},
        {"10^12 points in ascii",
         with([](Head& h) { h.width = h.points = "1000000000000"; }, "1 2 3\n"),
         {"1000000000000 points"}},
        {"10^12 points compressed",
         with(
             [](Head& h) {
                 h.data = "binary_compressed";
                 h.width = h.points = "1000000000000";
             },
             lies),
         {"12000000000000", "4000000000"}},
        {"cut short", with(binary, two_points.substr(1)), {"24 bytes", "23"}},
        {"no sizes", with(packed, "1234567"), {"8 bytes", "7"}},
        {"packed size lies",
         with(packed, std::string("\x64\0\0\0\x18\0\0\0abc", 11)),
         {"100 bytes", "3"}},
        {"unpacked size lies",
         with(packed, std::string("\x03\0\0\0\x19\0\0\0abc", 11)),
         {"24 bytes", "25"}},
        {"damaged", with(packed, damaged), {"does not unpack"}},
        {"bomb",
         with(
             [](Head& h) {
                 h.data = "binary_compressed";
                 h.width = h.points = "100000000";
             },
             std::string("\x03\0\0\0\x00\x8c\x86\x47"
                         "abc",
                         11)),
         {"can't unpack to 1200000000"}},
        {"unknown data", with([](Head& h) { h.data = "zipped"; }, ""), {"zipped"}},
        {"bad viewpoint",
         with([](Head& h) { h.viewpoint = "0 0 nan 1 0 0 0"; }, ""),
         {"line 9", "VIEWPOINT"}},
        {"a word for a number", with([](Head&) {}, "1 2 3\n1 x 3\n"), {"line 13", "\"x\""}},
        {"too few values", with([](Head&) {}, "1 2 3 \n1 2  \n"), {"line 13", "2 of the 3 values"}},
        {"fewer lines",
         with([](Head&) {}, "1.0000 2.0000 3.0000\n"),
         {"promises 2 points", "has 1"}},
        {"more lines",
         with([](Head&) {}, "1 2 3\n1 2 3\n1 2 3\n"),
         {"line 14", "more than the 2 points"}},
        {"nothing finite",
         with([](Head&) {}, "nan nan nan\nnan nan nan\n"),
         {"none of its 2 points"}},
        {"far away", with([](Head&) {}, "1 2 3\n0 -4e7 0\n"), {"point 1", "-4e+07"}},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.what);
        const auto file = write("a.pcd", c.bytes);
        expect_input_error([&] { read_cloud(file); }, c.message);
    }
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

using Bytes = std::vector<std::uint8_t>;

// 0xFF010203 as a float is no number, 0x00040506 a denormal one.
TEST_F(Pcd, packed_colours_in_every_encoding) {
    const std::array<std::uint32_t, 2> packed{0xFF010203u, 0x00040506u};
    for (const char type : {'F', 'U', 'I'}) {
        for (const char* name : {"rgb", "rgba"}) {
            SCOPED_TRACE(std::string(name) + " " + type);
            Head head;
            head.fields = std::string("x ") + name + " y z";
            head.size = "4 4 4 4";
            head.type = std::string("F ") + type + " F F";
            head.count = "1 1 1 1";
            std::string points, by_field;
            for (const std::uint32_t colour : packed) {
                append(points, 1.0f);
                append(points, colour);
                append(points, 2.0f);
                append(points, 3.0f);
            }
            for (int field = 0; field < 4; ++field) {
                for (const std::uint32_t colour : packed) {
                    if (field == 1)
                        append(by_field, colour);
                    else
                        append(by_field, static_cast<float>(field));
                }
            }
            for (const bool compress : {false, true}) {
                head.data = compress ? "binary_compressed" : "binary";
                const auto cloud = read_cloud(
                    write("a.pcd", head.text() + (compress ? compressed(by_field) : points)));
                EXPECT_EQ(cloud.red, (Bytes{1, 4}));
                EXPECT_EQ(cloud.green, (Bytes{2, 5}));
                EXPECT_EQ(cloud.blue, (Bytes{3, 6}));
            }
        }
    }
}

TEST_F(Pcd, packed_colours_as_text) {
    const auto colour_of = [&](const std::string& type, const std::string& text) {
        Head head;
        head.fields = "x y z rgb";
        head.size = "4 4 4 4";
        head.type = "F F F " + type;
        head.count = "1 1 1 1";
        head.width = head.points = "1";
        const auto cloud = read_cloud(write("a.pcd", head.text() + "1 2 3 " + text + "\n"));
        return cloud.red.empty() ? Bytes{} : Bytes{cloud.red[0], cloud.green[0], cloud.blue[0]};
    };
    const Bytes grey{64, 64, 64};
    EXPECT_EQ(colour_of("U", "4210752"), grey);
    EXPECT_EQ(colour_of("U", "4282400832"), grey) << "with alpha";
    EXPECT_EQ(colour_of("I", "-12566464"), grey) << "with alpha";
    EXPECT_EQ(colour_of("F", "4210752"), grey);
    EXPECT_EQ(colour_of("F", "5.900520e-39"), grey) << "the float that has its bits";
    EXPECT_EQ(colour_of("F", "-2.5555e+38"), (Bytes{64, 65, 36})) << "with alpha";
    for (const char* unknown : {"nan", "0", "1e20"}) {
        EXPECT_EQ(colour_of("U", unknown), Bytes{}) << unknown;
    }
    expect_input_error([&] { colour_of("F", "red"); }, {"line", "\"red\" is not a number"});
}

}  // namespace
}  // namespace topple::io
