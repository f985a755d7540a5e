// SPDX-License-Identifier: MIT
#include "vdb/write_space_fields.h"

#include "core/vectors.h"
#include "vdb/archive.h"

namespace topple::vdb {
namespace {

float value_of(float value) {
    return value;
}
openvdb::Vec3s value_of(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

template <class Grid, class Value>
typename Grid::Ptr grid_of(const SpaceField& field, const std::vector<Value>& values) {
    const auto grid = Grid::create();
    auto to = grid->getAccessor();
    for (std::size_t n = 0; n < field.size(); ++n) {
        const auto& [i, j, k] = field.cell[n];
        to.setValueOn({i, j, k}, value_of(values[n]));
    }
    return grid;
}

void add_grids(const std::string& name, const SpaceField& field, openvdb::GridPtrVec& grids) {
    const auto add = [&](const char* what, const std::string& unit,
                         const openvdb::GridBase::Ptr& grid) {
        describe(*grid, name + "_" + what, transform_of(field.corner_m, field.along_m),
                 length(field.along_m[0]));
        grid->insertMeta("unit", openvdb::StringMetadata(unit));
        grids.push_back(grid);
    };
    const auto velocity = grid_of<openvdb::Vec3SGrid>(field, field.velocity_m_s);
    velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    velocity->setIsInWorldSpace(true);
    add("velocity", "m/s", velocity);
    add("frequency", "per event", grid_of<openvdb::FloatGrid>(field, field.frequency));
    add("energy", field.energy_unit, grid_of<openvdb::FloatGrid>(field, field.energy));
}

}  // namespace

void write_space_fields(const std::filesystem::path& path,
                        const std::map<std::string, SpaceField>& fields) {
    openvdb::GridPtrVec grids;
    for (const auto& [name, field] : fields) add_grids(name, field, grids);
    write_archive(path, grids, about_file("topple.fields/1"));
}

}  // namespace topple::vdb
