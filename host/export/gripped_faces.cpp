// SPDX-License-Identifier: MIT
#include "export/gripped_faces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "core/field_rules.h"
#include "core/ranked.h"
#include "core/rotation.h"
#include "core/vectors.h"

namespace topple::exports {
namespace {

constexpr double cell_m = 0.01;      // of maps of faces
constexpr double on_face_m = 0.011;  // so far do points of a face lie from it,
constexpr double off_face_m = 0.014;
constexpr double before_face_m = 0.02;  // and so far at least those of a grip before it,
constexpr double most_grip_m = 0.09;    // at most so far: what reaches on is a thing of its own
constexpr double looked_at_m = 0.2;
constexpr int hidden = 6;           // half of the widest gap, in cells, that a grip hides
constexpr int margin = hidden + 1;  // cells of a map around what was seen
constexpr std::size_t least_points = 300;
constexpr double least_area_m2 = 0.1;
constexpr double least_deep_m = 0.2;    // of furniture
constexpr double least_edge_m = 0.035;  // of a grip's middle from a front's edge
constexpr double least_out_m = 0.025;   // so far does a grip reach
constexpr double least_chance = 0.4;    // of a grip

// The scan's points in the world's frame, ascending by x.
struct Points {
    std::vector<float> x, y, z, nx, ny, nz;
    std::vector<std::int32_t> object;
    std::vector<Rgb8> colour;  // empty: none are known
    std::size_t size() const { return x.size(); }
    Vec3 at(std::size_t n) const { return {x[n], y[n], z[n]}; }
};

Points world_points(const Scene& scene) {
    const ScenePoints& from = scene.points;
    const std::size_t count = from.nx.size() == from.x.size() ? from.x.size() : 0;
    const Rotation turn = rotation_of(scene.manhattan_from_input);
    std::vector<Vec3> at(count);
    for (std::size_t n = 0; n < count; ++n)
        at[n] = transformed(scene.manhattan_from_input, {from.x[n], from.y[n], from.z[n]});
    std::vector<std::uint32_t> order;
    for (std::uint32_t n = 0; n < count; ++n)
        if (rules::finite(at[n]) && std::isfinite(from.nx[n] + from.ny[n] + from.nz[n]))
            order.push_back(n);
    std::ranges::sort(order, {}, [&](std::uint32_t n) { return std::pair(at[n], n); });
    Points out;
    for (const std::uint32_t n : order) {
        const Vec3 normal = turned(turn, {from.nx[n], from.ny[n], from.nz[n]});
        const std::array<std::vector<float>*, 6> columns{&out.x,  &out.y,  &out.z,
                                                         &out.nx, &out.ny, &out.nz};
        for (std::size_t a = 0; a < 3; ++a) {
            columns[a]->push_back(static_cast<float>(at[n][a]));
            columns[a + 3]->push_back(static_cast<float>(normal[a]));
        }
        out.object.push_back(from.object[n]);
        if (!from.red.empty()) out.colour.push_back({from.red[n], from.green[n], from.blue[n]});
    }
    return out;
}

// A bit for each cell of a rectangle.
class Map {
  public:
    Map(int wide, int high) : wide_(wide), high_(high), set_(std::size_t(wide) * high) {}
    int wide() const { return wide_; }
    int high() const { return high_; }
    std::size_t index(int u, int z) const { return std::size_t(z) * wide_ + u; }
    bool inside(int u, int z) const { return u >= 0 && z >= 0 && u < wide_ && z < high_; }
    bool at(int u, int z) const { return inside(u, z) && set_[index(u, z)] != 0; }
    void set(int u, int z, bool value = true) { set_[index(u, z)] = value; }

    // Without the gaps that a square of 2 r + 1 cells does not fit into.
    Map closed(int r) const { return spread(r, true).spread(r, false); }

