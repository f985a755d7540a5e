// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lab/scan/files.h"
#include "lab/scan/scan.h"

namespace topple::scenes {
namespace {

// A binary .ply of records that the caller makes.
template <class Record>
void write_ply(const std::filesystem::path& path, const std::vector<Record>& records,
               const std::string& properties, const std::string& bytes) {
    write_text(path, "ply\nformat binary_little_endian 1.0\nelement vertex " +
                         std::to_string(records.size()) + "\n" + properties + "end_header\n" +
                         bytes);
}

constexpr const char* xyz = "property float x\nproperty float y\nproperty float z\n";

void append_place(std::string& bytes, const Vec3& p) {
    for (const double a : p) {
        const auto value = static_cast<float>(a);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
}

void write_coloured(const std::filesystem::path& path, const std::vector<ColouredPoint>& points) {
    std::string bytes;
    for (const ColouredPoint& p : points) {
        append_place(bytes, p.at);
        bytes.append(reinterpret_cast<const char*>(p.colour.data()), p.colour.size());
    }
    write_ply(path, points,
              std::string(xyz) + "property uchar red\nproperty uchar green\nproperty uchar blue\n",
              bytes);
}

void write_labelled(const std::filesystem::path& path, const std::vector<LabelledPoint>& points) {
    std::string bytes;
    for (const LabelledPoint& p : points) {
        append_place(bytes, p.at);
        bytes.append(reinterpret_cast<const char*>(&p.object), sizeof p.object);
    }
    write_ply(path, points, std::string(xyz) + "property int object\n", bytes);
}

double rounded(double value) {
    return std::round(value * 1e6) / 1e6;
}

nlohmann::json box_of(const World& world, std::int32_t object) {
    Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    for (const Part& part : world.parts) {
        if (part.object != object) continue;
        const auto box = part.bounds();
        for (std::size_t a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], rounded(box[0][a]));
            high[a] = std::max(high[a], rounded(box[1][a]));
        }
    }
    return {low, high};
}

nlohmann::json objects_json(const World& world, const Scan& scan) {
    std::vector<std::size_t> points(world.objects.size());
    for (const LabelledPoint& p : scan.truth) ++points[static_cast<std::size_t>(p.object)];
    const auto fixed = fixed_objects(world);
    const auto below = supporters(world);
    std::vector<bool> kept(world.objects.size());
    kept[0] = true;
    for (std::size_t n = kept.size(); n-- > 1;) {  // carriers come before what they carry
        kept[n] = kept[n] || points[n] > 0;
        if (!kept[n]) continue;
        for (const std::int32_t s : below[n]) kept[static_cast<std::size_t>(s)] = true;
    }
    nlohmann::json list = nlohmann::json::array();
    for (std::size_t n = 0; n < kept.size(); ++n) {
        if (!kept[n]) continue;
        const double edge = n == 0 ? scan.building_truth_m : scan.truth_m;
        nlohmann::json object{{"id", n},
                              {"name", n == 0 ? "building" : world.objects[n].name},
                              {"fixed", fixed[n]},
                              {"shell", n == 0},
                              {"pile", world.objects[n].pile},
                              {"supporters", fixed[n] ? std::vector<std::int32_t>{} : below[n]},
                              {"mass_kg", nullptr},
                              {"truth_points", points[n]},
                              {"seen_m2", rounded(static_cast<double>(points[n]) * edge * edge)}};
        if (n > 0) {
            object["box"] = box_of(world, static_cast<std::int32_t>(n));
            object["note"] = world.objects[n].where;
        }
        list.push_back(std::move(object));
    }
    return list;
}

void write_frames(const std::filesystem::path& folder, const Scan& scan) {
    make_folder(folder / "depth");
    make_folder(folder / "color");
    std::string poses;
    for (std::size_t n = 0; n < scan.frames.size(); ++n) {
        std::ostringstream name;
        name << std::setw(4) << std::setfill('0') << n << ".png";
        const DepthFrame& frame = scan.frames[n];
        write_depth_png(folder / "depth" / name.str(), scan.intrinsics.width, frame.depth);
        write_colour_png(folder / "color" / name.str(), scan.intrinsics.width, scan.colour[n]);
        poses += trajectory_line(static_cast<double>(n) / 3, frame.camera_to_world);
    }
    if (scan.frames.size() > 1) write_text(folder / "trajectory.txt", poses);
    write_text(folder / "intrinsics.json", intrinsics_text(scan.intrinsics));
}

}  // namespace

std::vector<std::vector<std::int32_t>> supporters(const World& world) {
    std::vector<std::vector<std::int32_t>> out(world.objects.size());
    for (const auto& [below, above] : world.support) {
        const std::int32_t a = world.parts[static_cast<std::size_t>(below)].object,
                           b = world.parts[static_cast<std::size_t>(above)].object;
        if (a != b) out[static_cast<std::size_t>(b)].push_back(a);
    }
    for (auto& list : out) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return out;
}

std::vector<bool> fixed_objects(const World& world) {
    std::vector<bool> fixed(world.objects.size());
    fixed[0] = true;
    const auto object = [&](std::int32_t part) {
        return static_cast<std::size_t>(world.parts[static_cast<std::size_t>(part)].object);
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : world.fixed) {
            if (fixed[object(a)] == fixed[object(b)]) continue;
            fixed[object(a)] = fixed[object(b)] = changed = true;
        }
    }
    return fixed;
}

void write_scan(const std::filesystem::path& folder, const World& world, const Scan& scan,
                const ScanOptions& options, const std::string& kind) {
    make_folder(folder);
    if (scan.frames.empty()) {
        write_coloured(folder / "cloud.ply", scan.cloud);
    } else {
        write_frames(folder, scan);
    }
    write_labelled(folder / "truth.ply", scan.truth);
    const Mat4& m = scan.world_to_scan;
    nlohmann::json rows = nlohmann::json::array();
    for (std::size_t r = 0; r < 4; ++r) {
        nlohmann::json row = nlohmann::json::array();
        for (std::size_t c = 0; c < 4; ++c) row.push_back(rounded(m[4 * r + c]));
        rows.push_back(row);
    }
    const nlohmann::json truth{{"world", kind},
                               {"scan", to_string(options.kind)},
                               {"seed", options.seed},
                               {"gravity", {rounded(-m[2]), rounded(-m[6]), rounded(-m[10])}},
                               {"world_to_scan", rows},
                               {"box_frame", "world"},
                               {"objects", objects_json(world, scan)}};
    write_text(folder / "truth.json", truth.dump(1) + "\n");
}

}  // namespace topple::scenes
