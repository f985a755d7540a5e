// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "topple/cloud_view.h"
#include "topple/frames_view.h"
#include "topple/parse.h"

// A scan that is still being made: depth frames, or sweeps of points, come one by one, a SLAM
// system corrects their poses, and in between one asks what is there and what may fall.
namespace topple {

// Of a frame that was added: 0, 1, 2 .. in the order in which they came.
using FrameId = std::uint64_t;
// Of a thing, the same from update to update.
using ThingId = std::uint64_t;

enum class Change : std::uint8_t {
    none,
    found,    // it was not seen before, or not told apart from others
    came,     // its place was seen to be free before
    moved,    // what had its size and weight has gone elsewhere, or it stands a little aside
    changed,  // it stands on something else, or its category of risk is another
    lost,     // it is not told apart from others any more
    gone,     // its place was seen to be free since
};

inline const char* to_string(Change change) {
    constexpr const char* names[] = {"none", "found", "came", "moved", "changed", "lost", "gone"};
    return names[static_cast<std::size_t>(change)];
}

struct Thing {
    ThingId id = 0;            // 0: the building
    std::int32_t object = -1;  // its place in Scene::objects; -1: it is lost or gone
    Change change = Change::none;
    double moved_m = 0;  // how far, where it moved
};

// What an update has found.
struct LiveScene {
    std::shared_ptr<const ParseResult> result;
    std::vector<Thing> things;    // by Scene::objects, then what is lost or gone
    std::vector<FrameId> frames;  // that it was parsed from
    std::uint64_t number = 0;     // of the parse that found it: 1, 2, ...
    // Whether these, and their poses, were all that there was when an update gave this.
    bool current = true;
};

// What frames that came since an update show where its scene was free: a thing that came, told
// before a parse knows of it. It is taken to be solid within what was seen of it, and down to what
// carries it; the next update knows better.
struct Appeared {
    Vec3 middle_m{}, size_m{};  // its box, upright and along the room's axes
    double mass_kg = 0, mass_error_kg = 0;
    std::vector<std::int32_t> stands_on;  // of the scene's objects, ascending
    double barrier_J = 0, barrier_error_J = 0, release_J = 0;
    std::string mode;                                   // "tip" | "slide" | "none"
    std::map<std::string, double> risk_J, fall_chance;  // by disturbance, as Object's
    std::string unsafety_category;  // as Object's; "": no disturbance was asked for
};

// As write_outputs() of its result, with things.json: the things and their changes.
void write_outputs(const LiveScene& found, const std::filesystem::path& folder,
                   const OutputOptions& options = {});

// A thing for each pixel, rows from the upper one down; -1: nothing that is known.
struct ThingLabels {
    std::uint32_t width = 0, height = 0;
    std::vector<std::int64_t> thing;
};

struct SessionOptions {
    ParseOptions parse;
    // Whether readings are left out at places that most of the latest looks see through: what was
    // there was taken away, or walked by.
    bool forget_gone = true;
    // That kept frames take, compressed: 640 x 480 pixels about 0.3 MB. Where that is not enough
    // the frame goes whose camera has a neighbour in time next to it.
    std::uint64_t max_frame_bytes = 2'000'000'000;
    std::string source = "session";  // Scene::source of its results
};

// One thread may add, correct and forget frames while others update and any number read scenes.
// Errors are those of parse().
class Session {
  public:
    // colour_intrinsics: of the colour images; none: the depth images', scaled to their size.
    explicit Session(const Intrinsics& intrinsics,
                     const std::optional<Intrinsics>& colour_intrinsics = {},
                     SessionOptions options = {});
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    // Of sweeps of points, as LiDARs and other scanners make them, in place of depth frames.
    static Session of_points(SessionOptions options = {});

    // Copies the frame. Throws Error(input) for one without readings, for the frame before once
    // more, and for images and poses that parse() refuses; the session stays as it was.
    FrameId add(const FrameView& frame, const Mat4& camera_to_world);
    // The same of points in the sensor's axes, z up, with colours or without; those that are not
    // finite are left out, and normals, of which the result has its own. A session is of one or the
    // other.
    FrameId add(const CloudView& points, const Mat4& sensor_to_world);
    // The number that the next frame will have; and that one never comes in, as of an image that
    // was damaged, so that numbers are those of a sequence.
    FrameId next_frame() const;
    void skip_frame();
    // After a loop closure: the poses that are others now. Those of frames that are not kept any
    // more count for nothing. Throws Error: usage (there was no such frame), input (no pose); no
    // pose is changed then.
    void correct(const std::map<FrameId, Mat4>& camera_to_world);
    // Leaves a frame out. Throws Error(usage) where there is none of that number.
    void forget(FrameId frame);
    const std::optional<Intrinsics>& intrinsics() const;  // none: of points
    std::vector<FrameId> frames() const;                  // that are kept, ascending
    std::uint64_t frame_bytes() const;                    // that they take

    // Parses the frames that are there now. Its result is bit for bit parse()'s of the same frames
    // and poses, but for what has gone, whatever was added, corrected or forgotten before; of
    // points, parse()'s of all in the world's frame, one sweep after the other, each with its
    // sensor's place for a viewpoint. One at a
    // time; where nothing has changed since, it is the one before, with no changes. Throws what
    // parse() does; the scene before stays then.
    std::shared_ptr<const LiveScene> update();
    // The same within `budget`: a parse that takes longer goes on behind, on a thread of its own,
    // which calls the options' functions (`cancelled` is polled by both), and a later update gives
    // its scene. Until then it is the
    // one before, without changes; null where there is none yet. LiveScene::current says
    // whether it knows of all frames and poses. What a parse behind throws, the next update does.
    std::shared_ptr<const LiveScene> update(std::chrono::milliseconds budget);
    // What the latest of the frames since the last update show that was not there then, the largest
    // first; none before the first update. It takes a few hundredths of an update's time, and may
    // run beside one.
    std::vector<Appeared> glance() const;
    // update(), then the result of parse() of all frames and poses that are there, bit for bit,
    // also where something has gone, which takes a parse of its own. Its things are scene()'s.
    std::shared_ptr<const ParseResult> settle();
    // From any thread: an update that is at work ends with Error(cancelled), and what goes on
    // behind ends, too, as it does where the session ends. Waits for that. Frames, and the scene
    // before, stay.
    void cancel();
    // Writes the frames, their poses, and the things of the last update to a file: a session that
    // begins from it goes on as this one would. Throws Error(input) where it can't be written, or
    // is there and no checkpoint of topple.
    void checkpoint(const std::filesystem::path& file) const;
    // Has no scene before its first update(), which tells what has changed since the last one
    // before the checkpoint. Throws Error(input) where the file is damaged, of another version, or
    // no checkpoint.
    static Session resume(const std::filesystem::path& file, SessionOptions options = {});
    // Of the last update; null before the first.
    std::shared_ptr<const LiveScene> scene() const;
    // The things of that scene in a depth frame. Throws Error(usage) before the first update.
    ThingLabels label(const FrameView& frame, const Mat4& camera_to_world) const;
    // The same of points, by point; of a session of either.
    std::vector<std::int64_t> label(const CloudView& points, const Mat4& sensor_to_world) const;

  private:
    class State;
    explicit Session(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace topple