    struct Patch {
        std::vector<std::pair<int, int>> cells;
        int low_u = 0, high_u = 0, low_z = 0, high_z = 0;  // the last ones within
    };
    // Of cells that touch by sides or corners, by their first cell.
    std::vector<Patch> patches() const {
        std::vector<Patch> out;
        Map done(wide_, high_);
        for (int z = 0; z < high_; ++z)
            for (int u = 0; u < wide_; ++u)
                if (at(u, z) && !done.at(u, z)) out.push_back(patch_of(u, z, done));
        return out;
    }

  private:
    // `to`: set wherever a cell within r is `to`; beyond the map is nothing.
    Map spread(int r, bool to) const {
        Map along(*this), out(*this);
        const auto any = [&](const Map& of, int u, int z, int du, int dz) {
            for (int n = -r; n <= r; ++n)
                if (of.at(u + n * du, z + n * dz) == to) return true;
            return false;
        };
        for (int z = 0; z < high_; ++z)
            for (int u = 0; u < wide_; ++u) along.set(u, z, any(*this, u, z, 1, 0) == to);
        for (int z = 0; z < high_; ++z)
            for (int u = 0; u < wide_; ++u) out.set(u, z, any(along, u, z, 0, 1) == to);
        return out;
    }
    Patch patch_of(int u, int z, Map& done) const {
        Patch out{{{u, z}}, u, u, z, z};
        done.set(u, z);
        for (std::size_t n = 0; n < out.cells.size(); ++n) {
            const auto [cu, cz] = out.cells[n];
            out.low_u = std::min(out.low_u, cu), out.high_u = std::max(out.high_u, cu);
            out.low_z = std::min(out.low_z, cz), out.high_z = std::max(out.high_z, cz);
            for (int k = 0; k < 9; ++k) {
                const int nu = cu + k % 3 - 1, nz = cz + k / 3 - 1;
                if (!at(nu, nz) || done.at(nu, nz)) continue;
                done.set(nu, nz);
                out.cells.emplace_back(nu, nz);
            }
        }
        return out;
    }

    int wide_, high_;
    std::vector<std::uint8_t> set_;
};

struct Plane {
    Vec3 out{};
    double at_m = 0;
};

// Places of counts of least_points or more, the largest first, without those that lie so near to a
// larger one. ring: the last count lies beside the first.
std::vector<std::size_t> peaks(const std::vector<std::size_t>& count, std::size_t near, bool ring) {
    std::vector<std::size_t> order(count.size()), out;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](std::size_t n) { return count[n]; });
    std::vector<bool> taken(count.size());
    for (const std::size_t n : order) {
        if (count[n] < least_points) break;
        if (taken[n]) continue;
        out.push_back(n);
        for (std::size_t k = n + count.size() - near; k <= n + count.size() + near; ++k)
            if (ring || (k >= count.size() && k < 2 * count.size())) taken[k % count.size()] = true;
    }
    return out;
}

// The upright plane through those points that lie near middle_m along `facing`; nothing where
// it looks another way.
std::optional<Plane> plane_near(const Points& points, std::span<const std::uint32_t> which,
                                const Vec3& facing, double middle_m) {
    const double least_cosine = std::cos(8 * std::numbers::pi / 180);
    std::vector<Vec3> on;
    Vec3 sum{};
    for (const std::uint32_t n : which) {
        if (std::abs(dot(facing, points.at(n)) - middle_m) > 1.5 * cell_m) continue;
        on.push_back(points.at(n));
        sum = plus(sum, on.back());
    }
    const Vec3 centre = along({}, 1.0 / static_cast<double>(on.size()), sum);
    double xx = 0, xy = 0, yy = 0;
    for (const Vec3& p : on) {
        const Vec3 d = minus(p, centre);
        xx += d[0] * d[0], xy += d[0] * d[1], yy += d[1] * d[1];
    }
    // The line through them, as seen from above.
    const double turn = std::atan2(2 * xy, xx - yy) / 2;
    Plane out{{-std::sin(turn), std::cos(turn), 0}};
    if (dot(out.out, facing) < 0) out.out = opposite(out.out);
    if (on.empty() || dot(out.out, facing) < least_cosine) return {};
    std::vector<double> at;
    for (const Vec3& p : on) at.push_back(dot(out.out, p));
    out.at_m = upper_median(at);
    return out;
}

