// SPDX-License-Identifier: MIT
#include "topple/stages.h"

#include <CL/cl.h>

#include "clouds.h"
#include "core/random.h"
#include "errors.h"
#include "topple/embed.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::stages {
namespace {

using ::testing::HasSubstr;
constexpr const char* taken = "nothing was thrown";

std::string words_of(const auto& stage) {
    return test::message_of(stage, std::nullopt);
}

// Rows of points on the floor, and on a wall at x = 0.
PointCloud corner() {
    PointCloud cloud;
    for (int a = 0; a < 60; ++a) {
        for (int b = 0; b < 60; ++b) {
            cloud.x.insert(cloud.x.end(), {0.02f * float(a) + 0.01f, 0});
            cloud.y.insert(cloud.y.end(), {0.02f * float(b), 0.02f * float(b)});
            cloud.z.insert(cloud.z.end(), {0, 0.02f * float(a) + 0.01f});
        }
    }
    return cloud;
}

TEST(Stages, NormalsOfACornerFaceTheEye) {
    const auto device = device::open_device("native");
    PointCloud cloud = corner();
    cloud.x[7] = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> nx(cloud.size(), 9), ny = nx, nz = nx;
    const Vec3 eye{1, 0.6, 1};
    const double cell = 2 * point_spacing(cloud);
    EXPECT_NEAR(cell, 0.04, 1e-3);
    normals(*device, cloud, cell, &eye, nx, ny, nz);
    EXPECT_EQ(nx[7], 0.0f);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (i == 7 || (cloud.x[i] < 0.2f && cloud.z[i] < 0.2f)) continue;
        EXPECT_NEAR(i % 2 ? nx[i] : nz[i], 1, 0.01) << i;
    }
    std::vector<float> few(3);
    EXPECT_THROW(normals(*device, cloud, cell, &eye, few, ny, nz), Error);
    EXPECT_THROW(normals(*device, cloud, -1, &eye, nx, ny, nz), Error);
}

// A sheet that was seen from above on the left, and from below on the right.
TEST(Stages, NormalsFaceWhereEachPointWasSeenFrom) {
    const auto device = device::open_device("native");
    PointCloud cloud;
    for (int i = 0; i < 60; ++i) {
        for (int j = 0; j < 30; ++j) {
            test::add(cloud, 0.01f * static_cast<float>(i), 0.01f * static_cast<float>(j), 0);
            for (auto* values : {&cloud.viewpoint_x, &cloud.viewpoint_y})
                values->push_back(i == 0 ? NAN : 0.1f);
            cloud.viewpoint_z.push_back(i < 30 ? 1.0f : -1.0f);
        }
    }
    std::vector<float> nx(cloud.size()), ny(nx), nz(nx);
    normals(*device, cloud, 0.02, nullptr, nx, ny, nz);
    for (std::size_t n = 0; n < nz.size(); ++n) {
        if (cloud.x[n] > 0.27f && cloud.x[n] < 0.33f) continue;  // cells of both
        EXPECT_NEAR(nz[n], cloud.x[n] < 0.3f ? 1 : -1, 1e-6) << cloud.x[n];
    }
    const Vec3 below{0, 0, -1};
    normals(*device, cloud, 0.02, &below, nx, ny, nz);
    EXPECT_NEAR(nz[5], -1, 1e-6);
    for (auto* values : {&cloud.viewpoint_x, &cloud.viewpoint_y, &cloud.viewpoint_z})
        values->clear();
    cloud.has_viewpoint = true;
    cloud.viewpoint = {0, 0, 2};
    normals(*device, cloud, 0.02, nullptr, nx, ny, nz);
    EXPECT_NEAR(nz[5], 1, 1e-6);
}

