// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

// What the library's messages call options: Error::what(), Scene::notes and ParseOptions::notice.
// They name them as C++ does, "ParseOptions::voxel_m -1: expected ..", and
// what is given of one as "ParseOptions::unit_m = 0.001". Programs and bindings whose users know
// them by other names put those in their place, where messages leave them.
namespace topple {

// Whose options have names of their own.
enum class Interface : std::uint8_t { command_line, c, python };

// An option, or one that is given a value; null where an interface has none, and says it as C++.
struct OptionName {
    const char* member;        // "ParseOptions::voxel_m"; an argument: "open_device(): threads"
    const char* command_line;  // "--voxel"
    const char* c;             // field or argument: "voxel_m"
    const char* python;        // keyword: "voxel_m"
};
std::span<const OptionName> option_names();

// The message with the interface's names of options; for Python also with what NumPy makes of poses
// beside the words for it. Other text stays as it is.
std::string in_words_of(Interface interface, std::string_view message);

}  // namespace topple
