// SPDX-License-Identifier: MIT
#include "physics/sliding.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <string>

#include "core/scan_gaps.h"
#include "core/thread_pool.h"
#include "core/vectors.h"
#include "physics/infinity.h"
#include "physics/slide_map.h"
#include "topple/error.h"

namespace topple::physics {
namespace {

// Columns of every object, in the order of the cells.
std::vector<Footprint> footprints(const SolidCells& cells, std::span<const std::int32_t> object,
                                  std::size_t count) {
    std::vector<Footprint> feet(count);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (object[n] < 0) continue;
        Footprint& foot = feet[object[n]];
        foot.top = foot.columns.empty() ? cells.k[n] : std::max(foot.top, cells.k[n]);
        if (foot.columns.empty() || foot.columns.back().i != cells.i[n] ||
            foot.columns.back().j != cells.j[n])
            foot.columns.push_back({cells.i[n], cells.j[n], cells.k[n]});
    }
    return feet;
}

// The level that most of the columns rest on; of equals the higher, where the object would land
// first. Of an object that is known to stand, of the levels where it does: what it reaches over is
// not what it slides on.
void find_support(const SolidCells& cells, const CellColumns& columns,
                  std::span<const std::int32_t> object, std::int32_t self,
                  const KnownFooting& stance, Footprint& foot) {
    std::map<std::int32_t, std::size_t> votes;
    for (const Footprint::Column& c : foot.columns) {
        const auto [first, last] = columns.at(c.i, c.j);
        std::size_t below = last;  // the highest cell under the object's lowest here
        for (std::size_t n = first; n < last && cells.k[n] < c.low; ++n) {
            if (object[n] != self) below = n;
        }
        if (below == last || std::int64_t{c.low} - cells.k[below] > std::int64_t{contact_gap} + 1)
            continue;
        ++votes[cells.k[below]];
    }
    std::size_t most = 0;
    const auto stands = static_cast<std::int64_t>(std::lround(stance.height_m / cells.voxel_m)) - 1;
    for (const auto& [level, count] : votes) {
        if (!stance.polygon.empty() && std::abs(level - stands) > noise_gap) continue;
        if (count < most) continue;
        most = count;
        foot.support = level;
        foot.stands = true;
    }
}

struct Node {
    double cost;  // voxels
    std::int32_t i, j;
    bool operator>(const Node& o) const {
        if (cost != o.cost) return cost > o.cost;
        return i != o.i ? i > o.i : j > o.j;
    }
};

// Lazy Theta* (Nash, Koenig & Tovey 2010) over positions of the centre of mass, with no goal in
// mind: the first position that falls is the nearest.
class Search {
  public:
    Search(SlideMap& map, double x, double y) : map_(map), x_(x), y_(y) {
        side_ = 2 * map.radius() + 1;
        nodes_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
    }

    struct Way {
        bool found = false;
        double length = 0;    // voxels
        double x = 0, y = 0;  // end of the first leg
        std::int32_t i = 0, j = 0;
    };
    // The cost of every place that can be reached within `reach` columns of the start, those that
    // fall included, without going on from these.
    void explore(std::int32_t reach) {
        search([&](const Node& node) {
            const bool far = std::max(std::abs(node.i - map_.start_i()),
                                      std::abs(node.j - map_.start_j())) >= reach;
            return map_.falls(node.i, node.j) || far ? Next::leave : Next::expand;
        });
    }
    // What explore() found; infinity where it did not get.
    double cost(std::int32_t i, std::int32_t j) {
        const State& s = state(i, j);
        return s.closed ? s.cost : std::numeric_limits<double>::infinity();
    }