// The same in all depths in which many of these points lie.
void add_planes(const Points& points, std::span<const std::uint32_t> which, const Vec3& facing,
                std::vector<Plane>& out) {
    constexpr double most_deep_m = 1000;
    std::vector<double> depth;
    for (const std::uint32_t n : which) depth.push_back(dot(facing, points.at(n)));
    const auto [low, high] = std::ranges::minmax(depth);
    if (!(high - low < most_deep_m)) return;
    std::vector<std::size_t> layer(static_cast<std::size_t>((high - low) / cell_m) + 2);
    for (const double d : depth) {  // each of two layers
        const auto n = static_cast<std::size_t>((d - low) / cell_m);
        ++layer[n];
        if (n > 0) ++layer[n - 1];
    }
    for (const std::size_t n : peaks(layer, 2, false))
        if (const auto plane =
                plane_near(points, which, facing, low + cell_m * (static_cast<double>(n) + 1)))
            out.push_back(*plane);
}

// The upright planes in which most of an object's points lie whose normals go with them.
std::vector<Plane> upright_planes(const Points& points, std::span<const std::uint32_t> own) {
    constexpr std::size_t bins = 72, near = 4;
    constexpr float upright = 0.35f;
    const double least_cosine = std::cos(12 * std::numbers::pi / 180);
    std::vector<std::uint32_t> sides;
    std::vector<std::size_t> count(bins);  // each of three bins
    for (const std::uint32_t n : own) {
        if (std::abs(points.nz[n]) >= upright) continue;
        sides.push_back(n);
        const double turns = std::atan2(points.ny[n], points.nx[n]) / (2 * std::numbers::pi) + 0.5;
        const std::size_t b = std::min(bins - 1, static_cast<std::size_t>(turns * bins));
        for (const std::size_t each : {b + bins - 1, b, b + 1}) ++count[each % bins];
    }
    std::vector<Plane> out;
    for (const std::size_t b : peaks(count, near, true)) {
        const double heading = ((static_cast<double>(b) + 0.5) / bins - 0.5) * 2 * std::numbers::pi;
        const Vec3 middle{std::cos(heading), std::sin(heading), 0};
        std::vector<std::uint32_t> facing;
        Vec3 sum{};
        for (const std::uint32_t n : sides) {
            const Vec3 level = unit({points.nx[n], points.ny[n], 0});
            if (dot(level, middle) < least_cosine) continue;
            facing.push_back(n);
            sum = plus(sum, level);
        }
        if (!facing.empty()) add_planes(points, facing, unit(sum), out);
    }
    return out;
}

// What was seen on and before a plane, cell by cell.
struct FaceMaps {
    FaceMaps(int wide, int high)
        : face(wide, high),
          grip(wide, high),
          far(wide, high),
          off(wide, high),
          out_m(std::size_t(wide) * high) {}
    double low_u = 0, low_z = 0;
    Vec3 colours{};  // the sum of those known on it
    double coloured = 0;
    Map face, grip, far;
    Map off;                   // of readings too far before the plane for its own
    std::vector<float> out_m;  // of the furthest reading of a grip
};

// In cells: the last ones within.
struct Rectangle {
    int low_u = 0, high_u = 0, low_z = 0, high_z = 0;
    // How far a cell lies outside.
    int distance(int u, int z) const {
        return std::max({0, low_u - u, u - high_u, low_z - z, z - high_z});
    }
};

// That what sticks out of a face is a grip, and not noise: a logistic function of the share of
// cells around it that have readings off the face, of the cells that it was seen in, and of these
// by its length; fitted on such patches of 34 generated rooms, of which 74 are grips: left out room
// by room 67 of these are told, and 6 others are taken for some.
double grip_chance(double off_share, double seen, double seen_by_length) {
    const double odds = -13.51 - 1.551 * std::log(off_share + 0.005) + 1.706 * std::log(seen) +
                        2.899 * seen_by_length;
    return 1 / (1 + std::exp(-odds));
}

