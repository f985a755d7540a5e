// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "topple/scene.h"

// Two scans of one room at two times: what came, went and moved in between, and what became less
// safe.
namespace topple {

// How the earlier result A and the later one B lie on each other.
struct Alignment {
    // Rigid, by rows: from B's frame, that of its points, to A's, metres.
    Mat4 a_from_b{};
    bool same_frame = false;  // both had the same coordinates, but for errors
    // Of all surfaces, those whose place the other scan saw; and of these, those that are surface
    // there, too. The rest was taken away, put there or is laid on wrongly.
    double seen = 0, agreeing = 0;
    // `agreeing` of the next best of all ways to turn and shift the room; 0: there is none.
    double next_agreeing = 0;
    double error_m = 0;  // how far the building's surfaces lie apart, root mean square
};

// What became of a thing.
enum class Became : std::uint8_t {
    same,    // it is where it was
    moved,   // what has its size, and its colours if any, is elsewhere, or it stands aside
    came,    // A saw its place to be free
    went,    // B saw its place to be free
    merged,  // its place is solid in the other scan, but as other things: told apart otherwise
    unseen,  // nobody knows: the other scan did not see its place
};

inline const char* to_string(Became became) {
    constexpr const char* names[] = {"same", "moved", "came", "went", "merged", "unseen"};
    return names[static_cast<std::size_t>(became)];
}

struct ComparedThing {
    Became became = Became::same;
    std::int32_t a = -1, b = -1;  // objects of A and of B; -1: there is none
    double moved_m = 0;           // of what moved: the way of its middle
    // Shares of its seen surface that the other scan shows to be free, and to be solid.
    double free = 0, solid = 0;
    // Of what is in both, alike and seen enough: another category, and a risk that differs by more
    // than two standard errors.
    bool less_safe = false, safer = false;
    bool stands_otherwise = false;  // nothing that holds it now held it before
};

struct Comparison {
    Alignment alignment;
    Scene a, b;
    // Of all that can move: by objects of A, then what only B has.
    std::vector<ComparedThing> things;
};

struct CompareOptions {
    // Polled now and then; true ends it with Error(cancelled).
    std::function<bool()> cancelled;
};

// Compares what write_outputs() has written of two scans of one room: A the earlier, B the later.
// Their frames may differ; the building, which both show, tells how. Throws Error(input) where a
// folder holds no whole output, where the rooms do not match, or where they do in several ways.
Comparison compare(const std::filesystem::path& a, const std::filesystem::path& b,
                   const CompareOptions& options = {});

}  // namespace topple
