// SPDX-License-Identifier: MIT
#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scenes/depth_camera.h"
#include "scenes/ground_truth.h"
#include "topple/error.h"

namespace topple::scenes {

namespace {

// libpng reports errors by longjmp: nothing with a destructor lives in this frame.
bool encode(std::FILE* file, png_struct* png, png_info* info, std::uint32_t width,
            std::uint32_t height, const std::uint16_t* depth) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
    png_set_compression_level(png, 3);
    png_set_IHDR(png, info, width, height, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_set_swap(png);  // the file is big-endian
    for (std::uint32_t v = 0; v < height; ++v) {
        png_write_row(png, reinterpret_cast<png_const_bytep>(depth + std::size_t{v} * width));
    }
    png_write_end(png, info);
    return true;
}

void write_png(const std::filesystem::path& path, const Intrinsics& k,
               const std::vector<std::uint16_t>& depth) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"),
                                                               std::fclose);
    png_struct* png = file ? png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr,
                                                     [](png_struct*, const char*) {})
                           : nullptr;
    png_info* info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && encode(file.get(), png, info, k.width, k.height, depth.data());
    if (png) png_destroy_write_struct(&png, &info);
    if (!done || std::fflush(file.get()) != 0) {
        throw Error(ErrorKind::input, path.string() + ": can't be written");
    }
}

// The quaternion x y z w of a rotation, by its largest component.
std::array<double, 4> quaternion(const Mat4& m) {
    const double trace = m[0] + m[5] + m[10];
    if (trace > 0) {
        const double s = 2 * std::sqrt(trace + 1);
        return {(m[9] - m[6]) / s, (m[2] - m[8]) / s, (m[4] - m[1]) / s, s / 4};
    }
    if (m[0] >= m[5] && m[0] >= m[10]) {
        const double s = 2 * std::sqrt(1 + m[0] - m[5] - m[10]);
        return {s / 4, (m[1] + m[4]) / s, (m[2] + m[8]) / s, (m[9] - m[6]) / s};
    }
    if (m[5] >= m[10]) {
        const double s = 2 * std::sqrt(1 + m[5] - m[0] - m[10]);
        return {(m[1] + m[4]) / s, s / 4, (m[6] + m[9]) / s, (m[2] - m[8]) / s};
    }
    const double s = 2 * std::sqrt(1 + m[10] - m[0] - m[5]);
    return {(m[2] + m[8]) / s, (m[6] + m[9]) / s, s / 4, (m[4] - m[1]) / s};
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.flush();
    if (!out) throw Error(ErrorKind::input, path.string() + ": can't be written");
}

}  // namespace

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
    std::error_code error;
    std::filesystem::create_directories(folder / "depth", error);
    if (error) throw Error(ErrorKind::input, folder.string() + ": " + error.message());
    std::ostringstream poses;
    poses << std::fixed << std::setprecision(9);
    for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
        std::ostringstream name;
        name << std::setw(4) << std::setfill('0') << n << ".png";
        const DepthFrame& frame = sequence.frames[n];
        write_png(folder / "depth" / name.str(), sequence.intrinsics, frame.depth);
        const Mat4& m = frame.camera_to_world;
        poses << static_cast<double>(n) / 30 << ' ' << m[3] << ' ' << m[7] << ' ' << m[11];
        for (const double q : quaternion(m)) poses << ' ' << q;
        poses << '\n';
    }
    if (sequence.frames.size() > 1) write_text(folder / "trajectory.txt", poses.str());
    const Intrinsics& k = sequence.intrinsics;
    const nlohmann::json camera{
        {"width", k.width}, {"height", k.height},          {"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx},
        {"cy", k.cy},       {"depth_scale", k.depth_scale}};
    write_text(folder / "intrinsics.json", camera.dump(1) + "\n");
    write_cloud(folder / "cloud.ply", sequence.cloud);
    write_truth(folder / "truth.json", world);
}

}  // namespace topple::scenes
