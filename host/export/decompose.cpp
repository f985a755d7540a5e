// SPDX-License-Identifier: MIT
#include "export/decompose.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "export/piece_solid.h"
#include "export/simplify.h"

namespace topple::exports {
namespace {

// A clump is convex enough where the hulls of its pieces are this share of it larger, and a piece
// where its own is so many voxels larger, or this share of the clump.
constexpr double slight_share = 0.15, slight_voxels = 24, slight_piece = 0.12;
// A cut must take this share of a piece's excess away.
constexpr double least_gain = 0.1;
constexpr std::size_t most_parts = 8;
// Of places for a cut along each axis: at changes of the section, and evenly spread ones.
constexpr std::size_t most_changes = 3, even_places = 2;

struct Piece {
    std::int32_t id = 0;
    std::vector<std::size_t> cells;
    Extents<std::int32_t> box;
    double hull = 0;                  // its volume, in voxels
    double excess = 0;                // what the hull holds beyond the solid, in voxels
    std::optional<PieceSolid> solid;  // once it was asked for
    bool final = false;
};

// Cuts are looked for on whole voxels, of which few are corners of a hull: those that end a row
// along each axis.
class Decomposition {
  public:
    Decomposition(const SolidScene& solids, std::vector<Cell> cells)
        : voxel_m_(solids.voxel_m()), grid_(std::move(cells)), exact_(solids, grid_) {
        Piece all;
        for (std::size_t n = 0; n < grid_.cells().size(); ++n) all.cells.push_back(n);
        bound(all);
        mark(all);
        std::vector<Vec3> points;
        measure(all, hull_with(points, corners(all, 0, {})[0]));
        pieces_.push_back(std::move(all));
    }

    // Of a floor that is level as it was seen, a slab below that from end to end: under what stands
    // on it, it was not seen.
    std::optional<Decomposed> level_slab() {
        constexpr double thick_m = 0.05, upwards = 0.5, level = 0.999;
        constexpr std::size_t most_sides = 8;
        const auto sides = exact_.flat_sides(pieces_[0].cells, most_sides);
        const auto found = std::ranges::find_if(
            sides, [](const HalfSpace& side) { return side.normal[2] > upwards; });
        const std::optional<HalfSpace> seen =
            found != sides.end() ? std::optional(*found) : layer_top();
        if (!seen || seen->normal[2] < level) return std::nullopt;
        const HalfSpace& top = *seen;
        PieceSolid& whole_solid = solid_of(pieces_[0]);
        auto& whole = whole_solid.hull;
        if (!whole) return std::nullopt;
        Decomposed out;
        out.solid_m3 = whole_solid.m3;
        const double x = (whole->low[0] + whole->high[0]) / 2;
        const double y = (whole->low[1] + whole->high[1]) / 2;
        const double z = (top.offset_m - top.normal[0] * x - top.normal[1] * y) / top.normal[2];
        std::vector<Vec3> points;
        for (const Vec3& c : whole->corner) {
            points.push_back({c[0], c[1], z});
            points.push_back({c[0], c[1], z - thick_m});
        }
        auto slab = hull_part(points);
        if (!slab) return std::nullopt;
        out.excess_m3 = slab->volume_m3 - out.solid_m3;
        slab->solid = std::move(whole->solid);
        slab->solid_each_m3 = whole->solid_each_m3;
        out.parts.push_back(*std::move(slab));
        out.floor = true;
        return out;
    }

    void run(double slight_m3) {
        const double h = voxel_m_;
        const double slight = std::max(slight_voxels, slight_m3 / (h * h * h));
        double excess = pieces_[0].excess;
        const auto count = static_cast<double>(grid_.cells().size());
        while (pieces_.size() < most_parts && excess > slight_share * count) {
            std::size_t worst = pieces_.size();
            for (std::size_t n = 0; n < pieces_.size(); ++n) {
                if (!pieces_[n].final &&
                    (worst == pieces_.size() || pieces_[n].excess > pieces_[worst].excess))
                    worst = n;
            }
            if (worst == pieces_.size() ||
                pieces_[worst].excess <= std::max(slight, slight_piece * count))
                return;
            const auto cut = best_cut(pieces_[worst]);
            if (!cut) {
                pieces_[worst].final = true;
                continue;
            }
            Piece below, above;
            for (const std::size_t n : pieces_[worst].cells)
                (grid_[n].at[cut->axis] < cut->layer ? below : above).cells.push_back(n);
            excess -= pieces_[worst].excess;
            below.id = pieces_[worst].id;
            bound(below);
            bound(above);
            above.id = static_cast<std::int32_t>(pieces_.size());
            mark(below);
            mark(above);
            measure(below, cut->hull_below);
            measure(above, cut->hull_above);
            excess += below.excess + above.excess;
            pieces_[worst] = std::move(below);
            pieces_.push_back(std::move(above));
        }
    }

