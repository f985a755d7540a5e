// SPDX-License-Identifier: MIT
#include "geometry/minimum_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace topple::geometry {
namespace {

constexpr double steps = 1e6;
constexpr std::uint32_t no_root = std::numeric_limits<std::uint32_t>::max();

std::int64_t in_steps(double cost) {
    return std::llround(steps * cost);
}

}  // namespace

MinimumCut::MinimumCut(std::size_t nodes, std::span<const CutEdge> edges)
    : first_(nodes + 1, 0),
      excess_(nodes),
      side_(nodes),
      parent_(nodes),
      when_(nodes),
      distance_(nodes),
      awake_(nodes) {
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
    }
    for (const Arc& arc : arcs_) capacity_.push_back(arc.rest);
}

std::vector<bool> MinimumCut::part(std::span<const CutNode> nodes) {
    plant(nodes);
    while (!active_.empty()) {
        const std::uint32_t n = active_.front();
        const std::uint32_t middle = hangs(n) ? grow(n) : no_arc;
        if (middle == no_arc) {
            active_.pop_front();
            awake_[n] = false;
            continue;
        }
        ++time_;
        augment(middle);
        while (!orphans_.empty()) {
            const std::uint32_t lost = orphans_.front();
            orphans_.pop_front();
            adopt(lost);
        }
    }
    std::vector<bool> inside(side_.size());
    for (std::size_t n = 0; n < inside.size(); ++n) inside[n] = side_[n] == Side::source;
    return inside;
}

// Every node that has something from the source, or to the sink, is the root of a tree.
void MinimumCut::plant(std::span<const CutNode> nodes) {
    for (const std::uint32_t arc : passed_)
        for (const std::uint32_t a : {arc, arcs_[arc].reverse}) arcs_[a].rest = capacity_[a];
    passed_.clear();
    time_ = 0;
    std::fill(when_.begin(), when_.end(), 0);
    std::fill(distance_.begin(), distance_.end(), 1);
    std::array<std::size_t, 3> count{};
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        excess_[n] = in_steps(nodes[n].from_source) - in_steps(nodes[n].from_sink);
        side_[n] = excess_[n] > 0 ? Side::source : excess_[n] < 0 ? Side::sink : Side::none;
        parent_[n] = side_[n] == Side::none ? no_arc : root;
        ++count[static_cast<std::size_t>(side_[n])];
    }
    // Of the larger side those nodes wake that something else is beside.
    const Side larger =
        count[static_cast<std::size_t>(Side::source)] > count[static_cast<std::size_t>(Side::sink)]
            ? Side::source
            : Side::sink;
    for (std::uint32_t n = 0; n < nodes.size(); ++n) {
        if (side_[n] == larger) continue;
        if (side_[n] != Side::none) wake(n);
        for (const Arc& arc : arcs_of(n))
            if (side_[arc.to] == larger) wake(arc.to);
    }
}

void MinimumCut::wake(std::uint32_t n) {
    if (awake_[n]) return;
    awake_[n] = true;
    active_.push_back(n);
}

// Lets a node's tree grow to its neighbours: tells an arc from the source's tree to the sink's, or
// no_arc.
std::uint32_t MinimumCut::grow(std::uint32_t n) {
    const Side side = side_[n];
    for (std::uint32_t arc = first_[n]; arc < first_[n + 1]; ++arc) {
        if (!leads_on(arc, side)) continue;
        const std::uint32_t to = arcs_[arc].to;
        if (side_[to] == Side::none) {
            side_[to] = side;
            parent_[to] = arcs_[arc].reverse;
            when_[to] = when_[n];
            distance_[to] = distance_[n] + 1;
            wake(to);
        } else if (side_[to] != side) {
            return side == Side::source ? arc : arcs_[arc].reverse;
        } else if (when_[to] <= when_[n] && distance_[to] > distance_[n] + 1) {
            parent_[to] = arcs_[arc].reverse;  // nearer to a root
            when_[to] = when_[n];
            distance_[to] = distance_[n] + 1;
        }
    }
    return no_arc;
}

