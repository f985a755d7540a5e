// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "safety/fields.h"
#include "topple/parse.h"

// What may disturb the objects. Each kind has a folder of its own, with its options, its field and
// what is said of it; disturbances.cpp lists them. To add one takes a folder and a line there.
namespace topple::safety {

// What people are told of a kind, in words that follow on others.
struct DisturbanceWords {
    const char* cause;      // "people walking by"
    const char* event;      // "walk", of which there may be several
    const char* one_event;  // "one person walking through the room"
    const char* column;     // its short name above a column of risks
    const char* doing;      // what goes on while its field is made
    const char* mend;       // for what it endangers most and nobody carries away
    const char* push;       // what a fixing must hold it against

    // How its arrows are drawn.
    struct Arrows {
        enum class Strength { visits, mean, speed };
        Strength strength;  // visits: how often; mean: speed times how often; speed
        bool at_tip;        // they point onto their place, and do not begin there
        bool below_things;  // which would hide them: they are drawn through these
        const char *title, *says, *legend;
        double scale;  // of the strongest arrow's strength, in the unit
        const char* unit;
    } arrows;

    // One of the figures that it is reckoned with: its key among scene.json's events, how it
    // follows on one_event ("" if it does not), its name and unit.
    struct Figure {
        const char *key, *follows, *name, *unit;
    } figure;

    const char* free_mend = "Take it out, or bolt it to the floor";    // no wall is near: the same;
    const char* light_mend = "Put it elsewhere, or fasten it";         // for what is carried away,
    const char* large_mend = "Put it elsewhere, or fasten it";         // and fits on no shelf,
    const char* high_mend = "Put it lower, or farther from the edge";  // and falls from a height
};

struct DisturbanceKind {
    const char* name;
    DisturbanceWords words;
    Disturbance (*field)(device::Device& device, const Surroundings& surroundings,
                         std::span<const RiskObject> objects, const ParseOptions& options);
    // What it reckons with, by names.
    std::map<std::string, double> (*events)(const ParseOptions& options);
    // What to ask where an option is in its range but was meant otherwise, perhaps; "": nothing.
    std::string (*doubt)(const ParseOptions& options) = nullptr;
    // Whether it is in this run, if it was asked for; null: always.
    bool (*acts)(const ParseOptions& options) = nullptr;
    bool everyday = false;  // such events have happened before the scan
    // What to note where this is left out and the scan has no ceiling.
    const char* left_out_below_none = nullptr;
};

// In the order in which they are reckoned and shown.
std::span<const DisturbanceKind* const> disturbance_kinds();
// Null: none has that name.
const DisturbanceKind* find_disturbance_kind(std::string_view name);
// Throws Error(usage) that names those that there are.
const DisturbanceKind& disturbance_kind(std::string_view name);
// Of the options' disturbances those that act, in their order.
std::vector<const DisturbanceKind*> acting_kinds(const ParseOptions& options);

}  // namespace topple::safety
