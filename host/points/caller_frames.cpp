// SPDX-License-Identifier: MIT
#include "points/caller_frames.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "io/text.h"
#include "points/formats/colour_frames.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/rigid_pose.h"
#include "topple/error.h"

namespace topple {
namespace {

constexpr double most_stored = std::numeric_limits<std::uint16_t>::max();

// The rows of an image, one after the other.
template <class Pixel, class To>
void copy_rows(const ImageView<Pixel>& from, To* to) {
    const std::size_t bytes = std::size_t{from.width()} * sizeof(Pixel);
    auto* at = reinterpret_cast<std::byte*>(to);
    for (std::uint32_t v = 0; v < from.height(); ++v, at += bytes)
        std::memcpy(at, from.row(v), bytes);
}

io::ColourImage image_of(const ImageView<Rgb>& from) {
    io::ColourImage out{from.width(), from.height(), {}};
    out.rgb.resize(std::size_t{3} * from.width() * from.height());
    copy_rows(from, out.rgb.data());
    return out;
}

}  // namespace

FrameView view_of(const DepthFrame& frame, const Intrinsics& k) {
    FrameView out;
    out.depth = {frame.depth.data(), k.width, k.height};
    if (!frame.rgb.empty())
        out.colour = {reinterpret_cast<const Rgb*>(frame.rgb.data()), k.width, k.height};
    return out;
}

CallerFrames::CallerFrames(const FramesView& frames)
    : from_(frames), source_(frames.source.empty() ? "frames" : frames.source) {
    if (!from_.images.empty() && from_.image)
        throw Error(ErrorKind::usage,
                    source_ + ": both images and the function image are given; give one of both");
    if (from_.images.empty() && !from_.image) refuse("there are none: images is empty");
    check_cameras();
    take_poses();
    for (std::size_t i = 0; i < from_.images.size(); ++i) check(i, from_.images[i]);
}

void CallerFrames::refuse(const std::string& why) const {
    throw Error(ErrorKind::input, source_ + ": " + why);
}

void CallerFrames::refuse(std::size_t frame, const std::string& why) const {
    // What names a frame that stands alone needs no number, which may be another one to the caller.
    if (from_.camera_to_world.size() <= 1 && !from_.source.empty()) refuse(why);
    refuse("frame " + std::to_string(frame) + ": " + why);
}

void CallerFrames::check_cameras() const {
    if (const auto fault = io::depth_intrinsics_fault(from_.intrinsics))
        refuse("intrinsics: " + *fault);
    if (!from_.colour_intrinsics) return;
    if (const auto fault = io::pinhole_fault(*from_.colour_intrinsics))
        refuse("colour_intrinsics: " + *fault);
}

void CallerFrames::take_poses() {
    const std::size_t images = from_.images.size();
    poses_ = from_.camera_to_world;
    if (poses_.empty()) {
        if (images > 1)
            refuse("there are " + std::to_string(images) +
                   " images but no poses; give camera_to_world of each, or one image");
        poses_.push_back(DepthFrame{}.camera_to_world);
        return;
    }
    if (images > 0 && images != poses_.size())
        refuse("there are " + io::counted(poses_.size(), "pose") + " for " +
               io::counted(images, "image") + "; camera_to_world must have one for each");
    for (std::size_t i = 0; i < poses_.size(); ++i)
        if (const auto fault = io::make_rigid(poses_[i])) refuse(i, "camera_to_world: " + *fault);
}

template <class Pixel>
void CallerFrames::check_rows(std::size_t i, const char* name,
                              const ImageView<Pixel>& image) const {
    if (!image.data()) refuse(i, std::string(name) + " is a null pointer");
    const auto row = static_cast<std::ptrdiff_t>(image.width() * sizeof(Pixel));
    const std::ptrdiff_t stride = image.stride_bytes();
    constexpr std::ptrdiff_t most = std::numeric_limits<std::ptrdiff_t>::max();
    const bool fits = (stride >= row || stride <= -row) && stride > -most / image.height() &&
                      stride < most / image.height();
    if (!fits)
        refuse(i, std::string(name) + ": its rows lie " + std::to_string(stride) +
                      " bytes apart, but each takes " + std::to_string(row));
}

void CallerFrames::check(std::size_t i, const FrameView& view) const {
    if (view.depth.empty() == view.depth_m.empty())
        refuse(i, std::string(view.depth.empty() ? "neither" : "both") +
                      " of depth and depth_m given; give one of both");
    const Intrinsics& k = from_.intrinsics;
    const auto check_depth = [&](const char* name, const auto& image) {
        if (image.width() != k.width || image.height() != k.height)
            refuse(i, std::string(name) + " is " + io::size_text(image.width(), image.height()) +
                          " pixels, but the intrinsics say " + io::size_text(k.width, k.height));
        check_rows(i, name, image);
    };
    if (view.depth.empty())
        check_depth("depth_m", view.depth_m);
    else
        check_depth("depth", view.depth);
    if (view.colour.empty()) return;
    const std::uint32_t width = view.colour.width(), height = view.colour.height();
    if (width == 0 || height == 0 || std::uint64_t{width} * height > io::most_image_pixels)
        refuse(i, "colour is " + io::size_text(width, height) + " pixels; expected 1 to " +
                      std::to_string(io::most_image_pixels) + " in all");
    const io::ColourCamera camera{k, from_.colour_intrinsics};
    if (const auto fault = camera.size_fault(width, height, "give colour_intrinsics"))
        refuse(i, "colour " + *fault);
    check_rows(i, "colour", view.colour);
}

FrameView CallerFrames::view(std::size_t i) const {
    if (!from_.images.empty()) return from_.images[i];  // checked already
    FrameView view = from_.image(i);
    check(i, view);
    return view;
}

// As sensors store it: what 16 bits can't hold is no reading.
std::vector<std::uint16_t> CallerFrames::stored_of(std::size_t i,
                                                   const ImageView<float>& metres) const {
    const double scale = from_.intrinsics.depth_scale;
    std::vector<float> row(metres.width());
    std::vector<std::uint16_t> out;
    out.reserve(std::size_t{metres.width()} * metres.height());
    std::size_t readings = 0, beyond = 0;
    for (std::uint32_t v = 0; v < metres.height(); ++v) {
        std::memcpy(row.data(), metres.row(v), row.size() * sizeof(float));
        for (const float z : row) {
            const double stored = std::nearbyint(double{z} * scale);
            const bool any = std::isfinite(z) && z > 0, held = any && stored <= most_stored;
            readings += held;
            beyond += any && !held;
            out.push_back(held ? static_cast<std::uint16_t>(stored) : std::uint16_t{0});
        }
    }
    if (readings == 0 && beyond > 0)
        refuse(i, "all readings of depth_m lie beyond " + io::short_number(most_stored / scale) +
                      " m, the farthest at a depth_scale of " + io::short_number(scale) +
                      "; give metres, or a smaller depth_scale");
    return out;
}

DepthFrame CallerFrames::depth_of(std::size_t i, const FrameView& view) const {
    DepthFrame frame;
    frame.camera_to_world = poses_[i];
    if (view.depth.empty()) {
        frame.depth = stored_of(i, view.depth_m);
    } else {
        frame.depth.resize(std::size_t{view.depth.width()} * view.depth.height());
        copy_rows(view.depth, frame.depth.data());
    }
    return frame;
}

DepthFrame CallerFrames::load(std::size_t i) const {
    return depth_of(i, view(i));
}

DepthFrame CallerFrames::load_coloured(std::size_t i) const {
    const FrameView seen = view(i);
    DepthFrame frame = depth_of(i, seen);
    const io::ColourCamera camera{from_.intrinsics, from_.colour_intrinsics};
    if (!seen.colour.empty()) frame.rgb = camera.seen_by_depth(image_of(seen.colour));
    return frame;
}

std::vector<std::string> CallerFrames::notes() const {
    std::size_t coloured = 0;
    for (const FrameView& image : from_.images) coloured += !image.colour.empty();
    if (coloured == 0 || coloured == from_.images.size()) return {};
    return {io::counted(from_.images.size() - coloured, "frame") + " of " +
            std::to_string(from_.images.size()) + " has no colours."};
}

}  // namespace topple
