// SPDX-License-Identifier: MIT
#include "errors.h"
#include "host/physics/solids.h"
#include "oracle/geodesic_sphere.h"
#include "physics/merge_close_points.h"
#include "physics/part_hulls.h"
#include "physics/rectangle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::physics {
namespace {

// Random cells with random labels, -1 among them.
SolidCells random_cells(std::uint64_t seed, std::int32_t side, std::int32_t labels,
                        std::int32_t offset = 0) {
    test::Random random(seed);
    SolidCells cells;
    cells.voxel_m = 0.02;
    for (std::int32_t i = 0; i < side; ++i) {
        for (std::int32_t j = 0; j < side; ++j) {
            for (std::int32_t k = 0; k < side; ++k) {
                if (random.word() % 3) continue;
                cells.i.push_back(i + offset);
                cells.j.push_back(j - offset);
                cells.k.push_back(k + offset / 2);
                const auto label = static_cast<std::int32_t>(
                    random.word() % static_cast<std::uint32_t>(labels + 1));
                cells.primitive.push_back(label - 1);
                cells.basis.push_back(Basis::half_enclosed);
            }
        }
    }
    return cells;
}

class Bodies : public test::EachBackend {};
TOPPLE_ON_EACH_BACKEND(Bodies);

TEST_P(Bodies, MassesMatchPlainSums) {
    for (const std::int32_t side : {1, 2, 9, 30}) {
        const SolidCells cells = random_cells(static_cast<std::uint64_t>(side), side, 5, 70000);
        const std::vector<double> density{700, 500, 1, 2, 3, 9};
        const std::vector<MassProperties> bodies = mass_properties(*device, cells, 6, density);
        for (std::int32_t label = 0; label < 6; ++label) {
            std::uint64_t count = 0;
            long double sum[3] = {0, 0, 0};
            for (std::size_t n = 0; n < cells.size(); ++n) {
                if (cells.primitive[n] != label) continue;
                ++count;
                sum[0] += cells.i[n] + 0.5L;
                sum[1] += cells.j[n] + 0.5L;
                sum[2] += cells.k[n] + 0.5L;
            }
            const MassProperties& b = bodies[label];
            EXPECT_EQ(b.voxels, count);
            EXPECT_NEAR(b.mass_kg, static_cast<double>(count) * 8e-6 * density[label], 1e-12);
            for (std::size_t a = 0; a < 3 && count; ++a)
                EXPECT_NEAR(b.center[a], static_cast<double>(sum[a] / count * 0.02L), 1e-9);
        }
    }
    EXPECT_TRUE(mass_properties(*device, SolidCells{}, 0, {}).empty());
}

TEST_P(Bodies, TouchingPairsMatchASearch) {
    for (const unsigned gap : {0U, 1U, 2U}) {
        const SolidCells cells = random_cells(gap + 7, 11, 4, -40);
        std::map<std::array<std::int32_t, 3>, std::int32_t> at;
        for (std::size_t n = 0; n < cells.size(); ++n)
            at[{cells.i[n], cells.j[n], cells.k[n]}] = cells.primitive[n];
        std::map<std::pair<std::int32_t, std::int32_t>, std::array<std::uint32_t, 6>> want;
        for (const auto& [place, label] : at) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const int sign : {-1, 1}) {
                    std::array<std::int32_t, 3> p = place;
                    for (unsigned step = 0; step <= gap; ++step) {
                        p[axis] += sign;
                        const auto found = at.find(p);
                        if (found == at.end()) continue;
                        if (label >= 0 && found->second > label)
                            ++want[{label, found->second}][axis * 2 + (sign > 0)];
                        break;
                    }
                }
            }
        }
        const std::vector<TouchingPair> pairs = touching_pairs(*device, cells, 4, gap);
        ASSERT_EQ(pairs.size(), want.size());
        std::size_t n = 0;
        for (const auto& [labels, faces] : want) {
            EXPECT_EQ(pairs[n].a, labels.first);
            EXPECT_EQ(pairs[n].b, labels.second);
            EXPECT_EQ(pairs[n].faces, faces);
            EXPECT_NEAR(pairs[n].area_m2, *std::max_element(faces.begin(), faces.end()) * 4e-4,
                        1e-12);
            ++n;
        }
    }
}

