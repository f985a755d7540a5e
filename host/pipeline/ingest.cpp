// SPDX-License-Identifier: MIT
#include "pipeline/ingest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/depth_noise.h"
#include "geometry/frames_fusion.h"
#include "geometry/surfels.h"
#include "io/frame_sequence.h"
#include "io/read_cloud.h"

namespace topple {
namespace {

// Working resolution stays within what indoor sensors deliver and what furniture needs.
constexpr double least_cell_m = 0.003, largest_cell_m = 0.05;
constexpr std::uint32_t virtual_positions = 6;

class SequenceStream final : public FrameStream {
  public:
    explicit SequenceStream(io::FrameSequence sequence) : sequence_(std::move(sequence)) {}
    const Intrinsics& intrinsics() const override { return sequence_.intrinsics(); }
    std::size_t size() const override { return sequence_.size(); }
    DepthFrame load(std::size_t i) const override { return sequence_.load(i); }

  private:
    io::FrameSequence sequence_;
};

class MemoryStream final : public FrameStream {
  public:
    MemoryStream(const Intrinsics& intrinsics, std::vector<DepthFrame> frames)
        : intrinsics_(intrinsics), frames_(std::move(frames)) {}
    const Intrinsics& intrinsics() const override { return intrinsics_; }
    std::size_t size() const override { return frames_.size(); }
    DepthFrame load(std::size_t i) const override { return frames_[i]; }

  private:
    Intrinsics intrinsics_;
    std::vector<DepthFrame> frames_;
};

Vec3 position(const DepthFrame& frame) {
    const Mat4& m = frame.camera_to_world;
    return {m[3], m[7], m[11]};
}

// The cell that suits a depth camera: about the spacing of its pixels at the scene's typical depth,
// but not below its noise there, which only smears points over more cells.
double cell_for_frames(const FrameStream& frames) {
    std::vector<double> depths;
    const Intrinsics& k = frames.intrinsics();
    const std::size_t step = std::max<std::size_t>(1, frames.size() / 8);
    for (std::size_t f = 0; f < frames.size(); f += step) {
        const DepthFrame frame = frames.load(f);
        for (std::size_t i = 0; i < frame.depth.size(); i += 37) {
            if (frame.depth[i]) depths.push_back(frame.depth[i] / k.depth_scale);
        }
    }
    if (depths.empty()) return 0.01;
    std::nth_element(depths.begin(),
                     depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2), depths.end());
    const double z = depths[depths.size() / 2];
    const double noise = geometry::depth_sigma(z);
    return std::clamp(std::max(1.5 * z / k.fx, 1.2 * noise), least_cell_m, 0.015);
}

double distance_to(const PointCloud& cloud, std::size_t n, const DepthFrame& frame) {
    const Mat4& m = frame.camera_to_world;
    return std::hypot(cloud.x[n] - m[3], cloud.y[n] - m[7], cloud.z[n] - m[11]);
}

// Whether the point is in the frame's view and nothing in the frame hides it.
bool sees(const DepthFrame& frame, const Intrinsics& k, const PointCloud& cloud, std::size_t n,
          double tolerance_m) {
    const Mat4& m = frame.camera_to_world;
    const double dx = cloud.x[n] - m[3], dy = cloud.y[n] - m[7], dz = cloud.z[n] - m[11];
    const double z = m[2] * dx + m[6] * dy + m[10] * dz;
    if (z <= 0) return false;
    const double u = k.fx * (m[0] * dx + m[4] * dy + m[8] * dz) / z + k.cx;
    const double v = k.fy * (m[1] * dx + m[5] * dy + m[9] * dz) / z + k.cy;
    if (!(u > -0.5 && v > -0.5 && u < k.width - 0.5 && v < k.height - 0.5)) return false;
    const auto pixel = static_cast<std::size_t>(std::lround(v)) * k.width +
                       static_cast<std::size_t>(std::lround(u));
    const double depth = frame.depth[pixel] / k.depth_scale;
    return depth > 0 && z <= depth + tolerance_m;
}

// For each point the nearest of the frames that see it; the nearest of all where none does.
std::vector<std::uint32_t> seen_from(const PointCloud& cloud, const Intrinsics& k,
                                     const std::vector<DepthFrame>& frames, double tolerance_m) {
    std::vector<std::uint32_t> best(cloud.size(), 0);
    for (std::size_t n = 0; n < cloud.size(); ++n) {
        double best_distance = std::numeric_limits<double>::infinity();
        bool best_seen = false;
        for (std::size_t f = 0; f < frames.size(); ++f) {
            const double distance = distance_to(cloud, n, frames[f]);
            if (best_seen && distance >= best_distance) continue;
            const bool seen = sees(frames[f], k, cloud, n, tolerance_m);
            if (seen == best_seen ? distance >= best_distance : !seen) continue;
            best[n] = static_cast<std::uint32_t>(f);
            best_distance = distance;
            best_seen = seen;
        }
    }
    return best;
}

Ingested ingest_frames(io::FrameSequence sequence, const ParseOptions& options) {
    Ingested out;
    const bool posed = sequence.posed();
    out.camera_up = sequence.mean_camera_up();
    out.frames = std::make_unique<SequenceStream>(std::move(sequence));
    out.cell_m = cell_for_frames(*out.frames);
    geometry::FrameFusion fusion(out.frames->intrinsics(), out.cell_m);
    for (std::size_t f = 0; f < out.frames->size(); ++f) {
        if (options.cancelled && options.cancelled()) throw Error(ErrorKind::input, "cancelled");
        fusion.add(out.frames->load(f));
        if (options.progress)
            options.progress("ingest",
                             static_cast<double>(f + 1) / static_cast<double>(out.frames->size()));
    }
    geometry::FusedCloud fused = fusion.finish();
    out.cloud = std::move(fused.cloud);
    out.viewpoints = std::move(fused.viewpoints);
    out.viewpoint_of_point = std::move(fused.viewpoint_of_point);
    if (!posed)
        out.notes.push_back("A single frame: what it does not show is completed by shape alone.");
    return out;
}

}  // namespace

