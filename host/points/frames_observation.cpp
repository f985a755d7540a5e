// SPDX-License-Identifier: MIT
#include <algorithm>
#include <exception>
#include <span>
#include <utility>

#include "core/depth_noise.h"
#include "core/ranked.h"
#include "device/cancelling.h"
#include "io/text.h"
#include "points/caller_frames.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/rigid_pose.h"
#include "points/frame_checks.h"
#include "points/frames_fusion.h"
#include "points/observation.h"
#include "points/parse_memory.h"
#include "points/voxel_size.h"
#include "points/work_check.h"
#include "points/working_origin.h"

// Depth frames become an observation.
namespace topple {
namespace {

std::vector<Vec3> places_of(std::span<const Mat4> poses) {
    std::vector<Vec3> places;
    for (const Mat4& m : poses) places.push_back({m[3], m[7], m[11]});
    return places;
}

// A fusion that takes no more memory than ParseOptions::max_memory_bytes, and says of frames that
// need more what to do about it.
class LimitedFusion {
  public:
    // Of input.frames, to its cells. What is referred to must stay. Throws Error(input), as the
    // others do.
    LimitedFusion(const Observation& input, double typical_depth_m, const std::string& source,
                  const ParseOptions& options, unsigned threads)
        : input_(input),
          count_(input.frames->size()),
          typical_depth_m_(typical_depth_m),
          source_(source),
          options_(options),
          fusion_(input.frames->intrinsics(), input.cell_m, threads) {
        if (memory_bound(options) == UINT64_MAX) return;
        const Intrinsics& k = input.frames->intrinsics();
        const auto beside = static_cast<std::uint64_t>(
            fusion_beside(static_cast<double>(count_) * k.width * k.height));
        check_memory(source + ": to fuse " + io::counted(count_, "depth frame") + " takes at least",
                     beside, options, "give points in their place");
        most_bytes_ = memory_bound(options) - beside;
        fusion_.set_most_bytes(most_bytes_);
    }
    void add(const DepthFrame& frame) {
        fusion_.add(frame);
        ++added_;
        check();
    }
    geometry::FusedCloud finish(const std::function<void()>& poll) {
        fusion_.flush();
        check();
        return fusion_.finish(poll);
    }

  private:
    void check() const {
        if (fusion_.bytes() <= most_bytes_) return;
        const std::string frames = io::counted(count_, "depth frame");
        throw Error(ErrorKind::input,
                    source_ + ": the surfaces of " +
                        (added_ < count_ ? "the first " + std::to_string(added_) + " of " : "") +
                        frames + " take more than the " + memory_bound_text(options_) +
                        "; allow more, or give fewer frames; " +
                        depth_scale_hint(count_, input_.frames->intrinsics().depth_scale,
                                         typical_depth_m_, input_.origin));
    }

