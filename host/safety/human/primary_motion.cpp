// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "core/random.h"
#include "physics/directions.h"
#include "safety/human/grid_line.h"
#include "safety/human/human_field.h"
#include "safety/human/walkable_map.h"

namespace topple::safety {
namespace {

constexpr std::uint32_t straight = 10000, diagonal = 14142;  // costs; sqrt 2 to 1e-5

bool can_step(const WalkableMap& map, std::uint32_t from, std::uint32_t to, float step_m) {
    return map.component[to] == map.component[from] &&
           std::fabs(map.floor_m[to] - map.floor_m[from]) <= step_m;
}

// Finds shortest paths; its arrays serve all searches.
class PathFinder {
  public:
    PathFinder(const WalkableMap& map, float step_m)
        : map_(map), step_m_(step_m), nodes_(map.size()) {}

    // The cells from start to goal, which lie in one component.
    std::vector<std::uint32_t> shortest(std::uint32_t start, std::uint32_t goal) {
        ++search_;
        open_ = {};
        reach(start, start, 0, goal);
        while (!open_.empty()) {
            const Entry entry = open_.top();
            open_.pop();
            if (entry.cell == goal) break;
            if (entry.cost != nodes_[entry.cell].cost + entry.to_go)
                continue;  // found cheaper since
            expand(entry.cell, goal);
        }
        if (nodes_[goal].search != search_) return {};
        std::vector<std::uint32_t> path{goal};
        while (path.back() != start) path.push_back(nodes_[path.back()].from);
        std::reverse(path.begin(), path.end());
        return path;
    }

    // The corners of the path when drawn straight wherever that is walkable.
    std::vector<std::uint32_t> straightened(const std::vector<std::uint32_t>& path) const {
        if (path.size() < 2) return path;
        std::vector<std::uint32_t> corners{path.front()};
        for (std::size_t at = 0; at + 1 < path.size();) {
            std::size_t next = at + 1;
            while (next + 1 < path.size() && walkable_line(path[at], path[next + 1])) ++next;
            corners.push_back(path[next]);
            at = next;
        }
        return corners;
    }

  private:
    struct Node {
        std::uint64_t cost = 0;
        std::uint32_t search = 0, from = 0;
    };
    struct Entry {
        std::uint64_t cost;  // so far and to go
        std::uint64_t to_go;
        std::uint32_t cell;
        bool operator<(const Entry& other) const {  // the queue's top is the largest
            return std::tie(other.cost, other.to_go, other.cell) < std::tie(cost, to_go, cell);
        }
    };

    std::uint64_t to_go(std::uint32_t from, std::uint32_t goal) const {
        const Place a = map_.place(from), b = map_.place(goal);
        const auto dx = static_cast<std::uint64_t>(std::abs(a.x - b.x));
        const auto dy = static_cast<std::uint64_t>(std::abs(a.y - b.y));
        return diagonal * std::min(dx, dy) + straight * (std::max(dx, dy) - std::min(dx, dy));
    }

    void reach(std::uint32_t cell, std::uint32_t from, std::uint64_t cost, std::uint32_t goal) {
        Node& node = nodes_[cell];
        if (node.search == search_ && node.cost <= cost) return;
        node = {cost, search_, from};
        const std::uint64_t rest = to_go(cell, goal);
        open_.push({cost + rest, rest, cell});
    }

    void expand(std::uint32_t cell, std::uint32_t goal) {
        const Place at = map_.place(cell);
        for (std::int64_t dy = -1; dy <= 1; ++dy) {
            for (std::int64_t dx = -1; dx <= 1; ++dx) {
                const Place to{at.x + dx, at.y + dy};
                if (to == at || !map_.inside(to)) continue;
                const std::uint32_t next = map_.index(to);
                if (!can_step(map_, cell, next, step_m_)) continue;
                reach(next, cell, nodes_[cell].cost + (dx && dy ? diagonal : straight), goal);
            }
        }
    }

    bool walkable_line(std::uint32_t a, std::uint32_t b) const {
        std::uint32_t last = a;
        return along_line(map_, map_.place(a), map_.place(b), [&](std::uint32_t cell) {
            const bool ok = can_step(map_, last, cell, step_m_);
            last = cell;
            return ok;
        });
    }

    const WalkableMap& map_;
    float step_m_;
    std::vector<Node> nodes_;
    std::uint32_t search_ = 0;
    std::priority_queue<Entry> open_;
};

}  // namespace

PrimaryMotion primary_motion(const WalkableMap& map, const HumanOptions& options) {
    PrimaryMotion motion;
    const std::size_t cells = map.size();
    motion.visits.assign(direction_count * cells, 0);
    if (map.walkable.empty() || options.paths == 0) return motion;
    motion.paths = options.paths;

    std::vector<std::vector<std::uint32_t>> members(static_cast<std::size_t>(map.components));
    for (const std::uint32_t c : map.walkable) {
        members[static_cast<std::size_t>(map.component[c])].push_back(c);
    }
    const auto step_m = static_cast<float>(std::max(options.step_height_m, map.voxel_m) + 1e-4);
    PathFinder finder(map, step_m);
    Random random(options.seed);
    std::vector<std::uint32_t> last_path(cells, 0);
    for (unsigned path = 1; path <= options.paths; ++path) {
        const std::uint32_t start = map.walkable[random.below(map.walkable.size())];
        const auto& others = members[static_cast<std::size_t>(map.component[start])];
        const std::uint32_t goal = others[random.below(others.size())];
        auto corners = finder.straightened(finder.shortest(start, goal));
        for (std::size_t leg = 1; leg < corners.size(); ++leg) {
            const Place a = map.place(corners[leg - 1]), b = map.place(corners[leg]);
            const unsigned heading =
                nearest_direction(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
            const unsigned back = (heading + direction_count / 2) % direction_count;
            along_line(map, a, b, [&](std::uint32_t cell) {
                if (last_path[cell] != path) {  // a walk counts once in each cell
                    last_path[cell] = path;
                    ++motion.visits[heading * cells + cell];
                    ++motion.visits[back * cells + cell];
                }
                return true;
            });
        }
        motion.corners.push_back(std::move(corners));
    }
    return motion;
}

Walks drawn_walks(const WalkableMap& map, const PrimaryMotion& motion) {
    Walks out;
    out.corner_m = {map.x0, map.y0, 0};
    out.along_x_m = {map.cell_m, 0, 0};
    out.along_y_m = {0, map.cell_m, 0};
    out.nx = map.nx;
    out.ny = map.ny;
    out.floor_m = map.floor_m;
    out.visits.assign(map.size(), -1.0f);
    for (const std::uint32_t c : map.walkable) {
        double sum = 0;
        for (unsigned d = 0; d < direction_count && motion.paths > 0; ++d)
            sum += motion.frequency(d, c, map.size());
        out.visits[c] = static_cast<float>(sum);
    }
    const std::size_t shown = std::min<std::size_t>(motion.corners.size(), max_shown_paths);
    for (std::size_t walk = 0; walk < shown; ++walk) {
        std::vector<Vec3> path;
        for (const std::uint32_t c : motion.corners[walk]) {
            const auto [x, y] = map.center(map.place(c));
            path.push_back({x, y, double{map.floor_m[c]}});
        }
        out.paths.push_back(std::move(path));
    }
    return out;
}

}  // namespace topple::safety