Ingested ingest_cloud(PointCloud cloud, const ParseOptions&) {
    Ingested out;
    const double spacing = geometry::point_spacing(cloud);
    // A little above the spacing, so that a surface has no holes at this resolution.
    out.cell_m = std::clamp(1.25 * spacing, least_cell_m, largest_cell_m);
    out.notes = cloud.notes;
    out.cloud = std::move(cloud);
    Intrinsics intrinsics;
    DepthFrame frame;
    if (out.cloud.height > 1 && geometry::frame_of_organised_cloud(out.cloud, intrinsics, frame)) {
        out.viewpoints = {position(frame)};
        const Mat4& pose = frame.camera_to_world;
        out.camera_up = Vec3{-pose[1], -pose[5], -pose[9]};
        std::vector<DepthFrame> frames;
        frames.push_back(std::move(frame));
        out.frames = std::make_unique<MemoryStream>(intrinsics, std::move(frames));
        return out;
    }
    if (out.cloud.has_viewpoint) out.viewpoints = {out.cloud.viewpoint};
    std::vector<DepthFrame> frames;
    geometry::virtual_frames(out.cloud, spacing, virtual_positions, intrinsics, frames);
    if (frames.empty()) {
        out.notes.push_back(
            "No free space could be seen from inside of the cloud; nothing was carved.");
        return out;
    }
    if (out.viewpoints.empty() && out.cloud.nx.empty()) {
        for (const DepthFrame& f : frames) out.viewpoints.push_back(position(f));
        out.viewpoint_of_point = seen_from(out.cloud, intrinsics, frames, 3 * out.cell_m);
    }
    out.frames = std::make_unique<MemoryStream>(intrinsics, std::move(frames));
    out.notes.push_back(
        "The cloud has no sensor poses: free space was estimated from viewpoints inside of it, and "
        "is less "
        "certain than from depth frames.");
    return out;
}

Ingested ingest(const std::filesystem::path& input, const ParseOptions& options) {
    if (options.progress) options.progress("ingest", 0);
    if (io::looks_like_sequence(input))
        return ingest_frames(io::FrameSequence::open(input), options);
    return ingest_cloud(io::read_cloud(input), options);
}

}  // namespace topple
