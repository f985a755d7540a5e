// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
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
    struct Hash {
        std::size_t operator()(const GroupKey& k) const { return k.low; }
    };
};
std::vector<GroupKey> keys_of_nodes(std::int32_t nodes);

// Energies by group, asked for once each.
class EnergyCache {
  public:
    struct Missing {
        GroupKey key;
        GroupQuery query;
    };
    explicit EnergyCache(const GroupEnergies& energies) : energies_(energies) { known_[{}] = 0; }

    // From any threads, between calls of evaluate().
    std::optional<double> known(const GroupKey& key) const;
    const GroupEnergies& energies() const { return energies_; }
    std::uint64_t evaluated() const { return known_.size() - 1; }

    // In one batch.
    void evaluate(std::vector<Missing> wanted);

  private:
    const GroupEnergies& energies_;
    std::unordered_map<GroupKey, double, GroupKey::Hash> known_;
};

// What the energies of groups are at least, as one chain finds it out, bound by bound.
class LowerBounds {
  public:
    // Takes the bounds up to the nth one into account, or the energy itself where it is known.
    // `group` gives the query; it is not called for what is known.
    template <class Group>
    double at_least(const EnergyCache& cache, const GroupKey& key, std::size_t n,
                    const Group& group) {
        if (const auto energy = cache.known(key)) return *energy;
        Bound& bound = bounds_[key];
        if (bound.used > n) return bound.value;
        const GroupQuery query = group();
        for (; bound.used <= n; ++bound.used)
            bound.value = cache.energies().at_least[bound.used](query, bound.value);
        return bound.value;
    }

  private:
    struct Bound {
        double value = -std::numeric_limits<double>::infinity();
        std::size_t used = 0;
    };
    std::unordered_map<GroupKey, Bound, GroupKey::Hash> bounds_;
};

}  // namespace topple::graph
