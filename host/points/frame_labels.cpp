// SPDX-License-Identifier: MIT
#include "topple/frame_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/depth_noise.h"
#include "core/rotation.h"
#include "core/thread_pool.h"
#include "core/vectors.h"
#include "geometry/cell_grid.h"
#include "io/text.h"
#include "points/caller_frames.h"
#include "points/caller_points.h"
#include "points/formats/frame_sequence.h"
#include "points/observation.h"

namespace topple {
namespace {

using CellIndex = std::array<std::int64_t, 3>;

}  // namespace

// The points by the cells of a grid that they lie in, and what they belong to.
class FrameLabeller::Points {
  public:
    explicit Points(const ParseResult& result) {
        const ScenePoints& from = result.scene.points;
        if (result.tiled)
            throw Error(ErrorKind::usage,
                        "frame labels: the cloud was parsed in blocks, and its result holds a "
                        "sample of the points alone; parse frames, or a smaller cloud");
        if (from.x.size() != from.primitive.size())
            throw Error(ErrorKind::usage,
                        "frame labels: the result has no coordinates of its points; "
                        "add_coordinates() puts them there");
        reach_m_ = result.scene.voxel_size_m;
        lay_out(from);
    }

    // The number of the nearest point within the reach of such a reading; none: `absent`.
    std::uint32_t nearest(const Vec3& at, double depth_m) const {
        constexpr double noise_reach = 3;  // of standard deviations: a reading in 370 lies beyond
        const std::uint32_t near = within(at, reach_m_);
        const double noise_m = noise_reach * depth_sigma(depth_m);
        return near != absent || noise_m <= reach_m_ ? near : within(at, noise_m);
    }
    std::int32_t primitive(std::uint32_t n) const { return primitive_[n]; }
    std::int32_t object(std::uint32_t n) const { return object_[n]; }

    static constexpr std::uint32_t absent = std::numeric_limits<std::uint32_t>::max();

  private:
    std::int64_t cell_of(double metres) const {
        return static_cast<std::int64_t>(std::floor(metres / cell_m_));
    }

    void lay_out(const ScenePoints& from) {
        const std::array<const std::vector<float>*, 3> axes{&from.x, &from.y, &from.z};
        const std::size_t count = from.x.size();
        if (count == 0) return;
        double extent = 0;
        std::array<std::pair<double, double>, 3> bounds;
        for (std::size_t a = 0; a < 3; ++a) {
            const auto [low, high] = std::ranges::minmax(*axes[a]);
            bounds[a] = {low, high};
            extent = std::max(extent, bounds[a].second - bounds[a].first);
        }
        // So that a ball of the reach meets eight cells; and no more of them than can be packed.
        constexpr double most_cells = 1 << 20;
        cell_m_ = std::max(2 * reach_m_, extent / most_cells);
        for (std::size_t a = 0; a < 3; ++a) {
            lowest_[a] = cell_of(bounds[a].first);
            highest_[a] = cell_of(bounds[a].second);
        }
        const geometry::CellPacking pack(lowest_, highest_);
        std::vector<std::uint64_t> keys(count);
        for (std::size_t i = 0; i < count; ++i)
            keys[i] = pack(cell_of(from.x[i]), cell_of(from.y[i]), cell_of(from.z[i]));
        geometry::KeyGroups groups = geometry::group_keys(keys);
        for (const std::uint32_t i : groups.order) {
            at_.push_back({from.x[i], from.y[i], from.z[i]});
            primitive_.push_back(from.primitive[i]);
            object_.push_back(from.object[i]);
        }
        for (std::size_t g = 0; g < groups.size(); ++g)
            keys_.push_back(keys[groups.order[groups.first[g]]]);
        first_ = std::move(groups.first);
    }

