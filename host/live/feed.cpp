// SPDX-License-Identifier: MIT
#include "live/feed.h"

#include <system_error>

#include "io/text.h"
#include "topple/error.h"

namespace topple::live {
namespace {

bool is_same(const std::optional<Intrinsics>& a, const std::optional<Intrinsics>& b) {
    if (!a || !b) return !a && !b;
    return a->width == b->width && a->height == b->height && a->fx == b->fx && a->fy == b->fy &&
           a->cx == b->cx && a->cy == b->cy && a->depth_scale == b->depth_scale;
}

}  // namespace

std::unique_ptr<Session> Feed::session_of(const std::optional<Intrinsics>& camera,
                                          const SessionOptions& options,
                                          const std::filesystem::path& checkpoint) {
    std::error_code error;
    if (!checkpoint.empty() && std::filesystem::exists(checkpoint, error)) {
        Session session = Session::resume(checkpoint, options);
        if (!is_same(session.intrinsics(), camera))
            io::fail(checkpoint,
                     "is of another camera than what comes now, or of points where "
                     "that has one; begin anew with another file");
        return std::make_unique<Session>(std::move(session));
    }
    return std::make_unique<Session>(camera ? Session(*camera, std::nullopt, options)
                                            : Session::of_points(options));
}

}  // namespace topple::live
