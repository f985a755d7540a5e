// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/open_file.h"
#include "points/formats/colour_image.h"
#include "topple/input.h"

namespace topple::io {

// What took the colour images: the camera `own`, or, without it, one with the depth images'
// intrinsics, scaled to their size.
struct ColourCamera {
    Intrinsics depth;
    std::optional<Intrinsics> own;

    // What is wrong with an image of that size, if anything: "is 4 x 3 pixels, but ..". `mend`:
    // what to do where it has other proportions than the depth images.
    std::optional<std::string> size_fault(std::uint32_t width, std::uint32_t height,
                                          const std::string& mend) const;
    // What the pixels of the depth image look like, sRGB, 3 bytes each: the mean of what falls into
    // each; 0, 0, 0 where the image is black or does not reach.
    std::vector<std::uint8_t> seen_by_depth(const ColourImage& image) const;
};

// The colour images of a sequence folder: color/NAME.png, .jpg or .jpeg beside depth/NAME.png, seen
// from the same place in the same direction. They have the depth images' intrinsics, scaled to
// their size, or their own: an object "color_intrinsics" in intrinsics.json, or the file
// color/intrinsics.json.
class ColourFrames {
  public:
    // depth_images: the frames, of `depth`. Throws Error(input) where intrinsics are wrong; the
    // images are not opened.
    static ColourFrames open(const std::filesystem::path& folder,
                             const std::vector<FileName>& depth_images, const Intrinsics& depth);

    // What the pixels of depth image `index` look like; empty where it has no image. May be called
    // from several threads at once. Throws Error(input) naming the image where it is damaged, or of
    // another size than its intrinsics or other proportions than the depth images.
    std::vector<std::uint8_t> load(std::size_t index) const;

    // The image of depth image `index`; null where it has none.
    const FileName* file(std::size_t index) const;

    // What looks odd, in sentences.
    const std::vector<std::string>& notes() const { return notes_; }

  private:
    ColourCamera camera_;
    std::vector<std::optional<FileName>> images_;  // by frame; none: it has none
    std::vector<std::string> notes_;
};

// Nothing where the colour images have no intrinsics of their own. Throws Error(input).
std::optional<Intrinsics> read_colour_intrinsics(const std::filesystem::path& folder);

// `image`, which `camera` took, at the pixels of another camera in the same place.
std::vector<std::uint8_t> seen_by(const Intrinsics& other, const Intrinsics& camera,
                                  const ColourImage& image);

}  // namespace topple::io
