// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/unseen.h"
#include "physics/bodies.h"
#include "physics/body_errors.h"
#include "physics/landscape.h"

// Position landscapes (paper, 3.1 Case II and Eq. 5): what it takes to push an object off its
// support.
namespace topple::physics {

// absorbed = mu m g * (shortest way on the support to where it stops holding the object)
// released = m g * (drop from the support to the next surface below)
// A way straight on to where the support ends: infinite where something stands in the way, or
// nobody knows what is below.
struct StraightSlide {
    double distance_m = std::numeric_limits<double>::infinity();
    double drop_m = 0;
};

struct SlideResult {
    double absorbed_J = 0, released_J = 0;
    double distance_m = 0, drop_m = 0;
    Vec3 direction{};          // of the way's first leg, horizontal, unit
    Ends edge{};               // of the support, where it slides off; ends, grid frame
    std::int32_t onto = -1;    // primitive below, -1 for other solid
    bool found = false;        // false: nothing holds it from below, or no way leads to an edge
    Landscape::Places places;  // the position landscape around it, if asked for
    std::vector<StraightSlide> straight;  // along each of the ways asked for
};

using Polygon = std::vector<std::array<double, 2>>;  // convex, counter-clockwise, metres

// What is known of how an object stood: its polygon is ground, too, where the columns would have it
// fall where it is, or, if part of what holds it was not seen, anyway. An empty polygon: nothing.
struct KnownFooting {
    Polygon polygon;
    double height_m = 0;  // of the support, where the object's columns rest on nothing
    bool unseen = false;
};

// Ways longer than this are no longer one push, metres. Set by hand.
inline constexpr double longest_slide_m = 3;

struct SlideOptions {
    bool places = false;                         // whether to look at all places around the object
    std::span<const KnownFooting> stances = {};  // by object; empty: none of any
    std::span<const std::array<double, 2>> ways = {};  // unit, horizontal: to look straight along
    ThreadPool* threads = nullptr;  // to share the objects out among; none: one by one
    Unseen unseen{};                // of the voxels
};

// For every object, on the voxel columns of its support. The support is the level that most of the
// object's columns rest on, of those at its stance's height where that is known; it holds the
// object while the centre of mass stands over it, or inside
// the hull of the columns that still bear (a hole narrower than the foot is no edge). Solids at the
// object's own height block its outline; what already reaches into its outline moves with it. An
// edge counts where a surface at least two voxels lower is known beneath it: where the scan ends,
// or the support may go on unseen, nobody knows. Ways are any-angle (lazy Theta*), so they are
// straight where nothing blocks them.
//   cells               sorted by (i, j, k)
//   object_of_primitive -1 for none
//   objects             mass and centre of each object; those without voxels find nothing
//   friction            coefficient of each object
// Throws Error(usage) where the sizes differ or an object is out of range.
std::vector<SlideResult> slide_all(const SolidCells& cells,
                                   std::span<const std::int32_t> object_of_primitive,
                                   std::span<const MassProperties> objects,
                                   std::span<const double> friction,
                                   const SlideOptions& options = {});

// The position landscapes of some of the objects, up to reach_m around each. As slide_all().
std::vector<Landscape::Places> places_of(const SolidCells& cells,
                                         std::span<const std::int32_t> object_of_primitive,
                                         std::span<const MassProperties> objects,
                                         std::span<const std::size_t> chosen,
                                         std::span<const double> friction, double reach_m,
                                         const Unseen& unseen = {});

// What sliding would be if the object stood at another of its places, column a and row b of them:
// the nearest place among them that falls, in a straight line. It may fall as soon as it has left
// the place before, so ways are a step shorter than to there. `reachable` is false where it can't
// be slid to.
struct SlideElsewhere {
    bool reachable = false;
    SlideResult slide;  // its straight ways are those asked for
};
SlideElsewhere slide_elsewhere(const Landscape::Places& places, std::int32_t a, std::int32_t b,
                               double mass_kg, double friction,
                               std::span<const std::array<double, 2>> ways = {});

// Tipping and sliding taken together.
struct Instability {
    enum class Mode : std::uint8_t { none, tip, slide };
    double barrier_J = 0, release_J = 0;  // of the mode
    Mode mode = Mode::none;
    Vec3 direction{};                    // zero for none
    std::vector<InstabilityStep> curve;  // S(W) of Eq. 6: ascending in W and in S
    // How it takes that barrier; for none the easiest way, which releases nothing.
    Vec3 weakest{};            // horizontal, unit; zero where no way is easier than others
    std::optional<Ends> edge;  // that it turns over, or slides off; grid frame
    double drop_m = 0;         // from where its support ends
    // The primitive that it meets there, -1 for other solid. For tipping the caller's to find out.
    std::int32_t onto = -1;
};
const char* to_string(Instability::Mode mode);

// The curve is the larger of both at every W. The mode is the one with the least barrier, tipping
// where equal, if either has something to release, and tipping from a barrier of 0 only if it does;
// without any, the barrier is that of tipping.
Instability combine_curves(const Stability& tip, const SlideResult& slide);

// Of tipping over an edge that is margin_m from the centre of mass: M g (sqrt(h^2 + m^2) - h).
double tipping_barrier_J(const Candidate& body, double margin_m);

// One standard error of that barrier, from those of the margin (how far inside of its support's
// border the centre of mass is), of its height and of the mass, to first order, as independent
// ones:
//     tipping over an edge at m > 0 from the centre of mass, h above it, of
//         M g (sqrt(h^2 + m^2) - h); but where m is small, of what is to be expected of it at 0;
//         without an edge, M g margin_error_m;
//     sliding by a way l: coefficient M g margin_error_m, and M g l times the coefficient's error.
double barrier_error_J(const Candidate& body, const BodyError& known, const Stability& tip,
                       const Instability& how, double margin_error_m, const Friction& friction);

}  // namespace topple::physics
