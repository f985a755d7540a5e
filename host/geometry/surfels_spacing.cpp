// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/place_hash.h"
#include "core/ranked.h"
#include "geometry/surfels.h"

// The resolution of a cloud.
namespace topple::geometry {
namespace {

// Where most points lie on little of the surface, a dense wall or what stands next to the sensor,
// their spacing would tear up all else. So it is no less than this share of the distance to the
// fourth place around, of that part of the surface; random points are as near to the next as that.
constexpr std::size_t around = 4;
constexpr double around_share = 0.38, surface_part = 0.75;
// Blocks that surface is counted in: as many spacings wide, and with no fewer points.
constexpr double area_spacings = 40;
constexpr std::size_t least_in_block = 6;

std::uint64_t hash_at(const CloudView& cloud, std::size_t i) {
    return place_hash(cloud.x[i], cloud.y[i], cloud.z[i]);
}
// Of places with one hash, whatever their order.
bool is_before(const CloudView& cloud, std::size_t i, std::size_t j) {
    return std::tuple(cloud.x[i], cloud.y[i], cloud.z[i]) <
           std::tuple(cloud.x[j], cloud.y[j], cloud.z[j]);
}

// Points at that many different places, evenly over the points: those of the lowest hashes.
std::vector<std::size_t> sample_places(const CloudView& cloud, std::size_t samples) {
    std::map<std::uint64_t, std::size_t> lowest;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const std::uint64_t hash = hash_at(cloud, i);
        if (lowest.size() == samples && hash > lowest.rbegin()->first) continue;
        std::size_t& point = lowest.emplace(hash, i).first->second;
        if (is_before(cloud, i, point)) point = i;
        if (lowest.size() > samples) lowest.erase(std::prev(lowest.end()));
    }
    std::vector<std::size_t> out;
    for (const auto& [hash, point] : lowest) out.push_back(point);
    return out;
}

// Points of that many different blocks of space, evenly over the surface that was scanned: of each
// block the point with the lowest hash. Blocks of a few points are strays.
std::vector<std::size_t> sample_area(const CloudView& cloud, std::size_t samples, double block_m) {
    struct Block {
        std::uint64_t lowest;
        std::size_t point, count;
    };
    constexpr std::size_t tried = 4;  // times as many, to leave enough without the strays
    std::map<std::uint64_t, Block> blocks;
    const auto index = [&](float v) { return static_cast<std::int64_t>(std::floor(v / block_m)); };
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const std::uint64_t block =
            hash_of(index(cloud.x[i]), index(cloud.y[i]), index(cloud.z[i]));
        if (blocks.size() == tried * samples && block > blocks.rbegin()->first) continue;
        const std::uint64_t place = hash_at(cloud, i);
        Block& b = blocks.try_emplace(block, Block{place, i, 0}).first->second;
        ++b.count;
        if (place < b.lowest || (place == b.lowest && is_before(cloud, i, b.point)))
            b.lowest = place, b.point = i;
        if (blocks.size() > tried * samples) blocks.erase(std::prev(blocks.end()));
    }
    std::vector<std::size_t> out;
    for (const auto& [hash, b] : blocks) {
        if (b.count >= least_in_block && out.size() < samples) out.push_back(b.point);
    }
    return out;
}

// How far it is from a point to the first and to the last of the `around` other places around it,
// squared; infinite where there are fewer. A place counts once, however often it is stored.
struct Spacings {
    float first = 0, last = 0;
};
class NearestPlaces {
  public:
    // Points of the cloud that are looked at together.
    static constexpr std::size_t at_once = 256;
    struct Portion {
        std::size_t first = 0, count = 0;
        std::array<float, at_once> x{}, y{}, z{};
    };

    NearestPlaces(const CloudView& cloud, std::size_t point)
        : cloud_(cloud), x_(cloud.x[point]), y_(cloud.y[point]), z_(cloud.z[point]) {}

