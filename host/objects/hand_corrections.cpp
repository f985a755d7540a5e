// SPDX-License-Identifier: MIT
#include "objects/hand_corrections.h"

#include <algorithm>
#include <array>
#include <memory>
#include <queue>
#include <set>

#include "core/union_find.h"
#include "fitted/boosted_trees.h"
#include "objects/told_sentences.h"

namespace topple {
namespace {

// The log-odds of what somebody has said: no more than any model knows.
const double surely_log_odds = fitted::log_odds(0.999);

// The links that lead from one primitive to another, by the corrections that they are of.
std::set<std::size_t> way_between(const graph::KnownLinks& links,
                                  const std::vector<std::size_t>& by, std::int32_t from,
                                  std::int32_t to) {
    std::map<std::int32_t, std::pair<std::int32_t, std::size_t>> came;  // from where, by which link
    std::queue<std::int32_t> open;
    open.push(from);
    came[from] = {from, 0};
    while (!open.empty() && !came.contains(to)) {
        const std::int32_t at = open.front();
        open.pop();
        for (std::size_t n = 0; n < links.together.size(); ++n) {
            const auto& [a, b] = links.together[n];
            if (a != at && b != at) continue;
            const std::int32_t next = a == at ? b : a;
            if (came.try_emplace(next, at, by[n]).second) open.push(next);
        }
    }
    std::set<std::size_t> out;
    for (std::int32_t at = to; at != from; at = came.at(at).first) out.insert(came.at(at).second);
    return out;
}

}  // namespace

HandCorrections::HandCorrections(std::span<const Correction> corrections, const SolidParts& parts)
    : primitives_(static_cast<std::int32_t>(parts.model.size())) {
    if (corrections.empty()) return;
    located_ = locate(corrections, *parts.solids, parts.frame);
    for (std::size_t n = 0; n < corrections.size(); ++n) {
        applied_.push_back({corrections[n], true, "", {}});
        const bool apart = corrections[n].kind == Kind::apart;
        const bool lost = located_[n].at.empty() || (apart && located_[n].from.empty()) ||
                          (corrections[n].kind == Kind::one_thing && located_[n].at.size() < 2);
        if (!located_[n].missed.empty()) remark(n, located_[n].missed, !lost);
    }
    find_links();
    find_contradictions();
}

std::string HandCorrections::numbered(std::size_t n) const {
    return "correction " + std::to_string(told_sentences(applied_)[n]);
}

std::string HandCorrections::with_kind(std::size_t n) const {
    return numbered(n) + " (" + to_string(applied_[n].correction.kind) + ")";
}

void HandCorrections::remark(std::size_t n, const std::string& what, bool held) {
    AppliedCorrection& to = applied_[n];
    to.held = to.held && held;
    // One reason that holds for several parts is said once.
    if (std::string("; ")
            .append(to.outcome)
            .append("; ")
            .find(std::string("; ").append(what).append("; ")) != std::string::npos)
        return;
    to.outcome.append(to.outcome.empty() ? "" : "; ").append(what);
}

void HandCorrections::find_links() {
    for (std::size_t n = 0; n < applied_.size(); ++n) {
        const LocatedCorrection& l = located_[n];
        if (applied_[n].correction.kind == Kind::one_thing) {
            for (std::size_t i = 1; i < l.at.size(); ++i) {
                links_.together.emplace_back(l.at[0], l.at[i]);
                together_by_.push_back(n);
            }
        }
        for (const std::int32_t a : l.at) {
            for (const std::int32_t b : l.from) {
                if (a == b) {
                    remark(n,
                           "at_m and from_m lie in one part, " + std::to_string(a) +
                               ", which can't be cut",
                           false);
                    continue;
                }
                links_.apart.emplace_back(a, b);
                apart_by_.push_back(n);
            }
        }
    }
}

void HandCorrections::find_contradictions() const {
    UnionFind one(static_cast<std::size_t>(primitives_));
    for (const auto& [a, b] : links_.together)
        one.join(PrimitiveId(a).place(), PrimitiveId(b).place());
    for (std::size_t n = 0; n < links_.apart.size(); ++n) {
        const auto& [a, b] = links_.apart[n];
        if (one.root(PrimitiveId(a).place()) != one.root(PrimitiveId(b).place())) continue;
        std::string others;
        for (const std::size_t m : way_between(links_, together_by_, a, b))
            others.append(others.empty() ? "" : " and ").append(with_kind(m));
        throw Error(ErrorKind::input, "corrections: " + with_kind(apart_by_[n]) + " contradicts " +
                                          others + ": parts " + std::to_string(a) + " and " +
                                          std::to_string(b) +
                                          " are to be one object and not; leave one of them out");
    }
}

void HandCorrections::keep_apart(const SolidScene& solids, graph::ShellOdds& shell) {
    const graph::LinkedNodes nodes(primitives_, links_);
    // How surely a node is the room's, by what of it is taken for that, and a floor more than all
    // else; none: nothing is.
    using Sure = std::pair<bool, double>;
    const auto room = [&](std::int32_t node) {
        std::optional<Sure> most;
        for (const std::int32_t p : nodes.members(node)) {
            if (!shell.pinned[p]) continue;
            const Sure own{solids.role(p) == Role::floor, shell.log_odds[p]};
            most = std::max(most.value_or(own), own);
        }
        return most;
    };
    for (const auto& [a, b] : links_.apart) {
        const auto by_a = room(nodes.node_of(a)), by_b = room(nodes.node_of(b));
        if (!by_a && !by_b) continue;
        const bool first = !by_a || (by_b && *by_a <= *by_b);
        for (const std::int32_t p : nodes.members(nodes.node_of(first ? a : b))) {
            shell.pinned[p] = false;
            shell.log_odds[p] = std::min(shell.log_odds[p], -surely_log_odds);
            things_.push_back(p);
        }
    }
}

void HandCorrections::look_at_joined(TableView<PrimitiveId, std::int32_t> before,
                                     TableView<PrimitiveId, std::int32_t> now) {
    const auto of_building = [&](std::int32_t p) { return before[p] < 0; };
    for (std::size_t n = 0; n < applied_.size(); ++n) {
        const std::vector<std::int32_t>& at = located_[n].at;
        if (applied_[n].correction.kind != Kind::one_thing || at.size() < 2) continue;
        if (std::ranges::all_of(at, of_building)) continue;
        if (now[at.front()] < 0) {
            const auto spots = std::ranges::count_if(at, of_building);
            remark(n,
                   "what it joins counts as the building now, and is not judged" +
                       (spots > 0 ? ": " + std::to_string(spots) +
                                        " of its parts were the building's; leave those out, or "
                                        "keep all apart from the building"
                                  : std::string("; keep it apart from the building")),
                   false);
            continue;
        }
        std::set<std::int32_t> joined;
        for (const std::int32_t p : at)
            if (before[p] >= 0) joined.insert(before[p]);
        std::size_t left = 0;
        for (std::int32_t p = 0; p < primitives_; ++p)
            left += joined.contains(before[p]) && now[p] != now[at.front()];
        if (left > 0)
            remark(n,
                   std::to_string(left) + (left == 1 ? " part" : " parts") +
                       " of the objects that it joins stayed behind: give a spot of every part",
                   true);
    }
}

void HandCorrections::renumber(TableView<PrimitiveId, std::int32_t> number) {
    const auto renumbered = [&](std::vector<std::int32_t>& list) {
        for (std::int32_t& p : list) p = number[p];
        std::erase(list, -1);
    };
    for (LocatedCorrection& l : located_) {
        renumbered(l.at);
        renumbered(l.from);
    }
    renumbered(things_);
    const auto links = [&](auto& pairs, std::vector<std::size_t>& by) {
        std::size_t kept = 0;
        for (std::size_t n = 0; n < pairs.size(); ++n) {
            const std::pair pair{number[pairs[n].first], number[pairs[n].second]};
            if (pair.first < 0 || pair.second < 0) continue;
            pairs[kept] = pair;
            by[kept++] = by[n];
        }
        pairs.resize(kept);
        by.resize(kept);
    };
    links(links_.together, together_by_);
    links(links_.apart, apart_by_);
}

std::optional<TakenAway> HandCorrections::take_from(SolidParts& parts, graph::Grouping& grouping,
                                                    graph::ShellOdds& shell,
                                                    std::vector<graph::Joint>& joints) {
    std::map<std::int32_t, std::size_t> gone;  // primitives, by which correction
    for (std::size_t n = 0; n < applied_.size(); ++n) {
        if (applied_[n].correction.kind != Kind::not_there) continue;
        for (const std::int32_t at : located_[n].at) {
            gone.try_emplace(at, n);
            if (grouping.group[at] < 0) continue;
            for (std::int32_t p = 0; p < primitives_; ++p)
                if (grouping.group[p] == grouping.group[at]) gone.try_emplace(p, n);
        }
    }
    if (gone.empty()) return std::nullopt;
    if (gone.size() == parts.model.size())
        throw Error(ErrorKind::input, "corrections: nothing is left of the scan: " +
                                          with_kind(gone.rbegin()->second) +
                                          " takes the last part of it away; leave it out");
    for (std::size_t n = 0; n < applied_.size(); ++n) {
        const std::vector<std::int32_t>& at = located_[n].at;
        const auto is_gone = [&](std::int32_t p) { return gone.contains(p); };
        if (applied_[n].correction.kind == Kind::not_there || at.empty() ||
            !std::ranges::all_of(at, is_gone))
            continue;
        remark(n, "what is there is taken away by " + numbered(gone.at(at.front())), false);
    }
    Table<PrimitiveId, bool> kept(parts.model.size(), true);
    for (const auto& [p, n] : gone) kept[p] = false;
    TakenAway out = take_away(*parts.solids, kept);
    parts.solids = out.solids;
    const TableView<PrimitiveId, std::int32_t> number(out.number);
    parts.model = left_of(out.number, parts.model);
    parts.shell_log_odds = left_of(out.number, parts.shell_log_odds);
    parts.points = left_of(out.number, parts.points);
    // Numbers rise as before, so the samples stay sorted by them.
    parts.samples = geometry::samples_where(parts.samples, [&](std::size_t n) {
        return parts.samples.primitive[n] < 0 || kept[parts.samples.primitive[n]];
    });
    for (std::int32_t& p : parts.samples.primitive)
        if (p >= 0) p = number[p];
    // Joints are found of these, and have been.
    parts.seams = {};
    grouping.group = left_of(out.number, grouping.group);
    graph::close_gaps(grouping.group);
    shell.log_odds = left_of(out.number, shell.log_odds);
    shell.pinned = left_of(out.number, shell.pinned);
    for (graph::Joint& j : joints) {
        j.a = number[j.a];
        j.b = number[j.b];
    }
    std::erase_if(joints, [](const graph::Joint& j) { return j.a < 0 || j.b < 0; });
    renumber(number);
    primitives_ = static_cast<std::int32_t>(parts.model.size());
    return out;
}

std::optional<std::size_t> HandCorrections::keeper_from_room(const graph::Grouping& grouping,
                                                             std::int32_t group) const {
    const auto group_of = [&](PrimitiveId p) { return grouping.group[p]; };
    for (std::size_t n = 0; n < links_.apart.size(); ++n) {
        const auto& [a, b] = links_.apart[n];
        if ((group_of(a) == group && group_of(b) < 0) || (group_of(b) == group && group_of(a) < 0))
            return apart_by_[n];
    }
    return std::nullopt;
}

void HandCorrections::fix(SolidParts& parts, graph::Grouping& grouping, graph::ShellOdds& shell) {
    std::set<std::int32_t> fixed;  // groups
    for (std::size_t n = 0; n < applied_.size(); ++n) {
        if (applied_[n].correction.kind != Kind::fixed) continue;
        for (const std::int32_t p : located_[n].at) {
            const std::int32_t g = grouping.group[p];
            if (g < 0) continue;
            if (const auto keeper = keeper_from_room(grouping, g))
                remark(n, numbered(*keeper) + " keeps a part of its object apart from the building",
                       false);
            else
                fixed.insert(g);
        }
    }
    Table<PrimitiveId, Role> roles;
    for (std::int32_t p = 0; p < primitives_; ++p) roles.push_back(parts.solids->role(p));
    const Table<PrimitiveId, Role> before = roles;
    for (const std::int32_t p : things_)
        if (grouping.group[p] >= 0) roles[p] = Role::none;
    for (std::int32_t p = 0; p < primitives_; ++p) {
        if (!fixed.contains(grouping.group[p])) continue;
        grouping.group[p] = -1;
        shell.pinned[p] = true;
        shell.log_odds[p] = std::max(shell.log_odds[p], surely_log_odds);
        if (roles[p] == Role::none) roles[p] = Role::fixture;
    }
    if (!fixed.empty()) graph::close_gaps(grouping.group);
    for (std::size_t n = 0; n < links_.apart.size(); ++n) {
        const auto& [a, b] = links_.apart[n];
        if (grouping.group[a] < 0 && grouping.group[b] < 0 &&
            applied_[apart_by_[n]].outcome.empty())
            remark(apart_by_[n], "both are fixed to the building by other corrections", true);
    }
    if (roles != before)
        parts.solids =
            std::make_shared<const SolidScene>(parts.solids->cells(), std::move(roles),
                                               parts.solids->strays(), parts.solids->boundary());
}

std::vector<std::int32_t> HandCorrections::fixed() const {
    std::vector<std::int32_t> out;
    for (std::size_t n = 0; n < applied_.size(); ++n)
        if (applied_[n].correction.kind == Kind::fixed)
            out.insert(out.end(), located_[n].at.begin(), located_[n].at.end());
    return out;
}

Table<ObjectId, KnownMass> HandCorrections::masses(ObjectOf object_of, std::size_t objects,
                                                   std::int32_t grounded) {
    Table<ObjectId, KnownMass> out(objects);
    struct Measure {
        Kind kind;
        double Correction::*said;
        std::optional<double> KnownMass::*known;
        Table<ObjectId, std::optional<std::size_t>> by;  // the correction that said so
    };
    const Table<ObjectId, std::optional<std::size_t>> none(objects);
    std::array measures{
        Measure{Kind::hollow, &Correction::wall_m, &KnownMass::wall_m, none},
        Measure{Kind::mass, &Correction::mass_kg, &KnownMass::mass_kg, none},
        Measure{Kind::friction, &Correction::coefficient, &KnownMass::friction, none}};
    for (std::size_t n = 0; n < applied_.size(); ++n) {
        const Correction& c = applied_[n].correction;
        std::set<std::int32_t> about;
        for (const std::int32_t p : located_[n].at) about.insert(object_of(p));
        if (c.kind == Kind::name)
            for (const std::int32_t o : about)
                if (out[o].name.empty()) out[o].name = c.name;
        const auto measure = std::ranges::find(measures, c.kind, &Measure::kind);
        if (measure == measures.end()) continue;
        if (c.kind == Kind::mass && about.size() > 1)
            remark(n,
                   "its spots lie in " + std::to_string(about.size()) +
                       " objects, each of which is taken to weigh that",
                   true);
        for (const std::int32_t o : about) {
            if (o == grounded) {
                remark(n,
                       "what is there is of the building, whose mass and friction count for "
                       "nothing",
                       false);
                continue;
            }
            std::optional<std::size_t>& by = measure->by[o];
            std::optional<double>& value = out[o].*measure->known;
            const double own = c.*measure->said;
            if (by && *value != own) {
                remark(n, numbered(*by) + " says otherwise of object " + std::to_string(o), false);
                continue;
            }
            by = by.value_or(n);
            value = own;
        }
    }
    return out;
}

HandCorrections::Told HandCorrections::tell(ObjectOf object_of, std::size_t objects,
                                            std::int32_t grounded) {
    Told out;
    out.name.resize(objects);
    out.corrected.resize(objects);
    Table<ObjectId, std::optional<std::size_t>> named_by(objects);
    std::map<std::int32_t, std::size_t> part_named_by;
    for (std::size_t n = 0; n < applied_.size(); ++n) {
        AppliedCorrection& applied = applied_[n];
        std::set<std::int32_t> about;
        // Of two that are apart it is about the one that was spoken of.
        for (const std::int32_t p : located_[n].at) about.insert(object_of(p));
        applied.objects.assign(about.begin(), about.end());
        if (applied.correction.kind == Kind::name) {
            const std::string& name = applied.correction.name;
            for (const std::int32_t p : located_[n].at) {
                const bool part = object_of(p) == grounded;
                std::string& to = part ? out.name_of_part[p] : out.name[object_of(p)];
                if (!to.empty() && to != name) {
                    remark(n,
                           numbered(part ? part_named_by.at(p) : *named_by[object_of(p)]) +
                               " names it otherwise",
                           false);
                    continue;
                }
                if (part)
                    part_named_by.try_emplace(p, n);
                else
                    named_by[object_of(p)] = named_by[object_of(p)].value_or(n);
                to = name;
            }
        }
        if (!applied.held) continue;
        for (const std::int32_t o : applied.objects)
            out.corrected[o].push_back(static_cast<std::int32_t>(n + 1));
        applied.outcome = applied.outcome.empty() ? "held" : "held, but " + applied.outcome;
    }
    out.corrections = std::move(applied_);
    return out;
}

}  // namespace topple
