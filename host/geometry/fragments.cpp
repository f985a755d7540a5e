// SPDX-License-Identifier: MIT
#include "geometry/fragments.h"

#include <map>
#include <utility>
#include <vector>

namespace topple::geometry {
namespace {

// Border of each fragment with each solid: neighbouring pairs of surfels.
using Borders = std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t>;

Borders borders(const Surfels& s, const std::vector<std::int32_t>& label,
                const std::vector<bool>& solid) {
    Borders out;
    for (std::size_t n = 0; n < s.size(); ++n) {
        const std::int32_t a = label[n];
        if (a < 0 || solid[static_cast<std::size_t>(a)]) continue;
        for (std::uint32_t k = s.neighbour_first[n]; k < s.neighbour_first[n + 1]; ++k) {
            const std::int32_t b = label[s.neighbours[k]];
            if (b >= 0 && solid[static_cast<std::size_t>(b)]) ++out[{a, b}];
        }
    }
    return out;
}

// One ring of unlabelled surfels takes the label that most of its labelled neighbours have, the
// lowest of equals. Returns whether any did.
bool grow_labels(const Surfels& s, std::vector<std::int32_t>& label) {
    std::vector<std::pair<std::size_t, std::int32_t>> taken;
    for (std::size_t n = 0; n < s.size(); ++n) {
        if (label[n] >= 0) continue;
        std::map<std::int32_t, unsigned> votes;
        for (std::uint32_t k = s.neighbour_first[n]; k < s.neighbour_first[n + 1]; ++k) {
            const std::int32_t l = label[s.neighbours[k]];
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
        if (l >= 0) ++size[static_cast<std::size_t>(l)];
    }
    std::vector<bool> solid;
    for (const std::uint64_t s : size) solid.push_back(s >= least_surfels);
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
    for (std::int32_t& l : primitives.label) l = l < 0 ? -1 : number[static_cast<std::size_t>(l)];
    while (grow_labels(surfels, primitives.label)) {
    }
    primitives.model = std::move(kept.model);
    primitives.regions = std::move(kept.regions);
}

}  // namespace topple::geometry
