// SPDX-License-Identifier: MIT
#include <algorithm>

#include "vdb/completion.h"
#include "vdb/grids.h"

namespace topple::vdb {

struct VolumeView::Access {
    explicit Access(const VoxelScene::Grids& g)
        : frame(g.frame),
          state(g.state->getConstAccessor()),
          primitive(g.primitive->getConstAccessor()) {}
    VoxelFrame frame;
    openvdb::Int32Grid::ConstAccessor state, primitive;
};

VolumeView::VolumeView(const VoxelScene& volume, const SolidCells& cells,
                       std::span<const Role> roles)
    : access_(std::make_unique<Access>(volume.grids())), cells_(cells), roles_(roles) {
    for (const std::int32_t p : cells.primitive)
        primitives_ = std::max(primitives_, static_cast<std::size_t>(std::int64_t{p} + 1));
}
VolumeView::~VolumeView() = default;

double VolumeView::voxel_m() const {
    return access_->frame.voxel_m;
}
bool VolumeView::solid(const Voxel& at) const {
    return access_->state.isValueOn(coord(at));
}
std::int32_t VolumeView::primitive(const Voxel& at) const {
    return access_->primitive.getValue(coord(at));
}
bool VolumeView::seen_empty(const Voxel& at) const {
    return access_->state.getValue(coord(at)) == static_cast<std::int32_t>(State::empty);
}

std::int32_t VolumeView::unseen_run(Voxel from, int axis, int way, std::int32_t most) const {
    std::int32_t run = 0;
    openvdb::Coord at = coord(from);
    while (run < most &&
           access_->state.getValue(at) == static_cast<std::int32_t>(State::invisible)) {
        ++run;
        at[axis] += way;
    }
    return run;
}

}  // namespace topple::vdb
