// SPDX-License-Identifier: MIT
#include "vdb/read_volume.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <string>

#include "core/room_measures.h"
#include "io/open_file.h"
#include "topple/error.h"
#include "vdb/volume_checks.h"

namespace topple::vdb {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

constexpr std::uint64_t most_voxels = std::uint64_t{1} << 28;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
    throw Error(ErrorKind::input, file.string() + ": " + message);
}

// Whether values lie on both sides of 0.
bool is_signed(const openvdb::FloatGrid& grid) {
    bool below = false, above = false;
    for (auto value = grid.cbeginValueOn(); value && !(below && above); ++value) {
        below = below || *value < 0;
        above = above || *value > 0;
    }
    return below && above;
}

// The grids of a file that may show a surface.
struct Candidates {
    openvdb::FloatGrid::Ptr distances, fog;
    openvdb::Int32Grid::Ptr labels;
};

void check_size(const std::filesystem::path& file, const openvdb::GridBase& grid) {
    if (grid.activeVoxelCount() > most_voxels) {
        fail(file, "grid \"" + grid.getName() + "\" has " +
                       std::to_string(grid.activeVoxelCount()) +
                       " active voxels, more than the limit of " + std::to_string(most_voxels));
    }
}

// What use(file) does with a file that was checked as far as OpenVDB takes it on trust.
template <class Use>
void with_file(const std::filesystem::path& path, const Use& use) {
    {
        const io::MappedFile bytes(path);
        io::check_volume(path, bytes.text());
    }
    try {
        openvdb::io::File file(path.string());
        file.open(false);
        use(file);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail(path, std::string("can't be read as OpenVDB: ") + error.what());
    }
}

Candidates read_grids(const std::filesystem::path& path) {
    Candidates found;
    with_file(path, [&](openvdb::io::File& file) {
        for (auto name = file.beginName(); name != file.endName(); ++name) {
            const openvdb::GridBase::Ptr about = file.readGridMetadata(name.gridName());
            const bool number = about->isType<openvdb::FloatGrid>();
            if (!number && !(about->isType<openvdb::Int32Grid>() && !found.labels)) continue;
            const openvdb::GridBase::Ptr grid = file.readGrid(name.gridName());
            check_size(path, *grid);
            if (!number) {
                found.labels = openvdb::gridPtrCast<openvdb::Int32Grid>(grid);
                continue;
            }
            const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
            if (is_signed(*floats)) {
                found.distances = floats;
                break;
            }
            if (!found.fog) found.fog = floats;
        }
    });
    return found;
}

// The surface of one grid, as points.
class Extraction {
  public:
    Extraction(const std::filesystem::path& file, const openvdb::GridBase& grid, double unit_m)
        : file_(file), transform_(grid.transform()), unit_m_(unit_m) {
        if (!transform_.isLinear())
            fail(file, "grid \"" + grid.getName() + "\" has a transform that is not linear");
        const Vec3d size = transform_.voxelSize();
        if (!(size.length() > 0) || !std::isfinite(size.length()))
            fail(file, "grid \"" + grid.getName() + "\" has voxels without a size");
        map_.cloud.source = file.string();
        const Vec3d corner = transform_.indexToWorld(Vec3d(0, 0, 0));
        aligned_ = true;
        for (int a = 0; a < 3; ++a) {
            Vec3d one(0, 0, 0);
            one[a] = 1;
            const Vec3d along = transform_.indexToWorld(one) - corner;
            for (int d = 0; d < 3; ++d)
                aligned_ = aligned_ && std::abs(along[d] - (a == d ? size[0] : 0)) < 1e-6 * size[0];
            map_.space.corner_m[a] = corner[a] * unit_m;
        }
        map_.space.voxel_m = size[0] * unit_m;
    }

