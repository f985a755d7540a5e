// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace topple {

using Vec3 = std::array<double, 3>;
// Row-major 4x4 rigid transform.
using Mat4 = std::array<double, 16>;

// A point cloud in the input's frame, metres, one array per coordinate. It holds the finite points
// only, in input order; `dropped` counts the others.
struct PointCloud {
    std::vector<float> x, y, z;
    std::vector<float> nx, ny, nz;  // unit normals as stored in the input, or empty
    std::uint64_t dropped = 0;      // non-finite points left out
    // Organised clouds (one depth image stored as points): width > 0, height > 1, and `pixel` holds
    // row * width + column of every kept point. Otherwise width = height = 0 and `pixel` is empty.
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> pixel;
    // Where the sensor was, where the file says so (PCD VIEWPOINT that is not all default in an
    // unorganised cloud, or any organised cloud).
    bool has_viewpoint = false;
    Vec3 viewpoint{0, 0, 0};
    std::string source;              // path, for messages
    std::vector<std::string> notes;  // what looks odd but is no error (units), in sentences

    std::size_t size() const { return x.size(); }
};

// Pinhole camera; x right, y down, z forward. Pixel (u, v) has its centre at (u, v).
struct Intrinsics {
    std::uint32_t width = 0, height = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;  // pixels
    double depth_scale = 1000;              // metres = stored value / depth_scale
};

// One depth image. depth: row-major, width*height, 0 = no reading.
struct DepthFrame {
    std::vector<std::uint16_t> depth;
    Mat4 camera_to_world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

}  // namespace topple
