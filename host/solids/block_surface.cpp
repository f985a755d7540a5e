// SPDX-License-Identifier: MIT
#include "solids/block_surface.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/union_find.h"
#include "solids/matching.h"

namespace topple::solids {
namespace {

constexpr Place corner_of_side(std::size_t direction, std::size_t slot) {
    const std::size_t axis = direction / 2;
    const bool upper = direction % 2, u = slot == 1 || slot == 2, v = slot >= 2;
    Place out{};
    out[axis] = upper;
    out[(axis + 1) % 3] = upper ? u : v;
    out[(axis + 2) % 3] = upper ? v : u;
    return out;
}

// The slot of a voxel's side in one direction whose edge, to the next one, it shares with the
// voxel's side in another.
constexpr std::array<std::array<std::uint8_t, 6>, 6> slot_towards = [] {
    std::array<std::array<std::uint8_t, 6>, 6> out{};
    for (std::size_t d = 0; d < 6; ++d) {
        for (std::uint8_t slot = 0; slot < 4; ++slot) {
            const Place from = corner_of_side(d, slot), to = corner_of_side(d, (slot + 1U) % 4);
            for (std::size_t a = 0; a < 3; ++a)
                if (a != d / 2 && from[a] == to[a])
                    out[d][2 * a + static_cast<std::size_t>(from[a])] = slot;
        }
    }
    return out;
}();

class Surface {
  public:
    explicit Surface(std::span<const ObjectVoxel> voxels) : voxels_(voxels) {
        for (std::size_t d = 0; d < 6; ++d) {
            beside_[d].assign(voxels.size(), no_voxel);
            face_[d].resize(voxels.size());
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            each_pair(moved({}, axis, 1), [&](std::size_t n, std::size_t m) {
                beside_[2 * axis + 1][n] = static_cast<std::uint32_t>(m);
                beside_[2 * axis][m] = static_cast<std::uint32_t>(n);
            });
        }
    }

    BlockSurface find() {
        add_faces();
        add_vertices();
        mark_pinched();
        return std::move(out_);
    }

  private:
    // Calls visit(voxel, the one that lies a step from it), for all that there are.
    template <class Visit>
    void each_pair(const Place& step, const Visit& visit) const {
        const auto place = [&](std::size_t n) { return voxels_[n].at; };
        const auto stepped = [&](std::size_t n) { return sum_of(voxels_[n].at, step); };
        each_match(voxels_.size(), stepped, voxels_.size(), place, visit);
    }
    bool filled(std::size_t voxel) const { return voxel != no_voxel && voxels_[voxel].filled; }

    void add_faces() {
        for (std::uint32_t n = 0; n < voxels_.size(); ++n) {
            if (!filled(n)) continue;
            for (std::uint8_t d = 0; d < 6; ++d) {
                if (filled(beside_[d][n])) continue;
                face_[d][n] = static_cast<std::uint32_t>(out_.face.size());
                out_.face.push_back({n, beside_[d][n], d, 0, {}});
            }
        }
    }

    // One for all corners of faces that hang together by edges, numbered by place. Of four faces
    // at an edge those of one voxel hang together.
    void add_vertices() {
        const std::size_t corners = 4 * out_.face.size();
        UnionFind joined(corners);
        for (std::size_t f = 0; f < out_.face.size(); ++f) {
            const std::size_t axis = out_.face[f].axis();
            for (const std::size_t a : {(axis + 1) % 3, (axis + 2) % 3})
                for (const std::size_t to : {2 * a, 2 * a + 1}) join_at(f, to, joined);
        }
        std::vector<std::size_t> roots;
        for (std::size_t c = 0; c < corners; ++c)
            if (joined.root(c) == c) roots.push_back(c);
        std::ranges::sort(roots, {}, [&](std::size_t c) { return std::pair(place_of(c), c); });
        std::vector<std::uint32_t> number(corners);
        for (const std::size_t c : roots) {
            number[c] = static_cast<std::uint32_t>(out_.corner.size());
            out_.corner.push_back(place_of(c));
        }
        for (std::size_t c = 0; c < corners; ++c)
            out_.face[c / 4].vertex[c % 4] = number[joined.root(c)];
    }
    // Of a corner, 4 times its face's number plus the slot.
    Place place_of(std::size_t corner) const {
        const VoxelFace& face = out_.face[corner / 4];
        return sum_of(voxels_[face.voxel].at, corner_of_side(face.direction, corner % 4));
    }
    // Joins a face to the one beyond its edge on the side `to`, which walks that the other way:
    // of the same voxel, of the next one, or of that above the next one.
    void join_at(std::size_t f, std::size_t to, UnionFind& joined) const {
        const std::size_t up = out_.face[f].direction;
        const std::uint32_t here = out_.face[f].voxel, next = beside_[to][here];
        std::size_t other = face_[to][here], slot = slot_towards[to][up];
        if (filled(next)) {
            const std::uint32_t above = beside_[up][next];
            other = filled(above) ? face_[to ^ 1][above] : face_[up][next];
            slot = filled(above) ? slot_towards[to ^ 1][up ^ 1] : slot_towards[up][to ^ 1];
        }
        const std::size_t own = slot_towards[up][to];
        joined.join(4 * f + own, 4 * other + (slot + 1) % 4);
        joined.join(4 * f + (own + 1) % 4, 4 * other + slot);
    }

    // Edges along which two voxels touch, and which have the same vertices for both.
    void mark_pinched() {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const bool up : {false, true}) {
                const std::size_t a = 2 * axis + 1, b = (2 * axis + 2) % 6 + up;
                each_pair(moved(moved({}, axis, 1), b / 2, up ? 1 : -1), [&](std::size_t n,
                                                                             std::size_t m) {
                    if (!filled(n) || !filled(m) || filled(beside_[a][n]) || filled(beside_[b][n]))
                        return;
                    const auto here = ends_of(n, a, b), there = ends_of(m, a ^ 1, b ^ 1);
                    if (here != there && here != std::pair(there.second, there.first)) return;
                    for (const auto& [voxel, one, other] :
                         {std::tuple(n, a, b), std::tuple(n, b, a), std::tuple(m, a ^ 1, b ^ 1),
                          std::tuple(m, b ^ 1, a ^ 1)})
                        out_.face[face_[one][voxel]].pinched |=
                            static_cast<std::uint8_t>(1U << slot_towards[one][other]);
                });
            }
        }
    }
    // The vertices of an edge of a voxel, between its faces in two directions.
    std::pair<std::uint32_t, std::uint32_t> ends_of(std::size_t voxel, std::size_t one,
                                                    std::size_t other) const {
        const auto& vertex = out_.face[face_[one][voxel]].vertex;
        const std::size_t slot = slot_towards[one][other];
        return {vertex[slot], vertex[(slot + 1) % 4]};
    }

    std::span<const ObjectVoxel> voxels_;
    std::array<std::vector<std::uint32_t>, 6> beside_;  // by direction and voxel
    std::array<std::vector<std::uint32_t>, 6> face_;  // by direction and voxel, where there is one
    BlockSurface out_;
};

}  // namespace

BlockSurface block_surface(std::span<const ObjectVoxel> voxels) {
    return Surface(voxels).find();
}

}  // namespace topple::solids
