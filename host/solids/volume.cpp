// SPDX-License-Identifier: MIT
#include "solids/volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/ranked.h"
#include "core/thread_pool.h"
#include "geometry/algebraic_model.h"
#include "geometry/ledges.h"
#include "geometry/split.h"
#include "geometry/surface_gaps.h"
#include "solids/boundary.h"
#include "solids/patches.h"
#include "solids/solid_places.h"

namespace topple {
namespace {

// The solids among so many primitives, by their voxels, numbered in their order.
std::vector<std::int32_t> solid_numbers(const SolidCells& cells, std::size_t primitives) {
    std::vector<std::uint64_t> voxels(primitives, 0);
    for (const std::int32_t p : cells.primitive) {
        if (p >= 0) ++voxels[p];
    }
    std::vector<std::int32_t> number;
    std::int32_t next = 0;
    for (const std::uint64_t count : voxels) number.push_back(count >= least_voxels ? next++ : -1);
    return number;
}

// Of a normal along an axis, that what goes along it meets the one side or the other.
constexpr double least_across = 0.35;

// The faces of the primitives: what bounds the solids within their voxels.
struct Faces {
    std::vector<SurfacePatch> patches;
    solids::SeenCells seen;
    std::vector<bool> sheet;  // by primitive: of the shell, and seen from one side only
};

// Where patches were seen, and what lies between: gaps of sparse scans.
solids::SeenCells seen_and_between(const CloudView& cloud, const geometry::GapPoints& gaps,
                                   solids::PointLabels labels,
                                   const std::vector<std::int32_t>& number,
                                   const std::array<Vec3, 3>& axes, double voxel_m,
                                   ThreadPool& threads) {
    if (gaps.size() == 0) return solids::seen_cells({cloud, axes}, labels, voxel_m, threads);
    std::int32_t faces = 0;
    for (const std::int32_t f : labels.patch) faces = std::max(faces, f + 1);
    std::vector<bool> left(static_cast<std::size_t>(faces), false);
    for (const std::int32_t f : labels.patch)
        if (f >= 0) left[f] = true;
    const PointCloud all = geometry::with_gaps(cloud, gaps);
    for (std::size_t n = 0; n < gaps.size(); ++n) {
        const std::int32_t f = gaps.face[n];
        labels.primitive.push_back(number[gaps.primitive[n]]);
        labels.patch.push_back(f >= 0 && f < faces && left[f] ? f : -1);
    }
    return solids::seen_cells({all, axes}, labels, voxel_m, threads);
}

Faces find_faces(device::Device& device, const Observation& input, const Surfaces& geometry,
                 const geometry::GapPoints& gaps, const std::vector<std::int32_t>& number,
                 double voxel_m, std::span<const Role> roles) {
    const geometry::Regions& faces = geometry.primitives.faces;
    const solids::GridPoints points(input.cloud, geometry.frame.axes);
    const double cell_m = 2 * geometry.surfels.cell_m;
    solids::PointLabels labels{numbered(geometry.primitive_of_point, number), {}};
    labels.patch.reserve(points.size());
    for (const std::uint32_t s : geometry.surfels.of_point) labels.patch.push_back(faces.label[s]);
    Faces out;
    out.patches = solids::fit_patches(points, faces.regions, labels.patch, device.threads());
    solids::drop_explained(points, out.patches, cell_m, labels, device.threads());
    solids::add_narrow_faces(points, cell_m, out.patches, labels, device.threads());
    out.seen = seen_and_between(input.cloud, gaps, std::move(labels), number, geometry.frame.axes,
                                voxel_m, device.threads());
    out.sheet = solids::one_sided(out.seen, out.patches, roles.size());
    for (std::size_t p = 0; p < roles.size(); ++p)
        out.sheet[p] = out.sheet[p] && in_shell(roles[p]);
    return out;
}

// Of the shell's solids those that were seen from one side only, by what their surfels' faces look
// to.
std::vector<bool> find_sheets(const Surfaces& geometry, const std::vector<std::int32_t>& number,
                              std::span<const Role> roles) {
    const geometry::Surfels& s = geometry.surfels;
    const geometry::Regions& faces = geometry.primitives.faces;
    std::vector<Eigen::Vector3d> sum(roles.size(), Eigen::Vector3d::Zero());
    std::vector<double> count(roles.size(), 0.0);
    for (std::size_t n = 0; n < s.size(); ++n) {
        const std::int32_t face = faces.label[n], primitive = geometry.primitives.label[n];
        const std::int32_t p = primitive < 0 ? -1 : number[primitive];
        if (face < 0 || p < 0 || !in_shell(roles[p])) continue;
        const geometry::AlgebraicModel& model = faces.regions[face].model;
        sum[p] += geometry::gradient(model, geometry::position(s, n)).normalized();
        ++count[p];
    }
    std::vector<bool> out;
    for (std::size_t p = 0; p < roles.size(); ++p)
        out.push_back(in_shell(roles[p]) && sum[p].norm() >= solids::one_way * count[p]);
    return out;
}

// For each cell the unseen voxels right below it, up to what fits. What is below floors and behind
// walls is of no interest.
std::vector<std::uint8_t> unseen_below(const vdb::VolumeView& view,
                                       const std::vector<bool>& sheet) {
    const SolidCells& cells = view.cells();
    std::vector<std::uint8_t> out(cells.size(), 0);
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p < 0 || sheet[p]) continue;
        out[n] = static_cast<std::uint8_t>(
            view.unseen_run(moved(place_of(cells, n), 2, -1), 2, -1, 255));
    }
    return out;
}

