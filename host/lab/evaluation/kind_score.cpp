// SPDX-License-Identifier: MIT
#include "lab/evaluation/kind_score.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "lab/rooms/kinds.h"

namespace topple::evaluation {
namespace {

constexpr double truth_reach_m = 0.06;  // of a point's true object
constexpr std::uint32_t least_points = 30;
constexpr double least_seen_m2 = 0.015;

using Id = std::int32_t;
using Pair = std::pair<Id, Id>;

double ratio(std::size_t hits, std::size_t of) {
    return of == 0 ? KindScore::none : static_cast<double>(hits) / static_cast<double>(of);
}

// How many points two labellings have in common, without negative labels.
struct Overlaps {
    std::map<Pair, std::uint32_t> common;
    std::map<Id, std::uint32_t> truth, found;

    Overlaps(const std::vector<Id>& of_truth, const std::vector<Id>& of_found) {
        for (std::size_t n = 0; n < of_truth.size(); ++n) {
            if (of_truth[n] < 0) continue;
            ++truth[of_truth[n]];
            if (of_found[n] < 0) continue;
            ++common[{of_truth[n], of_found[n]}];
        }
        for (const Id f : of_found) ++found[f];
    }
    // The true label that has most of each found one, and the other way round.
    std::map<Id, Id> owners() const { return largest(&Pair::second, &Pair::first); }
    std::map<Id, Id> matches() const { return largest(&Pair::first, &Pair::second); }

  private:
    std::map<Id, Id> largest(Id Pair::*of, Id Pair::*other) const {
        std::map<Id, Id> out;
        std::map<Id, std::uint32_t> most;
        for (const auto& [pair, count] : common) {
            if (count <= most[pair.*of]) continue;
            most[pair.*of] = count;
            out[pair.*of] = pair.*other;
        }
        return out;
    }
};

// Best IoU of a true object with a found one that `allowed` lets pass.
template <class Allowed>
double best_iou(const Overlaps& o, Id object, const Allowed& allowed) {
    double best = 0;
    for (auto k = o.common.lower_bound({object, -1}); k != o.common.end(); ++k) {
        if (k->first.first != object) break;
        if (!allowed(k->first.second)) continue;
        const double common = k->second;
        best = std::max(best, common / (o.truth.at(object) + o.found.at(k->first.second) - common));
    }
    return best;
}

class Judge {
  public:
    Judge(const scenes::World& world, const scenes::Scan& scan, const Scene& scene)
        : scene_(scene),
          fixed_(scenes::fixed_objects(world)),
          below_(scenes::supporters(world)),
          truth_(labels(scan, scene)),
          objects_(truth_, scene.points.object),
          primitives_(truth_, scene.points.primitive) {
        for (const Object& o : scene.objects) {
            if (o.grounded) grounded_.insert(o.id);
        }
        std::vector<double> seen(world.objects.size());
        for (const auto& p : scan.truth) seen[p.object] += scan.truth_m * scan.truth_m;
        for (std::size_t n = 1; n < fixed_.size(); ++n) {
            const auto id = static_cast<Id>(n);
            const auto points = objects_.truth.find(id);
            if (!fixed_[n] && !world.objects[n].pile && seen[n] >= least_seen_m2 &&
                points != objects_.truth.end() && points->second >= least_points)
                judged_.push_back(id);
        }
    }

    KindScore score() const {
        KindScore out;
        out.points = scene_.points.x.size();
        out.objects = judged_.size();
        if (!judged_.empty()) shares(out);
        joints(out);
        supports(out);
        for (const auto& [stage, seconds] : scene_.timings_s) out.parse_s += seconds;
        return out;
    }

  private:
    static std::vector<Id> labels(const scenes::Scan& scan, const Scene& scene) {
        const ScenePoints& p = scene.points;
        std::vector<Vec3> places(p.x.size());
        for (std::size_t n = 0; n < places.size(); ++n)
            places[n] = {p.x[n] + scene.offset_m[0], p.y[n] + scene.offset_m[1],
                         p.z[n] + scene.offset_m[2]};
        return scenes::nearest_objects(places, scan.truth, truth_reach_m);
    }
    bool is_grounded(Id found) const { return grounded_.contains(found); }
    // Everything that is fixed to the building is object 0; every grounded found object is -2.
    Id true_body(Id object) const { return fixed_[object] ? 0 : object; }
    Id found_body(Id object) const { return is_grounded(object) ? -2 : object; }

