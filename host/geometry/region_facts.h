// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/thread_pool.h"
#include "geometry/merge.h"

namespace topple::geometry {

// What merging asks of regions and of pairs of them. Each answer is found once and again only after
// a cut changed one of its regions: a scene is merged and cut by turns until no cut is left.
class RegionFacts {
  public:
    using Pair = std::pair<std::int32_t, std::int32_t>;  // lower region first

    // Keeps references to all arguments.
    RegionFacts(const Surfels& surfels, const CutRegions& cuts, const FreeSpace& free,
                ThreadPool& threads);

    // To be told after these regions changed; new regions count.
    void update(const std::vector<std::int32_t>& changed);

    const std::vector<RegionSamples>& samples() const { return samples_; }
    // All pairs of regions that touch.
    const std::map<Pair, Border>& borders() const { return borders_; }
    // The regions that touch region k, ascending.
    const std::set<std::int32_t>& touching(std::size_t k) const { return touching_[k]; }
    const Border& border(std::int32_t a, std::int32_t b) const {
        return borders_.at(std::minmax(a, b));
    }
    // For what works on many regions to poll.
    ThreadPool& threads() const { return threads_; }
    // Pairs of planes that are pieces of one face (are_face_pieces()).
    const std::set<Pair>& face_pieces() const { return face_pieces_; }
    // Share of point pairs that no convex solid has both on its surface; 1 where a cut parts the
    // regions.
    double concavity(std::int32_t a, std::int32_t b);

  private:
    void forget(std::int32_t k);
    void find_borders(const std::vector<std::int32_t>& changed);
    void find_face_pieces(const std::vector<std::int32_t>& changed);

    const Surfels& s_;
    const CutRegions& cuts_;
    const FreeSpace& free_;
    ThreadPool& threads_;
    std::vector<RegionSamples> samples_;
    std::vector<Eigen::AlignedBox3d> box_;
    std::vector<std::set<std::int32_t>> touching_;
    std::map<Pair, Border> borders_;
    std::set<Pair> face_pieces_;
    std::map<Pair, double> concavity_;
};

}  // namespace topple::geometry
