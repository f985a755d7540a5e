// SPDX-License-Identifier: MIT
#include "geometry/merge.h"

#include <algorithm>
#include <cmath>

#include "core/union_find.h"
#include "geometry/region_facts.h"

namespace topple::geometry {

namespace {

// Largest share of point pairs, one of each of two regions, that no convex solid has both on its
// surface. Not 0, since noise and rounded edges put some there. Set by hand.
constexpr double most_concavity = 0.12;

// Regions joined so far. The root of a set is its lowest region.
class Merger {
  public:
    Merger(const Surfels& surfels, const Vec3& up, const CutRegions& cuts, RegionFacts& facts)
        : s_(surfels),
          up_(up),
          cuts_(cuts),
          facts_(facts),
          r_(cuts.regions),
          sets_(r_.regions.size()),
          members_(r_.regions.size()) {
        for (std::size_t k = 0; k < members_.size(); ++k)
            members_[k].assign(1, static_cast<std::int32_t>(k));
    }

    void merge_all() {
        merge_level_pieces();
        merge_convex_borders();
        merge_face_pieces();
    }

    // The solid of each region: its root.
    std::vector<std::int32_t> solids() {
        std::vector<std::int32_t> out;
        for (std::size_t k = 0; k < members_.size(); ++k)
            out.push_back(root(static_cast<std::int32_t>(k)));
        return out;
    }

    PrimitiveSet result() {
        std::vector<std::uint64_t> size(members_.size(), 0);
        for (const std::int32_t label : r_.label)
            if (label >= 0) ++size[root(label)];
        std::vector<std::int32_t> order;
        for (std::size_t k = 0; k < size.size(); ++k)
            if (size[k] > 0) order.push_back(static_cast<std::int32_t>(k));
        std::stable_sort(order.begin(), order.end(),
                         [&](std::int32_t a, std::int32_t b) { return size[a] > size[b]; });
        PrimitiveSet out;
        out.faces = r_;
        out.ledges = cuts_.ledges;
        std::vector<std::int32_t> id(size.size(), -1);
        for (const std::int32_t k : order) {
            id[k] = static_cast<std::int32_t>(out.regions.size());
            auto regions = members_[k];
            std::sort(regions.begin(), regions.end());
            const bool single = regions.size() == 1;
            const int degree = r_.regions[k].model.degree;
            out.model.push_back(!single ? "merged" : degree == 1 ? "plane" : "quadric");
            out.regions.push_back(std::move(regions));
        }
        out.label.resize(r_.label.size(), -1);
        for (std::size_t i = 0; i < r_.label.size(); ++i)
            if (r_.label[i] >= 0) out.label[i] = id[root(r_.label[i])];
        return out;
    }

  private:
    void merge_convex_borders() {
        struct Candidate {
            double confidence;
            std::int32_t a, b;
        };
        std::vector<Candidate> candidates;
        for (const auto& [pair, border] : facts_.borders()) {
            const auto a = static_cast<std::size_t>(border.a),
                       b = static_cast<std::size_t>(border.b);
            if (border.length < least_border || border.inside_share <= least_inside_share ||
                cuts_.parted(a, b))
                continue;
            candidates.push_back(
                {border.inside_share * double(border.pairs.size()), border.a, border.b});
        }
        std::stable_sort(
            candidates.begin(), candidates.end(),
            [](const Candidate& x, const Candidate& y) { return x.confidence > y.confidence; });
        for (const Candidate& c : candidates) {
            const std::int32_t a = root(c.a), b = root(c.b);
            if (a != b && convex(a, b, most_concavity)) join(a, b);
        }
    }

    void merge_level_pieces() {
        for (const auto& [i, j] : find_level_pieces(s_, up_, r_, facts_.samples())) {
            const std::int32_t a = root(i), b = root(j);
            if (a != b) join(a, b);
        }
    }

    void merge_face_pieces() {
        for (const auto& [i, j] : facts_.face_pieces()) {
            const std::int32_t a = root(i), b = root(j);
            if (a != b && convex(a, b, most_concavity)) join(a, b);
        }
    }

    std::int32_t root(std::int32_t k) {
        return static_cast<std::int32_t>(sets_.root(static_cast<std::size_t>(k)));
    }

    void join(std::int32_t a, std::int32_t b) {
        if (b < a) std::swap(a, b);
        sets_.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
        auto& from = members_[b];
        auto& to = members_[a];
        std::vector<std::int32_t> both;
        std::merge(from.begin(), from.end(), to.begin(), to.end(), std::back_inserter(both),
                   [&](std::int32_t i, std::int32_t j) {
                       return surfels(i) != surfels(j) ? surfels(i) > surfels(j) : i < j;
                   });
        to = std::move(both);
        from.clear();
    }

    // Whether the merged set of two would have at most this concavity: the mean over pairs of
    // regions, each by its size. Large regions come first: they often settle it.
    bool convex(std::int32_t a, std::int32_t b, double most) {
        const auto &of_a = members_[a], &of_b = members_[b];
        const double all = surfels(of_a) * surfels(of_b);
        double sum = 0, left = all;
        facts_.threads().poll();
        for (const std::int32_t i : of_a)
            for (const std::int32_t j : of_b) {
                if (sum > most * all) return false;
                if (sum + left <= most * all) return true;
                const double weight = surfels(i) * surfels(j);
                sum += weight * facts_.concavity(i, j);
                left -= weight;
            }
        return sum <= most * all;
    }

    double surfels(std::int32_t k) const { return static_cast<double>(r_.regions[k].surfels); }
    double surfels(const std::vector<std::int32_t>& set) const {
        double sum = 0;
        for (const std::int32_t k : set) sum += surfels(k);
        return sum;
    }

    const Surfels& s_;
    Vec3 up_;
    const CutRegions& cuts_;
    RegionFacts& facts_;
    const Regions& r_;
    UnionFind sets_;
    std::vector<std::vector<std::int32_t>> members_;  // of each root, by falling size
};

}  // namespace

PrimitiveSet merge_convex(const Surfels& surfels, const Regions& regions, const Vec3& up,
                          const FreeSpace& free, ThreadPool& threads) {
    CutRegions cuts(regions);
    RegionFacts facts(surfels, cuts, free, threads);
    cut_flush_faces(surfels, up, {}, cuts, facts);
    // What the faces of a merged solid tell of one another may part some more.
    for (;;) {
        const std::uint32_t before = cuts.count;
        Merger merger(surfels, up, cuts, facts);
        merger.merge_all();
        cut_flush_faces(surfels, up, merger.solids(), cuts, facts);
        if (cuts.count > before) continue;
        if (cut_at_ledges(surfels, up, merger.solids(), cuts, facts, threads) == 0)
            return merger.result();
    }
}

}  // namespace topple::geometry
