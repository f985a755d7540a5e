// SPDX-License-Identifier: MIT
#include "export/decompose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "export/simplify.h"
#include "physics/weld.h"
#include "solids/cell_shape.h"

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

using Voxel = std::array<std::int32_t, 3>;
constexpr std::size_t no_boundary = BoundaryCells::absent;

// A voxel that is a clump's, wholly or in part.
struct Cell {
    Voxel at{};
    std::size_t boundary = no_boundary;
};

// The hull of what is solid of a piece, or nothing where that spans no volume, and how much it is.
struct PieceSolid {
    std::optional<ConvexPart> hull;
    double m3 = 0;
};

struct Piece {
    std::int32_t id = 0;
    std::vector<std::size_t> cells;
    Voxel low{}, high{};
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
        : solids_(solids), cells_(std::move(cells)), corner_(cells_.size()) {
        Piece all;
        for (std::size_t n = 0; n < cells_.size(); ++n) all.cells.push_back(n);
        bound(all);
        low_ = all.low;
        for (std::size_t a = 0; a < 3; ++a)
            size_[a] = static_cast<std::size_t>(all.high[a] - all.low[a]) + 1;
        piece_.assign(size_[0] * size_[1] * size_[2], -1);
        index_.assign(piece_.size(), 0);
        for (std::size_t n = 0; n < cells_.size(); ++n)
            index_[place(cells_[n].at)] = static_cast<std::uint32_t>(n);
        add(std::move(all));
    }

