// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "topple/error.h"
#include "vdb/archive.h"
#include "vdb/grids.h"

// VoxelScene as an OpenVDB file.
namespace topple::vdb {

openvdb::math::Transform::Ptr VoxelScene::Grids::transform() const {
    std::array<Vec3, 3> along = frame.grid_from_input;
    for (Vec3& axis : along)
        for (double& v : axis) v *= frame.voxel_m;
    return transform_of(frame.origin_m, along);
}

void VoxelScene::add_field(const std::string& name, std::span<const std::int32_t> i,
                           std::span<const std::int32_t> j, std::span<const std::int32_t> k,
                           std::span<const float> values) {
    bool taken = name.empty() || name == "state" || name == "primitive" || name == "object";
    for (const auto& field : grids_->fields) taken = taken || field.first == name;
    if (taken) throw Error(ErrorKind::usage, "field \"" + name + "\": the name is taken or empty");
    if (i.size() != values.size() || j.size() != values.size() || k.size() != values.size()) {
        throw Error(ErrorKind::usage, "field \"" + name + "\": " + std::to_string(values.size()) +
                                          " values for " + std::to_string(i.size()) + " voxels");
    }
    const auto& grid = grids_->fields.emplace_back(name, openvdb::FloatGrid::create(0)).second;
    auto to = grid->getAccessor();
    for (std::size_t n = 0; n < values.size(); ++n) {
        if (values[n] != 0) to.setValueOn({i[n], j[n], k[n]}, values[n]);
    }
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
}

void VoxelScene::remove_field(const std::string& name) {
    std::erase_if(grids_->fields, [&](const auto& field) {
        if (field.first != name) return false;
        clear_tree(field.second->tree());
        return true;
    });
}

void VoxelScene::write(const std::filesystem::path& path) const {
    const Grids& g = *grids_;
    // Labels count where the voxel is solid; elsewhere they are background.
    const ShortLived<openvdb::Int32Grid> primitives(-1), objects(-1);
    const auto &primitive = primitives.grid, &object = objects.grid;
    for (auto leaf = g.state->tree().cbeginLeaf(); leaf; ++leaf) {
        if (leaf->isEmpty()) continue;
        const auto* label = g.primitive->tree().probeConstLeaf(leaf->origin());
        auto* to_primitive = primitive->tree().touchLeaf(leaf->origin());
        auto* to_object = object->tree().touchLeaf(leaf->origin());
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            const std::int32_t p = label->getValue(voxel.pos());
            const bool known = p >= 0 && static_cast<std::size_t>(p) < g.object_of_primitive.size();
            to_primitive->setValueOn(voxel.pos(), p);
            to_object->setValueOn(voxel.pos(), known ? g.object_of_primitive[p] : -1);
        }
    }
    openvdb::GridPtrVec grids;
    const auto add = [&](const std::string& name, const openvdb::GridBase::Ptr& grid) {
        describe(*grid, name, g.transform(), g.frame.voxel_m);
        grids.push_back(grid);
    };
    const auto state =
        openvdb::gridPtrCast<openvdb::Int32Grid>(g.state->copyGrid());  // shares the tree
    state->setGridClass(openvdb::GRID_UNKNOWN);
    state->insertMeta("values",
                      openvdb::StringMetadata("0 empty, 1 surface, 2 invisible, 3 completed"));
    add("state", state);
    add("primitive", primitive);
    add("object", object);
    for (const auto& [name, field] : g.fields) add(name, field);

    openvdb::MetaMap meta = about_file("topple.volume/1");
    meta.insertMeta("voxel_size_m", openvdb::DoubleMetadata(g.frame.voxel_m));
    write_archive(path, grids, meta);
}

}  // namespace topple::vdb
