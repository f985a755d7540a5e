// SPDX-License-Identifier: MIT
#include "topple/session.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/checksum.h"
#include "device/cancelling.h"
#include "live/checkpoint.h"
#include "live/frame_store.h"
#include "live/glance.h"
#include "live/passes.h"
#include "live/scan_kind.h"
#include "points/caller_frames.h"
#include "points/caller_points.h"
#include "points/formats/rigid_pose.h"
#include "safety/disturbances.h"
#include "topple/device.h"
#include "topple/error.h"
#include "topple/frame_labels.h"
#include "topple/kernels/device.h"

namespace topple {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds no_budget{0}, most_budget{86'400'000};  // no clock runs over

// source: what messages call it.
FramesView one_frame(const Intrinsics& k, const std::optional<Intrinsics>& colour,
                     const FrameView& frame, const Mat4& pose, std::string source) {
    FramesView out;
    out.source = std::move(source);
    out.intrinsics = k;
    out.colour_intrinsics = colour;
    out.camera_to_world = {pose};
    out.images = {frame};
    return out;
}

}  // namespace

class Session::State {
  public:
    State(live::Checkpoint from, SessionOptions options)
        : kind_(live::scan_kind(from)),
          depth_(from.depth),
          colour_(from.colour),
          options_(checked(std::move(options))),
          threads_(options_.parse.device->threads().threads()),
          frames_(std::move(from.frames), options_.max_frame_bytes,
                  [this](const live::KeptFrame& frame) { return kind_->image(frame); }),
          glance_(*kind_, threads_),
          remembered_(std::move(from.remembered)) {
        options_.parse.cancelled = [this, asked = std::move(options_.parse.cancelled)] {
            return cancelling_ || (asked && asked());
        };
    }

    FrameId add(const FrameView& view, const Mat4& pose) {
        const std::string name = live::name_of(frames_.next());
        const FramesView given = one_frame(camera(), colour_, view, pose, name);
        // As parse() takes it: checked, its colours as the depth camera sees them.
        const DepthFrame frame = CallerFrames(given).load_coloured(0);
        if (std::ranges::all_of(frame.depth, [](std::uint16_t d) { return d == 0; }))
            throw Error(ErrorKind::input, name + ": it has no readings");
        Checksum sum;
        sum.add(frame.depth.data(), frame.depth.size() * sizeof(std::uint16_t));
        return frames_.add(sum, frame.camera_to_world, pose, [&] {
            return std::make_shared<const live::KeptFrame>(frame, depth_->width);
        });
    }
    FrameId add(const CloudView& view, const Mat4& sensor_to_world) {
        if (depth_)
            throw Error(ErrorKind::usage,
                        "session: it is of depth frames; begin one of points (Session::of_points)");
        const std::string name = live::name_of(frames_.next());
        const PointCloud points = points_of(view, name);
        const Mat4 pose = rigid(sensor_to_world, name + ": sensor_to_world");
        Checksum sum;
        for (const std::vector<float>* axis : {&points.x, &points.y, &points.z})
            sum.add(axis->data(), axis->size() * sizeof(float));
        return frames_.add(sum, pose, pose,
                           [&] { return std::make_shared<const live::KeptFrame>(points); });
    }
    const std::optional<Intrinsics>& intrinsics() const { return depth_; }
    live::FrameStore& frames() { return frames_; }
    const live::FrameStore& frames() const { return frames_; }

    std::shared_ptr<const LiveScene> update() {
        const std::lock_guard one_at_a_time(update_mutex_);
        wait_behind({});
        find();
        return told();
    }
    std::shared_ptr<const LiveScene> update(std::chrono::milliseconds budget) {
        const std::lock_guard one_at_a_time(update_mutex_);
        frames_.need_any();
        begin_behind();
        wait_behind(Clock::now() + std::clamp(budget, no_budget, most_budget));
        auto out = told();  // before the next one is
        begin_behind();
        return out;
    }
    std::vector<Appeared> glance() const {
        const Known known = this->known();
        if (!known.scene) return {};
        return glance_(*known.scene, *known.labeller, frames_.snapshot().first, options_.parse);
    }
    std::shared_ptr<const ParseResult> settle() {
        const std::lock_guard one_at_a_time(update_mutex_);
        wait_behind({});
        find();
        bool left_out = false;
        if (!of_all_) of_all_ = parsed(parsed_, {}, left_out);
        return of_all_;
    }
    void cancel() {
        cancelling_ = true;
        const std::lock_guard one_at_a_time(update_mutex_);
        if (behind_.valid()) behind_.wait();
        behind_ = {};
        cancelling_ = false;
    }
    ~State() { cancel(); }
    live::Checkpoint checkpoint() const {
        // First what is remembered: frames may be newer than an update, but never older.
        live::Checkpoint out{depth_, colour_, {}, remembered()};
        out.frames = frames_.all();
        return out;
    }
    std::shared_ptr<const LiveScene> scene() const {
        const std::lock_guard lock(scene_mutex_);
        return scene_;
    }
    ThingLabels label(const FrameView& view, const Mat4& pose) const {
        const Known known = needed();
        const FrameLabels found =
            known.labeller->label(one_frame(camera(), colour_, view, pose, "frame"), 0, threads_);
        return {found.width, found.height, things_of(found.object, *known.scene)};
    }
    std::vector<std::int64_t> label(const CloudView& points, const Mat4& sensor_to_world) const {
        const Known known = needed();
        const Mat4 pose = rigid(sensor_to_world, "points: sensor_to_world");
        return things_of(known.labeller->label(points, pose, threads_).object, *known.scene);
    }

