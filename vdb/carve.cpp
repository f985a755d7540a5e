// SPDX-License-Identifier: MIT
#include "carve.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "carve_leaves.hpp"
#include "core/depth_noise.h"
#include "core/short_number.h"
#include "core/thread_pool.h"
#include "topple/error.h"
#include "topple/kernels/buffer.h"
#include "topple/kernels/queue.h"
#include "vdb/depth_pyramid.h"
#include "vdb/grids.h"
#include "vdb/view_leaves.h"

// Visibility carving: what the frames say about leaves, then about the voxels of mixed ones.
namespace topple::vdb {
namespace {

constexpr std::uint64_t batch_frames = 32;                        // one bit of a word each
constexpr std::uint64_t resident_bytes = std::uint64_t{1} << 28;  // frames on the device at a time
constexpr std::uint64_t leaf_chunk = std::uint64_t{1} << 18;      // leaves classified at a time
constexpr std::uint64_t voxel_chunk = std::uint64_t{1} << 13;     // leaves counted at a time
constexpr std::size_t max_slots = std::size_t{1} << 21;

// When a voxel counts as seen through. It is in front of a reading where it is closer by half its
// diagonal and so many standard deviations of the reading, beyond which one in 44 is.
constexpr double noise_sigmas = 2;
// One frame that sees through a voxel without points makes it empty, as in the paper. One that
// holds points takes some, and more than so many times as many as see a surface in it: then they
// are flying points. Set by hand.
constexpr std::uint32_t least_through = 1, least_through_points = 3;
constexpr double flying_ratio = 2;

// Up to 32 frames on the device.
struct Batch {
    std::uint32_t frames = 0;
    device::Buffer<float> camera;
    device::Buffer<std::uint32_t> pyramid;
};

void check(const Intrinsics& k, std::span<const DepthFrame> frames, const device::Device& device) {
    const bool sane = k.width >= 2 && k.height >= 2 && k.width <= 65536 && k.height <= 65536 &&
                      k.fx > 0 && k.fy > 0 && std::isfinite(k.fx) && std::isfinite(k.fy) &&
                      std::isfinite(k.cx) && std::isfinite(k.cy) && k.depth_scale > 0 &&
                      std::isfinite(k.depth_scale);
    if (!sane) {
        throw Error(ErrorKind::input,
                    "intrinsics: need at least 2x2 pixels and positive, finite fx, fy and "
                    "depth_scale");
    }
    if (pyramid_words(k) * 4 > device.info().limits.max_binding_bytes) {
        throw Error(ErrorKind::input, "depth frames of " + std::to_string(k.width) + "x" +
                                          std::to_string(k.height) + " pixels exceed the " +
                                          std::to_string(device.info().limits.max_binding_bytes) +
                                          " bytes that the device can bind; scale them down");
    }
    for (std::size_t n = 0; n < frames.size(); ++n) {
        const std::string where = "depth frame " + std::to_string(n);
        if (frames[n].depth.size() != std::uint64_t{k.width} * k.height) {
            throw Error(ErrorKind::input, where + ": " + std::to_string(frames[n].depth.size()) +
                                              " pixels, but the intrinsics say " +
                                              std::to_string(k.width) + "x" +
                                              std::to_string(k.height));
        }
        for (const double value : frames[n].camera_to_world) {
            if (!std::isfinite(value))
                throw Error(ErrorKind::input, where + ": its pose is not finite");
        }
    }
}

// One call of VoxelScene::carve.
class Carver {
  public:
    Carver(device::Device& device, VoxelScene::Grids& grids, const Intrinsics& intrinsics)
        : device_(device), g_(grids), intrinsics_(intrinsics), words_(pyramid_words(intrinsics)) {
        auto& p = params_;
        p.width = intrinsics.width - 1;
        p.height = intrinsics.height - 1;
        p.frame_words = static_cast<std::uint32_t>(words_);
        p.near_m = 0.02f;
        p.metres_per_unit = static_cast<float>(1 / intrinsics.depth_scale);
        p.margin_m = static_cast<float>(g_.frame.voxel_m * std::sqrt(3.0) / 2 +
                                        0.5 / intrinsics.depth_scale);
        p.noise_base_m = static_cast<float>(noise_sigmas * least_depth_sigma);
        p.noise_growth = static_cast<float>(noise_sigmas * depth_sigma_growth);
        p.noise_from_m = static_cast<float>(depth_sigma_grows_from);
        p.slack_m = static_cast<float>(g_.frame.voxel_m * 0.02);
    }

