// SPDX-License-Identifier: MIT
#include "geometry/fragments.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/union_find.h"
#include "geometry/algebraic_model.h"
#include "geometry/face_limits.h"
#include "geometry/split.h"

namespace topple::geometry {
namespace {

// Border of each fragment with each solid: neighbouring pairs of surfels.
using Borders = std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t>;

Borders borders(const Surfels& s, const std::vector<std::int32_t>& label,
                const std::vector<bool>& solid) {
    Borders out;
    for (std::size_t n = 0; n < s.size(); ++n) {
        const std::int32_t a = label[n];
        if (a < 0 || solid[a]) continue;
        for (const std::uint32_t j : s.around(n)) {
            const std::int32_t b = label[j];
            if (b >= 0 && solid[b]) ++out[{a, b}];
        }
    }
    return out;
}

// How many steps over neighbours a surfel is away from the nearest solid; 0: part of one, or of
// what touches none.
std::vector<std::uint32_t> steps_from_solids(const Surfels& s,
                                             const std::vector<std::int32_t>& label,
                                             const std::vector<bool>& solid) {
    std::vector<std::uint32_t> steps(s.size(), 0), queue;
    const auto is_solid = [&](std::uint32_t n) { return label[n] >= 0 && solid[label[n]]; };
    for (std::uint32_t n = 0; n < s.size(); ++n) {
        if (is_solid(n)) queue.push_back(n);
    }
    for (std::size_t head = 0; head < queue.size(); ++head) {
        const std::uint32_t n = queue[head];
        for (const std::uint32_t m : s.around(n)) {
            if (is_solid(m) || steps[m] > 0) continue;
            steps[m] = steps[n] + 1;
            queue.push_back(m);
        }
    }
    return steps;
}

// The fragments that a thin thing breaks into, a leg seen by few rays, as one primitive: each
// connected piece of surfels further from all solids than noise along a crease is, with all of
// the fragments that take part in it. It takes the place of the largest of them.
void join_protrusions(const Surfels& s, std::vector<bool>& solid, PrimitiveSet& primitives) {
    constexpr std::uint32_t beyond_crease = 2, stands_off = 4;  // steps
    std::vector<std::int32_t>& label = primitives.label;
    const std::vector<std::uint32_t> steps = steps_from_solids(s, label, solid);
    std::vector<bool> seen(s.size());
    UnionFind joined(solid.size());
    const auto root = [&](std::int32_t p) {
        return static_cast<std::int32_t>(joined.root(static_cast<std::size_t>(p)));
    };
    for (std::uint32_t first = 0; first < s.size(); ++first) {
        if (seen[first] || steps[first] < beyond_crease) continue;
        std::vector<std::uint32_t> piece{first};
        std::set<std::int32_t> fragments;
        std::uint32_t furthest = 0;
        seen[first] = true;
        for (std::size_t head = 0; head < piece.size(); ++head) {
            const std::uint32_t n = piece[head];
            furthest = std::max(furthest, steps[n]);
            if (label[n] >= 0) fragments.insert(root(label[n]));
            for (const std::uint32_t m : s.around(n)) {
                if (seen[m] || steps[m] < beyond_crease) continue;
                seen[m] = true;
                piece.push_back(m);
            }
        }
        if (furthest < stands_off || piece.size() < least_region || fragments.empty()) continue;
        // Ids go by falling size.
        const std::int32_t whole = *fragments.begin();
        for (const std::int32_t f : fragments)
            joined.join(static_cast<std::size_t>(whole), static_cast<std::size_t>(f));
        solid[whole] = true;
        for (const std::uint32_t n : piece)
            if (label[n] < 0) label[n] = whole;
    }
    for (std::int32_t& l : label)
        if (l >= 0) l = root(l);
    for (std::size_t p = 0; p < solid.size(); ++p) {
        const std::size_t whole = joined.root(p);
        if (whole == p) continue;
        solid[p] = false;
        auto& to = primitives.regions[whole];
        to.insert(to.end(), primitives.regions[p].begin(), primitives.regions[p].end());
        primitives.model[whole] = "merged";
    }
}

// Whether the surface of one of these faces explains a surfel: it lies as near as noise and the
// rounding of an edge over a cell bring the points of a crease.
bool explained(const Surfels& s, std::uint32_t n, const Regions& faces,
               const std::set<std::int32_t>& among) {
    return std::ranges::any_of(among, [&](std::int32_t f) {
        const Region& face = faces.regions[f];
        return std::abs(distance(face.model, position(s, n))) <=
               own_surface_m(face.residual_m, s.cell_m);
    });
}

// A fragment is a small thing rather than noise where the faces of solids around it leave more
// than a part of it unexplained: a book on a table stands out of it by its thickness, however few
// surfels it shows. It must have as many surfels as a region.
void keep_small_things(const Surfels& s, std::vector<bool>& solid, const PrimitiveSet& primitives) {
    constexpr double unexplained_share = 0.3;
    const std::vector<std::int32_t>& label = primitives.label;
    const Regions& faces = primitives.faces;
    std::vector<std::vector<std::uint32_t>> members(solid.size());
    for (std::uint32_t n = 0; n < s.size(); ++n)
        if (label[n] >= 0 && !solid[label[n]]) members[label[n]].push_back(n);
    std::vector<std::size_t> things;
    for (std::size_t p = 0; p < members.size(); ++p) {
        if (members[p].size() < least_region) continue;
        std::set<std::int32_t> around;
        for (const std::uint32_t n : members[p])
            for (const std::uint32_t m : s.around(n)) {
                if (label[m] >= 0 && solid[label[m]] && faces.label[m] >= 0)
                    around.insert(faces.label[m]);
            }
        const auto unexplained = std::ranges::count_if(
            members[p], [&](std::uint32_t n) { return !explained(s, n, faces, around); });
        if (static_cast<double>(unexplained) >
            unexplained_share * static_cast<double>(members[p].size()))
            things.push_back(p);
    }
    for (const std::size_t p : things) solid[p] = true;
}

// One ring of unlabelled surfels takes the label that most of its labelled neighbours have, the
// lowest of equals. Returns whether any did.
bool grow_labels(const Surfels& s, std::vector<std::int32_t>& label) {
    std::vector<std::pair<std::size_t, std::int32_t>> taken;
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] >= 0) continue;
        std::map<std::int32_t, unsigned> votes;
        for (const std::uint32_t j : s.around(n)) {
            const std::int32_t l = label[j];
            if (l >= 0) ++votes[l];
        }
        unsigned most = 0;
        std::int32_t winner = -1;
        for (const auto& [l, count] : votes) {
            if (count > most) most = count, winner = l;
        }
        if (winner >= 0) taken.emplace_back(n, winner);
    }
    for (const auto& [n, l] : taken) label[n] = l;
    return !taken.empty();
}

}  // namespace