  private:
    using Frames = live::Frames;

    static SessionOptions checked(SessionOptions options) {
        check_options(options.parse);
        static_cast<void>(safety::acting_kinds(options.parse));  // throws for what is none
        if (!options.parse.cache_file.empty())
            throw Error(ErrorKind::usage,
                        "a session keeps no cache_file: leave it empty in its options");
        if (options.max_frame_bytes == 0)
            throw Error(ErrorKind::usage, "max_frame_bytes is 0: a session needs room for frames");
        if (!options.parse.device) options.parse.device = device::open_device("auto");
        options.parse.coordinates = true;  // things are told by them
        return options;
    }

    struct Known {
        std::shared_ptr<const LiveScene> scene;
        std::shared_ptr<const FrameLabeller> labeller;
    };
    Known known() const {
        const std::lock_guard lock(scene_mutex_);
        return {scene_, labeller_};
    }
    Known needed() const {
        Known out = known();
        if (!out.scene) throw Error(ErrorKind::usage, "session: nothing is known before update()");
        return out;
    }
    static std::vector<std::int64_t> things_of(const std::vector<std::int32_t>& objects,
                                               const LiveScene& scene) {
        std::vector<std::int64_t> out;
        out.reserve(objects.size());
        for (const std::int32_t o : objects)
            out.push_back(
                o < 0 ? -1
                      : static_cast<std::int64_t>(scene.things[static_cast<std::size_t>(o)].id));
        return out;
    }
    const Intrinsics& camera() const {
        if (depth_) return *depth_;
        throw Error(ErrorKind::usage,
                    "session: it is of points; begin one with intrinsics for depth frames");
    }
    static Mat4 rigid(Mat4 pose, const std::string& what) {
        if (const auto fault = io::make_rigid(pose))
            throw Error(ErrorKind::input, what + ": " + *fault);
        return pose;
    }
    // The finite ones, copied.
    static PointCloud points_of(CloudView view, std::string source) {
        view.source = std::move(source);
        if (view.size() == 0) throw Error(ErrorKind::input, view.source + ": it has no points");
        view.nx = view.ny = view.nz = {};
        if (auto finite = finite_points(view)) return std::move(finite->cloud);
        PointCloud out;
        out.x.assign(view.x.begin(), view.x.end());
        out.y.assign(view.y.begin(), view.y.end());
        out.z.assign(view.z.begin(), view.z.end());
        out.red.assign(view.red.begin(), view.red.end());
        out.green.assign(view.green.begin(), view.green.end());
        out.blue.assign(view.blue.begin(), view.blue.end());
        return out;
    }
    live::Remembered remembered() const {
        const std::lock_guard lock(scene_mutex_);
        return remembered_;
    }
    // Parses what is there, where that has not been done. One at a time.
    void find() {
        auto [frames, changes] = frames_.snapshot();
        if (changes == parsed_changes_) return;
        live::Remembered remembered = this->remembered();
        const live::Passes passes(frames, *kind_, remembered.poses,
                                  options_.parse.device->threads());
        auto found = std::make_shared<LiveScene>();
        for (const auto& [frame, kept] : frames) found->frames.push_back(frame);
        found->number = ++parses_;
        bool left_out = false;
        std::vector<live::Gone> gone;
        std::vector<bool> no_longer;
        if (options_.forget_gone) gone = passes.leave_out(remembered, no_longer);
        found->result = parsed(frames, gone, left_out);
        auto labeller = std::make_shared<const FrameLabeller>(*found->result);
        found->things =
            remembered.things.name(found->result->scene, passes.shown(*labeller), no_longer);
        remembered.poses.clear();
        for (const auto& [frame, kept] : frames) remembered.poses[frame] = kept.pose;
        of_all_ = left_out ? nullptr : found->result;
        parsed_ = left_out ? std::move(frames) : Frames{};
        parsed_changes_ = changes;
        const std::lock_guard lock(scene_mutex_);
        scene_ = std::move(found);
        told_ = false;
        labeller_ = std::move(labeller);
        remembered_ = std::move(remembered);
    }
    std::shared_ptr<const ParseResult> parsed(const Frames& frames,
                                              std::span<const live::Gone> gone,
                                              bool& left_out) const {
        return std::make_shared<const ParseResult>(
            kind_->parse(frames, gone, options_.source, options_.parse, left_out));
    }
    // The scene that is there; from the second time on without what changed.
    std::shared_ptr<const LiveScene> told() {
        const bool current = frames_.changes() == parsed_changes_;
        const std::lock_guard lock(scene_mutex_);
        if (!scene_) return nullptr;
        auto given = std::make_shared<LiveScene>(*scene_);
        given->current = current;
        if (std::exchange(told_, true)) {
            std::erase_if(given->things, [](const Thing& t) { return t.object < 0; });
            for (Thing& thing : given->things) thing = {.id = thing.id, .object = thing.object};
        }
        scene_ = std::move(given);
        return scene_;
    }
    void begin_behind() {
        if (behind_.valid() || frames_.changes() == parsed_changes_) return;
        behind_ = std::async(std::launch::async, [this] { find(); });
    }
    // Until what goes on behind has ended, or that time comes.
    void wait_behind(std::optional<Clock::time_point> until) {
        constexpr std::chrono::milliseconds poll{20};
        while (behind_.valid()) {
            const auto now = Clock::now();
            const Clock::duration left = until ? *until - now : Clock::duration(poll);
            const auto wait = std::clamp<Clock::duration>(left, Clock::duration(0), poll);
            if (behind_.wait_for(wait) == std::future_status::ready) return behind_.get();
            if (until && left <= wait) return;
            end_if_cancelled(options_.parse);
        }
    }
    const std::unique_ptr<const live::ScanKind> kind_;
    const std::optional<Intrinsics> depth_, colour_;  // none: of points
    SessionOptions options_;
    const unsigned threads_;

