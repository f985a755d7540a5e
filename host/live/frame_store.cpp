// SPDX-License-Identifier: MIT
#include "live/frame_store.h"

#include <algorithm>
#include <cmath>

#include "points/formats/rigid_pose.h"
#include "topple/error.h"

namespace topple::live {
namespace {

[[noreturn]] void no_such(FrameId frame) {
    throw Error(ErrorKind::usage, "session: there is no " + name_of(frame));
}

std::uint64_t bytes_of(const PosedFrame& kept) {
    return kept.frame->bytes() + kept.image->depth.size() * sizeof(std::uint16_t);
}

// How far apart two cameras are: 1 for 5 cm, or for 5 degrees.
double apart(const Mat4& a, const Mat4& b) {
    constexpr double metres = 0.05, radians = 5 * M_PI / 180;
    double trace = 0, square = 0;
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) trace += a[4 * r + c] * b[4 * r + c];
        square += (a[4 * r + 3] - b[4 * r + 3]) * (a[4 * r + 3] - b[4 * r + 3]);
    }
    return std::sqrt(square) / metres + std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)) / radians;
}

}  // namespace

std::string name_of(FrameId frame) {
    return "frame " + std::to_string(frame);
}

DepthFrame posed_image(const PosedFrame& kept) {
    DepthFrame out = *kept.image;
    out.camera_to_world = kept.pose;
    return out;
}

FrameStore::FrameStore(KeptFrames from, std::uint64_t most_bytes,
                       std::function<DepthFrame(const KeptFrame&)> image)
    : frames_(std::move(from)), most_bytes_(most_bytes), image_(std::move(image)) {
    for (auto& [frame, kept] : frames_.kept) {
        kept.image = std::make_shared<const DepthFrame>(image_(*kept.frame));
        bytes_ += bytes_of(kept);
    }
    changes_ = frames_.kept.size();
    keep_to_limit();
}

FrameId FrameStore::add(Checksum& readings, const Mat4& rigid, const Mat4& given,
                        const std::function<std::shared_ptr<const KeptFrame>()>& made) {
    readings.add(rigid.data(), sizeof(rigid));
    if (readings.value() == frames_.last)
        throw Error(ErrorKind::input, name_of(frames_.next) + ": it is the frame before once more");
    PosedFrame kept{made(), given};
    kept.image = std::make_shared<const DepthFrame>(image_(*kept.frame));
    const std::lock_guard lock(mutex_);
    frames_.last = readings.value();
    bytes_ += bytes_of(kept);
    frames_.kept[frames_.next] = std::move(kept);
    ++changes_;
    keep_to_limit();
    return frames_.next++;
}

void FrameStore::skip() {
    const std::lock_guard lock(mutex_);
    ++frames_.next;
}

void FrameStore::correct(const std::map<FrameId, Mat4>& poses) {
    for (auto [frame, pose] : poses) {
        if (frame >= frames_.next) no_such(frame);
        if (const auto fault = io::make_rigid(pose))
            throw Error(ErrorKind::input, name_of(frame) + ": camera_to_world: " + *fault);
    }
    const std::lock_guard lock(mutex_);
    for (const auto& [frame, pose] : poses) {
        const auto kept = frames_.kept.find(frame);
        if (kept == frames_.kept.end() || kept->second.pose == pose) continue;
        kept->second.pose = pose;
        ++changes_;
    }
}

void FrameStore::forget(FrameId frame) {
    const std::lock_guard lock(mutex_);
    const auto kept = frames_.kept.find(frame);
    if (kept == frames_.kept.end()) no_such(frame);
    if (frame + 1 == frames_.next) frames_.last = {};  // it may come once more
    drop(kept);
}

std::vector<FrameId> FrameStore::ids() const {
    const std::lock_guard lock(mutex_);
    std::vector<FrameId> out;
    for (const auto& [frame, kept] : frames_.kept) out.push_back(frame);
    return out;
}

std::uint64_t FrameStore::bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
}

void FrameStore::need_some() const {
    if (frames_.kept.empty())
        throw Error(ErrorKind::input, "session: there are no frames yet; add some first");
}

void FrameStore::need_any() const {
    const std::lock_guard lock(mutex_);
    need_some();
}

std::pair<Frames, std::uint64_t> FrameStore::snapshot() const {
    const std::lock_guard lock(mutex_);
    need_some();
    return {frames_.kept, changes_};
}

std::uint64_t FrameStore::changes() const {
    const std::lock_guard lock(mutex_);
    return changes_;
}

KeptFrames FrameStore::all() const {
    const std::lock_guard lock(mutex_);
    return frames_;
}

void FrameStore::drop(Frames::iterator kept) {
    bytes_ -= bytes_of(kept->second);
    frames_.kept.erase(kept);
    ++changes_;
}

void FrameStore::keep_to_limit() {
    while (bytes_ > most_bytes_ && frames_.kept.size() > 1) drop_least_missed();
}

// The earlier of the two whose cameras are nearest to one another: what is new stays.
void FrameStore::drop_least_missed() {
    auto least = frames_.kept.begin();
    double nearest = INFINITY;
    for (auto at = least, next = std::next(at); next != frames_.kept.end(); ++at, ++next) {
        const double far = apart(at->second.pose, next->second.pose);
        if (far >= nearest) continue;
        nearest = far;
        least = at;
    }
    drop(least);
}

}  // namespace topple::live
