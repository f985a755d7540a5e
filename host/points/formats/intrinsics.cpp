// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <utility>

#include "core/json.h"
#include "io/json_text.h"
#include "io/text.h"
#include "points/formats/colour_frames.h"
#include "points/formats/frame_sequence.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

// Sensors of depth have up to a few million pixels, cameras of colour up to a hundred million.
constexpr std::uint32_t most_pixels_a_side = 32768;
constexpr std::uint64_t most_depth_pixels = std::uint64_t{1} << 24;

std::string no_side(const char* key, const std::string& value) {
    return in_quotes(key) + " is " + value + ", but must be a whole number from 1 to " +
           std::to_string(most_pixels_a_side);
}

double number(const fs::path& file, const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) fail(file, "has no " + in_quotes(key));
    if (!found->is_number())
        fail(file, in_quotes(key) + " must be a number, not " + found->type_name());
    return found->get<double>();
}

std::uint32_t side(const fs::path& file, const Json& json, const char* key) {
    const double value = number(file, json, key);
    if (!(value >= 1 && value <= most_pixels_a_side && value == std::floor(value)))
        fail(file, no_side(key, short_number(value)));
    return static_cast<std::uint32_t>(value);
}

Json read_object(const FileName& name) {
    const fs::path& file = name.path();
    const auto bytes = read_file(name, 1 << 20);
    Json json = parse_json(file, bytes.text());
    if (!json.is_object()) {
        fail(file, std::string("must hold a JSON object, not ") + json.type_name());
    }
    return json;
}

// All but depth_scale.
Intrinsics pinhole(const fs::path& file, const Json& json) {
    Intrinsics intrinsics;
    intrinsics.width = side(file, json, "width");
    intrinsics.height = side(file, json, "height");
    intrinsics.fx = number(file, json, "fx");
    intrinsics.fy = number(file, json, "fy");
    intrinsics.cx = number(file, json, "cx");
    intrinsics.cy = number(file, json, "cy");
    if (const auto fault = pinhole_fault(intrinsics)) fail(file, *fault);
    return intrinsics;
}

}  // namespace

std::optional<std::string> pinhole_fault(const Intrinsics& k) {
    for (const auto& [key, value] : {std::pair("width", k.width), {"height", k.height}}) {
        if (value < 1 || value > most_pixels_a_side) return no_side(key, std::to_string(value));
    }
    for (const auto& [key, value] :
         {std::pair("fx", k.fx), {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy}}) {
        const bool may_be_zero = key[0] == 'c';
        if (!std::isfinite(value) || value < 0 || (value == 0 && !may_be_zero))
            return in_quotes(key) + " is " + short_number(value) + ", but must be " +
                   (may_be_zero ? "0 or more" : "above 0");
    }
    if (k.cx > k.width || k.cy > k.height)
        return "the principal point (" + short_number(k.cx) + ", " + short_number(k.cy) +
               ") lies outside of the image of " + size_text(k.width, k.height) + " pixels";
    return std::nullopt;
}

std::optional<std::string> depth_intrinsics_fault(const Intrinsics& k) {
    if (auto fault = pinhole_fault(k)) return fault;
    if (std::uint64_t{k.width} * k.height > most_depth_pixels)
        return "says " + size_text(k.width, k.height) + " pixels, more than the " +
               std::to_string(most_depth_pixels) +
               " that a depth image may have; scale the images down";
    // At these ends 16 bits reach 65 km and 6.5 cm: beyond them the unit is wrong.
    if (!(k.depth_scale >= 1 && k.depth_scale <= 1e6))
        return "\"depth_scale\" is " + short_number(k.depth_scale) +
               ", but must be from 1 (depth in metres) to 1e+06 (micrometres)";
    return std::nullopt;
}

Intrinsics depth_intrinsics(const fs::path& file, const Json& json) {
    Intrinsics intrinsics = pinhole(file, json);
    if (!json.contains("depth_scale")) {
        fail(file,
             "has no \"depth_scale\"; add it: metres = value / depth_scale, so 1000 for "
             "depth in millimetres");
    }
    intrinsics.depth_scale = number(file, json, "depth_scale");
    if (const auto fault = depth_intrinsics_fault(intrinsics)) fail(file, *fault);
    return intrinsics;
}

Intrinsics read_intrinsics(const FileName& name) {
    return depth_intrinsics(name.path(), read_object(name));
}

std::optional<Intrinsics> read_colour_intrinsics(const fs::path& folder) {
    const FileName name = FileName::in(folder, "intrinsics.json"),
                   own = FileName::in(folder, "color/intrinsics.json");
    const fs::path& file = name.path();
    const Json json = read_object(name);
    const auto inner = json.find("color_intrinsics");
    if (own.is_there()) {
        if (inner != json.end()) {
            fail(own.path(),
                 "is there, and intrinsics.json has \"color_intrinsics\", too; keep the one "
                 "that is meant");
        }
        return pinhole(own.path(), read_object(own));
    }
    if (inner == json.end()) return std::nullopt;
    if (!inner->is_object()) {
        fail(file, std::string("\"color_intrinsics\" must be an object with width, height, fx, fy, "
                               "cx and cy, not ") +
                       inner->type_name());
    }
    return pinhole(file, *inner);
}

}  // namespace topple::io
