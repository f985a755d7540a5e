// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "topple/cloud_view.h"
#include "topple/device.h"
#include "topple/scene.h"

// Single stages of a parse, for programs that have the rest. Each runs on the device that it is
// given, waits until it is done, and throws Error: usage (an argument is out of its range, or
// arrays don't fit together), input (values that are not finite), device (it failed, or something
// is too large for it).
//
// Metres, kilograms, joules. Those that take points work in the frame of the points; where
// gravity plays a part, that frame must have z up.
namespace topple::vdb {
class VoxelScene;
}

namespace topple::stages {

// The caller's buffer on an adopted device: a cl_mem of its context, or a VkBuffer of its VkDevice,
// made with VK_BUFFER_USAGE_STORAGE_BUFFER_BIT for the adopted queue's family. It is neither
// copied nor destroyed. What wrote to it must have ended; the stage's own writes are done, and
// visible to the queue's later commands behind a memory barrier, when the stage returns.
struct DeviceBuffer {
    void* handle = nullptr;
    std::uint64_t bytes = 0;         // of the whole buffer
    std::uint64_t offset_bytes = 0;  // of the array in it; a multiple of 512
};

// An array that a stage reads (const T) or writes: in host memory, or in the caller's buffer.
template <class T>
struct Array {
    std::span<T> host;
    DeviceBuffer buffer;  // instead of `host` where its handle is not null
    std::uint64_t count = 0;

    Array() = default;
    Array(std::span<T> values) : host(values), count(values.size()) {}
    template <class Values>
    requires requires(Values& v) { std::span<T>(v); }
    Array(Values& values) : Array(std::span<T>(values)) {}
    Array(const DeviceBuffer& b, std::uint64_t elements) : buffer(b), count(elements) {}
    bool on_device() const { return buffer.handle != nullptr; }
};

// Typical distance of a point to its nearest neighbour, metres; 0 for fewer than two places. Throws
// Error(input), too, where the points lie so far apart that they can't be in metres.
double point_spacing(const CloudView& cloud);

// Normals of a cloud, one for each point: that of the plane through its neighbourhood of cells,
// unit; 0, 0, 0 where there is none, and for points that are not finite. They turn towards `eye_m`,
// where the sensor was; where that is null, to where the cloud says that each point was seen from
// (viewpoint_x to viewpoint_z, else viewpoint); else their sign is arbitrary but locally
// consistent. cell_m: edge of the cells, about twice the points' spacing, 1 m at most. The spans
// hold a float for each point. Throws Error(input), too, where the points lie so far apart that
// they can't be in metres.
void normals(device::Device& device, const CloudView& cloud, double cell_m, const Vec3* eye_m,
             std::span<float> nx, std::span<float> ny, std::span<float> nz);

// Pinhole depth image, as DepthFrame, with the pixels where the caller keeps them.
struct DepthView {
    std::span<const std::uint16_t> depth;
    Mat4 camera_to_world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

// The solid voxels, sorted by (i, j, k): voxel (i, j, k) spans [i, i + 1] * voxel_m per axis.
struct Voxels {
    std::vector<std::int32_t> i, j, k;
    std::vector<std::int32_t> label;  // -1: none
    std::vector<std::uint8_t> state;  // 1: seen surface, 3: completed
};

// By label, the voxel (its place in the arrays) that names it best to corrections
// (docs/corrections.md): deep among its own, four voxels from those of others or as far as it gets,
// of these the one nearest to their middle, and one that was seen where any was; -1: it has none.
// Throws Error(usage) for arrays of different lengths, labels above 65533, and voxels further than
// 2^20 from 0.
std::vector<std::int64_t> label_spots(const Voxels& solid);

// A voxel grid, carved and filled (paper, 2.2). z up.
class Volume {
  public:
    // Surface voxels of a cloud; label: of each point, -1 for none; voxel_m: 0.001 to 1. Throws
    // Error(input), too, where the points lie so far apart that they can't be in metres.
    Volume(const CloudView& cloud, std::span<const std::int32_t> label, double voxel_m);
    ~Volume();
    Volume(Volume&&) noexcept;
    Volume& operator=(Volume&&) noexcept;

