// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/colour_space.h"
#include "topple/scene.h"

// Pictures of an object's energy landscapes (paper, Figs. 5 and 6), as what is to be drawn: the
// page draws it in the browser, the command line into a PNG.
namespace topple::report {

using Point = std::array<double, 2>;  // x to the right, y downwards, pixels

struct Drawing {
    enum class Style : std::uint8_t { axis, curve, border, pass, lowest, pose, now };
    struct Stroke {
        Style style;
        std::vector<Point> points;
    };
    struct Dot {
        Style style;
        Point at;
        double radius;
    };
    enum class Anchor : std::uint8_t { start, middle, end };
    struct Swatch {
        Point corner;
        double width, height;
        Rgb8 colour;
    };
    struct Label {
        Point at;  // of the base line
        Anchor anchor;
        bool strong;
        std::string text;
    };
    // The pose landscape of a hull, painted below all else: an equal-area map of the sphere of up
    // directions in a disc. The middle is the pose as it is; a place away from it is the body
    // leaning that way, north at the top, the rim upside down.
    struct Sphere {
        Point middle;
        double radius;
        std::vector<Vec3> corners;   // metres, x east, y north, z up, about the centre of mass
        double lowest_m, highest_m;  // of the centre of mass above the plane
    };
    // Squares of colours, painted below all else.
    struct Raster {
        Point corner;  // upper left
        double size;
        std::int32_t side;               // squares in a row
        std::vector<std::uint8_t> code;  // rows from above: into the palette
        std::vector<Rgb8> palette;
    };
    std::string title;
    double width = 0, height = 0;
    std::vector<Swatch> swatches{};
    std::vector<Stroke> strokes{};
    std::vector<Dot> dots{};
    std::vector<Label> labels{};
    std::optional<Sphere> sphere{};
    std::optional<Raster> raster{};

    void say(const Point& at, Anchor anchor, std::string text, bool strong = false) {
        labels.push_back({at, anchor, strong, std::move(text)});
    }
};

// Low to high energy.
inline constexpr std::array<Rgb8, 6> ramp{{{38, 62, 126},
                                           {66, 124, 178},
                                           {150, 196, 206},
                                           {240, 228, 188},
                                           {232, 146, 84},
                                           {158, 40, 44}}};
inline constexpr int bands = 14;  // of equal energy: their borders are contours

// Unsafety 1 to 10, pale to dark: lightness alone tells the order.
inline constexpr std::array<Rgb8, 5> unsafety_ramp{
    {{253, 236, 178}, {252, 187, 92}, {240, 118, 56}, {201, 44, 44}, {112, 10, 50}}};

// What may move and has no unsafety: no scan shows what holds it. No hue of the ramp's.
inline constexpr Rgb8 unranked_colour{118, 132, 176};

// Share 0 to 1 of the way along colours.
Rgb8 colour_along(std::span<const Rgb8> colours, double share);
Rgb8 ramp_colour(double share);

// Where the map of the sphere has an up direction (x east, y north, z up): in units of its radius.
Point map_of(const Vec3& up);
// The direction at a place of the map within its rim.
Vec3 direction_at(const Point& place);

// The energies along the sphere of poses, the disconnectivity graph, the places on its support, and
// S(W): those of them that the object has.
std::vector<Drawing> landscape_drawings(const Scene& scene, const Object& object);

}  // namespace topple::report
