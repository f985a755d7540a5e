// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

#include "geometry/algebraic_model.h"
#include "geometry/face_limits.h"
#include "geometry/split.h"

namespace topple::geometry {

namespace {

// Misfits (below) are in what growing allows: 1 is its bound. All of these are set by hand.
constexpr double leftover_reach = 2;  // of distance alone, within which a leftover joins a model
constexpr double absorbed_misfit = 1.25;  // mean over a small region that a neighbour takes
constexpr double most_misfit = 4;         // so that a stray counts no more than its neighbours do
constexpr double angle_weight = 0.5;      // of the normal's misfit beside the distance's
// Surfels under which a region may be taken by a neighbour: some of the least regions.
constexpr std::uint32_t absorbed_below = 5 * least_region;
// The smoothing of borders: what all neighbours that agree count against a misfit, and how often it
// is done.
constexpr double neighbour_vote = 2;
constexpr int smoothing_passes = 3;
constexpr std::uint64_t cleanup_chunk = 1 << 13;  // surfels handed to a thread at once

class Cleaner {
  public:
    Cleaner(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads, Regions& regions)
        : s_(surfels), scale_(scale), threads_(threads), r_(regions) {}

    void run() {
        hand_out(leftover_reach);
        make_regions_of_leftovers();
        refit_regions(s_, scale_, threads_, r_);
        absorb_small();
        smooth_borders();
        refit_regions(s_, scale_, threads_, r_);
    }

  private:
    const AlgebraicModel& model(std::int32_t label) const { return r_.regions[label].model; }

    // How badly a model explains a surfel: distance in tolerances, plus the angle where it is
    // beyond what noise explains. 1 is the bound of growing.
    double misfit(std::int32_t label, std::uint32_t i) const {
        const Eigen::Vector3d p = position(s_, i);
        const double d = std::abs(distance(model(label), p)) / scale_.tolerance_m[i];
        const Eigen::Vector3d g = gradient(model(label), p);
        const double length = g.norm();
        const double c = length > 0 ? normal(s_, i).dot(g) / length : 0;
        return d + angle_weight * std::acos(std::clamp(c, -1.0, 1.0)) / scale_.angle_rad;
    }

    // Surfels without a region go to adjacent regions, best fits first, so that a border between
    // two regions comes to lie where their models meet.
    void hand_out(double reach) {
        using Offer = std::tuple<double, std::uint32_t, std::int32_t>;
        std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
        const auto offer_around = [&](std::uint32_t i) {
            for (const std::uint32_t j : s_.around(i)) {
                if (r_.label[j] >= 0) continue;
                const double d = std::abs(distance(model(r_.label[i]), position(s_, j)));
                if (d > reach * scale_.tolerance_m[j]) continue;
                offers.emplace(misfit(r_.label[i], j), j, r_.label[i]);
            }
        };
        for (std::uint32_t i = 0; i < s_.size(); ++i)
            if (r_.label[i] >= 0) offer_around(i);
        while (!offers.empty()) {
            const auto [cost, i, label] = offers.top();
            offers.pop();
            if (r_.label[i] >= 0) continue;
            r_.label[i] = label;
            offer_around(i);
        }
    }

    // What no model reaches: connected pieces become regions of their own, crumbs join a neighbour.
    void make_regions_of_leftovers() {
        std::vector<std::uint32_t> piece;
        std::vector<bool> seen(s_.size(), false);
        for (std::uint32_t first = 0; first < s_.size(); ++first) {
            if (r_.label[first] >= 0 || seen[first]) continue;
            piece.assign(1, first);
            seen[first] = true;
            std::map<std::int32_t, std::uint32_t> touches;
            for (std::size_t head = 0; head < piece.size(); ++head) {
                const std::uint32_t i = piece[head];
                for (const std::uint32_t j : s_.around(i)) {
                    if (r_.label[j] >= 0) {
                        ++touches[r_.label[j]];
                    } else if (!seen[j]) {
                        seen[j] = true;
                        piece.push_back(j);
                    }
                }
            }
            place(piece, touches);
        }
    }

