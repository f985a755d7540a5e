// SPDX-License-Identifier: MIT
#include "geometry/shell_faces.h"

#include <algorithm>

namespace topple::geometry {

std::vector<Face> faces(const Surfels& s, const std::vector<std::int32_t>& label, std::size_t count,
                        const Vec3& up) {
    std::vector<Face> out(count);
    const double cell_area = s.cell_m * s.cell_m;
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] < 0) continue;
        Face& f = out[static_cast<std::size_t>(label[n])];
        f.area_m2 += cell_area;
        f.nx += s.nx[n], f.ny += s.ny[n], f.nz += s.nz[n];
        f.px += s.x[n], f.py += s.y[n], f.pz += s.z[n];
        const double height = component(up, s.x[n], s.y[n], s.z[n]);
        f.lowest_m = std::min(f.lowest_m, height);
        f.highest_m = std::max(f.highest_m, height);
    }
    for (Face& f : out) {
        const double surfels = std::max(1.0, f.area_m2 / cell_area);
        const double length = std::sqrt(f.nx * f.nx + f.ny * f.ny + f.nz * f.nz);
        f.flatness = length / surfels;
        if (length > 0) f.nx /= length, f.ny /= length, f.nz /= length;
        f.px /= surfels, f.py /= surfels, f.pz /= surfels;
    }
    return out;
}

double ceiling_height(const std::vector<Face>& faces, const Vec3& up, double floor_m,
                      double top_m) {
    double height = -INFINITY;
    for (const Face& f : faces) {
        if (f.level(up) < -horizontal_cos && f.area_m2 >= wall_area_m2 &&
            f.lowest_m - floor_m >= lowest_ceiling_m && f.highest_m < top_m)
            height = std::max(height, f.lowest_m);
    }
    return std::isfinite(height) ? height : INFINITY;
}

}  // namespace topple::geometry
