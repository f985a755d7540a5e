// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "api/c_result.h"
#include "api/c_support.h"
#include "topple/session.h"

using namespace topple;
using namespace topple::c_api;

struct topple_session {
    topple_options options;  // whose callbacks the session has
    std::unique_ptr<Session> session;
    std::shared_ptr<const LiveScene> updated;
    std::vector<Appeared> appeared;
};

static_assert(int{TOPPLE_CHANGE_FOUND} == int(Change::found) &&
              int{TOPPLE_CHANGE_CAME} == int(Change::came) &&
              int{TOPPLE_CHANGE_MOVED} == int(Change::moved) &&
              int{TOPPLE_CHANGE_CHANGED} == int(Change::changed) &&
              int{TOPPLE_CHANGE_LOST} == int(Change::lost) &&
              int{TOPPLE_CHANGE_GONE} == int(Change::gone));

namespace {

// made: of the options; Session.
template <class Made>
int make_session(const topple_options* options, uint64_t max_frame_bytes, int keep_gone,
                 topple_session** session, topple_status* status, const Made& made) {
    return guarded(status, [&] {
        needed(session, "session") = nullptr;
        auto out = std::make_unique<topple_session>();
        out->options = known(options, default_options(), "options");
        SessionOptions wanted;
        wanted.parse = parse_options(out->options);
        wanted.forget_gone = keep_gone == 0;
        if (max_frame_bytes > 0) wanted.max_frame_bytes = max_frame_bytes;
        out->session = std::make_unique<Session>(made(std::move(wanted)));
        *session = out.release();
    });
}

Mat4 pose_of(const double* sensor_to_world) {
    Mat4 out;
    std::copy_n(&needed(sensor_to_world, "sensor_to_world"), out.size(), out.begin());
    return out;
}

// update: of a Session; LiveScene, or null.
template <class Update>
int give_update(topple_session* session, topple_result** result, uint64_t* things,
                topple_status* status, const Update& update) {
    return guarded(status, [&] {
        if (result) *result = nullptr;
        if (things) *things = 0;
        topple_session& of = needed(session, "session");
        of.updated = update(*of.session);
        if (!of.updated) return;
        if (things) *things = of.updated->things.size();
        if (result)
            *result = new topple_result(ParseResult(*of.updated->result), of.options.allocator);
    });
}

}  // namespace

int topple_session_create(const topple_intrinsics* depth, const topple_intrinsics* colour,
                          const topple_options* options, uint64_t max_frame_bytes, int keep_gone,
                          topple_session** session, topple_status* status) {
    const auto made = [&](SessionOptions wanted) {
        std::optional<Intrinsics> seen;
        if (colour) seen = intrinsics_of(*colour);
        if (!depth && !colour) return Session::of_points(std::move(wanted));
        return Session(intrinsics_of(needed(depth, "depth")), seen, std::move(wanted));
    };
    return make_session(options, max_frame_bytes, keep_gone, session, status, made);
}

int topple_session_resume(const char* file, const topple_options* options, uint64_t max_frame_bytes,
                          int keep_gone, topple_session** session, topple_status* status) {
    const auto made = [&](SessionOptions wanted) {
        return Session::resume(std::filesystem::path(&needed(file, "file")), std::move(wanted));
    };
    return make_session(options, max_frame_bytes, keep_gone, session, status, made);
}

int topple_session_checkpoint(const topple_session* session, const char* file,
                              topple_status* status) {
    return guarded(status, [&] {
        needed(session, "session")
            .session->checkpoint(std::filesystem::path(&needed(file, "file")));
    });
}

void topple_session_release(topple_session* session) {
    delete session;
}

int topple_session_add(topple_session* session, const topple_frames* frames, uint64_t* ids,
                       topple_status* status) {
    return guarded(status, [&] {
        Session& to = *needed(session, "session").session;
        const FramesView view = frames_of(frames);
        if (view.camera_to_world.empty())
            throw Error(ErrorKind::usage, "frames: camera_to_world is NULL; a session needs poses");
        for (std::size_t n = 0; n < view.camera_to_world.size(); ++n) {
            const FrameId id = to.add(view.images.empty() ? view.image(n) : view.images[n],
                                      view.camera_to_world[n]);
            if (ids) ids[n] = id;
        }
    });
}

int topple_session_add_points(topple_session* session, const topple_cloud* points,
                              const double* sensor_to_world, uint64_t* id, topple_status* status) {
    return guarded(status, [&] {
        const FrameId added =
            needed(session, "session").session->add(view_of(points), pose_of(sensor_to_world));
        if (id) *id = added;
    });
}

