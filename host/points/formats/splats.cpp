// SPDX-License-Identifier: MIT
#include "points/formats/splats.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"

namespace topple::io {
namespace {

std::optional<std::size_t> index_of(const PlyElement& vertex, std::string_view name) {
    const auto at = std::ranges::find(vertex.properties, name, &PlyProperty::name);
    if (at == vertex.properties.end() || at->list_count) return std::nullopt;
    return static_cast<std::size_t>(at - vertex.properties.begin());
}

}  // namespace

std::optional<SplatFields> splat_fields(const std::filesystem::path& file,
                                        const PlyElement& vertex) {
    if (index_of(vertex, "packed_position") && !index_of(vertex, "x")) {
        fail(file,
             "holds Gaussian splats that are packed; save them as a PLY that is not compressed");
    }
    for (const char* name : {"scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"}) {
        if (!index_of(vertex, name)) return std::nullopt;
    }
    const auto opacity = index_of(vertex, "opacity"), red = index_of(vertex, "f_dc_0"),
               green = index_of(vertex, "f_dc_1"), blue = index_of(vertex, "f_dc_2");
    if (!opacity || !red || !green || !blue) return std::nullopt;
    return SplatFields{*opacity, {*red, *green, *blue}};
}

bool hides(double opacity_logit) {
    return opacity_logit > 0;
}

std::array<double, 3> splat_colour(const std::array<double, 3>& constant_term) {
    const double y00 = 0.5 / std::sqrt(3.14159265358979323846);
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double value = 0.5 + y00 * constant_term[c];
        if (!std::isfinite(value)) return {};
        out[c] = std::clamp(std::round(255 * value), 1.0, 255.0);
    }
    return out;
}

std::string splats_note(std::uint64_t taken, std::uint64_t all) {
    return std::string("The file holds Gaussian splats, no scan: the centres of the ") +
           counted(taken, "splat") + " of " + std::to_string(all) +
           " that are more than half opaque were taken as points. They lie near surfaces, not on "
           "them, and far apart where walls are plain; their unit is the metre only if the "
           "cameras' places were in metres. A mesh or cloud from the same images tells more.";
}

}  // namespace topple::io