// Of ledges those between solids.
std::vector<Ledge> between_solids(std::span<const Ledge> ledges,
                                  const std::vector<std::int32_t>& number) {
    std::vector<Ledge> out;
    for (const Ledge& l : ledges) {
        const std::int32_t above = number[l.above], below = number[l.below];
        if (above >= 0 && below >= 0) out.push_back({above, below, l.height_m});
    }
    return out;
}

// Strays are no body, and in no way.
struct Parted {
    SolidCells near, strays;
};
Parted part_strays(const SolidCells& cells, const vdb::VoxelScene& volume) {
    Parted out;
    out.near.voxel_m = out.strays.voxel_m = cells.voxel_m;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const bool in_bounds = volume.in_bounds(cells.i[n], cells.j[n], cells.k[n]);
        (in_bounds ? out.near : out.strays).add(cells, n, cells.primitive[n]);
    }
    return out;
}

std::shared_ptr<const SolidScene> solid_scene(device::Device& device, const Observation& input,
                                              const Surfaces& geometry,
                                              const geometry::GapPoints& gaps,
                                              std::span<const Ledge> ledges, Volume& volume,
                                              SolidCells cells, SolidDetail detail) {
    const bool within_voxels = detail == SolidDetail::within_voxels;
    std::vector<Role> roles = left_of(volume.number, geometry.role);
    Faces faces;
    if (within_voxels)
        faces = find_faces(device, input, geometry, gaps, volume.number, cells.voxel_m, roles);
    else
        faces.sheet = find_sheets(geometry, volume.number, roles);
    volume.sheet = faces.sheet;
    cells.unseen_below = unseen_below(vdb::VolumeView(*volume.scene, cells, roles), faces.sheet);
    Parted parted = part_strays(cells, *volume.scene);
    BoundaryCells boundary;
    if (within_voxels)
        boundary = solids::find_boundary(device, parted.near, faces.seen, std::move(faces.patches),
                                         faces.sheet, between_solids(ledges, volume.number));
    return std::make_shared<const SolidScene>(std::move(parted.near), std::move(roles),
                                              std::move(parted.strays), std::move(boundary));
}

SpaceCarving::Marks marks_of(const Observation& input, const Surfaces& geometry,
                             const geometry::GapPoints& gaps, const Rotation& grid_from_input) {
    SpaceCarving::Marks out{geometry.primitive_of_point, {}};
    out.label.insert(out.label.end(), gaps.primitive.begin(), gaps.primitive.end());
    if (input.viewpoints.empty() && input.cloud.nx.empty()) return out;
    const geometry::Surfels& s = geometry.surfels;
    std::vector<std::uint8_t> of_surfel(s.size(), 0);
    for (std::size_t n = 0; n < s.size(); ++n) {
        const Vec3 normal = turned(grid_from_input, {s.nx[n], s.ny[n], s.nz[n]});
        for (std::size_t a = 0; a < 3; ++a) {
            if (std::abs(normal[a]) < least_across) continue;
            of_surfel[n] |= static_cast<std::uint8_t>(1u << (2 * a + (normal[a] < 0 ? 1 : 0)));
        }
    }
    for (const std::uint32_t n : s.of_point) out.seen_side.push_back(of_surfel[n]);
    for (const std::uint32_t n : gaps.surfel) out.seen_side.push_back(of_surfel[n]);
    return out;
}

constexpr const char* fraction_field = "fraction";

}  // namespace

// The part of each voxel that is solid, of whichever primitives.
void store_fractions(const SolidScene& solids, vdb::VoxelScene& volume) {
    const SolidCells cells = solids.with_strays();
    const BoundaryCells& b = solids.boundary();
    std::vector<std::int32_t> i, j, k;
    std::vector<float> fraction;
    solids::each_solid_place(
        cells, b, [&](const Place& at, std::size_t n, std::size_t first, std::size_t last) {
            // A cell of which the boundary says nothing is solid as a whole.
            bool whole = n != solids::no_cell;
            std::uint32_t share = 0;
            for (std::size_t m = first; m < last; ++m) {
                share += b.share[m];
                whole = whole && b.primitive[m] != cells.primitive[n];
            }
            if (whole) share = BoundaryCells::whole;
            i.push_back(at[0]);
            j.push_back(at[1]);
            k.push_back(at[2]);
            fraction.push_back(static_cast<float>(std::min(share, BoundaryCells::whole)) /
                               static_cast<float>(BoundaryCells::whole));
        });
    volume.add_field(fraction_field, i, j, k, fraction);
}