    const Observation& input_;
    std::size_t count_;
    double typical_depth_m_;
    const std::string& source_;
    const ParseOptions& options_;
    geometry::FrameFusion fusion_;
    std::size_t most_bytes_ = SIZE_MAX, added_ = 0;
};

// Fuses out.frames, called `source`. poses: as they were given, of each; none of a single frame.
void fuse_frames(device::Device& device, std::span<const Mat4> poses, const std::string& source,
                 const ParseOptions& options, Observation& out) {
    const Intrinsics& k = out.frames->intrinsics();
    out.by_sensors = true;
    // Before anything is made of them.
    check_camera_steps(places_of(poses), source);
    const double depth_m = typical_depth(*out.frames, device.threads());
    check_readings(k, out.frames->size(), depth_m, source, out.origin);
    out.cell_m = cell_for_frames(k, depth_m);
    if (!poses.empty()) {  // the sensor is the origin of a single image
        out.origin_m = origin_amid_voxels(densest_planes(*out.frames, device.threads()),
                                          voxel_for_input(out, options));
        out.frames = std::make_unique<ReckonedFrames>(std::move(out.frames), out.origin_m);
    }
    LimitedFusion fusion(out, depth_m, source, options, device.threads().threads());
    geometry::PoseComparison comparison(k, poses, depth_m);
    const auto count = static_cast<double>(out.frames->size());
    constexpr double added_share = 0.4, polls = 5;  // of the stage; while it is finished
    const auto tell = [&](double done) {
        if (options.progress) options.progress("ingest", done);
    };
    const auto add = [&](const DepthFrame& frame, std::size_t f) {
        end_if_cancelled(options);
        fusion.add(frame);
        comparison.add(frame, f);
        tell(added_share * static_cast<double>(f + 1) / count);
    };
    for_each_frame(*out.frames, device.threads(), add, {.coloured = true});
    note_principal_point(k, out.origin, out.doubts);
    // First, and at once: the shards that such poses give take long.
    if (const std::string note = pose_note(comparison, poses.size(), out.origin); !note.empty()) {
        out.doubts.insert(out.doubts.begin(), note);
        if (options.notice) options.notice(note);
    }
    double polled = 0;
    geometry::FusedCloud fused = fusion.finish([&] {
        end_if_cancelled(options);
        tell(added_share + (1 - added_share) * std::min(1.0, ++polled / polls));
    });
    out.own = std::move(fused.cloud);
    const std::array<std::vector<float>*, 3> columns{&out.own.x, &out.own.y, &out.own.z};
    for (std::size_t a = 0; a < 3; ++a)
        for (float& v : *columns[a]) v = static_cast<float>(v + out.origin_m[a]);
    out.cloud = out.own;
    reckon_from(out.origin_m, out);
    out.viewpoints = std::move(fused.viewpoints);
    out.viewpoint_of_point = std::move(fused.viewpoint_of_point);
    if (poses.empty()) note_single_frame(out);
    note_colours(!out.cloud.red.empty(), out);
}

// Of frames in a folder or in memory; notes: what is odd about them.
template <class Frames>
Observation fused(device::Device& device, Frames given, ScanOrigin origin,
                  const std::string& source, const std::vector<std::string>& notes,
                  const ParseOptions& options) {
    auto frames = std::make_unique<Frames>(std::move(given));
    const std::vector<Mat4>& poses = frames->poses();  // these live as long as what is returned
    const bool posed = frames->posed();
    Observation out;
    out.origin = origin;
    out.camera_up = io::mean_camera_up(poses);
    out.doubts = notes;
    out.frames = std::move(frames);
    fuse_frames(device, posed ? std::span(poses) : std::span<const Mat4>(), source, options, out);
    if (out.cloud.size() == 0)
        throw Error(ErrorKind::input, io::path_text(source) + ": no points were found; " +
                                          depth_scale_hint(*out.frames, out.origin));
    return out;
}

}  // namespace

double typical_depth(const FrameStream& frames, ThreadPool& threads) {
    std::vector<double> depths;
    const double scale = frames.intrinsics().depth_scale;
    const auto add = [&](const DepthFrame& frame, std::size_t) {
        for (std::size_t i = 0; i < frame.depth.size(); i += 37)
            if (frame.depth[i]) depths.push_back(frame.depth[i] / scale);
    };
    for_each_frame(frames, threads, add, {.step = std::max<std::size_t>(1, frames.size() / 8)});
    return upper_median(depths);
}

double cell_for_frames(const Intrinsics& k, double typical_depth_m) {
    if (typical_depth_m <= 0) return 0.01;
    const double noise = depth_sigma(typical_depth_m);
    return std::clamp(std::max(1.5 * typical_depth_m / k.fx, 1.2 * noise), least_cell_m, 0.015);
}

std::string depth_scale_hint(const FrameStream& frames, ScanOrigin origin) {
    ThreadPool alone(1);
    return depth_scale_hint(frames.size(), frames.intrinsics().depth_scale,
                            typical_depth(frames, alone), origin);
}

void for_each_frame(const FrameStream& frames, ThreadPool& threads,
                    const std::function<void(DepthFrame, std::size_t)>& use,
                    const WhichFrames& which) {
    const auto load = [&](std::size_t i) {
        return which.coloured ? frames.load_coloured(i) : frames.load(i);
    };
    if (frames.one_by_one()) {
        for (std::size_t i = 0; i < frames.size(); i += which.step) use(load(i), i);
        return;
    }
    struct Decoded {
        std::size_t number;
        DepthFrame frame;
        std::exception_ptr error;
    };
    for (std::size_t first = 0; first < frames.size();) {
        std::vector<Decoded> batch;
        for (; batch.size() < threads.threads() && first < frames.size(); first += which.step)
            batch.push_back({first, {}, {}});
        threads.each(batch.size(), 1, [&](std::size_t i) {
            try {
                batch[i].frame = load(batch[i].number);
            } catch (...) {
                batch[i].error = std::current_exception();
            }
        });
        for (Decoded& decoded : batch) {
            if (decoded.error) std::rethrow_exception(decoded.error);
            use(std::move(decoded.frame), decoded.number);
        }
    }
}

Observation observe_folder(device::Device& device, const std::filesystem::path& folder,
                           const ParseOptions& options) {
    if (options.unit_m != 1) {
        throw Error(ErrorKind::usage,
                    "unit_m (--unit) is for point clouds, meshes and maps; depth frames have "
                    "their unit in intrinsics.json, as depth_scale");
    }
    io::FrameSequence frames = io::FrameSequence::open(folder);
    const std::vector<std::string> notes = frames.colours().notes();
    return fused(device, std::move(frames), ScanOrigin::frames_folder, folder.string(), notes,
                 options);
}

Observation observe_frames(device::Device& device, const FramesView& frames,
                           const ParseOptions& options) {
    if (options.unit_m != 1) {
        throw Error(ErrorKind::usage,
                    "unit_m (--unit) is for files; depth frames have their unit in their "
                    "intrinsics, as depth_scale");
    }
    CallerFrames given(frames);
    const std::string source = given.source();
    const std::vector<std::string> notes = given.notes();
    return fused(device, std::move(given), ScanOrigin::frames_in_memory, source, notes, options);
}

}  // namespace topple
