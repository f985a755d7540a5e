// SPDX-License-Identifier: MIT
#include "scenes/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <thread>

#include "topple/error.h"

namespace topple::scenes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nearest_m = 0.05;
constexpr std::uint64_t seen_points = 60;

// body(first, last) over equal pieces of [0, count), one for each core.
void in_parallel(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> running;
    for (std::size_t n = 1; n < threads; ++n) {
        running.emplace_back([&, n] { body(count * n / threads, count * (n + 1) / threads); });
    }
    body(0, count / threads);
}

// Distances to many parts, those far away left out by their bounding spheres.
struct Measure {
    const Part* part;
    Part::Heading heading;
    double radius;

    // Whether |distance| could be below `best` at p.
    bool near(const Vec3& p, double best) const {
        const double x = p[0] - part->center[0], y = p[1] - part->center[1],
                     z = p[2] - part->center[2];
        const double reach = radius + best;
        return !(x * x + y * y + z * z > reach * reach);
    }
    double at(const Vec3& p) const { return part->distance(p, heading); }
};

std::vector<Measure> measures(const World& truth) {
    std::vector<Measure> all;
    for (const Part& part : truth.parts)
        all.push_back({&part, part.heading(), part.bounding_radius()});
    return all;
}

// Part of each point, -1 beyond 5 cm.
std::vector<std::int32_t> true_parts(const World& truth, const ScenePoints& points) {
    const auto all = measures(truth);
    std::vector<std::int32_t> label(points.x.size(), -1);
    in_parallel(label.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            const Vec3 p = truth.to_room({points.x[n], points.y[n], points.z[n]});
            double best = nearest_m;
            for (std::size_t k = 0; k < all.size(); ++k) {
                if (!all[k].near(p, best)) continue;
                const double d = std::abs(all[k].at(p));
                if (d < best) {
                    best = d;
                    label[n] = static_cast<std::int32_t>(k);
                }
            }
        }
    });
    return label;
}

Share share(std::uint64_t hits, std::uint64_t of) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {of ? static_cast<double>(hits) / static_cast<double>(of) : none, of};
}

void score_precision(const World& truth, const SolidVoxels& solid, double h, Score& out) {
    const auto all = measures(truth);
    std::vector<std::uint8_t> verdict(solid.x.size());  // bit 0: counts, bit 1: right
    in_parallel(verdict.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            const Vec3 p = truth.to_room({solid.x[n], solid.y[n], solid.z[n]});
            bool in_room = false;
            double near = infinity;
            for (const Measure& m : all) {
                if (!m.near(p, 2 * h)) continue;
                const double d = m.at(p);
                if (m.part->object == 0) {
                    in_room = in_room || d < 1.5 * h;
                } else {
                    near = std::min(near, d);
                }
            }
            if (!in_room || near < 0) verdict[n] = near <= 0.87 * h ? 3 : 1;
        }
    });
    std::uint64_t right = 0, used = 0;
    for (const std::uint8_t v : verdict) {
        used += v & 1;
        right += v >> 1;
    }
    out.volume_precision = share(right, used);
}

// A voxel index packed into one word, 21 bits per axis.
std::uint64_t packed(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::int64_t half = 1 << 20;
    const auto bits = [](std::int64_t v) {
        return static_cast<std::uint64_t>(std::clamp(v + half, std::int64_t{0}, 2 * half - 1));
    };
    return bits(i) << 42 | bits(j) << 21 | bits(k);
}

void score_recall(const World& truth, const SolidVoxels& solid, double h, Score& out) {
    std::vector<std::uint64_t> occupied;
    for (std::size_t n = 0; n < solid.x.size(); ++n) {
        const Vec3 p = truth.to_room({solid.x[n], solid.y[n], solid.z[n]});
        occupied.push_back(packed(std::llround(std::floor(p[0] / h)),
                                  std::llround(std::floor(p[1] / h)),
                                  std::llround(std::floor(p[2] / h))));
    }
    std::sort(occupied.begin(), occupied.end());
    const auto has = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
        return std::binary_search(occupied.begin(), occupied.end(), packed(i, j, k));
    };
    std::vector<std::pair<std::uint64_t, std::uint64_t>> found(truth.parts.size());
    in_parallel(truth.parts.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            const Part& part = truth.parts[n];
            if (part.object == 0) continue;
            const auto box = part.bounds();
            std::array<std::int64_t, 3> low{}, high{};
            for (std::size_t a = 0; a < 3; ++a) {
                low[a] = std::llround(std::floor(box[0][a] / h)) - 1;
                high[a] = std::llround(std::ceil(box[1][a] / h)) + 1;
            }
            for (std::int64_t i = low[0]; i < high[0]; ++i) {
                for (std::int64_t j = low[1]; j < high[1]; ++j) {
                    for (std::int64_t k = low[2]; k < high[2]; ++k) {
                        const auto mid = [&](std::int64_t v) {
                            return (static_cast<double>(v) + 0.5) * h;
                        };
                        if (!(part.distance({mid(i), mid(j), mid(k)}) < -0.25 * h)) continue;
                        found[n].second++;
                        found[n].first += has(i, j, k) || has(i + 1, j, k) || has(i - 1, j, k) ||
                                          has(i, j + 1, k) || has(i, j - 1, k) ||
                                          has(i, j, k + 1) || has(i, j, k - 1);
                    }
                }
            }
        }
    });
    std::uint64_t hits = 0, of = 0;
    for (const auto& [h1, o1] : found) {
        hits += h1;
        of += o1;
    }
    out.volume_recall = share(hits, of);
}

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
        view.object.emplace_back();
        std::uint64_t most = 0;
        for (const auto& [o, count] : votes[k]) {
            if (count > most) {
                most = count;
                view.object[k] = o;
            }
        }
    }
    return view;
}

