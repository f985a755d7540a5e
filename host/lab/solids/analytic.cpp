// SPDX-License-Identifier: MIT
#include "lab/solids/analytic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

#include "topple/error.h"

namespace topple::scenes {
namespace {

using std::numbers::pi;

double height(const AnalyticSolid& s) {
    if (s.body == Body::hemisphere) return s.size[0] / 2;
    return s.body == Body::sphere ? s.size[0] : s.size[2];
}

Vec3 to_world(const AnalyticSolid& s, const Vec3& p) {
    Vec3 out = s.at;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t k = 0; k < 3; ++k) out[row] += s.turn[3 * row + k] * p[k];
    }
    return out;
}

bool inside_body(const AnalyticSolid& s, const Vec3& p) {
    const double r = s.size[0] / 2, h = height(s), x = p[0], y = p[1], z = p[2];
    if (z < 0 || z > h) return false;
    switch (s.body) {
        case Body::box:
            return std::abs(x) <= r && std::abs(y) <= s.size[1] / 2;
        case Body::cylinder:
            return x * x + y * y <= r * r;
        case Body::cone:
            return std::hypot(x, y) <= r * (1 - z / h);
        case Body::hemisphere:
            return x * x + y * y + z * z <= r * r;
        case Body::sphere:
            return x * x + y * y + (z - r) * (z - r) <= r * r;
    }
    return false;
}

}  // namespace

double AnalyticSolid::volume() const {
    const double r = size[0] / 2;
    switch (body) {
        case Body::box:
            return size[0] * size[1] * size[2];
        case Body::cylinder:
            return pi * r * r * size[2];
        case Body::cone:
            return pi * r * r * size[2] / 3;
        case Body::hemisphere:
            return 2 * pi / 3 * r * r * r;
        case Body::sphere:
            return 4 * pi / 3 * r * r * r;
    }
    return 0;
}

Vec3 AnalyticSolid::center() const {
    double above = height(*this) / 2;
    if (body == Body::cone) above = height(*this) / 4;
    if (body == Body::hemisphere) above = 3 * size[0] / 16;  // 3 r / 8
    return to_world(*this, {0, 0, above});
}

bool AnalyticSolid::inside(const Vec3& world) const {
    Vec3 local{};
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t row = 0; row < 3; ++row)
            local[k] += turn[3 * row + k] * (world[row] - at[row]);
    }
    return inside_body(*this, local);
}

std::array<Vec3, 2> AnalyticSolid::bounds() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<Vec3, 2> box{Vec3{infinity, infinity, infinity},
                            Vec3{-infinity, -infinity, -infinity}};
    const double rx = size[0] / 2, ry = body == Body::box ? size[1] / 2 : rx;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 p = to_world(
            *this, {corner & 1 ? rx : -rx, corner & 2 ? ry : -ry, corner & 4 ? height(*this) : 0});
        for (std::size_t k = 0; k < 3; ++k) {
            box[0][k] = std::min(box[0][k], p[k]);
            box[1][k] = std::max(box[1][k], p[k]);
        }
    }
    return box;
}

void append(SolidCells& cells, const AnalyticSolid& solid, std::int32_t primitive) {
    const double h = cells.voxel_m;
    const auto box = solid.bounds();
    std::array<std::int64_t, 3> low{}, high{};
    double tests = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        tests *= (box[1][k] - box[0][k]) / h + 1;
        if (!(h > 0 && tests < 1e8)) {
            throw Error(ErrorKind::usage, "analytic solid: voxels of " + std::to_string(h) +
                                              " m are too small for it");
        }
        low[k] = static_cast<std::int64_t>(std::floor(box[0][k] / h));
        high[k] = static_cast<std::int64_t>(std::ceil(box[1][k] / h));
    }
    const auto solid_at = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
        return solid.inside({(static_cast<double>(i) + 0.5) * h, (static_cast<double>(j) + 0.5) * h,
                             (static_cast<double>(k) + 0.5) * h});
    };
    using Cell = std::tuple<std::int32_t, std::int32_t, std::int32_t, std::int32_t, Basis>;
    std::vector<Cell> all;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        all.emplace_back(cells.i[n], cells.j[n], cells.k[n], cells.primitive[n], cells.basis[n]);
    }
    for (std::int64_t i = low[0]; i < high[0]; ++i) {
        for (std::int64_t j = low[1]; j < high[1]; ++j) {
            for (std::int64_t k = low[2]; k < high[2]; ++k) {
                if (!solid_at(i, j, k)) continue;
                const bool inner = solid_at(i - 1, j, k) && solid_at(i + 1, j, k) &&
                                   solid_at(i, j - 1, k) && solid_at(i, j + 1, k) &&
                                   solid_at(i, j, k - 1) && solid_at(i, j, k + 1);
                all.emplace_back(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j),
                                 static_cast<std::int32_t>(k), primitive,
                                 inner ? Basis::two_votes : Basis::surface);
            }
        }
    }
    const auto place = [](const Cell& c) {
        return std::tuple(std::get<0>(c), std::get<1>(c), std::get<2>(c));
    };
    std::stable_sort(all.begin(), all.end(),
                     [&](const Cell& a, const Cell& b) { return place(a) < place(b); });
    all.erase(std::unique(all.begin(), all.end(),
                          [&](const Cell& a, const Cell& b) { return place(a) == place(b); }),
              all.end());
    cells.i.clear();
    cells.j.clear();
    cells.k.clear();
    cells.primitive.clear();
    cells.basis.clear();
    for (const auto& [i, j, k, p, s] : all) {
        cells.i.push_back(i);
        cells.j.push_back(j);
        cells.k.push_back(k);
        cells.primitive.push_back(p);
        cells.basis.push_back(s);
    }
}

}  // namespace topple::scenes