// Who has millimetres gets to know it, instead of cells of one point each.
TEST(Stages, UnitsThatAreNoneOfRoomsAreRefused) {
    const auto device = device::open_device("native");
    PointCloud cloud;
    for (int n = 0; n < 900; ++n) test::add(cloud, 10 * (n % 30), 10 * (n / 30), 0);
    std::vector<float> nx(cloud.size()), ny(nx), nz(nx);
    const std::vector<std::int32_t> label(cloud.size(), 0);
    const auto of_normals = [&](double cell_m) {
        return words_of([&] { normals(*device, cloud, cell_m, nullptr, nx, ny, nz); });
    };
    const auto of_volume = [&](double voxel_m) {
        return words_of([&] { Volume(cloud, label, voxel_m); });
    };
    EXPECT_THAT(of_normals(0.02), HasSubstr("290 m and are 10 m apart"));
    EXPECT_THAT(of_volume(0.02), HasSubstr("in cm by 0.01 (2.9 m)"));
    EXPECT_EQ(of_normals(20),
              "normals: cell_m 20: expected metres above 0 and at most 1, about "
              "twice the points' spacing");
    EXPECT_EQ(of_volume(20), "Volume: voxel_m 20: expected metres from 0.001 to 1");
    EXPECT_EQ(of_volume(NAN), "Volume: voxel_m nan: expected metres from 0.001 to 1");
    EXPECT_THAT(words_of([&] { point_spacing(cloud); }), HasSubstr("are 10 m apart"));
    for (auto* values : {&cloud.x, &cloud.y})
        for (float& v : *values) v *= 0.001f;
    EXPECT_EQ(of_normals(0.02), taken);
    EXPECT_EQ(of_volume(0.02), taken);
    EXPECT_EQ(words_of([&] { point_spacing(cloud); }), taken);

    Volume volume(cloud, label, 0.02);
    const std::vector<std::uint16_t> depth(64 * 48, 700);
    const auto of_frames = [&](std::vector<double> places, double depth_scale) {
        const Intrinsics camera{64, 48, 60, 60, 31.5, 23.5, depth_scale};
        std::vector<DepthView> frames;
        for (const double x : places)
            frames.push_back({depth, {1, 0, 0, x, 0, -1, 0, 0.1, 0, 0, -1, 0.7, 0, 0, 0, 1}});
        return words_of([&] { volume.carve(*device, camera, frames); });
    };
    EXPECT_THAT(of_frames({1500}, 1000), HasSubstr("the cameras are 1499.71 m from the points"));
    EXPECT_THAT(of_frames({0, 1500, 2600}, 1000), HasSubstr("the camera moves by 1500 m"));
    EXPECT_THAT(of_frames({0.1}, 1),
                HasSubstr("the readings of 1 depth frame lie about 700 m away"));
    EXPECT_EQ(of_frames({0.1, 0.2, 9, 250}, 1000), taken);
    EXPECT_EQ(of_frames({}, 1000), taken);
}

// A camera above an open box sees its inside empty; below it nobody saw anything.
TEST(Stages, AVolumeIsCarvedAndFilled) {
    const auto device = device::open_device("native");
    PointCloud cloud;
    std::vector<std::int32_t> label;
    for (int a = 0; a < 40; ++a) {
        for (int b = 0; b < 40; ++b) {
            test::add(cloud, 0.0125f * float(a) + 0.006f, 0.0125f * float(b) + 0.006f, 0.31f);
            label.push_back(0);
            test::add(cloud, cloud.x.back(), cloud.y.back(), 0.01f);
            label.push_back(0);
        }
    }
    Volume volume(cloud, label, 0.02);
    EXPECT_EQ(volume.state_at(12, 12, 15), 1);
    EXPECT_EQ(volume.state_at(12, 12, 8), 2);
    EXPECT_EQ(volume.state_at(12, 12, 20), 2);
    const Intrinsics camera{64, 48, 60, 60, 31.5, 23.5, 1000};
    const std::vector<std::uint16_t> depth(64 * 48, 700);  // to the top, from 0.7 m above it
    const DepthView frame{depth, {1, 0, 0, 0.25, 0, -1, 0, 0.25, 0, 0, -1, 1.01, 0, 0, 0, 1}};
    volume.carve(*device, camera, std::span(&frame, 1));
    EXPECT_EQ(volume.state_at(12, 12, 20), 0);
    EXPECT_EQ(volume.state_at(12, 12, 8), 2);
    EXPECT_GT(volume.fill(*device, 2), 1000u);
    EXPECT_EQ(volume.state_at(12, 12, 8), 3);
    const Voxels solid = volume.solid();
    EXPECT_EQ(solid.i.size(), solid.state.size());
    EXPECT_EQ(std::accumulate(solid.label.begin(), solid.label.end(), 0), 0);
    EXPECT_THROW(volume.fill(*device, 9), Error);
    const std::int32_t none = 5;
    EXPECT_THROW(volume.fill(*device, 2, std::span(&none, 1)), Error);
    const DepthView small{std::span(depth).subspan(9), frame.camera_to_world};
    EXPECT_THROW(volume.carve(*device, camera, std::span(&small, 1)), Error);
    EXPECT_THROW(Volume(cloud, std::span(label).subspan(1), 0.02), Error);
}

