// SPDX-License-Identifier: MIT
#include "safety/people.h"

#include <array>
#include <string>

#include "core/listed.h"
#include "topple/error.h"
#include "topple/parse.h"

namespace topple::safety {
namespace {

// Who rolls moves as one body, at one speed, and what it strikes meets most of its mass. An
// occupied chair is 0.7 m wide and 1.2 m long at most (ISO 7176-5, recommended limits), and as
// high as its user's head; the shares of mass are set by hand.
constexpr std::array<BodyPart, 5> chair_parts{{
    // name             low    high   reach  back   front  speed  mass   share
    {"footrest", 0.030, 0.150, 0.170, -0.25, 0.45, 1.0, 1.000, 1.00},
    {"wheels", 0.000, 0.450, 0.260, 0.40, 0.25, 1.0, 1.000, 1.00},
    {"knees", 0.300, 0.500, 0.170, -0.10, 0.35, 1.0, 0.800, 1.00},
    {"trunk", 0.450, 0.950, 0.170, 0.25, 0.10, 1.0, 0.400, 1.00},
    {"reaching hand", 0.300, 0.900, 0.370, 0.00, 0.35, 1.3, 0.022, 0.05},
}};

// Of published figures:
//   [A] ASTM F2057-23 and 16 CFR 1261 (2022), furniture that tips over: a child of 60 lb, up to 6
//       years; children of 2 to 5 pull with 17.2 lbf (77 N).
//   [B] Bohannon & Williams Andrews 2011, Physiotherapy 97:182: 0.97 and 0.94 m/s from 80 years on.
//   [C] 2000 CDC growth charts (Vital Health Stat 11(246)): medians at 2 years 0.86 m and 12.5 kg,
//       at 6 years 1.15 m; 27 kg is then about the 95th percentile.
//   [D] Drillis & Contini 1966 (body_parts.h), fractions of height: hanging fingertips 0.377,
//       shoulder 0.818, arm 0.44; the grip of a raised arm 1.18.
//   [F] Fryar and others 2021 (NHANES 2015-2018): from 80 years on about 1.65 m and 73 kg.
//   [G] Hausdorff and others 1999, J Appl Physiol 86:1040: 1.20 m/s at 6 and 7 years.
//   [H] Adolph and others 2012, Psychol Sci 23:1387: those of 12 to 19 months fall 17 times an
//   hour. [S] Sutherland and others 1980, J Bone Joint Surg 62-A:336: 0.72 m/s at 2 years. [T]
//   Tolerico and others 2007, J Rehabil Res Dev 44:561: 0.79 m/s in manual wheelchairs. [W] de
//   Winter and others 1994 (doi 10.1080/09298349408945742): children's pushes and tugs go
//       with their weight. Toddlers' are those of [A] times theirs over that of 2 to 5, 16 kg [C].
// Set by hand: how hard elderly people hold on to a thing; the mass of a wheelchair and its user;
// how often others than toddlers fall.
constexpr std::array<PersonKind, 5> person_table{{
    {"adults", 1.80, 70, 1.3, 0.20, 0.05, body_parts, 0, 0, 0, 0, 0, false, 0, 1.47},
    // [C, A, G]; [D, A]
    {"children", 1.15, 27, 1.2, 0.13, 0.05, body_parts, 0, 1.36, 0.51, 77, 77, true, 0.1, 0.94},
    // [C, S]; [D, W]; [H]
    {"toddlers", 0.86, 12.5, 0.72, 0.10, 0.05, body_parts, 0, 1.01, 0.38, 60, 60, true, 1, 0.70},
    // [F, B]; [D]
    {"elderly", 1.65, 73, 0.95, 0.18, 0.05, body_parts, 0.62, 1.35, 0.73, 100, 100, false, 0.1,
     1.35},
    // [T]; a step of 2 cm stops it
    {"wheelchair", 1.35, 90, 0.79, 0.35, 0.02, chair_parts, 0, 0, 0, 0, 0, false, 0, 1.10},
}};

// As if one of that height had moved so.
std::shared_ptr<const BodyMotion> scaled(const BodyMotion& motion, double height_m) {
    const double stature = motion.stature_m();
    auto out = std::make_shared<BodyMotion>(motion);
    if (!(stature > 0)) return out;
    for (auto& track : out->track)
        for (Vec3& place : track)
            for (double& x : place) x *= height_m / stature;
    return out;
}

}  // namespace

std::span<const PersonKind> person_kinds() {
    return person_table;
}

const PersonKind& person_kind(std::string_view name) {
    std::vector<std::string> known;
    for (const PersonKind& kind : person_table) {
        if (name == kind.name) return kind;
        known.emplace_back(kind.name);
    }
    throw Error(ErrorKind::usage,
                "people (--people) " + std::string(name) + ": expected " + listed(known));
}

HumanOptions walker(const PersonKind& kind) {
    HumanOptions out;
    out.body_height_m = kind.height_m;
    out.body_mass_kg = kind.mass_kg;
    out.walking_speed_m_s = kind.walking_speed_m_s;
    out.body_radius_m = kind.body_radius_m;
    out.step_height_m = kind.step_height_m;
    out.parts = kind.parts;
    return out;
}

HumanOptions walker(const PersonKind& kind, const ParseOptions& options) {
    HumanOptions out = walker(kind);
    out.seed = options.seed;
    out.paths = options.walks;
    const bool adults = &kind == person_table.data(),
               walks = kind.parts.data() == body_parts.data();
    for (const auto& motion : options.motions)
        if (walks) out.motions.push_back(adults ? motion : scaled(*motion, kind.height_m));
    return out;
}

}  // namespace topple::safety

namespace topple {

std::vector<std::string> known_people() {
    std::vector<std::string> names;
    for (const safety::PersonKind& kind : safety::person_kinds()) names.emplace_back(kind.name);
    return names;
}

}  // namespace topple
