// SPDX-License-Identifier: MIT
#include "geometry/upright_box.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "host/geometry/sampled_faces.h"

namespace topple::geometry {
namespace {

using Eigen::Vector3d;

// A box on a floor at 0, turned by 20 degrees, of which some sides were seen, and perhaps its top.
struct Seen {
    const char* what;
    Vector3d size;
    std::size_t sides;
    bool top;
    double from_m;  // how high it begins
    bool box;       // whether it is an upright box that stands by itself
};

bool is_box(const Seen& s) {
    test::SampledFaces faces(0.03);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.35, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d x = turn * Vector3d(s.size[0], 0, 0), y = turn * Vector3d(0, s.size[1], 0),
                   z(0, 0, s.size[2]), low(1, 1, s.from_m);
    if (s.top) faces.face(0, low + z, x, y);
    const std::vector<std::array<Vector3d, 2>> sides{
        {low, x}, {low + x, y}, {low + x + y, -x}, {low + y, -y}};
    for (std::size_t n = 0; n < s.sides; ++n) faces.face(0, sides[n][0], sides[n][1], z);
    const PrimitiveShapes shapes = primitive_shapes(faces.samples, 1);
    return is_upright_box(faces.samples, shapes.of[0], 0);
}

TEST(UprightBox, StandsByItself) {
    for (const Seen& s : {
             Seen{"a cupboard in a room", {0.8, 0.35, 1.8}, 4, true, 0, true},
             Seen{"a cupboard at a wall", {0.5, 0.4, 0.8}, 3, true, 0, true},
             Seen{"a cabinet on feet", {0.4, 0.3, 1.9}, 4, true, 0.1, true},
             Seen{"a corner of a room from outside", {0.8, 0.4, 1.8}, 2, true, 0, false},
             Seen{"a pillar up to the ceiling", {0.5, 0.5, 2.5}, 4, false, 0, false},
             Seen{"a step", {0.8, 0.8, 0.18}, 4, true, 0, false},
             Seen{"a partition", {1.2, 0.08, 1.2}, 4, true, 0, false},
             Seen{"a counter", {2.6, 0.6, 0.9}, 4, true, 0, false},
             Seen{"a cabinet on a wall", {0.8, 0.35, 0.6}, 4, true, 1.4, false},
         })
        EXPECT_EQ(is_box(s), s.box) << s.what;
}

// A sofa's seat lies within its box.
TEST(UprightBox, IsNoOtherShape) {
    test::SampledFaces faces(0.03);
    faces.box(0, {0, 0, 0}, {1.2, 0.8, 0.4});
    faces.box(0, {0, 0.6, 0.4}, {1.2, 0.8, 0.8});
    EXPECT_FALSE(is_upright_box(faces.samples, primitive_shapes(faces.samples, 1).of[0], 0));
}

}  // namespace
}  // namespace topple::geometry
