// SPDX-License-Identifier: MIT
#include "fuzz/readers.h"

#include <new>

#include "fuzz/own_files.h"
#include "io/text.h"
#include "points/formats/colour_image.h"
#include "points/formats/frame_sequence.h"
#include "points/formats/octomap.h"
#include "points/formats/read_cloud.h"
#include "result/landscapes_json.h"
#include "result/read_result_ply.h"
#include "result/scene_json.h"
#include "topple/corrections.h"
#include "topple/error.h"
#include "topple/materials.h"
#include "topple/motion.h"
#include "vdb/volume_checks.h"

namespace topple::fuzz {
namespace {

namespace fs = std::filesystem;

// Thrown where a reader returns what it must not.
struct Broken {
    const char* what;
};

void expect(bool holds, const char* what) {
    if (!holds) throw Broken{what};
}

void check(const PointCloud& cloud) {
    const std::size_t size = cloud.size();
    expect(size > 0 && cloud.y.size() == size && cloud.z.size() == size, "arrays differ in size");
    expect(cloud.nx.size() == cloud.ny.size() && cloud.nx.size() == cloud.nz.size() &&
               (cloud.nx.empty() || cloud.nx.size() == size),
           "normals are not one a point");
    for (const auto* values : {&cloud.x, &cloud.y, &cloud.z}) {
        for (const float v : *values) expect(std::abs(v) <= 1e6f, "a coordinate is out of range");
    }
    expect(cloud.height == 0 || cloud.pixel.size() == size, "pixels are not one a point");
    for (const std::uint32_t p : cloud.pixel)
        expect(p < std::uint64_t{cloud.width} * cloud.height, "a pixel lies outside of the image");
}

// How many points lie on a mesh's faces makes no difference to its reader but the time they take.
constexpr io::MeshSampling few{.fewest = 100, .most = 1000};

void read_as_cloud(const fs::path& file) {
    check(io::read_cloud(file, 1, few));
}

// Nor does it how large an occupied leaf may be.
constexpr std::uint64_t few_voxels = 1 << 15;

void read_as_octomap(const fs::path& file) {
    const ScannedMap map = io::read_octomap(
        file, 1, [] {}, few_voxels);
    check(map.cloud);
    for (const SpaceMap::Box& box : map.space.free) {
        for (std::size_t a = 0; a < 3; ++a)
            expect(box.low[a] <= box.high[a] && box.low[a] >= -32768 && box.high[a] < 32768,
                   "a free box lies outside of the keys");
    }
}

void read_as_motion(const fs::path& file) {
    const BodyMotion motion = read_motion(file);
    for (const auto& track : motion.track)
        expect(track.empty() || track.size() == motion.frames(), "tracks differ in length");
}

void read_as_record(const fs::path& file) {
    const Accelerogram record = read_accelerogram(file);
    expect(record.m_s2.size() >= 2 && record.step_s > 0, "a record without time");
    expect(std::isfinite(record.peak_m_s2()), "a record without a finite peak");
}

void read_as_hazard(const fs::path& file) {
    const HazardCurve curve = read_hazard_curve(file);
    expect(curve.pga_g.size() >= 2 && !curve.fault(), "a hazard curve with a fault");
}

void read_as_materials(const fs::path& file) {
    expect(!fault_of(read_materials(file)), "materials with a fault");
}

void read_as_corrections(const fs::path& file) {
    expect(!fault_of(read_corrections(file)), "corrections with a fault");
}

constexpr Reader all[] = {
    {"ply", "in.ply", read_as_cloud},
    {"pcd", "in.pcd", read_as_cloud},
    {"xyz", "in.xyz", read_as_cloud},
    {"las", "in.las", read_as_cloud},
    {"obj", "in.obj", read_as_cloud},
    {"stl", "in.stl", read_as_cloud},
    {"glb", "in.glb", read_as_cloud},
    {"octomap", "in.bt", read_as_octomap},
    {"volume", "in.vdb",
     [](const fs::path& file) { io::check_volume(file, io::read_file(file).text()); }},
    {"depth", "in.png",
     [](const fs::path& file) {
         expect(io::read_depth_png(file, 9, 7).size() == 63, "an image of another size");
     }},
    {"colour", "in.png",
     [](const fs::path& file) {
         const auto image = io::decode_colour_image(file, io::read_file(file).text());
         expect(image.rgb.size() == std::size_t{3} * image.width * image.height,
                "an image of another size than it says");
     }},
    {"intrinsics", "in.json",
     [](const fs::path& file) { expect(io::read_intrinsics(file).fx > 0, "fx is not positive"); }},
    {"trajectory", "in.txt",
     [](const fs::path& file) {
         for (const Mat4& pose : io::read_trajectory(file)) {
             for (const double v : pose) expect(std::isfinite(v), "a pose is not finite");
         }
     }},
    {"bvh", "in.bvh", read_as_motion},
    {"joints", "in.csv", read_as_motion},
    {"record_json", "in.json", read_as_record},
    {"record_text", "in.txt", read_as_record},
    {"hazard", "in.txt", read_as_hazard},
    {"corrections", "in.json", read_as_corrections},
    {"materials", "in.json", read_as_materials},
    {"scene", "in.json", [](const fs::path& file) { io::scene_json(io::read_scene_json(file)); }},
    {"result", "in.ply",
     [](const fs::path& file) {
         const ScenePoints points = io::read_points_ply(file);
         expect(points.primitive.size() == points.x.size(), "labels are not one a point");
     }},
    {"landscapes", "in.json",
     [](const fs::path& file) {
         Scene scene;
         scene.objects.resize(3);
         io::read_landscapes_json(file, scene);
     }},
};

}  // namespace

std::vector<Reader> readers() {
    std::vector<Reader> out(std::begin(all), std::end(all));
    const auto own = own_files();
    out.insert(out.end(), own.begin(), own.end());
    return out;
}

std::string try_file(const Reader& reader, const fs::path& file) {
    try {
        reader.read(file);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input)
            return std::string("no error of input: ") + error.what();
        for (const char* c = error.what(); *c; ++c) {
            if (static_cast<unsigned char>(*c) < 0x20)
                return std::string("more than one line: ") + error.what();
        }
    } catch (const Broken& broken) {
        return broken.what;
    } catch (const std::exception& error) {
        return std::string("another exception: ") + error.what();
    }
    return "";
}

std::string try_input(const Reader& reader, const fs::path& folder, std::string_view bytes) {
    const fs::path file = folder / reader.file;
    if (reader.put_beside) reader.put_beside(folder);
    const std::string made = reader.made ? reader.made(bytes) : std::string(bytes);
    std::ofstream(file, std::ios::binary)
        .write(made.data(), static_cast<std::streamsize>(made.size()));
    return try_file(reader, file);
}

}  // namespace topple::fuzz