    void carve(std::span<const DepthFrame> frames) {
        upload(frames);
        std::vector<std::uint64_t> leaves = leaves_in_view(g_.leaves, cones_, params_);
        std::erase_if(leaves, [&](std::uint64_t leaf) {
            return g_.evidence.kind[leaf] == Evidence::Kind::empty;
        });
        for (std::size_t first = 0; first < leaves.size(); first += leaf_chunk) {
            classify(std::span(leaves).subspan(
                first, std::min<std::size_t>(leaf_chunk, leaves.size() - first)));
        }
    }

  private:
    void upload(std::span<const DepthFrame> frames);
    double deepest(std::span<const std::uint32_t> pyramid) const;
    void classify(std::span<const std::uint64_t> leaves);
    void count(std::span<const std::uint64_t> leaves,
               const std::vector<std::vector<std::uint32_t>>& mixed);
    void judge(std::uint64_t leaf, std::span<const std::uint32_t> evidence);
    void make_empty(std::uint64_t leaf);
    bool has_points(std::uint64_t leaf) const {
        return g_.points.probeConstLeaf(origin_of(g_.leaves.leaf_at(leaf))) != nullptr;
    }
    // Lowest voxels of leaves, relative to the reference, on the device.
    std::array<device::Buffer<std::int32_t>, 3> origins(
        std::span<const std::uint64_t> leaves) const;

