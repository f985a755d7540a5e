// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "clouds.h"
#include "geometry/surface_samples.h"

namespace topple::test {

// Samples of faces on a square lattice, as if the faces had been scanned evenly.
struct SampledFaces {
    geometry::SurfaceSamples samples;

    explicit SampledFaces(double spacing_m) { samples.edge_m = samples.spacing_m = spacing_m; }

    // Parallelogram from `corner` along u and v; its normal is u x v.
    void face(std::int32_t primitive, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
              const Eigen::Vector3d& v) {
        const auto nu = std::lround(u.norm() / samples.spacing_m),
                   nv = std::lround(v.norm() / samples.spacing_m);
        const Eigen::Vector3d n = u.cross(v).normalized();
        for (long a = 0; a < nu; ++a) {
            for (long b = 0; b < nv; ++b)
                add(primitive,
                    corner + (double(a) + 0.5) / double(nu) * u +
                        (double(b) + 0.5) / double(nv) * v,
                    n);
        }
    }
    // Without its underside.
    void box(std::int32_t primitive, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
        const Eigen::Vector3d size = high - low;
        const Eigen::Vector3d x(size[0], 0, 0), y(0, size[1], 0), z(0, 0, size[2]);
        face(primitive, low + z, x, y);
        face(primitive, low, x, z);
        face(primitive, low + x, y, z);
        face(primitive, low + x + y, -x, z);
        face(primitive, low + y, -y, z);
    }
    // Of all samples of one primitive; the others have none, unless they are painted as well.
    void paint(std::int32_t primitive, float l, float a, float b) {
        for (auto* values : {&samples.lab_l, &samples.lab_a, &samples.lab_b})
            values->resize(samples.size(), std::numeric_limits<float>::quiet_NaN());
        for (std::size_t n = 0; n < samples.size(); ++n) {
            if (samples.primitive[n] != primitive) continue;
            samples.lab_l[n] = l;
            samples.lab_a[n] = a;
            samples.lab_b[n] = b;
        }
    }

  private:
    void add(std::int32_t primitive, const Eigen::Vector3d& p, const Eigen::Vector3d& n) {
        test::add(samples, p);
        test::add_normal(samples, n);
        samples.primitive.push_back(primitive);
    }
};

}  // namespace topple::test
