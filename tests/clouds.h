// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"
#include "topple/input.h"

// Clouds, made point by point, and compared so.
namespace topple::test {

// Of clouds, surfels and samples.
template <class Cloud>
void add(Cloud& cloud, double x, double y, double z) {
    cloud.x.push_back(static_cast<float>(x));
    cloud.y.push_back(static_cast<float>(y));
    cloud.z.push_back(static_cast<float>(z));
}
template <class Cloud, class Point = Vec3>
void add(Cloud& cloud, const Point& p) {
    add(cloud, p[0], p[1], p[2]);
}
template <class Cloud, class Normal = Vec3>
void add_normal(Cloud& cloud, const Normal& n) {
    cloud.nx.push_back(static_cast<float>(n[0]));
    cloud.ny.push_back(static_cast<float>(n[1]));
    cloud.nz.push_back(static_cast<float>(n[2]));
}
template <class Points = std::vector<Vec3>>
PointCloud cloud_of(const Points& points) {
    PointCloud out;
    for (const auto& p : points) add(out, p);
    return out;
}

using Points = std::vector<std::array<float, 3>>;
using Colours = std::vector<std::array<int, 3>>;

template <class Out, class In>
Out rows_of(const std::vector<In>& a, const std::vector<In>& b, const std::vector<In>& c) {
    Out out(a.size());
    for (std::size_t n = 0; n < a.size(); ++n) out[n] = {a[n], b.at(n), c.at(n)};
    return out;
}
inline Points points_of(const PointCloud& cloud) {
    return rows_of<Points>(cloud.x, cloud.y, cloud.z);
}
inline Points normals_of(const PointCloud& cloud) {
    return rows_of<Points>(cloud.nx, cloud.ny, cloud.nz);
}
inline Points viewpoints_of(const PointCloud& cloud) {
    return rows_of<Points>(cloud.viewpoint_x, cloud.viewpoint_y, cloud.viewpoint_z);
}
inline Colours colours_of(const PointCloud& cloud) {
    return rows_of<Colours>(cloud.red, cloud.green, cloud.blue);
}

}  // namespace topple::test
