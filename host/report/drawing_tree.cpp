// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "report/drawing_parts.h"

namespace topple::report {
namespace {

using Style = Drawing::Style;
using Anchor = Drawing::Anchor;

// The merge tree: leaves are poses and, where its easiest step leads off its support, the place
// below.
class Tree {
  public:
    explicit Tree(const Object& object) : object_(object), l_(object.landscape) {}

    Drawing draw() {
        collect();
        for (const Join& join : joins_) merge(join);
        finish();
        return std::move(out_);
    }

  private:
    static constexpr double height = 210, left = 62, right = 12, top = 12, bottom = 26;

    struct Join {
        double energy;
        std::size_t a, b;
        bool falls;
    };
    // What has been joined so far. Leaves stand side by side in the order of the joins.
    struct Cluster {
        bool shown = false;        // whether it has a leaf that is
        double x = 0, energy = 0;  // where its line has got to
    };

    void collect() {
        const std::vector<int> number = numbers_of(l_);
        for (std::size_t n = 0; n < l_.poses.size(); ++n) {
            const Landscape::Pose& pose = l_.poses[n];
            name_.push_back(number[n] ? std::to_string(number[n]) : "");
            energy_.push_back(pose.energy_J);
            if (pose.joins >= 0)
                joins_.push_back({pose.joins_at_J, n, static_cast<std::size_t>(pose.joins), false});
        }
        if (object_.why.drop_m > 0 && l_.now >= 0) {
            // Work against friction is no height to fall from.
            const double from = object_.mode == "slide" ? 0 : object_.why.W_J;
            fallen_ = energy_.size();
            joins_.push_back({object_.why.W_J, fallen_, static_cast<std::size_t>(l_.now), true});
            energy_.push_back(from - object_.why.S_J);
            name_.push_back("fallen: " + joules(energy_.back()));
        }
        std::ranges::stable_sort(joins_, {}, &Join::energy);
        order_leaves();
        low_ = 0;
        high_ = 0;
        double pose_low = 0;
        for (std::size_t n = 0; n < energy_.size(); ++n) {
            if (name_[n].empty()) continue;
            low_ = std::min(low_, energy_[n]);
            high_ = std::max(high_, energy_[n]);
            if (n != fallen_) pose_low = std::min(pose_low, energy_[n]);
        }
        for (const Join& join : joins_) high_ = std::max(high_, join.energy);
        if (!(high_ > low_)) high_ = low_ + 1;
        // A fall that dwarfs the poses would leave them no room.
        const double poses = high_ - pose_low;
        if (fallen_ < energy_.size() && pose_low - energy_[fallen_] > poses) {
            broken_ = true;
            low_ = pose_low - 0.6 * poses;
        }
    }

    // A first pass over the joins, to know each leaf's place before anything is drawn.
    void order_leaves() {
        std::vector<std::vector<std::size_t>> leaves(energy_.size());
        root_.resize(energy_.size());
        std::iota(root_.begin(), root_.end(), std::size_t{0});
        for (std::size_t n = 0; n < energy_.size(); ++n)
            if (!name_[n].empty()) leaves[n] = {n};
        for (const Join& join : joins_) {
            const std::size_t a = root_of(join.a), b = root_of(join.b);
            leaves[b].insert(leaves[b].end(), leaves[a].begin(), leaves[a].end());
            leaves[a].clear();
            root_[a] = b;
        }
        std::vector<std::size_t> order;
        for (const auto& of : leaves) order.insert(order.end(), of.begin(), of.end());
        std::iota(root_.begin(), root_.end(), std::size_t{0});
        cluster_.resize(energy_.size());
        const double step =
            (width - left - right) / static_cast<double>(std::max<std::size_t>(order.size(), 1));
        leaf_.resize(energy_.size());
        for (std::size_t n = 0; n < order.size(); ++n) {
            leaf_[order[n]] = left + step * (static_cast<double>(n) + 0.5);
            cluster_[order[n]] = {true, leaf_[order[n]], energy_[order[n]]};
        }
    }
    std::size_t root_of(std::size_t n) const {
        while (root_[n] != n) n = root_[n];
        return n;
    }
    double y(double energy) const {
        return height - bottom -
               (height - top - bottom) * (std::max(energy, low_) - low_) / (high_ - low_);
    }
    void line(Style style, const Point& a, const Point& b) {
        out_.strokes.push_back({style, {a, b}});
    }

    void merge(const Join& join) {
        const std::size_t a = root_of(join.a), b = root_of(join.b);
        Cluster &from = cluster_[a], &to = cluster_[b];
        root_[a] = b;
        if (!from.shown) return;
        if (to.shown) {
            const Style style = join.falls ? Style::lowest : Style::curve;
            for (const Cluster& c : {from, to})
                line(Style::curve, {c.x, y(c.energy)}, {c.x, y(join.energy)});
            line(style, {from.x, y(join.energy)}, {to.x, y(join.energy)});
            to.x = (from.x + to.x) / 2;
            to.energy = join.energy;
        } else {
            to.x = from.x;
            to.energy = from.energy;
        }
        to.shown = true;
    }

    void finish() {
        for (std::size_t n = 0; n < energy_.size(); ++n) {
            if (root_[n] == n && cluster_[n].shown)
                line(Style::curve, {cluster_[n].x, y(cluster_[n].energy)},
                     {cluster_[n].x, top - 6});
        }
        line(Style::axis, {left - 8, top - 6}, {left - 8, height - bottom});
        if (broken_) {
            // Two strokes across the fall's line.
            const double middle = y(low_) - 0.2 * (height - top - bottom);
            for (const double at : {middle - 3, middle + 3})
                line(Style::axis, {leaf_[fallen_] - 7, at + 3}, {leaf_[fallen_] + 7, at - 3});
        }
        const double least = broken_ ? 0 : low_;
        for (const double energy : {least, high_})
            out_.say({left - 12, y(energy) + 4}, Anchor::end, joules(energy));
        if (least < 0 && std::abs(y(0) - y(low_)) > 14 && std::abs(y(0) - y(high_)) > 14)
            out_.say({left - 12, y(0) + 4}, Anchor::end, "0 J");
        for (std::size_t n = 0; n < energy_.size(); ++n) {
            if (name_[n].empty()) continue;
            const bool now = static_cast<std::int32_t>(n) == l_.now;
            out_.dots.push_back(
                {now ? Style::now : Style::pose, {leaf_[n], y(energy_[n])}, now ? 5.0 : 3.5});
            out_.say({leaf_[n], y(energy_[n]) + 18}, Anchor::middle, name_[n], now);
        }
    }

    const Object& object_;
    const Landscape& l_;
    Drawing out_{"Disconnectivity graph", width, height};
    std::vector<std::string> name_;  // empty: not shown
    std::vector<double> energy_;
    std::vector<double> leaf_;  // x of each
    std::vector<Join> joins_;
    std::vector<std::size_t> root_;
    std::vector<Cluster> cluster_;
    std::size_t fallen_ = std::numeric_limits<std::size_t>::max();  // its leaf
    bool broken_ = false;  // its leaf is drawn higher than it lies
    double low_ = 0, high_ = 1;
};

}  // namespace

Drawing draw_tree(const Object& object) {
    return Tree(object).draw();
}

}  // namespace topple::report
