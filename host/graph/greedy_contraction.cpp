// SPDX-License-Identifier: MIT
#include "graph/greedy_contraction.h"

#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "core/union_find.h"

namespace topple::graph {
namespace {

class Contraction {
  public:
    Contraction(std::int32_t nodes, std::span<const Joint> joints, const std::vector<bool>& pinned,
                std::span<const double> to_pinned, std::span<const std::vector<std::int32_t>> apart)
        : sets_(static_cast<std::size_t>(nodes)),
          between_(static_cast<std::size_t>(nodes)),
          apart_(apart.size()) {
        std::int32_t ground = -1;
        for (std::int32_t n = 0; n < nodes; ++n) {
            if (!pinned[static_cast<std::size_t>(n)]) continue;
            if (ground < 0) ground = n;
            sets_.join(static_cast<std::size_t>(ground), static_cast<std::size_t>(n));
        }
        for (std::size_t n = 0; n < apart.size(); ++n) {
            for (const std::int32_t other : apart[n])
                apart_[static_cast<std::size_t>(root(static_cast<std::int32_t>(n)))].insert(
                    root(other));
        }
        for (const Joint& joint : joints) add(root(joint.a), root(joint.b), joint.log_odds);
        for (std::int32_t n = 0; n < nodes && ground >= 0; ++n)
            add(n, root(n) == ground ? n : ground, to_pinned[static_cast<std::size_t>(n)]);
        for (std::int32_t n = 0; n < nodes; ++n) {
            for (const auto& [other, sum] : at(n))
                if (other > n) offer(n, other, sum);
        }
    }

    std::vector<std::int32_t> run() {
        while (!open_.empty()) {
            const auto [sum, minus_a, minus_b] = open_.top();
            open_.pop();
            const std::int32_t a = -minus_a, b = -minus_b;
            if (root(a) != a || root(b) != b) continue;
            const auto now = at(a).find(b);
            if (now == at(a).end() || now->second != sum) continue;  // an older offer
            if (kept_apart(a, b)) continue;
            join(a, b);
        }
        std::vector<std::int32_t> label;
        for (std::int32_t n = 0; n < static_cast<std::int32_t>(between_.size()); ++n)
            label.push_back(root(n));
        return label;
    }

  private:
    std::map<std::int32_t, double>& at(std::int32_t n) {
        return between_[static_cast<std::size_t>(n)];
    }
    std::int32_t root(std::int32_t n) {
        return static_cast<std::int32_t>(sets_.root(static_cast<std::size_t>(n)));
    }
    void add(std::int32_t a, std::int32_t b, double log_odds) {
        if (a == b) return;
        at(a)[b] += log_odds;
        at(b)[a] += log_odds;
    }
    void offer(std::int32_t a, std::int32_t b, double sum) {
        if (sum > 0) open_.emplace(sum, -std::min(a, b), -std::max(a, b));
    }
    bool kept_apart(std::int32_t a, std::int32_t b) const {
        return !apart_.empty() && apart_[static_cast<std::size_t>(a)].contains(b);
    }
    // b joins a, which is the lower.
    void join(std::int32_t a, std::int32_t b) {
        sets_.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
        if (!apart_.empty()) {
            for (const std::int32_t other : apart_[static_cast<std::size_t>(b)]) {
                apart_[static_cast<std::size_t>(other)].erase(b);
                apart_[static_cast<std::size_t>(other)].insert(a);
                apart_[static_cast<std::size_t>(a)].insert(other);
            }
        }
        at(a).erase(b);
        for (const auto& [other, sum] : at(b)) {
            if (other == a) continue;
            at(other).erase(b);
            const double both = at(a)[other] += sum;
            at(other)[a] = both;
            offer(a, other, both);
        }
        at(b).clear();
    }

    UnionFind sets_;
    std::vector<std::map<std::int32_t, double>> between_;
    std::vector<std::set<std::int32_t>> apart_;  // by root, other roots; or empty
    // (sum, -a, -b): the largest sum first, then the lowest nodes.
    std::priority_queue<std::tuple<double, std::int32_t, std::int32_t>> open_;
};

}  // namespace

std::vector<std::int32_t> contract_greedily(std::int32_t nodes, std::span<const Joint> joints,
                                            const std::vector<bool>& pinned,
                                            std::span<const double> to_pinned,
                                            std::span<const std::vector<std::int32_t>> apart) {
    return Contraction(nodes, joints, pinned, to_pinned, apart).run();
}

}  // namespace topple::graph
