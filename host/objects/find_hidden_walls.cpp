// SPDX-License-Identifier: MIT
#include "objects/find_hidden_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/ranked.h"
#include "core/table.h"

namespace topple {
namespace {

using geometry::SurfaceSamples;

constexpr double column_m = 0.05;  // of a wall, along it
// Cosine of the angle (5 degrees) below which two directions are one, and how far off one another
// parts of one wall lie: what plaster, skirting and drift do.
constexpr double alike_cos = 0.996, coplanar_m = 0.06;
constexpr double upright = 0.3;           // largest z of an upright surface's normal
constexpr std::size_t least_samples = 8;  // of a seen part: a patch of some 10 cm by 5
// What stands no farther from a wall than this hides it from all but a slanted look, and what it
// reaches beyond the wall's plane is noise.
constexpr double most_apart_m = 0.6, most_beyond_m = 0.05;
// Cosine of a normal to a wall's for a surface that faces it, or away from it; and the largest
// share of those that face it where nobody saw between the two.
constexpr double facing_cos = 0.7, most_facing = 0.1;
constexpr double widest_joint_m = 0.3;  // between things in a row, or such a thing and a seen part

struct Line {
    std::int32_t primitive = -1;
    std::size_t samples = 0;
    std::array<double, 2> normal{}, middle{};
};

double dot2(const std::array<double, 2>& a, double x, double y) {
    return a[0] * x + a[1] * y;
}

// The samples of each primitive: [first, last).
std::vector<std::pair<std::size_t, std::size_t>> ranges_of(const SurfaceSamples& s,
                                                           std::size_t primitives) {
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t p = 0; p < primitives; ++p) {
        const auto [first, last] =
            std::equal_range(s.primitive.begin(), s.primitive.end(), static_cast<std::int32_t>(p));
        out.emplace_back(first - s.primitive.begin(), last - s.primitive.begin());
    }
    return out;
}

// Seen parts of walls, the largest first.
std::vector<Line> wall_lines(const SolidParts& parts,
                             std::span<const std::pair<std::size_t, std::size_t>> range,
                             const std::vector<bool>& fixed) {
    const SurfaceSamples& s = parts.samples;
    std::vector<Line> out;
    for (std::size_t p = 0; p < range.size(); ++p) {
        const auto primitive = static_cast<std::int32_t>(p);
        if (!fixed[p] || parts.solids->role(primitive) != Role::wall) continue;
        Line line{primitive, 0, {}, {}};
        for (std::size_t n = range[p].first; n < range[p].second; ++n) {
            if (std::abs(s.nz[n]) > upright) continue;
            // Seen from both sides, it still has one direction.
            const double sign = dot2(line.normal, s.nx[n], s.ny[n]) < 0 ? -1 : 1;
            line.normal[0] += sign * s.nx[n];
            line.normal[1] += sign * s.ny[n];
            line.middle[0] += s.x[n];
            line.middle[1] += s.y[n];
            ++line.samples;
        }
        const double length = std::hypot(line.normal[0], line.normal[1]);
        // Of a wall that turns a corner little of the sum is left.
        if (line.samples < least_samples || length < 0.9 * static_cast<double>(line.samples))
            continue;
        for (std::size_t a = 0; a < 2; ++a) {
            line.normal[a] /= length;
            line.middle[a] /= static_cast<double>(line.samples);
        }
        // Along the grid, but for what is askew.
        for (std::size_t a = 0; a < 2; ++a)
            if (std::abs(line.normal[a]) > alike_cos) {
                line.normal[a] = 1;
                line.normal[1 - a] = 0;
            }
        out.push_back(line);
    }
    std::ranges::stable_sort(out, std::greater{}, &Line::samples);
    return out;
}

// The parts of one wall together.
std::vector<std::vector<Line>> walls_of(const std::vector<Line>& lines) {
    std::vector<std::vector<Line>> out;
    for (const Line& line : lines) {
        const auto fits = [&](const std::vector<Line>& wall) {
            const Line& first = wall.front();
            const double off = dot2(first.normal, line.middle[0] - first.middle[0],
                                    line.middle[1] - first.middle[1]);
            return std::abs(dot2(first.normal, line.normal[0], line.normal[1])) > alike_cos &&
                   std::abs(off) < coplanar_m;
        };
        const auto wall = std::ranges::find_if(out, fits);
        if (wall != out.end())
            wall->push_back(line);
        else
            out.push_back({line});
    }
    return out;
}

// What stands before a wall: where along it, and how high it reaches.
struct Cover {
    double from_m = 0, to_m = 0, bottom_m = 0, top_m = 0;
};

class Wall {
  public:
    Wall(const SurfaceSamples& samples, std::span<const std::pair<std::size_t, std::size_t>> range,
         const std::vector<Line>& parts)
        : s_(samples),
          range_(range),
          normal_(parts.front().normal),
          along_{-normal_[1], normal_[0]} {
        double sum = 0, all = 0;
        for (const Line& part : parts) {
            sum +=
                static_cast<double>(part.samples) * dot2(normal_, part.middle[0], part.middle[1]);
            all += static_cast<double>(part.samples);
            for_each(part.primitive, [&](std::size_t n) {
                seen_.push_back(dot2(along_, s_.x[n], s_.y[n]));
                top_m_ = std::max(top_m_, double{s_.z[n]});
            });
        }
        offset_m_ = sum / all;
        std::ranges::sort(seen_);
    }

