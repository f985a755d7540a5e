// SPDX-License-Identifier: MIT
#include "export/decompose.h"

#include <algorithm>
#include <array>
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
// A cut must take this share of what the piece's box holds beyond it away.
constexpr double least_gain = 0.1;
// Of a box that cells fill.
constexpr double full = 0.85;
constexpr std::size_t most_parts = 8;

struct Piece {
    std::int32_t id = 0;
    std::vector<std::size_t> cells;
    Extents<std::int32_t> box;
    double excess = 0;                // what the hull holds beyond the solid, in voxels
    std::optional<PieceSolid> solid;  // once it was asked for
    bool final = false;
};

// Cuts are looked for by the boxes around what they leave, which takes no hulls.
class Decomposition {
  public:
    Decomposition(const SolidScene& solids, std::vector<Cell> cells)
        : voxel_m_(solids.voxel_m()), grid_(std::move(cells)), exact_(solids, grid_) {
        Piece all;
        for (std::size_t n = 0; n < grid_.cells().size(); ++n) all.cells.push_back(n);
        bound(all);
        mark(all);
        measure(all);
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
            measure(below);
            measure(above);
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
    void measure(Piece& piece) {
        if (static_cast<double>(piece.cells.size()) <= slight_voxels) return;
        const PieceSolid& solid = solid_of(piece);
        const double h = voxel_m_;
        piece.excess = solid.hull ? (solid.hull->volume_m3 - solid.m3) / (h * h * h) : 0;
    }

    // What lies on one side of a cut: so many cells in such a box.
    struct Side {
        Extents<std::int32_t> box;
        double cells = 0;

        void add(const Side& other) {
            box.add(other.box.low);
            box.add(other.box.high);
            cells += other.cells;
        }
        double box_cells() const {
            double out = 1;
            for (std::size_t a = 0; a < 3; ++a) out *= static_cast<double>(layers_of(box, a));
            return out;
        }
        bool fills_box() const { return cells >= full * box_cells(); }
    };
    struct Cut {
        std::size_t axis;
        std::int32_t layer;  // the first above it
    };
    // Calls use(cut, below, above) for each cut along an axis that leaves cells on both sides.
    template <class Use>
    void each_cut(const Piece& piece, std::size_t axis, const Use& use) const {
        std::vector<Side> layer(layers_of(piece.box, axis));
        for (const std::size_t n : piece.cells) {
            Side& at = layer[grid_[n].at[axis] - piece.box.low[axis]];
            at.box.add(grid_[n].at);
            ++at.cells;
        }
        std::vector<Side> above(layer.size());
        for (std::size_t n = layer.size(); n-- > 0;) {
            if (n + 1 < layer.size()) above[n] = above[n + 1];
            if (layer[n].cells > 0) above[n].add(layer[n]);
        }
        Side below;
        for (std::size_t n = 1; n < layer.size(); ++n) {
            if (layer[n - 1].cells > 0) below.add(layer[n - 1]);
            if (layer[n].cells > 0)
                use(Cut{axis, piece.box.low[axis] + static_cast<std::int32_t>(n)}, below, above[n]);
        }
    }
    // The cut that leaves the smallest boxes. Where none takes much away, as of a box that is
    // hollow, the one that takes off most of what fills its own; where none does, as of a round
    // cup, through the middle: its quarters have smaller boxes.
    std::optional<Cut> best_cut(const Piece& piece) const {
        const Side all{piece.box, static_cast<double>(piece.cells.size())};
        double least = all.box_cells() - least_gain * (all.box_cells() - all.cells), most = 0;
        std::optional<Cut> best, peel;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            each_cut(piece, axis, [&](const Cut& cut, const Side& below, const Side& above) {
                if (const double left = below.box_cells() + above.box_cells(); left < least) {
                    least = left;
                    best = cut;
                }
                for (const Side& side : {below, above}) {
                    if (side.cells <= most || !side.fills_box()) continue;
                    most = side.cells;
                    peel = cut;
                }
            });
        }
        return best ? best : peel ? peel : halving(piece);
    }

    std::optional<Cut> halving(const Piece& piece) const {
        std::size_t axis = 0;
        for (std::size_t a = 1; a < 3; ++a)
            if (layers_of(piece.box, a) > layers_of(piece.box, axis)) axis = a;
        const auto layers = static_cast<std::int32_t>(layers_of(piece.box, axis));
        if (layers < 2) return std::nullopt;
        return Cut{axis, piece.box.low[axis] + layers / 2};
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
    std::vector<std::size_t> sizes;
    for (const auto& of : cells) sizes.push_back(of.size());
    threads.each_largest_first(sizes, [&](std::size_t n) {
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
