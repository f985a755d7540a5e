// SPDX-License-Identifier: MIT
#include "lab/scores/relation_score.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace topple::scenes {
namespace {

constexpr std::uint64_t seen_points = 60;

// Object that most points of each seen part came out in; none where no point has one.
struct PartView {
    std::vector<bool> seen;
    std::vector<std::optional<std::int32_t>> object;
};
PartView view_parts(std::size_t parts, std::span<const std::int32_t> label,
                    std::span<const std::int32_t> object) {
    std::vector<std::uint64_t> points(parts);
    std::vector<std::map<std::int32_t, std::uint64_t>> votes(parts);
    for (std::size_t n = 0; n < label.size(); ++n) {
        if (label[n] < 0) continue;
        const auto part = static_cast<std::size_t>(label[n]);
        points[part]++;
        if (object[n] >= 0) votes[part][object[n]]++;
    }
    PartView view;
    for (std::size_t k = 0; k < parts; ++k) {
        view.seen.push_back(points[k] >= seen_points);
        const auto most =
            std::ranges::max_element(votes[k], {}, [](const auto& vote) { return vote.second; });
        view.object.emplace_back();
        if (most != votes[k].end()) view.object[k] = most->first;
    }
    return view;
}

}  // namespace

std::vector<std::int32_t> true_bodies(const World& truth) {
    std::vector<std::int32_t> body;
    for (const Part& part : truth.parts) body.push_back(part.object);
    for (const auto& [a, b] : truth.fixed) {
        const std::int32_t from = body[a], to = body[b];
        if (from != to) std::replace(body.begin(), body.end(), from, to);
    }
    return body;
}

RelationScore relation_score(const World& truth, const Scene& parse,
                             std::span<const std::int32_t> label) {
    const PartView view = view_parts(truth.parts.size(), label, parse.points.object);
    const auto body = true_bodies(truth);
    const auto at = [](std::int32_t id) { return static_cast<std::size_t>(id); };
    const auto both_seen = [&](const auto& pair) {
        return view.seen[at(pair.first)] && view.seen[at(pair.second)];
    };
    const auto together = [&](const auto& pair) {
        return view.object[at(pair.first)] &&
               view.object[at(pair.first)] == view.object[at(pair.second)];
    };
    std::set<std::pair<std::int32_t, std::int32_t>> found, carries, touching;
    for (const Support& s : parse.supports) found.emplace(s.supporter, s.supported);
    std::uint64_t joined = 0, joints = 0, carried = 0, supports = 0;
    for (const auto& pair : truth.fixed) {
        touching.insert(std::minmax(pair.first, pair.second));
        if (!both_seen(pair)) continue;
        joints++;
        joined += together(pair);
    }
    for (const auto& pair : truth.support) {
        touching.insert(std::minmax(pair.first, pair.second));
        carries.emplace(body[at(pair.first)], body[at(pair.second)]);
        if (!both_seen(pair)) continue;
        supports++;
        const auto a = view.object[at(pair.first)], b = view.object[at(pair.second)];
        carried += a && b && *a != *b && found.contains({*a, *b});
    }
    std::uint64_t truly = 0, claimed = 0;
    for (const auto& pair : touching) {
        if (!both_seen(pair) || !together(pair)) continue;
        claimed++;
        truly += body[at(pair.first)] == body[at(pair.second)];
    }
    std::map<std::int32_t, std::set<std::int32_t>> bodies_of;  // of each found object
    for (std::size_t k = 0; k < truth.parts.size(); ++k) {
        if (view.seen[k] && view.object[k]) bodies_of[*view.object[k]].insert(body[k]);
    }
    std::uint64_t right = 0, judged = 0;
    for (const auto& [a, b] : found) {
        if (!bodies_of.contains(a) || !bodies_of.contains(b)) continue;
        judged++;
        bool any = false;
        for (const std::int32_t x : bodies_of[a]) {
            for (const std::int32_t y : bodies_of[b]) any = any || carries.contains({x, y});
        }
        right += any;
    }
    RelationScore out;
    out.fixed_recall = share(joined, joints);
    out.fixed_precision = share(truly, claimed);
    out.support_recall = share(carried, supports);
    out.support_precision = share(right, judged);
    return out;
}

}  // namespace topple::scenes