    void place(const std::vector<std::uint32_t>& piece,
               const std::map<std::int32_t, std::uint32_t>& touches) {
        std::int32_t label = -1;
        if (piece.size() >= least_region) {
            label = static_cast<std::int32_t>(r_.regions.size());
            Region region;
            region.model.degree = 2;
            r_.regions.push_back(region);
        } else {
            std::uint32_t most = 0;
            for (const auto& [other, count] : touches)
                if (count > most) most = count, label = other;
        }
        for (const std::uint32_t i : piece) r_.label[i] = label;
    }

    // Small regions that a neighbour's model explains as a whole join it.
    void absorb_small() {
        std::vector<std::vector<std::uint32_t>> members(r_.regions.size());
        for (std::uint32_t i = 0; i < s_.size(); ++i)
            if (r_.label[i] >= 0) members[r_.label[i]].push_back(i);
        std::vector<std::int32_t> order;
        for (std::size_t k = 0; k < members.size(); ++k)
            if (members[k].size() < absorbed_below) order.push_back(static_cast<std::int32_t>(k));
        std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
            return members[std::size_t(a)].size() < members[std::size_t(b)].size();
        });
        for (const std::int32_t k : order) {
            auto& mine = members[k];
            std::map<std::int32_t, std::uint32_t> touches;
            for (const std::uint32_t i : mine)
                for (const std::uint32_t j : s_.around(i)) {
                    const std::int32_t other = r_.label[j];
                    if (other >= 0 && other != k) ++touches[other];
                }
            std::int32_t best = -1;
            double best_cost = absorbed_misfit;
            for (const auto& [other, count] : touches) {
                double cost = 0;
                for (const std::uint32_t i : mine) cost += misfit(other, i);
                cost /= static_cast<double>(mine.size());
                if (cost < best_cost) best_cost = cost, best = other;
            }
            if (best < 0) continue;
            auto& theirs = members[best];
            for (const std::uint32_t i : mine) r_.label[i] = best;
            theirs.insert(theirs.end(), mine.begin(), mine.end());
            mine.clear();
        }
    }

    // Each surfel at a border takes the label that fits best given its neighbours, all at once.
    void smooth_borders() {
        std::vector<std::int32_t> next(r_.label.size());
        for (int pass = 0; pass < smoothing_passes; ++pass) {
            threads_.each(s_.size(), cleanup_chunk, [&](std::size_t i) {
                next[i] = smoothed_label(static_cast<std::uint32_t>(i));
            });
            r_.label.swap(next);
        }
    }

    std::int32_t smoothed_label(std::uint32_t i) const {
        std::array<std::pair<std::int32_t, int>, 26> votes;  // label, neighbours that have it
        std::size_t labels = 0;
        for (const std::uint32_t j : s_.around(i)) {
            const std::int32_t label = r_.label[j];
            if (label < 0) continue;
            std::size_t at = 0;
            while (at < labels && votes[at].first != label) ++at;
            if (at == labels) votes[labels++] = {label, 0};
            ++votes[at].second;
        }
        std::int32_t chosen = r_.label[i];
        if (labels == 0 || (labels == 1 && votes[0].first == chosen)) return chosen;
        std::sort(votes.begin(), votes.begin() + static_cast<std::ptrdiff_t>(labels));
        double best = 1e9;
        for (std::size_t k = 0; k < labels; ++k) {
            const auto [label, count] = votes[k];
            const double cost = std::min(misfit(label, i), most_misfit) -
                                neighbour_vote * count / static_cast<double>(s_.around(i).size());
            if (cost < best) best = cost, chosen = label;
        }
        return chosen;
    }

    const Surfels& s_;
    const SplitScale& scale_;
    ThreadPool& threads_;
    Regions& r_;
};

}  // namespace

void clean_regions(const Surfels& surfels, const SplitScale& scale, ThreadPool& threads,
                   Regions& regions) {
    Cleaner(surfels, scale, threads, regions).run();
}

}  // namespace topple::geometry
