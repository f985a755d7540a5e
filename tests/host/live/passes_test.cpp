// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/vectors.h"
#include "lab/rooms/furnished_room.h"
#include "lab/scan/depth_camera.h"
#include "topple/session.h"

// Two passes through a room, between which a thing is taken away and another is put there.
namespace topple::test {
namespace {

scenes::World without(const scenes::World& world, std::int32_t object) {
    scenes::World out = world;
    std::erase_if(out.parts, [&](const scenes::Part& part) { return part.object == object; });
    return out;
}

// Things that carry nothing, not too small to be seen, by size.
std::vector<std::int32_t> loose_things(const scenes::World& world) {
    std::set<std::int32_t> out, no;
    for (const scenes::Part& part : world.parts) out.insert(part.object);
    for (const auto& [below, above] : world.support) no.insert(world.parts[below].object);
    for (const auto& [a, b] : world.fixed) {
        if (world.parts[a].object == world.parts[b].object) continue;
        no.insert({world.parts[a].object, world.parts[b].object});
    }
    for (const std::int32_t object : no) out.erase(object);
    out.erase(0);
    return {out.begin(), out.end()};
}

class TwoPasses {
  public:
    explicit TwoPasses(std::uint64_t seed) : camera_(camera(seed)), session_(camera_.intrinsics) {}
    // Films it, and returns the thing that most pixels of each true object show. Glances once, when
    // it has just seen the object `put`.
    std::map<std::int32_t, std::int64_t> pass(const scenes::World& world, std::int32_t put = -1) {
        const scenes::Sequence film = scenes::walk(world, camera_);
        ++camera_.seed;
        const auto shows_it = [&](std::int32_t part) {
            return part >= 0 && world.parts[static_cast<std::size_t>(part)].object == put;
        };
        for (std::size_t n = 0; n < film.frames.size(); ++n) {
            const DepthFrame& frame = film.frames[n];
            session_.add(view(film, frame), frame.camera_to_world);
            constexpr int enough = 300;
            if (put < 0 || !glanced_.empty() ||
                std::ranges::count_if(film.part[n], shows_it) < enough)
                continue;
            glanced_ = session_.glance();
        }
        scene_ = session_.update();
        std::map<std::int32_t, std::map<std::int64_t, int>> shows;
        for (std::size_t n = 0; n < film.frames.size(); n += 2) {
            const DepthFrame& frame = film.frames[n];
            const ThingLabels labels = session_.label(view(film, frame), frame.camera_to_world);
            for (std::size_t p = 0; p < labels.thing.size(); ++p)
                if (film.part[n][p] >= 0)
                    ++shows[world.parts[static_cast<std::size_t>(film.part[n][p])].object]
                           [labels.thing[p]];
        }
        std::map<std::int32_t, std::int64_t> out;
        for (const auto& [object, things] : shows)
            out[object] =
                std::ranges::max_element(things, {}, [](const auto& t) { return t.second; })->first;
        return out;
    }
    const LiveScene& scene() const { return *scene_; }
    const std::vector<Appeared>& glanced() const { return glanced_; }

  private:
    static scenes::CameraOptions camera(std::uint64_t seed) {
        scenes::CameraOptions out;
        out.frames = 30;
        out.seed = seed;
        return out;
    }
    static FrameView view(const scenes::Sequence& film, const DepthFrame& frame) {
        FrameView out;
        out.depth = {frame.depth.data(), film.intrinsics.width, film.intrinsics.height};
        return out;
    }
    scenes::CameraOptions camera_;
    Session session_;
    std::shared_ptr<const LiveScene> scene_;
    std::vector<Appeared> glanced_;
};

TEST(SlowPasses, TellWhatWasTakenAwayAndPutThere) {
    int told = 0, alarms = 0;
    for (const std::uint64_t seed : {1}) {
        scenes::RoomOptions room;
        room.seed = seed;
        const scenes::World world = scenes::furnished_room(room);
        const std::vector<std::int32_t> loose = loose_things(world);
        ASSERT_GE(loose.size(), 4u);
        const std::int32_t taken = loose[loose.size() / 3], put = loose[2 * loose.size() / 3];
        TwoPasses passes(seed);
        const auto before = passes.pass(without(world, put));
        const auto after = passes.pass(without(world, taken), put);
        ASSERT_TRUE(before.count(taken) && after.count(put));
        const std::int64_t was = before.at(taken), is = after.at(put);
        for (const Thing& thing : passes.scene().things) {
            const auto id = static_cast<std::int64_t>(thing.id);
            if (thing.change == Change::came && id == is) {
                // It was told before, and nothing else was.
                ASSERT_EQ(passes.glanced().size(), 1u);
                const Appeared& glanced = passes.glanced().front();
                const Object& object = passes.scene().result->scene.objects[thing.object];
                EXPECT_LT(length(minus(glanced.middle_m, object.box_middle_m)), 0.05);
                EXPECT_LT(length(minus(glanced.size_m, object.size_m)), 0.08);
                EXPECT_GT(glanced.barrier_J + 2 * glanced.barrier_error_J, object.barrier_J);
            }
            const bool meant = (thing.change == Change::gone && id == was) ||
                               (thing.change == Change::came && id == is);
            told += meant;
            alarms += !meant && (thing.change == Change::came || thing.change == Change::gone ||
                                 thing.change == Change::moved);
        }
    }
    EXPECT_EQ(told, 2);
    EXPECT_EQ(alarms, 0);
}

}  // namespace
}  // namespace topple::test