    void shares(KindScore& out) const {
        const auto owner = primitives_.owners();
        std::vector<Id> grouped = scene_.points.primitive;
        for (Id& p : grouped) {
            const auto own = owner.find(p);
            p = p < 0 || own == owner.end() ? -1 : own->second;
        }
        const Overlaps ideal(truth_, grouped);
        const auto any = [](Id) { return true; };
        double sum = 0;
        std::size_t found = 0, alone = 0, best = 0, points = 0, lost = 0;
        for (const Id object : judged_) {
            const double iou = best_iou(objects_, object, [&](Id f) { return !is_grounded(f); });
            sum += iou;
            found += iou > 0.5;
            alone += best_iou(primitives_, object, any) > 0.5;
            best += best_iou(ideal, object, any) > 0.5;
            points += objects_.truth.at(object);
            for (const Id f : grounded_) {
                const auto k = objects_.common.find({object, f});
                if (k != objects_.common.end()) lost += k->second;
            }
        }
        out.miou = sum / static_cast<double>(judged_.size());
        out.found = ratio(found, judged_.size());
        out.found_alone = ratio(alone, judged_.size());
        out.found_best = ratio(best, judged_.size());
        out.swallowed = ratio(lost, points);
    }

    void joints(KindScore& out) const {
        const auto owner = primitives_.owners();
        std::map<Id, Id> object_of;
        for (const Primitive& p : scene_.primitives) object_of[p.id] = p.object;
        std::size_t fixed = 0, joined = 0, both = 0;
        for (const Contact& c : scene_.contacts) {
            const auto a = owner.find(c.a), b = owner.find(c.b);
            if (a == owner.end() || b == owner.end()) continue;
            const bool truly = true_body(a->second) == true_body(b->second);
            const bool found = found_body(object_of[c.a]) == found_body(object_of[c.b]);
            fixed += truly;
            joined += found;
            both += truly && found;
        }
        out.joint_recall = ratio(both, fixed);
        out.joint_precision = ratio(both, joined);
    }

    void supports(KindScore& out) const {
        std::set<Pair> found, real;
        for (const Support& s : scene_.supports)
            found.insert({found_body(s.supporter), found_body(s.supported)});
        const auto match = objects_.matches();
        std::size_t hits = 0, of = 0;
        for (const Id object : judged_) {
            for (const Id s : below_[object]) {
                const auto points = objects_.truth.find(s);
                if (points == objects_.truth.end() || points->second < least_points) continue;
                ++of;
                const auto upper = match.find(object), lower = match.find(s);
                if (upper == match.end() || lower == match.end()) continue;
                const Id up = found_body(upper->second);
                const Id low = true_body(s) == 0 ? -2 : found_body(lower->second);
                hits += low != up && found.contains({low, up});
            }
        }
        for (std::size_t n = 1; n < below_.size(); ++n) {
            for (const Id s : below_[n]) real.insert({true_body(s), true_body(static_cast<Id>(n))});
        }
        const std::map<Id, Id> owner = objects_.owners();
        std::size_t right = 0, told = 0;
        const auto body = [&](Id f) -> std::optional<Id> {
            if (f == -2) return 0;
            const auto own = owner.find(f);
            if (own == owner.end()) return std::nullopt;
            return true_body(own->second);
        };
        for (const auto& [a, b] : found) {
            const auto low = body(a), up = body(b);
            if (!low || !up) continue;
            ++told;
            right += real.contains({*low, *up});
        }
        out.support_recall = ratio(hits, of);
        out.support_precision = ratio(right, told);
    }

    const Scene& scene_;
    std::vector<bool> fixed_;
    std::vector<std::vector<Id>> below_;
    std::vector<Id> truth_;
    Overlaps objects_, primitives_;
    std::set<Id> grounded_;
    std::vector<Id> judged_;
};

}  // namespace

KindScore judge_kind(const scenes::World& world, const scenes::Scan& scan, const Scene& scene) {
    return Judge(world, scan, scene).score();
}

ScannedKind::ScannedKind(const std::string& kind, const scenes::ScanOptions& options)
    : world(scenes::make_world(kind, options.seed)), scan(scenes::scan(world, options)) {
    scenes::write_scan(folder_.path(), world, scan, options, kind);
}

std::filesystem::path ScannedKind::input() const {
    return scan.frames.empty() ? folder_.path() / "cloud.ply" : folder_.path();
}

KindScore scan_and_judge(const std::string& kind, const scenes::ScanOptions& scan_options,
                         const ParseOptions& parse_options) {
    const ScannedKind room(kind, scan_options);
    KindScore out = judge_kind(room.world, room.scan, parse(room.input(), parse_options).scene);
    out.kind = kind;
    out.seed = scan_options.seed;
    return out;
}

}  // namespace topple::evaluation
