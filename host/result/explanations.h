// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "core/rotation.h"
#include "geometry/manhattan.h"
#include "objects/object_stage.h"
#include "safety/safety_stage.h"
#include "topple/scene.h"

namespace topple {

// From the grid frame to the input's.
class ToInput {
  public:
    explicit ToInput(const geometry::SceneFrame& frame)
        : axes_(frame.axes), origin_m_(frame.origin_m) {}
    Vec3 place(const Vec3& g) const { return plus(way(g), origin_m_); }
    Vec3 way(const Vec3& g) const { return turned_back(axes_, g); }
    // Along up from the input's origin, of that from the grid's.
    double height(double g) const { return g + dot(axes_[2], origin_m_); }
    // Of standard errors along the grid's axes, those along the input's.
    Vec3 errors(const Vec3& g) const {
        Vec3 out{};
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = std::hypot(g[0] * axes_[0][c], g[1] * axes_[1][c], g[2] * axes_[2][c]);
        return out;
    }

    // Of a symmetric tensor along the grid's axes (xx, yy, zz, xy, xz, yz), that along the input's.
    Mat3 tensor(const std::array<double, 6>& g) const {
        const double full[3][3] = {{g[0], g[3], g[4]}, {g[3], g[1], g[5]}, {g[4], g[5], g[2]}};
        Mat3 out{};
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t a = 0; a < 3; ++a)
                    for (std::size_t b = 0; b < 3; ++b)
                        out[3 * r + c] += axes_[a][r] * full[a][b] * axes_[b][c];
        return out;
    }

  private:
    const Rotation& axes_;
    const Vec3& origin_m_;
};

// Clockwise from north, +y of the grid frame, from 0 to 360.
double azimuth_deg(const Vec3& way);

// Fills in each object's `why`, but for what it stands on: that and the energies are there already;
// and but for its sentence, as that of `advice` (sentences.h).
void explain(const ObjectStage& objects, const ToInput& to_input, Scene& scene);

// Fills in each object's `fall` and `advice`, from `why` and the supports.
void predict_falls(const ObjectStage& objects, const SafetyStage& safety, const ToInput& to_input,
                   Scene& scene);

}  // namespace topple
