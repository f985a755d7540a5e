// SPDX-License-Identifier: MIT
#include "report/view_data.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>

#include "core/extents.h"
#include "core/field_rules.h"
#include "core/scene_bounds.h"
#include "report/cell_colours.h"
#include "report/cells.h"
#include "report/field_arrows.h"
#include "report/open_sides.h"
#include "report/part_spots.h"
#include "report/surface_packer.h"
#include "report/view_frame.h"

namespace topple::report {
namespace {

// The pairs of primitive and object that occur, numbered as they come. Group 0 is (-1, -1); what
// does not fit into 16 bits joins it.
class Groups {
  public:
    explicit Groups(std::vector<std::pair<std::int32_t, std::int32_t>>& pairs) : pairs_(pairs) {
        of(-1, -1);
    }
    std::uint16_t of(std::int32_t primitive, std::int32_t object) {
        const std::pair pair(std::max(primitive, -1), std::max(object, -1));
        const auto found = ids_.find(pair);
        if (found != ids_.end()) return found->second;
        if (pairs_.size() > 65535) return 0;
        pairs_.push_back(pair);
        return ids_[pair] = static_cast<std::uint16_t>(pairs_.size() - 1);
    }

  private:
    std::vector<std::pair<std::int32_t, std::int32_t>>& pairs_;
    std::map<std::pair<std::int32_t, std::int32_t>, std::uint16_t> ids_;
};

// As of Record.
std::array<std::int8_t, 4> aux(const Vec3& normal, int flags) {
    const auto byte = [&](std::size_t axis) {
        return static_cast<std::int8_t>(std::lround(std::clamp(normal[axis], -1.0, 1.0) * 127));
    };
    return {byte(0), byte(1), byte(2), static_cast<std::int8_t>(flags)};
}

Vec3 as_vec3(const std::array<float, 3>& v) {
    return {double{v[0]}, double{v[1]}, double{v[2]}};
}

}  // namespace

class ViewPacker::Work {
  public:
    Work(const Scene& scene, const ViewLimits& limits, bool with_surfaces)
        : scene_(scene), limits_(limits), with_surfaces_(with_surfaces), groups_(view_.groups) {
        view_.view_from_input = view_frame(scene);
        view_.coloured = !scene.points.red.empty();
        // With colours a record takes 16 bytes, without them 12.
        if (view_.coloured) {
            limits_.voxels = limits_.voxels / 4 * 3;
            limits_.points = limits_.points / 4 * 3;
        }
        for (const auto& object : scene.objects) {
            if (object.grounded) grounded_.insert(object.id);
        }
        measure();
        pack_voxels();
        pack_points();
        for (const auto& [name, field] : scene_.fields)
            view_.fields[name] =
                pack_arrows(field, view_.view_from_input, 2 * view_.cube_m, limits_.arrows);
        view_.walks = pack_walks(scene_.walks, view_.view_from_input, limits_.walk_cells);
    }

    PackedView pack(std::span<const ObjectSurface> surfaces, ThreadPool& pool) {
        pack_surfaces(surfaces, pool);
        return std::move(view_);
    }

    const Records& points() const { return view_.points; }

  private:
    // What is fixed to the ground, or belongs to no object: it may be looked through.
    bool is_background(std::int32_t object) const {
        return object < 0 || grounded_.contains(object);
    }
    template <class Cloud>
    Vec3 place(const Cloud& cloud, std::size_t i) const {
        return turned(view_.view_from_input, {cloud.x[i], cloud.y[i], cloud.z[i]});
    }

    // Whether a place is drawn: strays far from all others would leave the rest no steps.
    bool drawn(const Vec3& p) const {
        return rules::finite(p) &&
               bounds_.contains(static_cast<float>(p[0]), static_cast<float>(p[1]),
                                static_cast<float>(p[2]));
    }

    // The box of all that is drawn, and how it divides into steps: 65,535 at most, and none finer
    // than shows.
    void measure() {
        std::array<std::vector<float>, 3> at;
        const auto add = [&](const auto& cloud) {
            for (std::size_t i = 0; i < cloud.x.size(); ++i) {
                const auto p = place(cloud, i);
                if (!rules::finite(p)) continue;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    at[axis].push_back(static_cast<float>(p[axis]));
            }
        };
        add(scene_.solid);
        add(scene_.points);
        if (at[0].empty()) at[0] = at[1] = at[2] = {0};
        bounds_ = scene_bounds<float>({at[0], at[1], at[2]}, 0.01f);
        // Surfaces reach beyond the middles of their voxels.
        const double margin = with_surfaces_ ? 2 * scene_.voxel_size_m : 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            view_.origin_m[axis] = bounds_.low[axis] - margin;
            const double extent = double{bounds_.high[axis]} - bounds_.low[axis] + 2 * margin;
            view_.step_m[axis] = std::max({extent / 65535, 1e-3 / 65535, scene_.voxel_size_m / 16});
        }
        for (std::size_t i = 0; i < scene_.solid.x.size(); ++i) {
            const auto p = place(scene_.solid, i);
            if (!drawn(p)) continue;
            solid_box_.add(p);
            if (scene_.solid.object[i] >= 0) ++voxels_of_object_[scene_.solid.object[i]];
        }
    }

