// SPDX-License-Identifier: MIT
#include "graph/cut_chain.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

namespace topple::graph {

Adjacency::Adjacency(std::int32_t nodes, std::span<const Edge> edges)
    : first(static_cast<std::size_t>(nodes) + 1), links(2 * edges.size()) {
    for (const Edge& e : edges) {
        ++first[e.a + 1];
        ++first[e.b + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    Table<NodeId, std::size_t> next(first.begin(), first.end() - 1);
    for (const Edge& e : edges) {
        const auto link = [&](std::int32_t from, std::int32_t to) {
            links[next[from]++] = {to, e.turn_on, std::log1p(-e.turn_on)};
        };
        link(e.a, e.b);
        link(e.b, e.a);
    }
}

CutChain::CutChain(const CutProblem& problem, const EnergyCache& energies, Random random,
                   TableView<NodeId, std::int32_t> start)
    : problem_(problem),
      energies_(energies),
      random_(random),
      label_(problem.key.size()),
      members_(problem.key.size() + 1),
      key_(members_.size()),
      energy_of_label_(members_.size()),
      is_moved_(problem.key.size()),
      seen_(problem.key.size()),
      own_(problem.key.size()),
      seen_label_(members_.size()),
      log_miss_to_(members_.size()) {
    group_by(start);
}

bool CutChain::begin() {
    wanted_.clear();
    for (std::size_t l = 0; l < members_.size(); ++l)
        if (!energies_.known(key_[l])) want(key_[l], group(l));
    if (!wanted_.empty()) return false;
    for (std::size_t l = 0; l < members_.size(); ++l) {
        energy_of_label_[l] = *energies_.known(key_[l]);
        energy_ += energy_of_label_[l];
    }
    return true;
}

void CutChain::group_by(TableView<NodeId, std::int32_t> start) {
    // What shares a label with a pinned node is in its group; the others' labels are their lowest
    // nodes' numbers.
    std::map<std::int32_t, std::int32_t> label_of_start;
    for (std::size_t n = 0; n < label_.size(); ++n) {
        if (problem_.pinned[n] && !start.empty()) label_of_start[start[n]] = pinned_label;
    }
    for (std::int32_t n = 0; n < static_cast<std::int32_t>(label_.size()); ++n) {
        LabelId l = is_pinned(n) ? pinned_label : LabelId(n + 1);
        if (!start.empty()) l = label_of_start.try_emplace(start[n], n + 1).first->second;
        label_[n] = l;
        members_[l].push_back(n);
        key_[l] ^= problem_.key[n];
    }
}

bool CutChain::step(const Temperatures& temperature) {
    const Random before = random_;
    wanted_.clear();
    if (propose(temperature(0))) {
        if (!wanted_.empty()) {
            // A flip that is left changes nothing but the random numbers: so what the next ones
            // would ask for, were all left, is known by now.
            for (unsigned ahead = 1; ahead < most_ahead && wanted_.size() < most_wanted; ++ahead)
                propose(temperature(ahead));
            random_ = before;
            return false;
        }
        if (change(from_energy_, to_energy_) < most_change_) take();
    }
    return true;
}

// Draws a flip, and finds its energies, or adds them to what is wanted. False where it can't be
// taken whatever they are.
bool CutChain::propose(double temperature) {
    const bool possible = draw();
    // Drawn always, so that the stream of random numbers doesn't depend on the outcome.
    const double u = random_.uniform();
    if (!possible) return false;
    // Metropolis-Hastings, Eq. 11: taken for a change of the energy below this one, that is for
    // ln u < ln ratio - change / T.
    most_change_ =
        temperature * (log_cut_ratio_ - std::log(std::max(u, std::numeric_limits<double>::min())));
    if (ruled_out(most_change_)) return false;
    const std::optional<double> from = energies_.known(from_key_), to = energies_.known(to_key_);
    if (!from) want(from_key_, group_less_moved());
    if (!to) want(to_key_, group_with_moved());
    from_energy_ = from.value_or(0);
    to_energy_ = to.value_or(0);
    return true;
}

bool CutChain::ruled_out(double most_change) {
    for (std::size_t n = 0; n < energies_.energies().at_least.size(); ++n) {
        const double from =
            bounds_.at_least(energies_, from_key_, n, [&] { return group_less_moved(); });
        const double to =
            bounds_.at_least(energies_, to_key_, n, [&] { return group_with_moved(); });
        if (change(from, to) >= most_change) return true;
    }
    return false;
}

void CutChain::want(const GroupKey& key, GroupQuery group) {
    wanted_.push_back({key, std::move(group)});
}

void CutChain::take() {
    energy_ += change(from_energy_, to_energy_);
    members_[to_] = group_with_moved().nodes;
    members_[from_] = group_less_moved().nodes;
    if (members_[from_].empty()) lowest_free_ = std::min(lowest_free_, from_.place());
    key_[from_] = from_key_;
    key_[to_] = to_key_;
    energy_of_label_[from_] = from_energy_;
    energy_of_label_[to_] = to_energy_;
    for (const std::int32_t n : moved_) label_[n] = to_;
}

GroupQuery CutChain::group_less_moved() const {
    GroupQuery q{{}, from_ == pinned_label};
    std::ranges::copy_if(members_[from_], std::back_inserter(q.nodes),
                         [&](std::int32_t n) { return !is_moved_.has(n); });
    return q;
}

GroupQuery CutChain::group_with_moved() const {
    GroupQuery q{{}, to_ == pinned_label};
    std::ranges::merge(members_[to_], moved_, std::back_inserter(q.nodes));
    return q;
}

double CutChain::change(double from_after, double to_after) const {
    return from_after + to_after - energy_of_label_[from_] - energy_of_label_[to_];
}

// False where the flip drawn is none.
bool CutChain::draw() {
    if (label_.empty() || !grow_component(random_.below(label_.size()))) return false;
    choose_target();
    if (to_ == from_ || !target_is_allowed() || !stays_connected()) return false;
    from_key_ = key_[from_];
    to_key_ = key_[to_];
    for (const std::int32_t n : moved_) {
        from_key_ ^= problem_.key[n];
        to_key_ ^= problem_.key[n];
    }
    return true;
}

// The connected component of turned-on edges around one node. Edges are drawn as they are met on
// the way out of it, which each is at most once: the same distribution as drawing all of them
// first. Starting from a random
// node picks a component with probability proportional to its size, which is the same in the
// state before and after the flip, and so cancels in Eq. 11 as a uniform choice would. False
// where it holds a pinned node: that one does not move.
bool CutChain::grow_component(NodeId seed) {
    if (is_pinned(seed)) return false;
    from_ = label_[seed];
    moved_.clear();
    is_moved_.clear();
    is_moved_.add(seed);
    moved_.push_back(seed);
    for (std::size_t head = 0; head < moved_.size(); ++head) {
        for (const Link& link : problem_.adjacency.of(moved_[head])) {
            if (label_of(link.node) != from_ || is_moved_.has(link.node)) continue;
            if (random_.uniform() >= link.turn_on) continue;
            if (is_pinned(link.node)) return false;
            is_moved_.add(link.node);
            moved_.push_back(link.node);
        }
    }
    sort_moved();
    return true;
}

// Of many nodes it is quicker to pick them from their group's, which ascend.
void CutChain::sort_moved() {
    constexpr std::size_t few = 8;
    if (moved_.size() <= few) {
        std::sort(moved_.begin(), moved_.end());
        return;
    }
    moved_.clear();
    std::ranges::copy_if(members_[from_], std::back_inserter(moved_),
                         [&](std::int32_t n) { return is_moved_.has(n); });
}

// The target is one of the groups that touch the component from outside, or a fresh group, each
// alike. The nodes outside keep their labels, so the reverse flip has the same choices and the
// proposal's own ratio q(old)/q(new) is 1.
void CutChain::choose_target() {
    targets_.clear();
    seen_label_.clear();
    border_.clear();
    seen_.clear();
    for (const std::int32_t n : moved_) {
        for (const Link& link : problem_.adjacency.of(n)) {
            if (is_moved_.has(link.node)) continue;
            const LabelId l = label_of(link.node);
            double& sum = log_miss_to_[l];
            if (seen_label_.add(l)) {
                targets_.push_back(l);
                sum = 0;
            }
            sum += link.log_miss;
            if (l == from_ && seen_.add(link.node)) border_.push_back(link.node);
        }
    }
    std::sort(targets_.begin(), targets_.end());
    const std::uint64_t pick = random_.below(targets_.size() + 1);
    if (pick == targets_.size()) {
        // A fresh group; where the component already is a whole group, that is no change.
        const bool whole = members_[from_].size() == moved_.size();
        to_ = whole ? from_ : free_label();
    } else {
        to_ = targets_[pick];
    }
    const auto log_misses = [&](LabelId l) { return seen_label_.has(l) ? log_miss_to_[l] : 0; };
    log_cut_ratio_ = log_misses(to_) - log_misses(from_);
}

// Whether nothing in the target is to be kept apart from what moves there. States that break this
// have no probability, so that a flip to one is turned down as any other of that kind would be.
bool CutChain::target_is_allowed() const {
    if (problem_.apart.empty()) return true;
    return std::ranges::none_of(moved_, [&](std::int32_t n) {
        return std::ranges::any_of(problem_.apart[n],
                                   [&](std::int32_t other) { return label_of(other) == to_; });
    });
}

// A group is one rigid body, so it hangs together; the pinned nodes do so by definition. Flips
// that would break a group are not proposed, which also keeps every flip reversible. What is
// left of a connected group is connected if all that touched the part taken out still reach one
// another, or, in the pinned group, a pinned node.
bool CutChain::stays_connected() {
    if (border_.empty()) return true;
    const bool shell = from_ == pinned_label;
    seen_.clear();  // nodes that reach the first one or the shell, or are about to
    if (!shell) seen_.add(border_.front());
    for (const std::int32_t start : border_) {
        if (seen_.has(start)) continue;
        if (!reaches(start, shell)) return false;
    }
    return true;
}
// Whether a node reaches a pinned one, or one that is seen, within its group less the moved
// part. All on the way there are seen then.
bool CutChain::reaches(NodeId start, bool shell) {
    open_.assign(1, start);
    own_.clear();
    own_.add(start);
    bool found = shell && is_pinned(start);
    for (std::size_t head = 0; head < open_.size() && !found; ++head) {
        for (const Link& link : problem_.adjacency.of(open_[head])) {
            if (label_of(link.node) != from_ || is_moved_.has(link.node)) continue;
            found = found || seen_.has(link.node) || (shell && is_pinned(link.node));
            if (own_.add(link.node)) open_.push_back(link.node);
        }
    }
    for (const std::int32_t n : open_) seen_.add(n);
    return found;
}

LabelId CutChain::free_label() {
    while (lowest_free_ < members_.size() && !members_[lowest_free_].empty()) ++lowest_free_;
    return lowest_free_;
}

}  // namespace topple::graph
