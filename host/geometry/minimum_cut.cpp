// SPDX-License-Identifier: MIT
#include "geometry/minimum_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::geometry {
namespace {

constexpr double steps = 1e6;
constexpr std::uint32_t unreached = std::numeric_limits<std::uint32_t>::max();
// Levels are made exact when as many arcs were looked at as the graph has, so many times.
constexpr std::size_t lifts_between = 4;

std::int64_t in_steps(double cost) {
    return std::llround(steps * cost);
}

}  // namespace

MinimumCut::MinimumCut(std::size_t nodes, std::span<const CutEdge> edges)
    : first_(nodes + 1, 0),
      around_(nodes, 0),
      excess_(nodes),
      room_(nodes),
      is_sink_(nodes),
      level_(nodes),
      next_(nodes) {
    for (const CutEdge& e : edges) {
        ++first_[e.a + 1];
        ++first_[e.b + 1];
    }
    for (std::size_t n = 0; n < nodes; ++n) first_[n + 1] += first_[n];
    arcs_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const CutEdge& e : edges) {
        const std::uint32_t there = next[e.a]++, back = next[e.b]++;
        const std::int64_t capacity = in_steps(e.weight);
        arcs_[there] = {e.b, back, capacity};
        arcs_[back] = {e.a, there, capacity};
        around_[e.a] += capacity;
        around_[e.b] += capacity;
    }
    capacity_.reserve(arcs_.size());
    for (const Arc& arc : arcs_) capacity_.push_back(arc.rest);
}

std::vector<bool> MinimumCut::part(std::span<const CutNode> nodes) {
    supply(nodes);
    while (find_levels()) push_all();
    std::vector<bool> inside(level_.size());
    for (std::size_t n = 0; n < inside.size(); ++n) inside[n] = level_[n] != unreached;
    return inside;
}

// What the sinks have goes to their nodes; and on to all neighbours from those that have more than
// these could take, which have nothing to do with the rest.
void MinimumCut::supply(std::span<const CutNode> nodes) {
    for (std::size_t arc = 0; arc < arcs_.size(); ++arc) arcs_[arc].rest = capacity_[arc];
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::int64_t more = in_steps(nodes[n].from_sink) - in_steps(nodes[n].from_source);
        excess_[n] = std::max<std::int64_t>(more, 0);
        room_[n] = std::max<std::int64_t>(-more, 0);
        is_sink_[n] = more > around_[n];
    }
    for (std::uint32_t n = 0; n < nodes.size(); ++n) {
        if (!is_sink_[n]) continue;
        for (std::uint32_t a = first_[n]; a < first_[n + 1]; ++a) {
            Arc& arc = arcs_[a];
            if (is_sink_[arc.to]) continue;
            excess_[arc.to] += arc.rest;
            send(arc, arc.rest);
        }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::int64_t taken = std::min(room_[n], excess_[n]);
        room_[n] -= taken;
        excess_[n] -= taken;
    }
}

// By a search from all nodes with room. Tells whether any excess reaches one.
bool MinimumCut::find_levels() {
    std::fill(level_.begin(), level_.end(), unreached);
    reached_.clear();
    for (std::uint32_t n = 0; n < level_.size(); ++n) {
        if (room_[n] == 0) continue;
        level_[n] = 0;
        reached_.push_back(n);
    }
    for (std::size_t k = 0; k < reached_.size(); ++k) {
        const std::uint32_t n = reached_[k];
        for (std::uint32_t a = first_[n]; a < first_[n + 1]; ++a) {
            const std::uint32_t from = arcs_[a].to;
            if (level_[from] != unreached || is_sink_[from] || arcs_[arcs_[a].reverse].rest == 0)
                continue;
            level_[from] = level_[n] + 1;
            reached_.push_back(from);
        }
    }
    count_.assign(level_.size() + 1, 0);
    active_.clear();
    active_.resize(1);
    highest_ = work_ = 0;
    gap_ = unreached - 1;
    for (const std::uint32_t n : reached_) {
        ++count_[level_[n]];
        next_[n] = first_[n];
        if (excess_[n] > 0) wake(n);
    }
    return !active_[highest_].empty();
}

void MinimumCut::wake(std::uint32_t n) {
    const std::size_t level = level_[n];
    if (active_.size() <= level) active_.resize(level + 1);
    active_[level].push_back(n);
    highest_ = std::max(highest_, level);
}

// Until nothing more seems to reach a source, or levels have grown wrong.
void MinimumCut::push_all() {
    while (work_ <= lifts_between * arcs_.size()) {
        while (highest_ > 0 && active_[highest_].empty()) --highest_;
        if (active_[highest_].empty()) return;
        const std::uint32_t n = active_[highest_].back();
        active_[highest_].pop_back();
        discharge(n);
    }
}

void MinimumCut::discharge(std::uint32_t n) {
    if (level_[n] > gap_) return;
    const std::int64_t taken = std::min(room_[n], excess_[n]);
    room_[n] -= taken;
    excess_[n] -= taken;
    for (std::uint32_t& a = next_[n]; excess_[n] > 0 && a < first_[n + 1]; ++a) {
        Arc& arc = arcs_[a];
        if (arc.rest == 0 || level_[n] == 0 || level_[arc.to] != level_[n] - 1) continue;
        const std::int64_t flow = std::min(arc.rest, excess_[n]);
        if (excess_[arc.to] == 0) wake(arc.to);
        excess_[arc.to] += flow;
        excess_[n] -= flow;
        send(arc, flow);
        if (excess_[n] == 0) return;  // the arc may have something left
    }
    if (excess_[n] > 0) lift(n);
}

// To right above the lowest node that it can push to.
void MinimumCut::lift(std::uint32_t n) {
    std::uint32_t least = unreached;
    for (std::uint32_t a = first_[n]; a < first_[n + 1]; ++a) {
        const Arc& arc = arcs_[a];
        if (arc.rest > 0 && level_[arc.to] <= gap_) least = std::min(least, level_[arc.to] + 1);
    }
    work_ += first_[n + 1] - first_[n] + 1;
    next_[n] = first_[n];
    if (--count_[level_[n]] == 0) gap_ = std::min(gap_, level_[n]);
    if (least > gap_ || least >= level_.size()) {
        level_[n] = unreached;
        return;
    }
    level_[n] = least;
    ++count_[least];
    wake(n);
}

}  // namespace topple::geometry
