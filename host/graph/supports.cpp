// SPDX-License-Identifier: MIT
#include "graph/supports.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/scan_gaps.h"
#include "fitted/boosted_trees.h"

namespace topple::graph {
namespace {

constexpr double intercept = -2.85, by_mass = 0.42, by_columns = 0.59, by_joint = 0.12;
// What stands on nothing likelier than not stands on the likeliest above this.
constexpr double least_alone = 0.2;

using Pair = std::pair<std::int32_t, std::int32_t>;

struct Evidence {
    double contact = 0, near = 0;  // columns
    double joint = 0;              // probability of the likeliest
};

// By (supporter, supported).
std::map<Pair, Evidence> gather(const ContactGraph& contacts,
                                std::span<const double> pair_probability, ObjectOf object_of,
                                TableView<ObjectId, Carried> objects,
                                const Table<ObjectId, std::vector<Underside>>& columns) {
    std::map<Pair, Evidence> found;
    for (const Carrying& c : contacts.carryings) {
        if (c.supporter < 0) continue;
        const Pair pair{object_of(c.supporter), object_of(c.supported)};
        // The ground carries, and nothing carries it, though fragments of it may lie on things.
        if (pair.first != pair.second && !objects[pair.second].grounded)
            found[pair].contact += c.area_m2 / (contacts.voxel_m * contacts.voxel_m);
    }
    for (std::size_t o = 0; o < columns.size(); ++o) {
        if (objects[o].grounded) continue;
        for (const Underside& u : columns[o]) {
            if (u.gap >= 0 && u.gap <= noise_gap && u.primitive >= 0)
                ++found[{object_of(u.primitive), static_cast<std::int32_t>(o)}].near;
        }
    }
    for (std::size_t n = 0; n < contacts.pairs.size(); ++n) {
        const std::int32_t a = object_of(contacts.pairs[n].a), b = object_of(contacts.pairs[n].b);
        for (const Pair& pair : {Pair{a, b}, Pair{b, a}}) {
            const auto at = found.find(pair);
            if (at != found.end())
                at->second.joint = std::max(at->second.joint, pair_probability[n]);
        }
    }
    return found;
}

double probability(const Evidence& e, double supporter_kg, double supported_kg) {
    constexpr double least_kg = 1e-3, most = 5, sure = 0.995;
    const double ratio =
        std::clamp(std::log((supporter_kg + least_kg) / (supported_kg + least_kg)), -most, most);
    const double odds = intercept + by_mass * ratio +
                        by_columns * std::log1p((e.contact + e.near) / 2) -
                        by_joint * fitted::log_odds(std::clamp(e.joint, 1 - sure, sure));
    return 1 / (1 + std::exp(-odds));
}

// Objects may carry one another two and two, as what leans together does, but a longer round holds
// nothing up: of the supports that close one, the likelier stay.
void break_rounds(std::vector<Support>& supports, std::size_t objects) {
    std::set<Pair> stated;
    for (const Support& s : supports) stated.emplace(s.supporter, s.supported);
    const auto mutual = [&](const Support& s) {
        return stated.contains({s.supported, s.supporter});
    };
    // What is not on any round goes, from the ground up (Kahn).
    Table<ObjectId, std::vector<std::size_t>> carries(objects);
    Table<ObjectId, int> carriers(objects, 0);
    for (const Support& s : supports) {
        if (mutual(s)) continue;
        carries[s.supporter].push_back(ObjectId(s.supported).place());
        ++carriers[s.supported];
    }
    std::vector<std::size_t> free;
    for (std::size_t o = 0; o < objects; ++o)
        if (carriers[o] == 0) free.push_back(o);
    for (std::size_t n = 0; n < free.size(); ++n) {
        for (const std::size_t o : carries[free[n]])
            if (--carriers[o] == 0) free.push_back(o);
    }
    if (free.size() == objects) return;

    std::vector<std::size_t> order;
    for (std::size_t n = 0; n < supports.size(); ++n) {
        const Support& s = supports[n];
        if (carriers[s.supporter] > 0 && carriers[s.supported] > 0 && !mutual(s))
            order.push_back(n);
    }
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return supports[a].probability > supports[b].probability;
    });
    for (auto& list : carries) list.clear();
    std::vector<std::size_t> dropped;
    for (const std::size_t n : order) {
        const std::size_t from = ObjectId(supports[n].supporter).place(),
                          to = ObjectId(supports[n].supported).place();
        std::vector<std::size_t> reached{to};
        std::vector<bool> seen(objects);
        for (std::size_t at = 0; at < reached.size() && !seen[from]; ++at) {
            for (const std::size_t o : carries[reached[at]]) {
                if (!seen[o]) reached.push_back(o);
                seen[o] = true;
            }
        }
        if (seen[from])
            dropped.push_back(n);
        else
            carries[from].push_back(to);
    }
    for (const std::size_t n : dropped) supports[n].probability = -1;
    std::erase_if(supports, [](const Support& s) { return s.probability < 0; });
}

}  // namespace

std::vector<Support> find_supports(const ContactGraph& contacts,
                                   std::span<const double> pair_probability, ObjectOf object_of,
                                   TableView<ObjectId, Carried> objects,
                                   const Table<ObjectId, std::vector<Underside>>& columns) {
    std::vector<Support> all;
    Table<ObjectId, double> likeliest(objects.size(), 0);
    for (const auto& [pair, e] : gather(contacts, pair_probability, object_of, objects, columns)) {
        const auto& [supporter, supported] = pair;
        const double p = probability(e, objects[supporter].mass_kg, objects[supported].mass_kg);
        const double area = (e.contact > 0 ? e.contact : e.near) * contacts.voxel_m;
        all.push_back({supporter, supported, area * contacts.voxel_m, p});
        likeliest[supported] = std::max(likeliest[supported], p);
    }
    std::erase_if(all, [&](const Support& s) {
        const double best = likeliest[s.supported];
        return s.probability <= 0.5 && (s.probability < best || best <= least_alone);
    });
    break_rounds(all, objects.size());
    return all;
}

}  // namespace topple::graph
