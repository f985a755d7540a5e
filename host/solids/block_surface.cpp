// SPDX-License-Identifier: MIT
#include "solids/block_surface.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace topple::solids {
namespace {

using Place = std::array<std::int32_t, 3>;

// The faces of filled voxels, by voxel.
std::vector<VoxelFace> faces_of(std::span<const ObjectVoxel> voxels) {
    const auto count = static_cast<std::uint32_t>(voxels.size());
    std::array<std::vector<std::uint32_t>, 6> beside;
    for (auto& b : beside) b.assign(count, no_voxel);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uint32_t m = 0;
        for (std::uint32_t n = 0; n < count; ++n) {
            Place wanted = voxels[n].at;
            ++wanted[axis];
            while (m < count && voxels[m].at < wanted) ++m;
            if (m == count) break;
            if (voxels[m].at != wanted) continue;
            beside[2 * axis + 1][n] = m;
            beside[2 * axis][m] = n;
        }
    }
    std::vector<VoxelFace> out;
    for (std::uint32_t n = 0; n < count; ++n) {
        if (!voxels[n].filled) continue;
        for (std::uint8_t d = 0; d < 6; ++d) {
            const std::uint32_t m = beside[d][n];
            if (m == no_voxel || !voxels[m].filled) out.push_back({n, m, d, 0, {}});
        }
    }
    return out;
}

constexpr std::uint8_t none = 255;

constexpr std::array<Place, 4> corners_of_side(std::size_t direction) {
    const std::size_t axis = direction / 2;
    const bool upper = direction % 2;
    std::array<Place, 4> out{};
    for (std::size_t n = 0; n < 4; ++n) {
        const bool u = n == 1 || n == 2, v = n >= 2;
        out[n][axis] = upper;
        out[n][(axis + 1) % 3] = upper ? u : v;
        out[n][(axis + 2) % 3] = upper ? v : u;
    }
    return out;
}

// The sides of voxels by direction: their corners, and which of these is at a corner of the voxel,
// which bits number, x first.
struct Sides {
    std::array<std::array<Place, 4>, 6> corner{};
    std::array<std::array<std::uint8_t, 8>, 6> slot_at{};
};
constexpr Sides sides = [] {
    Sides out;
    for (std::size_t d = 0; d < 6; ++d) {
        out.corner[d] = corners_of_side(d);
        out.slot_at[d].fill(none);
        for (std::uint8_t slot = 0; slot < 4; ++slot) {
            const auto& [x, y, z] = out.corner[d][slot];
            out.slot_at[d][static_cast<std::size_t>(4 * x + 2 * y + z)] = slot;
        }
    }
    return out;
}();

// A face's corner.
struct FaceCorner {
    std::uint32_t face;
    std::uint8_t slot;
};

// Calls visit(at, corners) for each voxel corner that faces have, ascending, with their corners
// there, by face. Faces: by voxel.
template <class Visit>
void each_corner(std::span<const ObjectVoxel> voxels, const std::vector<VoxelFace>& faces,
                 const Visit& visit) {
    struct Row {
        Place at;
        std::uint32_t first;
    };
    constexpr std::int32_t beyond_all = std::numeric_limits<std::int32_t>::max();
    std::vector<Row> row;  // of faces of one voxel
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        if (f == 0 || faces[f].voxel != faces[f - 1].voxel)
            row.push_back({voxels[faces[f].voxel].at, f});
    }
    row.push_back({{beyond_all, 0, 0}, static_cast<std::uint32_t>(faces.size())});
    // Voxels ascend, and so do their lowest corners, and so on: those of a kind are a sequence of
    // which each next one is known, and of voxels that share a corner that with the highest number
    // of it comes first.
    std::array<std::size_t, 8> next{};
    std::array<Place, 8> at{};
    const auto find_at = [&](std::size_t kind) {
        const Place& voxel = row[next[kind]].at;
        at[kind] = voxel;
        if (voxel[0] == beyond_all) return;
        for (std::size_t a = 0; a < 3; ++a)
            at[kind][a] += static_cast<std::int32_t>(kind >> (2 - a) & 1);
    };
    for (std::size_t kind = 0; kind < 8; ++kind) find_at(kind);
    std::vector<FaceCorner> here;
    for (;;) {
        const Place lowest = *std::ranges::min_element(at);
        if (lowest[0] == beyond_all) return;
        here.clear();
        for (std::size_t kind = 8; kind-- > 0;) {
            if (at[kind] != lowest) continue;
            const std::size_t voxel = next[kind]++;
            for (std::uint32_t f = row[voxel].first; f < row[voxel + 1].first; ++f) {
                const std::uint8_t slot = sides.slot_at[faces[f].direction][kind];
                if (slot != none) here.push_back({f, slot});
            }
            find_at(kind);
        }
        if (!here.empty()) visit(lowest, std::span<const FaceCorner>(here));
    }
}