    Way run() {
        if (map_.falls(map_.start_i(), map_.start_j()))
            return exit_at(map_.start_i(), map_.start_j());
        Way way;
        std::size_t settled = 0;
        search([&](const Node& node) {
            // A floor has no edge: worth asking once the search has grown.
            if (++settled == 4000 && !map_.any_edge()) return Next::stop;
            if (!map_.falls(node.i, node.j)) return Next::expand;
            way = exit_at(node.i, node.j);
            return Next::stop;
        });
        return way;
    }

  private:
    struct State {
        double cost = std::numeric_limits<double>::infinity();
        std::int32_t parent_i = 0, parent_j = 0;
        bool closed = false;
        bool in_sight = false;  // of the parent, as far as it can be: not to be asked again
    };
    State& state(std::int32_t i, std::int32_t j) {
        return nodes_[static_cast<std::size_t>(i - map_.start_i() + map_.radius()) *
                          static_cast<std::size_t>(side_) +
                      static_cast<std::size_t>(j - map_.start_j() + map_.radius())];
    }
    // Settles places by rising cost; what `settled` says of each is done next.
    enum class Next { expand, leave, stop };
    template <class Settled>
    void search(const Settled& settled) {
        std::priority_queue<Node, std::vector<Node>, std::greater<>> open;
        const std::int32_t si = map_.start_i(), sj = map_.start_j();
        state(si, sj) = {0, si, sj, false, true};
        open.push({0, si, sj});
        while (!open.empty()) {
            const Node node = open.top();
            open.pop();
            State& s = state(node.i, node.j);
            if (s.closed || node.cost != s.cost) continue;
            if (!settle(node, s)) {
                if (std::isfinite(s.cost)) open.push({s.cost, node.i, node.j});
                continue;
            }
            s.closed = true;
            const Next next = settled(node);
            if (next == Next::stop) return;
            if (next == Next::expand) expand(node, s, open);
        }
    }
    bool inside(std::int32_t i, std::int32_t j) const {
        return std::abs(i - map_.start_i()) <= map_.radius() &&
               std::abs(j - map_.start_j()) <= map_.radius();
    }
    // The object starts where its centre is; elsewhere it moves by whole voxels.
    std::array<double, 2> place(std::int32_t i, std::int32_t j) const {
        if (i == map_.start_i() && j == map_.start_j()) return {x_, y_};
        return {i + 0.5, j + 0.5};
    }
    // Straight distance from a position to one to be entered: to its centre, or to its nearest
    // point where the way ends there.
    double distance(std::int32_t i, std::int32_t j, std::int32_t to_i, std::int32_t to_j) {
        const auto from = place(i, j);
        auto to = place(to_i, to_j);
        if (map_.falls(to_i, to_j)) {
            to = {std::clamp<double>(from[0], to_i, to_i + 1),
                  std::clamp<double>(from[1], to_j, to_j + 1)};
        }
        return std::hypot(to[0] - from[0], to[1] - from[1]);
    }
    bool sight(std::int32_t i, std::int32_t j, std::int32_t to_i, std::int32_t to_j) {
        const auto from = place(i, j), to = place(to_i, to_j);
        const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
        const int steps = static_cast<int>(std::ceil(length * 2));
        for (int n = 1; n < steps; ++n) {
            const double t = static_cast<double>(n) / steps;
            const auto ci = static_cast<std::int32_t>(std::floor(from[0] + t * (to[0] - from[0])));
            const auto cj = static_cast<std::int32_t>(std::floor(from[1] + t * (to[1] - from[1])));
            if (ci == to_i && cj == to_j) return true;
            if ((ci != map_.start_i() || cj != map_.start_j()) &&
                (!map_.passable(ci, cj) || map_.falls(ci, cj)))
                return false;
        }
        return true;
    }
    // Makes good on a cost that took sight for granted; false if it was wrong, with the cost
    // mended.
    bool settle(const Node& node, State& s) {
        if (s.in_sight || sight(s.parent_i, s.parent_j, node.i, node.j)) return true;
        s.cost = std::numeric_limits<double>::infinity();
        for (int a = -1; a <= 1; ++a) {
            for (int b = -1; b <= 1; ++b) {
                const std::int32_t i = node.i + a, j = node.j + b;
                if ((a == 0 && b == 0) || !inside(i, j) || !state(i, j).closed) continue;
                const double cost = state(i, j).cost + distance(i, j, node.i, node.j);
                if (cost < s.cost) s = {cost, i, j, false, true};
            }
        }
        return false;
    }
    void expand(const Node& node, const State& s,
                std::priority_queue<Node, std::vector<Node>, std::greater<>>& open) {
        const State parent = state(s.parent_i, s.parent_j);
        for (int a = -1; a <= 1; ++a) {
            for (int b = -1; b <= 1; ++b) {
                const std::int32_t i = node.i + a, j = node.j + b;
                if ((a == 0 && b == 0) || !inside(i, j)) continue;
                State& next = state(i, j);
                if (next.closed || !map_.passable(i, j)) continue;
                const double cost = parent.cost + distance(s.parent_i, s.parent_j, i, j);
                if (cost < next.cost) {
                    next = {cost, s.parent_i, s.parent_j, false, false};
                    open.push({cost, i, j});
                }
            }
        }
    }
    Way exit_at(std::int32_t i, std::int32_t j) {
        Way way{map_.drop_m(i, j) > 0, 0, i + 0.5, j + 0.5, i, j};
        if (i == map_.start_i() && j == map_.start_j()) return way;
        way.length = state(i, j).cost;
        // Back along the parents to the first leg.
        std::int32_t at_i = i, at_j = j;
        for (;;) {
            const State& s = state(at_i, at_j);
            const bool first = s.parent_i == map_.start_i() && s.parent_j == map_.start_j();
            if (first) break;
            at_i = s.parent_i;
            at_j = s.parent_j;
        }
        const auto end = place(at_i, at_j);
        way.x = end[0];
        way.y = end[1];
        if (map_.falls(at_i, at_j)) {
            way.x = std::clamp<double>(x_, at_i, at_i + 1);
            way.y = std::clamp<double>(y_, at_j, at_j + 1);
        }
        return way;
    }

