// SPDX-License-Identifier: MIT
#pragma once

#include "topple/kernel_testing/compare.h"
#include "topple/kernels/primitives/words.h"

namespace topple::test {

class RandomBatch;

// A kernel, or a primitive, that is given random inputs. The same generator gives the same ones on
// every device.
struct RandomCase {
    const char* name;
    std::uint32_t most;  // largest size
    void (*add)(RandomBatch& to, Random& random, std::uint32_t size);
};
std::span<const RandomCase> random_kernels();
std::span<const RandomCase> random_voxels();
std::span<const RandomCase> random_primitives();

// Many dispatches of one submit. All their arrays lie in one buffer, with guard words between them.
class RandomBatch {
  public:
    explicit RandomBatch(device::Device& device)
        : queue(device), scratch(device), buffer_(device, words, "arrays") {}

    // Random numbers of one dispatch: the seed tells them all.
    void add(const RandomCase& test, std::uint64_t seed);
    // Runs what was added. Afterwards agrees_with() compares, and clear() makes room.
    void run();
    void clear();
    // Nothing but outputs was written, and every one of their words is what it is there.
    ::testing::AssertionResult agrees_with(const RandomBatch& other) const;

    // What cases take: arrays of what is given, or that are written; then a dispatch.
    template <class T>
    device::Slice<T> in(const std::vector<T>& values) {
        return array(values, Use::read);
    }
    template <class T>
    device::Slice<T> inout(const std::vector<T>& values) {
        return array(values, std::is_floating_point_v<T> ? Use::written_real : Use::written);
    }
    template <class T>
    device::Slice<T> out(std::size_t count) {
        return inout(std::vector<T>(count, std::bit_cast<T>(guard)));
    }
    device::Queue queue;
    primitives::Scratch scratch;

  private:
    enum class Use : std::uint8_t { guard, read, written, written_real };
    struct Array {
        const RandomCase* test;
        std::uint64_t seed;
        std::uint32_t size;
        std::size_t number, first;  // among the dispatch's arrays; word
    };
    static constexpr std::uint32_t guard = 0x4b1d4b1du;
    static constexpr std::size_t words = 1u << 22;

    // At least one guard word stands behind it.
    template <class T>
    device::Slice<T> array(const std::vector<T>& values, Use use) {
        arrays_.push_back(now_);
        arrays_.back().first = image_.size();
        ++now_.number;
        for (const T& value : values) image_.push_back(bits(value));
        use_.resize(image_.size(), use);
        constexpr std::size_t unit = primitives::slice_words;
        image_.resize((image_.size() / unit + 1) * unit, guard);
        use_.resize(image_.size(), Use::guard);
        return {buffer_.slice(arrays_.back().first, values.size()).range};
    }

    device::Buffer<std::uint32_t> buffer_;
    std::vector<std::uint32_t> image_, result_;  // before and afterwards
    std::vector<Use> use_;                       // of each word
    std::vector<Array> arrays_;
    Array now_{};
};

// Numbers of all magnitudes up to `most`, with denormals, and zeros of both signs.
inline std::vector<float> reals(Random& random, std::size_t count, float most) {
    std::vector<float> out(count);
    for (float& value : out) {
        const std::uint32_t kind = random.below(16), sign = random.word() & 0x80000000u;
        const std::uint32_t magnitude = kind == 0   ? 0
                                        : kind == 1 ? random.word() >> 9
                                        : kind < 5  ? random.below(std::size_t{bits(most)} + 1)
                                                    : bits(random.uniform(0, most));
        value = std::bit_cast<float>(sign | magnitude);
    }
    return out;
}
inline std::vector<float> positive(Random& random, std::size_t count, float most) {
    auto out = reals(random, count, most);
    for (float& value : out) value = std::fabs(value);
    return out;
}
// And infinities; and NaN, too.
inline std::vector<float> unbounded(Random& random, std::size_t count, bool nan) {
    auto out = reals(random, count, std::numeric_limits<float>::max());
    for (float& value : out) {
        const std::uint32_t kind = random.below(16);
        if (kind == 0) value = std::copysign(std::numeric_limits<float>::infinity(), value);
        if (kind == 1 && nan) value = std::numeric_limits<float>::quiet_NaN();
    }
    return out;
}
// Below `below`, or any.
inline std::vector<std::uint32_t> naturals(Random& random, std::size_t count,
                                           std::size_t below = std::size_t{1} << 32) {
    std::vector<std::uint32_t> out(count);
    for (auto& word : out) word = random.below(below);
    return out;
}
inline std::vector<std::int32_t> integers(Random& random, std::size_t count, std::int32_t low,
                                          std::int32_t high) {
    std::vector<std::int32_t> out(count);
    for (auto& value : out)
        value = low + static_cast<std::int32_t>(random.below(static_cast<std::size_t>(high - low)));
    return out;
}
// Where each of `count` lists begins, of up to `longest` elements, and where the last ends.
inline std::vector<std::uint32_t> beginnings(Random& random, std::size_t count,
                                             std::uint32_t longest) {
    std::vector<std::uint32_t> out{0};
    while (out.size() <= count) out.push_back(out.back() + random.below(longest + 1u));
    return out;
}

}  // namespace topple::test
