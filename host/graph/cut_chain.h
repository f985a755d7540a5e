// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/random.h"
#include "graph/energy_cache.h"
#include "graph/stamped_set.h"
#include "graph/swendsen_wang.h"

namespace topple::graph {

// What a chain calls a group: its places stay when it is empty.
using LabelId = Id<struct Labels>;
inline constexpr LabelId pinned_label = 0;

// An edge as one of its nodes sees it.
struct Link {
    std::int32_t node;
    double turn_on, log_miss;  // q_e and ln(1 - q_e)
};

// The links of each node, those of one after those of the other.
struct Adjacency {
    Table<NodeId, std::size_t> first;
    std::vector<Link> links;

    Adjacency(std::int32_t nodes, std::span<const Edge> edges);
    std::span<const Link> of(NodeId n) const {
        return std::span(links).subspan(first[n], first[n + 1] - first[n]);
    }
};

// What all chains share.
struct CutProblem {
    Table<NodeId, bool> pinned;
    Adjacency adjacency;
    Table<NodeId, GroupKey> key;
    TableView<NodeId, std::vector<std::int32_t>> apart;  // see SwendsenWangOptions

    CutProblem(std::int32_t nodes, std::span<const Edge> all, Table<NodeId, bool> held,
               TableView<NodeId, std::vector<std::int32_t>> kept_apart = {})
        : pinned(std::move(held)),
          adjacency(nodes, all),
          key(keys_of_nodes(nodes)),
          apart(kept_apart) {}
};

// One Markov chain of Swendsen-Wang cuts. Where it needs energies that the cache lacks it waits:
// what it does is then false, and is to be done again once the cache has what is wanted().
class CutChain {
  public:
    // start: see SwendsenWangOptions.
    CutChain(const CutProblem& problem, const EnergyCache& energies, Random random,
             TableView<NodeId, std::int32_t> start = {});

    // Takes the energy of the start; before all steps.
    bool begin();
    // Proposes one flip and takes it or leaves it. Of the temperatures, those of the flips after it
    // serve to ask for energies ahead of time.
    using Temperatures = std::function<double(unsigned ahead)>;
    bool step(const Temperatures& temperature);
    const std::vector<EnergyCache::Missing>& wanted() const { return wanted_; }

    double energy() const { return energy_; }
    const std::vector<std::int32_t>& labels() const { return label_; }

  private:
    bool is_pinned(NodeId n) const { return problem_.pinned[n]; }
    LabelId label_of(NodeId n) const { return label_[n]; }
    GroupQuery group(LabelId l) const { return {members_[l], l == pinned_label}; }
    GroupQuery group_less_moved() const;
    GroupQuery group_with_moved() const;

    static constexpr unsigned most_ahead = 32, most_wanted = 16;
    bool propose(double temperature);
    bool draw();
    bool grow_component(NodeId seed);
    void sort_moved();
    void choose_target();
    bool target_is_allowed() const;
    bool stays_connected();
    bool reaches(NodeId start, bool shell);
    LabelId free_label();
    void group_by(TableView<NodeId, std::int32_t> start);
    double change(double from_after, double to_after) const;
    bool ruled_out(double most_change);
    void want(const GroupKey& key, GroupQuery group);
    void take();

    const CutProblem& problem_;
    const EnergyCache& energies_;
    LowerBounds bounds_;
    Random random_;
    Table<NodeId, std::int32_t> label_;
    Table<LabelId, Group> members_;
    Table<LabelId, GroupKey> key_;
    Table<LabelId, double> energy_of_label_;
    double energy_ = 0;
    // A group of two or more leaves a label free, and none other is asked for one.
    std::size_t lowest_free_ = 1;

    // The flip that is proposed, and the groups after it.
    std::vector<std::int32_t> moved_;
    LabelId from_ = 0, to_ = 0;
    double most_change_ = 0;    // of the energy, with which it is taken
    double log_cut_ratio_ = 0;  // ln of the products of (1 - q_e) in Eq. 11
    GroupKey from_key_, to_key_;
    double from_energy_ = 0, to_energy_ = 0;

    // Kept for their memory: what one proposal meets.
    StampedSet is_moved_, seen_, own_, seen_label_;
    std::vector<std::int32_t> targets_, border_, open_;
    Table<LabelId, double> log_miss_to_;
    std::vector<EnergyCache::Missing> wanted_;
};

}  // namespace topple::graph
