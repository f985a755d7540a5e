// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "core/vectors.h"

namespace topple::solids {

// The sum of the squared distances to planes.
class ErrorQuadric {
  public:
    // normal: of unit length, or shorter, to count for less.
    void add_plane(const Vec3& normal, const Vec3& through) {
        const double d = -dot(normal, through);
        const std::array<double, 4> p{normal[0], normal[1], normal[2], d};
        std::size_t n = 0;
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = a; b < 4; ++b) m_[n++] += p[a] * p[b];
    }
    void add(const ErrorQuadric& other) {
        for (std::size_t n = 0; n < m_.size(); ++n) m_[n] += other.m_[n];
    }
    double at(const Vec3& p) const {
        const double x = p[0], y = p[1], z = p[2];
        return x * (m_[0] * x + 2 * (m_[1] * y + m_[2] * z + m_[3])) +
               y * (m_[4] * y + 2 * (m_[5] * z + m_[6])) + z * (m_[7] * z + 2 * m_[8]) + m_[9];
    }

  private:
    std::array<double, 10> m_{};
};

}  // namespace topple::solids
