// SPDX-License-Identifier: MIT
#include "arrays.h"

#include <algorithm>
#include <limits>

namespace topple::python {
namespace {

// A one-dimensional array where it lies.
template <class T>
Column<T> column(const py::array& from, const char* name) {
    if (from.ndim() != 1 || !py::isinstance<py::array_t<T>>(from)) {
        throw Error(ErrorKind::usage, std::string(name) + " is no array of " +
                                          (sizeof(T) == 1 ? "uint8" : "float32") + " in a row");
    }
    return {static_cast<const T*>(from.data()), static_cast<std::size_t>(from.shape(0)),
            from.strides(0)};
}

// An image where it lies; the Python side has seen to its type and to rows without gaps.
template <class Pixel, class Value>
ImageView<Pixel> image(const py::array& from, const char* name) {
    const py::ssize_t values = sizeof(Pixel) / sizeof(Value);
    const bool fits =
        py::isinstance<py::array_t<Value>>(from) && from.ndim() == (values == 1 ? 2 : 3) &&
        (values == 1 || (from.shape(2) == values && from.strides(2) == sizeof(Value)));
    if (!fits || (from.shape(1) > 1 && from.strides(1) != sizeof(Pixel)) ||
        std::max(from.shape(0), from.shape(1)) > std::numeric_limits<std::int32_t>::max())
        throw Error(ErrorKind::usage, std::string(name) + " is no image with rows without gaps");
    return {static_cast<const Pixel*>(from.data()), static_cast<std::uint32_t>(from.shape(1)),
            static_cast<std::uint32_t>(from.shape(0)), from.shape(0) > 1 ? from.strides(0) : 0};
}

}  // namespace

CloudView view_of(const std::vector<py::array>& points, const std::vector<py::array>& normals,
                  const std::vector<py::array>& colours, const std::optional<Vec3>& viewpoint) {
    CloudView view;
    view.source = "points";
    view.x = column<float>(points.at(0), "x");
    view.y = column<float>(points.at(1), "y");
    view.z = column<float>(points.at(2), "z");
    if (!normals.empty()) {
        view.nx = column<float>(normals.at(0), "nx");
        view.ny = column<float>(normals.at(1), "ny");
        view.nz = column<float>(normals.at(2), "nz");
    }
    if (!colours.empty()) {
        view.red = column<std::uint8_t>(colours.at(0), "red");
        view.green = column<std::uint8_t>(colours.at(1), "green");
        view.blue = column<std::uint8_t>(colours.at(2), "blue");
    }
    view.has_viewpoint = viewpoint.has_value();
    view.viewpoint = viewpoint.value_or(Vec3{});
    return view;
}

void see_from(const std::vector<py::array>& viewpoints, CloudView& view) {
    if (viewpoints.empty()) return;
    view.viewpoint_x = column<float>(viewpoints.at(0), "viewpoint x");
    view.viewpoint_y = column<float>(viewpoints.at(1), "viewpoint y");
    view.viewpoint_z = column<float>(viewpoints.at(2), "viewpoint z");
}

std::optional<CloudView> caller_points(const std::vector<py::array>& points,
                                       const std::vector<py::array>& colours) {
    if (points.empty()) return std::nullopt;
    return view_of(points, {}, colours, {});
}

ParseResult labelled_points(const std::vector<py::array>& points, const py::array& object,
                            const std::string& call) {
    const auto copied = [](auto& to, const auto& from) { to.assign(from.begin(), from.end()); };
    ParseResult result;
    ScenePoints& to = result.scene.points;
    copied(to.x, row<const float>(points.at(0), "x"));
    copied(to.y, row<const float>(points.at(1), "y"));
    copied(to.z, row<const float>(points.at(2), "z"));
    copied(to.object, row<const std::int32_t>(object, "point_object"));
    if (to.y.size() != to.x.size() || to.z.size() != to.x.size())
        throw Error(ErrorKind::usage, call + ": the columns differ in length");
    return result;
}

FrameView frame_view(const PyFrame& frame) {
    FrameView out;
    if (py::isinstance<py::array_t<float>>(frame.first))
        out.depth_m = image<float, float>(frame.first, "frames");
    else
        out.depth = image<std::uint16_t, std::uint16_t>(frame.first, "frames");
    if (frame.second) out.colour = image<Rgb, std::uint8_t>(*frame.second, "colours");
    return out;
}

Intrinsics intrinsics(std::uint32_t width, std::uint32_t height, const std::array<double, 5>& c) {
    return {width, height, c[0], c[1], c[2], c[3], c[4]};
}

FramesView frames_view(const std::vector<PyFrame>& frames, const std::array<std::uint32_t, 2>& size,
                       const py::array& poses, const std::array<double, 5>& camera,
                       const std::string& name) {
    FramesView view;
    view.source = name;
    view.intrinsics = intrinsics(size[0], size[1], camera);
    for (const PyFrame& frame : frames) view.images.push_back(frame_view(frame));
    const std::span<const double> values = row<const double>(poses, "camera_to_world");
    for (std::size_t at = 0; at + 16 <= values.size(); at += 16)
        std::ranges::copy(values.subspan(at, 16), view.camera_to_world.emplace_back().begin());
    return view;
}

}  // namespace topple::python
