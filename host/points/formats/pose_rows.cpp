// SPDX-License-Identifier: MIT
#include "points/formats/pose_rows.h"

#include <algorithm>
#include <cmath>

namespace topple::io {
namespace {

// Of rotations that are written with three digits or more.
constexpr double tolerance = 0.01;

double norm(std::span<const double> values) {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return std::sqrt(sum);
}

bool is_unit(std::span<const double> values) {
    return std::abs(norm(values) - 1) <= tolerance;
}

// Whether three rows begin with those of a rotation.
bool is_rotation(const double* a, const double* b, const double* c) {
    const std::array<const double*, 3> rows{a, b, c};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j) {
            double dot = 0;
            for (std::size_t k = 0; k < 3; ++k) dot += rows[i][k] * rows[j][k];
            if (!(std::abs(dot - (i == j ? 1 : 0)) <= tolerance)) return false;
        }
    }
    return true;
}

}  // namespace

void PoseRows::add(std::span<const double> values, std::size_t columns) {
    if (full()) return;
    std::ranges::copy(values.first(std::min(values.size(), most_columns)), row_[rows_].begin());
    columns_[rows_++] = columns;
}

bool PoseRows::are_poses() const {
    return rows_ > 0 && (tum() || kitti() || matrices());
}

bool PoseRows::tum() const {
    // Normals and something that is 0 beside them, as a curvature, are no quaternions; points in
    // rows whose first column rises, of all such rows, are rare.
    bool normals = true;
    for (std::size_t n = 0; n < rows_; ++n) {
        const std::span<const double> q(row_[n].data() + 4, 4);
        if (columns_[n] != 8 || !is_unit(q) || (n > 0 && !(row_[n][0] > row_[n - 1][0])))
            return false;
        normals &= is_unit(q.first(3));
    }
    return !normals;
}

bool PoseRows::kitti() const {
    for (std::size_t n = 0; n < rows_; ++n) {
        const double* const m = row_[n].data();
        if (columns_[n] != 12 || !is_rotation(m, m + 4, m + 8)) return false;
    }
    return true;
}

bool PoseRows::matrices() const {
    const std::size_t head = columns_[0] == 3 ? 1 : 0;
    if (rows_ < head + 4) return false;
    for (std::size_t n = head; n < head + 4; ++n)
        if (columns_[n] != 4) return false;
    return is_rotation(row_[head].data(), row_[head + 1].data(), row_[head + 2].data()) &&
           std::equal(row_[head + 3].begin(), row_[head + 3].begin() + 4,
                      std::array{0.0, 0.0, 0.0, 1.0}.begin());
}

}  // namespace topple::io
