// SPDX-License-Identifier: MIT
#include "perf/peers/cloud_peers.h"

#include <fstream>

namespace topple::perf {
namespace {

std::vector<std::int32_t> labels_of(const std::filesystem::path& path, std::size_t count) {
    std::vector<std::int32_t> out(count);
    const auto bytes = static_cast<std::streamsize>(count * sizeof(std::int32_t));
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(out.data()), bytes);
    if (file.gcount() != bytes) out.clear();
    return out;
}

}  // namespace

std::vector<CloudPeer> cloud_peers(const CloudView& cloud) {
    const ScriptFile points("points.f32"), labels("labels.i32");
    std::vector<float> rows;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        rows.insert(rows.end(), {cloud.x[i], cloud.y[i], cloud.z[i]});
    points.write({reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(float)});
    std::vector<CloudPeer> out;
    for (const Told& told : times_of("cloud_peers.py", {&points, &labels})) {
        out.push_back({told, {}});
        if (told.name.starts_with("segmentation/"))
            out.back().label = labels_of(labels.path(), cloud.size());
    }
    return out;
}

}  // namespace topple::perf
