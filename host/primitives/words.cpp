// SPDX-License-Identifier: MIT
#include "topple/kernels/primitives/words.h"

#include <algorithm>

namespace topple::primitives {

namespace {

std::vector<Tile> tiles_of(std::uint64_t count, std::uint64_t step) {
    std::vector<Tile> out;
    for (std::uint64_t first = 0; first < count; first += step)
        out.push_back({static_cast<std::uint32_t>(first),
                       static_cast<std::uint32_t>(std::min(step, count - first))});
    return out;
}

// With room for the words before a tile (RunParams::skip).
std::uint64_t most_words(const device::Device& device) {
    return std::min(device.info().limits.max_binding_bytes / 4 - slice_words,
                    std::uint64_t{1} << 31);
}

}  // namespace

std::vector<Tile> tiles(const device::Device& device, std::uint64_t count, std::uint64_t unit) {
    return tiles_of(count, most_words(device) / unit * unit);
}

std::vector<Tile> cached_tiles(const device::Device& device, std::uint64_t count) {
    constexpr std::uint64_t cached = std::uint64_t{1} << 20;
    const std::uint64_t most = most_words(device) / slice_words * slice_words;
    return tiles_of(count, device.info().gpu ? most : std::min(cached, most));
}

std::vector<Tile> windows(const device::Device& device, const Words& words) {
    auto out = tiles(device, size(words));
    if (out.empty()) out.push_back({0, 0});
    return out;
}

void check_size(const Words& words, std::uint64_t least, const char* name) {
    if (size(words) < least)
        throw Error(ErrorKind::device, std::string(name) + " has " + std::to_string(size(words)) +
                                           " words; it needs " + std::to_string(least));
}

Scratch::Lease Scratch::take(std::uint64_t count) {
    Block* best = nullptr;
    for (const auto& block : blocks_) {
        if (block->free && block->words.size() >= count &&
            (!best || block->words.size() < best->words.size()))
            best = block.get();
    }
    if (!best) {
        blocks_.push_back(std::make_unique<Block>(
            Block{{device_, std::max<std::uint64_t>(count, slice_words), "scratch"}, true}));
        best = blocks_.back().get();
    }
    best->free = false;
    return {best->words.slice(0, count), &best->free};
}

}  // namespace topple::primitives