    // Voxels in front of a depth reading become empty. May be called for one batch of frames after
    // the other. Throws Error(input), too, where places or readings can't be in metres: cameras
    // that leap, or are hundreds of metres from the cloud, and readings from as far away.
    void carve(device::Device& device, const Intrinsics& intrinsics,
               std::span<const DepthView> frames);
    // Voxels that no frame saw take the label that at least `votes` (1 to 6) of the rays along
    // their six axes hit first. hollow: labels that stop rays but neither fill nor are filled, as
    // walls do; the others count up from 0. Returns voxels completed.
    std::uint64_t fill(device::Device& device, unsigned votes,
                       std::span<const std::int32_t> hollow = {});
    // 0 seen empty, 1 seen surface, 2 never seen, 3 completed.
    int state_at(std::int32_t i, std::int32_t j, std::int32_t k) const;
    Voxels solid() const;

  private:
    std::unique_ptr<vdb::VoxelScene> scene_;
    std::array<Vec3, 2> box_m_{};  // around the points: its low and high corner
    std::int32_t labels_ = 0;
};

// One array per coordinate, of equal length.
struct Coordinates {
    Array<const float> x, y, z;
};

// Support functions (paper, Eq. 4): s(d) = min of v . d over the vertices v of each set, metres,
// for every direction d. `first`: where each set starts in `vertices`, and last where the last
// ends; no set is empty. `out` holds a row of directions for each set. Arrays may lie in the
// caller's buffers, each by itself; if directions or `out` do, the directions number a multiple of
// 32, and if `out` does, its sets and directions fit one binding of the device.
void support_functions(device::Device& device, const Coordinates& vertices,
                       std::span<const std::uint64_t> first, const Coordinates& directions,
                       const Array<float>& out);

// A rigid body on level ground: points of its surface (its convex hull decides), as it stands.
struct StandingBody {
    std::span<const Vec3> points;
    double mass_kg = 0;
    Vec3 center_of_mass_m{};
};

struct Barrier {
    double barrier_J = 0;  // least energy that takes it out of its pose; 0: it falls by itself
    double release_J = 0;  // what it then can release
    Vec3 direction{};      // horizontal way that it goes, unit; zero: any
    std::vector<InstabilityStep> curve;  // S(W)
};

// Barriers of bodies, by tipping alone (paper, 3.2). resolution_m: to what the points are known,
// up to 1; what is no higher above the lowest point bears the body. Throws Error(input), too, for a
// body of a density that none has in metres and kilograms, and for a centre of mass many times as
// far from the points as these extend.
std::vector<Barrier> barriers(device::Device& device, std::span<const StandingBody> bodies,
                              double resolution_m);

// Planes of a map, one for each direction that something moves in, rows of `width` cells.
struct MapShape {
    std::uint32_t width = 0, height = 0, directions = 0;
    // 0 where both arrays are in host memory; they get their margin on the way. Where one is in a
    // caller's buffer: the cells of 0 that `primary` has on each side, counted in width and height,
    // more than the reach of the footprint; width is then a multiple of 64.
    std::uint32_t margin = 0;
};
// What stands dx, dy cells from a cell acts on it by this weight.
struct FootprintEntry {
    std::int32_t dx = 0, dy = 0;
    float weight = 0;
};

// Disturbance field by convolution (paper, 5.1.2): for each direction d and cell c the sum of
// weight * primary(d, c + (dx, dy)) over the footprint's entries of d, in their order; cells
// beyond the map count as 0, and nothing stands in the way. first: where each direction's entries
// start, and last where the last ends. `density` has the shape of `primary`; with a margin, only
// its height - 2 * margin rows between, in which the first and last `margin` cells mean nothing.
void convolve(device::Device& device, const MapShape& shape, const Array<const float>& primary,
              std::span<const FootprintEntry> footprint, std::span<const std::uint32_t> first,
              const Array<float>& density);

}  // namespace topple::stages
