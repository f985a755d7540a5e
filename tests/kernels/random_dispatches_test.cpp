// SPDX-License-Identifier: MIT
#include "random_dispatches.h"

#include "device/devices.h"
#include "topple/kernel_testing/each_backend.h"

// Random dispatches of all kernels give the same bits on native and on another device.
namespace topple::test {

void RandomBatch::add(const RandomCase& test, std::uint64_t seed) {
    // Few, around groups and chunks, or up to `most`, small ones as often as large ones.
    static constexpr std::uint32_t units[] = {16, 32, 64, 256, 512, 1024};
    Random random(seed);
    const std::uint32_t kind = random.below(4);
    std::uint32_t size = random.below(20);
    if (kind == 1)
        size = units[random.below(std::size(units))] * (1 + random.below(3)) + size % 3 - 1;
    if (kind > 1 || size > test.most) size = random.below(test.most + 1u) >> random.below(8);
    now_ = {&test, seed, size, 0, 0};
    test.add(*this, random, size);
}

void RandomBatch::run() {
    result_.resize(image_.size());
    buffer_.upload(std::span<const std::uint32_t>(image_));
    queue.run();
    buffer_.download(std::span<std::uint32_t>(result_));
}

void RandomBatch::clear() {
    image_.clear();
    use_.clear();
    arrays_.clear();
}

::testing::AssertionResult RandomBatch::agrees_with(const RandomBatch& other) const {
    if (image_ != other.image_) return ::testing::AssertionFailure() << "the inputs differ";
    for (std::size_t i = 0; i < image_.size(); ++i) {
        const bool written = use_[i] == Use::written || use_[i] == Use::written_real;
        const std::uint32_t want = written ? other.result_[i] : image_[i];
        if (result_[i] == want) continue;
        if (use_[i] == Use::written_real &&
            alike(std::bit_cast<float>(result_[i]), std::bit_cast<float>(want)))
            continue;
        const auto next = std::ranges::upper_bound(arrays_, i, {}, &Array::first);
        const Array& array = *std::prev(next);
        return ::testing::AssertionFailure()
               << array.test->name << ", seed " << array.seed << ", size " << array.size
               << ": element " << i - array.first << " of array " << array.number << " is "
               << result_[i] << (written ? ", on native " : " instead of ") << want;
    }
    return ::testing::AssertionSuccess();
}

namespace {

class RandomDispatches : public EachBackend {};
TOPPLE_ON_EACH_FORM(RandomDispatches);

// On native itself with one thread and with all.
TEST_P(RandomDispatches, GiveTheBitsOfNative) {
    constexpr std::uint64_t dispatches = 12'500, of_submit = 50;
    std::vector<RandomCase> cases;
    for (const auto& some : {random_kernels(), random_voxels(), random_primitives()})
        cases.insert(cases.end(), some.begin(), some.end());
    const auto native = device::open_native(1);
    RandomBatch batch(*device), reference(*native);
    std::uint64_t seed = 0;
    while (device->counters().dispatches < dispatches) {
        for (std::uint64_t n = 0; n < of_submit; ++n, ++seed) {
            const RandomCase& test = cases[seed % cases.size()];
            batch.add(test, seed);
            reference.add(test, seed);
        }
        batch.run();
        reference.run();
        ASSERT_TRUE(batch.agrees_with(reference));
        ASSERT_TRUE(reference.agrees_with(reference));
        batch.clear();
        reference.clear();
    }
    EXPECT_GE(seed, cases.size() * 100);
}

}  // namespace
}  // namespace topple::test
