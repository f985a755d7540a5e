// SPDX-License-Identifier: MIT
#pragma once

#include "clouds.h"
#include "safety/action.h"
#include "topple/scene.h"

// A made-up room with all that a report shows, built by rule: floor and walls (object 0), a table
// (1) with a cup (2) and a monitor (3) on it, a shelf (4), a ball (5). It is turned against the
// input's axes by `turn` radians about z.
namespace topple::test {

// As a parse fills them in.
inline void say_actions(Scene& scene) {
    for (Object& o : scene.objects)
        if (!o.grounded) o.advice.action = safety::action_text(scene, o);
}

class SyntheticScene {
  public:
    explicit SyntheticScene(double voxel_m = 0.04, double turn = 0.4)
        : h_(voxel_m), c_(std::cos(turn)), s_(std::sin(turn)) {}

    Scene make() {
        describe();
        const int floor = add(0, "plane"), walls = add(0, "merged"), ceiling = add(0, "plane");
        box(floor, 0, 0, -0.1, 4, 5, 0, {0, 0, 1});
        box(ceiling, 0, 0, 2.5, 4, 5, 2.6, {0, 0, -1});
        box(walls, -0.1, 0, 0, 0, 5, 2.5, {1, 0, 0});
        box(walls, 4, 0, 0, 4.1, 5, 2.5, {-1, 0, 0});
        box(walls, 0, -0.1, 0, 4, 0, 2.5, {0, 1, 0});
        box(walls, 0, 5, 0, 4, 5.1, 2.5, {0, -1, 0});
        const int top = add(1, "plane"), leg = add(1, "merged");
        box(top, 1, 2, 0.7, 2.4, 2.8, 0.76, {0, 0, 1});
        for (const double x : {1.02, 2.3}) {
            for (const double y : {2.02, 2.7})
                box(leg, x, y, 0, x + 0.08, y + 0.08, 0.7, {0, 0, 1});
        }
        box(add(2, "quadric"), 1.2, 2.2, 0.76, 1.32, 2.32, 0.92, {0, 0, 1});
        box(add(3, "merged"), 1.6, 2.3, 0.76, 2.2, 2.42, 1.2, {0, 0, 1});
        box(add(4, "merged"), 3.4, 0.4, 0, 3.9, 1.6, 1.9, {-1, 0, 0});
        box(add(5, "quadric"), 0.6, 1, 0, 0.8, 1.2, 0.2, {0, 0, 1});
        relations();
        fields();
        walks();
        falls();
        say_actions(scene_);
        return scene_;
    }

