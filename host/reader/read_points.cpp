// SPDX-License-Identifier: MIT
#include "io/octomap.h"
#include "io/read_cloud.h"
#include "reader/read_scan.h"

namespace topple::reader {

ScannedMap read_points(const std::filesystem::path& file, double unit_m,
                       const std::function<void()>& poll) {
    if (io::looks_like_octomap(file)) return io::read_octomap(file, unit_m, poll);
    return {io::read_cloud(file, unit_m), {}};
}

}  // namespace topple::reader
