// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "device/queue.h"
#include "physics/support_rows.h"
#include "support_function.hpp"
#include "topple/error.h"

namespace topple::physics {
namespace {

constexpr std::uint64_t tile_bytes = 64U << 20;  // of the table, half of the smallest binding
constexpr std::size_t batch_vertices = std::size_t{8} << 20;  // 32 MiB per coordinate

double longest_edge(const SphereMesh& mesh) {
    double least = 1;
    for (std::size_t v = 0; v < mesh.size(); ++v) {
        for (std::size_t k = 0; k < 6; ++k) {
            const std::size_t w = mesh.neighbour[v * 6 + k];
            least = std::min(least, double{mesh.x[v]} * mesh.x[w] + double{mesh.y[v]} * mesh.y[w] +
                                        double{mesh.z[v]} * mesh.z[w]);
        }
    }
    return std::acos(least);
}

void check_mesh(const SphereMesh& mesh) {
    const std::size_t n = mesh.size();
    if (n < 12 || n > (std::size_t{1} << 27) || mesh.y.size() != n || mesh.z.size() != n ||
        mesh.neighbour.size() != 6 * n ||
        std::any_of(mesh.neighbour.begin(), mesh.neighbour.end(), [&](auto w) { return w >= n; })) {
        throw Error(ErrorKind::usage, "SupportTable: the mesh of " + std::to_string(n) +
                                          " directions is no geodesic_sphere");
    }
}

// Directions [first, first + count) of one coordinate; what lies beyond the mesh repeats direction
// 0.
std::vector<float> padded_part(const std::vector<float>& axis, std::uint32_t first,
                               std::uint32_t count) {
    std::vector<float> part(count);
    for (std::uint32_t n = 0; n < count; ++n) {
        part[n] = first + n < axis.size() ? axis[first + n] : axis[0];
    }
    return part;
}

void make_tiles(device::Device& device, SupportTable::Rows& rows) {
    const std::uint64_t primitives = rows.origin.size();
    const std::uint64_t row_bytes =
        direction_block * sizeof(float) * std::max<std::uint64_t>(primitives, 1);
    if (row_bytes > 2 * tile_bytes) {
        throw Error(ErrorKind::device,
                    "support table: " + std::to_string(primitives) +
                        " primitives are more than the " +
                        std::to_string(2 * tile_bytes / direction_block / sizeof(float)) +
                        " that one tile can hold; use a larger ParseOptions::voxel_m");
    }
    const std::uint64_t blocks = std::max<std::uint64_t>(1, tile_bytes / row_bytes);
    for (std::uint32_t first = 0; first < rows.padded;) {
        SupportTable::Rows::Tile tile;
        tile.first = first;
        tile.directions = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(rows.padded - first, blocks * direction_block));
        const auto upload = [&](const std::vector<float>& axis, const char* name) {
            const std::vector<float> part = padded_part(axis, first, tile.directions);
            return device::Buffer<float>(device, std::span<const float>(part), name);
        };
        tile.dx = upload(rows.mesh.x, "directions x");
        tile.dy = upload(rows.mesh.y, "directions y");
        tile.dz = upload(rows.mesh.z, "directions z");
        tile.s = device::Buffer<float>(device, primitives * tile.directions, "support table");
        first += tile.directions;
        rows.tiles.push_back(std::move(tile));
    }
}

// Runs support_function for the primitives, in batches of vertices.
void tabulate(device::Device& device, SupportTable::Rows& rows) {
    const std::size_t count = rows.vertices.size();
    for (std::size_t from = 0; from < count;) {
        std::vector<float> coordinate[3];
        std::vector<std::uint32_t> first;
        std::size_t to = from;
        for (; to < count &&
               (to == from || coordinate[0].size() + rows.vertices[to].size() <= batch_vertices);
             ++to) {
            first.push_back(static_cast<std::uint32_t>(coordinate[0].size()));
            for (const Vec3& v : rows.vertices[to]) {
                for (std::size_t a = 0; a < 3; ++a)
                    coordinate[a].push_back(static_cast<float>(v[a]));
            }
        }
        device::Buffer<float> vx(device, std::span<const float>(coordinate[0]), "hull vertices x"),
            vy(device, std::span<const float>(coordinate[1]), "hull vertices y"),
            vz(device, std::span<const float>(coordinate[2]), "hull vertices z");
        device::Queue queue(device);
        for (SupportTable::Rows::Tile& tile : rows.tiles) {
            for (std::size_t p = from; p < to; ++p) {
                queue.add<kernels::SupportFunction>(
                    tile.directions,
                    {.vx = vx,
                     .vy = vy,
                     .vz = vz,
                     .dx = tile.dx,
                     .dy = tile.dy,
                     .dz = tile.dz,
                     .s = tile.s},
                    {.vertex_count = static_cast<std::uint32_t>(rows.vertices[p].size()),
                     .vertex_first = first[p - from],
                     .direction_count = tile.directions,
                     .output_first = static_cast<std::uint32_t>(p) * tile.directions});
            }
        }
        queue.run();
        from = to;
    }
}

void build(device::Device& device, SupportTable::Rows& rows) {
    const std::size_t n = rows.mesh.size();
    rows.padded =
        static_cast<std::uint32_t>((n + direction_block - 1) / direction_block * direction_block);
    rows.spacing = longest_edge(rows.mesh);
    std::vector<std::uint32_t> planes(std::size_t{6} * rows.padded);
    for (std::uint32_t k = 0; k < 6; ++k) {
        for (std::uint32_t v = 0; v < rows.padded; ++v) {
            planes[std::size_t{k} * rows.padded + v] =
                v < n ? rows.mesh.neighbour[std::size_t{v} * 6 + k] : v;
        }
    }
    rows.neighbour = device::Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(planes),
                                                   "mesh neighbours");
    make_tiles(device, rows);
    tabulate(device, rows);
}