    // Nothing where the object does not hide the wall.
    std::optional<Cover> cover(std::span<const std::int32_t> object) const {
        std::vector<double> away;  // signed distances
        Cover out{infinity, -infinity, infinity, -infinity};
        for (const std::int32_t p : object)
            for_each(p, [&](std::size_t n) {
                const double t = dot2(along_, s_.x[n], s_.y[n]);
                away.push_back(dot2(normal_, s_.x[n], s_.y[n]) - offset_m_);
                out.from_m = std::min(out.from_m, t);
                out.to_m = std::max(out.to_m, t);
                out.bottom_m = std::min(out.bottom_m, double{s_.z[n]});
                out.top_m = std::max(out.top_m, double{s_.z[n]});
            });
        if (away.size() < least_samples) return std::nullopt;
        const double side = upper_median(away) < 0 ? -1 : 1;
        double nearest = infinity;
        for (const double d : away) nearest = std::min(nearest, side * d);
        if (nearest < -most_beyond_m || nearest > most_apart_m) return std::nullopt;
        std::size_t facing = 0, turned = 0;
        for (const std::int32_t p : object)
            for_each(p, [&](std::size_t n) {
                const double c = side * dot2(normal_, s_.nx[n], s_.ny[n]);
                facing += c < -facing_cos;
                turned += c > facing_cos;
            });
        if (turned == 0 || static_cast<double>(facing) > most_facing * static_cast<double>(turned))
            return std::nullopt;
        return out;
    }

    // The rows of covers that begin or end at a seen part, or go past one.
    std::optional<physics::HiddenWall> behind(std::vector<Cover> covers,
                                              std::int32_t primitive) const {
        std::ranges::sort(covers, {}, &Cover::from_m);
        std::vector<Cover> kept;
        for (std::size_t first = 0, last = 0; first < covers.size(); first = last) {
            double to = covers[first].to_m;
            for (last = first; last < covers.size() && covers[last].from_m <= to + widest_joint_m;
                 ++last)
                to = std::max(to, covers[last].to_m);
            const auto beside =
                std::ranges::lower_bound(seen_, covers[first].from_m - widest_joint_m);
            if (beside == seen_.end() || *beside > to + widest_joint_m) continue;
            kept.insert(kept.end(), covers.begin() + static_cast<std::ptrdiff_t>(first),
                        covers.begin() + static_cast<std::ptrdiff_t>(last));
        }
        if (kept.empty()) return std::nullopt;
        physics::HiddenWall out{primitive, normal_,  along_,   offset_m_,
                                infinity,  column_m, infinity, {}};
        double to = -infinity;
        for (const Cover& c : kept) {
            out.from_m = std::min(out.from_m, c.from_m);
            out.bottom_m = std::min(out.bottom_m, c.bottom_m);
            to = std::max(to, c.to_m);
        }
        out.top_m.assign(static_cast<std::size_t>((to - out.from_m) / column_m) + 1,
                         -std::numeric_limits<float>::infinity());
        for (const Cover& c : kept) {
            const auto first = static_cast<std::size_t>((c.from_m - out.from_m) / column_m),
                       last = static_cast<std::size_t>((c.to_m - out.from_m) / column_m);
            for (std::size_t n = first; n <= last; ++n)
                out.top_m[n] =
                    std::max(out.top_m[n], static_cast<float>(std::max(c.top_m, top_m_)));
        }
        return out;
    }

  private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    template <class Use>
    void for_each(std::int32_t primitive, const Use& use) const {
        const auto [first, last] = range_[primitive];
        for (std::size_t n = first; n < last; ++n) use(n);
    }

    const SurfaceSamples& s_;
    TableView<PrimitiveId, std::pair<std::size_t, std::size_t>> range_;
    std::array<double, 2> normal_, along_;
    double offset_m_ = 0, top_m_ = -infinity;
    std::vector<double> seen_;  // places along it of what was seen of it
};

}  // namespace

physics::HiddenWalls find_hidden_walls(const SolidParts& parts,
                                       std::span<const std::int32_t> object_of_primitive,
                                       const std::vector<bool>& fixed) {
    const auto range = ranges_of(parts.samples, object_of_primitive.size());
    std::map<std::int32_t, std::vector<std::int32_t>> objects;  // those that can move
    for (std::size_t p = 0; p < object_of_primitive.size(); ++p)
        if (object_of_primitive[p] >= 0 && !fixed[p])
            objects[object_of_primitive[p]].push_back(static_cast<std::int32_t>(p));
    std::vector<physics::HiddenWall> out;
    for (const std::vector<Line>& lines : walls_of(wall_lines(parts, range, fixed))) {
        const Wall wall(parts.samples, range, lines);
        std::vector<Cover> covers;
        for (const auto& [o, primitives] : objects)
            if (const auto cover = wall.cover(primitives)) covers.push_back(*cover);
        if (auto hidden = wall.behind(std::move(covers), lines.front().primitive))
            out.push_back(std::move(*hidden));
    }
    return physics::HiddenWalls(std::move(out));
}

}  // namespace topple