TEST_P(Bodies, ACupOnATableTouchesUpwards) {
    const SolidCells cells = test::voxelise({{0, test::box({0, 0, 0}, {0.5, 0.5, 0.1})},
                                             {1, test::box({0.1, 0.1, 0.12}, {0.2, 0.2, 0.2})}},
                                            {0, 0, 0}, {0.5, 0.5, 0.2}, 0.02);
    const std::vector<TouchingPair> pairs = touching_pairs(*device, cells, 2);
    ASSERT_EQ(pairs.size(), 1U);  // across the gap of one voxel
    EXPECT_EQ(pairs[0].normal, (Vec3{0, 0, 1}));
    EXPECT_NEAR(pairs[0].area_m2, 0.01, 1e-9);
    EXPECT_NEAR(pairs[0].center[0], 0.15, 1e-9);
    EXPECT_NEAR(pairs[0].center[2], 0.11, 1e-9);
    // Middles of its outermost faces, half a voxel inside its border.
    EXPECT_NEAR(pairs[0].ends[0][0], 0.11, 1e-9);
    EXPECT_NEAR(pairs[0].ends[1][0], 0.19, 1e-9);
    EXPECT_NEAR(pairs[0].ends[2][1], 0.11, 1e-9);
    EXPECT_NEAR(pairs[0].ends[3][1], 0.19, 1e-9);
    EXPECT_TRUE(touching_pairs(*device, cells, 2, 0).empty());
    SolidCells unsorted = cells;
    std::swap(unsorted.k.front(), unsorted.k.back());
    EXPECT_THROW(touching_pairs(*device, unsorted, 2), Error);
    EXPECT_THROW(touching_pairs(*device, cells, 1), Error);
}

TEST(VoxelHulls, SupportEveryCorner) {
    for (std::uint64_t seed = 1; seed < 12; ++seed) {
        SolidCells cells = random_cells(seed, static_cast<std::int32_t>(seed), 2, 9);
        if (seed == 11) {  // flat
            for (auto& k : cells.k) k = 4;
            SolidCells flat;
            flat.voxel_m = cells.voxel_m;
            for (std::size_t n = 0; n < cells.size(); ++n) {
                if (n && cells.i[n] == cells.i[n - 1] && cells.j[n] == cells.j[n - 1]) continue;
                flat.i.push_back(cells.i[n]);
                flat.j.push_back(cells.j[n]);
                flat.k.push_back(4);
                flat.primitive.push_back(0);
                flat.basis.push_back(Basis::half_enclosed);
            }
            cells = flat;
        }
        const auto hulls = voxel_hulls(cells, 3);
        const test::SphereMesh mesh = test::geodesic_sphere(5);
        for (std::int32_t label = 0; label < 3; ++label) {
            for (std::size_t d = 0; d < mesh.size(); ++d) {
                const auto along = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
                    return double{mesh.x[d]} * i + double{mesh.y[d]} * j + double{mesh.z[d]} * k;
                };
                double all = 1e30, hull = 1e30;
                for (std::size_t n = 0; n < cells.size(); ++n) {
                    if (cells.primitive[n] != label) continue;
                    for (int c = 0; c < 8; ++c) {
                        all = std::min(all, along(cells.i[n] + (c & 1), cells.j[n] + (c >> 1 & 1),
                                                  cells.k[n] + (c >> 2)));
                    }
                }
                for (const auto& c : hulls[label]) hull = std::min(hull, along(c[0], c[1], c[2]));
                ASSERT_NEAR(all, hull, 1e-9) << "seed " << seed << " label " << label;
            }
        }
    }
    const SolidCells cube = test::voxelise({{0, test::box({0, 0, 0}, {0.6, 0.6, 0.6})}}, {0, 0, 0},
                                           {0.6, 0.6, 0.6}, 0.02);
    EXPECT_EQ(voxel_hulls(cube, 1)[0].size(), 8U);
}

