// SPDX-License-Identifier: MIT
#include "live/kept_frame.h"

#include <libdeflate.h>

#include <bit>
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

// The lowest bytes of all values, then the next ones: those high up are mostly alike.
template <class Value>
std::vector<std::uint8_t> planes_of(const std::vector<Value>& values) {
    std::vector<std::uint8_t> out(sizeof(Value) * values.size());
    for (std::size_t byte = 0; byte < sizeof(Value); ++byte)
        for (std::size_t n = 0; n < values.size(); ++n)
            out[byte * values.size() + n] = static_cast<std::uint8_t>(values[n] >> 8 * byte);
    return out;
}
template <class Value>
std::vector<Value> values_of(const std::vector<std::uint8_t>& planes) {
    std::vector<Value> out(planes.size() / sizeof(Value), 0);
    for (std::size_t byte = 0; byte < sizeof(Value); ++byte)
        for (std::size_t n = 0; n < out.size(); ++n)
            out[n] = static_cast<Value>(out[n] | Value{planes[byte * out.size() + n]} << 8 * byte);
    return out;
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
    depth_ = Packed(planes_of(depth));
    std::vector<std::uint8_t> colour = frame.rgb;
    to_differences(colour, std::size_t{3} * width, 3);
    colour_ = Packed(colour);
}

DepthFrame KeptFrame::depth_frame() const {
    DepthFrame out;
    out.depth = values_of<std::uint16_t>(depth_.unpacked());
    to_values(out.depth, width_, 1);
    return out;
}

DepthFrame KeptFrame::frame() const {
    DepthFrame out = depth_frame();
    out.rgb = colour_.unpacked();
    to_values(out.rgb, std::size_t{3} * width_, 3);
    return out;
}

KeptFrame::KeptFrame(const PointCloud& points) {
    const std::size_t count = points.size();
    std::vector<std::uint32_t> places;
    for (const std::vector<float>* axis : {&points.x, &points.y, &points.z})
        for (const float value : *axis) places.push_back(std::bit_cast<std::uint32_t>(value));
    to_differences(places, count, 1);
    places_ = Packed(planes_of(places));
    if (points.red.empty()) return;
    std::vector<std::uint8_t> colour;
    for (const std::vector<std::uint8_t>* channel : {&points.red, &points.green, &points.blue})
        colour.insert(colour.end(), channel->begin(), channel->end());
    to_differences(colour, count, 1);
    colour_ = Packed(colour);
}

PointCloud KeptFrame::points() const {
    std::vector<std::uint32_t> places = values_of<std::uint32_t>(places_.unpacked());
    PointCloud out;
    const std::size_t count = places.size() / 3;
    if (count == 0) return out;
    to_values(places, count, 1);
    std::size_t n = 0;
    for (std::vector<float>* axis : {&out.x, &out.y, &out.z})
        for (axis->reserve(count); axis->size() < count; ++n)
            axis->push_back(std::bit_cast<float>(places[n]));
    std::vector<std::uint8_t> colour = colour_.unpacked();
    if (colour.empty()) return out;
    to_values(colour, count, 1);
    auto next = colour.begin();
    for (std::vector<std::uint8_t>* channel : {&out.red, &out.green, &out.blue}) {
        channel->assign(next, next + static_cast<std::ptrdiff_t>(count));
        next += static_cast<std::ptrdiff_t>(count);
    }
    return out;
}

}  // namespace topple::live
