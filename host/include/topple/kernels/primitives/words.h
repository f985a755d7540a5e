// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "topple/kernels/queue.h"

// Data-parallel primitives on a device's buffers. Each call adds dispatches to a queue, one after
// the other, and waits for nothing; counts that come out are left on the device. Integers are
// exact, floats take one order on all devices, so that every backend gives the same bits. Arrays
// may be larger than what a binding spans. At most 2^32 - 2^22 elements.
namespace topple::primitives {

using Words = device::Slice<std::uint32_t>;

inline std::uint64_t size(const Words& words) {
    return words.range.bytes / sizeof(std::uint32_t);
}
// Words [first, first + count); first a multiple of slice_words.
inline constexpr std::uint64_t slice_words = device::slice_alignment / sizeof(std::uint32_t);
inline Words part(const Words& words, std::uint64_t first, std::uint64_t count) {
    return {{words.range.memory, words.range.offset + first * 4, count * 4}};
}

// A part of an array that a binding spans: what a dispatch reads or writes of it.
struct Tile {
    std::uint32_t first, count;
};
inline Words part(const Words& words, const Tile& tile) {
    return part(words, tile.first, tile.count);
}
template <class T>
device::Slice<T> part(const device::Slice<T>& all, const Tile& tile) {
    return {part(Words{all.range}, tile).range};
}
// Tiles of an array that a dispatch may take as bindings, the largest of whole `unit`s, which are
// multiples of slice_words; none of none.
std::vector<Tile> tiles(const device::Device& device, std::uint64_t count,
                        std::uint64_t unit = slice_words);
// The same, but of as many words as stay in a processor's cache between two dispatches.
std::vector<Tile> cached_tiles(const device::Device& device, std::uint64_t count);
// As many for an output that is written by index; an empty one of an empty array.
std::vector<Tile> windows(const device::Device& device, const Words& words);

// Throws Error(device) where the array has fewer words.
void check_size(const Words& words, std::uint64_t least, const char* name);

// Memory that primitives use between their dispatches. Dispatches run in order, so the next
// primitive of the same queue takes it again; it must outlive the queue's run.
class Scratch {
  public:
    explicit Scratch(device::Device& device) : device_(device) {}
    device::Device& device() const { return device_; }

    // Words that belong to its holder as long as it lives.
    class Lease {
      public:
        Lease(Lease&& other) noexcept
            : words_(other.words_), free_(std::exchange(other.free_, {})) {}
        Lease& operator=(Lease&&) = delete;
        ~Lease() {
            if (free_) *free_ = true;
        }
        operator const Words&() const { return words_; }
        operator device::Argument<std::uint32_t>() const { return words_; }
        const Words& words() const { return words_; }

      private:
        friend class Scratch;
        Lease(Words words, bool* free) : words_(words), free_(free) {}
        Words words_;
        bool* free_;
    };
    Lease take(std::uint64_t count);

  private:
    struct Block {
        device::Buffer<std::uint32_t> words;
        bool free;
    };
    device::Device& device_;
    std::vector<std::unique_ptr<Block>> blocks_;
};

}  // namespace topple::primitives
