// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "clouds.h"
#include "geometry/segmentation.h"

// Surfels of analytic bodies with known normals, made here without the kernel that estimates them.
namespace topple::geometry::scenes {

struct Builder {
    double cell_m = 0.02;
    double noise_m = 0;        // standard deviation along the normal
    std::uint64_t state = 42;  // of the noise
    std::vector<Eigen::Vector3d> points, normals;
    std::vector<int> body;

    // Roughly normal: twelve uniforms.
    double noise() {
        double sum = -6;
        for (int k = 0; k < 12; ++k) {
            state = state * 6364136223846793005ull + 1442695040888963407ull;
            sum += static_cast<double>(state >> 11) * 0x1p-53;
        }
        return noise_m * sum;
    }
    void point(const Eigen::Vector3d& p, const Eigen::Vector3d& n, int of) {
        points.push_back(p + noise() * n);
        normals.push_back(n);
        body.push_back(of);
    }
    // Parallelogram from `corner` along u and v; its normal is u x v.
    void face(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
              int of) {
        const double step = cell_m / 2;
        const auto nu = static_cast<int>(u.norm() / step), nv = static_cast<int>(v.norm() / step);
        const Eigen::Vector3d n = u.cross(v).normalized();
        for (int a = 0; a < nu; ++a)
            for (int b = 0; b < nv; ++b)
                point(corner + (a + 0.5) / nu * u + (b + 0.5) / nv * v, n, of);
    }
    // Box without its bottom.
    void box(const Eigen::Vector3d& low, const Eigen::Vector3d& size, int of) {
        const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
        face(low + z, x, y, of);
        face(low, x, z, of);
        face(low + x, y, z, of);
        face(low + x + y, -x, z, of);
        face(low + y, -y, z, of);
    }
    void ball(const Eigen::Vector3d& centre, double r, int of) {
        const double step = cell_m / 2 / r;
        for (double a = step; a < EIGEN_PI - step / 2; a += step)
            for (double b = 0; b < 2 * EIGEN_PI; b += step / std::sin(a)) {
                const Eigen::Vector3d n(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b),
                                        std::cos(a));
                point(centre + r * n, n, of);
            }
    }
    // The mantle of an upright tube standing at `foot`, and its top if `closed`.
    void tube(const Eigen::Vector3d& foot, double r, double height, bool closed, int of) {
        const double step = cell_m / 2;
        for (double b = 0; b < 2 * EIGEN_PI; b += step / r) {
            const Eigen::Vector3d n(std::cos(b), std::sin(b), 0);
            for (double z = step / 2; z < height; z += step)
                point(foot + r * n + Eigen::Vector3d(0, 0, z), n, of);
        }
        for (double x = -r; closed && x < r; x += step)
            for (double y = -r; y < r; y += step)
                if (x * x + y * y < r * r)
                    point(foot + Eigen::Vector3d(x, y, height), Eigen::Vector3d(0, 0, 1), of);
    }

    Surfels surfels() const {
        using Cell = std::array<std::int32_t, 3>;
        std::map<Cell, std::vector<std::size_t>> cells;
        for (std::size_t i = 0; i < points.size(); ++i) {
            Cell c;
            for (int a = 0; a < 3; ++a)
                c[a] = static_cast<std::int32_t>(std::floor(points[i][a] / cell_m));
            cells[c].push_back(i);
        }
        Surfels s;
        s.cell_m = cell_m;
        s.of_point.resize(points.size());
        std::map<Cell, std::uint32_t> index;
        for (const auto& [cell, members] : cells) {
            Eigen::Vector3d p = Eigen::Vector3d::Zero(), n = Eigen::Vector3d::Zero();
            for (const std::size_t i : members) {
                p += points[i];
                n += normals[i];
                s.of_point[i] = static_cast<std::uint32_t>(s.x.size());
            }
            p /= static_cast<double>(members.size());
            n = n.norm() > 1e-6 ? Eigen::Vector3d(n.normalized()) : Eigen::Vector3d::Zero();
            index[cell] = static_cast<std::uint32_t>(s.x.size());
            s.cx.push_back(cell[0]), s.cy.push_back(cell[1]), s.cz.push_back(cell[2]);
            test::add(s, p);
            test::add_normal(s, n);
            s.weight.push_back(static_cast<float>(members.size()));
        }
        s.neighbour_first.push_back(0);
        for (const auto& [cell, own] : index) {
            double sum = 0, count = 1;
            for (int x = -1; x <= 1; ++x)
                for (int y = -1; y <= 1; ++y)
                    for (int z = -1; z <= 1; ++z) {
                        const auto at = index.find({cell[0] + x, cell[1] + y, cell[2] + z});
                        if ((x == 0 && y == 0 && z == 0) || at == index.end()) continue;
                        const std::uint32_t j = at->second;
                        s.neighbours.push_back(j);
                        const double d = (s.x[j] - s.x[own]) * s.nx[own] +
                                         (s.y[j] - s.y[own]) * s.ny[own] +
                                         (s.z[j] - s.z[own]) * s.nz[own];
                        sum += d * d;
                        count += 1;
                    }
            s.roughness_m.push_back(static_cast<float>(std::sqrt(sum / count)));
            s.neighbour_first.push_back(static_cast<std::uint32_t>(s.neighbours.size()));
        }
        return s;
    }
};

// The label that most points of a body carry, and the share of them that do.
struct Majority {
    std::int32_t label = -1;
    double share = 0;
};
inline Majority majority(const Builder& scene, const Surfels& s,
                         const std::vector<std::int32_t>& label, int body) {
    std::map<std::int32_t, std::size_t> count;
    std::size_t all = 0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        if (scene.body[i] != body) continue;
        ++count[label[s.of_point[i]]];
        ++all;
    }
    Majority best;
    for (const auto& [l, n] : count)
        if (double(n) / double(all) > best.share) best = {l, double(n) / double(all)};
    return best;
}

}  // namespace topple::geometry::scenes
