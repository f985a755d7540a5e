// SPDX-License-Identifier: MIT
#include "export/colour_texture.h"

#include <png.h>

#include <vector>

#include "topple/error.h"

namespace topple::exports {
namespace {

constexpr std::uint32_t levels = 16, side = 64;
static_assert(levels * levels * levels == side * side);

}  // namespace

std::uint32_t texel_of(const Rgb8& colour) {
    std::uint32_t out = 0;
    for (const std::uint8_t channel : colour)
        out = out * levels + (channel * (levels - 1) + 127) / 255;
    return out;
}

std::array<double, 2> middle_of_texel(std::uint32_t texel) {
    return {(texel % side + 0.5) / side, 1 - (texel / side + 0.5) / side};
}

std::string colour_texture() {
    std::vector<std::uint8_t> pixels;
    constexpr std::uint32_t step = 255 / (levels - 1);
    for (std::uint32_t texel = 0; texel < side * side; ++texel)
        for (const std::uint32_t channel :
             {texel / (levels * levels), texel / levels % levels, texel % levels})
            pixels.push_back(static_cast<std::uint8_t>(channel * step));
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = image.height = side;
    image.format = PNG_FORMAT_RGB;
    // Else the file says that it is sRGB, as every picture is, and MuJoCo makes it linear and dark.
    image.flags = PNG_IMAGE_FLAG_COLORSPACE_NOT_sRGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string out(size, '\0');
    if (png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
        throw Error(ErrorKind::input, "no memory for a texture");
    out.resize(size);
    return out;
}

}  // namespace topple::exports