    Decomposed result() {
        Decomposed out;
        for (Piece& piece : pieces_) {
            PieceSolid& solid = solid_of(piece);
            out.solid_m3 += solid.m3;
            if (!solid.hull) continue;
            exact_.trim(piece.cells, *solid.hull);
            out.excess_m3 += solid.hull->volume_m3 - solid.m3;
            out.parts.push_back(*std::move(solid.hull));
        }
        return out;
    }

  private:
    // Where a side lies on a border of voxels, it cuts none of them and no patch tells of it: the
    // top of the layer that holds most.
    std::optional<HalfSpace> layer_top() const {
        constexpr double most = 0.5;
        std::map<std::int32_t, std::size_t> count;
        for (const std::size_t n : pieces_[0].cells)
            if (grid_[n].whole()) ++count[grid_[n].at[2]];
        const auto fullest =
            std::ranges::max_element(count, {}, [](const auto& layer) { return layer.second; });
        if (fullest == count.end() || static_cast<double>(fullest->second) <
                                          most * static_cast<double>(pieces_[0].cells.size()))
            return std::nullopt;
        return HalfSpace{{0, 0, 1}, (fullest->first + 1) * voxel_m_};
    }
    PieceSolid& solid_of(Piece& piece) {
        if (!piece.solid) piece.solid = exact_.of(piece.id, piece.cells);
        return *piece.solid;
    }
    void bound(Piece& piece) const {
        for (const std::size_t n : piece.cells) piece.box.add(grid_[n].at);
    }
    void mark(const Piece& piece) {
        for (const std::size_t n : piece.cells) grid_.mark(n, piece.id);
    }
    // Corners of the piece's cells, in voxels, as far as they may be those of the hull of a slab of
    // it. slab: by layer from the piece's lowest along an axis; none: all is one slab.
    std::vector<std::vector<Vec3>> corners(const Piece& piece, std::size_t axis,
                                           std::span<const std::size_t> slab_of_layer) const {
        const auto slab_of = [&](const Voxel& at) {
            return slab_of_layer.empty() ? 0 : slab_of_layer[at[axis] - piece.box.low[axis]];
        };
        std::vector<std::vector<Vec3>> out(slab_of(piece.box.high) + 1);
        for (const std::size_t n : piece.cells) {
            const Voxel& at = grid_[n].at;
            const std::size_t slab = slab_of(at);
            const auto ends_at = [&](std::size_t a, bool up) {
                const std::uint32_t next = grid_.beside(n, a, up);
                return !grid_.is(piece.id, next) || slab_of(grid_[next].at) != slab;
            };
            std::array<std::array<bool, 2>, 3> ends{};
            bool corner = true;
            for (std::size_t a = 0; a < 3 && corner; ++a) {
                ends[a] = {ends_at(a, false), ends_at(a, true)};
                corner = ends[a][0] || ends[a][1];
            }
            if (!corner) continue;
            for (unsigned c = 0; c < 8; ++c) {
                const std::array<unsigned, 3> bit{c & 1, c >> 1 & 1, c >> 2};
                if (ends[0][bit[0]] && ends[1][bit[1]] && ends[2][bit[2]])
                    out[slab].push_back(
                        {double(at[0]) + bit[0], double(at[1]) + bit[1], double(at[2]) + bit[2]});
            }
        }
        return out;
    }
    // hull: the volume of that of its voxels, in voxels.
    void measure(Piece& piece, double hull) {
        piece.hull = hull;
        piece.excess = piece.hull - static_cast<double>(piece.cells.size());
        if (piece.excess <= slight_voxels) return;
        // Much of that may be the steps of slanted surfaces, which are of the voxels, not of the
        // solid.
        const PieceSolid& solid = solid_of(piece);
        const double h = voxel_m_;
        piece.excess = solid.hull ? (solid.hull->volume_m3 - solid.m3) / (h * h * h) : 0;
    }
    // Where to try cuts along an axis: the layers that begin where the section changes most, and
    // some in between. Ascending, in layers from the piece's lowest.
    std::vector<std::size_t> places(const Piece& piece, std::size_t axis) const {
        const std::size_t layers = layers_of(piece.box, axis);
        std::vector<std::int64_t> count(layers, 0);
        for (const std::size_t n : piece.cells) ++count[grid_[n].at[axis] - piece.box.low[axis]];
        std::vector<std::pair<std::int64_t, std::size_t>> changes;
        for (std::size_t n = 1; n < layers; ++n)
            changes.emplace_back(-std::abs(count[n] - count[n - 1]), n);
        std::ranges::sort(changes);
        std::vector<std::size_t> out;
        for (std::size_t n = 0; n < std::min(most_changes, changes.size()); ++n)
            out.push_back(changes[n].second);
        for (std::size_t n = 1; n < even_places; ++n) out.push_back(n * layers / even_places);
        std::ranges::sort(out);
        out.erase(std::unique(out.begin(), out.end()), out.end());
        std::erase(out, std::size_t{0});
        return out;
    }

