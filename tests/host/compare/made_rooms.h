// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "compare/side.h"

// Rooms of voxels, as a parse would find them.
namespace topple::test {

struct MadeBox {
    std::array<int, 3> low, size;  // in voxels of the room, from its corner
    const char* category = "low";
    int on = 0;  // 0: the floor; else the number of the box that carries it, from 1
};

struct MadeRoom {
    std::array<int, 3> size{80, 60, 44};
    std::vector<MadeBox> boxes;
    std::array<int, 3> unseen_low{}, unseen_size{};  // that nobody saw into
    int quarters = 0;                                // that its grid is turned by
    std::array<int, 3> shift{};                      // of its grid
    double yaw_deg = 0;                              // of its input's frame to the grid
    static constexpr double voxel_m = 0.05;

    Eigen::Isometry3d grid_from_room() const {
        Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
        out.translate(voxel_m * Eigen::Vector3d(shift[0], shift[1], shift[2]));
        out.rotate(Eigen::AngleAxisd(quarters * M_PI / 2, Eigen::Vector3d::UnitZ()));
        return out;
    }
    Eigen::Isometry3d input_from_grid() const {
        Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
        out.translate(Eigen::Vector3d(yaw_deg, -yaw_deg, yaw_deg / 10));
        out.rotate(Eigen::AngleAxisd(yaw_deg * M_PI / 180, Eigen::Vector3d::UnitZ()));
        return out;
    }

    // The object at a voxel: 0 the building, then boxes; -1: free; -2: unseen.
    int at(int i, int j, int k) const {
        const std::array<int, 3> place{i, j, k};
        const auto within = [&](const std::array<int, 3>& low, const std::array<int, 3>& extent) {
            for (std::size_t a = 0; a < 3; ++a)
                if (place[a] < low[a] || place[a] >= low[a] + extent[a]) return false;
            return true;
        };
        if (!within({0, 0, 0}, size)) return 0;
        if (within(unseen_low, unseen_size)) return -2;
        for (std::size_t n = 0; n < boxes.size(); ++n)
            if (within(boxes[n].low, boxes[n].size)) return static_cast<int>(n) + 1;
        return -1;
    }

    comparing::Side side() const {
        Scene scene;
        scene.source = "made";
        scene.voxel_size_m = voxel_m;
        const Eigen::Isometry3d to_input = input_from_grid(), to_grid = grid_from_room();
        const Eigen::Matrix4d manhattan = to_input.inverse().matrix();
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c)
                scene.manhattan_from_input[static_cast<std::size_t>(4 * r + c)] = manhattan(r, c);
        SpaceMap space;
        space.voxel_m = voxel_m;
        std::vector<comparing::SurfacePoint> surface;
        const auto middle = [&](int i, int j, int k) -> Eigen::Vector3d {
            return to_grid * (voxel_m * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5));
        };
        for (int i = -1; i <= size[0]; ++i)
            for (int j = -1; j <= size[1]; ++j)
                for (int k = -1; k <= size[2]; ++k) {
                    const int object = at(i, j, k);
                    const Eigen::Vector3d place = middle(i, j, k);
                    if (object == -1) {
                        SpaceMap::Box box;
                        for (int a = 0; a < 3; ++a)
                            box.low[static_cast<std::size_t>(a)] =
                                static_cast<std::int32_t>(std::floor(place[a] / voxel_m));
                        box.high = box.low;
                        space.free.push_back(box);
                        continue;
                    }
                    if (object < 0) continue;
                    bool seen = false;
                    for (int step = 0; step < 6; ++step) {
                        std::array<int, 3> next{i, j, k};
                        next[static_cast<std::size_t>(step / 2)] += step % 2 ? -1 : 1;
                        if (at(next[0], next[1], next[2]) != -1) continue;
                        seen = true;
                        const Eigen::Vector3d away = middle(next[0], next[1], next[2]) - place;
                        const Eigen::Vector3d face = place + away / 2, normal = away.normalized();
                        surface.push_back({{face.x(), face.y(), face.z()},
                                           {normal.x(), normal.y(), normal.z()},
                                           object == 0});
                    }
                    const Eigen::Vector3d in_input = to_input * place;
                    scene.solid.x.push_back(static_cast<float>(in_input.x()));
                    scene.solid.y.push_back(static_cast<float>(in_input.y()));
                    scene.solid.z.push_back(static_cast<float>(in_input.z()));
                    scene.solid.object.push_back(object);
                    scene.solid.primitive.push_back(object);
                    scene.solid.state.push_back(seen ? 0 : 1);
                }
        scene.objects.emplace_back().grounded = true;
        for (const MadeBox& box : boxes) {
            Object object;
            object.unsafety_category = box.category;
            object.risk_J["wind"] = box.category == std::string("high") ? 20 : 0.1;
            object.risk_error_J["wind"] = 1;
            object.size_m = {voxel_m * box.size[0], voxel_m * box.size[1], voxel_m * box.size[2]};
            if (quarters % 2) std::swap(object.size_m[0], object.size_m[1]);
            const Eigen::Vector3d at = to_input * to_grid *
                                       (voxel_m * Eigen::Vector3d(box.low[0] + box.size[0] / 2.0,
                                                                  box.low[1] + box.size[1] / 2.0,
                                                                  box.low[2] + box.size[2] / 2.0));
            object.box_middle_m = {at.x(), at.y(), at.z()};
            scene.supports.push_back({box.on, static_cast<int>(scene.objects.size()), 0.1});
            scene.objects.push_back(object);
        }
        for (std::size_t n = 0; n < scene.objects.size(); ++n) {
            scene.objects[n].id = static_cast<std::int32_t>(n);
            Primitive part;
            part.id = part.object = static_cast<std::int32_t>(n);
            part.volume_m3 = n == 0 ? 10
                                    : scene.objects[n].size_m[0] * scene.objects[n].size_m[1] *
                                          scene.objects[n].size_m[2];
            scene.primitives.push_back(part);
        }
        comparing::SeenSpace seen(scene, space);
        return {std::move(scene), std::move(seen), std::move(surface)};
    }
};

}  // namespace topple::test
