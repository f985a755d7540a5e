// SPDX-License-Identifier: MIT
#include "graph/contact_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/scan_gaps.h"
#include "core/thread_pool.h"
#include "graph/outline.h"
#include "graph/undersides.h"
#include "physics/tipping.h"
#include "solids/cell_shape.h"

namespace topple::graph {
namespace {

// Sorts places in `key` by their key, of equal ones in the order in which they come. Linear in the
// places and the range of keys.
void sort_by(std::span<const std::int32_t> key, std::vector<std::size_t>& places) {
    if (key.empty()) return;
    const auto ends = std::ranges::minmax(key);
    const std::int64_t low = ends.min;
    std::vector<std::size_t> first(static_cast<std::size_t>(ends.max - low) + 2, 0);
    const auto slot = [&](std::size_t n) { return static_cast<std::size_t>(key[n] - low); };
    for (const std::size_t n : places) ++first[slot(n) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::size_t> sorted(places.size());
    for (const std::size_t n : places) sorted[first[slot(n)]++] = n;
    places = std::move(sorted);
}

// Those of what is sorted by that member in which it is `key`.
template <class T>
std::span<const T> range_of(std::span<const T> sorted, std::int32_t key, std::int32_t T::*member) {
    const auto first = std::ranges::lower_bound(sorted, key, {}, member);
    const auto last = std::ranges::upper_bound(sorted, key, {}, member);
    return {first, last};
}

// Areas seen along one axis: each line of cells along it counts once for every primitive on it.
void add_silhouettes(const SolidCells& cells, std::span<const std::int32_t> u,
                     std::span<const std::int32_t> v, std::size_t axis, ContactGraph& graph) {
    std::vector<std::size_t> order(cells.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (const auto values : {v, u, std::span<const std::int32_t>(cells.primitive)})
        sort_by(values, order);
    const auto line = [&](std::size_t n) { return std::tuple(cells.primitive[n], u[n], v[n]); };
    Table<PrimitiveId, std::uint64_t> lines(graph.silhouette_m2.size());
    for (std::size_t n = 0; n < order.size(); ++n) {
        const std::int32_t p = cells.primitive[order[n]];
        if (p >= 0 && (n == 0 || line(order[n]) != line(order[n - 1]))) ++lines[p];
    }
    for (std::size_t p = 0; p < lines.size(); ++p)
        graph.silhouette_m2[p][axis] =
            static_cast<double>(lines[p]) * (cells.voxel_m * cells.voxel_m);
}

void add_corners(std::int32_t i, std::int32_t j, double h, std::vector<BorderPoint>& corners) {
    for (const int di : {0, 1}) {
        for (const int dj : {0, 1})
            corners.push_back({{(i + di) * h, (j + dj) * h}, solids::voxel_error * h});
    }
}

// A mean of heights: of those that patches tell, if any do.
struct MeanHeight {
    double sum[2] = {0, 0}, count[2] = {0, 0};
    void add(double height_m, bool bounded) {
        sum[bounded] += height_m;
        ++count[bounded];
    }
    double mean_m() const { return sum[count[1] > 0] / count[count[1] > 0]; }
};

// A column in which one primitive lies right above another: the lowest cell of the one, and the
// first layer that the other does not reach.
struct ContactColumn {
    std::int32_t i, j, k, top;
};

// The outlines of undersides: of the surfaces that bound them within voxels.
class Shapes {
  public:
    Shapes(const SolidCells& cells, const BoundaryCells& boundary)
        : boundary_(boundary),
          beside_(solids::border_columns(cells, boundary)),
          voxel_m_(cells.voxel_m) {}
    // Of a primitive's lowest cell in a column.
    void add(std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t primitive,
             std::vector<BorderPoint>& corners, MeanHeight* height = nullptr) const {
        if (boundary_.size() == 0) {
            add_corners(i, j, voxel_m_, corners);
            return;
        }
        for (const solids::UndersideCorner& c :
             solids::underside_of(boundary_, i, j, k, primitive, voxel_m_)) {
            corners.push_back({{c.at[0], c.at[1]}, c.error_m});
            if (height) height->add(c.at[2], c.bounded);
        }
    }

    // Whether the primitive goes on into the voxel below its lowest cell.
    bool goes_on_below(std::int32_t i, std::int32_t j, std::int32_t k,
                       std::int32_t primitive) const {
        const std::size_t n = boundary_.find(i, j, k - 1, primitive);
        return n != BoundaryCells::absent && boundary_.share[n] > 0;
    }
    // Columns that the primitive only reaches into.
    std::span<const solids::BorderColumn> beside(std::int32_t primitive) const {
        return range_of(std::span(beside_), primitive, &solids::BorderColumn::primitive);
    }
    // Of a primitive's highest cell in a column, the surface's height in voxels.
    double top(std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t primitive) const {
        return solids::top_of(boundary_, i, j, k, primitive, voxel_m_) / voxel_m_;
    }

  private:
    const BoundaryCells& boundary_;
    std::vector<solids::BorderColumn> beside_;
    double voxel_m_;
};

std::pair<std::int32_t, std::int32_t> ends(const physics::TouchingPair& pair) {
    return {pair.a, pair.b};
}

// Voxel faces with which one primitive carries another, or 0 where it does not. The border of two
// solids is a staircase of voxels; its steps cancel in the sum over its faces, which is the true
// area vector of the contact. Where it points sideways, some columns of the one lie on the other
// all the same, by chance.
double upward_faces(const std::vector<physics::TouchingPair>& pairs, std::int32_t supporter,
                    std::int32_t supported) {
    constexpr double steepest = 0.5;  // least share of the upward part in the sideways one
    const std::pair wanted{std::min(supporter, supported), std::max(supporter, supported)};
    const auto at = std::ranges::lower_bound(pairs, wanted, {}, ends);
    if (at == pairs.end() || ends(*at) != wanted) return 0;
    const auto net = [&](std::size_t axis) {
        return static_cast<double>(at->faces[2 * axis + 1]) -
               static_cast<double>(at->faces[2 * axis]);
    };
    const double up = supporter < supported ? net(2) : -net(2);
    return up >= steepest * std::hypot(net(0), net(1)) ? up : 0;
}

// Of a primitive's columns, in voxels.
struct Extent {
    std::int32_t i_low = std::numeric_limits<std::int32_t>::max(), i_high = 0, j_low = i_low,
                 j_high = 0;
    std::uint64_t columns = 0;
    double tops = 0;  // sum over the columns

    std::array<double, 2> middle() const {
        return {0.5 * (i_low + i_high + 1), 0.5 * (j_low + j_high + 1)};
    }
    bool holds(const std::array<double, 2>& point) const {
        return point[0] >= i_low && point[0] <= i_high + 1.0 && point[1] >= j_low &&
               point[1] <= j_high + 1.0;
    }
    double mean_top() const { return tops / static_cast<double>(columns); }
    void add(std::int32_t i, std::int32_t j, double top) {
        if (columns == 0) i_high = i, j_high = j;
        i_low = std::min(i_low, i), i_high = std::max(i_high, i);
        j_low = std::min(j_low, j), j_high = std::max(j_high, j);
        ++columns;
        tops += top;
    }
};

// The convex hull of a primitive's columns, seen from above: it may go on where it is hidden, but
// not beyond that.
std::vector<std::array<double, 2>> hull_of(const std::vector<Underside>& columns, double h) {
    std::vector<BorderPoint> corners;
    for (const Underside& u : columns) add_corners(u.i, u.j, h, corners);
    return graph::outline_of(corners).polygon;
}

// The columns that may rest on a surface at this height, within its outline if that is known:
// unseen from their underside down to it, or, where they end at it, for some way on: else it is air
// that they end in. What bounds them may tell that they reach the surface.
std::uint64_t add_hidden_corners(const std::vector<Underside>& undersides, double height_m,
                                 const std::vector<std::array<double, 2>>& outline, double h,
                                 std::int32_t primitive, const Shapes& shapes,
                                 std::vector<BorderPoint>& corners) {
    const auto within = [&](const auto& column) {
        return outline.empty() ||
               physics::footing(outline, (column.i + 0.5) * h, (column.j + 0.5) * h).margin_m > 0;
    };
    const double surface = height_m / h;
    std::uint64_t columns = 0;
    for (const Underside& u : undersides) {
        const double above = u.k - surface;
        const bool rests =
            above >= -1.5 && (u.unseen >= std::max(above - 0.5, 2.0) ||
                              (above <= 1.5 && shapes.goes_on_below(u.i, u.j, u.k, primitive)));
        if (!rests || !within(u)) continue;
        shapes.add(u.i, u.j, u.k, primitive, corners);
        ++columns;
    }
    for (const solids::BorderColumn& c : shapes.beside(primitive))
        if (std::abs(c.k - surface) <= 1.5 && within(c))
            shapes.add(c.i, c.j, c.k, primitive, corners);
    return columns;
}

// What is seen to carry, before its outline is known.
struct Carrier {
    std::int32_t supporter = -1, supported = -1;
    double area_m2 = 0;
    bool wide = false;  // it may go on where it is hidden
    std::span<const ContactColumn> columns;
};

// The outlines and heights of contacts: most of the time that contacts take.
void find_outlines(std::span<const Carrier> carriers,
                   const Table<ObjectId, std::vector<Underside>>& undersides, double h,
                   const Shapes& shapes, ThreadPool& threads, ContactGraph& graph) {
    Table<PrimitiveId, bool> asked(undersides.size(), false);
    std::vector<std::int32_t> wide;
    for (const Carrier& c : carriers) {
        const std::int32_t below = std::max(c.supporter, 0);
        if (!c.wide || asked[below]) continue;
        asked[below] = true;
        wide.push_back(below);
    }
    Table<PrimitiveId, std::vector<std::array<double, 2>>> hulls(undersides.size());
    threads.each(wide.size(), 1,
                 [&](std::size_t n) { hulls[wide[n]] = hull_of(undersides[wide[n]], h); });
    graph.carryings.resize(carriers.size());
    constexpr std::uint64_t at_once = 8;
    threads.each(carriers.size(), at_once, [&](std::size_t n) {
        const Carrier& c = carriers[n];
        std::vector<BorderPoint> corners;
        MeanHeight heights;
        for (const auto& [i, j, k, top] : c.columns) {
            heights.add(top * h, false);
            shapes.add(i, j, k, c.supported, corners, &heights);
        }
        const double height = heights.mean_m();
        if (c.wide)
            add_hidden_corners(undersides[c.supported], height, hulls[c.supporter], h, c.supported,
                               shapes, corners);
        Outline outline = graph::outline_of(corners);
        graph.carryings[n] = {
            c.supporter,    c.supported, c.area_m2, height, std::move(outline.polygon),
            outline.error_m};
    });
}

// Solid that belongs to no primitive is mostly noise: it carries what rests on it with this share
// of its columns.
constexpr double least_on_fragments = 0.15;

// What is not seen to hang, and is not seen to stand either, stands on the highest level surface
// under it: others hide its foot, and it hides its shadow on the table.
void add_hidden_carryings(const Table<ObjectId, std::vector<Underside>>& undersides,
                          const Table<PrimitiveId, Extent>& extents, double h, const Shapes& shapes,
                          ContactGraph& graph) {
    constexpr double least_hidden = 0.5;  // share of the columns below which nobody has seen
    std::vector<Carrying> found;
    for (std::int32_t p = 0; p < graph.primitives; ++p) {
        const std::vector<Underside>& own = undersides[p];
        if (own.empty() || !graph.carriers_of(p).empty()) continue;
        const Extent& e = extents[p];
        Carrying best;
        for (std::int32_t q = 0; q < graph.primitives; ++q) {
            const Extent& under = extents[q];
            if (q == p || under.columns < e.columns || !under.holds(e.middle())) continue;
            const double top = under.mean_top();
            if (top * h > graph.lowest_m[p] + 1.5 * h) continue;
            if (best.supporter < 0 || top * h > best.height_m) {
                best.supporter = q;
                best.height_m = top * h;
            }
        }
        if (best.supporter < 0) continue;
        std::vector<BorderPoint> corners;
        const auto columns =
            static_cast<double>(add_hidden_corners(own, best.height_m, {}, h, p, shapes, corners));
        if (columns < least_hidden * static_cast<double>(own.size())) continue;
        best.supported = p;
        best.area_m2 = columns * h * h;
        Outline outline = graph::outline_of(corners);
        best.outline = std::move(outline.polygon);
        best.border_error_m = outline.error_m;
        found.push_back(std::move(best));
    }
    for (Carrying& c : found) {
        physics::TouchingPair pair;
        pair.a = std::min(c.supporter, c.supported);
        pair.b = std::max(c.supporter, c.supported);
        pair.area_m2 = c.area_m2;
        pair.normal = {0, 0, c.supporter < c.supported ? 1.0 : -1.0};
        const Extent& e = extents[c.supported];
        pair.center = {e.middle()[0] * h, e.middle()[1] * h, c.height_m};
        const auto at = std::ranges::lower_bound(graph.pairs, ends(pair), {}, ends);
        if (at == graph.pairs.end() || ends(*at) != ends(pair)) graph.pairs.insert(at, pair);
        graph.carryings.push_back(std::move(c));
    }
    std::ranges::sort(graph.carryings, {},
                      [](const Carrying& c) { return std::pair(c.supported, c.supporter); });
}

// What is seen to hang must be held by something near it, although the scan shows a gap: the back
// of a cabinet is never seen, nor is what holds a screen.
// hidden: columns of air between two primitives (a, b), a < b, that nobody has seen into.
void add_hidden_joints(device::Device& device, const SolidCells& cells, std::int32_t primitives,
                       const std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t>& hidden,
                       ContactGraph& graph) {
    constexpr double longest_m = 0.08;
    constexpr double least_hidden = 0.3;  // of the columns between the two
    Table<PrimitiveId, bool> hangs(static_cast<std::size_t>(primitives), false);
    for (std::int32_t p = 0; p < primitives; ++p) hangs[p] = graph.carriers_of(p).empty();
    std::vector<physics::TouchingPair> joints;
    for (const physics::TouchingPair& pair : physics::touching_pairs(
             device, cells, primitives, static_cast<unsigned>(longest_m / cells.voxel_m))) {
        if (!hangs[pair.a] && !hangs[pair.b]) continue;
        if (std::ranges::binary_search(graph.pairs, ends(pair), {}, ends)) continue;
        if (std::abs(pair.normal[2]) > 0.5) {
            // Air that was seen is no joint.
            const auto at = hidden.find(ends(pair));
            const double columns = std::max(pair.faces[4], pair.faces[5]);
            if (at == hidden.end() || static_cast<double>(at->second) < least_hidden * columns)
                continue;
        }
        joints.push_back(pair);
    }
    graph.pairs.insert(graph.pairs.end(), joints.begin(), joints.end());
    std::ranges::sort(graph.pairs, {}, ends);
}

void add_leanings(ContactGraph& graph) {
    for (const physics::TouchingPair& pair : graph.pairs) {
        if (std::abs(pair.normal[2]) > 0.5) continue;
        Leaning leaning{pair.a, pair.b, pair.center[2], {}};
        for (std::size_t e = 0; e < 4; ++e) leaning.outline[e] = {pair.ends[e][0], pair.ends[e][1]};
        graph.leanings.push_back(leaning);
        std::swap(leaning.primitive, leaning.against);
        graph.leanings.push_back(leaning);
    }
    std::ranges::sort(graph.leanings, {},
                      [](const Leaning& l) { return std::pair(l.primitive, l.against); });
}

}  // namespace

std::span<const Carrying> ContactGraph::carriers_of(std::int32_t primitive) const {
    return range_of(std::span(carryings), primitive, &Carrying::supported);
}

std::span<const Leaning> ContactGraph::leanings_of(std::int32_t primitive) const {
    return range_of(std::span(leanings), primitive, &Leaning::primitive);
}

ContactGraph build_contact_graph(device::Device& device, const SolidCells& cells,
                                 std::int32_t primitives, const BoundaryCells& boundary) {
    ContactGraph graph;
    graph.primitives = primitives;
    graph.voxel_m = cells.voxel_m;
    const auto count = static_cast<std::size_t>(primitives);
    graph.silhouette_m2.assign(count, {0, 0, 0});
    graph.lowest_m.assign(count, std::numeric_limits<double>::infinity());
    graph.highest_m.assign(count, -std::numeric_limits<double>::infinity());
    graph.section_m2.assign(count, 0.0);
    graph.pairs = physics::touching_pairs(device, cells, primitives);
    add_silhouettes(cells, cells.j, cells.k, 0, graph);
    add_silhouettes(cells, cells.i, cells.k, 1, graph);
    add_silhouettes(cells, cells.i, cells.j, 2, graph);

    const double h = cells.voxel_m;
    const Shapes shapes(cells, boundary);
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<ContactColumn>>
        carried;  // (supported, supporter)
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint64_t> hidden;
    std::vector<std::int32_t> alone(count);  // each primitive as an object of its own
    std::iota(alone.begin(), alone.end(), 0);
    const Table<ObjectId, std::vector<Underside>> undersides =
        graph::undersides(cells, alone, count);
    Table<PrimitiveId, Extent> extents(count);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t upper = cells.primitive[n];
        if (upper < 0) continue;
        graph.lowest_m[upper] = std::min(graph.lowest_m[upper], cells.k[n] * h);
        graph.highest_m[upper] = std::max(graph.highest_m[upper], (cells.k[n] + 1) * h);
        graph.section_m2[upper] += h * h * h;
        const bool last = n + 1 == cells.size() || cells.i[n + 1] != cells.i[n] ||
                          cells.j[n + 1] != cells.j[n] || cells.primitive[n + 1] != upper;
        if (last)
            extents[upper].add(cells.i[n], cells.j[n],
                               shapes.top(cells.i[n], cells.j[n], cells.k[n], upper));
        // Cells are sorted by (i, j, k): the one below in the column, if any, comes right before.
        if (n == 0 || cells.i[n - 1] != cells.i[n] || cells.j[n - 1] != cells.j[n]) continue;
        const std::int32_t lower = cells.primitive[n - 1];
        if (lower == upper) continue;
        const std::int32_t empty = cells.k[n] - cells.k[n - 1] - 1;
        if (cells.unseen_below.empty() || cells.unseen_below[n] >= empty)
            ++hidden[std::minmax(upper, lower)];
        if (empty > static_cast<std::int32_t>(contact_gap)) continue;
        carried[{upper, lower}].push_back({cells.i[n], cells.j[n], cells.k[n], cells.k[n - 1] + 1});
    }
    for (std::size_t p = 0; p < count; ++p)
        if (graph.section_m2[p] > 0) graph.section_m2[p] /= graph.highest_m[p] - graph.lowest_m[p];
    std::vector<Carrier> carriers;
    for (const auto& [key, columns] : carried) {
        const auto& [supported, supporter] = key;
        const Extent& load = extents[supported];
        const auto met = static_cast<double>(columns.size());
        const bool fragments = supporter < 0;
        if (fragments && met < least_on_fragments * static_cast<double>(load.columns)) continue;
        const double area = fragments ? met : upward_faces(graph.pairs, supporter, supported);
        if (area <= 0) continue;
        // A surface at least half as wide may go on where it is hidden; a leg does not.
        const bool wide = !fragments && 2 * extents[supporter].columns >= load.columns;
        carriers.push_back({supporter, supported, area * h * h, wide, columns});
    }
    find_outlines(carriers, undersides, h, shapes, device.threads(), graph);
    add_leanings(graph);
    add_hidden_carryings(undersides, extents, h, shapes, graph);
    add_hidden_joints(device, cells, primitives, hidden, graph);
    return graph;
}

}  // namespace topple::graph