TEST(Footings, SignedDistances) {
    const std::vector<std::array<double, 2>> square{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
    EXPECT_NEAR(footing(square, 0.5, 0.4).margin_m, 0.4, 1e-12);
    EXPECT_NEAR(footing(square, -3, 5).margin_m, -5, 1e-12);
    EXPECT_NEAR(footing(square, -3, 5).away[0], -0.6, 1e-12);
    EXPECT_NEAR(footing(std::vector<std::array<double, 2>>{{1, 1}}, 4, 5).margin_m, -5, 1e-12);
    EXPECT_LE(footing(std::vector<std::array<double, 2>>{{0, 0}, {1, 0}}, 0.5, 0).margin_m, 0);
    const auto hull = convex_polygon({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}, {1, 0.5}, {0, 0}});
    EXPECT_EQ(hull, square);
}

using Corners = std::vector<std::array<double, 2>>;

TEST(SmallestRectangle, OfATurnedRectangleIsItself) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    Corners polygon;
    for (const auto& [x, y] : {std::array{-2.0, -0.5}, {2.0, -0.5}, {2.0, 0.5}, {-2.0, 0.5}})
        polygon.push_back({3 + c * x - s * y, 1 + s * x + c * y});
    const Rectangle r = smallest_rectangle(polygon);
    EXPECT_NEAR(r.area(), 4, 1e-12);
    EXPECT_NEAR(r.middle[0], 3, 1e-12);
    EXPECT_NEAR(r.middle[1], 1, 1e-12);
    EXPECT_NEAR(std::abs(r.axes[0][0] * c + r.axes[0][1] * s), 1, 1e-12);
    EXPECT_NEAR(r.half[0], 2, 1e-12);
    EXPECT_NEAR(r.half[1], 0.5, 1e-12);
}

// Of all turns of a box around a triangle none is smaller.
TEST(SmallestRectangle, NoTurnIsSmaller) {
    const Corners triangle{{0, 0}, {3, 0.5}, {1, 2}};
    const double least = smallest_rectangle(triangle).area();
    for (int n = 0; n < 900; ++n) {
        const double angle = 1e-3 * n * 3.1416 / 1.8, c = std::cos(angle), s = std::sin(angle);
        double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
        for (const auto& [x, y] : triangle) {
            const double at[2] = {c * x + s * y, c * y - s * x};
            for (int a = 0; a < 2; ++a) {
                low[a] = std::min(low[a], at[a]);
                high[a] = std::max(high[a], at[a]);
            }
        }
        EXPECT_GE((high[0] - low[0]) * (high[1] - low[1]), least - 1e-9);
    }
}

TEST(SmallestRectangle, WithoutAnAreaThereIsNone) {
    EXPECT_EQ(smallest_rectangle(Corners{}).area(), 0);
    EXPECT_EQ(smallest_rectangle(Corners{{1, 2}}).area(), 0);
    EXPECT_EQ(smallest_rectangle(Corners{{1, 2}, {2, 2}}).area(), 0);
}

TEST(Weld, KeepsTheFirstOfPointsThatAreAllButTheSame) {
    const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1e-4, 0, 0}, {1, 0, 2e-3}, {1, 1e-4, 0}};
    const std::vector<Vec3> kept{{0, 0, 0}, {1, 0, 0}, {1, 0, 2e-3}};
    EXPECT_EQ(merge_close_points(points, 1e-3), kept);
    EXPECT_EQ(merge_close_points(points, 1e-6), points);
    EXPECT_TRUE(merge_close_points({}, 1e-3).empty());
}

// Two points may be close and yet in different cells of whatever grid finds them.
TEST(Weld, DoesNotDependOnWherePointsLie) {
    for (int n = -50; n < 50; ++n) {
        const double x = 0.00137 * n;
        EXPECT_EQ(merge_close_points({{x, -x, x}, {x + 5e-4, -x, x - 5e-4}}, 1e-3).size(), 1u) << n;
        EXPECT_EQ(merge_close_points({{x, -x, x}, {x + 1.1e-3, -x, x}}, 1e-3).size(), 2u) << n;
    }
}

}  // namespace
}  // namespace topple::physics