    struct Cut {
        std::size_t axis;
        std::int32_t layer;             // the first above it
        double hull_below, hull_above;  // volumes, in voxels
    };
    // A piece in slabs between the places for cuts along an axis. Volumes in voxels.
    struct Slabs {
        std::vector<std::size_t> first;          // layer of each but the lowest, from the piece's
        std::vector<std::vector<Vec3>> corner;   // by slab
        std::vector<double> solid_below, below;  // by cut: what lies below, and the hull of that
    };
    Slabs slabs_along(const Piece& piece, std::size_t axis) const {
        Slabs out;
        out.first = places(piece, axis);
        const std::size_t layers = layers_of(piece.box, axis);
        std::vector<std::size_t> slab_of_layer(layers, 0);
        for (std::size_t n = 0; n < layers; ++n)
            slab_of_layer[n] = static_cast<std::size_t>(std::ranges::upper_bound(out.first, n) -
                                                        out.first.begin());
        std::vector<double> solid(out.first.size() + 1, 0);
        for (const std::size_t n : piece.cells)
            ++solid[slab_of_layer[grid_[n].at[axis] - piece.box.low[axis]]];
        out.corner = corners(piece, axis, slab_of_layer);
        std::vector<Vec3> points;
        double solid_below = 0;
        for (std::size_t n = 0; n < out.first.size(); ++n) {
            out.solid_below.push_back(solid_below += solid[n]);
            out.below.push_back(hull_with(points, out.corner[n]));
        }
        return out;
    }
    // The volume of the hull of both; of the first the corners of that are left.
    static double hull_with(std::vector<Vec3>& points, const std::vector<Vec3>& more) {
        points.insert(points.end(), more.begin(), more.end());
        auto hull = hull_part(points);
        if (!hull) return 0;
        points = std::move(hull->corner);
        return hull->volume_m3;
    }
    // The cut that leaves least. Where none takes much away, as of a box that is hollow, the one
    // that takes off most of what is convex.
    std::optional<Cut> best_cut(const Piece& piece) const {
        const auto all = static_cast<double>(piece.cells.size());
        double least = piece.hull - least_gain * piece.excess;
        std::optional<Cut> best;
        std::array<Slabs, 3> along;
        for (std::size_t a = 0; a < 3; ++a) {
            along[a] = slabs_along(piece, a);
            const Slabs& slabs = along[a];
            std::vector<Vec3> points;
            for (std::size_t n = slabs.first.size(); n-- > 0;) {
                const auto& next = slabs.corner[n + 1];
                // A hull is no smaller than what is solid of it.
                if (slabs.below[n] + all - slabs.solid_below[n] >= least) {
                    points.insert(points.end(), next.begin(), next.end());
                    continue;
                }
                const double above = hull_with(points, next);
                if (slabs.below[n] + above >= least) continue;
                least = slabs.below[n] + above;
                best = {a, piece.box.low[a] + static_cast<std::int32_t>(slabs.first[n]),
                        slabs.below[n], above};
            }
        }
        return best ? best : best_peel(piece, along);
    }
    std::optional<Cut> best_peel(const Piece& piece, const std::array<Slabs, 3>& along) const {
        const auto all = static_cast<double>(piece.cells.size());
        const auto convex = [](double hull, double solid) {
            return hull - solid <= slight_share * solid;
        };
        double most = 0;
        std::optional<Cut> peel;
        for (std::size_t a = 0; a < 3; ++a) {
            const Slabs& slabs = along[a];
            std::vector<Vec3> points;
            for (std::size_t n = slabs.first.size(); n-- > 0;) {
                const double below = slabs.below[n], above = hull_with(points, slabs.corner[n + 1]);
                const double solid_below = slabs.solid_below[n], solid_above = all - solid_below;
                const double off = std::max(convex(below, solid_below) ? solid_below : 0,
                                            convex(above, solid_above) ? solid_above : 0);
                if (off <= most) continue;
                most = off;
                peel = {a, piece.box.low[a] + static_cast<std::int32_t>(slabs.first[n]), below,
                        above};
            }
        }
        return peel;
    }

