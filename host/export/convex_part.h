// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/extents.h"
#include "topple/input.h"

namespace topple::exports {

// The half-space normal . x <= offset_m; the normal is a unit vector.
struct HalfSpace {
    Vec3 normal{};
    double offset_m = 0;
};

// What is so close to a plane lies on neither side of it.
inline constexpr double on_plane_m = 1e-4;

// As many points tell where the solid of a part lies.
inline constexpr std::size_t most_points = 512;

// A convex polytope, metres, with the box around it.
struct ConvexPart : Extents<double> {
    std::vector<Vec3> corner;
    std::vector<HalfSpace> face;
    // Corners of each face, counter-clockwise as seen from outside.
    std::vector<std::vector<std::uint32_t>> outline;
    double volume_m3 = 0;
    // Points spread over what of it was found to be solid, and the volume that each stands for.
    std::vector<Vec3> solid;
    double solid_each_m3 = 0;
};

// The hull of points; nothing where they span no volume.
std::optional<ConvexPart> hull_part(std::span<const Vec3> points);

// In square metres.
std::vector<double> face_areas(const ConvexPart& part);

// Another form of the same solid: the hull of points, or nothing.
std::optional<ConvexPart> reshaped(const ConvexPart& part, std::span<const Vec3> points);

// What of the part lies in the half-space, and of what is solid of it; nothing where that has no
// volume.
std::optional<ConvexPart> cut(const ConvexPart& part, const HalfSpace& to);

// The part with each face moved inwards by so much; the part itself, where that leaves nothing.
ConvexPart shrunk(const ConvexPart& part, double by_m);

ConvexPart moved(ConvexPart part, const Vec3& by);

// The interval of n . x over the part.
struct Interval {
    double low = 0, high = 0;
};
Interval extent_along(const ConvexPart& part, const Vec3& n);

// The eight corners of a box that is the part to within `tolerance_m`, in the order of the bits
// (x, y, z) of its own axes; or nothing. Which of the part's faces it follows is the same on every
// machine.
struct Box {
    Vec3 center{};
    std::array<Vec3, 3> axis{};  // unit, right-handed
    Vec3 half_m{};
    std::array<Vec3, 8> corners() const;
};
std::optional<Box> as_box(const ConvexPart& part, double tolerance_m);

}  // namespace topple::exports