    SlideMap& map_;
    double x_, y_;
    std::int32_t side_;
    std::vector<State> nodes_;
};

// The support's border around column (i, j), which does not hold: the faces between such columns
// that hang together within reach of it and columns that do, as the segment that fits them best.
Ends border_at(SlideMap& map, std::int32_t i, std::int32_t j, std::int32_t reach, double voxel_m,
               double height_m) {
    std::vector<std::array<double, 2>> middles;  // of faces, voxels
    std::vector<std::array<std::int32_t, 2>> next{{i, j}};
    std::set<std::array<std::int32_t, 2>> seen{{i, j}};
    while (!next.empty()) {
        const auto [at_i, at_j] = next.back();
        next.pop_back();
        for (int a = -1; a <= 1; ++a) {
            for (int b = -1; b <= 1; ++b) {
                const std::int32_t to_i = at_i + a, to_j = at_j + b;
                if (map.holds(to_i, to_j)) {
                    if ((a == 0) != (b == 0))
                        middles.push_back({at_i + 0.5 + 0.5 * a, at_j + 0.5 + 0.5 * b});
                } else if (std::max(std::abs(to_i - i), std::abs(to_j - j)) <= reach &&
                           seen.insert({to_i, to_j}).second) {
                    next.push_back({to_i, to_j});
                }
            }
        }
    }
    Vec3 middle{i + 0.5, j + 0.5, height_m / voxel_m};
    if (middles.empty()) return {along({}, voxel_m, middle), along({}, voxel_m, middle)};
    const double count = static_cast<double>(middles.size());
    middle[0] = middle[1] = 0;
    for (const auto& m : middles) middle = along(middle, 1 / count, {m[0], m[1], 0});
    double xx = 0, xy = 0, yy = 0;
    for (const auto& m : middles) {
        const double x = m[0] - middle[0], y = m[1] - middle[1];
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const Vec3 way{std::cos(angle), std::sin(angle), 0};
    double low = 0, high = 0;
    for (const auto& m : middles) {
        const double t = dot(way, {m[0] - middle[0], m[1] - middle[1], 0});
        low = std::min(low, t);
        high = std::max(high, t);
    }
    return {along({}, voxel_m, along(middle, low - 0.5, way)),
            along({}, voxel_m, along(middle, high + 0.5, way))};
}

// As far as the way goes and a bit more, or `least` where there is none.
Landscape::Places places_around(SlideMap& map, const MassProperties& body, double around_m,
                                double friction, double voxel_m) {
    constexpr std::int32_t most_in_a_row = 63;
    const double weight = body.mass_kg * gravity;
    const std::int32_t reach =
        std::min(static_cast<std::int32_t>(std::ceil(around_m / voxel_m)), map.radius() - 1);
    Search search(map, body.center[0] / voxel_m, body.center[1] / voxel_m);
    search.explore(reach);
    const std::int32_t stride = (2 * reach + most_in_a_row) / most_in_a_row;
    const std::int32_t half = reach / stride;
    Landscape::Places places;
    places.side = 2 * half + 1;
    places.step_m = stride * voxel_m;
    for (std::int32_t b = -half; b <= half; ++b) {
        for (std::int32_t a = -half; a <= half; ++a) {
            const std::int32_t i = map.start_i() + a * stride, j = map.start_j() + b * stride;
            const double cost = search.cost(i, j);
            double value = std::numeric_limits<double>::quiet_NaN();
            if (map.blocked(i, j)) {
                value = std::numeric_limits<double>::infinity();
            } else if (map.drop_m(i, j) > 0 && map.falls(i, j)) {
                value = -weight * map.drop_m(i, j);
            } else if (std::isfinite(cost)) {
                value = friction * weight * cost * voxel_m;
            }
            places.energy_J.push_back(static_cast<float>(value));
        }
    }
    return places;
}

SlideResult slide_one(const SolidCells& cells, const CellColumns& columns,
                      std::span<const std::int32_t> object, std::int32_t self,
                      const Footprint& foot, const MassProperties& body, double friction,
                      const SlideOptions& options) {
    SlideMap map(cells, columns, object, self, foot, body.center, longest_slide_m, options.unseen);
    if (!options.stances.empty()) map.stand(options.stances[self]);
    const double x = body.center[0] / cells.voxel_m, y = body.center[1] / cells.voxel_m;
    const Search::Way way = Search(map, x, y).run();
    SlideResult result;
    const bool found = way.found && way.length * cells.voxel_m <= longest_slide_m;
    if (options.places)
        result.places = places_around(
            map, body, std::clamp(1.3 * (found ? way.length * cells.voxel_m : 0), 0.3, 1.5),
            friction, cells.voxel_m);
    result.straight = straight_slides(map, {x, y}, options.ways);
    if (!found) return result;
    const double weight = body.mass_kg * gravity;
    result.found = true;
    result.distance_m = way.length * cells.voxel_m;
    result.drop_m = map.drop_m(way.i, way.j);
    result.absorbed_J = friction * weight * result.distance_m;
    result.released_J = weight * result.drop_m;
    const double dx = way.x - x, dy = way.y - y, length = std::hypot(dx, dy);
    if (length > 0) result.direction = {dx / length, dy / length, 0};
    std::int32_t reach = 3;
    for (const Footprint::Column& c : foot.columns)
        reach = std::max(reach, std::abs(c.i - map.start_i()));
    const std::int32_t below = foot.support - map.drop_voxels(way.i, way.j);
    result.edge = border_at(map, way.i, way.j, std::min(reach, 50), cells.voxel_m,
                            (foot.support + 1) * cells.voxel_m);
    const auto [first, last] = columns.at(way.i, way.j);
    for (std::size_t n = first; n < last; ++n)
        if (cells.k[n] == below) result.onto = cells.primitive[n];
    return result;
}

// Throws where a primitive has no object among `objects`.
std::vector<std::int32_t> object_of_cells(const SolidCells& cells,
                                          std::span<const std::int32_t> object_of_primitive,
                                          std::size_t objects) {
    std::vector<std::int32_t> object(cells.size(), -1);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p < 0) continue;
        if (static_cast<std::size_t>(p) >= object_of_primitive.size() ||
            object_of_primitive[p] >= static_cast<std::int64_t>(objects)) {
            throw Error(ErrorKind::usage, "slide_all: primitive " + std::to_string(p) +
                                              " has no object among " + std::to_string(objects));
        }
        object[n] = object_of_primitive[p];
    }
    return object;
}

}  // namespace

