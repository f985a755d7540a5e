// SPDX-License-Identifier: MIT
#include "geometry/merge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace topple::geometry {

namespace {

// Regions joined so far. The root of a set is its lowest region.
class Merger {
  public:
    Merger(const Surfels& surfels, const FlushCuts& cuts, const FreeSpace& free,
           const MergeOptions& options)
        : s_(surfels),
          cuts_(cuts),
          free_(free),
          r_(cuts.regions),
          options_(options),
          samples_(sample_regions(surfels, r_, options)),
          parent_(r_.regions.size()),
          members_(r_.regions.size()) {
        std::iota(parent_.begin(), parent_.end(), 0);
        for (std::size_t k = 0; k < members_.size(); ++k)
            members_[k].assign(1, static_cast<std::int32_t>(k));
    }

    void merge_all() {
        merge_wall_pieces();
        merge_convex_borders();
        merge_face_pieces();
        merge_sides();
    }

    // The solid of each region: its root.
    std::vector<std::int32_t> solids() {
        std::vector<std::int32_t> out;
        for (std::size_t k = 0; k < parent_.size(); ++k)
            out.push_back(root(static_cast<std::int32_t>(k)));
        return out;
    }

    PrimitiveSet result() {
        std::vector<std::uint64_t> size(parent_.size(), 0);
        for (const std::int32_t label : r_.label)
            if (label >= 0) ++size[static_cast<std::size_t>(root(label))];
        std::vector<std::int32_t> order;
        for (std::size_t k = 0; k < size.size(); ++k)
            if (size[k] > 0) order.push_back(static_cast<std::int32_t>(k));
        std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
            return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)];
        });
        PrimitiveSet out;
        std::vector<std::int32_t> id(size.size(), -1);
        for (const std::int32_t k : order) {
            id[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(out.regions.size());
            auto regions = members_[static_cast<std::size_t>(k)];
            std::sort(regions.begin(), regions.end());
            const bool single = regions.size() == 1;
            const int degree = r_.regions[static_cast<std::size_t>(k)].model.degree;
            out.model.push_back(!single ? "merged" : degree == 1 ? "plane" : "quadric");
            out.regions.push_back(std::move(regions));
        }
        out.label.resize(r_.label.size(), -1);
        for (std::size_t i = 0; i < r_.label.size(); ++i)
            if (r_.label[i] >= 0) out.label[i] = id[static_cast<std::size_t>(root(r_.label[i]))];
        return out;
    }

  private:
    void merge_convex_borders() {
        struct Candidate {
            double confidence;
            std::int32_t a, b;
        };
        std::vector<Candidate> candidates;
        for (const Border& border : find_borders(s_, r_)) {
            const auto a = static_cast<std::size_t>(border.a),
                       b = static_cast<std::size_t>(border.b);
            const auto smaller = std::min(r_.regions[a].surfels, r_.regions[b].surfels);
            const double side = std::sqrt(static_cast<double>(smaller));
            const double length = static_cast<double>(border.pairs.size()) / side;
            if (length < options_.border_share) continue;
            if (cuts_.parted(a, b)) continue;
            const double share = inside_share(
                s_, r_, border, {samples_[a].tolerance_m, samples_[b].tolerance_m}, options_);
            if (share <= options_.delta2) continue;
            candidates.push_back({share * double(border.pairs.size()), border.a, border.b});
        }
        std::stable_sort(
            candidates.begin(), candidates.end(),
            [](const Candidate& x, const Candidate& y) { return x.confidence > y.confidence; });
        for (const Candidate& c : candidates) {
            const std::int32_t a = root(c.a), b = root(c.b);
            if (a != b && set_concavity(a, b) <= options_.concavity_max) join(a, b);
        }
    }

    // The two sides of a board often have no visible edge between them.
    void merge_sides() {
        for (const Sides& pair : find_sides(s_, r_, samples_, options_)) {
            const std::int32_t a = root(pair.a), b = root(pair.b);
            if (a != b && set_concavity(a, b) <= options_.board_concavity_max) join(a, b);
        }
    }

    void merge_wall_pieces() {
        for (const auto& [i, j] : find_wall_pieces(s_, r_, samples_, options_)) {
            const std::int32_t a = root(i), b = root(j);
            if (a != b) join(a, b);
        }
    }

    void merge_face_pieces() {
        for (const auto& [i, j] : find_face_pieces(s_, r_, samples_, options_)) {
            const std::int32_t a = root(i), b = root(j);
            if (a != b && set_concavity(a, b) <= options_.concavity_max) join(a, b);
        }
    }

    std::int32_t root(std::int32_t k) {
        while (parent_[static_cast<std::size_t>(k)] != k) {
            auto& up = parent_[static_cast<std::size_t>(k)];
            up = parent_[static_cast<std::size_t>(up)];
            k = up;
        }
        return k;
    }

    void join(std::int32_t a, std::int32_t b) {
        if (b < a) std::swap(a, b);
        parent_[static_cast<std::size_t>(b)] = a;
        auto& from = members_[static_cast<std::size_t>(b)];
        auto& to = members_[static_cast<std::size_t>(a)];
        to.insert(to.end(), from.begin(), from.end());
        from.clear();
    }

    double region_concavity(std::int32_t a, std::int32_t b) {
        const auto key = std::minmax(a, b);
        const auto [at, fresh] = concavity_.try_emplace(key, 0.0);
        if (fresh) {
            const auto i = static_cast<std::size_t>(key.first),
                       j = static_cast<std::size_t>(key.second);
            at->second = cuts_.parted(i, j) ? 1 : concavity(samples_[i], samples_[j], free_);
        }
        return at->second;
    }

    // The merged set's concavity: mean over pairs of regions, each by its size.
    double set_concavity(std::int32_t a, std::int32_t b) {
        double sum = 0, weight = 0;
        for (const std::int32_t i : members_[static_cast<std::size_t>(a)])
            for (const std::int32_t j : members_[static_cast<std::size_t>(b)]) {
                const double w =
                    static_cast<double>(r_.regions[static_cast<std::size_t>(i)].surfels) *
                    static_cast<double>(r_.regions[static_cast<std::size_t>(j)].surfels);
                sum += w * region_concavity(i, j);
                weight += w;
            }
        return weight > 0 ? sum / weight : 0;
    }

    const Surfels& s_;
    const FlushCuts& cuts_;
    const FreeSpace& free_;
    const Regions& r_;
    const MergeOptions& options_;
    std::vector<RegionSamples> samples_;
    std::vector<std::int32_t> parent_;
    std::vector<std::vector<std::int32_t>> members_;
    std::map<std::pair<std::int32_t, std::int32_t>, double> concavity_;
};

}  // namespace

PrimitiveSet merge_convex(const Surfels& surfels, const Regions& regions, const Vec3& up,
                          const FreeSpace& free) {
    const MergeOptions options;
    FlushCuts cuts;
    cuts.regions = regions;
    cut_flush_faces(surfels, up, {}, options, cuts);
    // What the faces of a merged solid tell of one another may part some more.
    for (;;) {
        const std::uint32_t before = cuts.count;
        Merger merger(surfels, cuts, free, options);
        merger.merge_all();
        cut_flush_faces(surfels, up, merger.solids(), options, cuts);
        if (cuts.count == before) return merger.result();
    }
}

}  // namespace topple::geometry
