// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "topple/input.h"

// A point cloud where the caller keeps it: parsing it makes no copy of the points.
namespace topple {

// One value of each point, a fixed number of bytes apart: an array of its own, or a member of the
// caller's struct. The bytes need no alignment. They must stay while the column is in use.
template <class T>
class Column {
  public:
    Column() = default;
    Column(const T* first, std::size_t size, std::ptrdiff_t stride_bytes = sizeof(T)) noexcept
        : first_(reinterpret_cast<const std::byte*>(first)), size_(size), stride_(stride_bytes) {}
    Column(std::span<const T> values) noexcept : Column(values.data(), values.size()) {}
    Column(const std::vector<T>& values) noexcept : Column(values.data(), values.size()) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const std::byte* data() const {
        return first_;
    }  // of the first value as it is stored; null: there is none
    std::ptrdiff_t stride_bytes() const { return stride_; }
    T operator[](std::size_t i) const {
        T value;
        std::memcpy(&value, first_ + static_cast<std::ptrdiff_t>(i) * stride_, sizeof(value));
        return static_cast<T>(value - less_);
    }
    // Of the same bytes, with values that are each less by that than what is stored.
    Column less(T by) const {
        Column out = *this;
        out.less_ = by;
        return out;
    }

    class Iterator {
      public:
        using iterator_category = std::forward_iterator_tag;
        using value_type = T;
        using difference_type = std::ptrdiff_t;
        using pointer = const T*;
        using reference = T;
        Iterator() = default;
        Iterator(const Column& column, std::size_t i) : column_(&column), i_(i) {}
        T operator*() const { return (*column_)[i_]; }
        Iterator& operator++() {
            ++i_;
            return *this;
        }
        Iterator operator++(int) {
            Iterator before = *this;
            ++i_;
            return before;
        }
        bool operator==(const Iterator& other) const { return i_ == other.i_; }

      private:
        const Column* column_ = nullptr;
        std::size_t i_ = 0;
    };
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size_}; }

  private:
    const std::byte* first_ = nullptr;
    std::size_t size_ = 0;
    std::ptrdiff_t stride_ = sizeof(T);
    T less_{};
};
using FloatColumn = Column<float>;
using ByteColumn = Column<std::uint8_t>;

// As PointCloud, with the points in the caller's memory: metres, any right-handed frame. It must
// stay, unchanged, while it is parsed. Points that are not finite may be among them: they are left
// out, which takes a copy of the others; see ScenePoints::index.
struct CloudView {
    FloatColumn x, y, z;
    FloatColumn nx, ny, nz;     // normals of about unit length, or empty
    std::uint64_t dropped = 0;  // points that were left out before
    // Of an organised cloud, and row * width + column of each point; empty: point i is pixel i, and
    // there are width * height.
    std::uint32_t width = 0, height = 0;
    std::span<const std::uint32_t> pixel;
    bool has_viewpoint = false;
    Vec3 viewpoint{0, 0, 0};
    // Where the sensor was that saw each point, metres, or empty. What is not finite: not known.
    FloatColumn viewpoint_x, viewpoint_y, viewpoint_z;
    std::string source;  // what messages call it; empty: "cloud"
    std::vector<std::string> notes;
    // sRGB, 0 to 255, or empty. 0, 0, 0: this point's is not known.
    ByteColumn red, green, blue;

    CloudView() = default;
    CloudView(const PointCloud& cloud)
        : x(cloud.x),
          y(cloud.y),
          z(cloud.z),
          nx(cloud.nx),
          ny(cloud.ny),
          nz(cloud.nz),
          dropped(cloud.dropped),
          width(cloud.width),
          height(cloud.height),
          pixel(cloud.pixel),
          has_viewpoint(cloud.has_viewpoint),
          viewpoint(cloud.viewpoint),
          viewpoint_x(cloud.viewpoint_x),
          viewpoint_y(cloud.viewpoint_y),
          viewpoint_z(cloud.viewpoint_z),
          source(cloud.source),
          notes(cloud.notes),
          red(cloud.red),
          green(cloud.green),
          blue(cloud.blue) {}
    // Of records that begin with x, y, z, `stride_bytes` apart.
    static CloudView of_records(const float* xyz, std::size_t count,
                                std::ptrdiff_t stride_bytes = 3 * sizeof(float)) {
        CloudView view;
        view.x = {xyz, count, stride_bytes};
        view.y = {xyz + 1, count, stride_bytes};
        view.z = {xyz + 2, count, stride_bytes};
        return view;
    }

    std::size_t size() const { return x.size(); }
    std::size_t pixel_of(std::size_t i) const { return pixel.empty() ? i : pixel[i]; }
};

}  // namespace topple