    // Of two that are as near that of the lower cell, and in it the earlier one in the cloud.
    std::uint32_t within(const Vec3& at, double reach_m) const {
        if (at_.empty()) return absent;
        CellIndex low{}, high{};
        for (std::size_t a = 0; a < 3; ++a) {
            // Compared as numbers: what is far off has no cell.
            if (!(at[a] + reach_m >= cell_m_ * static_cast<double>(lowest_[a])) ||
                !(at[a] - reach_m <= cell_m_ * static_cast<double>(highest_[a] + 1)))
                return absent;
            low[a] = std::max(cell_of(at[a] - reach_m), lowest_[a]);
            high[a] = std::min(cell_of(at[a] + reach_m), highest_[a]);
        }
        const geometry::CellPacking pack(lowest_, highest_);
        std::uint32_t best = absent;
        double least = reach_m * reach_m;
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                const std::uint64_t last = pack(x, y, high[2]);
                auto key = std::ranges::lower_bound(keys_, pack(x, y, low[2]));
                for (; key != keys_.end() && *key <= last; ++key) {
                    const auto cell = static_cast<std::size_t>(key - keys_.begin());
                    for (std::uint32_t n = first_[cell]; n < first_[cell + 1]; ++n) {
                        const double dx = at_[n][0] - at[0], dy = at_[n][1] - at[1],
                                     dz = at_[n][2] - at[2];
                        const double square = dx * dx + dy * dy + dz * dz;
                        if (square > least || (square == least && best != absent)) continue;
                        least = square;
                        best = n;
                    }
                }
            }
        }
        return best;
    }

    double reach_m_ = 0, cell_m_ = 1;
    CellIndex lowest_{}, highest_{};
    std::vector<std::uint64_t> keys_;       // of cells with points, ascending
    std::vector<std::uint32_t> first_;      // where the points of each begin, and the last's end
    std::vector<std::array<float, 3>> at_;  // by cell
    std::vector<std::int32_t> primitive_, object_;
};

FrameLabeller::FrameLabeller(const ParseResult& result)
    : points_(std::make_unique<const Points>(result)) {}
FrameLabeller::~FrameLabeller() = default;
FrameLabeller::FrameLabeller(FrameLabeller&&) noexcept = default;
FrameLabeller& FrameLabeller::operator=(FrameLabeller&&) noexcept = default;

namespace {

void check_number(const std::string& source, std::size_t number, std::size_t frames) {
    if (number < frames) return;
    throw Error(ErrorKind::usage, source + ": there is no frame " + std::to_string(number) +
                                      ": they count from 0, and there are " +
                                      std::to_string(frames));
}

template <class Points>
FrameLabels labels_of(const Points& points, const Intrinsics& k, const DepthFrame& frame,
                      unsigned threads) {
    FrameLabels out{k.width, k.height, {}, {}};
    out.primitive.assign(frame.depth.size(), -1);
    out.object.assign(frame.depth.size(), -1);
    const Mat4& m = frame.camera_to_world;
    ThreadPool pool(threads);
    pool.each(k.height, 16, [&](std::size_t v) {
        for (std::size_t u = 0; u < k.width; ++u) {
            const std::size_t pixel = v * k.width + u;
            if (frame.depth[pixel] == 0) continue;
            const double z = frame.depth[pixel] / k.depth_scale;
            const double x = z * (static_cast<double>(u) - k.cx) / k.fx,
                         y = z * (static_cast<double>(v) - k.cy) / k.fy;
            Vec3 at{};
            for (std::size_t a = 0; a < 3; ++a)
                at[a] = m[4 * a] * x + m[4 * a + 1] * y + m[4 * a + 2] * z + m[4 * a + 3];
            const std::uint32_t nearest = points.nearest(at, z);
            if (nearest == Points::absent) continue;
            out.primitive[pixel] = points.primitive(nearest);
            out.object[pixel] = points.object(nearest);
        }
    });
    return out;
}

}  // namespace

FrameLabels FrameLabeller::label(const FramesView& frames, std::size_t number,
                                 unsigned threads) const {
    const CallerFrames given(frames);
    check_number(given.source(), number, given.size());
    return labels_of(*points_, given.intrinsics(), given.load(number), threads);
}

PointLabels FrameLabeller::label(const CloudView& points, const Mat4& sensor_to_world,
                                 unsigned threads) const {
    check_points(points);
    PointLabels out;
    out.primitive.assign(points.size(), -1);
    out.object.assign(points.size(), -1);
    ThreadPool pool(threads);
    pool.each(points.size(), 1024, [&](std::size_t i) {
        const Vec3 at{points.x[i], points.y[i], points.z[i]};
        const double range_m = length(at);
        if (!std::isfinite(range_m)) return;
        const std::uint32_t nearest = points_->nearest(transformed(sensor_to_world, at), range_m);
        if (nearest == Points::absent) return;
        out.primitive[i] = points_->primitive(nearest);
        out.object[i] = points_->object(nearest);
    });
    return out;
}

FrameLabels FrameLabeller::label(const std::filesystem::path& folder, std::size_t number,
                                 unsigned threads) const {
    check_path(folder);
    const io::FrameSequence sequence = io::FrameSequence::open(folder);
    check_number(io::path_text(folder), number, sequence.size());
    return labels_of(*points_, sequence.intrinsics(), sequence.load(number), threads);
}

}  // namespace topple