    std::array<std::uint16_t, 4> quantised(const Vec3& p, std::uint16_t group) const {
        std::array<std::uint16_t, 4> cell{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double steps = (p[axis] - view_.origin_m[axis]) / view_.step_m[axis];
            cell[axis] = static_cast<std::uint16_t>(std::lround(std::clamp(steps, 0.0, 65535.0)));
        }
        cell[3] = group;
        return cell;
    }

    // Index of the cube of edge `edge` that a place lies in.
    std::array<std::int32_t, 3> index_of(const Vec3& p, double edge) const {
        std::array<std::int32_t, 3> index{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double cubes =
                std::floor((p[axis] - solid_box_.low[axis]) / edge + lattice_shift_);
            index[axis] = static_cast<std::int32_t>(std::clamp(cubes, -1e6, 1e6));
        }
        return index;
    }

    // The solid voxels as cells of the given edge. A cell that holds voxels of several objects is
    // the smallest one's, so that no object vanishes where cells are large.
    std::vector<Cell> cells_of(double edge, CellTable& table) {
        const auto& solid = scene_.solid;
        std::vector<Cell> cells;
        std::vector<std::uint64_t> size_of_owner;
        for (std::size_t i = 0; i < solid.x.size(); ++i) {
            const auto p = place(solid, i);
            if (!drawn(p)) continue;
            Cell cell;
            cell.index = index_of(p, edge);
            cell.group = groups_.of(solid.primitive[i], solid.object[i]);
            cell.background = is_background(solid.object[i]);
            cell.completed = solid.state[i] != 0;
            const auto size = object_size(solid.object[i]);
            const auto at = table.insert(cell.index, static_cast<std::uint32_t>(cells.size()));
            if (at == cells.size()) {
                cells.push_back(cell);
                size_of_owner.push_back(size);
            } else if (size < size_of_owner[at]) {
                cells[at] = cell;
                size_of_owner[at] = size;
            }
        }
        return cells;
    }

    // Voxels of an object; what belongs to none counts as largest.
    std::uint64_t object_size(std::int32_t object) const {
        const auto found = voxels_of_object_.find(object);
        return found == voxels_of_object_.end() ? UINT64_MAX : found->second;
    }

    // How many voxels along the edge of the first cubes to try. The voxels of the surface are what
    // is exposed, and cubes of n voxels' edge show an n^2-th of them: here still a little too many.
    int first_merge() const {
        const auto surface = std::ranges::count(scene_.solid.state, 0);
        const double too_many = static_cast<double>(surface) /
                                static_cast<double>(std::max<std::size_t>(limits_.voxels, 1));
        return std::clamp(static_cast<int>(0.8 * std::sqrt(too_many)), 1, 64);
    }

    void pack_voxels() {
        view_.voxels.total = scene_.solid.x.size();
        view_.cube_m = scene_.voxel_size_m > 0 ? scene_.voxel_size_m : 0.02;
        if (solid_box_.empty()) return;
        for (int merge = first_merge();; ++merge) {
            const double edge = view_.cube_m * merge;
            // The lowest centre lies half a voxel into its cube.
            lattice_shift_ = 0.5 / merge;
            CellTable table;
            auto cells = cells_of(edge, table);
            // A scene of things far apart is not coarsened without end.
            if (mark_exposed(cells, table) > limits_.voxels && merge < 64) continue;
            add_normals(cells, table, edge);
            find_spots(cells, table, edge);
            if (view_.coloured) find_colours(cells, table, edge);
            write_cells(cells, edge);
            view_.cube_m = edge;
            cells_ = std::move(cells);
            table_ = std::move(table);
            return;
        }
    }

    // The centre of a cube of edge `edge`.
    Vec3 centre_of(const Cell& cell, double edge) const {
        Vec3 p;
        for (std::size_t axis = 0; axis < 3; ++axis)
            p[axis] = solid_box_.low[axis] + (cell.index[axis] + 0.5 - lattice_shift_) * edge;
        return p;
    }