// The least of what is left on the way from a node to its root.
std::int64_t MinimumCut::least_rest(std::uint32_t from, Side side, std::int64_t least) const {
    while (parent_[from] != root) {
        const Arc& up = arcs_[parent_[from]];
        least = std::min(least, side == Side::source ? arcs_[up.reverse].rest : up.rest);
        from = up.to;
    }
    return std::min(least, std::abs(excess_[from]));
}

void MinimumCut::pass(std::uint32_t arc, std::int64_t flow) {
    const std::uint32_t back = arcs_[arc].reverse;
    if (arcs_[arc].rest == capacity_[arc]) passed_.push_back(arc);
    arcs_[arc].rest -= flow;
    arcs_[back].rest += flow;
}

void MinimumCut::push(std::uint32_t from, Side side, std::int64_t flow) {
    while (parent_[from] != root) {
        const std::uint32_t up = parent_[from],
                            along = side == Side::source ? arcs_[up].reverse : up;
        pass(along, flow);
        if (arcs_[along].rest == 0) {
            parent_[from] = orphan;
            orphans_.push_front(from);
        }
        from = arcs_[up].to;
    }
    excess_[from] -= side == Side::source ? flow : -flow;
    if (excess_[from] == 0) {
        parent_[from] = orphan;
        orphans_.push_front(from);
    }
}

void MinimumCut::augment(std::uint32_t middle) {
    const std::uint32_t head = arcs_[middle].to, tail = arcs_[arcs_[middle].reverse].to;
    std::int64_t flow = least_rest(tail, Side::source, arcs_[middle].rest);
    flow = least_rest(head, Side::sink, flow);
    pass(middle, flow);
    push(tail, Side::source, flow);
    push(head, Side::sink, flow);
}

// Nodes from one to the root of its tree; no_root where an orphan is on the way. Marks the way, so
// that it is walked once for each path.
std::uint32_t MinimumCut::distance_to_root(std::uint32_t n) {
    std::uint32_t all = 0;
    for (std::uint32_t at = n;; at = arcs_[parent_[at]].to) {
        if (when_[at] == time_) {
            all += distance_[at];
            break;
        }
        if (!hangs(at)) return no_root;
        ++all;
        if (parent_[at] == root) {
            when_[at] = time_;
            distance_[at] = 1;
            break;
        }
    }
    std::uint32_t away = all;
    for (std::uint32_t at = n; when_[at] != time_; at = arcs_[parent_[at]].to) {
        when_[at] = time_;
        distance_[at] = away--;
    }
    return all;
}

// A node whose way to its root is closed gets another parent in the same tree, or leaves it, and
// its children are orphans, too.
void MinimumCut::adopt(std::uint32_t n) {
    const Side side = side_[n];
    std::uint32_t best = no_arc, nearest = no_root;
    for (std::uint32_t arc = first_[n]; arc < first_[n + 1]; ++arc) {
        const std::uint32_t to = arcs_[arc].to;
        if (side_[to] != side || !hangs(to) || !leads_on(arcs_[arc].reverse, side)) continue;
        const std::uint32_t away = distance_to_root(to);
        if (away < nearest) nearest = away, best = arc;
    }
    if (best != no_arc) {
        parent_[n] = best;
        when_[n] = time_;
        distance_[n] = nearest + 1;
        return;
    }
    for (std::uint32_t arc = first_[n]; arc < first_[n + 1]; ++arc) {
        const std::uint32_t to = arcs_[arc].to;
        if (side_[to] != side) continue;
        if (leads_on(arcs_[arc].reverse, side)) wake(to);
        if (parent_[to] < orphan && arcs_[parent_[to]].to == n) {
            parent_[to] = orphan;
            orphans_.push_back(to);
        }
    }
    side_[n] = Side::none;
    parent_[n] = no_arc;
}

}  // namespace topple::geometry