// The faces that meet in one voxel corner. The eight voxels around it have octants: bit a tells
// that it lies above the corner along axis a. Between them are twelve places of faces.
class Meeting {
  public:
    Meeting(std::span<const FaceCorner> here, std::vector<VoxelFace>& faces)
        : here_(here), faces_(faces) {
        place_.fill(none);
        std::iota(parent_.begin(), parent_.end(), std::uint8_t{0});
        for (std::size_t n = 0; n < here.size(); ++n) {
            const VoxelFace& face = faces[here[n].face];
            const Place& offset = sides.corner[face.direction][here[n].slot];
            unsigned octant = 0;
            for (unsigned a = 0; a < 3; ++a) octant |= offset[a] == 0 ? 1U << a : 0U;
            octant_[n] = octant;
            place_[place_of(face.axis(), octant)] = static_cast<std::uint8_t>(n);
        }
    }

    // Gives vertices from number `next` on to the faces, one for all that hang together; returns
    // how many.
    std::uint32_t join(std::uint32_t next) {
        for (unsigned edge = 0; edge < 6; ++edge) join_at(edge);
        std::array<std::uint32_t, 12> vertex{};
        std::uint32_t made = 0;
        for (std::size_t n = 0; n < here_.size(); ++n) {
            if (root(n) == n) vertex[n] = next + made++;
        }
        for (std::size_t n = 0; n < here_.size(); ++n)
            faces_[here_[n].face].vertex[here_[n].slot] = vertex[root(n)];
        return made;
    }

    // Of the faces, bits 2 n and 2 n + 1 for vertex n: the edge to the next one and that from the
    // one before have four faces, all of one vertex here.
    void mark_pinched(std::vector<std::uint8_t>& pinched) const {
        for (unsigned edge = 0; edge < 6; ++edge) {
            const std::array<std::uint8_t, 4> around = around_edge(edge);
            if (std::ranges::find(around, none) != around.end()) continue;
            const bool one = std::ranges::all_of(
                around, [&](std::uint8_t n) { return root(n) == root(around[0]); });
            if (!one) continue;
            for (const std::uint8_t n : around) {
                const std::uint8_t slot = here_[n].slot;
                const auto& corners = sides.corner[faces_[here_[n].face].direction];
                const std::size_t axis = edge / 2;
                const bool to_next = corners[(slot + 1U) % 4][axis] != corners[slot][axis];
                pinched[here_[n].face] |=
                    static_cast<std::uint8_t>(1U << (2 * slot + (to_next ? 0 : 1)));
            }
        }
    }

  private:
    static unsigned place_of(std::size_t axis, unsigned octant) {
        return static_cast<unsigned>(4 * axis + (octant >> (axis + 1) % 3 & 1) +
                                     2 * (octant >> (axis + 2) % 3 & 1));
    }
    // The faces at the edge that leaves the corner along an axis, 2 * axis + 1 for upwards.
    std::array<std::uint8_t, 4> around_edge(unsigned edge) const {
        const unsigned axis = edge / 2, up = edge % 2;
        std::array<std::uint8_t, 4> out{};
        for (unsigned n = 0; n < 4; ++n) {
            const unsigned across = (axis + 1 + n / 2) % 3, other = 3 - axis - across;
            out[n] = place_[place_of(across, up << axis | (n % 2) << other)];
        }
        return out;
    }
    void join_at(unsigned edge) {
        std::array<std::uint8_t, 4> around = around_edge(edge);
        const auto end = std::remove(around.begin(), around.end(), none);
        const bool touch_only = end - around.begin() == 4;
        for (auto a = around.begin(); a != end; ++a) {
            for (auto b = around.begin(); b != a; ++b)
                if (!touch_only || octant_[*a] == octant_[*b]) unite(*a, *b);
        }
    }
    std::size_t root(std::size_t n) const {
        while (parent_[n] != n) n = parent_[n];
        return n;
    }
    void unite(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = static_cast<std::uint8_t>(std::min(a, b));
    }

    std::span<const FaceCorner> here_;
    std::vector<VoxelFace>& faces_;
    std::array<std::uint8_t, 12> place_{};  // which of here_ is there
    std::array<unsigned, 12> octant_{};     // of the voxel of each of here_
    std::array<std::uint8_t, 12> parent_{};
};

}  // namespace

BlockSurface block_surface(std::span<const ObjectVoxel> voxels) {
    BlockSurface out;
    out.face = faces_of(voxels);
    std::vector<std::uint8_t> pinched(out.face.size(), 0);
    each_corner(voxels, out.face, [&](const Place& at, std::span<const FaceCorner> corners) {
        Meeting meeting(corners, out.face);
        const std::uint32_t made = meeting.join(static_cast<std::uint32_t>(out.corner.size()));
        out.corner.insert(out.corner.end(), made, at);
        meeting.mark_pinched(pinched);
    });
    for (std::size_t f = 0; f < out.face.size(); ++f) {
        for (unsigned n = 0; n < 4; ++n) {
            const bool both =
                pinched[f] >> (2 * n) & 1 && pinched[f] >> (2 * ((n + 1) % 4) + 1) & 1;
            out.face[f].pinched |= static_cast<std::uint8_t>(both ? 1U << n : 0U);
        }
    }
    return out;
}

}  // namespace topple::solids