    // Where the values of neighbours pass `threshold`; `solid_above`: solid is what lies above it.
    void surface(const openvdb::FloatGrid& grid, float threshold, bool solid_above) {
        const auto at = grid.getConstAccessor();
        const auto value = [&](const Coord& c) {
            return solid_above ? threshold - at.getValue(c) : at.getValue(c) - threshold;
        };
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
                const Coord c = voxel.getCoord();
                const float here = value(c);
                for (int step = 0; step < 6; ++step) {
                    Coord next = c;
                    next[step / 2] += step % 2 ? -1 : 1;
                    // Distances are known where voxels are active; fog is 0 elsewhere.
                    const bool active = at.isValueOn(next);
                    if (active ? step % 2 : !solid_above) continue;
                    const float there = value(next);
                    if (!std::isfinite(here) || !std::isfinite(there) || (here < 0) == (there < 0))
                        continue;
                    const double share = double(here) / (double(here) - there);
                    const Vec3d p = c.asVec3d() + share * (next.asVec3d() - c.asVec3d());
                    Vec3d outwards;
                    const Coord& nearer = share < 0.5 ? c : next;
                    for (int a = 0; a < 3; ++a) {
                        Coord low = nearer, high = nearer;
                        --low[a];
                        ++high[a];
                        outwards[a] = double(value(high)) - value(low);
                    }
                    add(p, outwards);
                }
            }
        }
    }

    void surface(const openvdb::Int32Grid& grid) {
        const auto at = grid.getConstAccessor();
        const auto solid = [&](const Coord& c) { return at.isValueOn(c) && at.getValue(c) > 0; };
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
                const Coord c = voxel.getCoord();
                if (!solid(c)) continue;
                Vec3d outwards(0, 0, 0);
                bool at_surface = false;
                for (int step = 0; step < 6; ++step) {
                    Coord next = c;
                    next[step / 2] += step % 2 ? -1 : 1;
                    if (solid(next)) continue;
                    at_surface = true;
                    outwards[step / 2] += step % 2 ? -1 : 1;
                }
                if (at_surface) add(c.asVec3d(), outwards);
            }
        }
    }

    // Cubes between eight neighbours that are active and all free: they need no rounding where the
    // grid's corners are the world's.
    template <class Grid, class Free>
    void free_space(const Grid& grid, Free is_free) {
        if (!aligned_) {
            map_.cloud.notes.push_back(
                "The grid's voxels are no cubes along the axes: what it says to be free was left "
                "out.");
            return;
        }
        const auto at = grid.getConstAccessor();
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
            for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
                const Coord c = voxel.getCoord();
                bool free = true;
                for (int corner = 0; corner < 8 && free; ++corner) {
                    const Coord n = c.offsetBy(corner & 1, corner >> 1 & 1, corner >> 2);
                    free = at.isValueOn(n) && is_free(at.getValue(n));
                }
                if (!free) continue;
                auto& boxes = map_.space.free;
                const std::array<std::int32_t, 3> low{c[0], c[1], c[2]};
                if (!boxes.empty() && boxes.back().low[0] == c[0] && boxes.back().low[1] == c[1] &&
                    boxes.back().high[2] == c[2] - 1) {
                    boxes.back().high[2] = c[2];
                } else {
                    boxes.push_back({low, low});
                }
            }
        }
    }

    ScannedMap finish() {
        if (map_.cloud.x.empty())
            fail(file_, "shows no surface: no value of its grids changes sides");
        return std::move(map_);
    }

  private:
    void add(const Vec3d& index, const Vec3d& outwards) {
        const Vec3d p = transform_.indexToWorld(index) * unit_m_;
        // Normals go through the inverse transposed.
        const Vec3d turned = transform_.baseMap()->applyIJT(outwards);
        for (int a = 0; a < 3; ++a) {
            if (!(std::abs(p[a]) <= farthest_m)) {
                fail(file_, "has a coordinate of " + std::to_string(p[a]) +
                                ", beyond the limit of 1e+06 m; convert the units, or move it");
            }
        }
        const double length = turned.length();
        const bool usable = std::isfinite(length) && length > 0;
        const auto put = [&](std::vector<float>& to, double v) {
            to.push_back(static_cast<float>(v));
        };
        PointCloud& cloud = map_.cloud;
        put(cloud.x, p[0]);
        put(cloud.y, p[1]);
        put(cloud.z, p[2]);
        put(cloud.nx, usable ? turned[0] / length : 0);
        put(cloud.ny, usable ? turned[1] / length : 0);
        put(cloud.nz, usable ? turned[2] / length : 0);
    }

    const std::filesystem::path& file_;
    const openvdb::math::Transform& transform_;
    double unit_m_;
    bool aligned_ = false;
    ScannedMap map_;
};

}  // namespace