void clear_lost_labels(const SolidScene& before, const SolidScene& now, vdb::VoxelScene& scene) {
    SolidCells cells = before.cells();
    const SolidCells& to = now.cells();
    std::vector<vdb::Claim> claims;
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (to.primitive[n] != cells.primitive[n])
            claims.push_back({place_of(to, n), to.primitive[n], to.basis[n]});
    vdb::commit(claims, scene, cells);
}

void take_likely(Volume& volume) {
    const SolidScene& before = *volume.solids;
    const SolidCells& were = before.cells();
    // Of cells that are not solid after all, what their surfaces left of them.
    const BoundaryCells& boundary = before.boundary();
    std::vector<bool> kept(boundary.size(), true);
    std::size_t n = 0;
    for (const vdb::Claim& claim : volume.likely) {
        while (n < were.size() && place_of(were, n) < claim.at) ++n;
        if (claim.solid || n == were.size() || place_of(were, n) != claim.at) continue;
        const std::size_t b = boundary.find(were.i[n], were.j[n], were.k[n], were.primitive[n]);
        if (b != BoundaryCells::absent) kept[b] = false;
    }
    SolidCells cells = were;
    vdb::commit(volume.likely, *volume.scene, cells);
    cells.unseen_below =
        unseen_below(vdb::VolumeView(*volume.scene, cells, before.roles()), volume.sheet);
    volume.solids = std::make_shared<const SolidScene>(std::move(cells), before.roles(),
                                                       before.strays(), boundary.only(kept));
    volume.likely.clear();
    store_fractions(*volume.solids, *volume.scene);
}

void take_away(const TakenAway& taken, vdb::VoxelScene& scene) {
    scene.relabel(taken.number);
    std::vector<vdb::Voxel> empty;
    for (const TakenAway::Voxel& v : taken.changed) {
        if (v.primitive < 0)
            empty.push_back(v.at);
        else
            scene.put_label(v.at[0], v.at[1], v.at[2], v.primitive);
    }
    scene.set_empty(empty);
    scene.remove_field(fraction_field);
    store_fractions(*taken.solids, scene);
}

vdb::FillOptions fill_options(const SolidCells& cells, std::span<const Role> roles, double top_m) {
    std::vector<std::int32_t> floor;
    for (std::size_t n = 0; n < cells.size(); ++n) {
        if (cells.basis[n] == Basis::surface && cells.k[n] < top_m / cells.voxel_m &&
            role_of(roles, cells.primitive[n]) == Role::floor)
            floor.push_back(cells.k[n]);
    }
    vdb::FillOptions out;
    if (!floor.empty()) out.lowest = upper_median(floor);
    out.roles.assign(roles.begin(), roles.end());
    return out;
}

std::vector<std::int32_t> numbered(std::span<const std::int32_t> primitive,
                                   std::span<const std::int32_t> number) {
    std::vector<std::int32_t> out;
    out.reserve(primitive.size());
    for (const std::int32_t p : primitive) out.push_back(p < 0 ? -1 : number[p]);
    return out;
}

geometry::SurfaceSamples numbered(geometry::SurfaceSamples samples,
                                  std::span<const std::int32_t> number) {
    samples.primitive = numbered(samples.primitive, number);
    geometry::sort_by_primitive(samples);
    return samples;
}

Volume fill_volume(device::Device& device, const Observation& input, const Surfaces& geometry,
                   SpaceCarving& carving, StageClock& stage, SolidDetail detail) {
    Volume out;
    out.by_sensors = input.by_sensors;
    const double voxel_m = carving.frame().voxel_m;
    geometry::GapPoints gaps;
    stage("voxels", [&] {
        if (carving.closes_gaps())
            gaps = geometry::close_gaps(geometry.surfels, geometry.primitives.faces.label,
                                        geometry.primitives.label, voxel_m / 2, device.threads());
    });
    const SpaceCarving::Carved carved = carving.finish(
        marks_of(input, geometry, gaps, carving.frame().grid_from_input), gaps, stage);
    out.scene = carved.scene;
    stage("filling", [&] {
        SolidCells cells = out.scene->solid_cells();
        vdb::CompletionOptions options;
        const double inf = std::numeric_limits<double>::infinity();
        options.fill = fill_options(
            cells, geometry.role, geometry.storeys.empty() ? inf : geometry.storeys.front().top_m);
        options.fill.columns = carved.from_around;
        options.ledges =
            geometry::ledges_between(geometry.surfels, geometry.primitives, geometry.frame.axes[2]);
        options.map = input.space ? &*input.space : nullptr;
        out.likely = vdb::complete(device, options, *out.scene, cells);
        out.number = solid_numbers(cells, geometry.role.size());
        std::erase_if(out.likely, [&](vdb::Claim& claim) {
            if (claim.solid) claim.primitive = out.number[claim.primitive];
            return claim.solid && claim.primitive < 0;
        });
        out.scene->relabel(out.number);
        cells.primitive = numbered(cells.primitive, out.number);
        out.solids = solid_scene(device, input, geometry, gaps, options.ledges, out,
                                 std::move(cells), detail);
    });
    return out;
}

}  // namespace topple
