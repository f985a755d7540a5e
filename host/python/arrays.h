// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "python.h"
#include "topple/cloud_view.h"
#include "topple/error.h"
#include "topple/frames_view.h"

// Arrays of NumPy where they lie. The Python side has converted what needs it, and says in the
// caller's words what is wrong with the rest: here remain checks that keep memory safe.
namespace topple::python {

// One-dimensional and without gaps; written to where T is not const.
template <class T>
std::span<T> row(const py::array& from, const char* name) {
    using Element = std::remove_const_t<T>;
    const bool fits = from.ndim() == 1 && py::isinstance<py::array_t<Element>>(from) &&
                      (from.shape(0) < 2 || from.strides(0) == sizeof(T));
    if (!fits || (!std::is_const_v<T> && !from.writeable()))
        throw Error(ErrorKind::usage, std::string(name) + " is no such array, without gaps");
    T* first = nullptr;
    if constexpr (std::is_const_v<T>)
        first = static_cast<T*>(from.data());
    else
        first = static_cast<T*>(const_cast<void*>(from.data()));
    return {first, static_cast<std::size_t>(from.shape(0))};
}

// Lists of three arrays each, or empty ones where there are none; any strides.
CloudView view_of(const std::vector<py::array>& points, const std::vector<py::array>& normals,
                  const std::vector<py::array>& colours, const std::optional<Vec3>& viewpoint);

// Gives each point the place that it was seen from: three arrays, or none.
void see_from(const std::vector<py::array>& viewpoints, CloudView& view);

// The points of which a result has no coordinates, as they are the caller's; none: it has them.
std::optional<CloudView> caller_points(const std::vector<py::array>& points,
                                       const std::vector<py::array>& colours);

// Of the columns that a pickle holds: a result of its points and the object of each, and no more.
ParseResult labelled_points(const std::vector<py::array>& points, const py::array& object,
                            const std::string& call);

// While it lives, the result has the coordinates of these points. Nobody else may use it meanwhile.
class LentCoordinates {
  public:
    LentCoordinates(const std::optional<CloudView>& points, Parsed& parsed) {
        if (!points) return;
        add_coordinates(*points, parsed.result);
        to_ = &parsed.result.scene.points;
    }
    ~LentCoordinates() {
        if (!to_) return;
        to_->x = to_->y = to_->z = {};
        to_->red = to_->green = to_->blue = {};
    }
    LentCoordinates(const LentCoordinates&) = delete;
    LentCoordinates& operator=(const LentCoordinates&) = delete;

  private:
    ScenePoints* to_ = nullptr;
};

using PyFrame = std::pair<py::array, std::optional<py::array>>;  // depth, colour

FrameView frame_view(const PyFrame& frame);
// c: fx, fy, cx, cy, depth_scale.
Intrinsics intrinsics(std::uint32_t width, std::uint32_t height, const std::array<double, 5>& c);
// size: width and height. poses: 16 numbers each. camera: as above.
FramesView frames_view(const std::vector<PyFrame>& frames, const std::array<std::uint32_t, 2>& size,
                       const py::array& poses, const std::array<double, 5>& camera,
                       const std::string& name);

// A vector's memory as an array, which owns it from then on.
template <class T>
py::array owned(std::vector<T>&& values) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    const py::capsule owner(kept.get(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
    const std::vector<T>& lasting = *kept.release();
    return py::array_t<T>({static_cast<py::ssize_t>(lasting.size())},
                          {static_cast<py::ssize_t>(sizeof(T))}, lasting.data(), owner);
}

}  // namespace topple::python
