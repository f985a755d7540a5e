// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "vdb/grids.h"

// Where filled solids end below: at the surface on which they are seen to stand.
namespace topple::vdb {
namespace {

// What one primitive's cells look like from above.
struct Shape {
    std::array<std::int32_t, 2> low{}, high{};  // of its columns, inclusive
    std::vector<std::int32_t> bottoms;          // lowest k of each column
    std::vector<std::int32_t> seen;             // k of the cells that were seen
    // Whether the other lies within, and this one goes on beyond it on three sides at least: so
    // does a table top around a box, but not a sofa's seat around its arm.
    bool surrounds(const Shape& other) const {
        constexpr std::int32_t beyond = 2;
        int sides = 0;
        for (std::size_t a = 0; a < 2; ++a) {
            if (other.low[a] < low[a] || other.high[a] > high[a]) return false;
            sides += (other.low[a] >= low[a] + beyond) + (other.high[a] + beyond <= high[a]);
        }
        return sides >= 3;
    }
};

std::int32_t median(std::vector<std::int32_t>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Stand {
    std::int32_t on = -1;     // primitive
    std::int32_t level = 0;   // k of its highest voxels
    std::int32_t bottom = 0;  // k down to which it reaches itself
};

class Settling {
  public:
    Settling(const SolidCellArrays& cells, VoxelScene::Grids& grids,
             const std::vector<bool>& hollow)
        : cells_(cells),
          hollow_(hollow),
          state_(grids.state->getAccessor()),
          primitive_(grids.primitive->getAccessor()) {
        for (std::size_t n = 0; n < cells.size(); ++n) add_to_shape(n);
        for (std::size_t n = 0; n < cells.size(); ++n) add_creases(n);
    }

    // Primitives that are seen to stand on another one.
    std::map<std::int32_t, Stand> stands() {
        // A crease of fewer voxels is noise.
        constexpr std::size_t least_crease = 6;
        // Who shows more of itself below than noise would does not end there.
        constexpr double most_seen_below = 0.05;
        std::map<std::int32_t, Stand> found;
        std::map<std::int32_t, std::size_t> crease;
        for (auto& [pair, levels] : creases_) {
            const auto& [thing, on] = pair;
            Shape &own = shapes_[thing], &under = shapes_[on];
            if (levels.size() < std::max(least_crease, crease[thing] + 1)) continue;
            if (!under.surrounds(own)) continue;
            const std::int32_t level = median(levels);
            const auto below =
                std::ranges::count_if(own.seen, [&](std::int32_t k) { return k < level - 1; });
            if (static_cast<double>(below) > most_seen_below * static_cast<double>(own.seen.size()))
                continue;
            crease[thing] = levels.size();
            found[thing] = {on, level, median(under.bottoms)};
        }
        return found;
    }

    // Those that are known.
    void add(std::span<const VoxelScene::StandsOn> known, double voxel_m,
             std::map<std::int32_t, Stand>& stands) {
        for (const VoxelScene::StandsOn& s : known) {
            if (!shapes_.contains(s.above) || !shapes_.contains(s.below)) continue;
            // The highest voxel with its centre below the foot.
            const auto level = static_cast<std::int32_t>(std::ceil(s.height_m / voxel_m - 0.5)) - 1;
            stands[s.above] = {s.below, level, median(shapes_[s.below].bottoms)};
        }
    }

    // Completed voxels below that level go to what is stood on, down to its own underside or to
    // what it stands on in turn, or to what is beside them: a leg under the table top. Others
    // become hidden again.
    std::uint64_t settle(const std::map<std::int32_t, Stand>& stands) {
        std::vector<openvdb::Coord> open;
        std::uint64_t changed = 0;
        for (std::size_t n = 0; n < cells_.size(); ++n) {
            if (cells_.state[n] != State::completed) continue;
            const std::int32_t k = cells_.k[n];
            const Stand* last = nullptr;
            // No chain is longer than there are stands; one that closes on itself ends, too.
            std::size_t most = stands.size();
            for (auto at = stands.find(cells_.primitive[n]);
                 most > 0 && at != stands.end() && k <= at->second.level; --most) {
                last = &at->second;
                at = stands.find(last->on);
            }
            if (!last) continue;
            const openvdb::Coord voxel(cells_.i[n], cells_.j[n], k);
            ++changed;
            if (k >= last->bottom) {
                primitive_.setValueOn(voxel, last->on);
            } else {
                state_.setValueOff(voxel, static_cast<std::int32_t>(State::invisible));
                primitive_.setValueOff(voxel, -1);
                open.push_back(voxel);
            }
        }
        while (grow_into(open)) {
        }
        return changed;
    }

  private:
    static constexpr std::array<std::array<std::int32_t, 2>, 4> sides{
        {{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

    bool plain(std::int32_t p) const {
        return p >= 0 && !(static_cast<std::size_t>(p) < hollow_.size() &&
                           hollow_[static_cast<std::size_t>(p)]);
    }
    bool solid(const openvdb::Coord& voxel) const { return state_.isValueOn(voxel); }

    void add_to_shape(std::size_t n) {
        if (!plain(cells_.primitive[n])) return;
        Shape& s = shapes_[cells_.primitive[n]];
        const std::array<std::int32_t, 2> at{cells_.i[n], cells_.j[n]};
        if (cells_.state[n] == State::surface) s.seen.push_back(cells_.k[n]);
        for (std::size_t a = 0; a < 2; ++a) {
            s.low[a] = s.bottoms.empty() ? at[a] : std::min(s.low[a], at[a]);
            s.high[a] = s.bottoms.empty() ? at[a] : std::max(s.high[a], at[a]);
        }
        const std::array<std::int32_t, 3> place{cells_.primitive[n], at[0], at[1]};
        if (last_column_[cells_.primitive[n]] == place) return;
        last_column_[cells_.primitive[n]] = place;
        s.bottoms.push_back(cells_.k[n]);
    }

    // Where the top of one solid is seen right beside another's side.
    void add_creases(std::size_t n) {
        if (cells_.state[n] != State::surface || !plain(cells_.primitive[n])) return;
        const openvdb::Coord above(cells_.i[n], cells_.j[n], cells_.k[n] + 1);
        if (solid(above) || state_.getValue(above) != static_cast<std::int32_t>(State::empty))
            return;
        for (const auto& side : sides) {
            const openvdb::Coord beside = above.offsetBy(side[0], side[1], 0);
            if (!solid(beside)) continue;
            const std::int32_t thing = primitive_.getValue(beside);
            if (plain(thing) && thing != cells_.primitive[n])
                creases_[{thing, cells_.primitive[n]}].push_back(cells_.k[n]);
        }
    }

    // One layer sideways from the solids around; returns whether any voxel was taken.
    bool grow_into(std::vector<openvdb::Coord>& open) {
        std::vector<std::pair<openvdb::Coord, std::int32_t>> taken;
        std::vector<openvdb::Coord> left;
        for (const openvdb::Coord& voxel : open) {
            std::int32_t by = -1;
            for (const auto& side : sides) {
                const openvdb::Coord beside = voxel.offsetBy(side[0], side[1], 0);
                const std::int32_t p = solid(beside) ? primitive_.getValue(beside) : -1;
                if (plain(p)) by = std::max(by, p);
            }
            if (by >= 0)
                taken.emplace_back(voxel, by);
            else
                left.push_back(voxel);
        }
        for (const auto& [voxel, by] : taken) {
            state_.setValueOn(voxel, static_cast<std::int32_t>(State::completed));
            primitive_.setValueOn(voxel, by);
        }
        open = std::move(left);
        return !taken.empty();
    }

    const SolidCellArrays& cells_;
    const std::vector<bool>& hollow_;
    openvdb::Int32Grid::Accessor state_;
    openvdb::Int32Grid::Accessor primitive_;
    std::map<std::int32_t, Shape> shapes_;
    std::map<std::int32_t, std::array<std::int32_t, 3>> last_column_;
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> creases_;
};

}  // namespace

std::uint64_t VoxelScene::settle(const std::vector<bool>& hollow, std::span<const StandsOn> on) {
    const SolidCellArrays cells = solid_cells();
    Settling settling(cells, *grids_, hollow);
    std::map<std::int32_t, Stand> stands = settling.stands();
    settling.add(on, frame().voxel_m, stands);
    return settling.settle(stands);
}

}  // namespace topple::vdb
