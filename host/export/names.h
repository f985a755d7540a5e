// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "export/body.h"

namespace topple::exports {

// What a body is called in every format; place: in the scene's list of bodies.
inline std::string body_name(const Body& body, std::size_t place) {
    return body.object >= 0 ? "object_" + std::to_string(body.object)
                            : "pad_" + std::to_string(place);
}

inline std::string part_name(const std::string& body, std::size_t part) {
    return body + "_part_" + std::to_string(part);
}

}  // namespace topple::exports
