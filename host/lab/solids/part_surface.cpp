// SPDX-License-Identifier: MIT
#include "lab/solids/part_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::scenes {
namespace {

using std::numbers::pi;

// Adds sheets of one part in its own frame.
class Builder {
  public:
    Builder(const Part& part, std::int32_t id, std::vector<Sheet>& sheets)
        : part_(part), axes_(part.axes()), id_(id), sheets_(sheets) {}

    // The six faces of a box, each reaching `core` to both sides and `half` out.
    void faces(const Vec3& core, const Vec3& half) {
        for (std::size_t k = 0; k < 3; ++k) {
            for (const double side : {-1.0, 1.0}) {
                Sheet& s = add(Sheet::Kind::flat, k);
                if (side < 0) {  // u and v change places, so that the third axis points outwards
                    std::swap(s.axes[0], s.axes[1]);
                    for (double& x : s.axes[2]) x = -x;
                }
                const std::size_t first = (k + (side < 0 ? 2 : 1)) % 3,
                                  second = (k + (side < 0 ? 1 : 2)) % 3;
                s.origin = combined(s.origin, s.axes, 0, 0, half[k]);
                s.u = {-core[first], core[first]};
                s.v = {-core[second], core[second]};
            }
        }
    }

    // Quarters of cylinders along the edges and eighths of spheres at the corners.
    void rounded_edges(const Vec3& core, double rounding) {
        constexpr std::array<std::array<double, 2>, 4> quadrants{
            {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
        for (std::size_t q = 0; q < 4; ++q) {
            const std::array<double, 2> turn{pi / 2 * static_cast<double>(q),
                                             pi / 2 * static_cast<double>(q + 1)};
            for (std::size_t k = 0; k < 3; ++k) {
                Sheet& s = add(Sheet::Kind::swept, k);
                s.origin = combined(s.origin, s.axes, quadrants[q][0] * core[(k + 1) % 3],
                                    quadrants[q][1] * core[(k + 2) % 3], 0);
                s.u = turn;
                s.v = {0, 1};
                s.radius = rounding;
                s.height = -core[k];
                s.height_change = 2 * core[k];
            }
            for (const double side : {-1.0, 1.0}) {
                Sheet& s = add(Sheet::Kind::round, 2);
                s.origin = combined(s.origin, s.axes, quadrants[q][0] * core[0],
                                    quadrants[q][1] * core[1], side * core[2]);
                s.u = turn;
                s.v = {side < 0 ? -pi / 2 : 0, side < 0 ? 0 : pi / 2};
                s.radius = rounding;
            }
        }
    }

    void swept(const solids::Profile& profile) {
        for (std::size_t n = 1; n < profile.size(); ++n) {
            const auto [r0, z0] = profile[n - 1];
            const auto [r1, z1] = profile[n];
            if (r0 + r1 <= 0 || (r0 == r1 && z0 == z1)) continue;
            Sheet& s = add(Sheet::Kind::swept, 2);
            s.u = {0, 2 * pi};
            s.v = {0, 1};
            s.radius = r0;
            s.height = z0;
            s.radius_change = r1 - r0;
            s.height_change = z1 - z0;
        }
    }

    void sphere(double radius) {
        Sheet& s = add(Sheet::Kind::round, 2);
        s.u = {0, 2 * pi};
        s.v = {-pi / 2, pi / 2};
        s.radius = radius;
    }

  private:
    // About or across axis k.
    Sheet& add(Sheet::Kind kind, std::size_t k) {
        Sheet& sheet = sheets_.emplace_back();
        sheet.kind = kind;
        sheet.part = id_;
        sheet.origin = part_.center;
        sheet.axes = {axes_[(k + 1) % 3], axes_[(k + 2) % 3], axes_[k]};
        return sheet;
    }

    const Part& part_;
    std::array<Vec3, 3> axes_;
    std::int32_t id_;
    std::vector<Sheet>& sheets_;
};

}  // namespace

Vec3 combined(const Vec3& origin, const std::array<Vec3, 3>& axes, double a, double b, double c) {
    Vec3 out = origin;
    for (std::size_t k = 0; k < 3; ++k) out[k] += a * axes[0][k] + b * axes[1][k] + c * axes[2][k];
    return out;
}

Sheet::Place Sheet::at(double u_value, double v_value) const {
    constexpr Vec3 zero{};
    if (kind == Kind::flat) return {combined(origin, axes, u_value, v_value, 0), axes[2]};
    const double c = std::cos(u_value), s = std::sin(u_value);
    if (kind == Kind::round) {
        const double across = std::cos(v_value), up = std::sin(v_value);
        return {combined(origin, axes, radius * c * across, radius * s * across, radius * up),
                combined(zero, axes, c * across, s * across, up)};
    }
    const double r = radius + v_value * radius_change,
                 length = std::hypot(radius_change, height_change);
    // A profile runs upwards along the outside.
    const double outwards = height_change / length, upwards = -radius_change / length;
    return {combined(origin, axes, c * r, s * r, height + v_value * height_change),
            combined(zero, axes, c * outwards, s * outwards, upwards)};
}

double Patch::area(const Sheet& s) const {
    const double across = u[1] - u[0], along = v[1] - v[0];
    switch (s.kind) {
        case Sheet::Kind::flat:
            return across * along;
        case Sheet::Kind::round:
            return s.radius * s.radius * across * (std::sin(v[1]) - std::sin(v[0]));
        case Sheet::Kind::swept:
            return across * along * std::hypot(s.radius_change, s.height_change) *
                   (s.radius + (v[0] + v[1]) / 2 * s.radius_change);
    }
    return 0;
}

Sheet::Place Patch::spread(const Sheet& s, double along_u, double along_v) const {
    double share = v[0] + along_v * (v[1] - v[0]);
    if (s.kind == Sheet::Kind::swept && s.radius_change != 0) {
        // Equal areas are equal steps of the radius' square.
        const double a = s.radius + v[0] * s.radius_change, b = s.radius + v[1] * s.radius_change;
        share = (std::sqrt(a * a + along_v * (b * b - a * a)) - s.radius) / s.radius_change;
    } else if (s.kind == Sheet::Kind::round) {
        const double low = std::sin(v[0]), high = std::sin(v[1]);
        share = std::asin(std::clamp(low + along_v * (high - low), -1.0, 1.0));
    }
    return s.at(u[0] + along_u * (u[1] - u[0]), share);
}

std::array<Patch, 4> Patch::quarters() const {
    const double mu = (u[0] + u[1]) / 2, mv = (v[0] + v[1]) / 2;
    return {Patch{sheet, {u[0], mu}, {v[0], mv}}, Patch{sheet, {mu, u[1]}, {v[0], mv}},
            Patch{sheet, {u[0], mu}, {mv, v[1]}}, Patch{sheet, {mu, u[1]}, {mv, v[1]}}};
}

void add_sheets(const Part& part, std::int32_t id, std::vector<Sheet>& sheets) {
    Builder builder(part, id, sheets);
    const Vec3 half{part.size[0] / 2, part.size[1] / 2, part.size[2] / 2};
    switch (part.shape) {
        case Shape::box:
            return builder.faces(half, half);
        case Shape::rounded_box: {
            const double r = part.rounding;
            const Vec3 core{half[0] - r, half[1] - r, half[2] - r};
            builder.faces(core, half);
            return builder.rounded_edges(core, r);
        }
        case Shape::sphere:
            return builder.sphere(half[0]);
        case Shape::revolved:
            return builder.swept(part.profile);
        default: {
            const auto rims = part.outline();
            return builder.swept({{0, rims[0][1]}, rims[0], rims[1], {0, rims[1][1]}});
        }
    }
}

void add_patches(const Sheet& s, std::uint32_t id, double size, std::vector<Patch>& patches) {
    double across = s.u[1] - s.u[0], along = s.v[1] - s.v[0];
    double least_u = 1, least_v = 1;
    if (s.kind == Sheet::Kind::swept) {
        least_u = across / (pi / 4);
        across *= std::max(s.radius, s.radius + s.radius_change);
        along = std::hypot(s.radius_change, s.height_change);
    } else if (s.kind == Sheet::Kind::round) {
        least_u = across / (pi / 4);
        least_v = along / (pi / 4);
        across *= s.radius;
        along *= s.radius;
    }
    const auto columns = static_cast<std::size_t>(std::ceil(std::max(least_u, across / size)));
    const auto rows = static_cast<std::size_t>(std::ceil(std::max(least_v, along / size)));
    const auto step = [](const std::array<double, 2>& range, std::size_t n, std::size_t count) {
        return range[0] +
               (range[1] - range[0]) * static_cast<double>(n) / static_cast<double>(count);
    };
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            patches.push_back({id,
                               {step(s.u, column, columns), step(s.u, column + 1, columns)},
                               {step(s.v, row, rows), step(s.v, row + 1, rows)}});
        }
    }
}

}  // namespace topple::scenes
