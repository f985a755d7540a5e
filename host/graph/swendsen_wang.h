// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/table.h"
#include "core/thread_pool.h"

// Swendsen-Wang cuts over partitions of a graph (Barbu and Zhu 2005; paper, 4.3, Algorithm 1).
namespace topple::graph {

using NodeId = Id<struct Nodes>;

struct Edge {
    std::int32_t a = -1, b = -1;
    double turn_on = 0.5;  // q_e in (0, 1): how readily the sampler moves both ends together
};

// A group of nodes, ascending.
using Group = std::vector<std::int32_t>;

// Energies of groups that hold no pinned node, or (`pinned` true) of the one that holds them all.
// The energy of a partition is the sum over its groups.
struct GroupQuery {
    Group nodes;
    bool pinned = false;
};
// `of` is called by the sampler's thread, with what all chains want at a time; the bounds by
// several at once.
struct GroupEnergies {
    std::function<void(std::span<const GroupQuery>, std::span<double>)> of;
    // What a group's energy is at least, by ways that cost ever more and tell ever more, each given
    // what the one before it said (-infinity: none before): flips that these rule out need no
    // energy. May be empty. Does not change the outcome.
    std::vector<std::function<double(const GroupQuery&, double)>> at_least;
};

struct SwendsenWangOptions {
    std::uint64_t seed = 1;
    unsigned chains = 8;             // independent
    ThreadPool* threads = nullptr;   // that the chains share; the result does not depend on them
    unsigned anneal_steps = 2000;    // flips per chain while cooling
    double first_temperature = 1.0;  // of p ~ exp(-E / T)
    double last_temperature = 0.05;
    // Seconds for all, about; annealing is sped up to fit. 0: as long as it takes. A limit that is
    // met makes the result depend on the machine.
    double time_limit_s = 0;
    // Partitions that the chains start from in turn: nodes of one group have one label, pinned
    // nodes share theirs. An empty one, or none at all: each node on its own.
    std::vector<Table<NodeId, std::int32_t>> starts;
    // Of each node those that no group may hold beside it; empty: there are none. Symmetric, not of
    // two pinned nodes, and starts keep to it. Flips that would break it are not proposed.
    Table<NodeId, std::vector<std::int32_t>> apart;
    std::function<bool()> cancelled;  // polled between steps by the caller's thread; may be empty
};

struct Partition {
    Table<NodeId, std::int32_t> label;  // its group, numbered by first appearance;
                                        // the pinned group, where there is one, is -1
    double energy = 0;
    std::vector<double> best_energy_curve;  // after every step, over all chains
    std::uint64_t energies_evaluated = 0;   // groups asked for
};

// Returns the best partition seen, which is no worse than any start. A flip moves one connected
// component of turned-on edges to the group of one of its neighbours, or to a fresh group; it is
// accepted with the probability of Barbu and Zhu's Theorem 1 (paper, Eq. 11). Deterministic.
Partition swendsen_wang_cuts(std::int32_t nodes, std::span<const Edge> edges,
                             const Table<NodeId, bool>& pinned, const GroupEnergies& energies,
                             const SwendsenWangOptions& options);

}  // namespace topple::graph