struct Hulls {
    std::vector<float> x, y, z, dx, dy, dz;
    std::vector<std::uint64_t> first{0};
    Coordinates vertices() const { return {x, y, z}; }
    Coordinates directions() const { return {dx, dy, dz}; }
    float expected(std::size_t set, std::size_t d) const {
        double low = std::numeric_limits<double>::infinity();
        for (std::uint64_t v = first[set]; v < first[set + 1]; ++v)
            low = std::min(low, double{dx[d]} * x[v] + double{dy[d]} * y[v] + double{dz[d]} * z[v]);
        return static_cast<float>(low);
    }
};
Hulls random_hulls(std::size_t sets, std::size_t directions) {
    Random random(4);
    Hulls out;
    for (std::size_t s = 0; s < sets; ++s) {
        for (std::size_t v = 0; v < 5 + 7 * s; ++v) {
            for (auto* axis : {&out.x, &out.y, &out.z})
                axis->push_back(static_cast<float>(random.uniform() - 0.5));
        }
        out.first.push_back(out.x.size());
    }
    for (std::size_t d = 0; d < directions; ++d) {
        const double turn = 0.37 * static_cast<double>(d), z = random.uniform() * 2 - 1;
        out.dx.push_back(static_cast<float>(std::sqrt(1 - z * z) * std::cos(turn)));
        out.dy.push_back(static_cast<float>(std::sqrt(1 - z * z) * std::sin(turn)));
        out.dz.push_back(static_cast<float>(z));
    }
    return out;
}

TEST(Stages, SupportFunctionsAreTheLowestProducts) {
    const auto device = device::open_device("native");
    for (const std::size_t directions : {1, 31, 32, 97}) {
        const Hulls hulls = random_hulls(5, directions);
        std::vector<float> s(5 * directions, 9);
        support_functions(*device, hulls.vertices(), hulls.first, hulls.directions(), s);
        for (std::size_t n = 0; n < s.size(); ++n)
            EXPECT_NEAR(s[n], hulls.expected(n / directions, n % directions), 1e-6) << n;
    }
    const Hulls hulls = random_hulls(3, 4);
    std::vector<float> s(12);
    const auto refuses = [&](std::vector<std::uint64_t> first, std::size_t values) {
        EXPECT_THROW(support_functions(*device, hulls.vertices(), first, hulls.directions(),
                                       std::span(s).subspan(0, values)),
                     Error);
    };
    refuses(hulls.first, 11);
    refuses({}, 12);
    refuses({0, 0, 17, 36}, 12);
    refuses({0, 5, 99, 36}, 12);
}

// A box tips over its shorter side: M g (sqrt(h^2 + m^2) - h).
TEST(Stages, BarrierOfABox) {
    const auto device = device::open_device("native");
    std::vector<Vec3> corners;
    for (int n = 0; n < 8; ++n)
        corners.push_back({n & 1 ? 0.4 : 0.0, n & 2 ? 0.2 : 0.0, n & 4 ? 1.0 : 0.0});
    const StandingBody box{corners, 10, {0.2, 0.1, 0.5}};
    const auto found = barriers(*device, std::span(&box, 1), 0.001);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].barrier_J, 10 * 9.80665 * (std::hypot(0.5, 0.1) - 0.5), 1e-6);
    EXPECT_NEAR(std::abs(found[0].direction[1]), 1, 1e-9);
    EXPECT_FALSE(found[0].curve.empty());
    const StandingBody none{{}, 10, {}}, light{corners, 0, {}};
    for (const double far : {1e200, std::numeric_limits<double>::quiet_NaN()}) {
        std::vector<Vec3> spoilt = corners;
        spoilt[3][1] = far;
        const StandingBody body{spoilt, 10, {0.2, 0.1, 0.5}};
        EXPECT_THROW(barriers(*device, std::span(&body, 1), 0.001), Error) << far;
    }
    const auto refusal = [&](double scale, double mass_kg, double resolution_m) {
        std::vector<Vec3> scaled = corners;
        for (Vec3& p : scaled)
            for (double& c : p) c *= scale;
        const StandingBody body{scaled, mass_kg, {0.2 * scale, 0.1 * scale, 0.5 * scale}};
        return words_of([&] { barriers(*device, std::span(&body, 1), resolution_m); });
    };
    // Millimetres, and grams.
    EXPECT_THAT(refusal(1000, 10, 0.5), HasSubstr("400 x 200 x 1000 m"));
    EXPECT_THAT(refusal(1, 10000, 0), HasSubstr("125000 kg/m^3"));
    EXPECT_EQ(refusal(1, 10, 20), "barriers: resolution_m 20: expected metres from 0 to 1");
    EXPECT_EQ(refusal(1, 0.02, 0), taken);
    const auto off = [&](double z) {
        const StandingBody body{corners, 10, {0.2, 0.1, z}};
        return words_of([&] { barriers(*device, std::span(&body, 1), 0.001); });
    };
    EXPECT_THAT(off(500), HasSubstr("lies 499 m off its points, which extend over 1 m"));
    EXPECT_EQ(off(4), taken);
    EXPECT_THROW(barriers(*device, std::span(&none, 1), 0.001), Error);
    EXPECT_THROW(barriers(*device, std::span(&light, 1), 0.001), Error);
}

