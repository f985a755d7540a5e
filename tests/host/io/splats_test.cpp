// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <vector>

#include "files.h"
#include "points/formats/read_cloud.h"

namespace topple::io {
namespace {

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