int topple_session_label_points(const topple_session* session, const topple_cloud* points,
                                const double* sensor_to_world, int64_t* things,
                                topple_status* status) {
    return guarded(status, [&] {
        const std::vector<std::int64_t> found =
            needed(session, "session").session->label(view_of(points), pose_of(sensor_to_world));
        if (!found.empty()) std::ranges::copy(found, &needed(things, "things"));
    });
}

int topple_session_correct(topple_session* session, const uint64_t* ids,
                           const double* camera_to_world, uint64_t count, topple_status* status) {
    return guarded(status, [&] {
        array(ids, "ids", count);
        array(camera_to_world, "camera_to_world", count, 16);
        std::map<FrameId, Mat4> poses;
        for (std::uint64_t n = 0; n < count; ++n)
            std::copy_n(camera_to_world + 16 * n, 16, poses[ids[n]].begin());
        needed(session, "session").session->correct(poses);
    });
}

int topple_session_forget(topple_session* session, uint64_t id, topple_status* status) {
    return guarded(status, [&] { needed(session, "session").session->forget(id); });
}

int topple_session_update(topple_session* session, topple_result** result, uint64_t* things,
                          topple_status* status) {
    return give_update(session, result, things, status, [](Session& of) { return of.update(); });
}

int topple_session_update_within(topple_session* session, uint64_t budget_ms,
                                 topple_result** result, uint64_t* things, topple_status* status) {
    constexpr std::uint64_t a_day = 86'400'000;
    return give_update(session, result, things, status, [&](Session& of) {
        return of.update(std::chrono::milliseconds(std::min(budget_ms, a_day)));
    });
}

int topple_session_settle(topple_session* session, topple_result** result, topple_status* status) {
    return guarded(status, [&] {
        needed(result, "result") = nullptr;
        topple_session& of = needed(session, "session");
        *result = new topple_result(ParseResult(*of.session->settle()), of.options.allocator);
    });
}

int topple_session_cancel(topple_session* session, topple_status* status) {
    return guarded(status, [&] { needed(session, "session").session->cancel(); });
}

int topple_session_glance(topple_session* session, uint64_t* count, topple_status* status) {
    return guarded(status, [&] {
        topple_session& of = needed(session, "session");
        of.appeared = of.session->glance();
        needed(count, "count") = of.appeared.size();
    });
}

int topple_session_appeared(const topple_session* session, uint64_t index,
                            topple_appeared* appeared, topple_status* status) {
    return guarded(status, [&] {
        const Appeared& from = item(needed(session, "session").appeared, index, "appeared");
        topple_appeared out{};
        std::ranges::copy(from.middle_m, out.middle_m);
        std::ranges::copy(from.size_m, out.size_m);
        out.mass_kg = from.mass_kg;
        out.mass_error_kg = from.mass_error_kg;
        out.stands_on = from.stands_on.empty() ? -1 : from.stands_on.front();
        out.barrier_J = from.barrier_J;
        out.barrier_error_J = from.barrier_error_J;
        out.release_J = from.release_J;
        out.mode = from.mode.c_str();
        out.unsafety_category = from.unsafety_category.c_str();
        give(out, appeared, "appeared");
    });
}

int topple_session_thing(const topple_session* session, uint64_t index, topple_thing* thing,
                         topple_status* status) {
    return guarded(status, [&] {
        const auto& updated = needed(session, "session").updated;
        static const std::vector<Thing> none;
        const Thing& from = item(updated ? updated->things : none, index, "thing");
        topple_thing out{};
        out.id = from.id;
        out.object = from.object;
        out.change = static_cast<std::int32_t>(from.change);
        out.moved_m = from.moved_m;
        give(out, thing, "thing");
    });
}

int topple_session_label(const topple_session* session, const topple_frames* frames,
                         uint64_t number, int64_t* things, topple_status* status) {
    return guarded(status, [&] {
        needed(things, "things");
        const FramesView view = frames_of(frames);
        if (number >= view.camera_to_world.size())
            throw Error(ErrorKind::usage,
                        "frames: there is no pose of frame " + std::to_string(number));
        const ThingLabels found =
            needed(session, "session")
                .session->label(view.images.empty() ? view.image(number) : view.images[number],
                                view.camera_to_world[number]);
        std::ranges::copy(found.thing, things);
    });
}
