// SPDX-License-Identifier: MIT
#include "live/passes.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "core/random.h"
#include "live/gone_things.h"

namespace topple::live {
namespace {

// Things are told by this many frames at most, the same ones as long as these are not too many.
constexpr std::size_t most_telling = 96;

// One that has nothing to do with when it was taken: of a camera that swings to and fro, each
// second frame looks the same way.
std::uint64_t number_of(FrameId frame) {
    return Random(frame).bits();
}

}  // namespace

Passes::Passes(const Frames& frames, const ScanKind& kind, const std::map<FrameId, Mat4>& parsed,
               ThreadPool& threads)
    : frames_(frames), kind_(kind), threads_(threads) {
    const FrameId first_new = parsed.empty() ? 0 : parsed.rbegin()->first + 1;
    std::size_t old = 0;
    std::vector<std::optional<Mat4>> before;
    for (const auto& [frame, kept] : frames) {
        old += frame < first_new;
        const auto pose = parsed.find(frame);
        before.push_back(pose == parsed.end() ? std::nullopt : std::optional(pose->second));
        ids_.push_back(frame);
        images_.push_back(posed_image(kept));
    }
    const Looks looks(kind.projection(), images_, threads, std::move(before));
    const std::size_t all = images_.size();
    later_ = looks.look([&](std::size_t n) { return std::pair(n + 1, all); });
    earlier_ =
        looks.look([&](std::size_t n) { return std::pair(std::size_t{0}, n < old ? 0 : old); });
}

std::vector<Gone> Passes::leave_out(Remembered& remembered, std::vector<bool>& no_longer) const {
    const FramesLooked looked{kind_.projection(), ids_, images_, later_};
    std::vector<ThingPixels> gone = still_gone(std::move(remembered.gone), looked);
    const auto pixels_of = [&](FrameId frame) {
        const auto kept = frames_.find(frame);
        return kept == frames_.end() ? std::vector<std::uint32_t>()
                                     : kind_.spot_pixels(kept->second);
    };
    const auto things = gone_of(remembered.things.pixels(pixels_of), looked);
    no_longer.clear();
    for (const ThingPixels& thing : things) no_longer.push_back(!thing.empty());
    std::ranges::copy_if(things, std::back_inserter(gone),
                         [](const ThingPixels& thing) { return !thing.empty(); });
    remembered.gone = std::move(gone);
    std::vector<Gone> out;
    for (const Looked& of : later_) out.push_back(of.through);
    add_things(remembered.gone, looked, out);
    return out;
}

ShownObjects Passes::shown(const FrameLabeller& labeller) const {
    std::uint64_t every = 1;
    const auto telling = [&] {
        return static_cast<std::size_t>(std::ranges::count_if(
            ids_, [&](FrameId frame) { return number_of(frame) % every == 0; }));
    };
    while (telling() > most_telling) every *= 2;
    const auto at = [](const Looked& looked, const std::vector<std::uint32_t>& spots) {
        std::vector<Says> out;
        for (const std::uint32_t pixel : spots) out.push_back(looked.says[pixel]);
        return out;
    };
    ShownObjects out;
    for (std::size_t n = 0; n < ids_.size(); ++n) {
        if (number_of(ids_[n]) % every != 0) continue;
        ScanKind::Spots spots =
            kind_.spots(frames_.at(ids_[n]), images_[n], labeller, threads_.threads());
        out[ids_[n]] = {std::move(spots.object), at(later_[n], spots.pixel),
                        at(earlier_[n], spots.pixel)};
    }
    return out;
}

}  // namespace topple::live
