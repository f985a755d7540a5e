// SPDX-License-Identifier: MIT
#include "vdb/write_space_fields.h"

#include "core/vectors.h"
#include "vdb/archive.h"

namespace topple::vdb {
namespace {

openvdb::math::Transform::Ptr transform_of(const SpaceField& field) {
    openvdb::Mat4d m = openvdb::Mat4d::identity();
    for (int d = 0; d < 3; ++d) {
        m(3, d) = field.corner_m[d];
        for (int a = 0; a < 3; ++a) {
            m(a, d) = field.along_m[a][d];
            m(3, d) += 0.5 * m(a, d);
        }
    }
    return openvdb::math::Transform::createLinearTransform(m);
}

template <class Grid, class ValueOf>
openvdb::GridBase::Ptr grid_of(const SpaceField& field, const ValueOf& value_of) {
    const auto grid = Grid::create();
    auto to = grid->getAccessor();
    for (std::size_t n = 0; n < field.size(); ++n) {
        const auto& [i, j, k] = field.cell[n];
        to.setValueOn({i, j, k}, value_of(n));
    }
    return grid;
}

}  // namespace

void write_space_fields(const std::filesystem::path& path,
                        const std::map<std::string, SpaceField>& fields) {
    openvdb::GridPtrVec grids;
    for (const auto& [name, field] : fields) {
        const auto add = [&, &name = name, &field = field](const char* what, const std::string& unit,
                                                           const openvdb::GridBase::Ptr& grid) {
            grid->setName(name + "_" + what);
            grid->setTransform(transform_of(field));
            grid->setCreator("topple");
            grid->insertMeta("unit", openvdb::StringMetadata(unit));
            grid->insertMeta("voxel_size_m", openvdb::DoubleMetadata(length(field.along_m[0])));
            grids.push_back(grid);
        };
        const auto velocity =
            grid_of<openvdb::Vec3SGrid>(field, [&, &field = field](std::size_t n) {
                const auto& v = field.velocity_m_s[n];
                return openvdb::Vec3s(v[0], v[1], v[2]);
            });
        velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
        velocity->setIsInWorldSpace(true);
        add("velocity", "m/s", velocity);
        add("frequency", "per event",
            grid_of<openvdb::FloatGrid>(
                field, [&, &field = field](std::size_t n) { return field.frequency[n]; }));
        add("energy", field.energy_unit,
            grid_of<openvdb::FloatGrid>(
                field, [&, &field = field](std::size_t n) { return field.energy[n]; }));
    }
    openvdb::MetaMap meta;
    meta.insertMeta("creator", openvdb::StringMetadata("topple"));
    meta.insertMeta("topple_schema", openvdb::StringMetadata("topple.fields/1"));
    write_archive(path, grids, meta);
}

}  // namespace topple::vdb
