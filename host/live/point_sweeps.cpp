// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "core/rotation.h"
#include "live/scan_kind.h"

namespace topple::live {
namespace {

// Of the image of a sweep: a degree each.
constexpr std::uint32_t image_rows = 180;
constexpr double millimetres = 1000;
// Things are told by so many points of a sweep at most.
constexpr std::size_t most_spots = 4096;

class PointSweeps final : public ScanKind {
  public:
    const Projection& projection() const override { return projection_; }
    DepthFrame image(const KeptFrame& frame) const override {
        DepthFrame out;
        out.depth.assign(projection_.pixels(), 0);
        const PointCloud points = frame.points();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto seen = projection_.see({points.x[i], points.y[i], points.z[i]});
            if (!seen) continue;
            const auto mm = static_cast<std::uint16_t>(
                std::clamp(std::round(double{seen->depth_m} * millimetres), 1.0, 65535.0));
            std::uint16_t& nearest = out.depth[seen->pixel];
            if (nearest == 0 || mm < nearest) nearest = mm;
        }
        return out;
    }
    ParseResult parse(const Frames& frames, std::span<const Gone> gone, const std::string& source,
                      const ParseOptions& options, bool& left_out) const override {
        PointCloud all;
        all.source = source;
        bool coloured = false;
        for (const auto& [frame, kept] : frames) coloured |= kept.frame->is_coloured();
        std::size_t n = 0;
        for (const auto& [frame, kept] : frames) {
            const PointCloud sweep = kept.frame->points();
            const std::vector<bool> out =
                gone.empty() ? std::vector<bool>(sweep.size()) : leave_out(gone[n], sweep);
            ++n;
            for (std::size_t i = 0; i < sweep.size(); ++i) {
                left_out |= out[i];
                if (!out[i]) append(sweep, i, kept.pose, coloured, all);
            }
        }
        return topple::parse(CloudView(all), options);
    }
    PointCloud points(const PosedFrame& frame) const override { return frame.frame->points(); }
    Spots spots(const PosedFrame& frame, const DepthFrame&, const FrameLabeller& labeller,
                unsigned threads) const override {
        PointCloud some;
        Spots out;
        each_spot(frame, [&](std::uint32_t pixel, const Vec3f& at) {
            out.pixel.push_back(pixel);
            some.x.push_back(at[0]);
            some.y.push_back(at[1]);
            some.z.push_back(at[2]);
        });
        out.object = labeller.label(CloudView(some), frame.pose, threads).object;
        return out;
    }
    std::vector<std::uint32_t> spot_pixels(const PosedFrame& frame) const override {
        std::vector<std::uint32_t> out;
        each_spot(frame, [&](std::uint32_t pixel, const Vec3f&) { out.push_back(pixel); });
        return out;
    }

  private:
    using Vec3f = std::array<float, 3>;
    template <class Visit>
    void each_spot(const PosedFrame& frame, const Visit& visit) const {
        const PointCloud points = frame.frame->points();
        const std::size_t every =
            std::max<std::size_t>(1, (points.size() + most_spots - 1) / most_spots);
        for (std::size_t i = 0; i < points.size(); i += every) {
            const Vec3f at{points.x[i], points.y[i], points.z[i]};
            if (const auto seen = projection_.see(at))
                visit(static_cast<std::uint32_t>(seen->pixel), at);
        }
    }
    static void append(const PointCloud& sweep, std::size_t i, const Mat4& pose, bool coloured,
                       PointCloud& all) {
        const Vec3 at = transformed(pose, {sweep.x[i], sweep.y[i], sweep.z[i]});
        all.x.push_back(static_cast<float>(at[0]));
        all.y.push_back(static_cast<float>(at[1]));
        all.z.push_back(static_cast<float>(at[2]));
        all.viewpoint_x.push_back(static_cast<float>(pose[3]));
        all.viewpoint_y.push_back(static_cast<float>(pose[7]));
        all.viewpoint_z.push_back(static_cast<float>(pose[11]));
        if (!coloured) return;
        const bool known = !sweep.red.empty();
        all.red.push_back(known ? sweep.red[i] : 0);
        all.green.push_back(known ? sweep.green[i] : 0);
        all.blue.push_back(known ? sweep.blue[i] : 0);
    }
    // The points that are left out.
    std::vector<bool> leave_out(const Gone& gone, const PointCloud& sweep) const {
        const std::uint32_t width = projection_.width(), height = projection_.height();
        std::vector<std::uint16_t> seen_through(projection_.pixels(), 0);
        for (const GonePixel& pixel : gone)
            if (pixel.is_sure())
                seen_through[std::size_t{pixel.v} * width + pixel.u] = pixel.stored;
        std::vector<bool> out(sweep.size());
        for (std::size_t i = 0; i < sweep.size(); ++i) {
            const auto seen = projection_.see({sweep.x[i], sweep.y[i], sweep.z[i]});
            if (!seen) continue;
            const double across_m = double{seen->depth_m} * M_PI / image_rows;
            const std::size_t u = seen->pixel % width, v = seen->pixel / width;
            for (std::size_t row = std::max<std::size_t>(v, 1) - 1;
                 row <= std::min<std::size_t>(v + 1, height - 1); ++row) {
                for (std::size_t column = u + width - 1; column <= u + width + 1; ++column) {
                    const std::uint16_t stored = seen_through[row * width + column % width];
                    out[i] = out[i] || (stored > 0 &&
                                        std::abs(double{seen->depth_m} - stored / millimetres) <=
                                            alike_depth_m + across_m);
                }
            }
        }
        return out;
    }

    Projection projection_ = Projection::around(image_rows, millimetres);
};

}  // namespace

std::unique_ptr<ScanKind> point_sweeps() {
    return std::make_unique<PointSweeps>();
}

}  // namespace topple::live
