// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "topple/input.h"

// Depth frames with poses where the caller keeps them: parsing them needs no folder of images, and
// gives the same as of one.
namespace topple {

// An image where the caller keeps it: rows of pixels without gaps, a fixed number of bytes apart.
// The bytes need no alignment. They must stay while the image is in use.
template <class Pixel>
class ImageView {
  public:
    ImageView() = default;
    // stride_bytes: from a row to the one below it, negative where they run upwards in memory; 0:
    // nothing lies between rows.
    ImageView(const Pixel* first, std::uint32_t width, std::uint32_t height,
              std::ptrdiff_t stride_bytes = 0) noexcept
        : first_(reinterpret_cast<const std::byte*>(first)),
          width_(width),
          height_(height),
          stride_(stride_bytes != 0 ? stride_bytes
                                    : static_cast<std::ptrdiff_t>(width * sizeof(Pixel))) {}

    bool empty() const { return !first_ && width_ == 0 && height_ == 0; }
    const std::byte* data() const { return first_; }  // of the upper left pixel
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    std::ptrdiff_t stride_bytes() const { return stride_; }
    const std::byte* row(std::uint32_t v) const {
        return first_ + static_cast<std::ptrdiff_t>(v) * stride_;
    }

  private:
    const std::byte* first_ = nullptr;
    std::uint32_t width_ = 0, height_ = 0;
    std::ptrdiff_t stride_ = 0;
};
using Rgb = std::array<std::uint8_t, 3>;

// What a camera saw at one time. Of depth and depth_m one is given, of the size that the intrinsics
// say: distances along the camera's axis.
struct FrameView {
    ImageView<std::uint16_t> depth;  // metres = value / depth_scale; 0: no reading
    // Metres, to be rounded to 1 / depth_scale; no reading: what is not finite, or not above 0, or
    // beyond 65535 / depth_scale.
    ImageView<float> depth_m;
    // sRGB, 0, 0, 0 where it is not known; or empty. Seen from the same place in the same
    // direction: of any size in the proportions of depth, or that of colour_intrinsics.
    ImageView<Rgb> colour;
};

// Frames of one camera, as a folder of them has (docs/formats.md).
struct FramesView {
    Intrinsics intrinsics;  // of the depth images
    // Of the colour images; none: the depth images', scaled to their size. Its depth_scale counts
    // for nothing.
    std::optional<Intrinsics> colour_intrinsics;
    // Of each frame, metres: rotations to 1e-3, which are made so exactly. None: there is a single
    // frame, whose camera is the origin.
    std::vector<Mat4> camera_to_world;
    // One for each pose. The caller's memory must stay, unchanged, while they are parsed.
    std::vector<FrameView> images;
    // Or, where `images` is empty, what gives them, for frames that don't fit into memory together:
    // called for numbers from 0 on, on the thread that called the parse, more than once for each,
    // and always with the same answer. It must stay until the next call.
    std::function<FrameView(std::size_t)> image;
    std::string source;  // what messages call them, or the only one; empty: "frames"
};

}  // namespace topple
