// SPDX-License-Identifier: MIT
// robot OUT: points in memory, progress, an end by time, a correction, results, and a scene for a
// simulator. The points are made up here; yours come from a sensor.
#include <chrono>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "topple/export.h"
#include "topple/parse.h"
#include "topple/stays.h"

struct Point {
    float x, y, z, intensity;
};

// A floor, two walls, a crate and a box on it, z up: metres, with a millimetre of noise.
std::vector<Point> scan() {
    std::vector<Point> points;
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.001);
    const auto face = [&](const topple::Vec3& corner, const topple::Vec3& u,
                          const topple::Vec3& v) {
        const double step = 0.015;  // along sides that are each along one axis
        for (double s = 0; s <= u[0] + u[1] + u[2]; s += step)
            for (double t = 0; t <= v[0] + v[1] + v[2]; t += step) {
                double at[3];
                for (int a = 0; a < 3; ++a)
                    at[a] = corner[a] + (u[a] > 0 ? s : 0) + (v[a] > 0 ? t : 0) + noise(random);
                points.push_back({float(at[0]), float(at[1]), float(at[2]), 0});
            }
    };
    const auto block = [&](const topple::Vec3& low, const topple::Vec3& size) {
        const topple::Vec3 x{size[0], 0, 0}, y{0, size[1], 0}, z{0, 0, size[2]};
        face(low, x, z);
        face(low, y, z);
        face({low[0], low[1] + size[1], low[2]}, x, z);
        face({low[0] + size[0], low[1], low[2]}, y, z);
        face({low[0], low[1], low[2] + size[2]}, x, y);
    };
    face({0, 0, 0}, {2.8, 0, 0}, {0, 2.4, 0});
    face({0, 0, 0}, {2.8, 0, 0}, {0, 0, 1.4});
    face({0, 0, 0}, {0, 2.4, 0}, {0, 0, 1.4});
    block({1.0, 0.9, 0}, {0.7, 0.6, 0.5});
    block({1.2, 1.1, 0.5}, {0.25, 0.2, 0.35});
    return points;
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::string out = argv[1];
    try {
        const std::vector<Point> points = scan();
        auto cloud = topple::CloudView::of_records(&points[0].x, points.size(), sizeof(Point));
        cloud.source = "map";  // what messages and the report call it

        topple::ParseOptions options;
        options.device =
            topple::device::open_device("native");  // keep it: the next parse starts sooner
        options.up = topple::Vec3{0, 0, 1};         // as an accelerometer says
        options.disturbances = {"human"};
        options.max_memory_bytes = 4ull << 30;
        options.progress = [last = std::string()](const std::string& stage, double done) mutable {
            if (stage != last) std::fprintf(stderr, "%3.0f %%  %s\n", 100 * done, stage.c_str());
            last = stage;
        };
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        options.cancelled = [&] { return std::chrono::steady_clock::now() > end; };
        topple::Correction box;  // a spot on it, and what its label says
        box.kind = topple::Correction::Kind::mass;
        box.at_m = {{1.3, 1.2, 0.85}};
        box.mass_kg = 3;
        options.corrections = {box};

        const topple::ParseResult result = topple::parse(cloud, options);
        const topple::Scene& scene = result.scene;
        std::printf("%zu objects\n", scene.objects.size());
        for (const topple::AppliedCorrection& c : scene.corrections)
            std::printf("%s of object %d: %s\n", topple::to_string(c.correction.kind),
                        c.objects.empty() ? -1 : c.objects[0], c.outcome.c_str());
        std::vector<std::size_t> count(scene.objects.size());
        for (const std::int32_t object : scene.points.object)  // of each point; -1: of none
            if (object >= 0) ++count[object];
        for (const topple::Object& o : scene.objects) {
            if (o.grounded) continue;  // floor, walls and what is fixed to them
            std::printf("object %d: %zu points, %.1f kg, barrier %.2f J, ", o.id, count[o.id],
                        o.mass_kg, o.barrier_J);
            if (o.seen_enough)
                std::printf("%.3g J a walk. %s\n", o.risk_J.at("human"), o.why.sentence.c_str());
            else
                std::printf("what holds it was not seen.\n");
            for (const std::int32_t carrier : o.why.stands_on)
                std::printf("  stands on object %d\n", carrier);
            topple::Touch touch;  // from any side
            touch.place_m = o.center_of_mass_m;
            touch.force_N = 5;
            touch.impulse_Ns = 0.5;
            std::printf("  an arm %s it with 5 N or 0.5 N s at its middle\n",
                        topple::stays(scene, o, touch) ? "may touch" : "must not touch");
        }

        topple::write_outputs(result, out);  // report.html and the rest
        topple::ExportOptions simulator;
        simulator.mjcf = out + "-mujoco";
        const topple::ExportSummary made = topple::export_scene(result, simulator);
        std::printf("%zu bodies in %s/scene.xml\n", made.bodies.size(), simulator.mjcf.c_str());
        for (const std::string& note : made.notes) std::printf("%s\n", note.c_str());
    } catch (const topple::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.kind() == topple::ErrorKind::cancelled ? 3 : 1;
    }
}
