// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/object_surface.h"
#include "core/thread_pool.h"
#include "report/view_walks.h"
#include "topple/scene.h"

// What the page draws, packed for it. Everything is in the view's frame: the input's, turned so
// that z is up and, where the scene has a Manhattan frame, its walls follow the axes.
namespace topple::report {

// How much the page may hold. A surface's bytes are those of its records, about twice what they
// take in the page. Of scans with colours it is three quarters of the voxels and points.
struct ViewLimits {
    std::size_t voxels = 400'000, points = 300'000, arrows = 1'200, walk_cells = 40'000;
    std::size_t surface_bytes = 16'000'000;
};

// Records of a voxel or point. cell: x, y, z in steps of PackedView::step_m from origin_m, then the
// group. aux: the mean normal in 1/127 (0 where unknown, which no voxel of the background is), then
// for voxels the exposed faces (bits -x +x -y +y -z +z) and, in bit 6, whether it was completed.
// photo: the colour in the scan, sRGB, and 255, or 0 where it is not known; empty where the scan
// has no colours.
struct Record {
    std::array<std::uint16_t, 4> cell{};
    std::array<std::int8_t, 4> aux{};
    std::array<std::uint8_t, 4> photo{};
};
struct Records {
    std::vector<std::array<std::uint16_t, 4>> cell;
    std::vector<std::array<std::int8_t, 4>> aux;
    std::vector<std::array<std::uint8_t, 4>> photo;
    std::size_t total = 0;  // how many the scene has

    void add(const Record& record, bool coloured) {
        cell.push_back(record.cell);
        aux.push_back(record.aux);
        if (coloured) photo.push_back(record.photo);
    }
    Record at(std::size_t n) const {
        return {cell[n], aux[n], photo.empty() ? Record{}.photo : photo[n]};
    }
};

// The surface of the solids: a record for each vertex, but that its aux has, after the normal,
// where a room sees the background from: x + 1 + 3 (y + 1) + 9 (z + 1) of a direction of -1, 0 and
// 1, 13 for things; and in bit 6 whether it was completed. index: of each triangle's corners how
// many vertices back it is, 0 for the next one that no triangle before had.
struct PackedSurface : Records {
    std::vector<std::array<std::uint16_t, 3>> index;
};

// Arrows of a field: position, direction times strength, density.
struct Arrows {
    std::vector<std::array<float, 7>> arrow;
    std::size_t total = 0;
};

struct PackedView {
    Rotation view_from_input;
    Vec3 origin_m{}, step_m{};
    double cube_m =
        0;  // edge of the cubes that are drawn; larger than a voxel where those are merged
    std::vector<std::pair<std::int32_t, std::int32_t>>
        groups;  // primitive and object of each group
    // Of each group a place well inside of its primitive's surface, as far as one is solid: a point
    // of the scan, in the input's frame. By it a correction tells which primitive it means.
    std::vector<std::optional<Vec3>> spots;
    bool coloured = false;  // the scan has colours
    Records voxels, points;
    PackedSurface surface;  // in place of voxels; empty where there is none, or too large a one
    std::map<std::string, Arrows> fields;
    PackedWalks walks;
};

// pack_view() in two steps, the first of which takes as long and needs no surfaces.
class ViewPacker {
  public:
    // with_surfaces: whether there will be some. The scene must outlive it.
    ViewPacker(const Scene& scene, const ViewLimits& limits, bool with_surfaces);
    ~ViewPacker();
    ViewPacker(const ViewPacker&) = delete;
    ViewPacker& operator=(const ViewPacker&) = delete;

    // Those of the view, before it is packed.
    const Records& points() const;
    // Once.
    PackedView pack(std::span<const ObjectSurface> surfaces, ThreadPool& pool);

  private:
    class Work;
    std::unique_ptr<Work> work_;
};

// Never fails; what is not finite is left out. surfaces: of the scene's solids; without them voxels
// are packed.
PackedView pack_view(const Scene& scene, const ViewLimits& limits = {},
                     std::span<const ObjectSurface> surfaces = {});

}  // namespace topple::report