    // Most points are farther off than those found, and no more than compared.
    void look(const Portion& all) {
        std::array<float, at_once> distance;
        const float last = nearest_.back().distance;
        std::uint32_t nearer = 0;
        for (std::size_t n = 0; n < at_once; ++n) {
            const float dx = all.x[n] - x_, dy = all.y[n] - y_, dz = all.z[n] - z_;
            distance[n] = dx * dx + dy * dy + dz * dz;
            nearer |= std::uint32_t{distance[n] < last};
        }
        if (nearer == 0) return;
        for (std::size_t n = 0; n < all.count; ++n) add(all.first + n, distance[n]);
    }

    Spacings found() const { return {nearest_.front().distance, nearest_.back().distance}; }

  private:
    struct Place {
        float distance = std::numeric_limits<float>::infinity();
        std::size_t point = 0;
    };
    bool same(std::size_t a, std::size_t b) const {
        return cloud_.x[a] == cloud_.x[b] && cloud_.y[a] == cloud_.y[b] &&
               cloud_.z[a] == cloud_.z[b];
    }
    void add(std::size_t j, float d) {
        Place& last = nearest_.back();
        if (!(d < last.distance && d > 0)) return;
        if (std::any_of(nearest_.begin(), nearest_.end(),
                        [&](const Place& p) { return p.distance == d && same(p.point, j); }))
            return;
        last = {d, j};
        for (auto at = nearest_.end() - 1;
             at != nearest_.begin() && at->distance < (at - 1)->distance; --at)
            std::swap(*at, *(at - 1));
    }

    const CloudView& cloud_;
    float x_, y_, z_;
    std::array<Place, around> nearest_{};
};

// The distance that this share of those found has at most; 0 where none was.
double share_of(const std::vector<Spacings>& all, float Spacings::*which, double share) {
    std::vector<float> distances;
    for (const Spacings& a : all)
        if (std::isfinite(a.*which)) distances.push_back(a.*which);
    return std::sqrt(static_cast<double>(quantile(distances, share)));
}

std::vector<Spacings> look_around(const CloudView& cloud, const std::vector<std::size_t>& points) {
    std::vector<NearestPlaces> nearest;
    for (const std::size_t i : points) nearest.emplace_back(cloud, i);
    NearestPlaces::Portion portion;
    for (std::size_t first = 0; first < cloud.size(); first += NearestPlaces::at_once) {
        portion.first = first;
        portion.count = std::min(NearestPlaces::at_once, cloud.size() - first);
        for (std::size_t n = 0; n < portion.count; ++n) {
            portion.x[n] = cloud.x[first + n];
            portion.y[n] = cloud.y[first + n];
            portion.z[n] = cloud.z[first + n];
        }
        for (NearestPlaces& of_point : nearest) of_point.look(portion);
    }
    std::vector<Spacings> out;
    for (const NearestPlaces& of_point : nearest) out.push_back(of_point.found());
    return out;
}

}  // namespace

PointSpacing point_spacing(const CloudView& cloud) {
    PointSpacing out;
    const std::size_t n = cloud.size();
    if (n < 2) return out;
    // Brute force over a sample: the clouds that come here have at most some 10^7 points.
    const std::size_t samples = std::clamp<std::size_t>(100'000'000 / n, 64, 1024);
    const std::vector<Spacings> of_points = look_around(cloud, sample_places(cloud, samples));
    out.nearest_m = share_of(of_points, &Spacings::first, 0.5);
    if (out.nearest_m <= 0) return out;
    out.around_m = share_of(of_points, &Spacings::last, 0.5);
    const std::vector<Spacings> of_area =
        look_around(cloud, sample_area(cloud, samples, area_spacings * out.nearest_m));
    const double of_surface = share_of(of_area, &Spacings::last, surface_part);
    out.surface_m = std::max(out.around_m, of_surface);
    out.nearest_m = std::max(out.nearest_m, around_share * of_surface);
    return out;
}

SurfelScale surfels_for(const PointSpacing& spacing, double coarse_m) {
    // Surfels this wide tell what lies on a surface from the surface; cells narrower than this
    // share of the points' distance are empty but for one of them each; and what is this many
    // distances apart does not touch.
    constexpr double fine_m = 0.02, pitch_share = 0.65, reach_pitches = 2;
    const double cell_m = std::min(coarse_m, std::max(fine_m, pitch_share * spacing.around_m));
    return {cell_m, spacing.around_m, reach_pitches * spacing.surface_m};
}

}  // namespace topple::geometry
