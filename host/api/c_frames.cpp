// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "api/c_support.h"

namespace topple::c_api {
namespace {

// An image where the struct says that it lies; NULL: there is none.
template <class Pixel, class Value>
ImageView<Pixel> image_of(const Value* first, std::uint32_t width, std::uint32_t height,
                          std::int64_t stride_bytes) {
    if (!first) return {};
    return {reinterpret_cast<const Pixel*>(first), width, height,
            static_cast<std::ptrdiff_t>(stride_bytes)};
}

FrameView frame_of(const topple_frame& f, const Intrinsics& k) {
    const bool sized = f.rgb_width > 0 || f.rgb_height > 0;
    return {image_of<std::uint16_t>(f.depth, k.width, k.height, f.depth_stride_bytes),
            image_of<float>(f.depth_m, k.width, k.height, f.depth_stride_bytes),
            image_of<Rgb>(f.rgb, sized ? f.rgb_width : k.width, sized ? f.rgb_height : k.height,
                          f.rgb_stride_bytes)};
}

}  // namespace

Intrinsics intrinsics_of(const topple_intrinsics& from) {
    return {from.width, from.height, from.fx, from.fy, from.cx, from.cy, from.depth_scale};
}

FramesView frames_of(const topple_frames* frames) {
    const topple_frames f = known(&needed(frames, "frames"), {}, "frames");
    if (!f.frames && !f.load && f.count > 0)
        throw Error(ErrorKind::usage, "frames: frames and load are NULL; give one of both");
    if (f.frames && f.load)
        throw Error(ErrorKind::usage, "frames: both frames and load are given; give one of both");
    FramesView view;
    view.intrinsics = intrinsics_of(f.intrinsics);
    if (f.colour_intrinsics) view.colour_intrinsics = intrinsics_of(*f.colour_intrinsics);
    if (f.name) view.source = f.name;
    if (f.count != 1 && !f.camera_to_world)
        throw Error(ErrorKind::usage,
                    "frames: camera_to_world is NULL, which is for one frame, but count is " +
                        std::to_string(f.count));
    array(f.camera_to_world, "frames: camera_to_world", f.camera_to_world ? f.count : 0, 16);
    for (std::uint64_t n = 0; f.camera_to_world && n < f.count; ++n)
        std::copy_n(f.camera_to_world + 16 * n, 16, view.camera_to_world.emplace_back().begin());
    if (f.load) {
        view.image = [f, k = view.intrinsics](std::size_t n) {
            topple_frame frame{};
            frame.size = sizeof(frame);
            if (const int code = f.load(n, &frame, f.user))
                throw Error(ErrorKind::input, "frames: load() returned " + std::to_string(code) +
                                                  " for frame " + std::to_string(n));
            return frame_of(known(&frame, {}, "frame"), k);
        };
        return view;
    }
    if (f.frames) check_size<topple_frame>(f.frames->size, "frame");
    const auto* at = reinterpret_cast<const std::byte*>(f.frames);
    for (std::uint64_t n = 0; n < f.count; ++n, at += f.frames->size) {
        const auto* frame = reinterpret_cast<const topple_frame*>(at);
        if (frame->size != f.frames->size)
            throw Error(ErrorKind::usage, "frames: the size of frame " + std::to_string(n) +
                                              " is not that of the first");
        view.images.push_back(frame_of(known(frame, {}, "frame"), view.intrinsics));
    }
    return view;
}

}  // namespace topple::c_api

using topple::c_api::begin;

void topple_frame_init(topple_frame* frame, size_t size) {
    begin(frame, size);
}

void topple_frames_init(topple_frames* frames, size_t size) {
    begin(frames, size);
}
