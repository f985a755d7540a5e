// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/vectors.h"
#include "io/file_writer.h"
#include "lab/scan/files.h"
#include "lab/scan/scan.h"
#include "lab/solids/ground_truth.h"

namespace topple::scenes {
namespace {

void append_place(std::string& bytes, const Vec3& p) {
    scenes::append_place(bytes, static_cast<float>(p[0]), static_cast<float>(p[1]),
                         static_cast<float>(p[2]));
}

void write_coloured(const std::filesystem::path& path, const std::vector<ColouredPoint>& points) {
    std::string bytes;
    for (const ColouredPoint& p : points) {
        append_place(bytes, p.at);
        bytes.append(reinterpret_cast<const char*>(p.colour.data()), p.colour.size());
    }
    write_ply(path, points.size(),
              "property uchar red\nproperty uchar green\nproperty uchar blue\n", bytes);
}

void write_labelled(const std::filesystem::path& path, const std::vector<LabelledPoint>& points) {
    std::string bytes;
    for (const LabelledPoint& p : points) {
        append_place(bytes, p.at);
        bytes.append(reinterpret_cast<const char*>(&p.object), sizeof p.object);
    }
    write_ply(path, points.size(), "property int object\n", bytes);
}

double rounded(double value) {
    return std::round(value * 1e6) / 1e6;
}

nlohmann::json box_of(const World& world, std::int32_t object) {
    Bounds all = no_bounds();
    for (const Part& part : world.parts) {
        if (part.object != object) continue;
        Bounds box = part.bounds();
        for (Vec3& corner : box)
            for (double& a : corner) a = rounded(a);
        extend(all, box);
    }
    return all;
}

Vec3 rounded(const Vec3& p) {
    return {rounded(p[0]), rounded(p[1]), rounded(p[2])};
}

// Whether a front has a bar or a knob.
bool has_handle(const World& world, const Part& front) {
    const auto [across, out, up] = front.axes();
    return std::ranges::any_of(world.parts, [&](const Part& p) {
        if (p.object != front.object || (p.name != "handle" && p.name != "knob")) return false;
        const Vec3 off = minus(p.center, front.center);
        return std::abs(dot(off, across)) < front.size[0] / 2 &&
               std::abs(dot(off, up)) < front.size[2] / 2 && dot(off, out) > 0 &&
               dot(off, out) < 0.1;
    });
}

// Its doors and drawers: middle and sides, whether they have handles, the axis (unit; the way that
// drawers come out), and a point that a hinge's axis goes through.
nlohmann::json fronts_of(const World& world, std::int32_t object) {
    nlohmann::json list = nlohmann::json::array();
    for (const Part& p : world.parts) {
        if (p.object != object || p.opening == Opening::none) continue;
        const auto [across, out, up] = p.axes();
        const bool below = p.opening == Opening::hinge_below, slides = p.opening == Opening::slide;
        const double side = p.opening == Opening::hinge_at_low_x ? -1 : 1;
        nlohmann::json front{{"name", p.name},
                             {"center", rounded(p.center)},
                             {"size", rounded(p.size)},
                             {"yaw", rounded(p.yaw)},
                             {"handle", has_handle(world, p)},
                             {"kind", slides ? "slide" : "hinge"},
                             {"axis", rounded(slides  ? out
                                              : below ? across
                                                      : up)}};
        if (!slides)
            front["at"] = rounded(below ? along(p.center, -p.size[2] / 2, up)
                                        : along(p.center, side * p.size[0] / 2, across));
        list.push_back(std::move(front));
    }
    return list;
}

nlohmann::json objects_json(const World& world, const Scan& scan) {
    std::vector<std::size_t> points(world.objects.size());
    for (const LabelledPoint& p : scan.truth) ++points[p.object];
    const auto fixed = fixed_objects(world);
    const auto below = supporters(world);
    std::vector<bool> kept(world.objects.size());
    kept[0] = true;
    for (std::size_t n = kept.size(); n-- > 1;) {  // carriers come before what they carry
        kept[n] = kept[n] || points[n] > 0;
        if (!kept[n]) continue;
        for (const std::int32_t s : below[n]) kept[s] = true;
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
            if (auto fronts = fronts_of(world, static_cast<std::int32_t>(n)); !fronts.empty())
                object["fronts"] = std::move(fronts);
        }
        list.push_back(std::move(object));
    }
    return list;
}

}  // namespace

std::vector<std::vector<std::int32_t>> supporters(const World& world) {
    std::vector<std::vector<std::int32_t>> out(world.objects.size());
    for (const auto& [below, above] : world.support) {
        const std::int32_t a = world.parts[below].object, b = world.parts[above].object;
        if (a != b) out[b].push_back(a);
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
        return static_cast<std::size_t>(world.parts[part].object);
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
        write_frames(folder, scan.intrinsics, scan.frames, 3, scan.colour);
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
                               {"parts", parts_json(world)},
                               {"objects", objects_json(world, scan)}};
    io::write_file(folder / "truth.json", truth.dump(1) + "\n");
}

}  // namespace topple::scenes
