// SPDX-License-Identifier: MIT
#include "live/growing_folder.h"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "io/text.h"
#include "points/caller_frames.h"
#include "points/formats/frame_sequence.h"
#include "topple/error.h"

namespace topple::live {
namespace {

// What reading gives; nothing, and why, of what can't be read now.
template <class Read>
auto unless_unfinished(std::string& why, const Read& read) -> std::optional<decltype(read())> {
    try {
        return read();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input) throw;
        why = error.what();
        return std::nullopt;
    }
}

}  // namespace

std::optional<Intrinsics> GrowingFolder::intrinsics() {
    waits_for_.clear();
    return unless_unfinished(waits_for_,
                             [&] { return io::FrameSequence::open(folder_).intrinsics(); });
}

std::unique_ptr<Session> GrowingFolder::begin(const SessionOptions& options,
                                              const std::filesystem::path& checkpoint) {
    const auto found = intrinsics();
    if (!found) return nullptr;
    auto session = session_of(found, options, checkpoint);
    poses_.assign(session->next_frame(), std::nullopt);
    // No image's: all are corrected.
    for (const FrameId frame : session->frames()) poses_[frame] = Mat4{};
    return session;
}

std::string GrowingFolder::missing_from(const std::string& out) const {
    if (damaged_ == 0) return Feed::missing_from(out);
    if (out.empty()) return first_damaged_;
    return first_damaged_ + "; " + io::counted(damaged_, "damaged image") + " of " +
           std::to_string(poses_.size()) + " left out of " + out;
}

GrowingFolder::Stamps GrowingFolder::stamps_of(const io::FrameSequence& frames, std::size_t image) {
    Stamps out;
    for (const std::filesystem::path& file : frames.files(image)) {
        std::error_code no_size, no_time;  // it may be gone by now
        const auto size = std::filesystem::file_size(file, no_size);
        const auto time = std::filesystem::last_write_time(file, no_time);
        out.emplace_back(no_size ? 0 : size,
                         no_time ? std::filesystem::file_time_type::min() : time);
    }
    return out;
}

// Of the image that can't be read: programs write one after the other, so that it is not being
// written where one behind it is whole and it has not changed for a while.
bool GrowingFolder::is_damaged(const io::FrameSequence& frames, std::size_t image) {
    Stamps now = stamps_of(frames, image);
    if (now != unread_) {
        unread_ = std::move(now);
        unread_since_ = Clock::now();
        return false;
    }
    if (Clock::now() - unread_since_ < patience_) return false;
    std::string why;
    for (std::size_t n = image + 1; n < frames.size(); ++n)
        if (unless_unfinished(why, [&] { return frames.load(n); })) return true;
    return false;
}

void GrowingFolder::leave_out_damaged(Session& session, const Reading& how) {
    poses_.emplace_back();
    session.skip_frame();
    unread_.clear();
    if (damaged_++ == 0) first_damaged_ = waits_for_;
    if (how.told) how.told(waits_for_ + "; it is left out");
    waits_for_.clear();
}

bool GrowingFolder::read(Session& session, const Reading& how) {
    waits_for_.clear();
    const auto frames =
        unless_unfinished(waits_for_, [&] { return io::FrameSequence::open(folder_); });
    if (!frames) return false;
    if (frames->size() < poses_.size())
        io::fail(folder_, "has " + std::to_string(frames->size()) + " depth images, but had " +
                              std::to_string(poses_.size()) +
                              "; frames may come, but none may go while it is followed");
    std::map<FrameId, Mat4> corrected;
    for (std::size_t n = 0; n < poses_.size(); ++n) {
        if (!poses_[n] || *poses_[n] == frames->poses()[n]) continue;
        poses_[n] = corrected[n] = frames->poses()[n];
    }
    session.correct(corrected);
    std::size_t added = 0;
    while (poses_.size() < frames->size() && added < how.most) {
        const std::size_t n = poses_.size();
        const auto frame = unless_unfinished(waits_for_, [&] { return frames->load_coloured(n); });
        if (!frame) {
            if (!how.is_last && !is_damaged(*frames, n)) break;
            leave_out_damaged(session, how);
            continue;
        }
        unread_.clear();
        try {
            session.add(view_of(*frame, frames->intrinsics()), frames->poses()[n]);
            poses_.emplace_back(frames->poses()[n]);
            ++added;
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            poses_.emplace_back();
            session.skip_frame();
            if (how.told)
                how.told(io::path_text(frames->files(n).front()) + ": " + error.what() +
                         "; it is left out");
        }
    }
    return !corrected.empty() || added > 0;
}

}  // namespace topple::live
