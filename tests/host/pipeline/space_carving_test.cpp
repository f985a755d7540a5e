// SPDX-License-Identifier: MIT
#include "solids/space_carving.h"

#include <atomic>
#include <chrono>

#include "clouds.h"
#include "errors.h"
#include "objects/find_hidden_walls.h"
#include "topple/device.h"
#include "topple/error.h"

namespace topple {
namespace {

constexpr double voxel_m = 0.05;

// A wall that fills the image, two metres ahead, over and over.
class Wall final : public FrameStream {
  public:
    explicit Wall(std::size_t frames) : size_(frames) {}
    const Intrinsics& intrinsics() const override { return intrinsics_; }
    std::size_t size() const override { return size_; }
    DepthFrame load(std::size_t i) const override {
        ++loaded;
        if (i >= broken_from) throw Error(ErrorKind::input, "broken frame");
        DepthFrame frame;
        frame.depth.assign(std::size_t{640} * 480, 2000);
        frame.camera_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        return frame;
    }

    std::size_t broken_from = ~std::size_t{0};
    mutable std::atomic<std::size_t> loaded = 0;

  private:
    Intrinsics intrinsics_{640, 480, 500, 500, 319.5, 239.5, 1000};
    std::size_t size_;
};

// A wall, frames of it, and a post beside what they see.
class Carving : public testing::Test {
  protected:
    Observation input_of(std::unique_ptr<Wall> wall, double cell_m = 0.02) {
        Observation input;
        for (int x = -20; x < 20; ++x)
            for (int y = -20; y < 20; ++y) {
                test::add(input.own, static_cast<float>(x) * 0.05f + 0.02f,
                          static_cast<float>(y) * 0.05f + 0.02f, 2.02f);
            }
        for (int z = 0; z < 20; ++z)
            test::add(input.own, -0.98f, -0.98f, static_cast<float>(z) * 0.05f + 0.02f);
        input.cloud = input.own;
        input.cell_m = cell_m;
        frames_ = wall.get();
        input.frames = std::move(wall);
        return input;
    }
    static std::shared_ptr<device::Device> device_of(unsigned threads) {
        return device::open_device("native", threads);
    }
    SpaceCarving::Carved carved(device::Device& device, const Observation& input) {
        SpaceCarving carving(device, input, frame_);
        const std::vector<std::int32_t> label(input.cloud.size(), 3);
        return carving.finish({label, {}}, {}, stage_);
    }

