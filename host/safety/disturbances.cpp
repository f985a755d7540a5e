// SPDX-License-Identifier: MIT
#include "safety/disturbances.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/listed.h"
#include "safety/earthquake/earthquake_field.h"
#include "safety/human/human_field.h"
#include "safety/reach/reach_field.h"
#include "safety/wind/wind_field.h"
#include "topple/error.h"

namespace topple::safety {
std::span<const DisturbanceKind* const> disturbance_kinds() {
    static const std::array kinds{&human_kind(), &wind_kind(), &earthquake_kind(), &reach_kind()};
    return kinds;
}

const DisturbanceKind* find_disturbance_kind(std::string_view name) {
    for (const DisturbanceKind* kind : disturbance_kinds())
        if (name == kind->name) return kind;
    return nullptr;
}

const DisturbanceKind& disturbance_kind(std::string_view name) {
    if (const DisturbanceKind* kind = find_disturbance_kind(name)) return *kind;
    std::vector<std::string> known;
    for (const DisturbanceKind* kind : disturbance_kinds()) known.emplace_back(kind->name);
    std::string message =
        "disturbances (--disturbance) " + std::string(name) + ": expected " + listed(known);
    for (const DisturbanceKind* kind : disturbance_kinds()) {
        const auto& words = kind->words;
        const bool meant = std::ranges::any_of(
            std::array<std::string_view, 3>{words.cause, words.event, words.column},
            [&](std::string_view word) { return !name.empty() && word.starts_with(name); });
        if (meant) message.append("; for ").append(name).append(" say ").append(kind->name);
    }
    throw Error(ErrorKind::usage, message);
}

std::vector<const DisturbanceKind*> acting_kinds(const ParseOptions& options) {
    std::vector<const DisturbanceKind*> out;
    for (const std::string& name : options.disturbances) {
        const DisturbanceKind& kind = disturbance_kind(name);
        if (!kind.acts || kind.acts(options)) out.push_back(&kind);
    }
    return out;
}

}  // namespace topple::safety

namespace topple {

std::vector<std::string> known_disturbances() {
    std::vector<std::string> names;
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds())
        names.emplace_back(kind->name);
    return names;
}

}  // namespace topple