// Moves vertices to an origin at the middle of their bounds: floats keep their accuracy far from
// the scene's origin.
Vec3 recentre(std::vector<Vec3>& vertices) {
    Vec3 origin{};
    if (vertices.empty()) return origin;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto [low, high] =
            std::minmax_element(vertices.begin(), vertices.end(),
                                [&](const Vec3& p, const Vec3& q) { return p[a] < q[a]; });
        origin[a] = ((*low)[a] + (*high)[a]) / 2;
    }
    for (Vec3& v : vertices) {
        for (std::size_t a = 0; a < 3; ++a) v[a] -= origin[a];
    }
    return origin;
}

}  // namespace

SupportTable::SupportTable(device::Device& device, const SolidCells& cells, std::int32_t primitives,
                           const SphereMesh& mesh)
    : rows_(std::make_unique<Rows>()) {
    if (primitives < 0) {
        throw Error(ErrorKind::usage,
                    "SupportTable: " + std::to_string(primitives) + " primitives");
    }
    check_mesh(mesh);
    rows_->mesh = mesh;
    rows_->resolution_m = cells.voxel_m;
    for (const auto& hull : voxel_hulls(cells, primitives)) {
        std::vector<Vec3> vertices;
        for (const auto& corner : hull) {
            vertices.push_back(
                {corner[0] * cells.voxel_m, corner[1] * cells.voxel_m, corner[2] * cells.voxel_m});
        }
        rows_->origin.push_back(recentre(vertices));
        rows_->vertices.push_back(std::move(vertices));
    }
    build(device, *rows_);
}

SupportTable::SupportTable(device::Device& device, std::span<const std::vector<Vec3>> vertices,
                           double resolution_m, const SphereMesh& mesh)
    : rows_(std::make_unique<Rows>()) {
    check_mesh(mesh);
    rows_->mesh = mesh;
    rows_->resolution_m = resolution_m;
    for (std::vector<Vec3> set : vertices) {
        for (const Vec3& v : set) {
            if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) {
                throw Error(ErrorKind::input, "SupportTable: a vertex of primitive " +
                                                  std::to_string(rows_->origin.size()) +
                                                  " is not finite");
            }
        }
        rows_->origin.push_back(recentre(set));
        rows_->vertices.push_back(std::move(set));
    }
    build(device, *rows_);
}

SupportTable::~SupportTable() = default;
SupportTable::SupportTable(SupportTable&&) noexcept = default;
std::int32_t SupportTable::primitives() const {
    return static_cast<std::int32_t>(rows_->origin.size());
}
const SphereMesh& SupportTable::mesh() const {
    return rows_->mesh;
}

}  // namespace topple::physics
