// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "export/gripped_faces.h"
#include "topple/scene.h"

namespace topple::exports {

// How a front opens: it is drawn out, or turns about its edge at its lowest or highest u, or about
// its lower edge.
enum class Opening : std::uint8_t { slide, hinge_at_low_u, hinge_at_high_u, hinge_below };
inline const char* to_string(Opening opening) {
    return opening == Opening::slide ? "slide" : "hinge";
}

// A door or a drawer of closed furniture, which its handle tells. World frame: z up, metres.
struct Front {
    Opening opening = Opening::slide;
    double probability = 0;  // that it is there, and opens so
    Vec3 out{}, across{};    // unit and level, right-handed with up
    Vec3 middle{};           // of its outer face
    double wide_m = 0, high_m = 0;
    double deep_m = 0;  // so deep is the furniture behind it
    Vec3 grip{};        // the middle of the handle's box; its sides along across, out and up
    Vec3 grip_m{};
    Rgb8 colour{};
};

// Of each object, by id: those that are likelier than not.
std::vector<std::vector<Front>> fronts_of(const Scene& scene);

// How likely each column of grips, which lie over one another, belongs to drawers or to doors whose
// hinges are at their low or high edge, and where these fronts begin and end: fronts lie side by
// side in a face, drawers have their grips in the middle, and doors near the edge that opens.
struct ColumnFronts {
    double slide = 0, hinge_at_low_u = 0, hinge_at_high_u = 0;  // probabilities
    double low_u = 0, high_u = 0;                               // of the likeliest
    std::vector<Grip> grips;                                    // by z
};
std::vector<ColumnFronts> columns_of(const GrippedFace& face);

}  // namespace topple::exports