std::optional<Grip> grip_of(const Map::Patch& patch, const Map& face, const Rectangle& within,
                            const FaceMaps& maps) {
    constexpr double most_long_m = 0.7, bar_m = 0.06, most_thick_m = 0.05;
    constexpr double least_around = 0.75;  // of the cells around it are of the face
    constexpr std::size_t least_seen = 3;
    constexpr int touching = 1, around = 3, looked_at = 15;
    const Rectangle box{patch.low_u, patch.high_u, patch.low_z, patch.high_z};
    const int wide = box.high_u - box.low_u + 1, high = box.high_z - box.low_z + 1;
    const double wide_m = wide * cell_m, high_m = high * cell_m, long_m = std::max(wide_m, high_m);
    Grip grip;
    if (long_m > most_long_m) return {};
    if (long_m >= bar_m) {
        if (std::min(wide_m, high_m) > most_thick_m || long_m < 2 * std::min(wide_m, high_m))
            return {};
        grip.form = wide > high ? Grip::Form::level_bar : Grip::Form::upright_bar;
    }
    std::size_t ring = 0, of_face = 0, beside = 0, off = 0;
    std::vector<float> out_m;
    for (int z = box.low_z - looked_at; z <= box.high_z + looked_at; ++z) {
        for (int u = box.low_u - looked_at; u <= box.high_u + looked_at; ++u) {
            const int distance = box.distance(u, z);
            if (distance <= touching && maps.far.at(u, z)) return {};
            if (distance == 0 && maps.grip.at(u, z))
                out_m.push_back(maps.out_m[maps.grip.index(u, z)]);
            if (distance > touching && distance <= around) {
                ++ring;
                of_face += face.at(u, z);
            }
            if (distance > touching + 1 && within.distance(u, z) == 0) {
                beside += face.at(u, z);
                off += maps.off.at(u, z);
            }
        }
    }
    if (out_m.size() < least_seen ||
        static_cast<double>(of_face) < least_around * static_cast<double>(ring))
        return {};
    grip.out_m = ranked(out_m, out_m.size() * 4 / 5);
    if (grip.out_m < least_out_m) return {};
    const auto seen = static_cast<double>(out_m.size());
    grip.probability =
        grip_chance(std::min(1.0, static_cast<double>(off) /
                                      static_cast<double>(std::max<std::size_t>(1, beside))),
                    seen, seen / std::max(wide, high));
    if (grip.probability < least_chance) return {};
    grip.u = maps.low_u + (box.low_u + box.high_u + 1) * cell_m / 2;
    grip.z = maps.low_z + (box.low_z + box.high_z + 1) * cell_m / 2;
    grip.wide_m = wide_m;
    grip.high_m = high_m;
    return grip;
}

// The first and last line that is as full as most are.
std::pair<int, int> full_lines(const std::vector<int>& count) {
    constexpr double share = 0.3;
    std::vector<int> any;
    for (const int c : count)
        if (c > 0) any.push_back(c);
    const double least = share * ranked(any, any.size() * 9 / 10);
    int first = 0, last = static_cast<int>(count.size()) - 1;
    while (count[first] <= least) ++first;
    while (count[last] <= least) --last;
    return {first, last};
}

class Look {
  public:
    explicit Look(const Points& points) : points_(points) {}

    void add_faces(std::int32_t object, std::span<const std::uint32_t> own, const Plane& plane,
                   std::vector<GrippedFace>& out) const {
        const std::optional<FaceMaps> maps = maps_of(object, own, plane);
        if (!maps) return;
        const Map closed = maps->face.closed(2);
        for (const Map::Patch& patch : closed.patches()) {
            if (static_cast<double>(patch.cells.size()) * cell_m * cell_m < least_area_m2) continue;
            add_face(plane, *maps, patch, out);
        }
    }

