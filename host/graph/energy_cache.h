// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "graph/swendsen_wang.h"

namespace topple::graph {

// The name of a set of nodes: the exclusive or of random words, 128 bits for each node, so that
// moving nodes changes it by theirs alone, and two sets share one about never (2^-128 a pair).
struct GroupKey {
    std::uint64_t low = 0, high = 0;
    GroupKey& operator^=(const GroupKey& other) {
        low ^= other.low;
        high ^= other.high;
        return *this;
    }
    bool operator==(const GroupKey&) const = default;
};
std::vector<GroupKey> keys_of_nodes(std::int32_t nodes);

// Energies by group, asked for once each, by several threads. One of them evaluates at a time, what
// it and others asked for meanwhile.
class EnergyCache {
  public:
    struct Missing {
        GroupKey key;
        GroupQuery query;
    };
    explicit EnergyCache(const GroupEnergies& energies);

    std::size_t bounds() const { return energies_.at_least.size(); }

    // Takes the bounds up to the nth one into account, or the energy itself where it is known.
    // `group` gives the query; it is not called for what is known.
    template <class Group>
    double at_least(const GroupKey& key, std::size_t n, const Group& group) {
        Entry entry = copy(key);
        if (entry.exact || entry.bounds > n) return entry.value;
        const GroupQuery query = group();
        for (; entry.bounds <= n; ++entry.bounds)
            entry.value = energies_.at_least[entry.bounds](query, entry.value);
        return raise(key, entry);
    }
    std::optional<double> known(const GroupKey& key);

    // Blocks until all of them are known. Throws what the energies throw, to all that wait.
    void fetch(std::vector<Missing>& missing);

    std::uint64_t evaluated() const { return evaluated_; }

  private:
    struct Entry {
        double value = -std::numeric_limits<double>::infinity();  // or a lower bound
        std::size_t bounds = 0;                                   // that went into it
        bool exact = false, asked = false;
    };
    struct Hash {
        std::size_t operator()(const GroupKey& k) const { return k.low; }
    };
    Entry copy(const GroupKey& key);
    double raise(const GroupKey& key, const Entry& bound);
    void await(std::vector<Missing>& missing, std::unique_lock<std::mutex>& lock);
    void evaluate(std::unique_lock<std::mutex>& lock);

    const GroupEnergies& energies_;
    std::mutex mutex_;  // of all below
    std::condition_variable evaluated_some_;
    std::unordered_map<GroupKey, Entry, Hash> known_;
    std::vector<Missing> wanted_;
    bool evaluating_ = false;
    std::uint64_t evaluated_ = 0;
    std::exception_ptr failure_;
};

}  // namespace topple::graph
