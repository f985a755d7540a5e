// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/ranked.h"
#include "vdb/completion.h"

// Where filled solids end below: at the surface on which they are seen to stand.
namespace topple::vdb {
namespace {

// What one primitive's cells look like from above.
struct Shape {
    std::array<std::int32_t, 2> low{}, high{};  // of its columns, inclusive
    std::array<std::int32_t, 2> last{};         // column
    std::vector<std::int32_t> bottoms;          // lowest k of each column
    std::vector<std::int32_t> seen;             // k of the cells that were seen
    bool empty() const { return bottoms.empty(); }
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

struct Stand {
    std::int32_t on = -1;     // primitive
    std::int32_t level = 0;   // k of its highest voxels
    std::int32_t bottom = 0;  // k down to which it reaches itself
};

class Settling {
  public:
    explicit Settling(const VolumeView& view)
        : view_(view), cells_(view.cells()), shapes_(view.primitives()) {
        for (std::size_t n = 0; n < cells_.size(); ++n) add_to_shape(n);
        for (std::size_t n = 0; n < cells_.size(); ++n) add_creases(n);
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
            Shape &own = shape(thing), &under = shape(on);
            if (levels.size() < std::max(least_crease, crease[thing] + 1)) continue;
            if (!under.surrounds(own)) continue;
            const std::int32_t level = upper_median(levels);
            const auto below =
                std::ranges::count_if(own.seen, [&](std::int32_t k) { return k < level - 1; });
            if (static_cast<double>(below) > most_seen_below * static_cast<double>(own.seen.size()))
                continue;
            crease[thing] = levels.size();
            found[thing] = {on, level, upper_median(under.bottoms)};
        }
        return found;
    }

    // Those that are known.
    void add(std::span<const Ledge> ledges, std::map<std::int32_t, Stand>& stands) {
        const auto shown = [&](std::int32_t p) {
            return p >= 0 && static_cast<std::size_t>(p) < shapes_.size() && !shape(p).empty();
        };
        for (const Ledge& l : ledges) {
            if (!shown(l.above) || !shown(l.below)) continue;
            // The highest voxel with its centre below the foot.
            const auto level =
                static_cast<std::int32_t>(std::ceil(l.height_m / view_.voxel_m() - 0.5)) - 1;
            stands[l.above] = {l.below, level, upper_median(shape(l.below).bottoms)};
        }
    }

    // Completed voxels below that level go to what is stood on, down to its own underside or to
    // what it stands on in turn, or to what is beside them: a leg under the table top. Others
    // become hidden again.
    std::vector<Claim> settle(const std::map<std::int32_t, Stand>& stands) {
        std::vector<Voxel> open;
        for (std::size_t n = 0; n < cells_.size(); ++n) {
            if (cells_.basis[n] == Basis::surface) continue;
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
            const Voxel voxel = place_of(cells_, n);
            owner_[voxel] = k >= last->bottom ? last->on : -1;
            if (k < last->bottom) open.push_back(voxel);
        }
        while (grow_into(open)) {
        }
        std::vector<Claim> claims;
        for (const auto& [voxel, p] : owner_) claims.push_back({voxel, p, Basis::stand, p >= 0});
        return claims;
    }

  private:
    static constexpr std::array<std::array<std::int32_t, 2>, 4> sides{
        {{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

    Shape& shape(std::int32_t p) { return shapes_[p]; }

    void add_to_shape(std::size_t n) {
        if (!view_.is_body(cells_.primitive[n])) return;
        Shape& s = shape(cells_.primitive[n]);
        const std::array<std::int32_t, 2> at{cells_.i[n], cells_.j[n]};
        if (cells_.basis[n] == Basis::surface) s.seen.push_back(cells_.k[n]);
        if (!s.empty() && s.last == at) return;
        for (std::size_t a = 0; a < 2; ++a) {
            s.low[a] = s.empty() ? at[a] : std::min(s.low[a], at[a]);
            s.high[a] = s.empty() ? at[a] : std::max(s.high[a], at[a]);
        }
        s.last = at;
        s.bottoms.push_back(cells_.k[n]);
    }

    // Where the top of one solid is seen right beside another's side.
    void add_creases(std::size_t n) {
        if (cells_.basis[n] != Basis::surface || !view_.is_body(cells_.primitive[n])) return;
        const Voxel above = moved(place_of(cells_, n), 2, 1);
        if (!view_.seen_empty(above)) return;
        for (const auto& side : sides) {
            const Voxel beside{above[0] + side[0], above[1] + side[1], above[2]};
            if (!view_.solid(beside)) continue;
            const std::int32_t thing = view_.primitive(beside);
            if (view_.is_body(thing) && thing != cells_.primitive[n])
                creases_[{thing, cells_.primitive[n]}].push_back(cells_.k[n]);
        }
    }

    // Whose body a voxel is now; -1: none's.
    std::int32_t body_at(const Voxel& voxel) const {
        const auto changed = owner_.find(voxel);
        const std::int32_t p = changed != owner_.end() ? changed->second
                               : view_.solid(voxel)    ? view_.primitive(voxel)
                                                       : -1;
        return view_.is_body(p) ? p : -1;
    }

    // One layer sideways from the solids around; returns whether any voxel was taken.
    bool grow_into(std::vector<Voxel>& open) {
        std::vector<std::pair<Voxel, std::int32_t>> taken;
        std::vector<Voxel> left;
        for (const Voxel& voxel : open) {
            std::int32_t by = -1;
            for (const auto& side : sides)
                by = std::max(by, body_at({voxel[0] + side[0], voxel[1] + side[1], voxel[2]}));
            if (by >= 0)
                taken.emplace_back(voxel, by);
            else
                left.push_back(voxel);
        }
        for (const auto& [voxel, by] : taken) owner_[voxel] = by;
        open = std::move(left);
        return !taken.empty();
    }

    const VolumeView& view_;
    const SolidCells& cells_;
    std::vector<Shape> shapes_;  // by primitive; none of walls and ceilings
    // By (thing, what it stands on): k of the creases.
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> creases_;
    std::map<Voxel, std::int32_t> owner_;  // of the voxels that change hands; -1: none
};

}  // namespace

std::vector<Claim> support_claims(const VolumeView& view, std::span<const Ledge> ledges) {
    Settling settling(view);
    std::map<std::int32_t, Stand> stands = settling.stands();
    settling.add(ledges, stands);
    return settling.settle(stands);
}

}  // namespace topple::vdb