// Primary motion of two directions, with what acts on cells that lie ahead and beside.
struct Walks {
    MapShape shape{70, 21, 2, 0};
    std::vector<float> primary;
    std::vector<FootprintEntry> footprint{{0, 0, 1}, {3, -2, 0.5f}, {-1, 4, 0.25f}, {5, 0, 2}};
    std::vector<std::uint32_t> first{0, 3, 4};
    Walks() {
        Random random(2);
        primary.resize(std::size_t{70} * 21 * 2);
        for (float& v : primary) v = static_cast<float>(random.uniform());
    }
    float expected(std::uint32_t d, int x, int y) const {
        double sum = 0;
        for (std::uint32_t e = first[d]; e < first[d + 1]; ++e) {
            const int u = x + footprint[e].dx, v = y + footprint[e].dy;
            if (u < 0 || v < 0 || u >= 70 || v >= 21) continue;
            sum +=
                double{footprint[e].weight} *
                primary[(d * 21 + static_cast<std::size_t>(v)) * 70 + static_cast<std::size_t>(u)];
        }
        return static_cast<float>(sum);
    }
    // Of a map of so many columns, and as many to the left of it.
    void expect_density(const std::vector<float>& density, std::size_t columns,
                        std::size_t margin) const {
        for (std::uint32_t d = 0; d < 2; ++d)
            for (int y = 0; y < 21; ++y)
                for (int x = 0; x < 70; ++x)
                    EXPECT_NEAR(
                        density[(d * 21 + std::size_t(y)) * columns + margin + std::size_t(x)],
                        expected(d, x, y), 1e-6);
    }
};

TEST(Stages, ConvolvesOnHostArrays) {
    const auto device = device::open_device("native");
    const Walks walks;
    std::vector<float> density(walks.primary.size(), 9);
    convolve(*device, walks.shape, walks.primary, walks.footprint, walks.first, density);
    walks.expect_density(density, 70, 0);
    EXPECT_THROW(convolve(*device, walks.shape, walks.primary, walks.footprint,
                          std::vector<std::uint32_t>{0, 4}, density),
                 Error);
    EXPECT_THROW(convolve(*device, {7, 7, 2}, walks.primary, walks.footprint, walks.first, density),
                 Error);
}

// A context of the caller's, with buffers that stages work on where they are.
class CallersOpenCl : public ::testing::Test {
  protected:
    void SetUp() override {
        cl_platform_id platform = nullptr;
        cl_device_id id = nullptr;
        if (clGetPlatformIDs(1, &platform, nullptr) != CL_SUCCESS ||
            clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &id, nullptr) != CL_SUCCESS) {
            ASSERT_FALSE(test::backends_required()) << "an OpenCL driver is missing";
            GTEST_SKIP() << "no OpenCL driver";
        }
        context = clCreateContext(nullptr, 1, &id, nullptr, nullptr, nullptr);
        queue = clCreateCommandQueue(context, id, 0, nullptr);
        device = device::adopt_opencl({context, id, queue});
    }
    void TearDown() override {
        device.reset();
        for (cl_mem b : buffers) clReleaseMemObject(b);
        if (queue) clReleaseCommandQueue(queue);
        if (context) clReleaseContext(context);
    }
    DeviceBuffer buffer(std::vector<float> values) {
        const std::size_t bytes = values.size() * sizeof(float);
        buffers.push_back(clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes,
                                         values.data(), nullptr));
        return {buffers.back(), bytes, 0};
    }
    std::vector<float> read(const DeviceBuffer& from) {
        std::vector<float> out(from.bytes / sizeof(float));
        EXPECT_EQ(clEnqueueReadBuffer(queue, static_cast<cl_mem>(from.handle), CL_TRUE, 0,
                                      from.bytes, out.data(), 0, nullptr, nullptr),
                  CL_SUCCESS);
        return out;
    }
    cl_context context = nullptr;
    cl_command_queue queue = nullptr;
    std::vector<cl_mem> buffers;
    std::shared_ptr<device::Device> device;
};

