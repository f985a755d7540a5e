// SPDX-License-Identifier: MIT
#include "pipeline/groundwork_file.h"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>
#include <type_traits>
#include <utility>

#include "core/build_id.h"
#include "io/folder_names.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "pipeline/cancelling.h"
#include "pipeline/voxel_stage.h"
#include "tiles/binary_file.h"
#include "tiles/work_files.h"
#include "topple/version.h"

namespace topple {
namespace {

namespace fs = std::filesystem;

// Changes with what is written below.
constexpr std::string_view groundwork_mark = "topple groundwork 4";

// --- What it depends on ---

void add_text(Checksum& sum, std::string_view text) {
    const std::uint64_t size = text.size();
    sum.add(&size, sizeof(size));
    sum.add(text.data(), text.size());
}

// What is larger takes blocks, or is none of what is parsed in one piece.
constexpr std::uint64_t largest_file_bytes = std::uint64_t{4} << 30;

// False where it can't be read: whoever reads it next says why.
bool add_file(Checksum& sum, const io::FileName& name, const ParseOptions& options) {
    std::optional<io::OpenFile> file;
    try {
        file.emplace(name);
    } catch (const Error&) {
        return false;
    }
    const std::uint64_t size = file->size;
    if (size > largest_file_bytes) return false;
    add_text(sum, name.path().filename().string());
    sum.add(&size, sizeof(size));
    std::vector<char> piece(1 << 20);
    for (std::uint64_t left = size; left > 0;) {
        end_if_cancelled(options);
        const std::uint64_t count = std::min<std::uint64_t>(left, piece.size());
        if (file->read(piece.data(), count) < count) return false;
        sum.add(piece.data(), count);
        left -= count;
    }
    return true;
}

// The files right in a folder of the scan, by name; part: "." for the scan's own.
bool add_files_of(Checksum& sum, const fs::path& scan, const fs::path& part,
                  const ParseOptions& options) {
    std::error_code error;
    if (!fs::is_directory(scan / part, error)) return true;
    std::vector<std::string> names = io::folder_names(io::FileName::in(scan, part), error);
    if (error) return false;
    std::ranges::sort(names);
    for (const std::string& name : names) {
        if (!fs::is_regular_file(scan / part / name, error)) continue;
        if (!add_file(sum, io::FileName::in(scan, part / name), options)) return false;
    }
    return true;
}

bool add_input(Checksum& sum, const fs::path& input, const ParseOptions& options) {
    std::error_code error;
    if (!fs::is_directory(input, error)) {
        // Parts of these lie in other files.
        const std::string kind = io::lower_case(input.extension().string());
        return kind != ".gltf" && kind != ".obj" && add_file(sum, input, options);
    }
    for (const char* part : {"", "depth", "color"}) {
        add_text(sum, part);
        if (!add_files_of(sum, input, *part ? part : ".", options)) return false;
    }
    return true;
}

void add_options(Checksum& sum, const ParseOptions& options) {
    const auto add = [&](const auto& value) { sum.add(&value, sizeof(value)); };
    add_text(sum, version);
    add_text(sum, build_id());
    const device::DeviceInfo& info = options.device->info();
    add_text(sum, device::to_string(info.backend));
    // The native backend's results are those of every processor and number of threads.
    if (info.backend != device::Backend::native) {
        add_text(sum, info.name);
        add_text(sum, info.driver);
    }
    add(options.voxel_m);
    add(options.unit_m);
    add(options.max_memory_bytes);
    add(options.density_kg_m3);
    add(options.up.value_or(Vec3{}));
    add(options.coordinates);
}

// --- How it is written: one list of fields for both ways ---

// Structs with gaps between their members go by members: equal groundwork is equal files.
template <class Io, class Contacts>
void contact_fields(Io& io, Contacts& c) {
    io(c.primitives);
    io(c.voxel_m);
    io(c.pairs);
    list_fields(io, c.carryings, [](auto& each, auto& carrying) {
        each(carrying.supporter);
        each(carrying.supported);
        each(carrying.area_m2);
        each(carrying.height_m);
        each(carrying.outline);
        each(carrying.border_error_m);
    });
    io(c.leanings);
    io(c.silhouette_m2);
    list_fields(io, c.clearances, [](auto& each, auto& of_primitive) {
        list_fields(each, of_primitive, [](auto& one, auto& clearance) {
            one(clearance.below);
            one(clearance.gap_m);
            one(clearance.area_m2);
        });
    });
    io(c.lowest_m);
    io(c.highest_m);
    io(c.section_m2);
}
template <class Io, class Voxels>
void voxel_fields(Io& io, Voxels& v) {
    io(v.frame);
    io(v.bounds);
    io(v.unplaced);
    io(v.beyond);
    io(v.tiles);
    io(v.leaves);
    io(v.states);
    io(v.solid);
    io(v.labelled);
    io(v.has_label);
    io(v.label);
}

// A scene of solids in its parts.
struct FlatSolids {
    SolidCells cells, strays;
    BoundaryCells boundary;
    std::vector<Role> roles;
};
FlatSolids flat(const SolidScene& solids) {
    FlatSolids out{solids.cells(), solids.strays(), solids.boundary(), {}};
    for (std::size_t p = 0; p < solids.primitives(); ++p)
        out.roles.push_back(solids.role(static_cast<std::int32_t>(p)));
    return out;
}
template <class Io, class Solids>
void solid_fields(Io& io, Solids& s) {
    for (auto* cells : {&s.cells, &s.strays}) {
        io(cells->voxel_m);
        for (auto* array : {&cells->i, &cells->j, &cells->k, &cells->primitive}) io(*array);
        io(cells->basis);
        io(cells->unseen_below);
    }
    auto& b = s.boundary;
    list_fields(io, b.patches, [](auto& each, auto& patch) {
        each(patch.primitive);
        each(patch.origin);
        each(patch.c);
        each(patch.noise_m);
        each(patch.offset_m);
    });
    for (auto* array : {&b.i, &b.j, &b.k, &b.primitive}) io(*array);
    for (auto& slot : b.slot) io(slot);
    io(b.form);
    io(b.share);
    for (auto& moment : b.moment) io(moment);
    io(s.roles);
}

template <class Io, class Ground>
void ground_fields(Io& io, Ground& g) {
    io(g.voxel_m);
    io(g.offset_m);
    io(g.notes);
    auto& p = g.points;
    for (auto* array : {&p.x, &p.y, &p.z, &p.nx, &p.ny, &p.nz}) io(*array);
    io(p.primitive);
    io(p.region);
    for (auto* array : {&p.red, &p.green, &p.blue}) io(*array);
    io(p.index);
    io(g.image_width);
    io(g.image_height);
    auto& f = g.parts.frame;
    io(f.axes);
    io(f.found);
    io(f.up_method);
    io(f.note);
    io(f.up_share);
    io(g.parts.model);
    io(g.parts.shell_log_odds);
    io(g.parts.points);
    auto& s = g.parts.samples;
    io(s.edge_m);
    io(s.spacing_m);
    for (auto* column : geometry::columns_of(s)) io(*column);
    io(s.primitive);
    io(g.weighed.bodies);
    contact_fields(io, g.weighed.contacts);
    io(g.weighed.joints);
    io(g.weighed.shell.log_odds);
    io(g.weighed.shell.pinned);
}

// --- Whether what was read is what is written: a file says anything ---

bool coherent(const Groundwork& g, const FlatSolids& solids) {
    const std::size_t count = g.parts.model.size(), points = g.points.primitive.size();
    const auto is_part = [&](std::int32_t p) {
        return p >= 0 && static_cast<std::size_t>(p) < count;
    };
    const auto is_label = [&](std::int32_t p) { return p == -1 || is_part(p); };
    const graph::ContactGraph& c = g.weighed.contacts;
    bool right = count > 0 && solids.roles.size() == count && solids.boundary.fits(count) &&
                 c.primitives == static_cast<std::int32_t>(count) &&
                 std::ranges::all_of(g.points.primitive, is_label) &&
                 std::ranges::all_of(solids.cells.primitive, is_label);
    for (const std::size_t size :
         {g.parts.shell_log_odds.size(), g.parts.points.size(), g.weighed.bodies.size(),
          g.weighed.shell.log_odds.size(), g.weighed.shell.pinned.size(), c.silhouette_m2.size(),
          c.clearances.size(), c.lowest_m.size(), c.highest_m.size(), c.section_m2.size()})
        right = right && size == count;
    for (const auto* array : {&g.points.x, &g.points.y, &g.points.z})
        right = right && (array->size() == points || array->empty());
    for (const auto* array : {&g.points.red, &g.points.green, &g.points.blue})
        right = right && (array->size() == points || array->empty());
    for (const auto* array : {&g.points.nx, &g.points.ny, &g.points.nz})
        right = right && array->size() == points;
    right = right && g.points.region.size() == points &&
            (g.points.index.empty() || g.points.index.size() == points);
    const geometry::SurfaceSamples& samples = g.parts.samples;
    const auto columns = geometry::columns_of(samples);
    for (const auto* column : columns) {
        const bool colour =
            column == &samples.lab_l || column == &samples.lab_a || column == &samples.lab_b;
        right = right &&
                column->size() == (colour && !samples.coloured() ? 0 : samples.primitive.size());
    }
    right = right && std::ranges::all_of(samples.primitive, is_label) &&
            std::ranges::is_sorted(samples.primitive);
    for (const physics::TouchingPair& pair : c.pairs)
        right = right && is_part(pair.a) && is_part(pair.b);
    for (const graph::Carrying& carrying : c.carryings)
        right = right && is_label(carrying.supporter) && is_part(carrying.supported);
    for (const graph::Leaning& l : c.leanings)
        right = right && is_part(l.primitive) && is_part(l.against);
    for (const graph::Joint& j : g.weighed.joints)
        right = right && is_part(j.a) && is_part(j.b) && j.a < j.b;
    for (const auto* cells : {&solids.cells, &solids.strays})
        right = right && cells->basis.size() == cells->size() &&
                std::ranges::all_of(cells->basis, [](Basis basis) {
                    return static_cast<std::uint8_t>(basis) < basis_count;
                });
    for (const Role role : solids.roles) right = right && role <= Role::fixture;
    return right;
}

Groundwork read_whole(tiles::BinaryReader& file) {
    Groundwork out;
    FlatSolids solids;
    vdb::SavedVoxels voxels;
    ground_fields(file, out);
    solid_fields(file, solids);
    voxel_fields(file, voxels);
    if (!coherent(out, solids)) file.damaged();
    try {
        out.parts.solids = std::make_shared<const SolidScene>(
            std::move(solids.cells), std::move(solids.roles), std::move(solids.strays),
            std::move(solids.boundary));
        out.voxels = std::make_shared<vdb::VoxelScene>(voxels);
    } catch (const Error&) {
        file.damaged();
    }
    store_fractions(*out.parts.solids, *out.voxels);
    return out;
}

}  // namespace

GroundworkFile::GroundworkFile(const fs::path& input, const ParseOptions& options)
    : file_(options.cache_file), notice_(options.notice) {
    io::check_replaceable_file(file_);
    if (!tiles::has_mark(file_))
        io::fail(file_, "exists and is no cache of topple; choose another name");
    Checksum sum;
    add_text(sum, groundwork_mark);
    add_options(sum, options);
    if (add_input(sum, input, options)) key_ = sum.value();
}

std::optional<Groundwork> GroundworkFile::read() const {
    std::error_code error;
    if (!key_ || !fs::is_regular_file(file_, error)) return std::nullopt;
    const auto tell = [&](const std::string& line) {
        if (notice_) notice_(line);
    };
    try {
        tiles::BinaryReader file(file_);
        if (file.value<Checksum::Value>() != *key_) return std::nullopt;
        Groundwork out = read_whole(file);
        tell("going on from " + file_.filename().string() +
             ", which holds what an earlier parse found");
        return out;
    } catch (const Error&) {
        tell(file_.filename().string() +
             " is damaged or no cache of this program; it is made anew");
        return std::nullopt;
    }
}

void GroundworkFile::write(const Groundwork& ground) const {
    try {
        io::PendingFile pending(file_);
        tiles::BinaryWriter file(pending.path());
        file(*key_);
        const FlatSolids solids = flat(*ground.parts.solids);
        const vdb::SavedVoxels voxels = ground.voxels->saved();
        ground_fields(file, ground);
        solid_fields(file, solids);
        voxel_fields(file, voxels);
        file.finish(false);
        pending.commit();
    } catch (const Error& failed) {
        if (notice_) notice_(std::string(failed.what()) + "; the next parse begins anew");
    }
}

}  // namespace topple
