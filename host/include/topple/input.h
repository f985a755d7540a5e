// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace topple {

using Vec3 = std::array<double, 3>;
using Mat3 = std::array<double, 9>;  // row-major
// Row-major 4x4 rigid transform.
using Mat4 = std::array<double, 16>;

// A point cloud in the input's frame, metres, one array per coordinate. It holds the finite points
// only, in input order; `dropped` counts the others.
struct PointCloud {
    std::vector<float> x, y, z;
    std::vector<float> nx, ny, nz;  // unit normals as stored in the input, or empty
    // sRGB, 0 to 255, as stored in the input, or empty. 0, 0, 0: this point's is not known, as
    // scanners write it.
    std::vector<std::uint8_t> red, green, blue;
    std::uint64_t dropped = 0;  // non-finite points left out
    // Organised clouds (one depth image stored as points): width > 0, height > 1, and `pixel` holds
    // row * width + column of every kept point. Otherwise width = height = 0 and `pixel` is empty.
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> pixel;
    // Where the sensor was, where the file says so (PCD VIEWPOINT that is not all default in an
    // unorganised cloud, or any organised cloud).
    bool has_viewpoint = false;
    Vec3 viewpoint{0, 0, 0};
    // Or of each point, of an unorganised cloud that several scans or a moving sensor made (PCL's
    // vp_x, vp_y, vp_z), metres; or empty. NaN: not known.
    std::vector<float> viewpoint_x, viewpoint_y, viewpoint_z;
    // Else where it may have been: the origin of the numbers that the file holds, which a scan of
    // one sensor that was moved since has there still.
    Vec3 origin_m{0, 0, 0};
    Vec3 offset_m{0, 0, 0};          // the file's coordinates are these points' plus this
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
    // sRGB, 3 bytes for each pixel, 0, 0, 0 where it is not known; or empty.
    std::vector<std::uint8_t> rgb{};
};

// Acceleration of the ground in one level direction, and in others where they are known, at equal
// steps of time and straight between them; before and after, 0.
struct Accelerogram {
    std::vector<double> m_s2;
    double step_s = 0;
    std::string source;              // path, for messages
    std::vector<std::string> notes;  // what was taken for granted, in sentences
    // Level and a quarter turn to the left of m_s2, and upwards: as many samples, or none.
    std::vector<double> across_m_s2{}, up_m_s2{};

    // Of the level components: of two the geometric mean, as earthquakes are mostly described.
    double peak_m_s2() const {
        const auto peak_of = [](const std::vector<double>& values) {
            double peak = 0;
            for (const double a : values) peak = std::max(peak, std::fabs(a));
            return peak;
        };
        const double along = peak_of(m_s2);
        return across_m_s2.empty() ? along : std::sqrt(along * peak_of(across_m_s2));
    }
    double duration_s() const {
        return m_s2.empty() ? 0 : step_s * static_cast<double>(m_s2.size() - 1);
    }
};

// How many m/s^2 one of a unit is: "g", "m/s2", "cm/s2". Throws Error(usage) for another.
double acceleration_unit_m_s2(const std::string& name);

// Reads a record of an earthquake from
//   - JSON: "dT" (or "dt"), seconds, and a list "accel_data" (or "data", "acceleration", "accel"),
//     with "unit" and "factor", by which the values count, if any; at the top or in "timeSeries";
//   - PEER's .AT2: header lines, the last with NPTS and DT, and then the samples;
//   - text: a line of time in seconds and acceleration for each sample. Other columns are not
//     looked at. The unit stands in its header: "# time s, acceleration m/s^2".
// Units are g, m/s^2, cm/s^2 and gal; `unit_m_s2`, of which a value is so many, overrides them.
// Without any it is g, which is noted. Throws Error(input) naming the file and the fault; peaks
// beyond 10 g are one, or beyond 3 g where no unit was named.
Accelerogram read_accelerogram(const std::filesystem::path& file,
                               std::optional<double> unit_m_s2 = std::nullopt);

// Reads the components of one record, each from a file of its own, so many seconds apart as the
// first one's samples, with which they begin: what is longer is cut off, what is shorter ends in 0.
// No path: that component is not known. Throws Error(input) as above, and where steps differ.
Accelerogram read_accelerogram(const std::filesystem::path& along,
                               const std::optional<std::filesystem::path>& across,
                               const std::optional<std::filesystem::path>& up,
                               std::optional<double> unit_m_s2 = std::nullopt);

// How often the ground at a place shakes: annual rates at which peak ground accelerations are
// exceeded, by rising peaks and falling rates, straight between them in logarithms of both.
struct HazardCurve {
    std::vector<double> pga_g, per_year;
    std::string source;  // path, for messages

    std::optional<std::string> fault() const;  // what keeps it from being such a curve
};

// Reads a hazard curve: JSON with lists "pga_g" and "per_year", or text with a line of peak ground
// acceleration in g and annual rate for each point; lines that begin with a letter or # are
// headers. Throws Error(input) naming the file and the fault.
HazardCurve read_hazard_curve(const std::filesystem::path& file);

}  // namespace topple
