// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/text.h"
#include "points/formats/cloud_builder.h"

namespace topple::io {

// The point that is being read, and which columns of a file's rows hold what of it.
struct PointValues {
    using Columns = std::array<std::optional<std::size_t>, 3>;

    PointValues() = default;
    PointValues(const PointValues&) = delete;
    PointValues& operator=(const PointValues&) = delete;

    // Takes three values from there, if all three are there; returns whether they are.
    bool take(const Columns& from, std::array<double, 3>& to) {
        if (!from[0] || !from[1] || !from[2]) return false;
        for (std::size_t a = 0; a < 3; ++a) values.push_back({*from[a], &to[a]});
        return true;
    }
    // Takes x, y and z first, without which Error(input) says what is `missing`; a normal, each of
    // its columns by the first of two names; and a viewpoint. find(name): a column.
    template <class Find>
    CloudFields take_named(const std::filesystem::path& file, const Find& find,
                           const std::string& missing, const std::array<std::string, 2>& normals) {
        Columns at, normal, viewpoint;
        for (std::size_t a = 0; a < 3; ++a) {
            const std::string axis(1, "xyz"[a]);
            at[a] = find(axis);
            if (!at[a]) fail(file, missing + axis + "; x, y and z are needed");
            normal[a] = find(normals[0] + axis);
            if (!normal[a]) normal[a] = find(normals[1] + axis);
            viewpoint[a] = find("vp_" + axis);
        }
        take(at, point.at);
        return {take(normal, point.normal), take(viewpoint, point.viewpoint), ColourValues::none};
    }

    FilePoint point;
    struct Value {
        std::size_t column;
        double* to;
    };
    std::vector<Value> values;
};

}  // namespace topple::io