bool looks_like_volume(const std::filesystem::path& path) {
    return path.extension() == ".vdb";
}

ScannedMap read_volume(const std::filesystem::path& file, double unit_m) {
    openvdb::initialize();
    const Candidates found = read_grids(file);
    if (found.distances) {
        found.distances->tree().voxelizeActiveTiles(false);
        Extraction extraction(file, *found.distances, unit_m);
        extraction.surface(*found.distances, 0, false);
        extraction.free_space(*found.distances, [](float v) { return v > 0; });
        return extraction.finish();
    }
    if (found.labels) {
        found.labels->tree().voxelizeActiveTiles(false);
        Extraction extraction(file, *found.labels, unit_m);
        extraction.surface(*found.labels);
        extraction.free_space(*found.labels, [](std::int32_t v) { return v == 0; });
        return extraction.finish();
    }
    if (found.fog) {
        found.fog->tree().voxelizeActiveTiles(false);
        Extraction extraction(file, *found.fog, unit_m);
        extraction.surface(*found.fog, fog_threshold, true);
        return extraction.finish();
    }
    fail(file, "has no grid of floats (distances or density) or of 32-bit integers (labels)");
}

ScannedMap read_states(const std::filesystem::path& file, double unit_m) {
    openvdb::initialize();
    const char* const name = "state";
    openvdb::Int32Grid::Ptr states;
    with_file(file, [&](openvdb::io::File& from) {
        if (!from.hasGrid(name) || !from.readGridMetadata(name)->isType<openvdb::Int32Grid>())
            return;
        states = openvdb::gridPtrCast<openvdb::Int32Grid>(from.readGrid(name));
        check_size(file, *states);
    });
    const auto size = states ? states->getMetadata<openvdb::DoubleMetadata>("voxel_size_m")
                             : openvdb::DoubleMetadata::Ptr();
    if (!size || !(size->value() > 0) || !states->transform().isLinear())
        fail(file, "is no volume of topple: it has no grid \"state\" with voxel_size_m");
    ScannedMap out;
    out.cloud.source = file.string();
    out.space.voxel_m = size->value() * unit_m;
    constexpr std::int32_t empty = 0;
    const auto add_free = [&](const openvdb::CoordBBox& box) {
        if (out.space.free.size() >= most_voxels) fail(file, "has too many voxels");
        out.space.free.push_back({{box.min()[0], box.min()[1], box.min()[2]},
                                  {box.max()[0], box.max()[1], box.max()[2]}});
    };
    // What is stored as one value; then voxels, in runs along z.
    for (auto value = states->tree().cbeginValueAll(); value; ++value) {
        if (value.isVoxelValue() || *value != empty) continue;
        add_free(value.getBoundingBox());
    }
    for (auto leaf = states->tree().cbeginLeaf(); leaf; ++leaf) {
        constexpr openvdb::Index32 row = 8, all = 512;
        for (openvdb::Index32 first = 0; first < all; first += row) {
            for (openvdb::Index32 n = first, next; n < first + row; n = next) {
                next = n + 1;
                if (leaf->getValue(n) != empty) continue;
                while (next < first + row && leaf->getValue(next) == empty) ++next;
                const Coord low = leaf->offsetToGlobalCoord(n);
                add_free({low, low.offsetBy(0, 0, static_cast<int>(next - n) - 1)});
            }
        }
        for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
            const Vec3d at = states->transform().indexToWorld(voxel.getCoord()) * unit_m;
            out.cloud.x.push_back(static_cast<float>(at[0]));
            out.cloud.y.push_back(static_cast<float>(at[1]));
            out.cloud.z.push_back(static_cast<float>(at[2]));
        }
    }
    if (out.cloud.x.empty()) fail(file, "has no solid voxel");
    return out;
}

}  // namespace topple::vdb