    double voxel_m_;
    CellGrid grid_;
    PieceSolids exact_;
    std::vector<Piece> pieces_;
};

// By clump.
std::vector<std::vector<Cell>> cells_of(const SolidScene& solids, std::span<const Clump> clumps) {
    constexpr std::size_t none = ~std::size_t{0};
    std::vector<std::size_t> clump_of(solids.primitives(), none);
    for (std::size_t n = 0; n < clumps.size(); ++n)
        for (const std::int32_t p : clumps[n].primitives)
            clump_of.at(static_cast<std::size_t>(p)) = n;
    std::vector<std::vector<Cell>> out(clumps.size());
    const auto add = [&](std::int32_t p, const Cell& cell) {
        if (p < 0) return;
        const std::size_t clump = clump_of[p];
        if (clump != none) out[clump].push_back(cell);
    };
    const SolidCells& cells = solids.cells();
    const BoundaryCells& boundary = solids.boundary();
    for (std::size_t b = 0; b < boundary.size(); ++b)
        if (boundary.share[b] > 0)
            add(boundary.primitive[b], {{boundary.i[b], boundary.j[b], boundary.k[b]}, b});
    for (std::size_t n = 0; n < cells.size(); ++n)
        if (boundary.find(cells.i[n], cells.j[n], cells.k[n], cells.primitive[n]) ==
            BoundaryCells::absent)
            add(cells.primitive[n], {{cells.i[n], cells.j[n], cells.k[n]}});
    return out;
}

}  // namespace

std::vector<Decomposed> decompose(const SolidScene& solids, std::span<const Clump> clumps,
                                  ThreadPool& threads) {
    auto cells = cells_of(solids, clumps);
    std::vector<Decomposed> out(clumps.size());
    threads.each(clumps.size(), 1, [&](std::size_t n) {
        if (cells[n].empty()) return;
        Decomposition pieces(solids, std::move(cells[n]));
        std::optional<Decomposed> slab;
        if (clumps[n].ground && clumps[n].primitives.size() == 1 &&
            solids.role(clumps[n].primitives[0]) == Role::floor)
            slab = pieces.level_slab();
        if (!slab) pieces.run(clumps[n].slight_m3);
        out[n] = slab ? *std::move(slab) : pieces.result();
        for (ConvexPart& part : out[n].parts) {
            part = simplified(std::move(part), fine_voxels * solids.voxel_m());
            // A box is what solids are most often, and what simulators reckon best with.
            constexpr double alike = 0.1;  // of a voxel
            if (const auto box = as_box(part, alike * solids.voxel_m()))
                if (auto whole = reshaped(part, box->corners())) part = *std::move(whole);
        }
    });
    return out;
}

}  // namespace topple::exports
