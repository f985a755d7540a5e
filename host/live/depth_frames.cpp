// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <utility>

#include "live/coarse_frame.h"
#include "live/scan_kind.h"
#include "points/caller_frames.h"

namespace topple::live {
namespace {

class DepthFrames final : public ScanKind {
  public:
    explicit DepthFrames(const Intrinsics& depth)
        : k_(depth), coarse_(depth), projection_(coarse_.intrinsics()) {}
    const Projection& projection() const override { return projection_; }
    DepthFrame image(const KeptFrame& frame) const override {
        return coarse_.of(frame.depth_frame());
    }
    ParseResult parse(const Frames& frames, std::span<const Gone> gone, const std::string& source,
                      const ParseOptions& options, bool& left_out) const override {
        FramesView view;
        view.intrinsics = k_;
        view.source = source;
        std::vector<const KeptFrame*> images;
        for (const auto& [frame, kept] : frames) {
            view.camera_to_world.push_back(kept.pose);
            images.push_back(kept.frame.get());
        }
        DepthFrame current;
        view.image = [&](std::size_t n) {
            current = images[n]->frame();
            if (!gone.empty()) left_out |= coarse_.leave_out(gone[n], current);
            return view_of(current, k_);
        };
        return topple::parse(view, options);
    }
    PointCloud points(const PosedFrame& frame) const override {
        constexpr std::uint32_t enough_columns = 320;
        const std::size_t step = std::max(1u, k_.width / enough_columns);
        const Projection by(k_);
        const DepthFrame seen = frame.frame->depth_frame();
        PointCloud out;
        for (std::size_t v = 0; v < k_.height; v += step)
            for (std::size_t u = 0; u < k_.width; u += step) {
                const std::uint16_t stored = seen.depth[v * k_.width + u];
                if (stored == 0) continue;
                const auto [x, y, z] = by.place(u, v, stored / k_.depth_scale);
                out.x.push_back(x);
                out.y.push_back(y);
                out.z.push_back(z);
            }
        return out;
    }
    Spots spots(const PosedFrame& frame, const DepthFrame& image, const FrameLabeller& labeller,
                unsigned threads) const override {
        FramesView view;
        view.intrinsics = coarse_.intrinsics();
        view.camera_to_world = {frame.pose};
        view.images = {view_of(image, view.intrinsics)};
        return {spot_pixels(frame), labeller.label(view, 0, threads).object};
    }
    std::vector<std::uint32_t> spot_pixels(const PosedFrame&) const override {
        std::vector<std::uint32_t> out(projection_.pixels());
        std::iota(out.begin(), out.end(), 0u);
        return out;
    }

  private:
    Intrinsics k_;
    Coarse coarse_;
    Projection projection_;
};

}  // namespace

std::unique_ptr<ScanKind> depth_frames(const Intrinsics& depth) {
    return std::make_unique<DepthFrames>(depth);
}

std::unique_ptr<ScanKind> scan_kind(const Checkpoint& of) {
    return of.depth ? depth_frames(*of.depth) : point_sweeps();
}

}  // namespace topple::live
