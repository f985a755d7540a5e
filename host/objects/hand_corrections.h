// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/object_of.h"
#include "graph/known_links.h"
#include "graph/stable_objects.h"
#include "objects/located_corrections.h"
#include "objects/object_masses.h"
#include "solids/solid_parts.h"
#include "solids/taken_away.h"
#include "topple/corrections.h"

namespace topple {

// Corrections by hand on their way through the stages: what is one object and what is none binds
// the grouping; what is fixed, not there, hollow, weighed or named is said of the objects that it
// has found, all of each. Of the room only the parts at the spots are meant.
class HandCorrections {
  public:
    // Throws Error(input) where two of them contradict each other.
    HandCorrections(std::span<const Correction> corrections, const SolidParts& parts);

    bool none() const { return applied_.empty(); }
    const graph::KnownLinks& links() const { return links_; }
    // Of two that are apart one at most is the room's: what is less surely so is a thing, and never
    // a floor for what is none.
    void keep_apart(const SolidScene& solids, graph::ShellOdds& shell);

    // What one_thing did besides, by the groups without it: whether what it joins counts as the
    // building now, and how many parts of the objects that it joins stayed behind.
    void look_at_joined(TableView<PrimitiveId, std::int32_t> before,
                        TableView<PrimitiveId, std::int32_t> now);
    // To be called after the grouping, in this order. Returns what becomes of the solids where
    // things are taken away, which is done in `parts`, too. Throws Error(input) where nothing is
    // left.
    std::optional<TakenAway> take_from(SolidParts& parts, graph::Grouping& grouping,
                                       graph::ShellOdds& shell, std::vector<graph::Joint>& joints);
    // Also gives parts that are of the room, or no longer so, their role.
    void fix(SolidParts& parts, graph::Grouping& grouping, graph::ShellOdds& shell);
    // Primitives that are said to be fixed to the room.
    std::vector<std::int32_t> fixed() const;
    // grounded: the room, which has no mass, -1: none.
    Table<ObjectId, KnownMass> masses(ObjectOf object_of, std::size_t objects,
                                      std::int32_t grounded);

    // What became of them all, and of whom they speak.
    struct Told {
        std::vector<AppliedCorrection> corrections;
        Table<ObjectId, std::string> name;
        Table<ObjectId, std::vector<std::int32_t>> corrected;  // numbers
        std::map<std::int32_t, std::string> name_of_part;      // by primitive of the room
    };
    Told tell(ObjectOf object_of, std::size_t objects, std::int32_t grounded);

  private:
    using Kind = Correction::Kind;
    void find_links();
    void find_contradictions() const;
    // "correction 3", by the sentence that it is of, and the same with its kind.
    std::string numbered(std::size_t n) const;
    std::string with_kind(std::size_t n) const;
    // held: whether it holds all the same.
    void remark(std::size_t n, const std::string& what, bool held);
    void renumber(TableView<PrimitiveId, std::int32_t> number);
    // The correction that keeps a part of the group apart from the room.
    std::optional<std::size_t> keeper_from_room(const graph::Grouping& grouping,
                                                std::int32_t group) const;

    std::vector<LocatedCorrection> located_;
    std::vector<AppliedCorrection> applied_;
    std::int32_t primitives_;
    graph::KnownLinks links_;
    std::vector<std::size_t> together_by_, apart_by_;  // of each link, the correction that it is of
    std::vector<std::int32_t> things_;  // primitives that are not the room's, whatever it seemed
};

}  // namespace topple