    vdb::VoxelFrame frame_{voxel_m, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    ParseOptions options_;
    std::vector<std::pair<std::string, double>> timings_;
    StageClock stage_{timings_, options_};
    const Wall* frames_ = nullptr;
};

// A device does not know of voxels.
TEST_F(Carving, SaysHowToNeedLessMemory) {
    const auto device = device_of(1);
    EXPECT_THAT(
        test::message_of([&] { stage_("carving", [&] { device->allocate(~0ull, "huge"); }); }),
        ::testing::EndsWith(" bytes; use a larger voxel_m (--voxel)"));
}

TEST_F(Carving, GivesTheSameBesideAndAfterwards) {
    const auto one = device_of(1), two = device_of(2);
    const Observation first = input_of(std::make_unique<Wall>(40));
    const auto alone = carved(*one, first);
    const Observation second = input_of(std::make_unique<Wall>(40));
    const auto beside = carved(*two, second);
    const auto closing = input_of(std::make_unique<Wall>(40), voxel_m);
    const auto late = carved(*two, closing);  // as gaps may come to hold points
    const vdb::Tiles tiles = alone.scene->tiles(true);
    EXPECT_EQ(alone.scene->state_at(0, 0, 20), vdb::State::empty);
    EXPECT_EQ(alone.scene->state_at(0, 6, 40), vdb::State::surface);
    for (const auto& other : {beside, late}) {
        EXPECT_EQ(other.scene->tiles(true).x, tiles.x);
        EXPECT_EQ(other.scene->states(tiles), alone.scene->states(tiles));
        EXPECT_EQ(other.scene->primitives(tiles), alone.scene->primitives(tiles));
        EXPECT_EQ(other.from_around, alone.from_around);
    }
}

TEST_F(Carving, IsBegunOnlyWhereNothingElseHasASay) {
    const auto one = device_of(1), two = device_of(2);
    const Observation dense = input_of(std::make_unique<Wall>(40));
    EXPECT_FALSE(SpaceCarving(*one, dense, frame_).closes_gaps());
    EXPECT_EQ(frames_->loaded, 0u);  // no thread for it
    const Observation sparse = input_of(std::make_unique<Wall>(40), voxel_m);
    EXPECT_TRUE(SpaceCarving(*two, sparse, frame_).closes_gaps());
    EXPECT_EQ(frames_->loaded, 0u);
}

TEST_F(Carving, WhatFailsBesideIsToldInTheEnd) {
    const auto device = device_of(2);
    auto wall = std::make_unique<Wall>(40);
    wall->broken_from = 20;
    const Observation input = input_of(std::move(wall));
    EXPECT_EQ(test::message_of([&] { carved(*device, input); }, ErrorKind::input), "broken frame");
}

// Nobody waits for a hundred thousand frames.
TEST_F(Carving, EndsWithWhatHasNoUseForItAnyMore) {
    const auto device = device_of(2);
    const Observation input = input_of(std::make_unique<Wall>(100'000));
    { const SpaceCarving carving(*device, input, frame_); }
    EXPECT_LT(frames_->loaded, 1000u);
    options_.cancelled = [begun = std::chrono::steady_clock::now()] {
        return std::chrono::steady_clock::now() - begun > std::chrono::milliseconds(100);
    };
    const Cancelling cancelling(*device, options_);
    try {
        carved(*device, input);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
    EXPECT_LT(frames_->loaded, 50'000u);
}

constexpr std::int32_t left = 0, right = 1, bookcase = 2;

// Two parts of the wall x = 0, and a bookcase between them that reaches from 0.1 to 0.4 m before
// it, of which its front and sides were seen.
class HiddenWall : public testing::Test {
  protected:
    // An upright face of constant x, or y, metres.
    void add_x(std::int32_t primitive, double x, double from_y, double to_y, float nx) {
        for (double y = from_y; y <= to_y; y += 0.05)
            for (double z = 0.05; z < 2; z += 0.05) add(primitive, x, y, z, nx, 0);
    }
    void add_y(std::int32_t primitive, double y, double from_x, double to_x, float ny) {
        for (double x = from_x; x <= to_x; x += 0.05)
            for (double z = 0.05; z < 2; z += 0.05) add(primitive, x, y, z, 0, ny);
    }
    physics::HiddenWalls walls() {
        geometry::sort_by_primitive(parts_.samples);
        SolidCells cells;
        cells.voxel_m = 0.02;
        parts_.solids = std::make_shared<const SolidScene>(
            std::move(cells), std::vector<Role>{Role::wall, Role::wall, Role::none});
        const std::vector<std::int32_t> object{0, 0, 1};
        return find_hidden_walls(parts_, object, {true, true, false});
    }
    void seen_scene() {
        add_x(left, 0, -2, -1.1, 1);
        add_x(right, 0.02, 1.1, 2, 1);
        add_bookcase();
    }
    void add_bookcase() {
        add_x(bookcase, 0.4, -1, 1, 1);
        add_y(bookcase, -1, 0.1, 0.4, -1);
        add_y(bookcase, 1, 0.1, 0.4, 1);
    }

    SolidParts parts_;

  private:
    void add(std::int32_t primitive, double x, double y, double z, float nx, float ny) {
        geometry::SurfaceSamples& s = parts_.samples;
        test::add(s, x, y, z);
        s.nx.push_back(nx);
        s.ny.push_back(ny);
        s.nz.push_back(0);
        s.primitive.push_back(primitive);
    }
};

TEST_F(HiddenWall, GoesOnBetweenItsSeenParts) {
    seen_scene();
    const physics::HiddenWalls found = walls();
    ASSERT_EQ(found.size(), 1u);
    for (const double y : {-0.95, 0.0, 0.95}) {
        const auto by = found.between({0.25, y, 1}, {-0.1, y, 1});
        ASSERT_TRUE(by) << y;
        EXPECT_TRUE(*by == left || *by == right);
    }
    EXPECT_FALSE(found.between({0.25, 0, 1}, {0.05, 0, 1}));      // before it
    EXPECT_FALSE(found.between({0.25, 0, 1}, {-0.1, 0, 2.6}));    // over it
    EXPECT_FALSE(found.between({0.25, 1.5, 1}, {-0.1, 1.5, 1}));  // nothing hides it there
    EXPECT_FALSE(found.between({-0.5, 0, 1}, {-0.1, 0, 1}));      // both behind it
    EXPECT_TRUE(found.between({0.25, -3, 1}, {-0.1, 1.2, 1}));    // where the way crosses it
}

TEST_F(HiddenWall, IsNotBehindWhatWasSeenFromThere) {
    seen_scene();
    add_x(bookcase, 0.1, -1, 1, -1);  // its back
    EXPECT_EQ(walls().size(), 0u);
}

TEST_F(HiddenWall, NeedsASeenPartBesideTheThing) {
    add_x(left, 0, -3, -2, 1);
    add_bookcase();
    EXPECT_EQ(walls().size(), 0u);
}

TEST_F(HiddenWall, DoesNotGoThroughAThing) {
    add_x(left, 0.25, -2, -1.1, 1);
    add_x(right, 0.25, 1.1, 2, 1);
    add_bookcase();
    EXPECT_EQ(walls().size(), 0u);
}

TEST_F(HiddenWall, IsNotFarBehindAThing) {
    add_x(left, -1, -2, -1.1, 1);
    add_x(right, -1, 1.1, 2, 1);
    add_bookcase();
    EXPECT_EQ(walls().size(), 0u);
}

}  // namespace
}  // namespace topple
