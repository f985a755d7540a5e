// SPDX-License-Identifier: MIT
#include <cstdint>
#include <string>
#include <vector>

#include "topple/parse.h"

namespace topple {

void add_coordinates(const CloudView& cloud, ParseResult& result) {
    ScenePoints& points = result.scene.points;
    const std::size_t count = points.primitive.size();
    const bool fits = points.index.empty() ? cloud.size() == count
                                           : points.index.back() < cloud.size();  // ascending
    const auto whole = [&](const ByteColumn& channel) {
        return channel.size() == (cloud.red.empty() ? 0 : cloud.size());
    };
    if (!fits || cloud.y.size() != cloud.size() || cloud.z.size() != cloud.size() ||
        !whole(cloud.red) || !whole(cloud.green) || !whole(cloud.blue)) {
        throw Error(ErrorKind::usage, "add_coordinates: a cloud of " +
                                          std::to_string(cloud.size()) +
                                          " points is not what the result of " +
                                          std::to_string(count) + " came from");
    }
    const auto taken = [&]<class T>(const Column<T>& from) {
        if (points.index.empty() || from.empty()) return std::vector<T>(from.begin(), from.end());
        std::vector<T> out;
        out.reserve(count);
        for (const std::uint64_t i : points.index) out.push_back(from[i]);
        return out;
    };
    points.x = taken(cloud.x);
    points.y = taken(cloud.y);
    points.z = taken(cloud.z);
    points.red = taken(cloud.red);
    points.green = taken(cloud.green);
    points.blue = taken(cloud.blue);
}

}  // namespace topple
