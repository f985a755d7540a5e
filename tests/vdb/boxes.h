// SPDX-License-Identifier: MIT
#pragma once

#include "clouds.h"

// Analytic boxes seen by pinhole cameras: depth frames, and the points and labels they give.
namespace topple::test {

struct TestBox {
    Vec3 low, high;
    bool contains(const Vec3& p, double slack) const {
        for (int a = 0; a < 3; ++a) {
            if (p[a] < low[a] - slack || p[a] > high[a] + slack) return false;
        }
        return true;
    }
    // Distance along the ray, infinite for a miss.
    double hit(const Vec3& from, const Vec3& way) const {
        double enter = 0, leave = std::numeric_limits<double>::infinity();
        for (int a = 0; a < 3; ++a) {
            if (way[a] == 0) {
                if (from[a] < low[a] || from[a] > high[a])
                    return std::numeric_limits<double>::infinity();
                continue;
            }
            const double t0 = (low[a] - from[a]) / way[a], t1 = (high[a] - from[a]) / way[a];
            enter = std::max(enter, std::min(t0, t1));
            leave = std::min(leave, std::max(t0, t1));
        }
        return enter <= leave && enter > 0 ? enter : std::numeric_limits<double>::infinity();
    }
};

struct Boxes {
    Intrinsics intrinsics{160, 120, 140, 140, 79.5, 59.5, 1000};
    std::vector<TestBox> boxes;
    std::vector<DepthFrame> frames;
    PointCloud cloud;
    std::vector<std::int32_t> label;

    // Adds what a camera at `eye` sees when it looks at `target`, z up.
    void look(const Vec3& eye, const Vec3& target) {
        Vec3 forward, right, down;
        double norm = 0;
        for (int a = 0; a < 3; ++a) norm += (target[a] - eye[a]) * (target[a] - eye[a]);
        for (int a = 0; a < 3; ++a) forward[a] = (target[a] - eye[a]) / std::sqrt(norm);
        const double flat = std::hypot(forward[0], forward[1]);
        right = {forward[1] / flat, -forward[0] / flat, 0};
        down = {forward[1] * right[2] - forward[2] * right[1],
                forward[2] * right[0] - forward[0] * right[2],
                forward[0] * right[1] - forward[1] * right[0]};
        DepthFrame frame;
        for (int a = 0; a < 3; ++a) {
            frame.camera_to_world[4 * a] = right[a];
            frame.camera_to_world[4 * a + 1] = down[a];
            frame.camera_to_world[4 * a + 2] = forward[a];
            frame.camera_to_world[4 * a + 3] = eye[a];
        }
        for (std::uint32_t v = 0; v < intrinsics.height; ++v) {
            for (std::uint32_t u = 0; u < intrinsics.width; ++u) {
                Vec3 way;
                for (int a = 0; a < 3; ++a) {
                    way[a] = right[a] * (u - intrinsics.cx) / intrinsics.fx +
                             down[a] * (v - intrinsics.cy) / intrinsics.fy + forward[a];
                }
                double best = std::numeric_limits<double>::infinity();
                std::int32_t which = -1;
                for (std::size_t b = 0; b < boxes.size(); ++b) {
                    const double t = boxes[b].hit(eye, way);
                    if (t < best) {
                        best = t;
                        which = static_cast<std::int32_t>(b);
                    }
                }
                frame.depth.push_back(
                    which < 0 ? 0 : static_cast<std::uint16_t>(std::lround(best * 1000)));
                if (which < 0) continue;
                test::add(cloud, eye[0] + best * way[0], eye[1] + best * way[1],
                          eye[2] + best * way[2]);
                label.push_back(which);
            }
        }
        frames.push_back(std::move(frame));
    }

    // A floor (label 0), and two boxes that stand on it and touch one another, seen from all
    // around.
    static Boxes on_a_floor() {
        Boxes scene;
        scene.boxes = {{{-2, -2, -0.2}, {2, 2, 0}},
                       {{-0.3, -0.2, 0}, {0, 0.2, 0.4}},
                       {{0, -0.2, 0}, {0.25, 0.2, 0.26}}};
        for (int n = 0; n < 8; ++n) {
            const double angle = 0.3 + n * 3.14159265 / 4;
            scene.look({1.5 * std::cos(angle), 1.5 * std::sin(angle), 1.2}, {0, 0, 0.1});
        }
        return scene;
    }
};

}  // namespace topple::test
