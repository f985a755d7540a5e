// SPDX-License-Identifier: MIT
#include "result/write_ply.h"

#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

#include "io/file_writer.h"
#include "io/palette.h"
#include "io/text.h"

namespace topple::io {
namespace {

// One vertex on its way out; little-endian whatever the host is.
class Record {
  public:
    template <class T>
    void put(T value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            const bool big = std::endian::native == std::endian::big;
            bytes_[size_++] = bytes[big ? sizeof(T) - 1 - i : i];
        }
    }
    template <class Values>
    void put_all(const Values& values) {
        for (const auto value : values) put(value);
    }
    void write_to(FileWriter& writer) {
        writer.write(bytes_, size_);
        size_ = 0;
    }

  private:
    char bytes_[64];
    std::size_t size_ = 0;
};

template <class... Arrays>
void check_lengths(const char* what, std::size_t size, const Arrays&... arrays) {
    if (((arrays.size() != size) || ...)) {
        throw std::invalid_argument(std::string(what) + ": arrays differ in length");
    }
}

std::string header(std::uint64_t count, const std::string& properties, bool coloured = false) {
    return "ply\nformat binary_little_endian 1.0\ncomment written by topple; metres, -1 = "
           "unassigned\n"
           "element vertex " +
           std::to_string(count) + "\nproperty float x\nproperty float y\nproperty float z\n" +
           "property int primitive\nproperty int object\n" + properties +
           "property uchar red\nproperty uchar green\nproperty uchar blue\n" +
           (coloured ? "property uchar object_red\nproperty uchar object_green\n"
                       "property uchar object_blue\n"
                     : "") +
           "end_header\n";
}

}  // namespace

void write_points_ply(const std::filesystem::path& file, const ScenePoints& points) {
    const auto count = points.x.size();
    check_lengths("points.ply", count, points.y, points.z, points.primitive, points.object);
    const bool normals = !points.nx.empty(), coloured = !points.red.empty();
    if (normals) check_lengths("points.ply", count, points.nx, points.ny, points.nz);
    if (coloured) check_lengths("points.ply", count, points.red, points.green, points.blue);

    PointsPlyWriter writer(file, count, coloured, normals);
    for (std::size_t i = 0; i < count; ++i) {
        Rgb8 own{};
        std::array<float, 3> normal{};
        if (coloured) own = {points.red[i], points.green[i], points.blue[i]};
        if (normals) normal = {points.nx[i], points.ny[i], points.nz[i]};
        writer.add({points.x[i], points.y[i], points.z[i]}, points.primitive[i], points.object[i],
                   own, normal);
    }
    writer.close();
}

PointsPlyWriter::PointsPlyWriter(const std::filesystem::path& file, std::uint64_t count,
                                 bool coloured, bool normals)
    : own_colours_(coloured), normals_(normals), path_(file), writer_(file), left_(count) {
    writer_.write(header(count,
                         normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
                         coloured));
}

void PointsPlyWriter::add(const std::array<float, 3>& point, std::int32_t primitive,
                          std::int32_t object, const Rgb8& own,
                          const std::array<float, 3>& normal) {
    if (left_ == 0) fail(path_, "more points come than were announced");
    --left_;
    if (object != coloured_) {
        coloured_ = object;
        colour_ = colour_of(object);
    }
    Record record;
    record.put_all(point);
    record.put(primitive);
    record.put(object);
    if (normals_) record.put_all(normal);
    if (own_colours_) record.put_all(own);
    record.put_all(colour_);
    record.write_to(writer_);
}

void PointsPlyWriter::close() {
    if (left_ > 0) fail(path_, counted(left_, "point") + " of those announced did not come");
    writer_.close();
}

void write_solid_ply(const std::filesystem::path& file, const SolidVoxels& voxels) {
    const auto count = voxels.x.size();
    check_lengths("solid.ply", count, voxels.y, voxels.z, voxels.primitive, voxels.object,
                  voxels.state);

    FileWriter writer(file);
    writer.write(header(count, "property uchar state\n"));
    Record record;
    for (std::size_t i = 0; i < count; ++i) {
        record.put_all(std::array{voxels.x[i], voxels.y[i], voxels.z[i]});
        record.put(voxels.primitive[i]);
        record.put(voxels.object[i]);
        record.put(voxels.state[i]);
        record.put_all(colour_of(voxels.object[i]));
        record.write_to(writer);
    }
    writer.close();
}

}  // namespace topple::io
