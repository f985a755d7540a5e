// SPDX-License-Identifier: MIT
#include "mesh_files.h"
#include "points/formats/read_cloud.h"
#include "points/formats/triangulate.h"

namespace topple::io {
namespace {

using test::append;
using test::expect_input_error;

// A box of 2 x 1 x 0.5, as twelve triangles seen from outside, in each of the formats.
class Mesh : public test::Files {};

// Which of the box's sides a point lies on, by axis and end.
int side_of(const PointCloud& cloud, std::size_t n) {
    const std::array<double, 3> p{cloud.x[n], cloud.y[n], cloud.z[n]};
    for (int a = 0; a < 3; ++a) {
        if (std::abs(p[a]) < 1e-6) return 2 * a;
        if (std::abs(p[a] - test::box_size[a]) < 1e-6) return 2 * a + 1;
    }
    return -1;
}

TEST_F(Mesh, faces_become_points_with_normals_evenly_by_area) {
    const double area = 2 * (2 * 1 + 2 * 0.5 + 1 * 0.5);
    for (const char* name : {"box.obj", "box.stl", "box.glb", "box.ply"}) {
        SCOPED_TRACE(name);
        const auto cloud = read_cloud(write(name, test::box_file(name)));
        // 7 m2 at 1 cm.
        EXPECT_NEAR(static_cast<double>(cloud.size()), 70000, 2);
        ASSERT_EQ(cloud.nx.size(), cloud.size());
        std::map<int, std::size_t> on;
        std::size_t at_edges = 0;
        for (std::size_t n = 0; n < cloud.size(); ++n) {
            const int side = side_of(cloud, n);
            ASSERT_GE(side, 0) << "a point off the box";
            ++on[side];
            const std::array<float, 3> normal{cloud.nx[n], cloud.ny[n], cloud.nz[n]};
            const auto axis = static_cast<std::size_t>(side / 2);
            // At an edge either of two sides may be the point's.
            if (std::abs(normal[axis]) < 0.5f) {
                ++at_edges;
                continue;
            }
            EXPECT_FLOAT_EQ(normal[axis], side % 2 ? 1.0f : -1.0f);
        }
        EXPECT_LE(at_edges, 5u);
        for (const auto& [side, count] : on) {
            const double share = 2.0 * 1.0 * 0.5 / test::box_size[side / 2];
            EXPECT_NEAR(static_cast<double>(count), 70000 * share / area, 10) << side;
        }
    }
}

// Squares of 5 cm hold 25 points each, give or take the few at their edges.
TEST_F(Mesh, points_are_spread_evenly) {
    const auto cloud = read_cloud(write("box.obj", test::box_obj()));
    std::map<std::pair<int, int>, int> cells;
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        if (side_of(cloud, n) == 5) ++cells[{int(cloud.x[n] * 20), int(cloud.y[n] * 20)}];
    }
    ASSERT_EQ(cells.size(), 800u);
    for (const auto& [cell, count] : cells) {
        EXPECT_GE(count, 15) << cell.first << ", " << cell.second;
        EXPECT_LE(count, 36) << cell.first << ", " << cell.second;
    }
}

TEST_F(Mesh, the_same_file_gives_the_same_points_and_units_scale_them) {
    const auto file = write("box.obj", test::box_obj());
    const auto once = read_cloud(file), again = read_cloud(file);
    EXPECT_EQ(once.x, again.x);
    EXPECT_EQ(once.y, again.y);
    EXPECT_EQ(once.z, again.z);
    // In decimetres or so: 0.07 m2 take the least number of points, closer than 1 cm.
    const auto small = read_cloud(file, 0.1);
    EXPECT_NEAR(static_cast<double>(small.size()), 50000, 2);
    EXPECT_NEAR(*std::max_element(small.x.begin(), small.x.end()), 0.2, 1e-6);
    // In tens of metres: 700 m2 take the most.
    const auto large = read_cloud(file, 10);
    EXPECT_NEAR(static_cast<double>(large.size()), 5e6, 2);
}

TEST_F(Mesh, nodes_of_gltf_are_placed_and_nothing_is_turned) {
    const auto cloud = read_cloud(write("box.glb", test::box_glb({10, 20, 30})));
    for (const auto& [values, low, high] :
         {std::tuple(&cloud.x, 10.0, 12.0), {&cloud.y, 20.0, 21.0}, {&cloud.z, 30.0, 30.5}}) {
        EXPECT_NEAR(*std::min_element(values->begin(), values->end()), low, 1e-2);
        EXPECT_NEAR(*std::max_element(values->begin(), values->end()), high, 1e-2);
    }
}

TEST_F(Mesh, gltf_with_its_buffer_beside_it) {
    test::write_box_gltf(folder_);
    EXPECT_NEAR(static_cast<double>(read_cloud(path("box.gltf")).size()), 70000, 2);
    std::filesystem::remove(path("box.bin"));
    expect_input_error([&] { read_cloud(path("box.gltf")); },
                       {"box.gltf", "box.bin", "can't be opened"});
}

// An L of 3 m2, whose corner points inwards, from each of its corners on and both ways round.
TEST_F(Mesh, polygons_that_are_not_convex_are_covered_once) {
    const std::array<std::array<double, 2>, 6> corners{
        {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t first = 0; first < 6; ++first) {
            for (const bool reversed : {false, true}) {
                std::vector<Vec3> polygon;
                for (std::size_t n = 0; n < 6; ++n) {
                    const auto& c = corners[(first + (reversed ? 6 - n : n)) % 6];
                    Vec3 p{};
                    p[(axis + 1) % 3] = c[0];
                    p[(axis + 2) % 3] = c[1];
                    polygon.push_back(p);
                }
                double area = 0;
                for (const auto& t : triangulate(polygon)) {
                    const Vec3 &a = polygon[t[0]], &b = polygon[t[1]], &c = polygon[t[2]];
                    const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
                    const double twice =
                        (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
                    EXPECT_GE(reversed ? -twice : twice, 0);
                    area += std::abs(twice) / 2;
                }
                EXPECT_DOUBLE_EQ(area, 3);
            }
        }
    }
}

TEST_F(Mesh, a_ply_whose_faces_show_nothing_is_a_cloud) {
    const auto text = [](const char* face) {
        return std::string(
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                   "end_header\n0 0 0\n1 0 0\n2 0 0\n") +
               face;
    };
    for (const char* face : {"3 0 1 2\n", "3 0 1 9\n", "2 0 1\n", "0\n"}) {
        SCOPED_TRACE(face);
        const auto cloud = read_cloud(write("a.ply", text(face)));
        EXPECT_EQ(cloud.x, (std::vector<float>{0, 1, 2}));
        ASSERT_EQ(cloud.notes.size(), 1u);
        EXPECT_THAT(cloud.notes[0], testing::HasSubstr("faces"));
    }
}

// The library that reads faces makes room for as many as a count says.
TEST_F(Mesh, a_ply_with_faces_that_make_no_sense_is_a_cloud) {
    const std::string corners =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    const auto text = [&](const std::string& element, const std::string& face) {
        return "ply\nformat ascii 1.0\n" + corners + element + "end_header\n" + points + face;
    };
    const auto binary = [&](const std::string& element, const std::string& face) {
        std::string out = "ply\nformat binary_little_endian 1.0\n" + corners + element;
        out.append("end_header\n");
        for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
            test::append<float>(out, v);
        return out + face;
    };
    const std::string faces = "element face 1\nproperty list uint int vertex_indices\n";
    const std::string many = "element face 4000000000\nproperty list uint int vertex_indices\n";
    std::string long_list, good;
    for (const std::uint32_t n : {4000000000u, 0u, 1u, 2u}) test::append(long_list, n);
    for (const std::uint32_t n : {3u, 0u, 1u, 2u}) test::append(good, n);
    const struct {
        std::string bytes, message;
        bool cut = false;  // the file ends too early
    } cases[] = {
        {text(faces, "4000000000 0 1 2\n"), "line 13: a list has fewer values"},
        {text(faces, "41111111111111111111111 0 1 2\n"), "no length of a list"},
        {text(faces, "3 0 1\n"), "a list has fewer values"},
        {text(faces, "3 0 1.5 2\n"), "\"1.5\" is no number of its property's type"},
        {text(faces, "3 0 1 2 3\n"), "more values than"},
        {text(faces, "3 0\f1 2\n"), "control character"},
        {text(faces, "\n3 0 1 2\n"), "no length of a list"},
        {text(many, "3 0 1 2\n"), "4000000000 element 'face's", true},
        {text(faces + "element what 4000000000\n", "3 0 1 2\n"), "no property"},
        {binary(faces, long_list), "16000000000 more bytes", true},
        {binary(many, good), "4000000000 element 'face's", true},
        {binary(faces + "element what 4000000000\n", good), "no property"},
        {binary(faces + "element w 1\nproperty int64 v\n", good + std::string(8, '\0')), "64 bits"},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.message);
        if (c.cut) {
            test::expect_input_error([&] { read_cloud(write("a.ply", c.bytes)); }, {c.message});
            continue;
        }
        const auto cloud = read_cloud(write("a.ply", c.bytes));
        EXPECT_EQ(cloud.size(), 3u);
        ASSERT_EQ(cloud.notes.size(), 1u);
        EXPECT_THAT(cloud.notes[0], testing::HasSubstr(c.message));
    }
    EXPECT_GT(read_cloud(write("a.ply", text(faces, "3 0 1 2\n"))).size(), 1000u);
    EXPECT_GT(read_cloud(write("a.ply", binary(faces, good))).size(), 1000u);
}

TEST_F(Mesh, bad_files) {
    const std::string glb = test::box_glb(), stl = test::box_stl();
    const auto patched = [&](std::string bytes, const std::string& from, const std::string& to) {
        const auto at = bytes.find(from);
        EXPECT_NE(at, std::string::npos);
        EXPECT_EQ(from.size(), to.size());
        return bytes.replace(at, from.size(), to);
    };
    auto old_version = glb;
    old_version[4] = 1;
    const std::pair<const char*, test::BadFile> cases[] = {
        {"a.glb", {"glTF", {"no GLB"}}},
        {"a.glb", {"something of another kind", {"no GLB"}}},
        {"a.glb", {old_version, {"version 1"}}},
        {"a.glb", {glb.substr(0, glb.size() - 8), {"cut short"}}},
        {"a.glb", {patched(glb, "\"count\":36", "\"count\":99"), {"accessor 1", "more than"}}},
        {"a.glb", {patched(glb, "\"byteOffset\":96", "\"byteOffset\":99"), {"reaches beyond"}}},
        {"a.gltf", {"{", {"no JSON"}}},
        {"a.gltf", {"[]", {"no object"}}},
        {"a.gltf", {R"({"accessors": [{"count": 99999999999}]})", {"accessor 0"}}},
        {"a.gltf", {R"({"buffers": [5]})", {"\"buffers\""}}},
        {"a.gltf", {R"({"bufferViews": [{"buffer": -1}]})", {"\"buffer\"", "-1"}}},
        {"a.stl", {stl.substr(0, stl.size() - 1), {"12 triangles", "cut short"}}},
        {"a.stl", {stl.substr(0, 50), {"84 bytes"}}},
        {"a.obj", {"# nothing\n", {"a.obj"}}},
        {"a.obj", {"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", {"face", "area"}}},
        {"a.obj", {"v 0 0 0\nv 1 0 0\nv 0 2e7 0\nf 1 2 3\n", {"1e+06"}}},
    };
    for (const auto& [name, bad] : cases)
        expect_refused(name, std::span(&bad, 1), [](const auto& file) { read_cloud(file); });
}

}  // namespace
}  // namespace topple::io