    live::FrameStore frames_;
    const live::Glance glance_;

    // Of the updates, and of the parse that goes on behind, which only they begin and wait for.
    std::mutex update_mutex_;
    std::future<void> behind_;
    std::atomic<bool> cancelling_ = false;
    std::atomic<std::uint64_t> parsed_changes_ = 0;
    std::uint64_t parses_ = 0;
    Frames parsed_;                              // of which something was left out
    std::shared_ptr<const ParseResult> of_all_;  // with that; null: not known yet

    mutable std::mutex scene_mutex_;
    live::Remembered remembered_;
    std::shared_ptr<const LiveScene> scene_;
    bool told_ = false;
    std::shared_ptr<const FrameLabeller> labeller_;
};

Session::Session(const Intrinsics& intrinsics, const std::optional<Intrinsics>& colour_intrinsics,
                 SessionOptions options)
    : state_(std::make_unique<State>(live::Checkpoint{intrinsics, colour_intrinsics, {}, {}},
                                     std::move(options))) {}
Session Session::of_points(SessionOptions options) {
    return Session(std::make_unique<State>(live::Checkpoint{}, std::move(options)));
}
Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session Session::resume(const std::filesystem::path& file, SessionOptions options) {
    return Session(std::make_unique<State>(live::Checkpoint::read(file), std::move(options)));
}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

FrameId Session::add(const FrameView& frame, const Mat4& camera_to_world) {
    return state_->add(frame, camera_to_world);
}
FrameId Session::add(const CloudView& points, const Mat4& sensor_to_world) {
    return state_->add(points, sensor_to_world);
}
FrameId Session::next_frame() const {
    return state_->frames().next();
}
void Session::skip_frame() {
    state_->frames().skip();
}
void Session::correct(const std::map<FrameId, Mat4>& camera_to_world) {
    state_->frames().correct(camera_to_world);
}
void Session::forget(FrameId frame) {
    state_->frames().forget(frame);
}
const std::optional<Intrinsics>& Session::intrinsics() const {
    return state_->intrinsics();
}
std::vector<FrameId> Session::frames() const {
    return state_->frames().ids();
}
std::uint64_t Session::frame_bytes() const {
    return state_->frames().bytes();
}
std::shared_ptr<const LiveScene> Session::update() {
    return state_->update();
}
std::shared_ptr<const LiveScene> Session::update(std::chrono::milliseconds budget) {
    return state_->update(budget);
}
std::vector<Appeared> Session::glance() const {
    return state_->glance();
}
std::shared_ptr<const ParseResult> Session::settle() {
    return state_->settle();
}
void Session::cancel() {
    state_->cancel();
}
void Session::checkpoint(const std::filesystem::path& file) const {
    state_->checkpoint().write(file);
}
std::shared_ptr<const LiveScene> Session::scene() const {
    return state_->scene();
}
ThingLabels Session::label(const FrameView& frame, const Mat4& camera_to_world) const {
    return state_->label(frame, camera_to_world);
}

std::vector<std::int64_t> Session::label(const CloudView& points,
                                         const Mat4& sensor_to_world) const {
    return state_->label(points, sensor_to_world);
}

}  // namespace topple
