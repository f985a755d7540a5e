// SPDX-License-Identifier: MIT
#pragma once

#include "clouds.h"
#include "core/random.h"
#include "testing.h"
#include "topple/device.h"
#include "topple/parse.h"

// A cloud small enough to be parsed in a second, and spoilt in many ways.
namespace topple::test {

// Floor, four walls, a crate on the floor and a box on the crate, each without its underside; z up.
struct SmallRoom {
    enum Part : std::int32_t { floor, west, south, east, north, crate, box, parts };

    PointCloud cloud;
    std::vector<std::int32_t> part;  // of each point

    // A point of a rectangle, from 0 to 1 along its sides; how densely, as a share of `per_m2`.
    struct Face {
        Vec3 corner, u, v;
        Part part;
        Vec3 at(double s, double t) const {
            return {corner[0] + s * u[0] + t * v[0], corner[1] + s * u[1] + t * v[1],
                    corner[2] + s * u[2] + t * v[2]};
        }
    };
    static std::vector<Face> faces() {
        std::vector<Face> out{{{0, 0, 0}, {2.8, 0, 0}, {0, 2.4, 0}, floor},
                              {{0, 0, 0}, {0, 2.4, 0}, {0, 0, 1.4}, west},
                              {{0, 0, 0}, {2.8, 0, 0}, {0, 0, 1.4}, south},
                              {{2.8, 0, 0}, {0, 2.4, 0}, {0, 0, 1.4}, east},
                              {{0, 2.4, 0}, {2.8, 0, 0}, {0, 0, 1.4}, north}};
        const auto upright_box = [&](const Vec3& low, const Vec3& size, Part part) {
            const Vec3 x{size[0], 0, 0}, y{0, size[1], 0}, z{0, 0, size[2]};
            out.push_back({{low[0], low[1], low[2] + size[2]}, x, y, part});
            out.push_back({low, x, z, part});
            out.push_back({{low[0], low[1] + size[1], low[2]}, x, z, part});
            out.push_back({low, y, z, part});
            out.push_back({{low[0] + size[0], low[1], low[2]}, y, z, part});
        };
        upright_box({1.0, 0.9, 0}, {0.7, 0.6, 0.5}, crate);
        upright_box({1.2, 1.1, 0.5}, {0.25, 0.2, 0.35}, box);
        return out;
    }

    void add(const Vec3& p, std::int32_t of) {
        test::add(cloud, p[0], p[1], p[2]);
        part.push_back(of);
    }
    // Random points on all faces, `density(face's part, point)` per square metre, `most` at most.
    template <class Density>
    static SmallRoom scattered(double most, const Density& density, std::uint64_t seed = 1) {
        SmallRoom room;
        room.cloud.source = "room";
        topple::Random random(seed);
        for (const Face& face : faces()) {
            const auto length = [](const Vec3& d) { return d[0] + d[1] + d[2]; };  // along an axis
            const auto count = static_cast<std::size_t>(length(face.u) * length(face.v) * most);
            for (std::size_t n = 0; n < count; ++n) {
                const double s = random.uniform(), t = random.uniform(), draw = random.uniform();
                const Vec3 p = face.at(s, t);
                if (draw * most < density(face.part, p)) room.add(p, face.part);
            }
        }
        return room;
    }
    static SmallRoom scattered() {
        return scattered(2500, [](Part, const Vec3&) { return 2500.0; });
    }
    // Points in rows and columns, exactly on the surface.
    static SmallRoom regular(double step_m) {
        SmallRoom room;
        room.cloud.source = "room";
        for (const Face& face : faces()) {
            const auto steps = [&](const Vec3& d) {
                return static_cast<int>((d[0] + d[1] + d[2]) / step_m);
            };
            const int nu = steps(face.u), nv = steps(face.v);
            for (int a = 0; a <= nu; ++a)
                for (int b = 0; b <= nv; ++b)
                    room.add(face.at(double(a) / nu, double(b) / nv), face.part);
        }
        return room;
    }
};

// What of it any test may look at that takes no parse of its own.
class ParsedRoom : public ::testing::Test {
  protected:
    static ParseOptions quick() {
        ParseOptions options;
        options.device = device::open_device("native");
        options.disturbances = {};
        return options;
    }
    static const SmallRoom& room() {
        static const SmallRoom made = [] {
            SmallRoom scattered = SmallRoom::scattered();
            scattered.cloud.dropped = 1234;  // as readers leave out points that are not finite
            return scattered;
        }();
        return made;
    }
    static const ParseResult& result() {
        static const ParseResult parsed = parse(room().cloud, quick());
        return parsed;
    }
};

}  // namespace topple::test
