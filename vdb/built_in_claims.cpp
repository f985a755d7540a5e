// SPDX-License-Identifier: MIT
#include <array>
#include <optional>
#include <vector>

#include "core/ranked.h"
#include "core/sort_unique.h"
#include "vdb/completion.h"

// Fronts of what is built in: a wall cabinet that was seen from before alone has neither sides nor
// a back, but the wall.
namespace topple::vdb {
namespace {

constexpr double deepest_m = 0.7;      // of built-in furniture
constexpr double flat_m = 0.08;        // thickness of a sheet's voxels, beside one voxel
constexpr std::size_t outermost = 20;  // of a sheet's voxels one in so many at either end is noise
// Share of a front's columns behind which nobody saw anything, down to the wall.
constexpr double hidden_share = 0.6;

// A sheet's voxels, and their bounds without the outermost.
struct Sheet {
    std::vector<std::size_t> cells;
    Voxel low{}, high{};
    std::int32_t thick(std::size_t axis) const { return high[axis] - low[axis] + 1; }
};

void find_bounds(const SolidCells& cells, Sheet& sheet) {
    const std::array<const std::vector<std::int32_t>*, 3> place{&cells.i, &cells.j, &cells.k};
    std::vector<std::int32_t> values;
    for (std::size_t a = 0; a < 3; ++a) {
        values.clear();
        for (const std::size_t n : sheet.cells) values.push_back((*place[a])[n]);
        const std::size_t out = values.size() / outermost;
        sheet.low[a] = ranked(values, out);
        sheet.high[a] = ranked(values, values.size() - 1 - out);
    }
}

std::vector<Sheet> sheets_of(const VolumeView& view) {
    const SolidCells& cells = view.cells();
    std::vector<Sheet> out(view.primitives());
    for (std::size_t n = 0; n < cells.size(); ++n) {
        const std::int32_t p = cells.primitive[n];
        if (p >= 0 && view.is_upright_sheet(p)) out[p].cells.push_back(n);
    }
    for (Sheet& sheet : out)
        if (!sheet.cells.empty()) find_bounds(cells, sheet);
    return out;
}

// A sheet that may be a front, and how far behind each nobody saw, up to the wall.
class Front {
  public:
    Front(const VolumeView& view, const Sheet& sheet, std::size_t axis, int way)
        : view_(view), sheet_(sheet), axis_(axis), way_(way) {}

    // Where the first sheet behind it begins that goes on to both sides of it, and no less high.
    std::optional<std::int32_t> wall(const std::vector<Sheet>& sheets, std::int32_t flat,
                                     std::int32_t deepest) const {
        const std::size_t across = 1 - axis_;
        std::optional<std::int32_t> out;
        for (const Sheet& w : sheets) {
            if (&w == &sheet_ || w.cells.empty() || w.thick(axis_) > flat) continue;
            const std::int32_t begin = way_ > 0 ? w.low[axis_] : w.high[axis_];
            const std::int32_t away = way_ * (begin - (way_ > 0 ? sheet_.high : sheet_.low)[axis_]);
            if (away < 2 || away > deepest || w.low[across] > sheet_.low[across] ||
                w.high[across] < sheet_.high[across] || w.high[2] < sheet_.high[2])
                continue;
            if (!out || way_ * (begin - *out) < 0) out = begin;
        }
        return out;
    }

    void fill(std::int32_t primitive, std::int32_t wall, std::vector<Claim>& claims) const {
        const std::size_t before = claims.size();
        std::size_t columns = 0, hidden = 0;
        for (const std::size_t n : sheet_.cells) {
            Voxel at = place_of(view_.cells(), n);
            at[axis_] += way_;
            // The backmost voxel of its column, of the front itself.
            if (at[axis_] < sheet_.low[axis_] - 1 || at[axis_] > sheet_.high[axis_] + 1 ||
                (view_.solid(at) && view_.primitive(at) == primitive))
                continue;
            ++columns;
            const std::int32_t depth = way_ * (wall - at[axis_]);
            const std::int32_t run = view_.unseen_run(at, static_cast<int>(axis_), way_, depth);
            Voxel end = at;
            end[axis_] += way_ * run;
            if (run < depth && !view_.solid(end)) continue;  // seen to be empty
            ++hidden;
            for (std::int32_t step = 0; step < run; ++step, at[axis_] += way_)
                claims.push_back({at, primitive, Basis::gap});
        }
        if (static_cast<double>(hidden) < hidden_share * static_cast<double>(columns))
            claims.resize(before);
    }

  private:
    const VolumeView& view_;
    const Sheet& sheet_;
    std::size_t axis_;
    int way_;
};

}  // namespace

std::vector<Claim> built_in_claims(const VolumeView& view) {
    const auto flat = static_cast<std::int32_t>(flat_m / view.voxel_m()) + 1,
               deepest = static_cast<std::int32_t>(deepest_m / view.voxel_m());
    const std::vector<Sheet> sheets = sheets_of(view);
    std::vector<Claim> claims;
    for (std::size_t p = 0; p < sheets.size(); ++p) {
        if (sheets[p].cells.empty()) continue;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (sheets[p].thick(axis) > flat) continue;
            for (const int way : {-1, 1}) {
                const Front front(view, sheets[p], axis, way);
                if (const auto wall = front.wall(sheets, flat, deepest))
                    front.fill(static_cast<std::int32_t>(p), *wall, claims);
            }
        }
    }
    // Of two fronts the one with the lower number.
    sort_unique(claims, &Claim::at);
    return claims;
}

}  // namespace topple::vdb
