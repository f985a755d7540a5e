// SPDX-License-Identifier: MIT
#include "geometry/region_facts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/split.h"

namespace topple::geometry {

RegionFacts::RegionFacts(const Surfels& surfels, const CutRegions& cuts, const FreeSpace& free,
                         ThreadPool& threads)
    : s_(surfels), cuts_(cuts), free_(free), threads_(threads) {
    std::vector<std::int32_t> all(cuts.members.size());
    std::iota(all.begin(), all.end(), 0);
    update(all);
}

void RegionFacts::update(const std::vector<std::int32_t>& changed) {
    const std::size_t count = cuts_.members.size();
    samples_.resize(count);
    box_.resize(count);
    touching_.resize(count);
    for (const std::int32_t k : changed) forget(k);
    threads_.each(changed.size(), 4, [&](std::size_t n) {
        const auto k = static_cast<std::size_t>(changed[n]);
        samples_[k] = sample_region(s_, cuts_, k);
        box_[k].setEmpty();
        for (const std::uint32_t i : cuts_.members[k]) box_[k].extend(position(s_, i));
    });
    find_borders(changed);
    find_face_pieces(changed);
}

void RegionFacts::forget(std::int32_t k) {
    const auto of_k = [&](const Pair& pair) { return pair.first == k || pair.second == k; };
    for (const std::int32_t other : touching_[k]) {
        borders_.erase(std::minmax(k, other));
        touching_[other].erase(k);
    }
    touching_[k].clear();
    std::erase_if(face_pieces_, of_k);
    std::erase_if(concavity_, [&](const auto& entry) { return of_k(entry.first); });
}

void RegionFacts::find_borders(const std::vector<std::int32_t>& changed) {
    struct Touch {
        std::int32_t a, b;
        std::uint32_t i, j;
        auto operator<=>(const Touch&) const = default;
    };
    std::vector<bool> among(cuts_.members.size(), false);
    for (const std::int32_t k : changed) among[k] = true;
    const std::vector<std::int32_t>& label = cuts_.regions.label;
    std::vector<Touch> touches;
    for (const std::int32_t a : changed)
        for (const std::uint32_t i : cuts_.members[a])
            for (const std::uint32_t j : s_.around(i)) {
                const std::int32_t b = label[j];
                if (b > a) touches.push_back({a, b, i, j});
                if (b >= 0 && b < a && !among[b]) touches.push_back({b, a, j, i});
            }
    std::sort(touches.begin(), touches.end());
    std::vector<Border*> fresh;
    for (const Touch& t : touches) {
        if (fresh.empty() || fresh.back()->a != t.a || fresh.back()->b != t.b) {
            Border& border = borders_[{t.a, t.b}];
            border.a = t.a;
            border.b = t.b;
            touching_[t.a].insert(t.b);
            touching_[t.b].insert(t.a);
            fresh.push_back(&border);
        }
        fresh.back()->pairs.emplace_back(t.i, t.j);
    }
    threads_.each(fresh.size(), 4, [&](std::size_t n) {
        Border& border = *fresh[n];
        const auto a = static_cast<std::size_t>(border.a), b = static_cast<std::size_t>(border.b);
        const auto smaller =
            std::min(cuts_.regions.regions[a].surfels, cuts_.regions.regions[b].surfels);
        border.length =
            static_cast<double>(border.pairs.size()) / std::sqrt(static_cast<double>(smaller));
        if (border.length < least_border) return;
        border.inside_share = inside_share(s_, cuts_.regions, border,
                                           {samples_[a].tolerance_m, samples_[b].tolerance_m});
    });
}

void RegionFacts::find_face_pieces(const std::vector<std::int32_t>& changed) {
    std::vector<bool> among(cuts_.members.size(), false);
    for (const std::int32_t k : changed) among[k] = true;
    // The widest gap that is looked into, and a little for rounding.
    const double reach = 1.001 * (widest_face_gap_m + s_.cell_m);
    std::vector<std::vector<std::int32_t>> found(changed.size());
    threads_.each(changed.size(), 4, [&](std::size_t n) {
        const auto k = static_cast<std::size_t>(changed[n]);
        if (cuts_.members[k].size() < least_piece) return;
        for (std::size_t other = 0; other < cuts_.members.size(); ++other) {
            if (other == k || cuts_.members[other].size() < least_piece) continue;
            if (among[other] && other < k) continue;  // its own turn finds the pair
            if (box_[k].exteriorDistance(box_[other]) > reach) continue;
            if (are_face_pieces(s_, cuts_, samples_, std::min(k, other), std::max(k, other)))
                found[n].push_back(static_cast<std::int32_t>(other));
        }
    });
    for (std::size_t n = 0; n < changed.size(); ++n)
        for (const std::int32_t other : found[n])
            face_pieces_.insert(std::minmax(changed[n], other));
}

double RegionFacts::concavity(std::int32_t a, std::int32_t b) {
    const Pair pair = std::minmax(a, b);
    const auto [at, fresh] = concavity_.try_emplace(pair, 0.0);
    if (fresh) {
        const auto i = static_cast<std::size_t>(pair.first),
                   j = static_cast<std::size_t>(pair.second);
        at->second = cuts_.parted(i, j) ? 1 : geometry::concavity(samples_[i], samples_[j], free_);
    }
    return at->second;
}

}  // namespace topple::geometry
