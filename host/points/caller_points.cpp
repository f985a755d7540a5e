// SPDX-License-Identifier: MIT
#include "points/caller_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/room_measures.h"
#include "io/text.h"
#include "points/formats/cloud_builder.h"
#include "topple/error.h"

namespace topple {
namespace {

[[noreturn]] void refuse(const CloudView& view, const std::string& why) {
    throw Error(ErrorKind::input, view.source + ": " + why);
}

// Columns of which all are there, or none.
template <class T>
void check_columns(const CloudView& view,
                   std::initializer_list<std::pair<const char*, const Column<T>*>> columns) {
    const auto is_empty = [](const auto& named) { return named.second->empty(); };
    if (std::ranges::all_of(columns, is_empty)) return;
    for (const auto& [name, column] : columns) {
        if (column->size() != view.size()) {
            refuse(view, std::string(name) + " has " + std::to_string(column->size()) +
                             " values, but x has " + std::to_string(view.size()));
        }
        if (!column->data()) refuse(view, std::string(name) + " is a null pointer");
    }
}

// That an organised cloud has the pixels that it names.
void check_image(const CloudView& view) {
    if (view.width == 0 && view.height == 0) {
        if (view.pixel.empty()) return;
        refuse(view, "pixel is given, but width and height are 0; give those of the image");
    }
    const std::uint64_t pixels = std::uint64_t{view.width} * view.height;
    const std::string image = io::size_text(view.width, view.height);
    if (view.pixel.empty() && pixels != view.size()) {
        refuse(view, "an organised cloud of " + image + " pixels has as many points, but x has " +
                         std::to_string(view.size()) +
                         " values; give `pixel`, or 0 for both where it is none");
    }
    const auto beyond =
        std::ranges::find_if(view.pixel, [&](std::uint64_t p) { return p >= pixels; });
    if (beyond != view.pixel.end())
        refuse(view, "pixel " + std::to_string(*beyond) + " lies outside of its " + image);
}

void check_viewpoint(const CloudView& view) {
    if (!view.has_viewpoint) return;
    for (const double value : view.viewpoint) {
        if (!(std::abs(value) <= farthest_m))
            refuse(view, "its viewpoint has a coordinate of " + io::short_number(value) +
                             "; expected metres up to " + io::short_number(farthest_m) +
                             ", or none");
    }
}

bool finite(const FloatColumn& a, const FloatColumn& b, const FloatColumn& c, std::size_t i) {
    return std::isfinite(a[i]) && std::isfinite(b[i]) && std::isfinite(c[i]);
}

// Whether all are finite. Coordinates that can't be metres are refused.
bool all_finite(const CloudView& view) {
    bool all = true;
    for (std::size_t i = 0; i < view.size(); ++i) {
        if (!finite(view.x, view.y, view.z, i)) {
            all = false;
            continue;
        }
        for (const float v : {view.x[i], view.y[i], view.z[i]}) {
            if (std::abs(v) > farthest_m) refuse(view, io::too_far(i, v));
        }
    }
    for (std::size_t i = 0; all && i < view.nx.size(); ++i)
        all = finite(view.nx, view.ny, view.nz, i);
    return all;
}

}  // namespace

void check_points(const CloudView& view) {
    check_columns<float>(view, {{"x", &view.x}, {"y", &view.y}, {"z", &view.z}});
    check_columns<float>(view, {{"nx", &view.nx}, {"ny", &view.ny}, {"nz", &view.nz}});
    check_columns<float>(view, {{"viewpoint_x", &view.viewpoint_x},
                                {"viewpoint_y", &view.viewpoint_y},
                                {"viewpoint_z", &view.viewpoint_z}});
    if (!view.viewpoint_x.empty() && view.height > 1) {
        refuse(
            view,
            "it is organised, of one image, but has a viewpoint for each point; leave out either "
            "width and height or viewpoint_x, viewpoint_y and viewpoint_z");
    }
    check_columns<std::uint8_t>(view,
                                {{"red", &view.red}, {"green", &view.green}, {"blue", &view.blue}});
    if (!view.pixel.empty() && view.pixel.size() != view.size()) {
        refuse(view, "pixel has " + std::to_string(view.pixel.size()) + " values, but x has " +
                         std::to_string(view.size()));
    }
    check_image(view);
    check_viewpoint(view);
}

std::optional<FinitePoints> finite_points(const CloudView& view) {
    check_points(view);
    if (all_finite(view)) return {};
    FinitePoints out;
    PointCloud& to = out.cloud;
    for (std::size_t i = 0; i < view.size(); ++i) {
        if (!finite(view.x, view.y, view.z, i)) continue;
        out.index.push_back(i);
        to.x.push_back(view.x[i]);
        to.y.push_back(view.y[i]);
        to.z.push_back(view.z[i]);
        if (view.height > 1) to.pixel.push_back(static_cast<std::uint32_t>(view.pixel_of(i)));
        if (!view.red.empty()) {
            to.red.push_back(view.red[i]);
            to.green.push_back(view.green[i]);
            to.blue.push_back(view.blue[i]);
        }
        if (!view.viewpoint_x.empty()) {
            to.viewpoint_x.push_back(view.viewpoint_x[i]);
            to.viewpoint_y.push_back(view.viewpoint_y[i]);
            to.viewpoint_z.push_back(view.viewpoint_z[i]);
        }
        if (view.nx.empty()) continue;
        const bool usable = finite(view.nx, view.ny, view.nz, i);
        to.nx.push_back(usable ? view.nx[i] : 0);
        to.ny.push_back(usable ? view.ny[i] : 0);
        to.nz.push_back(usable ? view.nz[i] : 0);
    }
    if (to.x.empty()) {
        refuse(view, "none of its " + std::to_string(view.size()) +
                         " points is finite; at least one must be");
    }
    to.dropped = view.dropped + view.size() - to.size();
    to.width = view.width;
    to.height = view.height;
    to.has_viewpoint = view.has_viewpoint;
    to.viewpoint = view.viewpoint;
    to.source = view.source;
    to.notes = view.notes;
    return out;
}

}  // namespace topple
