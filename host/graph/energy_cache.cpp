// SPDX-License-Identifier: MIT
#include "graph/energy_cache.h"

#include <utility>

#include "core/random.h"

namespace topple::graph {

std::vector<GroupKey> keys_of_nodes(std::int32_t nodes) {
    Random random(0);
    std::vector<GroupKey> keys(static_cast<std::size_t>(nodes));
    for (GroupKey& k : keys) {
        k.low = random.bits();
        k.high = random.bits();
    }
    return keys;
}

std::optional<double> EnergyCache::known(const GroupKey& key) const {
    const auto at = known_.find(key);
    return at == known_.end() ? std::nullopt : std::optional(at->second);
}

void EnergyCache::evaluate(std::vector<Missing> wanted) {
    std::vector<GroupQuery> queries;
    std::vector<double*> to;  // a map's values stay where they are
    for (Missing& m : wanted) {
        const auto [at, fresh] = known_.try_emplace(m.key);
        if (!fresh) continue;
        queries.push_back(std::move(m.query));
        to.push_back(&at->second);
    }
    std::vector<double> values(queries.size());
    energies_.of(queries, values);
    for (std::size_t n = 0; n < to.size(); ++n) *to[n] = values[n];
}

}  // namespace topple::graph
