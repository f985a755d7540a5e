// SPDX-License-Identifier: MIT
#include "live/gone_things.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

#include "core/place.h"
#include "core/rotation.h"

namespace topple::live {
namespace {

// Of a thing's pixels that later frames look at, those that they must see through; pixels that are
// too few tell nothing, also of one frame.
constexpr double least_through = 0.1, least_of_frame = 0.05;
constexpr std::size_t least_pixels = 20, least_in_frame = 3;
// Things that may go at once, and their share of all that are looked at.
constexpr std::size_t few_things = 3;
constexpr double most_things = 0.25;
// Places of a thing are told apart by so much.
constexpr double cell_m = 0.03;

Place cell_of(const Projection& by, const DepthFrame& image, std::size_t pixel) {
    const auto [x, y, z] =
        by.place(pixel % by.width(), pixel / by.width(), image.depth[pixel] / by.depth_scale());
    const Vec3 at = transformed(image.camera_to_world, {x, y, z});
    Place out{};
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = static_cast<std::int32_t>(std::floor(std::clamp(at[a] / cell_m, -1e9, 1e9)));
    return out;
}

// Of the pixels that show a thing, those of which later frames tell; and the frames that were taken
// before it had gone, 0: it has not.
struct Judged {
    std::size_t told = 0;
    std::ptrdiff_t frames = 0;
};
Judged judge(const ThingPixels& thing, const FramesLooked& frames) {
    std::size_t through = 0, told = 0, through_before = 0, told_before = 0;
    std::ptrdiff_t n = 0, before = 0;
    for (const auto& [frame, pixels] : thing) {
        ++n;
        std::size_t of_frame = 0;
        for (const std::uint32_t pixel : pixels) {
            const Says says = frames.later[frames.number_of(frame)].says[pixel];
            told += says != Says::nothing;
            of_frame += says == Says::through;
        }
        through += of_frame;
        if (of_frame < least_in_frame ||
            static_cast<double>(of_frame) < least_of_frame * static_cast<double>(pixels.size()))
            continue;
        before = n;
        through_before = through;
        told_before = told;
    }
    const bool gone =
        through_before >= least_pixels &&
        static_cast<double>(through_before) >= least_through * static_cast<double>(told_before);
    return {told, gone ? before : 0};
}

// Leaves of each thing the frames that were taken before it had gone. How many of them have, and of
// how many later frames tell.
std::pair<std::size_t, std::size_t> leave_gone(std::vector<ThingPixels>& things,
                                               const FramesLooked& frames) {
    std::size_t gone = 0, judged = 0;
    for (ThingPixels& thing : things) {
        std::erase_if(thing, [&](const auto& of) {
            return !std::ranges::binary_search(frames.ids, of.first);
        });
        const Judged of = judge(thing, frames);
        gone += of.frames > 0;
        judged += of.told >= least_pixels;
        thing.erase(std::next(thing.begin(), of.frames), thing.end());
    }
    return {gone, judged};
}

}  // namespace

std::vector<ThingPixels> gone_of(std::vector<ThingPixels> things, const FramesLooked& frames) {
    const auto [gone, judged] = leave_gone(things, frames);
    if (gone > few_things && static_cast<double>(gone) > most_things * static_cast<double>(judged))
        for (ThingPixels& thing : things) thing.clear();
    return things;
}

std::vector<ThingPixels> still_gone(std::vector<ThingPixels> things, const FramesLooked& frames) {
    leave_gone(things, frames);
    std::erase_if(things, [](const ThingPixels& thing) { return thing.empty(); });
    return things;
}

void add_things(std::span<const ThingPixels> gone, const FramesLooked& frames,
                std::vector<Gone>& through) {
    const Projection& by = frames.projection;
    const auto add = [&](std::size_t n, std::size_t pixel) {
        constexpr std::uint8_t surely = 2;
        through[n].push_back({static_cast<std::uint32_t>(pixel % by.width()),
                              static_cast<std::uint32_t>(pixel / by.width()),
                              frames.images[n].depth[pixel], surely});
    };
    std::map<Place, std::size_t> thing_at;
    FrameId end = 0;
    for (std::size_t t = 0; t < gone.size(); ++t) {
        for (const auto& [frame, pixels] : gone[t]) {
            const std::size_t n = frames.number_of(frame);
            for (const std::uint32_t pixel : pixels) {
                if (frames.images[n].depth[pixel] == 0) continue;
                thing_at[cell_of(by, frames.images[n], pixel)] = t;
                add(n, pixel);
            }
            end = std::max(end, frame);
        }
    }
    // What shows them in frames between, which tell of nothing.
    for (std::size_t n = 0; n < frames.ids.size() && frames.ids[n] < end; ++n) {
        for (std::size_t pixel = 0; pixel < by.pixels(); ++pixel) {
            if (frames.images[n].depth[pixel] == 0) continue;
            const auto at = thing_at.find(cell_of(by, frames.images[n], pixel));
            if (at == thing_at.end()) continue;
            const ThingPixels& thing = gone[at->second];
            if (frames.ids[n] < thing.rbegin()->first && !thing.contains(frames.ids[n]))
                add(n, pixel);
        }
    }
}

}  // namespace topple::live
