// SPDX-License-Identifier: MIT
#include "scale/parts_fields.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/field_rules.h"
#include "core/saved_solids.h"
#include "solids/volume.h"

namespace topple {
namespace {

// Metres, and what there may be of anything: what is reckoned with such numbers is finite.
constexpr auto place = rules::within(-1e7, 1e7), amount = rules::within(0, 1e12);

// Structs with gaps between their members go by members: equal parts are equal files.
template <class Io, class Contacts>
void contact_fields(Io& io, Contacts& c, std::size_t count) {
    using namespace rules;
    io(c.primitives, within(static_cast<double>(count), static_cast<double>(count)));
    io(c.voxel_m, within(0, 1));
    io(c.pairs, of_all([count](const physics::TouchingPair& pair, const auto& must) {
           must(pair.a, ids(count)), must(pair.b, ids(count));
           must(pair.area_m2, amount), must(pair.normal, within(-1.001, 1.001));
           must(pair.center, place), must(pair.ends, place);
       }));
    io.expect(
        std::ranges::is_sorted(c.pairs, {}, [](const auto& p) { return std::pair(p.a, p.b); }));
    list_fields(io, c.carryings, [count](auto& each, auto& carrying) {
        each(carrying.supporter, labels(count));
        each(carrying.supported, ids(count));
        each(carrying.area_m2, amount);
        each(carrying.height_m, place);
        each(carrying.outline, place);
        each(carrying.border_error_m, amount);
    });
    io.expect(std::ranges::is_sorted(
        c.carryings, {}, [](const auto& one) { return std::pair(one.supported, one.supporter); }));
    io(c.leanings, of_all([count](const graph::Leaning& l, const auto& must) {
           must(l.primitive, ids(count)), must(l.against, ids(count));
           must(l.height_m, place), must(l.outline, place);
       }));
    io.expect(std::ranges::is_sorted(c.leanings, {}, &graph::Leaning::primitive));
    io(c.silhouette_m2, length(count), amount);
    for (auto* values : {&c.lowest_m, &c.highest_m}) io(*values, length(count), no_nan);
    io(c.section_m2, length(count), amount);
}

// What else they are is asked where a scene is made of them.
template <class Io, class Voxels>
void voxel_fields(Io& io, Voxels& v, std::size_t count) {
    io(v.frame);
    io(v.bounds);
    io(v.beyond);
    io(v.tiles);
    io(v.leaves);
    io(v.states);
    io(v.solid);
    io(v.labelled);
    io(v.has_label);
    io(v.label, rules::labels(count));
}

// The same.
template <class Io, class Solids>
void solid_fields(Io& io, Solids& s, std::size_t count) {
    for (auto* cells : {&s.cells, &s.strays}) {
        io(cells->voxel_m);
        SolidCells::each_array([&](auto& array) { io(array); }, *cells);
        io(cells->unseen_below);
    }
    list_fields(io, s.boundary.patches, [](auto& each, auto& patch) {
        each(patch.primitive);
        each(patch.origin);
        each(patch.c);
        each(patch.noise_m);
        each(patch.offset_m);
    });
    BoundaryCells::each_array([&](auto& array) { io(array); }, s.boundary);
    io(s.roles, rules::length(count));
}

template <class Io, class Points>
void point_fields(Io& io, Points& p, std::size_t count) {
    using namespace rules;
    io(p.primitive, labels(count));
    const std::size_t points = p.primitive.size();
    for (auto* values : {&p.x, &p.y, &p.z}) io(*values, length_or_none(points), place);
    io.expect(p.y.size() == p.x.size() && p.z.size() == p.x.size());
    for (auto* values : {&p.nx, &p.ny, &p.nz}) io(*values, length(points), finite);
    io(p.region, length(points));
    for (auto* values : {&p.red, &p.green, &p.blue}) io(*values, length_or_none(points));
    io.expect(p.green.size() == p.red.size() && p.blue.size() == p.red.size());
    io(p.index, length_or_none(points), ascending);
}

template <class Io, class Samples>
void sample_fields(Io& io, Samples& s, std::size_t count) {
    using namespace rules;
    io(s.edge_m, within(1e-6, 1e3));
    io(s.spacing_m, within(1e-6, 1e3));
    io(s.primitive, labels(count), [](const auto& p) { return std::ranges::is_sorted(p); });
    const std::size_t size = s.primitive.size();
    for (auto* values : {&s.x, &s.y, &s.z}) io(*values, length(size), place);
    for (auto* values : {&s.nx, &s.ny, &s.nz}) io(*values, length(size), finite);
    io(s.lab_l, length_or_none(size));
    for (auto* values : {&s.lab_a, &s.lab_b}) io(*values, length(s.lab_l.size()));
}

template <class Io, class Parts>
void parts_fields(Io& io, Parts& g) {
    using namespace rules;
    io(g.parts.model, shown);
    const std::size_t count = g.parts.model.size();
    io.expect(count > 0);
    io(g.voxel_m, within(0, 1));
    io(g.offset_m, finite);
    io(g.notes, shown);
    point_fields(io, g.points, count);
    io(g.image_width);
    io(g.image_height);
    auto& f = g.parts.frame;
    io(f.axes, finite);
    io(f.origin_m, finite);
    io(f.found);
    io(f.up_method, shown);
    io(f.note, shown);
    io(f.up_share, finite);
    io(g.parts.shell_log_odds, length(count), finite);
    io(g.parts.points, length(count));
    sample_fields(io, g.parts.samples, count);
    io(g.weighed.bodies, length(count),
       of_all([](const physics::MassProperties& body, const auto& must) {
           must(body.volume_m3, amount), must(body.mass_kg, amount), must(body.center, place);
       }));
    contact_fields(io, g.weighed.contacts, count);
    io(g.weighed.joints, of_all([count](const graph::Joint& joint, const auto& must) {
           must(joint.a, ids(count)), must(joint.b, ids(count)), must(joint.log_odds, finite);
           must(joint.b, within(joint.a + 1.0, static_cast<double>(count)));
       }));
    io.expect(std::ranges::is_sorted(
        g.weighed.joints, {}, [](const auto& joint) { return std::pair(joint.a, joint.b); }));
    io(g.weighed.shell.log_odds, length(count), finite);
    io(g.weighed.shell.pinned, length(count));
}

}  // namespace

FoundParts read_parts(tiles::BinaryReader& file) {
    FoundParts out;
    SavedSolids solids;
    vdb::SavedVoxels voxels;
    parts_fields(file, out);
    const std::size_t count = out.parts.model.size();
    solid_fields(file, solids, count);
    voxel_fields(file, voxels, count);
    bool sensed = false;
    file(sensed);
    file.expect(solids.cells.voxel_m == out.voxel_m && voxels.frame.voxel_m == out.voxel_m &&
                voxels.frame.grid_from_input == out.parts.frame.axes &&
                voxels.frame.origin_m == out.parts.frame.origin_m);
    out.parts.solids = scene_of(std::move(solids));
    out.voxels = std::make_shared<vdb::VoxelScene>(voxels);
    if (sensed) out.parts.sensed = out.voxels;
    store_fractions(*out.parts.solids, *out.voxels);
    return out;
}

void write_parts(tiles::BinaryWriter& file, const FoundParts& found) {
    const std::size_t count = found.parts.model.size();
    const SavedSolids solids = saved(*found.parts.solids);
    const vdb::SavedVoxels voxels = found.voxels->saved();
    parts_fields(file, found);
    solid_fields(file, solids, count);
    voxel_fields(file, voxels, count);
    file(found.parts.sensed != nullptr);
}

}  // namespace topple