void absorb_fragments(const Surfels& surfels, std::uint64_t least_surfels,
                      PrimitiveSet& primitives) {
    std::vector<std::uint64_t> size(primitives.model.size(), 0);
    for (const std::int32_t l : primitives.label) {
        if (l >= 0) ++size[l];
    }
    std::vector<bool> solid;
    for (const std::uint64_t s : size) solid.push_back(s >= least_surfels);
    join_protrusions(surfels, solid, primitives);
    keep_small_things(surfels, solid, primitives);
    // Each round takes in the fragments that touch a solid; what they touched in turn is next.
    for (;;) {
        std::map<std::int32_t, std::pair<std::uint64_t, std::int32_t>>
            best;  // fragment: border, solid
        for (const auto& [pair, border] : borders(surfels, primitives.label, solid)) {
            auto& [most, home] = best.try_emplace(pair.first, 0, -1).first->second;
            if (border > most) most = border, home = pair.second;
        }
        if (best.empty()) break;
        for (std::int32_t& l : primitives.label) {
            const auto at = best.find(l);
            if (at != best.end()) l = at->second.second;
        }
    }
    std::vector<std::int32_t> number(size.size(), -1);
    PrimitiveSet kept;
    for (std::size_t p = 0; p < size.size(); ++p) {
        if (!solid[p]) continue;
        number[p] = static_cast<std::int32_t>(kept.model.size());
        kept.model.push_back(std::move(primitives.model[p]));
        kept.regions.push_back(std::move(primitives.regions[p]));
    }
    for (std::int32_t& l : primitives.label) l = l < 0 ? -1 : number[l];
    while (grow_labels(surfels, primitives.label)) {
    }
    primitives.model = std::move(kept.model);
    primitives.regions = std::move(kept.regions);
}

}  // namespace topple::geometry
