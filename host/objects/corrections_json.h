// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/json.h"
#include "topple/corrections.h"

// Corrections in scene.json: as a file says them, and what became of them.
namespace topple::io {

// What "do" says of each kind.
inline constexpr std::array correction_kinds{std::pair{Correction::Kind::one_thing, "one_thing"},
                                             std::pair{Correction::Kind::apart, "apart"},
                                             std::pair{Correction::Kind::fixed, "fixed"},
                                             std::pair{Correction::Kind::not_there, "not_there"},
                                             std::pair{Correction::Kind::hollow, "hollow"},
                                             std::pair{Correction::Kind::mass, "mass"},
                                             std::pair{Correction::Kind::name, "name"},
                                             std::pair{Correction::Kind::friction, "friction"}};
std::optional<Correction::Kind> correction_kind(std::string_view name);
// "one_thing, apart, ..."
std::string known_corrections();

OrderedJson json_of_correction(const AppliedCorrection& applied);
// Throws nlohmann's exceptions for what is none.
AppliedCorrection correction_of(const OrderedJson& json);

}  // namespace topple::io
