// SPDX-License-Identifier: MIT
#include "lab/scan/files.h"

#include <png.h>

#include <Eigen/Geometry>
#include <csetjmp>
#include <cstdio>
#include <iomanip>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/file_writer.h"
#include "topple/error.h"

namespace topple::scenes {

namespace {

struct Image {
    std::uint32_t width, height;
    int bits, type;
    const std::uint8_t* first;
    std::size_t row_bytes;
};

// libpng reports errors by longjmp: nothing with a destructor lives in this frame.
bool encode(std::FILE* file, png_struct* png, png_info* info, const Image& image) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
    png_set_compression_level(png, 3);
    png_set_IHDR(png, info, image.width, image.height, image.bits, image.type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    if (image.bits == 16) png_set_swap(png);  // the file is big-endian
    for (std::uint32_t v = 0; v < image.height; ++v)
        png_write_row(png, image.first + v * image.row_bytes);
    png_write_end(png, info);
    return true;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    io::write_file(path, "");  // a new file, whatever had its name
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"),
                                                               std::fclose);
    png_struct* png = file ? png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr,
                                                     [](png_struct*, const char*) {})
                           : nullptr;
    png_info* info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && encode(file.get(), png, info, image);
    if (png) png_destroy_write_struct(&png, &info);
    if (!done || std::fflush(file.get()) != 0) {
        throw Error(ErrorKind::input, path.string() + ": can't be written");
    }
}

// The line of trajectory.txt for a pose.
std::string trajectory_line(double time_s, const Mat4& pose) {
    std::ostringstream line;
    line << std::fixed << std::setprecision(9);
    line << time_s << ' ' << pose[3] << ' ' << pose[7] << ' ' << pose[11];
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(pose.data());
    const Eigen::Quaterniond turn(matrix.topLeftCorner<3, 3>());
    for (const double q : turn.coeffs()) line << ' ' << q;
    line << '\n';
    return line.str();
}

constexpr std::array<std::string_view, 5> scan_files{"cloud.ply", "truth.ply", "trajectory.txt",
                                                     "intrinsics.json", "truth.json"};
constexpr std::array<std::string_view, 2> scan_folders{"depth", "color"};

}  // namespace

const io::OutputKind generated_scan{scan_files, "{", scan_folders, "scan that topple made"};

void write_depth_png(const std::filesystem::path& path, std::uint32_t width,
                     const std::vector<std::uint16_t>& depth) {
    write_png(path, {width, static_cast<std::uint32_t>(depth.size() / width), 16,
                     PNG_COLOR_TYPE_GRAY, reinterpret_cast<const std::uint8_t*>(depth.data()),
                     std::size_t{width} * sizeof(std::uint16_t)});
}

void write_colour_png(const std::filesystem::path& path, std::uint32_t width,
                      const std::vector<std::array<std::uint8_t, 3>>& colour) {
    write_png(path, {width, static_cast<std::uint32_t>(colour.size() / width), 8,
                     PNG_COLOR_TYPE_RGB, colour.front().data(), std::size_t{width} * 3});
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::input, folder.string() + ": " + error.message());
}

std::string intrinsics_text(const Intrinsics& k) {
    const nlohmann::json camera{
        {"width", k.width}, {"height", k.height},          {"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx},
        {"cy", k.cy},       {"depth_scale", k.depth_scale}};
    return camera.dump(1) + "\n";
}

void write_frames(const std::filesystem::path& folder, const Intrinsics& k,
                  const std::vector<DepthFrame>& frames, double frames_per_s,
                  const std::vector<std::vector<std::array<std::uint8_t, 3>>>& colour) {
    make_folder(folder / "depth");
    if (!colour.empty()) make_folder(folder / "color");
    std::string poses;
    for (std::size_t n = 0; n < frames.size(); ++n) {
        std::ostringstream name;
        name << std::setw(4) << std::setfill('0') << n << ".png";
        write_depth_png(folder / "depth" / name.str(), k.width, frames[n].depth);
        if (!colour.empty()) write_colour_png(folder / "color" / name.str(), k.width, colour[n]);
        poses += trajectory_line(static_cast<double>(n) / frames_per_s, frames[n].camera_to_world);
    }
    if (frames.size() > 1) io::write_file(folder / "trajectory.txt", poses);
    io::write_file(folder / "intrinsics.json", intrinsics_text(k));
}

void write_ply(const std::filesystem::path& path, std::size_t count, const std::string& properties,
               const std::string& bytes) {
    io::write_file(path, "ply\nformat binary_little_endian 1.0\nelement vertex " +
                             std::to_string(count) +
                             "\nproperty float x\nproperty float y\nproperty float z\n" +
                             properties + "end_header\n" + bytes);
}

void append_place(std::string& bytes, float x, float y, float z) {
    for (const float a : {x, y, z}) bytes.append(reinterpret_cast<const char*>(&a), sizeof a);
}

}  // namespace topple::scenes
