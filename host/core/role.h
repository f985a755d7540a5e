// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace topple {

// What a primitive is to the room: a part of its shell, which stays where it is, or none.
// A fixture is built in: a counter, a wall cabinet, a radiator.
enum class Role : std::uint8_t { none, floor, wall, ceiling, fixture };

constexpr bool in_shell(Role role) {
    return role != Role::none;
}

// Walls and ceilings are sheets as far as a scan tells: what lies behind one is not known to be its
// inside. Under a floor nothing is looked for at all.
constexpr bool is_sheet(Role role) {
    return role == Role::wall || role == Role::ceiling;
}

// Of a primitive by its number; none where the span ends.
constexpr Role role_of(std::span<const Role> roles, std::int32_t primitive) {
    const auto p = static_cast<std::size_t>(primitive);
    return primitive < 0 || p >= roles.size() ? Role::none : roles[p];
}

// By primitive, whether it is of the shell.
inline std::vector<bool> shell_of(std::span<const Role> roles) {
    std::vector<bool> out;
    for (const Role role : roles) out.push_back(in_shell(role));
    return out;
}

}  // namespace topple
