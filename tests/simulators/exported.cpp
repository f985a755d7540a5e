// SPDX-License-Identifier: MIT
#include "simulators/exported.h"

#include <nlohmann/json.hpp>

#include "export/writers.h"
#include "host/export/shapes_scene.h"
#include "host/io/files.h"
#include "lab/temporary_folder.h"
#include "topple/kernels/device.h"
#include "topple/parse.h"

namespace topple::exports::test {
namespace {

// Points on the sides of boxes, of a colour each: a room, a crate and a box on it.
void write_scan(const std::filesystem::path& file) {
    struct Painted {
        Vec3 low, high;
        const char* colour;
    };
    std::ofstream out(file);
    topple::test::Random random(1);
    const auto share = [&] { return static_cast<double>(random.below(1'000'000)) / 1e6; };
    for (const Painted& box : {Painted{{0, 0, 0}, {2, 2, 0}, "150 150 140"},
                               {{0, 0, 0}, {0, 2, 1}, "90 110 150"},
                               {{0, 0, 0}, {2, 0, 1}, "90 110 150"},
                               {{2, 0, 0}, {2, 2, 1}, "90 110 150"},
                               {{0, 2, 0}, {2, 2, 1}, "90 110 150"},
                               {{0.7, 0.7, 0}, {1.3, 1.2, 0.4}, "180 60 40"},
                               {{0.8, 0.8, 0.4}, {1.05, 1, 0.7}, "40 160 60"}}) {
        const Vec3 size = minus(box.high, box.low);
        for (std::size_t across = 0; across < 3; ++across) {
            const std::size_t u = (across + 1) % 3, v = (across + 2) % 3;
            for (const bool upper : {false, true}) {
                // Nobody sees what things stand on.
                if (across == 2 && !upper && size[2] > 0) continue;
                const int count = static_cast<int>(4000 * size[u] * size[v]);
                for (int n = 0; n < count; ++n) {
                    Vec3 p = upper ? box.high : box.low;
                    p[u] = box.low[u] + share() * size[u];
                    p[v] = box.low[v] + share() * size[v];
                    out << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << box.colour << '\n';
                }
            }
        }
    }
}

void write_expected(const Exported& each) {
    nlohmann::json bodies = nlohmann::json::object();
    for (const NamedBody& named : each.bodies) {
        const Body& body = *named.body;
        nlohmann::json parts = nlohmann::json::object();
        for (const NamedPart& part : named.parts)
            parts[part.name] = {
                {"low", part.part->low}, {"high", part.part->high}, {"mesh", is_mesh(part.shape)}};
        nlohmann::json fronts = nlohmann::json::object();
        for (const NamedFront& of : named.fronts) {
            const JointedFront& front = *of.front;
            Extents<double> box;
            for (const Box& board : front.boxes)
                for (const Vec3& corner : board.corners()) box.add(corner);
            fronts[front.name] = {{"joint", of.joint()},
                                  {"slides", front.slides()},
                                  {"mass", front.mass_kg},
                                  {"center", front.center_m},
                                  {"inertia", front.inertia_kg_m2},
                                  {"axis", front.axis},
                                  {"at", front.at_m},
                                  {"most", front.most},
                                  {"boxes", front.boxes.size()},
                                  {"low", box.low},
                                  {"high", box.high}};
        }
        bodies[named.name] = {{"fixed", body.fixed},
                              {"mass", body.mass_kg},
                              {"friction", named.friction},
                              {"center", body.center_m},
                              {"inertia", body.inertia_kg_m2},
                              {"colours", !body.visual.triangle.empty()},
                              {"parts", parts},
                              {"fronts", fronts}};
    }
    const nlohmann::json all{{"gravity", each.scene.gravity_m_s2}, {"bodies", bodies}};
    std::ofstream(each.folder / "expected.json") << all.dump(1);
}

SimScene parsed_scene(const std::filesystem::path& folder) {
    write_scan(folder / "scan.xyz");
    ParseOptions options;
    options.device = device::open_device("native");
    options.disturbances.clear();
    const ParseResult result = parse(folder / "scan.xyz", options);
    return sim_scene(result.scene, *result.solids, true, true, 0);
}

}  // namespace

const std::vector<Exported>& exported() {
    static const scenes::TemporaryFolder folder("topple-exports");
    static const std::vector<Exported> all = [] {
        std::vector<Exported> out(2);
        out[0] = {shapes_scene(), {}, folder.path() / "shapes"};
        out[1] = {parsed_scene(folder.path()), {}, folder.path() / "scan"};
        for (Exported& each : out) {
            each.bodies = named_bodies(each.scene);
            write_mjcf(each.folder, each.scene);
            write_urdf(each.folder, each.scene);
            write_sdf(each.folder, each.scene);
            write_usd(each.folder / "scene.usda", each.scene);
            write_expected(each);
        }
        return out;
    }();
    return all;
}

}  // namespace topple::exports::test
