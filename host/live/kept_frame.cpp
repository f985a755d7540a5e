// SPDX-License-Identifier: MIT
#include "live/kept_frame.h"

#include <libdeflate.h>

#include <memory>
#include <new>

#include "topple/error.h"

namespace topple::live {
namespace {

// How far each value is from the one `step` before it in its row, modulo 2^bits: mostly little, so
// that it takes few bits.
template <class Value>
void to_differences(std::vector<Value>& values, std::size_t row, std::size_t step) {
    for (std::size_t first = 0; first < values.size(); first += row)
        for (std::size_t n = row; n-- > step;)
            values[first + n] = static_cast<Value>(values[first + n] - values[first + n - step]);
}
template <class Value>
void to_values(std::vector<Value>& differences, std::size_t row, std::size_t step) {
    for (std::size_t first = 0; first < differences.size(); first += row)
        for (std::size_t n = step; n < row; ++n)
            differences[first + n] =
                static_cast<Value>(differences[first + n] + differences[first + n - step]);
}

}  // namespace

Packed::Packed(const std::vector<std::uint8_t>& bytes) : unpacked_bytes_(bytes.size()) {
    if (bytes.empty()) return;
    constexpr int quickest = 1;
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(quickest), &libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::vector<std::uint8_t> room(
        libdeflate_deflate_compress_bound(compressor.get(), bytes.size()));
    const std::size_t size = libdeflate_deflate_compress(compressor.get(), bytes.data(),
                                                         bytes.size(), room.data(), room.size());
    packed_.assign(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size));
}

std::vector<std::uint8_t> Packed::unpacked() const {
    std::vector<std::uint8_t> out(unpacked_bytes_);
    if (out.empty()) return out;
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
        decompressor(libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
    if (!decompressor) throw std::bad_alloc();
    if (libdeflate_deflate_decompress(decompressor.get(), packed_.data(), packed_.size(),
                                      out.data(), out.size(), nullptr) != LIBDEFLATE_SUCCESS)
        throw Error(ErrorKind::input, "a kept frame can't be unpacked: it is damaged");
    return out;
}

KeptFrame::KeptFrame(const DepthFrame& frame, std::uint32_t width) : width_(width) {
    std::vector<std::uint16_t> depth = frame.depth;
    to_differences(depth, width, 1);
    // Lower bytes, then upper ones, most of which are 0 or 255.
    std::vector<std::uint8_t> bytes(2 * depth.size());
    for (std::size_t n = 0; n < depth.size(); ++n) {
        bytes[n] = static_cast<std::uint8_t>(depth[n] & 0xFF);
        bytes[depth.size() + n] = static_cast<std::uint8_t>(depth[n] >> 8);
    }
    depth_ = Packed(bytes);
    std::vector<std::uint8_t> colour = frame.rgb;
    to_differences(colour, std::size_t{3} * width, 3);
    colour_ = Packed(colour);
}

DepthFrame KeptFrame::depth_frame() const {
    DepthFrame out;
    const std::vector<std::uint8_t> bytes = depth_.unpacked();
    out.depth.resize(bytes.size() / 2);
    for (std::size_t n = 0; n < out.depth.size(); ++n)
        out.depth[n] = static_cast<std::uint16_t>(bytes[n] | bytes[out.depth.size() + n] << 8);
    to_values(out.depth, width_, 1);
    return out;
}

DepthFrame KeptFrame::frame() const {
    DepthFrame out = depth_frame();
    out.rgb = colour_.unpacked();
    to_values(out.rgb, std::size_t{3} * width_, 3);
    return out;
}

}  // namespace topple::live
