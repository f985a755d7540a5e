// SPDX-License-Identifier: MIT
#include "graph/energy_cache.h"

#include <algorithm>

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

EnergyCache::EnergyCache(const GroupEnergies& energies) : energies_(energies) {
    Entry& no_node = known_[{}];
    no_node.value = 0;
    no_node.exact = true;
}

EnergyCache::Entry EnergyCache::copy(const GroupKey& key) {
    const std::lock_guard lock(mutex_);
    return known_[key];
}

double EnergyCache::raise(const GroupKey& key, const Entry& bound) {
    const std::lock_guard lock(mutex_);
    Entry& entry = known_[key];
    if (!entry.exact && entry.bounds < bound.bounds) {
        entry.value = bound.value;
        entry.bounds = bound.bounds;
    }
    return entry.value;
}

std::optional<double> EnergyCache::known(const GroupKey& key) {
    const Entry entry = copy(key);
    return entry.exact ? std::optional(entry.value) : std::nullopt;
}

void EnergyCache::fetch(std::vector<Missing>& missing) {
    std::unique_lock lock(mutex_);
    try {
        await(missing, lock);
    } catch (...) {
        // Others may wait for what this thread was to evaluate, and never will.
        if (!lock.owns_lock()) lock.lock();
        if (!failure_) failure_ = std::current_exception();
        evaluated_some_.notify_all();
        throw;
    }
    if (failure_) std::rethrow_exception(failure_);
}

void EnergyCache::await(std::vector<Missing>& missing, std::unique_lock<std::mutex>& lock) {
    std::vector<GroupKey> mine;
    for (Missing& m : missing) {
        Entry& entry = known_[m.key];
        if (entry.exact) continue;
        mine.push_back(m.key);
        if (std::exchange(entry.asked, true)) continue;
        wanted_.push_back(std::move(m));
    }
    const auto all_known = [&] {
        return std::ranges::all_of(mine, [&](const GroupKey& k) { return known_[k].exact; });
    };
    while (!failure_ && !all_known()) {
        if (evaluating_)
            evaluated_some_.wait(lock);
        else
            evaluate(lock);
    }
}

void EnergyCache::evaluate(std::unique_lock<std::mutex>& lock) {
    std::vector<GroupKey> keys;
    std::vector<GroupQuery> queries;
    for (Missing& m : wanted_) {
        keys.push_back(m.key);
        queries.push_back(std::move(m.query));
    }
    std::vector<double> values(queries.size());
    wanted_.clear();
    evaluating_ = true;
    lock.unlock();
    std::exception_ptr failure;
    try {
        energies_.of(queries, values);
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    evaluating_ = false;
    if (failure) std::rethrow_exception(failure);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        Entry& entry = known_[keys[i]];
        entry.value = values[i];
        entry.exact = true;
    }
    evaluated_ += keys.size();
    evaluated_some_.notify_all();
}

}  // namespace topple::graph
