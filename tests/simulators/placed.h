// SPDX-License-Identifier: MIT
#pragma once

#include "core/vectors.h"
#include "export/shape.h"
#include "testing.h"

// Where a shape lies that another library has read.
namespace topple::exports::test {

// A point of the shape's frame in the world: turned by a quaternion (w, x, y, z), and moved.
inline Vec3 placed(const std::array<double, 4>& q, const Vec3& at, const Vec3& p) {
    const auto& [w, x, y, z] = q;
    const Vec3 t{2 * (y * p[2] - z * p[1]), 2 * (z * p[0] - x * p[2]), 2 * (x * p[1] - y * p[0])};
    return {at[0] + p[0] + w * t[0] + y * t[2] - z * t[1],
            at[1] + p[1] + w * t[1] + z * t[0] - x * t[2],
            at[2] + p[2] + w * t[2] + x * t[1] - y * t[0]};
}

// The extents of a shape along the axes, to be those of the part.
struct Bounds : Extents<double> {
    void expect(const ConvexPart& part, double within_m) const {
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_NEAR(low[a], part.low[a], within_m);
            EXPECT_NEAR(high[a], part.high[a], within_m);
        }
    }
};

inline Bounds bounds_of_box(const std::array<double, 4>& q, const Vec3& at, const Vec3& half) {
    Bounds out;
    for (const Vec3& corner : Extents<double>{opposite(half), half}.corners())
        out.add(placed(q, at, corner));
    return out;
}

inline Bounds bounds_of_cylinder(const std::array<double, 4>& q, const Vec3& at, double radius_m,
                                 double half_m) {
    const Vec3 axis = placed(q, {}, {0, 0, 1});
    Bounds out;
    for (const double sign : {-1.0, 1.0}) {
        Vec3 p = at;
        for (std::size_t a = 0; a < 3; ++a)
            p[a] += sign * (half_m * std::abs(axis[a]) +
                            radius_m * std::sqrt(std::max(0.0, 1 - axis[a] * axis[a])));
        out.add(p);
    }
    return out;
}

// Of the corners in an OBJ file.
inline Bounds bounds_of_mesh(const std::array<double, 4>& q, const Vec3& at,
                             const std::string& file) {
    Bounds out;
    std::ifstream stream(file);
    EXPECT_TRUE(stream.good()) << file;
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        std::string kind;
        Vec3 p{};
        if (words >> kind && kind == "v" && words >> p[0] >> p[1] >> p[2])
            out.add(placed(q, at, p));
    }
    return out;
}

}  // namespace topple::exports::test
