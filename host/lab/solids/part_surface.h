// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lab/solids/part.h"

// The surface of a Part as sheets with coordinates, cut into small patches that points can be
// spread over evenly. Room frame, metres and radians.
namespace topple::scenes {

// The place that is so far from an origin along three axes.
Vec3 combined(const Vec3& origin, const std::array<Vec3, 3>& axes, double a, double b, double c);

// A flat rectangle (u, v: metres along the first two axes), what an edge of a profile sweeps out
// about the third axis (u: angle, v: share of the way from its lower end to its upper), or a piece
// of a sphere (u, v: longitude and latitude).
struct Sheet {
    enum class Kind : std::uint8_t { flat, swept, round };
    Kind kind = Kind::flat;
    std::int32_t part = -1;
    Vec3 origin{};
    std::array<Vec3, 3> axes{};
    std::array<double, 2> u{}, v{};               // from, to
    double radius = 0, height = 0;                // swept: where v = 0; round: radius only
    double radius_change = 0, height_change = 0;  // swept: from v = 0 to v = 1

    struct Place {
        Vec3 point, normal;  // unit, outwards
    };
    Place at(double u_value, double v_value) const;
};

// A rectangle of a sheet's coordinates.
struct Patch {
    std::uint32_t sheet = 0;
    std::array<double, 2> u{}, v{};

    double area(const Sheet& sheet_of_it) const;
    // The point at shares (0 to 1) of its area along u and along v.
    Sheet::Place spread(const Sheet& sheet_of_it, double along_u, double along_v) const;
    Sheet::Place middle(const Sheet& sheet_of_it) const {
        return sheet_of_it.at((u[0] + u[1]) / 2, (v[0] + v[1]) / 2);
    }
    std::array<Patch, 4> quarters() const;
};

// Adds the sheets of a part, with `part` as theirs.
void add_sheets(const Part& part, std::int32_t id, std::vector<Sheet>& sheets);

// Adds patches of at most `size` along either coordinate, and of an eighth of a turn, that make up
// a sheet.
void add_patches(const Sheet& sheet, std::uint32_t id, double size, std::vector<Patch>& patches);

}  // namespace topple::scenes