std::vector<SlideResult> slide_all(const SolidCells& cells,
                                   std::span<const std::int32_t> object_of_primitive,
                                   std::span<const MassProperties> objects,
                                   std::span<const double> friction, const SlideOptions& options) {
    if (friction.size() != objects.size()) {
        throw Error(ErrorKind::usage, "slide_all: " + std::to_string(friction.size()) +
                                          " friction coefficients for " +
                                          std::to_string(objects.size()) + " objects");
    }
    if (!options.stances.empty() && options.stances.size() != objects.size()) {
        throw Error(ErrorKind::usage, "slide_all: " + std::to_string(options.stances.size()) +
                                          " stances for " + std::to_string(objects.size()) +
                                          " objects");
    }
    const std::vector<std::int32_t> object =
        object_of_cells(cells, object_of_primitive, objects.size());
    const CellColumns columns(cells);
    std::vector<Footprint> feet = footprints(cells, object, objects.size());
    std::vector<SlideResult> results(objects.size());
    const auto slide = [&](std::size_t o) {
        const auto self = static_cast<std::int32_t>(o);
        find_support(cells, columns, object, self,
                     options.stances.empty() ? KnownFooting{} : options.stances[o], feet[o]);
        if (!feet[o].stands && !options.stances.empty() && !options.stances[o].polygon.empty()) {
            feet[o].support = static_cast<std::int32_t>(
                                  std::lround(options.stances[o].height_m / cells.voxel_m)) -
                              1;
            feet[o].stands = true;
        }
        if (!feet[o].stands || !(objects[o].mass_kg > 0)) return;
        results[o] =
            slide_one(cells, columns, object, self, feet[o], objects[o], friction[o], options);
    };
    if (options.threads) {
        options.threads->each(objects.size(), 1, slide);
    } else {
        for (std::size_t o = 0; o < objects.size(); ++o) slide(o);
    }
    return results;
}

std::vector<Landscape::Places> places_of(const SolidCells& cells,
                                         std::span<const std::int32_t> object_of_primitive,
                                         std::span<const MassProperties> objects,
                                         std::span<const std::size_t> chosen,
                                         std::span<const double> friction, double reach_m,
                                         const Unseen& unseen) {
    const std::vector<std::int32_t> object =
        object_of_cells(cells, object_of_primitive, objects.size());
    const CellColumns columns(cells);
    std::vector<Footprint> feet = footprints(cells, object, objects.size());
    std::vector<Landscape::Places> out;
    for (const std::size_t o : chosen) {
        const auto self = static_cast<std::int32_t>(o);
        find_support(cells, columns, object, self, {}, feet[o]);
        out.emplace_back();
        if (!feet[o].stands || !(objects[o].mass_kg > 0)) continue;
        SlideMap map(cells, columns, object, self, feet[o], objects[o].center, reach_m, unseen);
        out.back() = places_around(map, objects[o], reach_m, friction[o], cells.voxel_m);
    }
    return out;
}

}  // namespace topple::physics
