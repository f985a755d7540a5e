// SPDX-License-Identifier: MIT
#include <iomanip>
#include <sstream>

#include "lab/scan/depth_camera.h"
#include "lab/scan/files.h"
#include "lab/solids/ground_truth.h"

namespace topple::scenes {

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud) {
    std::vector<float> records;
    records.reserve(3 * cloud.size());
    for (std::size_t k = 0; k < cloud.size(); ++k) {
        records.insert(records.end(), {cloud.x[k], cloud.y[k], cloud.z[k]});
    }
    std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(cloud.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    text.append(reinterpret_cast<const char*>(records.data()), records.size() * sizeof(float));
    write_text(path, text);
}

void write_sequence(const std::filesystem::path& folder, const World& world,
                    const Sequence& sequence) {
    make_folder(folder / "depth");
    std::string poses;
    for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
        std::ostringstream name;
        name << std::setw(4) << std::setfill('0') << n << ".png";
        const DepthFrame& frame = sequence.frames[n];
        write_depth_png(folder / "depth" / name.str(), sequence.intrinsics.width, frame.depth);
        poses += trajectory_line(static_cast<double>(n) / 30, frame.camera_to_world);
    }
    if (sequence.frames.size() > 1) write_text(folder / "trajectory.txt", poses);
    write_text(folder / "intrinsics.json", intrinsics_text(sequence.intrinsics));
    write_cloud(folder / "cloud.ply", sequence.cloud);
    write_truth(folder / "truth.json", world);
}

}  // namespace topple::scenes
