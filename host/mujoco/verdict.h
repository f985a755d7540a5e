// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mujoco/settled.h"
#include "topple/export.h"
#include "topple/scene.h"

namespace topple::mujoco {

// What topple says of an object that nobody touches: it is stable, since leaving its place takes
// energy, or frees none; it falls, since its barrier is 0; or its barrier can't be told from 0, or
// what carries it was not seen.
enum class Says { stable, unsure, falls };
const char* to_string(Says says);
Says says_of(const Object& object);

// An object that is no part of the ground.
struct ObjectVerdict {
    std::int32_t object = -1;
    Says says = Says::stable;
    double barrier_J = 0, barrier_error_J = 0;
    bool on_pad = false, held = false;  // see ExportedBody
    std::optional<Motion> motion;       // none: it was not free in the export, or has no parts
    bool stays() const { return motion && motion->stays(); }
    // Whether MuJoCo finds the same; none: topple is unsure, or it did not move freely.
    std::optional<bool> agrees() const;
};

struct Verdict {
    Settled run;  // without its motions
    double asked_s = 0;
    std::vector<ObjectVerdict> objects;  // by id
    struct Count {
        std::uint64_t free = 0, stay = 0;
    };
    // Of what topple says so of, or of all.
    Count count(std::optional<Says> says = {}) const;
};

// scene, exported, run: of the same export.
Verdict judge(const Scene& scene, const ExportSummary& exported, Settled run, double asked_s);

// Throws Error(input) where the simulation became unstable. output: what it was of.
void check_stable(const Verdict& verdict, const std::string& output);

// verify.json, schema "topple.verify/1".
std::string verdict_json(const Verdict& verdict);

// For people: a line on the run, a table by what topple says, and a row for each object that moved.
std::string verdict_text(const Verdict& verdict);

}  // namespace topple::mujoco
