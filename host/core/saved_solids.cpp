// SPDX-License-Identifier: MIT
#include "core/saved_solids.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/voxel_spread.h"
#include "topple/error.h"

namespace topple {
namespace {

[[noreturn]] void refuse(const char* why) {
    throw Error(ErrorKind::input, why);
}

// Where all is along an axis.
struct Range {
    std::int64_t low = std::numeric_limits<std::int64_t>::max();
    std::int64_t high = std::numeric_limits<std::int64_t>::min();

    void add(const std::vector<std::int32_t>& values) {
        for (const std::int32_t v : values) {
            low = std::min<std::int64_t>(low, v);
            high = std::max<std::int64_t>(high, v);
        }
    }
    std::int64_t size() const { return low > high ? 0 : high - low + 1; }
};

// No voxel of a scene lies further than 2^20 from the middle.
void check_places(const SavedSolids& s) {
    constexpr std::int64_t most = (std::int64_t{1} << 21) + 64;
    std::array<Range, 3> range;
    VoxelSpread spread;
    const auto add = [&](const auto& voxels) {
        range[0].add(voxels.i);
        range[1].add(voxels.j);
        range[2].add(voxels.k);
        for (std::size_t n = 0; n < voxels.size(); ++n)
            if (!spread.add(voxels.i[n], voxels.j[n], voxels.k[n]))
                refuse("its voxels lie too far apart");
    };
    add(s.cells);
    add(s.boundary);
    add(s.strays);
    for (const Range& r : range)
        if (r.size() > most) refuse("its voxels lie too far apart");
}

template <class Voxels>
bool has_places(const Voxels& v) {
    return v.j.size() == v.i.size() && v.k.size() == v.i.size();
}

}  // namespace

SavedSolids saved(const SolidScene& solids) {
    SavedSolids out{solids.cells(), solids.strays(), solids.boundary(), {}};
    for (std::size_t p = 0; p < solids.primitives(); ++p)
        out.roles.push_back(solids.role(static_cast<std::int32_t>(p)));
    return out;
}

std::shared_ptr<const SolidScene> scene_of(SavedSolids s) {
    const double voxel_m = s.cells.voxel_m;
    if (!(voxel_m > 0 && voxel_m <= 1)) refuse("its voxels have no size");
    if (!has_places(s.cells) || !has_places(s.strays) || !has_places(s.boundary))
        refuse("its arrays differ in length");
    if (!std::ranges::all_of(s.roles, [](Role role) { return role <= Role::fixture; }))
        refuse("a primitive has a role that there is not");
    check_places(s);
    try {
        return std::make_shared<const SolidScene>(std::move(s.cells), std::move(s.roles),
                                                  std::move(s.strays), std::move(s.boundary));
    } catch (const Error& error) {
        refuse(error.what());
    }
}

}  // namespace topple
