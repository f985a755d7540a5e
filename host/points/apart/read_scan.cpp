// SPDX-License-Identifier: MIT
#include "points/apart/read_scan.h"

#include "points/formats/octomap.h"
#include "points/formats/read_cloud.h"
#include "vdb/read_volume.h"

namespace topple::reader {

bool takes_others(const std::filesystem::path& file) {
    return io::looks_like_octomap(file) || vdb::looks_like_volume(file) || io::is_mesh(file);
}

ScannedMap read_scan(const std::filesystem::path& file, double unit_m,
                     const std::function<void()>& poll) {
    return vdb::looks_like_volume(file) ? vdb::read_volume(file, unit_m)
                                        : read_points(file, unit_m, poll);
}

}  // namespace topple::reader