  private:
    std::optional<FaceMaps> maps_of(std::int32_t object, std::span<const std::uint32_t> own,
                                    const Plane& plane) const {
        const Vec3 across{-plane.out[1], plane.out[0], 0};
        double low_u = INFINITY, high_u = -INFINITY, low_z = INFINITY, high_z = -INFINITY;
        double low_x = INFINITY, high_x = -INFINITY, coloured = 0;
        Vec3 colours{};
        for (const std::uint32_t n : own) {
            const Vec3 p = points_.at(n);
            if (std::abs(dot(plane.out, p) - plane.at_m) > on_face_m) continue;
            if (!points_.colour.empty() && points_.colour[n] != Rgb8{}) {
                for (std::size_t c = 0; c < 3; ++c) colours[c] += points_.colour[n][c];
                ++coloured;
            }
            low_u = std::min(low_u, dot(across, p)), high_u = std::max(high_u, dot(across, p));
            low_z = std::min(low_z, p[2]), high_z = std::max(high_z, p[2]);
            low_x = std::min(low_x, p[0]), high_x = std::max(high_x, p[0]);
        }
        constexpr double most_m = 10;  // of what is furniture
        if (!(high_u - low_u < most_m && high_z - low_z < most_m)) return {};
        FaceMaps maps(static_cast<int>((high_u - low_u) / cell_m) + 1 + 2 * margin,
                      static_cast<int>((high_z - low_z) / cell_m) + 1 + 2 * margin);
        maps.colours = colours;
        maps.coloured = coloured;
        maps.low_u = low_u - margin * cell_m;
        maps.low_z = low_z - margin * cell_m;
        const auto first = std::ranges::lower_bound(points_.x, low_x - looked_at_m),
                   last = std::ranges::upper_bound(points_.x, high_x + looked_at_m);
        for (auto at = first; at < last; ++at) {
            const auto n = static_cast<std::size_t>(at - points_.x.begin());
            const Vec3 p = points_.at(n);
            const double before = dot(plane.out, p) - plane.at_m;
            if (before < -1.5 * cell_m || before > looked_at_m) continue;
            const int u = static_cast<int>(std::floor((dot(across, p) - maps.low_u) / cell_m)),
                      z = static_cast<int>(std::floor((p[2] - maps.low_z) / cell_m));
            if (!maps.face.inside(u, z)) continue;
            if (before > off_face_m && before < most_grip_m) maps.off.set(u, z);
            if (before < on_face_m) {
                if (points_.object[n] == object) maps.face.set(u, z);
            } else if (before >= most_grip_m) {
                maps.far.set(u, z);
            } else if (before >= before_face_m) {
                maps.grip.set(u, z);
                float& most = maps.out_m[maps.grip.index(u, z)];
                most = std::max(most, static_cast<float>(before));
            }
        }
        return maps;
    }