TEST_F(CallersOpenCl, SupportFunctionsInTheirBuffers) {
    const Hulls hulls = random_hulls(4, 64);
    const Coordinates directions{Array<const float>(buffer(hulls.dx), 64),
                                 Array<const float>(buffer(hulls.dy), 64), hulls.dz};
    const DeviceBuffer out = buffer(std::vector<float>(4 * 64, 9));
    support_functions(*device, hulls.vertices(), hulls.first, directions, {out, 4 * 64});
    const std::vector<float> s = read(out);
    for (std::size_t n = 0; n < s.size(); ++n)
        EXPECT_NEAR(s[n], hulls.expected(n / 64, n % 64), 1e-6) << n;
    EXPECT_THROW(support_functions(*device, hulls.vertices(), hulls.first, directions,
                                   {DeviceBuffer{out.handle, 512, 0}, 4 * 64}),
                 Error);
    EXPECT_THROW(support_functions(*device, hulls.vertices(), hulls.first, directions,
                                   {DeviceBuffer{out.handle, 4096, 4}, 4 * 64}),
                 Error);
}

TEST_F(CallersOpenCl, ConvolvesInTheirBuffers) {
    const Walks walks;
    MapShape shape{128, 33, 2, 6};
    std::vector<float> wide(std::size_t{128} * 33 * 2, 0);
    for (std::size_t d = 0; d < 2; ++d) {
        for (std::size_t y = 0; y < 21; ++y) {
            for (std::size_t x = 0; x < 70; ++x)
                wide[(d * 33 + y + 6) * 128 + x + 6] = walks.primary[(d * 21 + y) * 70 + x];
        }
    }
    const DeviceBuffer primary = buffer(wide),
                       density = buffer(std::vector<float>(std::size_t{128} * 21 * 2));
    convolve(*device, shape, {primary, wide.size()}, walks.footprint, walks.first,
             {density, density.bytes / 4});
    walks.expect_density(read(density), 128, 6);
    shape.margin = 5;
    EXPECT_THROW(convolve(*device, shape, {primary, wide.size()}, walks.footprint, walks.first,
                          {density, density.bytes / 4}),
                 Error);
}

// A slab of label 1, seen for x < 8, with a block of label 0 on its middle.
TEST(Stages, SpotsLieDeepInWhatWasSeen) {
    Voxels solid;
    const auto add = [&](int i, int j, int k, int label, int state) {
        solid.i.push_back(i);
        solid.j.push_back(j);
        solid.k.push_back(k);
        solid.label.push_back(label);
        solid.state.push_back(static_cast<std::uint8_t>(state));
    };
    for (int i = 0; i < 21; ++i)
        for (int j = 0; j < 11; ++j) add(i, j, 0, 1, i < 8 ? 1 : 3);
    for (int i = 8; i < 13; ++i)
        for (int j = 3; j < 8; ++j) add(i, j, 1, 0, 1);
    add(30, 0, 0, 3, 3);
    const std::vector<std::int64_t> spots = label_spots(solid);
    ASSERT_EQ(spots.size(), 4u);
    const auto at = [&](std::size_t label) {
        const auto n = static_cast<std::size_t>(spots[label]);
        return std::array{solid.i[n], solid.j[n], solid.k[n]};
    };
    EXPECT_EQ(at(0), (std::array{10, 5, 1}));
    EXPECT_EQ(at(1), (std::array{3, 5, 0})) << "in the middle of what was seen, clear of the block";
    EXPECT_EQ(spots[2], -1);
    EXPECT_EQ(at(3), (std::array{30, 0, 0}));
    solid.label[0] = 65534;
    EXPECT_THROW(label_spots(solid), Error);
    solid.label.pop_back();
    EXPECT_THROW(label_spots(solid), Error);
    EXPECT_TRUE(label_spots({}).empty());
}

}  // namespace
}  // namespace topple::stages
