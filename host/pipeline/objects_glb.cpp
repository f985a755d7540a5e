// SPDX-License-Identifier: MIT
#include "pipeline/objects_glb.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "core/colour_space.h"
#include "io/palette.h"
#include "io/write_glb.h"
#include "report/cell_colours.h"
#include "report/cells.h"
#include "report/drawing.h"

namespace topple {
namespace {

using Cell = std::array<std::int32_t, 3>;

std::map<std::int32_t, std::vector<Cell>> cells_of_objects(const Scene& scene,
                                                           const vdb::VoxelScene& voxels) {
    std::map<std::int32_t, std::vector<Cell>> out;
    const SolidCells cells = voxels.solid_cells();
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        const bool known = p >= 0 && static_cast<std::size_t>(p) < scene.primitives.size();
        const std::int32_t object =
            known ? scene.primitives[static_cast<std::size_t>(p)].object : -1;
        out[object].push_back({cells.i[n], cells.j[n], cells.k[n]});
    }
    return out;
}

std::array<std::uint8_t, 3> colour_of(const Scene& scene, std::int32_t id) {
    const auto o = static_cast<std::size_t>(id);
    if (id < 0 || o >= scene.objects.size() || scene.objects[o].grounded) return io::colour_of(-1);
    const double unsafety = scene.objects[o].unsafety;
    return report::colour_along(report::unsafety_ramp,
                                std::isfinite(unsafety) ? (unsafety - 1) / 9 : 0);
}

// The colours of the objects' voxels.
class VoxelColours {
  public:
    VoxelColours(const Scene& scene, const vdb::VoxelFrame& frame,
                 const std::map<std::int32_t, std::vector<Cell>>& cells_of) {
        for (const auto& [object, cells] : cells_of) {
            for (const Cell& cell : cells) {
                if (index_.empty()) first_ = cell;
                table_.insert(moved(cell), static_cast<std::uint32_t>(index_.size()));
                index_.push_back(moved(cell));
                object_.push_back(object);
            }
        }
        const ScenePoints& points = scene.points;
        report::CellColours colours(index_.size());
        for (std::size_t i = 0; i < points.x.size(); ++i) {
            const std::uint32_t found = table_.find(moved(cell_at(frame, points, i)));
            if (found == report::CellTable::absent || object_[found] != points.object[i]) continue;
            colours.add(found, {points.red[i], points.green[i], points.blue[i]});
        }
        seen_ = colours.spread(table_, index_, object_);
    }

    // Of a corner of an object's voxels, or a place on one of their sides: the mean of those around
    // it; else `otherwise`.
    Rgb8 at(const Vec3& corner, std::int32_t object, const Rgb8& otherwise) const {
        std::array<std::array<std::int32_t, 2>, 3> range{};
        for (std::size_t a = 0; a < 3; ++a) {
            const auto low = static_cast<std::int32_t>(std::floor(corner[a]));
            range[a] = {corner[a] > low ? low : low - 1, low};
        }
        std::array<unsigned, 3> sum{};
        unsigned count = 0;
        for (std::int32_t i = range[0][0]; i <= range[0][1]; ++i) {
            for (std::int32_t j = range[1][0]; j <= range[1][1]; ++j) {
                for (std::int32_t k = range[2][0]; k <= range[2][1]; ++k) {
                    const std::uint32_t found = table_.find(moved({i, j, k}));
                    if (found == report::CellTable::absent || object_[found] != object ||
                        !seen_[found].known)
                        continue;
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += seen_[found].colour[c];
                    ++count;
                }
            }
        }
        if (count == 0) return otherwise;
        Rgb8 out{};
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
        return out;
    }

  private:
    static Cell cell_at(const vdb::VoxelFrame& frame, const ScenePoints& points, std::size_t i) {
        Cell out{};
        for (std::size_t a = 0; a < 3; ++a) {
            const Vec3& row = frame.grid_from_input[a];
            const double at = (row[0] * points.x[i] + row[1] * points.y[i] + row[2] * points.z[i]) /
                              frame.voxel_m;
            out[a] = static_cast<std::int32_t>(std::clamp(std::floor(at), -1e9, 1e9));
        }
        return out;
    }
    // The table's indices are small.
    Cell moved(const Cell& cell) const {
        Cell out{};
        for (std::size_t a = 0; a < 3; ++a) {
            const std::int64_t from_first = std::int64_t{cell[a]} - first_[a];
            out[a] = static_cast<std::int32_t>(
                std::clamp<std::int64_t>(from_first, -(1 << 20) + 2, (1 << 20) - 2));
        }
        return out;
    }

    Cell first_{};
    report::CellTable table_;
    std::vector<Cell> index_;
    std::vector<std::int32_t> object_;
    std::vector<report::CellColours::Known> seen_;
};

// Faces of scans with colours end at multiples of so many voxels, so that corners show what varies
// along them.
constexpr std::int32_t coloured_faces = 2;

}  // namespace

void write_objects_glb(const std::filesystem::path& file, const Scene& scene,
                       const vdb::VoxelScene& voxels) {
    const vdb::VoxelFrame& frame = voxels.frame();
    const auto& grid = frame.grid_from_input;
    const auto cells_of = cells_of_objects(scene, voxels);
    std::optional<VoxelColours> colours;
    if (!scene.points.red.empty()) colours.emplace(scene, frame, cells_of);
    std::vector<io::GlbNode> nodes;
    for (const auto& [id, cells] : cells_of) {
        io::GlbNode node;
        node.name = id < 0 ? "unassigned" : "object " + std::to_string(id);
        node.colour = colour_of(scene, id);
        node.mesh = io::voxel_boundary(cells, colours ? coloured_faces : 0);
        for (Vec3& v : node.mesh.vertex) {
            if (colours) node.vertex_colour.push_back(colours->at(v, id, node.colour));
            Vec3 in_input{};
            for (std::size_t a = 0; a < 3; ++a) {
                for (std::size_t d = 0; d < 3; ++d)
                    in_input[d] += grid[a][d] * v[a] * frame.voxel_m;
            }
            v = in_input;
        }
        nodes.push_back(std::move(node));
    }
    const Vec3 &x = grid[0], &y = grid[1], &z = grid[2];
    io::write_glb(file, nodes, {x, z, Vec3{-y[0], -y[1], -y[2]}});
}

}  // namespace topple
