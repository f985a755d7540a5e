// SPDX-License-Identifier: MIT
#include "live/growing_folder.h"

#include <map>
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

bool GrowingFolder::read(Session& session, std::size_t most,
                         const std::function<void(const char*)>& told) {
    waits_for_.clear();
    const auto frames =
        unless_unfinished(waits_for_, [&] { return io::FrameSequence::open(folder_); });
    if (!frames) return false;
    if (frames->size() < known_.size())
        io::fail(folder_, "has " + std::to_string(frames->size()) + " depth images, but had " +
                              std::to_string(known_.size()) +
                              "; frames may come, but none may go while it is followed");
    std::map<FrameId, Mat4> corrected;
    for (std::size_t n = 0; n < known_.size(); ++n) {
        if (!known_[n].frame || known_[n].pose == frames->poses()[n]) continue;
        corrected[*known_[n].frame] = known_[n].pose = frames->poses()[n];
    }
    session.correct(corrected);
    const std::size_t before = known_.size();
    while (known_.size() < frames->size() && known_.size() < before + most) {
        const std::size_t n = known_.size();
        const auto frame = unless_unfinished(waits_for_, [&] { return frames->load_coloured(n); });
        if (!frame) break;
        Known& known = known_.emplace_back();
        known.pose = frames->poses()[n];
        try {
            known.frame = session.add(view_of(*frame, frames->intrinsics()), known.pose);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            told(error.what());
        }
    }
    return !corrected.empty() || known_.size() > before;
}

}  // namespace topple::live
