// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "topple/input.h"

// What somebody who knows the room says of it, beside what the scan shows. Parts are named by
// spots, points in the frame of the results (Scene) on or near their surfaces: so corrections hold
// for another seed, another voxel size and another scan of the same room, too.
namespace topple {

struct Correction {
    enum class Kind : std::uint8_t {
        one_thing,
        apart,
        fixed,
        not_there,
        hollow,
        mass,
        name,
        friction
    };

    Kind kind = Kind::name;
    std::vector<Vec3> at_m;    // one spot at least; of one_thing two
    std::vector<Vec3> from_m;  // of apart: spots on what the parts at at_m are not one with
    double wall_m = 0;         // of hollow: thickness of the shell
    double mass_kg = 0;        // of mass: of all of the object
    std::string name;          // of name
    std::string was{};         // what is to be kept of it for people, as its number before; or ""
    double coefficient = 0;    // of friction: of all of the object, on what it stands on
};

// "one_thing", "apart", ..: as files call them.
const char* to_string(Correction::Kind kind);

// A file of corrections (docs/corrections.md). Throws Error(input) that names the file, the number
// of the correction, from 1 on, and what is wrong with it.
std::vector<Correction> read_corrections(const std::filesystem::path& file);
// The same of the file's text; `source` stands for its name in messages.
std::vector<Correction> corrections_of(std::string_view text,
                                       const std::string& source = "corrections");

// What is wrong with the first correction that can't be followed whatever the scan shows, with its
// number; none: they may all be.
std::optional<std::string> fault_of(const std::vector<Correction>& corrections);

// A correction, and what became of it.
struct AppliedCorrection {
    Correction correction;
    bool held = false;
    std::string outcome;                // "held", or what kept it from that, in words
    std::vector<std::int32_t> objects;  // that it is about, ascending; none of what is taken away
};

}  // namespace topple