    device::Device& device_;
    VoxelScene::Grids& g_;
    const Intrinsics& intrinsics_;
    std::uint64_t words_;
    kernels::CarveParams params_{};
    std::vector<Batch> batches_;
    std::vector<ViewCone> cones_;  // of all batches' frames
};

// How deep a frame sees, from the word that holds the least and largest of all its readings.
double Carver::deepest(std::span<const std::uint32_t> pyramid) const {
    const std::uint32_t high = pyramid.back() >> 16;
    if (high == 0) return -1;
    const double depth = high * double{params_.metres_per_unit};
    const double far = std::max(depth - params_.noise_from_m, 0.0);
    return depth + params_.margin_m + params_.noise_base_m + params_.noise_growth * far * far;
}

void Carver::upload(std::span<const DepthFrame> frames) {
    const std::uint64_t fit = device_.info().limits.max_binding_bytes / (words_ * 4);
    const std::uint64_t step =
        std::min({batch_frames, fit, std::max<std::uint64_t>(1, resident_bytes / (words_ * 4))});
    std::vector<std::uint32_t> words;
    std::vector<float> rows;
    batches_.clear();
    cones_.clear();
    for (std::size_t first = 0; first < frames.size(); first += step) {
        const auto some = frames.subspan(first, std::min<std::size_t>(step, frames.size() - first));
        words.resize(some.size() * words_);
        rows.clear();
        device_.threads().each(some.size(), 1, [&](std::size_t n) {
            build_pyramid(intrinsics_, some[n].depth, {words.data() + n * words_, words_});
        });
        for (std::size_t n = 0; n < some.size(); ++n) {
            const auto camera =
                camera_rows(g_.frame, g_.leaves.reference(), intrinsics_, some[n].camera_to_world);
            rows.insert(rows.end(), camera.begin(), camera.end());
            cones_.push_back({camera, deepest({words.data() + n * words_, words_})});
        }
        batches_.push_back({static_cast<std::uint32_t>(some.size()),
                            {device_, std::span<const float>(rows), "cameras"},
                            {device_, std::span<const std::uint32_t>(words), "depth frames"}});
    }
}

std::array<device::Buffer<std::int32_t>, 3> Carver::origins(
    std::span<const std::uint64_t> leaves) const {
    const auto reference = g_.leaves.reference();
    std::array<std::vector<std::int32_t>, 3> at;
    for (const std::uint64_t leaf : leaves) {
        const auto place = g_.leaves.leaf_at(leaf);
        for (int a = 0; a < 3; ++a) at[a].push_back(place[a] * 8 - reference[a]);
    }
    std::array<device::Buffer<std::int32_t>, 3> buffers;
    for (int a = 0; a < 3; ++a)
        buffers[a] = {device_, std::span<const std::int32_t>(at[a]), "leaf origins"};
    return buffers;
}

void Carver::classify(std::span<const std::uint64_t> leaves) {
    const auto origin = origins(leaves);
    std::vector<std::uint32_t> holds(leaves.size());
    for (std::size_t n = 0; n < leaves.size(); ++n) holds[n] = has_points(leaves[n]);
    const device::Buffer<std::uint32_t> points(device_, std::span<const std::uint32_t>(holds),
                                               "leaves with points");
    std::vector<device::Buffer<std::uint32_t>> mixed_words, front_words;
    params_.leaf_count = static_cast<std::uint32_t>(leaves.size());
    device::Queue queue(device_);
    for (const Batch& batch : batches_) {
        mixed_words.emplace_back(device_, leaves.size(), "mixed leaves");
        front_words.emplace_back(device_, leaves.size(), "leaves seen through");
        params_.frame_count = batch.frames;
        queue.add<kernels::CarveLeaves>(leaves.size(),
                                        {.leaf_x = origin[0],
                                         .leaf_y = origin[1],
                                         .leaf_z = origin[2],
                                         .points = points,
                                         .camera = batch.camera,
                                         .pyramid = batch.pyramid,
                                         .mixed = mixed_words.back(),
                                         .front = front_words.back()},
                                        params_);
    }
    queue.run();

    std::vector<std::vector<std::uint32_t>> mixed, front;
    for (std::size_t b = 0; b < batches_.size(); ++b) {
        mixed.push_back(mixed_words[b].download());
        front.push_back(front_words[b].download());
    }
    Evidence& e = g_.evidence;
    // Leaves to look into, and their frames, by batch.
    std::vector<std::uint64_t> detailed;
    std::vector<std::vector<std::uint32_t>> detailed_mixed(batches_.size());
    for (std::size_t n = 0; n < leaves.size(); ++n) {
        const std::uint64_t leaf = leaves[n];
        std::uint32_t any = 0, through = e.front[leaf];
        for (std::size_t b = 0; b < batches_.size(); ++b) {
            any |= mixed[b][n];
            through += static_cast<std::uint32_t>(std::popcount(front[b][n]));
        }
        const bool changed = through != e.front[leaf];
        e.front[leaf] = static_cast<std::uint16_t>(std::min(through, 65535u));
        if (through >= least_through && !holds[n]) {
            make_empty(leaf);
        } else if (any != 0 || (changed && (holds[n] || e.slot[leaf] >= 0))) {
            detailed.push_back(leaf);
            for (std::size_t b = 0; b < batches_.size(); ++b)
                detailed_mixed[b].push_back(mixed[b][n]);
        }
    }
    for (std::size_t first = 0; first < detailed.size(); first += voxel_chunk) {
        const std::size_t size = std::min<std::size_t>(voxel_chunk, detailed.size() - first);
        std::vector<std::vector<std::uint32_t>> part;
        for (const auto& bits : detailed_mixed) {
            part.emplace_back(bits.begin() + static_cast<std::ptrdiff_t>(first),
                              bits.begin() + static_cast<std::ptrdiff_t>(first + size));
        }
        count({detailed.data() + first, size}, part);
    }
}

void Carver::count(std::span<const std::uint64_t> leaves,
                   const std::vector<std::vector<std::uint32_t>>& mixed) {
    Evidence& e = g_.evidence;
    std::vector<std::uint32_t> evidence(leaves.size() * 512, 0);
    for (std::size_t n = 0; n < leaves.size(); ++n) {
        const std::int32_t slot = e.slot[leaves[n]];
        if (slot < 0) continue;
        const auto& from = e.voxels[slot];
        std::copy(from.begin(), from.end(),
                  evidence.begin() + static_cast<std::ptrdiff_t>(n * 512));
    }
    const auto origin = origins(leaves);
    device::Buffer<std::uint32_t> words(device_, std::span<const std::uint32_t>(evidence),
                                        "carving evidence");
    std::vector<device::Buffer<std::uint32_t>> bits;
    params_.leaf_count = static_cast<std::uint32_t>(leaves.size());
    device::Queue queue(device_);
    for (std::size_t b = 0; b < batches_.size(); ++b) {
        bits.emplace_back(device_, std::span<const std::uint32_t>(mixed[b]),
                          "frames of mixed leaves");
        params_.frame_count = batches_[b].frames;
        queue.add<kernels::Carve>(leaves.size() * 512,
                                  {.leaf_x = origin[0],
                                   .leaf_y = origin[1],
                                   .leaf_z = origin[2],
                                   .mixed = bits.back(),
                                   .camera = batches_[b].camera,
                                   .pyramid = batches_[b].pyramid,
                                   .evidence = words},
                                  params_);
    }
    queue.run();
    words.download(std::span<std::uint32_t>(evidence));
    for (std::size_t n = 0; n < leaves.size(); ++n) {
        judge(leaves[n], std::span<const std::uint32_t>(evidence).subspan(n * 512, 512));
    }
}

void Carver::make_empty(std::uint64_t leaf) {
    Evidence& e = g_.evidence;
    e.kind[leaf] = Evidence::Kind::empty;
    if (e.slot[leaf] >= 0) {
        e.free_slots.push_back(e.slot[leaf]);
        e.slot[leaf] = -1;
    }
    g_.state->tree().addTile(1, origin_of(g_.leaves.leaf_at(leaf)),
                             static_cast<std::int32_t>(State::empty), false);
}

// Turns a leaf's counts into states.
void Carver::judge(std::uint64_t leaf, std::span<const std::uint32_t> evidence) {
    Evidence& e = g_.evidence;
    const auto origin = origin_of(g_.leaves.leaf_at(leaf));
    const auto* points = g_.points.probeConstLeaf(origin);
    const std::uint32_t front = e.front[leaf];
    if (!points) {
        std::size_t empty = 0, seen = 0;
        for (const std::uint32_t word : evidence) {
            empty += front + (word & 0xffff) >= least_through;
            seen += (word & 0xffff) != 0;
        }
        if (empty == evidence.size()) return make_empty(leaf);
        if (seen == 0) return;
    }
    if (e.slot[leaf] < 0) {
        if (e.free_slots.empty()) {
            if (e.voxels.size() >= max_slots) {
                throw Error(ErrorKind::input, "carving needs more than " +
                                                  std::to_string(max_slots) +
                                                  " blocks of 8x8x8 voxels in detail; use a "
                                                  "voxel_m (--voxel) larger than " +
                                                  short_number(g_.frame.voxel_m));
            }
            e.free_slots.push_back(static_cast<std::int32_t>(e.voxels.size()));
            e.voxels.emplace_back();
        }
        e.slot[leaf] = e.free_slots.back();
        e.free_slots.pop_back();
    }
    e.kind[leaf] = Evidence::Kind::detailed;
    e.voxels[e.slot[leaf]].assign(evidence.begin(), evidence.end());

    auto* state = g_.state->tree().touchLeaf(origin);
    for (openvdb::Index v = 0; v < 512; ++v) {
        const std::uint32_t through = front + (evidence[v] & 0xffff), hit = evidence[v] >> 16;
        if (points && points->isValueOn(v)) {
            const bool flying = through >= least_through_points && through > flying_ratio * hit;
            if (flying) {
                state->setValueOff(v, static_cast<std::int32_t>(State::empty));
            } else {
                state->setValueOn(v, static_cast<std::int32_t>(State::surface));
            }
        } else {
            const bool empty = through >= least_through;
            state->setValueOff(v,
                               static_cast<std::int32_t>(empty ? State::empty : State::invisible));
        }
    }
}

}  // namespace

void VoxelScene::carve(device::Device& device, const Intrinsics& intrinsics,
                       std::span<const DepthFrame> frames) {
    check(intrinsics, frames, device);
    Grids& g = *grids_;
    clear_completed();
    const auto size = g.leaves.size();
    if (g.evidence.kind.size() != size) {
        g.evidence.kind.assign(size, Evidence::Kind::invisible);
        g.evidence.front.assign(size, 0);
        g.evidence.slot.assign(size, -1);
    }
    const std::uint64_t frame_bytes = pyramid_words(intrinsics) * 4;
    const std::size_t step =
        static_cast<std::size_t>(std::max<std::uint64_t>(1, resident_bytes / frame_bytes));
    Carver carver(device, g, intrinsics);
    for (std::size_t first = 0; first < frames.size(); first += step) {
        carver.carve(frames.subspan(first, std::min(step, frames.size() - first)));
    }
}

}  // namespace topple::vdb