    // By group, in the input's frame.
    void find_spots(const std::vector<Cell>& cells, const CellTable& table, double edge) {
        const auto chosen = inner_cells(cells, table, view_.groups.size());
        std::vector<std::optional<Vec3>> near(view_.groups.size());
        for (std::size_t g = 0; g < near.size(); ++g) {
            if (chosen[g] == CellTable::absent || view_.groups[g].first < 0) continue;
            near[g] = turned_back(view_.view_from_input, centre_of(cells[chosen[g]], edge));
        }
        view_.spots = nearest_points(scene_.points, view_.groups, std::move(near));
    }

    void add_normals(std::vector<Cell>& cells, const CellTable& table, double edge) {
        const auto& points = scene_.points;
        for (std::size_t i = 0; i < points.nx.size(); ++i) {
            const auto p = place(points, i);
            if (!rules::finite(p)) continue;
            const auto found = table.find(index_of(p, edge));
            if (found == CellTable::absent) continue;
            const auto n =
                turned(view_.view_from_input, {points.nx[i], points.ny[i], points.nz[i]});
            if (!rules::finite(n)) continue;
            for (std::size_t axis = 0; axis < 3; ++axis)
                cells[found].normal[axis] += static_cast<float>(n[axis]);
        }
        std::array<double, 3> centre{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            centre[axis] = (solid_box_.high[axis] - solid_box_.low[axis]) / edge / 2;
        face_open_sides(cells, table, spread_normals(cells, table), centre, edge);
    }

    Rgb8 colour_of_point(std::size_t i) const {
        const auto& points = scene_.points;
        return {points.red[i], points.green[i], points.blue[i]};
    }

    // From the points of a cell's own object: where two touch, neither takes on the other's colour.
    void find_colours(const std::vector<Cell>& cells, const CellTable& table, double edge) {
        const auto& points = scene_.points;
        std::vector<std::array<std::int32_t, 3>> index;
        std::vector<std::int32_t> object;
        for (const Cell& cell : cells) {
            index.push_back(cell.index);
            object.push_back(view_.groups[cell.group].second);
        }
        CellColours colours(cells.size());
        for (std::size_t i = 0; i < points.x.size(); ++i) {
            const auto p = place(points, i);
            if (!rules::finite(p)) continue;
            const auto found = table.find(index_of(p, edge));
            if (found == CellTable::absent || object[found] != std::max(points.object[i], -1))
                continue;
            colours.add(found, colour_of_point(i));
        }
        colours_ = colours.spread(table, index, object);
    }

    static std::array<std::uint8_t, 4> photo(const std::optional<Rgb8>& colour) {
        if (!colour) return {};
        return {(*colour)[0], (*colour)[1], (*colour)[2], 255};
    }

    void write_cells(const std::vector<Cell>& cells, double edge) {
        auto& out = view_.voxels;
        for (const auto& cell : cells) {
            if (cell.exposed == 0 || out.cell.size() == limits_.voxels) continue;
            Record record{quantised(centre_of(cell, edge), cell.group),
                          aux(as_vec3(cell.normal), cell.exposed | (cell.completed ? 64 : 0))};
            if (view_.coloured) record.photo = photo(colours_[&cell - cells.data()]);
            out.add(record, view_.coloured);
        }
    }

    // In place of the voxels, where it is not too large.
    void pack_surfaces(std::span<const ObjectSurface> surfaces, ThreadPool& pool) {
        if (surfaces.empty() || cells_.empty()) return;
        const auto group_of = [&](const ObjectSurface& surface, std::int32_t primitive) {
            return groups_.of(primitive, surface.object);
        };
        view_.surface = report::pack_surfaces(
            surfaces, {view_.coloured, group_of, std::bind_front(&Work::vertex_of, this)},
            limits_.surface_bytes, pool);
        if (view_.surface.index.empty()) return;
        const std::size_t total = view_.voxels.total;
        view_.voxels = {};
        view_.voxels.total = total;
    }

    Record vertex_of(const ObjectSurface& surface, std::size_t v, std::uint16_t group) const {
        const Vec3 p = turned(view_.view_from_input, surface.vertex[v]),
                   n = turned(view_.view_from_input, surface.normal[v]);
        Record out;
        out.cell = quantised(p, group);
        const bool background = is_background(surface.object);
        const Cell* cell = cell_below(p, n, background);
        const auto facing = background && cell ? direction_code(cell->normal) : no_direction;
        out.aux = aux(n, facing + (cell && cell->completed ? 64 : 0));
        if (!surface.colour.empty()) out.photo = photo(surface.colour[v]);
        return out;
    }
    // What is drawn of the voxels below a place of the surface, or beside it. Of the background,
    // one that faces as the surface does or away from it goes before those of walls that meet it
    // there.
    const Cell* cell_below(const Vec3& p, const Vec3& normal, bool background) const {
        constexpr float same = 0.7f;  // cosine
        const auto cell_at = [&](const std::array<std::int32_t, 3>& index) -> const Cell* {
            const auto found = table_.find(index);
            return found == CellTable::absent || cells_[found].background != background
                       ? nullptr
                       : &cells_[found];
        };
        const auto aligned = [&](const Cell& cell) {
            return std::abs(dot(normal, as_vec3(cell.normal)));
        };
        const Cell* nearest = nullptr;
        for (const double depth : {0.5, 1.0, 0.0}) {
            const Vec3 at = along(p, -(depth * view_.cube_m), normal);
            const Cell* cell = cell_at(index_of(at, view_.cube_m));
            if (cell && (!background || aligned(*cell) > same)) return cell;
            if (!nearest) nearest = cell;
        }
        if (nearest && !background) return nearest;
        const Cell* best = nearest;
        double most = nearest ? same : -1;
        const auto middle = index_of(p, view_.cube_m);
        for (int n = 0; n < 125; ++n) {
            const Cell* cell =
                cell_at({middle[0] + n / 25 - 2, middle[1] + n / 5 % 5 - 2, middle[2] + n % 5 - 2});
            if (!cell || aligned(*cell) <= most) continue;
            most = aligned(*cell);
            best = cell;
        }
        return best;
    }

    void pack_points() {
        const auto& points = scene_.points;
        auto& out = view_.points;
        out.total = points.x.size();
        for (std::size_t i = 0; i < points.x.size(); ++i) {
            // A hash of the number picks about limits_.points of them, evenly over any order.
            std::uint64_t hash = (i + 1) * 0x9E3779B97F4A7C15u;
            hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9u;
            const double draw = static_cast<double>((hash ^ (hash >> 27)) >> 11) * 0x1p-53;
            if (draw * static_cast<double>(out.total) >= static_cast<double>(limits_.points))
                continue;
            const auto p = place(points, i);
            if (!drawn(p)) continue;
            Record record{quantised(p, groups_.of(points.primitive[i], points.object[i]))};
            Vec3 n{};
            if (!points.nx.empty())
                n = turned(view_.view_from_input, {points.nx[i], points.ny[i], points.nz[i]});
            if (!rules::finite(n)) n = {};
            if (points.nx.empty() && is_background(points.object[i])) n = background_normal(p);
            record.aux = aux(n, 0);
            if (view_.coloured) {
                const Rgb8 colour = colour_of_point(i);
                if (colour != Rgb8{0, 0, 0}) record.photo = photo(colour);
            }
            out.add(record, view_.coloured);
        }
    }

    // Of the cell that a place lies in; 0 where there is none.
    Vec3 background_normal(const Vec3& p) const {
        if (cells_.empty()) return {};
        const auto found = table_.find(index_of(p, view_.cube_m));
        if (found == CellTable::absent || !cells_[found].background) return {};
        return as_vec3(cells_[found].normal);
    }

    const Scene& scene_;
    ViewLimits limits_;
    bool with_surfaces_;
    PackedView view_;
    Groups groups_;
    std::set<std::int32_t> grounded_;
    std::map<std::int32_t, std::uint64_t> voxels_of_object_;
    Bounds<float> bounds_;
    Extents<double> solid_box_;
    double lattice_shift_ = 0.5;
    std::vector<Cell> cells_;                   // what is drawn, cubes of view_.cube_m
    CellTable table_;                           // finds them
    std::vector<std::optional<Rgb8>> colours_;  // of what is drawn, where the scan has colours
};

ViewPacker::ViewPacker(const Scene& scene, const ViewLimits& limits, bool with_surfaces)
    : work_(std::make_unique<Work>(scene, limits, with_surfaces)) {}
ViewPacker::~ViewPacker() = default;

PackedView ViewPacker::pack(std::span<const ObjectSurface> surfaces, ThreadPool& pool) {
    return work_->pack(surfaces, pool);
}

const Records& ViewPacker::points() const {
    return work_->points();
}

PackedView pack_view(const Scene& scene, const ViewLimits& limits,
                     std::span<const ObjectSurface> surfaces) {
    ThreadPool alone(1);
    return ViewPacker(scene, limits, !surfaces.empty()).pack(surfaces, alone);
}

}  // namespace topple::report
