// SPDX-License-Identifier: MIT
#include "graph/swendsen_wang.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <thread>

#include "core/random.h"
#include "core/thread_pool.h"
#include "graph/cut_chain.h"
#include "graph/energy_cache.h"

namespace topple::graph {
namespace {

using Clock = std::chrono::steady_clock;

// What one chain came to.
struct Outcome {
    std::vector<std::int32_t> best_labels;
    double best_energy = std::numeric_limits<double>::infinity();
    std::vector<double> best_energy_curve;
};

// How far a chain is with its annealing, 0 to 1, by its steps, or by its time where that is short.
class Schedule {
  public:
    explicit Schedule(const SwendsenWangOptions& options) : options_(options) {}

    double at(unsigned step) const {
        const double by_steps = step / static_cast<double>(options_.anneal_steps);
        if (options_.time_limit_s <= 0) return by_steps;
        const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
        return std::max(by_steps, elapsed / options_.time_limit_s);
    }
    double temperature(double along) const {
        return options_.first_temperature *
               std::pow(options_.last_temperature / options_.first_temperature, along);
    }

  private:
    const SwendsenWangOptions& options_;
    Clock::time_point start_ = Clock::now();
};

// A chain on its way.
class Run {
  public:
    Run(const CutProblem& problem, const EnergyCache& cache, std::size_t number,
        const SwendsenWangOptions& options)
        : options_(options),
          schedule_(options),
          chain_(problem, cache, Random(options.seed).split(number), start_of(number, options)) {}

    // Until it is done, or waits for energies: whether it does that.
    bool waits(const std::function<bool()>& stopped) {
        if (!begun_) {
            if (!chain_.begin()) return true;
            begun_ = true;
            out_.best_labels = chain_.labels();
            out_.best_energy = chain_.energy();
        }
        for (; step_ < options_.anneal_steps; ++step_) {
            if (schedule_.at(step_) >= 1 || stopped()) break;
            const auto temperature = [this](unsigned ahead) {
                return schedule_.temperature(schedule_.at(step_ + ahead));
            };
            if (!chain_.step(temperature)) return true;
            // A margin, so that rounding in the running sum is not taken for an improvement.
            if (chain_.energy() < out_.best_energy - 1e-9) {
                out_.best_energy = chain_.energy();
                out_.best_labels = chain_.labels();
            }
            out_.best_energy_curve.push_back(out_.best_energy);
        }
        return false;
    }
    const std::vector<EnergyCache::Missing>& wanted() const { return chain_.wanted(); }

    Outcome outcome() && { return std::move(out_); }

  private:
    static TableView<NodeId, std::int32_t> start_of(std::size_t number,
                                                    const SwendsenWangOptions& options) {
        if (options.starts.empty()) return {};
        return options.starts[number % options.starts.size()];
    }
    const SwendsenWangOptions& options_;
    Schedule schedule_;
    CutChain chain_;
    Outcome out_;
    bool begun_ = false;
    unsigned step_ = 0;
};

std::vector<std::int32_t> canonical(const std::vector<std::int32_t>& labels) {
    std::map<std::int32_t, std::int32_t> number{{pinned_label, -1}};
    std::vector<std::int32_t> out;
    std::int32_t next = 0;
    for (const std::int32_t l : labels) {
        const auto [at, fresh] = number.try_emplace(l, next);
        if (fresh) ++next;
        out.push_back(at->second);
    }
    return out;
}

// The best of each step over all chains; one that was stopped keeps what it had.
std::vector<double> best_of(const std::vector<Outcome>& chains) {
    std::vector<double> curve;
    for (const Outcome& c : chains) {
        if (c.best_energy_curve.size() > curve.size())
            curve.resize(c.best_energy_curve.size(), std::numeric_limits<double>::infinity());
    }
    for (const Outcome& c : chains) {
        for (std::size_t i = 0; i < curve.size() && !c.best_energy_curve.empty(); ++i)
            curve[i] = std::min(curve[i],
                                c.best_energy_curve[std::min(i, c.best_energy_curve.size() - 1)]);
    }
    return curve;
}

Partition combined(const std::vector<Outcome>& chains) {
    Partition result;
    const Outcome* best = &chains.front();
    for (const Outcome& c : chains)
        if (c.best_energy < best->best_energy - 1e-9) best = &c;
    result.label = canonical(best->best_labels);
    result.energy = best->best_energy;
    result.best_energy_curve = best_of(chains);
    return result;
}

}  // namespace

Partition swendsen_wang_cuts(std::int32_t nodes, std::span<const Edge> edges,
                             const Table<NodeId, bool>& pinned, const GroupEnergies& energies,
                             const SwendsenWangOptions& options) {
    if (nodes == 0) return {};
    const CutProblem problem(nodes, edges, pinned, options.apart);
    EnergyCache cache(energies);
    std::atomic<bool> cancelled = false;
    const auto here = std::this_thread::get_id();
    const auto stopped = [&] {
        // The caller's function is called from the caller's thread alone.
        if (std::this_thread::get_id() == here && options.cancelled && options.cancelled())
            cancelled = true;
        return cancelled.load();
    };
    std::deque<Run> runs;
    std::vector<std::size_t> open(std::max(1u, options.chains));
    std::iota(open.begin(), open.end(), std::size_t{0});
    for (const std::size_t c : open) runs.emplace_back(problem, cache, c, options);
    ThreadPool alone(1);
    ThreadPool& threads = options.threads ? *options.threads : alone;
    std::vector<std::uint8_t> waits(runs.size());
    while (!open.empty()) {
        threads.each(open.size(), 1,
                     [&](std::size_t n) { waits[open[n]] = runs[open[n]].waits(stopped); });
        std::erase_if(open, [&](std::size_t c) { return !waits[c]; });
        std::vector<EnergyCache::Missing> wanted;
        for (const std::size_t c : open)
            wanted.insert(wanted.end(), runs[c].wanted().begin(), runs[c].wanted().end());
        if (!wanted.empty()) cache.evaluate(std::move(wanted));
    }
    std::vector<Outcome> outcomes;
    for (Run& run : runs) outcomes.push_back(std::move(run).outcome());
    Partition result = combined(outcomes);
    result.energies_evaluated = cache.evaluated();
    return result;
}

}  // namespace topple::graph
