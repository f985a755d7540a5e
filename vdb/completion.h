// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/ledge.h"
#include "core/role.h"
#include "core/solid_cells.h"
#include "core/space_map.h"
#include "topple/kernels/device.h"
#include "vdb/voxel_scene.h"

// From what was seen to what is solid. Each rule looks at the volume and proposes a list of voxels;
// none changes anything but by commit(). Rules that build on one another run in rounds, in this
// order: filling, settling, extending, backing, bridging, dropping what is detached, and what a map
// tells.
namespace topple::vdb {

// A voxel, and what a rule takes it for. Lists of them are sorted by voxel, each but once.
struct Claim {
    Voxel at{};
    std::int32_t primitive = -1;
    Basis basis = Basis::surface;
    bool solid = true;  // false: it is what nobody saw, after all
};

// What rules may ask: the volume as it was carved, with what earlier rounds made solid. One thread
// at a time; a commit() ends it.
class VolumeView {
  public:
    // cells: the volume's solid voxels, all of them. roles: by primitive.
    VolumeView(const VoxelScene& volume, const SolidCells& cells, std::span<const Role> roles);
    ~VolumeView();

    double voxel_m() const;
    const SolidCells& cells() const { return cells_; }
    // One more than the highest number of a primitive.
    std::size_t primitives() const { return primitives_; }
    // Of a primitive that ends somewhere; walls and ceilings are known as sheets alone.
    bool is_body(std::int32_t primitive) const {
        return primitive >= 0 && !is_sheet(role_of(roles_, primitive));
    }

    bool in_shell(std::int32_t primitive) const {
        return topple::in_shell(role_of(roles_, primitive));
    }
    bool is_upright_sheet(std::int32_t primitive) const {
        return role_of(roles_, primitive) == Role::wall;
    }

    bool solid(const Voxel& at) const;
    std::int32_t primitive(const Voxel& at) const;  // of a solid voxel; -1: of none
    // Whether a line of sight passed through it, and nothing lies there.
    bool seen_empty(const Voxel& at) const;
    // Voxels from `from` on, in steps of one along an axis (0 to 2; way 1 or -1), that nobody saw
    // and that nothing completed: at most `most`. Whether nobody saw a voxel is asked here alone.
    std::int32_t unseen_run(Voxel from, int axis, int way, std::int32_t most) const;

  private:
    struct Access;  // of OpenVDB
    std::unique_ptr<Access> access_;
    const SolidCells& cells_;
    std::span<const Role> roles_;
    std::size_t primitives_ = 0;
};

// Six-direction filling (paper, 2.2.3; kernels six_fill_sweep, six_fill_vote): an invisible
// voxel takes the primitive that at least `votes` of the rays along its six axes hit first; of
// several the one hit most often, then the nearest, then the lowest. Rays end at seen-empty
// voxels and at surfaces. Walls and ceilings stop rays, but neither fill nor are filled. With
// `columns`, for scenes seen from around, the ray upwards alone suffices where neither the ray
// downwards nor more than two of the four to the sides end in space seen to be empty: the inside of
// a sofa whose back stands at a wall. Throws Error(input) where the device has not the memory for
// it, Error(usage) for votes that are not 1 to 6. The volume holds nothing completed.
struct FillOptions {
    unsigned votes = 2;    // directions that must agree
    bool columns = false;  // fill what hides under a top, down to where it stands
    // Voxels with k below this one, the floor's, stay as they are and stop rays.
    std::int32_t lowest = std::numeric_limits<std::int32_t>::min();
    std::vector<Role> roles;  // by primitive
};
// Of each invisible voxel from which a ray hits a primitive.
struct RayEnds {
    Voxel at{};
    std::int32_t primitive = -1;  // that takes it; or the nearest whose back a ray meets
    std::uint8_t ends = 0;        // what its rays end at (fill_chance.h)
    bool taken = false;
};
// Those of which keep(ends) is so, by voxel.
std::vector<RayEnds> six_direction_rays(device::Device& device, const VoxelScene& volume,
                                        const FillOptions& options,
                                        const std::function<bool(const RayEnds&)>& keep);
// Of those that are taken.
std::vector<Claim> claims_of(std::span<const RayEnds> rays);

// Ends filled solids at the surface on which they are seen to stand: rays pass from a box into
// the table top that it hides, and take that for more of the box. What lies below goes to the
// primitive stood on, or beside it to a leg. ledges: where that is known.
std::vector<Claim> support_claims(const VolumeView& view, std::span<const Ledge> ledges = {});

// Slender parts (up to 10 cm) whose upper end nobody saw go on, through at most 60 cm of what
// nobody saw, to the wider thing above them: legs under a seat.
std::vector<Claim> leg_claims(const VolumeView& view);

// Upright sheets of the shell that stand before a wall, along an axis and at most 70 cm, with
// nothing seen between: fronts of what is built in, which reaches to the wall.
std::vector<Claim> built_in_claims(const VolumeView& view);

// Joins neighbouring primitives through what no frame saw: gaps of up to noise_gap
// invisible voxels along an axis between two primitives are completed, each voxel by the nearer
// of the two. Legs meet their table top where the edge above hides it. A gap with a voxel that
// was seen to be empty stays; so does one beside, not below or above, a wall or ceiling.
std::vector<Claim> gap_claims(const VolumeView& view);

// What was completed of a thing but hangs together with nothing that was seen of it or of others,
// not even across a hidden gap of noise_gap voxels up or down, is not solid after all: rays
// went on past space that was seen to be empty. What is the room's is left as it is.
std::vector<Claim> detached_claims(const VolumeView& view);

// What a map says to be solid within its surfaces: from here on as if it was seen. Such voxels
// belong to the primitive that they were completed to, if any. Throws as VoxelScene::set_free().
std::vector<Claim> map_claims(const VoxelScene& volume, const SpaceMap& map);

// The one way by which anything is completed: into the volume, and into the list of its solid
// voxels.
void commit(std::span<const Claim> claims, VoxelScene& volume, SolidCells& cells);

// Filling alone, of a volume by itself; an earlier completion is undone. Returns voxels completed.
std::uint64_t fill(device::Device& device, VoxelScene& volume, const FillOptions& options);

// All rounds. Returns what would make the volume what is likely (fill_chance.h), where filling has
// not, for a commit() of its own: the models of joints were fitted to volumes that are filled as in
// the paper. By what is completed in the end; sorted.
struct CompletionOptions {
    FillOptions fill;
    std::vector<Ledge> ledges;
    const SpaceMap* map = nullptr;  // what it tells to be solid
};
std::vector<Claim> complete(device::Device& device, const CompletionOptions& options,
                            VoxelScene& volume, SolidCells& cells);

}  // namespace topple::vdb