    void add_face(const Plane& plane, const FaceMaps& maps, const Map::Patch& patch,
                  std::vector<GrippedFace>& out) const {
        Map face(maps.face.wide(), maps.face.high()), grips = face;
        std::vector<int> rows(static_cast<std::size_t>(face.high())),
            columns(static_cast<std::size_t>(face.wide()));
        for (const auto& [u, z] : patch.cells) {
            face.set(u, z);
            ++rows[z];
            ++columns[u];
        }
        const Map whole = face.closed(hidden);  // what a grip hides is of the face
        for (int z = patch.low_z; z <= patch.high_z; ++z)
            for (int u = patch.low_u; u <= patch.high_u; ++u)
                if (maps.grip.at(u, z) && whole.at(u, z)) grips.set(u, z);
        GrippedFace found;
        found.out = plane.out;
        found.across = {-plane.out[1], plane.out[0], 0};
        found.at_m = plane.at_m;
        if (maps.coloured > 0)
            for (std::size_t c = 0; c < 3; ++c)
                found.colour[c] =
                    static_cast<std::uint8_t>(std::lround(maps.colours[c] / maps.coloured));
        const auto [low_u, high_u] = full_lines(columns);
        const auto [low_z, high_z] = full_lines(rows);
        found.low_u = maps.low_u + low_u * cell_m;
        found.high_u = maps.low_u + (high_u + 1) * cell_m;
        found.low_z = maps.low_z + low_z * cell_m;
        found.high_z = maps.low_z + (high_z + 1) * cell_m;
        constexpr int rim = 4;
        const Rectangle within{low_u + rim, high_u - rim, low_z + rim, high_z - rim};
        for (const Map::Patch& each : grips.closed(1).patches()) {
            const std::optional<Grip> grip = grip_of(each, whole, within, maps);
            if (grip && edge_m(found, *grip) >= least_edge_m) found.grips.push_back(*grip);
        }
        constexpr std::size_t most_grips = 40;
        if (found.grips.empty() || found.grips.size() > most_grips) return;
        found.deep_m = deep_m(found);
        if (found.deep_m < least_deep_m) return;
        std::ranges::stable_sort(found.grips, {}, &Grip::u);
        out.push_back(std::move(found));
    }

    // A grip's middle from the nearest edge.
    static double edge_m(const GrippedFace& face, const Grip& grip) {
        return std::min(
            {grip.u - face.low_u, face.high_u - grip.u, grip.z - face.low_z, face.high_z - grip.z});
    }

    // Behind a wall nothing is seen, and through what is open something within its outline; behind
    // a closed front only what goes back from its edges: a top, sides.
    double deep_m(const GrippedFace& face) const {
        constexpr double beside_m = 0.06, first_m = 0.1, most_m = 0.8, most_within = 0.1;
        constexpr std::size_t least_seen = 50;
        const double reach = face.wide_m() / 2 + most_m + beside_m;
        const double x = face.place((face.low_u + face.high_u) / 2, 0)[0];
        std::vector<float> rim, within;
        const auto first = std::ranges::lower_bound(points_.x, x - reach),
                   last = std::ranges::upper_bound(points_.x, x + reach);
        for (auto at = first; at < last; ++at) {
            const Vec3 p = points_.at(static_cast<std::size_t>(at - points_.x.begin()));
            const double behind = face.at_m - dot(face.out, p), u = dot(face.across, p);
            if (behind < first_m || behind > most_m) continue;
            const double outside =
                std::max({face.low_u - u, u - face.high_u, face.low_z - p[2], p[2] - face.high_z});
            if (outside <= beside_m)
                (outside < -beside_m ? within : rim).push_back(static_cast<float>(behind));
        }
        if (rim.size() < least_seen) return 0;
        const float deepest = ranked(rim, rim.size() * 9 / 10);
        // Its back may be seen.
        const auto inside = std::ranges::count_if(
            within, [&](float behind) { return behind < deepest - beside_m; });
        if (static_cast<double>(inside) > most_within * static_cast<double>(rim.size())) return 0;
        return deepest;
    }

    const Points& points_;
};

}  // namespace

std::vector<std::vector<GrippedFace>> gripped_faces(const Scene& scene) {
    std::vector<std::vector<GrippedFace>> out(scene.objects.size());
    const Points points = world_points(scene);
    std::vector<std::vector<std::uint32_t>> own(scene.objects.size());
    for (std::size_t n = 0; n < points.size(); ++n)
        if (points.object[n] >= 0 && static_cast<std::size_t>(points.object[n]) < own.size())
            own[points.object[n]].push_back(static_cast<std::uint32_t>(n));
    const Look look(points);
    for (std::size_t o = 0; o < own.size(); ++o) {
        if (own[o].size() < least_points) continue;
        for (const Plane& plane : upright_planes(points, own[o]))
            look.add_faces(static_cast<std::int32_t>(o), own[o], plane, out[o]);
    }
    return out;
}

}  // namespace topple::exports