  private:
    void describe() {
        scene_.source = "made-up <room> & \"hall\" </script><b>.ply";
        scene_.topple_version = "0.1.0";
        scene_.backend = "native";
        scene_.device = "12 threads";
        scene_.voxel_size_m = h_;
        scene_.up_method = "manhattan";
        scene_.manhattan_found = true;
        scene_.manhattan_from_input = {c_, s_, 0, 0, -s_, c_, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        scene_.timings_s = {{"ingest", 0.31},
                            {"normals", 0.62},
                            {"segments", 0.4},
                            {"volume", 2.1},
                            {"sampler", 1.7}};
        for (int i = 0; i < 120; ++i) scene_.swc_energy.push_back(40 + 160 * std::exp(-i / 18.0));
        scene_.notes = {"A note with <i>markup</i> that must show as text.",
                        "12 % of the points belong to no primitive."};
        const struct {
            bool grounded;
            double mass, barrier, release, human, wind, earthquake, unsafety;
            const char* mode;
        } objects[] = {{true, 5200, 0, 0, 0, 0, 0, 1, "none"},
                       {false, 41, 62, 180, 0.4, 0, 1.1, 2.6, "tip"},
                       {false, 0.4, 0.05, 2.9, 1.9, 0.01, 2.2, 8.7, "slide"},
                       {false, 6.2, 1.4, 44, 6.5, 0.2, 5.8, 10, "tip"},
                       {false, 88, 21, 410, 1.2, 0, 3.7, 5.1, "tip"},
                       {false, 0.9, 0, 0, 0, 0, 0, 1.4, "none"}};
        for (int id = 0; id < 6; ++id) {
            const auto& o = objects[id];
            Object object;
            object.id = id;
            object.grounded = o.grounded;
            object.mass_kg = o.mass;
            object.barrier_J = o.barrier;
            object.release_J = o.release;
            object.mode = o.mode;
            object.unsafety = o.unsafety;
            object.unsafety_category = o.unsafety > 8 ? "high" : o.unsafety > 2 ? "low" : "none";
            object.unsafety_certain = id != 3;
            object.risk_J = {{"human", o.human}, {"wind", o.wind}, {"earthquake", o.earthquake}};
            for (const auto& [name, risk] : object.risk_J) {
                object.risk_spread_J[name] = 0.1 * risk;
                object.risk_error_J[name] = 0.2 * risk;
                object.fall_chance[name] = risk > 0 ? 0.025 : 0;
            }
            if (object.mode != "none") object.direction = at(1, 0, 0);
            if (o.release > 0) {
                object.instability = {{o.barrier, 0.6 * o.release},
                                      {1.8 * o.barrier, 0.85 * o.release},
                                      {3 * o.barrier, o.release}};
            }
            if (!o.grounded) {
                object.why.sentence =
                    std::string("It ") + (o.mode[0] == 't' ? "tips over." : "stays.");
                object.why.azimuth_deg = 90;
                object.why.drop_m = 0.5;
                object.why.W_J = o.barrier;
                object.why.S_J = o.release;
                object.landscape = landscape();
            }
            scene_.objects.push_back(object);
        }
    }

    // Of a cube of 0.2 m: two poses with a border, and a few places.
    Landscape landscape() const {
        Landscape l;
        for (const double x : {-0.1, 0.1}) {
            for (const double y : {-0.1, 0.1}) {
                for (const double z : {-0.1, 0.1}) l.hull_m.push_back(at(x, y, z));
            }
        }
        const double inf = std::numeric_limits<double>::infinity(), half = std::sqrt(0.5);
        l.poses = {{{0, 0, 1}, 0, inf, -1, 0.5}, {at(1, 0, 0), 0, 1, 0, 0.5}};
        l.passes = {{at(half, 0, half), 1, {0, 1}, {at(0.6, 0.5, 0.62), at(half, 0, half)}}};
        l.now = 0;
        l.places = {3, h_, {0, 1, 2, 1, 0, 1, -3, static_cast<float>(inf), 2}};
        return l;
    }

    int add(int object, const char* model) {
        Primitive primitive;
        primitive.id = static_cast<int>(scene_.primitives.size());
        primitive.object = object;
        primitive.model = model;
        scene_.primitives.push_back(primitive);
        scene_.objects[object].primitives.push_back(primitive.id);
        return primitive.id;
    }

    Vec3 at(double x, double y, double z) const { return {c_ * x - s_ * y, s_ * x + c_ * y, z}; }

    // Voxels of a box on the grid, and points on its face that looks along `normal`.
    void box(int id, double x0, double y0, double z0, double x1, double y1, double z1,
             const Vec3& normal) {
        auto& primitive = scene_.primitives[id];
        auto& object = scene_.objects[primitive.object];
        const auto cells = [&](double low, double high) {
            return std::pair(std::lround(low / h_),
                             std::max(std::lround(high / h_), std::lround(low / h_) + 1));
        };
        const auto [i0, i1] = cells(x0, x1);
        const auto [j0, j1] = cells(y0, y1);
        const auto [k0, k1] = cells(z0, z1);
        const auto n = at(normal[0], normal[1], normal[2]);
        for (long i = i0; i < i1; ++i) {
            for (long j = j0; j < j1; ++j) {
                for (long k = k0; k < k1; ++k) {
                    const bool surface =
                        i == i0 || j == j0 || k == k0 || i == i1 - 1 || j == j1 - 1 || k == k1 - 1;
                    const auto p =
                        at((double(i) + 0.5) * h_, (double(j) + 0.5) * h_, (double(k) + 0.5) * h_);
                    auto& s = scene_.solid;
                    test::add(s, p[0], p[1], p[2]);
                    s.primitive.push_back(id);
                    s.object.push_back(primitive.object);
                    s.state.push_back(surface ? 0 : 1);
                    ++primitive.solid_voxels;
                    if (!surface) continue;
                    auto& q = scene_.points;
                    test::add(q, p[0], p[1], p[2]);
                    q.nx.push_back(float(n[0]));
                    q.ny.push_back(float(n[1]));
                    q.nz.push_back(float(n[2]));
                    q.primitive.push_back(id);
                    q.object.push_back(primitive.object);
                    ++primitive.points;
                }
            }
        }
        primitive.volume_m3 = double(primitive.solid_voxels) * h_ * h_ * h_;
        primitive.mass_kg = 700 * primitive.volume_m3;
        primitive.center_of_mass_m = object.center_of_mass_m =
            at((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2);
        auto& ends = ends_.try_emplace(primitive.object, std::array{nowhere, nowhere, nowhere})
                         .first->second;
        const std::array<std::pair<long, long>, 3> cell{{{i0, i1}, {j0, j1}, {k0, k1}}};
        Vec3 middle{};
        for (std::size_t a = 0; a < 3; ++a) {
            ends[a].first = std::min(ends[a].first, cell[a].first);
            ends[a].second = std::max(ends[a].second, cell[a].second);
            middle[a] = h_ * double(ends[a].first + ends[a].second) / 2;
        }
        object.box_middle_m = at(middle[0], middle[1], middle[2]);
    }

    void relations() {
        scene_.supports = {{0, 1, 0.04}, {1, 2, 0.012}, {1, 3, 0.05}, {0, 4, 0.6}, {0, 5, 0.002}};
        scene_.contacts = {{0, 1, 12, {1, 0, 0}, "fixed", 0.99},
                           {3, 5, 0.012, {0, 0, 1}, "support", 0.2},
                           {3, 6, 0.05, {0, 0, 1}, "support", 0.1}};
    }

    void fields() {
        for (const char* name : {"human", "wind", "earthquake"}) {
            auto& field = scene_.fields[name];
            for (double x = 0.2; x < 4; x += 0.2) {
                for (double y = 0.2; y < 5; y += 0.2) {
                    const auto p = at(x, y, name[0] == 'h' ? 0.9 : 1.5);
                    const auto v = name[0] == 'e' ? at(1, 0, 0) : at(std::sin(y), std::cos(x), 0);
                    test::add(field, p[0], p[1], p[2]);
                    field.vx.push_back(float(v[0]));
                    field.vy.push_back(float(v[1]));
                    field.vz.push_back(float(v[2]));
                    field.density.push_back(float(0.5 + 0.5 * std::sin(x)));
                }
            }
        }
    }

    // People walk everywhere but within 0.5 m of the table; one path along its west.
    void walks() {
        auto& walks = scene_.walks;
        walks.corner_m = at(0, 0, 0);
        walks.along_x_m = at(0.1, 0, 0);
        walks.along_y_m = at(0, 0.1, 0);
        walks.nx = 40;
        walks.ny = 50;
        for (std::int64_t y = 0; y < walks.ny; ++y) {
            for (std::int64_t x = 0; x < walks.nx; ++x) {
                const bool table = x >= 5 && x < 29 && y >= 15 && y < 33;
                walks.floor_m.push_back(0);
                walks.visits.push_back(table ? -1.0f : 0.002f * static_cast<float>(x));
            }
        }
        walks.paths = {{at(0.3, 0.3, 0), at(0.3, 4.7, 0), at(3.2, 4.7, 0)}};
    }

    // The monitor falls off the table with the cup, to its north; the cup should be moved.
    void falls() {
        Object& monitor = scene_.objects[3];
        monitor.fall = {true, at(1.9, 3.2, 0.2), 0.76, 0, -1, {2}, 44, 0.12};
        monitor.overturning = {15.2, 0.4, {}, 31.4, 1.2, 18.3, 0.2717};
        monitor.fragility = {0.41,  0.3, 0.36, 0.52, 0.28, {{0.2, 0.01}, {0.4, 0.45}, {0.8, 0.98}},
                             0.002, 500};
        monitor.advice = {"fix", {}, 0.1, 12, 0.3, "Fix it where it stands: 12 N at 0.3 m."};
        Object& cup = scene_.objects[2];
        cup.fall = {true, at(0.8, 2.26, 0.1), 0.76, 5, -1, {}, 2.9, 0};
        cup.advice = {"move", at(0.2, 0, 0), 0.1, 0, 0, "Move it 20 cm to the east."};
    }

    static constexpr std::pair<long, long> nowhere{std::numeric_limits<long>::max(),
                                                   std::numeric_limits<long>::min()};
    double h_, c_, s_;
    std::map<int, std::array<std::pair<long, long>, 3>> ends_;  // of objects, in voxels
    Scene scene_;
};

}  // namespace topple::test