    // Of a floor that is level as it was seen, a slab below that from end to end: under what stands
    // on it, it was not seen.
    std::optional<Decomposed> level_slab() {
        constexpr double thick_m = 0.05, level = 0.999;
        const auto patches = flat_patches(pieces_[0], 1);
        if (patches.empty()) return std::nullopt;
        const HalfSpace top = half_space(solids_.boundary().patches[patches[0]]);
        if (top.normal[2] < level) return std::nullopt;
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
        const double h = solids_.voxel_m();
        const double slight = std::max(slight_voxels, slight_m3 / (h * h * h));
        double excess = pieces_[0].excess;
        const auto count = static_cast<double>(cells_.size());
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
                (cells_[n].at[cut->axis] < cut->layer ? below : above).cells.push_back(n);
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
            trim(piece, *solid.hull);
            out.excess_m3 += solid.hull->volume_m3 - solid.m3;
            out.parts.push_back(*std::move(solid.hull));
        }
        return out;
    }

  private:
    PieceSolid& solid_of(Piece& piece) const {
        if (!piece.solid) piece.solid = found_solid(piece);
        return *piece.solid;
    }
    PieceSolid found_solid(const Piece& piece) const {
        const double h = solids_.voxel_m(), voxel_m3 = h * h * h;
        const BoundaryCells& boundary = solids_.boundary();
        PieceSolid out;
        std::vector<Vec3> points;
        for (const std::size_t n : piece.cells) {
            const Cell& cell = cells_[n];
            out.m3 += cell.boundary == no_boundary
                          ? voxel_m3
                          : boundary.share[cell.boundary] * voxel_m3 / BoundaryCells::whole;
            if (!between_alike(cell, piece.id)) add_corners(n, points);
        }
        constexpr double alike = 0.005;  // of a voxel
        out.hull = hull_part(physics::welded(points, alike * h));
        if (out.hull) sample(piece, out.m3, *out.hull);
        return out;
    }
    // Corners of some of its cells.
    void sample(const Piece& piece, double solid_m3, ConvexPart& part) const {
        constexpr std::size_t most = most_points / 8;  // corners of a voxel
        const std::size_t step = (piece.cells.size() + most - 1) / most;
        for (std::size_t n = step / 2; n < piece.cells.size(); n += step)
            add_corners(piece.cells[n], part.solid);
        part.solid_each_m3 = solid_m3 / static_cast<double>(part.solid.size());
    }
    // Cuts a hull along the flat patches beyond which hardly any of its solid lies: faces are as
    // flat as they were seen, whatever single voxels stick out.
    void trim(const Piece& piece, ConvexPart& part) const {
        constexpr std::size_t most_patches = 16;
        constexpr double slight_loss = 0.002;
        for (const std::uint32_t number : flat_patches(piece, most_patches)) {
            auto left = cut(part, half_space(solids_.boundary().patches[number]));
            if (!left || left->volume_m3 == part.volume_m3) continue;
            const auto lost = static_cast<double>(part.solid.size() - left->solid.size());
            if (lost <= slight_loss * static_cast<double>(part.solid.size()))
                part = *std::move(left);
        }
    }
    // Those that bound most of a piece's cells.
    std::vector<std::uint32_t> flat_patches(const Piece& piece, std::size_t most) const {
        const BoundaryCells& b = solids_.boundary();
        std::map<std::uint32_t, std::size_t> cells;  // by patch
        for (const std::size_t n : piece.cells) {
            const std::size_t at = cells_[n].boundary;
            if (at == no_boundary) continue;
            for (std::size_t s = 0; s < b.slots_used(at); ++s)
                if (!b.use(at, s).outside && b.patches[b.slot[s][at]].flat())
                    ++cells[b.slot[s][at]];
        }
        std::vector<std::pair<std::size_t, std::uint32_t>> by_count;
        for (const auto& [patch, count] : cells) by_count.emplace_back(count, patch);
        std::ranges::sort(by_count, std::greater<>());
        // A face of the piece, and no neighbour's that it touches.
        constexpr std::size_t least_share = 50;
        std::erase_if(by_count, [&](const auto& patch) {
            return patch.first * least_share < piece.cells.size();
        });
        by_count.resize(std::min(by_count.size(), most));
        std::vector<std::uint32_t> out;
        for (const auto& [count, patch] : by_count) out.push_back(patch);
        return out;
    }
    static HalfSpace half_space(const SurfacePatch& patch) {
        const Vec3 g = patch.gradient(patch.origin);
        const double length = std::hypot(g[0], g[1], g[2]);
        const Vec3 n{g[0] / length, g[1] / length, g[2] / length};
        return {n, n[0] * patch.origin[0] + n[1] * patch.origin[1] + n[2] * patch.origin[2] -
                       patch.c[0] / length};
    }
    void add_corners(std::size_t n, std::vector<Vec3>& out) const {
        std::vector<Vec3>& corner = corner_[n];
        if (corner.empty()) corner = corners_of(cells_[n]);
        out.insert(out.end(), corner.begin(), corner.end());
    }
    std::vector<Vec3> corners_of(const Cell& cell) const {
        const double h = solids_.voxel_m();
        if (cell.boundary != no_boundary) {
            const auto corners = solids::corners_of(solids_.boundary(), cell.boundary, h);
            return {corners.begin(), corners.end()};
        }
        std::vector<Vec3> out;
        for (unsigned c = 0; c < 8; ++c)
            out.push_back({(cell.at[0] + int(c & 1)) * h, (cell.at[1] + int(c >> 1 & 1)) * h,
                           (cell.at[2] + int(c >> 2)) * h});
        return out;
    }
    std::size_t place(const Voxel& at) const {
        return (static_cast<std::size_t>(at[0] - low_[0]) * size_[1] +
                static_cast<std::size_t>(at[1] - low_[1])) *
                   size_[2] +
               static_cast<std::size_t>(at[2] - low_[2]);
    }
    bool inside(const Voxel& at) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (at[a] < low_[a] || at[a] >= low_[a] + static_cast<std::int32_t>(size_[a]))
                return false;
        return true;
    }
    bool is(std::int32_t id, const Voxel& at) const {
        return inside(at) && piece_[place(at)] == id;
    }

    void bound(Piece& piece) const {
        piece.low.fill(std::numeric_limits<std::int32_t>::max());
        piece.high.fill(std::numeric_limits<std::int32_t>::min());
        for (const std::size_t n : piece.cells) {
            for (std::size_t a = 0; a < 3; ++a) {
                piece.low[a] = std::min(piece.low[a], cells_[n].at[a]);
                piece.high[a] = std::max(piece.high[a], cells_[n].at[a]);
            }
        }
    }
    void mark(const Piece& piece) {
        for (const std::size_t n : piece.cells) piece_[place(cells_[n].at)] = piece.id;
    }
    void add(Piece piece) {
        mark(piece);
        std::vector<Vec3> points;
        measure(piece, hull_with(points, corners(piece, 0, {})[0]));
        pieces_.push_back(std::move(piece));
    }

    // Whether a cell lies between two of its piece that are bounded as it is, so that no corner of
    // the piece's hull is in it.
    bool between_alike(const Cell& cell, std::int32_t id) const {
        for (std::size_t a = 0; a < 3; ++a) {
            Voxel before = cell.at, after = cell.at;
            --before[a];
            ++after[a];
            if (!is(id, before) || !is(id, after)) continue;
            if (alike(cell, cells_[index_[place(before)]]) &&
                alike(cell, cells_[index_[place(after)]]))
                return true;
        }
        return false;
    }
    bool alike(const Cell& one, const Cell& other) const {
        if ((one.boundary == no_boundary) != (other.boundary == no_boundary)) return false;
        if (one.boundary == no_boundary) return true;
        const BoundaryCells& b = solids_.boundary();
        if (b.form[one.boundary] != b.form[other.boundary]) return false;
        for (std::size_t s = 0; s < b.slots_used(one.boundary); ++s) {
            if (b.slot[s][one.boundary] != b.slot[s][other.boundary] ||
                !b.patches[b.slot[s][one.boundary]].flat())
                return false;
        }
        return true;
    }

    // Corners of the piece's cells, in voxels, as far as they may be those of the hull of a slab of
    // it. slab: by layer from the piece's lowest along an axis; none: all is one slab.
    std::vector<std::vector<Vec3>> corners(const Piece& piece, std::size_t axis,
                                           std::span<const std::size_t> slab_of_layer) const {
        const auto slab_of = [&](const Voxel& at) {
            return slab_of_layer.empty()
                       ? 0
                       : slab_of_layer[static_cast<std::size_t>(at[axis] - piece.low[axis])];
        };
        std::vector<std::vector<Vec3>> out(slab_of(piece.high) + 1);
        for (const std::size_t n : piece.cells) {
            const Voxel& at = cells_[n].at;
            const std::size_t slab = slab_of(at);
            const auto ends_at = [&](std::size_t a, std::int32_t step) {
                Voxel next = at;
                next[a] += step;
                return !is(piece.id, next) || slab_of(next) != slab;
            };
            std::array<std::array<bool, 2>, 3> ends{};
            bool corner = true;
            for (std::size_t a = 0; a < 3 && corner; ++a) {
                ends[a] = {ends_at(a, -1), ends_at(a, 1)};
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
    void measure(Piece& piece, double hull) const {
        piece.hull = hull;
        piece.excess = piece.hull - static_cast<double>(piece.cells.size());
        if (piece.excess <= slight_voxels) return;
        // Much of that may be the steps of slanted surfaces, which are of the voxels, not of the
        // solid.
        const PieceSolid& solid = solid_of(piece);
        const double h = solids_.voxel_m();
        piece.excess = solid.hull ? (solid.hull->volume_m3 - solid.m3) / (h * h * h) : 0;
    }
    // Where to try cuts along an axis: the layers that begin where the section changes most, and
    // some in between. Ascending, in layers from the piece's lowest.
    std::vector<std::size_t> places(const Piece& piece, std::size_t axis) const {
        const auto layers = static_cast<std::size_t>(piece.high[axis] - piece.low[axis]) + 1;
        std::vector<std::int64_t> count(layers, 0);
        for (const std::size_t n : piece.cells)
            ++count[static_cast<std::size_t>(cells_[n].at[axis] - piece.low[axis])];
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
        const auto layers = static_cast<std::size_t>(piece.high[axis] - piece.low[axis]) + 1;
        std::vector<std::size_t> slab_of_layer(layers, 0);
        for (std::size_t n = 0; n < layers; ++n)
            slab_of_layer[n] = static_cast<std::size_t>(std::ranges::upper_bound(out.first, n) -
                                                        out.first.begin());
        std::vector<double> solid(out.first.size() + 1, 0);
        for (const std::size_t n : piece.cells)
            ++solid[slab_of_layer[static_cast<std::size_t>(cells_[n].at[axis] - piece.low[axis])]];
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
                best = {a, piece.low[a] + static_cast<std::int32_t>(slabs.first[n]), slabs.below[n],
                        above};
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
                peel = {a, piece.low[a] + static_cast<std::int32_t>(slabs.first[n]), below, above};
            }
        }
        return peel;
    }

    const SolidScene& solids_;
    std::vector<Cell> cells_;
    mutable std::vector<std::vector<Vec3>> corner_;  // of each cell's solid; found when first asked
    std::vector<Piece> pieces_;
    Voxel low_{};
    std::array<std::size_t, 3> size_{};
    std::vector<std::int32_t> piece_;   // by voxel of the box around all
    std::vector<std::uint32_t> index_;  // of the cell there
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
        const std::size_t clump = clump_of[static_cast<std::size_t>(p)];
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
        if (clumps[n].primitives.size() == 1 && solids.role(clumps[n].primitives[0]) == Role::floor)
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
