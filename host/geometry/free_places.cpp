// SPDX-License-Identifier: MIT
#include "geometry/free_places.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "core/scene_bounds.h"

namespace topple::geometry {
namespace {

constexpr int most_cells_along = 48;
// To look in from outside: at least two cells, and a quarter of the scene's longest side.
constexpr int margin = most_cells_along / 4;
constexpr double cells_per_surfel = 3;
constexpr int least_clearance = 2;

}  // namespace

FreePlaces::FreePlaces(const Surfels& surfels) {
    if (surfels.size() == 0) return;
    occupy(surfels);
    find_places();
}

double FreePlaces::longest_m() const {
    return *std::max_element(size_.begin(), size_.end()) * cell_m_;
}

double FreePlaces::volume_m3() const {
    double volume = 1;
    for (const int side : size_) volume *= (side - 2 * margin) * cell_m_;
    return volume;
}

bool FreePlaces::inside(const std::array<int, 3>& c) const {
    for (std::size_t a = 0; a < 3; ++a) {
        if (c[a] < 0 || c[a] >= size_[a]) return false;
    }
    return true;
}

std::size_t FreePlaces::at(const std::array<int, 3>& c) const {
    return (static_cast<std::size_t>(c[0]) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(c[1])) *
               static_cast<std::size_t>(size_[2]) +
           static_cast<std::size_t>(c[2]);
}

void FreePlaces::occupy(const Surfels& s) {
    const std::array<const std::vector<float>*, 3> p{&s.x, &s.y, &s.z};
    Vec3 extent{};
    for (std::size_t a = 0; a < 3; ++a) {
        std::vector<float> values = *p[a];
        const auto [low, high] = inner_range(values);
        low_[a] = low;
        extent[a] = high - low_[a];
    }
    const double longest = *std::max_element(extent.begin(), extent.end());
    cell_m_ = std::max(cells_per_surfel * s.cell_m, longest / most_cells_along);
    for (std::size_t a = 0; a < 3; ++a) {
        size_[a] = static_cast<int>(extent[a] / cell_m_) + 1 + 2 * margin;
        low_[a] -= margin * cell_m_;
    }
    occupied_.assign(at({size_[0] - 1, size_[1] - 1, size_[2] - 1}) + 1, false);
    for (std::size_t i = 0; i < s.size(); ++i) {
        std::array<int, 3> c{};
        bool within = true;
        for (std::size_t a = 0; a < 3; ++a) {
            const double cell = std::floor(((*p[a])[i] - low_[a]) / cell_m_);
            within = within && cell >= 0 && cell < size_[a];
            c[a] = within ? static_cast<int>(cell) : 0;
        }
        if (within) occupied_[at(c)] = true;
    }
}

void FreePlaces::find_places() {
    std::vector<int> steps(occupied_.size(), -1);
    std::deque<std::array<int, 3>> front;
    const auto for_each_cell = [&](const auto& body) {
        for (int i = 0; i < size_[0]; ++i) {
            for (int j = 0; j < size_[1]; ++j) {
                for (int k = 0; k < size_[2]; ++k) body(std::array<int, 3>{i, j, k});
            }
        }
    };
    for_each_cell([&](const std::array<int, 3>& c) {
        if (!occupied_[at(c)]) return;
        steps[at(c)] = 0;
        front.push_back(c);
    });
    while (!front.empty()) {
        const std::array<int, 3> c = front.front();
        front.pop_front();
        for (std::size_t a = 0; a < 3; ++a) {
            for (const int step : {-1, 1}) {
                std::array<int, 3> to = c;
                to[a] += step;
                if (!inside(to) || steps[at(to)] >= 0) continue;
                steps[at(to)] = steps[at(c)] + 1;
                front.push_back(to);
            }
        }
    }
    const std::vector<std::uint8_t> hits = directions_hit();
    for_each_cell([&](const std::array<int, 3>& c) {
        if (steps[at(c)] < least_clearance) return;
        middle_.push_back({low_[0] + (c[0] + 0.5) * cell_m_, low_[1] + (c[1] + 0.5) * cell_m_,
                           low_[2] + (c[2] + 0.5) * cell_m_});
        clearance_.push_back(steps[at(c)] * cell_m_);
        enclosure_.push_back(hits[at(c)] / 26.0);
        bool within = true;
        for (std::size_t a = 0; a < 3; ++a)
            within = within && c[a] >= margin && c[a] < size_[a] - margin;
        within_.push_back(within);
    });
    apart_.assign(middle_.size(), std::numeric_limits<double>::max());
    free_.assign(middle_.size(), 0);
    passed_over_.assign(middle_.size(), false);
}

// From each cell a direction hits something where the next cell that way does, or is occupied: one
// sweep against each direction tells for all cells.
std::vector<std::uint8_t> FreePlaces::directions_hit() const {
    std::vector<std::uint8_t> count(occupied_.size(), 0), hit(occupied_.size());
    for (int direction = 0; direction < 27; ++direction) {
        const std::array<int, 3> step{direction / 9 - 1, direction / 3 % 3 - 1, direction % 3 - 1};
        if (step == std::array<int, 3>{}) continue;
        // Along each axis from the end that the direction points to.
        const auto index = [&](int n, std::size_t a) { return step[a] > 0 ? size_[a] - 1 - n : n; };
        std::array<int, 3> c{};
        for (int i = 0; i < size_[0]; ++i) {
            c[0] = index(i, 0);
            for (int j = 0; j < size_[1]; ++j) {
                c[1] = index(j, 1);
                for (int k = 0; k < size_[2]; ++k) {
                    c[2] = index(k, 2);
                    const std::array<int, 3> next{c[0] + step[0], c[1] + step[1], c[2] + step[2]};
                    const std::size_t here = at(c);
                    hit[here] = occupied_[here] || (inside(next) && hit[at(next)]);
                    count[here] = static_cast<std::uint8_t>(count[here] + hit[here]);
                }
            }
        }
    }
    return count;
}

std::size_t FreePlaces::choose_first() const {
    // Nobody looks up through a floor: outside only where there is nothing within.
    const std::size_t place = best([&](std::size_t i) { return !passed_over_[i] && within_[i]; });
    if (place < size()) return place;
    return best([&](std::size_t i) { return !passed_over_[i]; });
}

std::size_t FreePlaces::choose_free() const {
    return best([&](std::size_t i) { return is_free(i); });
}

std::size_t FreePlaces::choose_closed(double clearance_m) const {
    constexpr double closed = 0.95;
    return best([&](std::size_t i) {
        return !is_free(i) && !passed_over_[i] && within_[i] && clearance_[i] >= clearance_m &&
               enclosure_[i] >= closed;
    });
}

std::size_t FreePlaces::choose_outside(const std::function<bool(std::size_t)>& may) const {
    return best([&](std::size_t i) { return !within_[i] && may(i); });
}

std::size_t FreePlaces::best(const std::function<bool(std::size_t)>& may) const {
    std::size_t best = size();
    double best_score = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        if (!may(i)) continue;
        // Squared: a place outside of the room has all the clearance in the world.
        const double score =
            std::min(clearance_[i], 0.5 * apart_[i]) * enclosure_[i] * enclosure_[i];
        if (score > best_score) {
            best_score = score;
            best = i;
        }
    }
    return best;
}

void FreePlaces::leave_out(const Vec3& chosen) {
    for (std::size_t i = 0; i < size(); ++i) {
        apart_[i] =
            std::min(apart_[i], std::hypot(middle_[i][0] - chosen[0], middle_[i][1] - chosen[1],
                                           middle_[i][2] - chosen[2]));
    }
}

}  // namespace topple::geometry
