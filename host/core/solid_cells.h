// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/basis.h"
#include "core/place.h"

namespace topple {

// The solid voxels of a scene, one array per field, sorted by (i, j, k). Grid frame: z up, voxel
// (i, j, k) spans [i, i + 1] * voxel_m per axis.
struct SolidCells {
    double voxel_m = 0;
    std::vector<std::int32_t> i, j, k;
    std::vector<std::int32_t> primitive;  // -1: belongs to none; such cells block but have no mass
    std::vector<Basis> basis;             // why it is taken to be solid
    // Voxels right below each that nobody has seen into, up to 255; empty: none for all.
    std::vector<std::uint8_t> unseen_below;
    std::size_t size() const { return i.size(); }
    // One more, of which unseen_below says nothing.
    void add(const Place& at, std::int32_t of, Basis why) {
        i.push_back(at[0]);
        j.push_back(at[1]);
        k.push_back(at[2]);
        primitive.push_back(of);
        basis.push_back(why);
    }
    // visit(array...) for each array that has a value for each cell, the same one of all of these.
    template <class Visit, class... Cells>
    static void each_array(const Visit& visit, Cells&... of) {
        each_place_array(visit, of...);
        visit(of.primitive...);
        visit(of.basis...);
    }
    // Appends cell n of others, as one of that primitive.
    void add(const SolidCells& from, std::size_t n, std::int32_t as) {
        add(place_of(from, n), as, from.basis[n]);
        if (!from.unseen_below.empty()) unseen_below.push_back(from.unseen_below[n]);
    }
};

// A solid has at least the volume of a cube of two voxels; less is a fragment that noise left,
// and too little to tell how it stands.
inline constexpr std::uint64_t least_voxels = 8;

}  // namespace topple