// True objects after joining those that are fixed to one another: what hangs on a wall is the
// room's.
std::vector<std::int32_t> true_bodies(const World& truth) {
    std::vector<std::int32_t> body;
    for (const Part& part : truth.parts) body.push_back(part.object);
    for (const auto& [a, b] : truth.fixed) {
        const std::int32_t from = body[static_cast<std::size_t>(a)],
                           to = body[static_cast<std::size_t>(b)];
        if (from != to) std::replace(body.begin(), body.end(), from, to);
    }
    return body;
}

void score_relations(const World& truth, const topple::Scene& parse,
                     std::span<const std::int32_t> label, Score& out) {
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
    out.fixed_recall = share(joined, joints);
    out.fixed_precision = share(truly, claimed);
    out.support_recall = share(carried, supports);
    out.support_precision = share(right, judged);
}

}  // namespace

SegmentationScore segmentation_score(std::span<const std::int32_t> truth,
                                     std::span<const std::int32_t> predicted) {
    if (truth.size() != predicted.size()) {
        throw Error(ErrorKind::usage, "score: " + std::to_string(truth.size()) +
                                          " true labels against " +
                                          std::to_string(predicted.size()));
    }
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t> both;
    std::map<std::int32_t, std::uint64_t> of_truth, of_predicted, best_of_truth, best_of_predicted;
    for (std::size_t n = 0; n < truth.size(); ++n) {
        const std::int32_t p = std::max(predicted[n], -1);
        both[{truth[n], p}]++;
        of_truth[truth[n]]++;
        of_predicted[p]++;
    }
    std::map<std::int32_t, double> iou;
    for (const auto& [pair, count] : both) {
        const auto [t, p] = pair;
        best_of_truth[t] = std::max(best_of_truth[t], count);
        best_of_predicted[p] = std::max(best_of_predicted[p], count);
        iou[t] = std::max(iou[t], static_cast<double>(count) /
                                      static_cast<double>(of_truth[t] + of_predicted[p] - count));
    }
    SegmentationScore out;
    const auto all = static_cast<double>(truth.size());
    if (truth.empty()) return out;
    std::uint64_t covered = 0, kept = 0;
    for (const auto& [t, count] : best_of_truth) covered += count;
    for (const auto& [p, count] : best_of_predicted) kept += count;
    out.missing = 1 - static_cast<double>(covered) / all;
    out.false_alarm = 1 - static_cast<double>(kept) / all;
    out.hamming = (out.missing + out.false_alarm) / 2;
    for (const auto& [t, value] : iou) {
        out.miou += value / static_cast<double>(iou.size());
        out.weighted_iou += value * static_cast<double>(of_truth[t]) / all;
    }
    out.segments = of_predicted.size();
    return out;
}

Score score(const World& truth, const topple::Scene& parse) {
    const ScenePoints& points = parse.points;
    const std::size_t n = points.x.size();
    if (n == 0 || points.primitive.size() != n || points.object.size() != n ||
        !(parse.voxel_size_m > 0)) {
        throw Error(ErrorKind::input,
                    "score: the parse has " + std::to_string(n) + " points, labels of " +
                        std::to_string(points.primitive.size()) + " and voxels of " +
                        std::to_string(parse.voxel_size_m) + " m");
    }
    const auto label = true_parts(truth, points);
    std::vector<std::int32_t> part, part_object, primitive, object;
    for (std::size_t k = 0; k < n; ++k) {
        if (label[k] < 0) continue;
        part.push_back(label[k]);
        part_object.push_back(truth.parts[static_cast<std::size_t>(label[k])].object);
        primitive.push_back(points.primitive[k]);
        object.push_back(points.object[k]);
    }
    Score out;
    out.parts = segmentation_score(part, primitive);
    out.objects = segmentation_score(part_object, object);
    score_precision(truth, parse.solid, parse.voxel_size_m, out);
    score_recall(truth, parse.solid, parse.voxel_size_m, out);
    score_relations(truth, parse, label, out);
    const Vec3 up = truth.to_input({0, 0, 1});
    const double length = std::hypot(parse.up[0], parse.up[1], parse.up[2]);
    const double cosine =
        (parse.up[0] * up[0] + parse.up[1] * up[1] + parse.up[2] * up[2]) / length;
    out.gravity_deg = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
    return out;
}

}  // namespace topple::scenes
