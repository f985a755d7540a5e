// SPDX-License-Identifier: MIT
#include "points/apart/read_scan.h"
#include "points/formats/octomap.h"
#include "points/formats/read_cloud.h"

namespace topple::reader {

ScannedMap read_points(const std::filesystem::path& file, double unit_m,
                       const std::function<void()>& poll) {
    if (io::looks_like_octomap(file)) return io::read_octomap(file, unit_m, poll);
    return {io::read_cloud(file, unit_m), {}};
}

}  // namespace topple::reader
