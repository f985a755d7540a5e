// SPDX-License-Identifier: MIT
#include "solids/space_carving.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>
#include <vector>

#include "core/thread_pool.h"
#include "points/view_coverage.h"
#include "points/voxel_size.h"

namespace topple {
namespace {

// Frames are carved in batches of this many bytes of depth, so that any number of them fits.
constexpr std::uint64_t batch_bytes = 32u << 20;

constexpr std::chrono::milliseconds between_looks{20};  // at whether carving beside has ended

struct Stopped {};

}  // namespace

SpaceCarving::SpaceCarving(device::Device& device, const Observation& input,
                           const vdb::VoxelFrame& frame)
    : device_(device), input_(input), frame_(frame) {
    const bool beside = input.frames && !input.frames->one_by_one() && !closes_gaps() &&
                        device.threads().threads() > 1;
    if (beside) begin();
}

SpaceCarving::~SpaceCarving() {
    stop_.request_stop();
}

void SpaceCarving::begin() {
    try {
        beside_ = std::async(std::launch::async, [this] {
            const ThreadPool::Beside one_more(device_.threads());
            Carved out{std::make_shared<vdb::VoxelScene>(frame_, input_.cloud)};
            out.from_around = carve(*out.scene, [this](double) {
                if (stop_.stop_requested()) throw Stopped{};
            });
            return out;
        });
    } catch (const std::system_error&) {
        // The system has no more threads: finish() does it all.
    }
}

bool SpaceCarving::closes_gaps() const {
    return frame_.voxel_m < closing_cells * std::max(input_.cell_m, input_.sparse_cell_m);
}

bool SpaceCarving::carve(vdb::VoxelScene& scene,
                         const std::function<void(double)>& progress) const {
    const FrameStream& frames = *input_.frames;
    ViewCoverage coverage(frame_.grid_from_input);
    const Intrinsics& k = frames.intrinsics();
    const std::uint64_t frame_bytes = std::uint64_t{2} * k.width * k.height;
    const std::size_t per_batch =
        static_cast<std::size_t>(std::clamp<std::uint64_t>(batch_bytes / frame_bytes, 1, 512));
    std::vector<DepthFrame> batch;
    for_each_frame(frames, device_.threads(), [&](DepthFrame frame, std::size_t f) {
        batch.push_back(std::move(frame));
        coverage.add(batch.back().camera_to_world);
        if (batch.size() < per_batch && f + 1 < frames.size()) return;
        scene.carve(device_, k, batch);
        batch.clear();
        progress(static_cast<double>(f + 1) / static_cast<double>(frames.size()));
    });
    return coverage.from_around();
}

SpaceCarving::Carved SpaceCarving::take_carved(const Marks& marks) {
    while (beside_.wait_for(between_looks) == std::future_status::timeout) device_.threads().poll();
    Carved out = beside_.get();
    out.scene->set_labels(input_.cloud, marks.label, marks.seen_side);
    return out;
}

SpaceCarving::Carved SpaceCarving::finish(const Marks& marks, const geometry::GapPoints& gaps,
                                          StageClock& stage) {
    Carved out;
    const bool beside = beside_.valid();
    if (!beside) {
        out.scene = stage("voxels", [&] {
            const auto of = [&](const CloudView& cloud) {
                return std::make_shared<vdb::VoxelScene>(frame_, cloud, marks.label,
                                                         marks.seen_side);
            };
            return gaps.size() == 0 ? of(input_.cloud)
                                    : of(geometry::with_gaps(input_.cloud, gaps));
        });
    }
    stage("carving", [&] {
        if (beside) {
            out = take_carved(marks);
        } else if (input_.frames) {
            out.from_around =
                carve(*out.scene, [&](double done) { stage.progress("carving", done); });
        }
        if (input_.space) out.scene->set_free(*input_.space);
    });
    return out;
}

}  // namespace topple
