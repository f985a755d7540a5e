// SPDX-License-Identifier: MIT
#include "oracle/primitives_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"
#include "topple/kernels/primitives/components.h"
#include "topple/kernels/primitives/indexed.h"
#include "topple/kernels/primitives/reduce.h"
#include "topple/kernels/primitives/runs.h"
#include "topple/kernels/primitives/scan.h"
#include "topple/kernels/primitives/sort.h"

// The data-parallel primitives, each as a whole, on every form of the kernels.
namespace topple::test {
namespace {

using oracle::Words;
using Buffer = device::Buffer<std::uint32_t>;

// Around a chunk of each device's and a group of them; primes; more than a tile that stays in a
// cache.
constexpr std::size_t sizes[] = {0,    1,    2,    15,    16,     17,      63,        64,
                                 65,   511,  512,  513,   997,    1023,    1024,      1025,
                                 4096, 4099, 8191, 32769, 65'537, 262'147, 1'048'576, 1'299'709};

class Primitives : public EachBackend {
  protected:
    void SetUp() override {
        EachBackend::SetUp();
        if (!device) return;
        queue.emplace(*device);
        scratch.emplace(*device);
    }
    Buffer buffer(const Words& words, const char* name) { return {*device, words, name}; }
    // What stands in the first elements, for outputs that hold as many as there may be.
    static Words head(const Guarded<std::uint32_t>& from, std::size_t count) {
        Words all = from.download();
        all.resize(std::min(all.size(), count));
        return all;
    }
    static Words words(Random& random, std::size_t count, std::uint32_t below = 0) {
        Words out(count);
        for (auto& word : out) word = below ? random.below(below) : random.word();
        return out;
    }
    // Sorted, with runs of many lengths.
    static std::vector<std::uint64_t> sorted_keys(Random& random, std::size_t count, bool wide) {
        std::vector<std::uint64_t> out(count);
        std::uint64_t key = 0;
        for (auto& k : out) {
            const std::uint32_t chance = random.below(8);
            if (chance < 3) key += wide && chance == 0 ? std::uint64_t{1} << 32 : 1;
            if (count > 3000 && random.below(1000) == 0) key += 5;
            k = key;
        }
        // One run far longer than a chunk.
        if (count > 5000) std::fill(out.begin() + 1000, out.end() - 1000, out[1000]);
        std::sort(out.begin(), out.end());
        return out;
    }
    static Words low(const std::vector<std::uint64_t>& keys) {
        Words out;
        for (const std::uint64_t key : keys) out.push_back(oracle::low_word(key));
        return out;
    }
    static Words high(const std::vector<std::uint64_t>& keys) {
        Words out;
        for (const std::uint64_t key : keys) out.push_back(oracle::low_word(key >> 32));
        return out;
    }

    std::optional<device::Queue> queue;
    std::optional<primitives::Scratch> scratch;
};
TOPPLE_ON_EACH_FORM(Primitives);
// And with arrays that take several bindings.
INSTANTIATE_TEST_SUITE_P(Tiles, Primitives, ::testing::Values("vulkan_small_bindings"),
                         backend_name);

TEST_P(Primitives, ScanMatchesTheOracle) {
    for (const std::size_t count : sizes) {
        SCOPED_TRACE(count);
        Random random(count);
        const Words values = words(random, count);
        const Buffer from = buffer(values, "from");
        const Guarded<std::uint32_t> before(*device, count, "before"),
            up_to(*device, count, "up to");
        primitives::scan(*queue, *scratch, from, before.slice());
        primitives::scan(*queue, *scratch, from, up_to.slice(), true);
        queue->run();
        EXPECT_TRUE(same(before.download(), oracle::scan(values, false)));
        EXPECT_TRUE(same(up_to.download(), oracle::scan(values, true)));
        EXPECT_TRUE(before.untouched());
        EXPECT_TRUE(up_to.untouched());
    }
}

TEST_P(Primitives, CompactionMatchesTheOracle) {
    for (const std::size_t count : sizes) {
        for (const std::uint32_t one_in : {1u, 2u, 100u}) {
            SCOPED_TRACE(testing::Message() << count << ", one in " << one_in);
            Random random(count + one_in);
            const Words values = words(random, count);
            Words flags;
            for (std::size_t i = 0; i < count; ++i)
                flags.push_back(random.below(one_in) ? 0 : 1 + random.below(7));
            const Buffer flag = buffer(flags, "flags"), from = buffer(values, "from");
            const Words want = oracle::compact(flags, values);
            const Guarded<std::uint32_t> to(*device, count, "to"), kept(*device, 1, "count");
            const Guarded<std::uint32_t> few(*device, want.size() / 2, "few");
            primitives::compact(*queue, *scratch, flag, from, to.slice(), kept.slice());
            primitives::compact(*queue, *scratch, flag, from, few.slice(), kept.slice());
            queue->run();
            EXPECT_EQ(kept.download()[0], want.size());
            EXPECT_TRUE(same(head(to, want.size()), want));
            EXPECT_TRUE(same(
                few.download(),
                Words(want.begin(), want.begin() + static_cast<std::ptrdiff_t>(want.size() / 2))));
            EXPECT_TRUE(to.untouched());
            EXPECT_TRUE(few.untouched());
        }
    }
}

TEST_P(Primitives, ReductionsMatchTheOracle) {
    using primitives::Reduction;
    for (const std::size_t count : sizes) {
        SCOPED_TRACE(count);
        Random random(count);
        const Words values = words(random, count);
        const std::vector<float> reals = random.floats(count, -3, 5);
        const Buffer from = buffer(values, "from");
        const device::Buffer<float> floats(*device, reals, "floats");
        std::vector<Guarded<std::uint32_t>> to;
        std::vector<Guarded<float>> real_to;
        for (const auto reduction : {Reduction::sum, Reduction::least, Reduction::greatest}) {
            to.emplace_back(*device, 1, "to");
            real_to.emplace_back(*device, 1, "to");
            primitives::reduce(*queue, *scratch, reduction, from, to.back().slice());
            primitives::reduce(*queue, *scratch, reduction, floats, real_to.back().slice());
        }
        queue->run();
        EXPECT_EQ(to[0].download()[0], oracle::low_word(std::accumulate(
                                           values.begin(), values.end(), std::uint64_t{0})));
        EXPECT_EQ(to[1].download()[0], count ? *std::ranges::min_element(values) : ~0u);
        EXPECT_EQ(to[2].download()[0], count ? *std::ranges::max_element(values) : 0u);
        const auto [sum, bound] = oracle::float_sum(reals);
        EXPECT_TRUE(within(real_to[0].download(), {sum}, {bound}));
        EXPECT_EQ(real_to[1].download()[0], count ? *std::ranges::min_element(reals) : HUGE_VALF);
        EXPECT_EQ(real_to[2].download()[0], count ? *std::ranges::max_element(reals) : -HUGE_VALF);
        for (const auto& one : to) EXPECT_TRUE(one.untouched());
        for (const auto& one : real_to) EXPECT_TRUE(one.untouched());
    }
}

TEST_P(Primitives, FloatSumsHaveTheBitsOfNative) {
    const std::vector<float> reals = Random(7).floats(1'299'709, -3, 5);
    const auto sum_on = [&](device::Device& on) {
        primitives::Scratch memory(on);
        device::Queue order(on);
        const device::Buffer<float> from(on, reals, "from"), to(on, 1, "to");
        primitives::reduce(order, memory, primitives::Reduction::sum, from, to);
        order.run();
        return bits(to.download()[0]);
    };
    EXPECT_EQ(sum_on(*device), sum_on(*device::open_device("native")));
}

TEST_P(Primitives, SortMatchesTheOracle) {
    struct Shape {
        bool wide, valued;
        unsigned bits;
    };
    for (const std::size_t count : sizes) {
        for (const Shape& shape : {Shape{false, false, 0},
                                   {false, true, 32},
                                   {true, false, 64},
                                   {true, true, 0},
                                   {true, true, 40},
                                   {false, true, 7},
                                   {false, false, 17}}) {
            if (count > 300'000 && shape.bits && shape.bits < 64) continue;
            SCOPED_TRACE(testing::Message() << count << " of " << shape.bits << " bits");
            Random random(count);
            std::vector<std::uint64_t> keys(count);
            for (auto& key : keys) {
                key = random.word();
                // Equal ones, too, and digits that are all the same.
                if (random.below(4) == 0) key &= 0xff00ffu;
                if (shape.wide) key |= std::uint64_t{random.below(2) ? random.word() : 77} << 32;
                if (shape.bits && shape.bits < 64) key &= (std::uint64_t{1} << shape.bits) - 1;
            }
            const Words values = words(random, count);
            const Words lows = low(keys), highs = high(keys);
            const Buffer l = buffer(lows, "low"), h = buffer(highs, "high"),
                         v = buffer(values, "value");
            const Guarded<std::uint32_t> low_to(*device, count, "low"),
                high_to(*device, count, "high"), value_to(*device, count, "value");
            primitives::Records from{l}, to{low_to.slice()};
            if (shape.wide) from.high = h, to.high = high_to.slice();
            if (shape.valued) from.value = v, to.value = value_to.slice();
            primitives::sort(*queue, *scratch, from, to, shape.bits);
            queue->run();
            Words want_low, want_high, want_value;
            for (const std::size_t i : oracle::order(keys)) {
                want_low.push_back(lows[i]);
                want_high.push_back(highs[i]);
                want_value.push_back(values[i]);
            }
            EXPECT_TRUE(same(low_to.download(), want_low));
            if (shape.wide) {
                EXPECT_TRUE(same(high_to.download(), want_high));
            }
            if (shape.valued) {
                EXPECT_TRUE(same(value_to.download(), want_value));
            }
            EXPECT_TRUE(same(l.download(), lows));
            EXPECT_TRUE(low_to.untouched());
            EXPECT_TRUE(high_to.untouched());
            EXPECT_TRUE(value_to.untouched());
        }
    }
}

TEST_P(Primitives, UniqueAndRunLengthsMatchTheOracle) {
    for (const std::size_t count : sizes) {
        for (const bool wide : {false, true}) {
            SCOPED_TRACE(testing::Message() << count << (wide ? " wide" : ""));
            Random random(count);
            const auto keys = sorted_keys(random, count, wide);
            const Words lows = low(keys), highs = high(keys);
            const Buffer l = buffer(lows, "low"), h = buffer(highs, "high");
            const Guarded<std::uint32_t> low_to(*device, count, "low"),
                high_to(*device, count, "high"), starts(*device, count + 1, "starts"),
                lengths(*device, count, "lengths"), runs(*device, 1, "count");
            const auto of =
                wide ? primitives::Segments::of_keys(l, h) : primitives::Segments::of_keys(l);
            primitives::unique(*queue, *scratch, of, low_to.slice(), high_to.slice(),
                               starts.slice(), runs.slice());
            primitives::run_lengths(*queue, starts.slice(), runs.slice(), lengths.slice());
            queue->run();
            const auto begins =
                wide ? oracle::begins(keys) : oracle::begins({lows.begin(), lows.end()});
            Words want_low, want_high, want_start, want_length;
            for (std::size_t i = 0; i < count; ++i) {
                if (begins[i]) {
                    want_low.push_back(lows[i]);
                    want_high.push_back(highs[i]);
                    want_start.push_back(static_cast<std::uint32_t>(i));
                    want_length.push_back(0);
                }
                ++want_length.back();
            }
            want_start.push_back(static_cast<std::uint32_t>(count));
            EXPECT_EQ(runs.download()[0], want_low.size());
            EXPECT_TRUE(same(head(low_to, want_low.size()), want_low));
            if (wide) {
                EXPECT_TRUE(same(head(high_to, want_high.size()), want_high));
            }
            EXPECT_TRUE(same(head(starts, want_start.size()), want_start));
            EXPECT_TRUE(same(head(lengths, want_length.size()), want_length));
            for (const auto* one : {&low_to, &high_to, &starts, &lengths, &runs})
                EXPECT_TRUE(one->untouched());
        }
    }
}

TEST_P(Primitives, SegmentedSumsAndScansMatchTheOracle) {
    enum Kind { flags, keys, wide };
    for (const std::size_t count : sizes) {
        for (const Kind kind : {flags, keys, wide}) {
            SCOPED_TRACE(testing::Message() << count << " kind " << kind);
            Random random(count);
            const auto key = sorted_keys(random, count, kind == wide);
            const Words lows = low(key), highs = high(key);
            auto begins = oracle::begins(key);
            Words flag;
            for (const bool b : begins) flag.push_back(b ? 1 + random.below(9) : 0);
            // The first element begins a segment, whatever its flag.
            if (count > 0) flag[0] = random.below(2);
            if (kind == keys) begins = oracle::begins({lows.begin(), lows.end()});
            const Words values = words(random, count);
            const Buffer l = buffer(lows, "low"), h = buffer(highs, "high"),
                         f = buffer(flag, "flags"), v = buffer(values, "values");
            const auto of = kind == flags  ? primitives::Segments::of_flags(f)
                            : kind == keys ? primitives::Segments::of_keys(l)
                                           : primitives::Segments::of_keys(l, h);
            const Guarded<std::uint32_t> sums(*device, count, "sums"), runs(*device, 1, "count"),
                before(*device, count, "before"), up_to(*device, count, "up to");
            primitives::segmented_sum(*queue, *scratch, of, v, sums.slice(), runs.slice());
            primitives::segmented_scan(*queue, *scratch, of, v, up_to.slice());
            primitives::segmented_scan(*queue, *scratch, of, v, before.slice(), false);
            queue->run();
            const Words want = oracle::segmented_sum(begins, values);
            EXPECT_EQ(runs.download()[0], want.size());
            EXPECT_TRUE(same(head(sums, want.size()), want));
            EXPECT_TRUE(same(up_to.download(), oracle::scan(values, true, begins)));
            EXPECT_TRUE(same(before.download(), oracle::scan(values, false, begins)));
            for (const auto* one : {&sums, &runs, &before, &up_to}) EXPECT_TRUE(one->untouched());
        }
    }
}

TEST_P(Primitives, SumsByKeyAndHistogramsMatchTheOracle) {
    for (const std::size_t count : sizes) {
        for (const std::uint32_t keys : {1u, 13u, 1000u, 70'001u}) {
            SCOPED_TRACE(testing::Message() << count << " of " << keys << " keys");
            Random random(count);
            // Keys that there are no sums of are left out.
            const Words key = words(random, count, keys + 3), values = words(random, count);
            const Buffer k = buffer(key, "keys"), v = buffer(values, "values");
            Guarded<std::uint32_t> sums(*device, keys, "sums"), counts(*device, keys, "counts");
            sums.upload(Words(keys, 5));
            counts.upload(Words(keys, 0));
            primitives::add_by_key(*queue, k, v, sums.slice());
            primitives::histogram(*queue, k, counts.slice());
            queue->run();
            std::vector<std::uint64_t> want(keys + 3, 5), want_count(keys + 3);
            for (std::size_t i = 0; i < count; ++i) {
                want[key[i]] += values[i];
                ++want_count[key[i]];
            }
            want.resize(keys);
            want_count.resize(keys);
            EXPECT_TRUE(same(sums.download(), low(want)));
            EXPECT_TRUE(same(counts.download(), low(want_count)));
            EXPECT_TRUE(sums.untouched());
            EXPECT_TRUE(counts.untouched());
        }
    }
}

TEST_P(Primitives, GatherAndScatterMatchTheOracle) {
    for (const std::size_t count : sizes) {
        SCOPED_TRACE(count);
        Random random(count);
        Words index(count + 2);
        std::iota(index.begin(), index.end(), 0u);
        random.shuffle(index);
        const Words values = words(random, count + 2);
        const Buffer at = buffer(index, "index"), from = buffer(values, "from");
        Guarded<std::uint32_t> gathered(*device, count + 2, "gathered"),
            scattered(*device, count, "scattered");
        gathered.upload(Words(count + 2, 9));
        primitives::gather(*queue, at, from, gathered.slice());
        primitives::scatter(*queue, at, from, scattered.slice());
        queue->run();
        Words want(count + 2), want_scattered(count);
        for (std::size_t i = 0; i < index.size(); ++i) {
            want[i] = values[index[i]];
            if (index[i] < count) want_scattered[index[i]] = values[i];
        }
        EXPECT_TRUE(same(gathered.download(), want));
        EXPECT_TRUE(same(scattered.download(), want_scattered));
        EXPECT_TRUE(gathered.untouched());
        EXPECT_TRUE(scattered.untouched());
    }
}

TEST_P(Primitives, ComponentsMatchTheOracle) {
    struct Graph {
        std::uint32_t nodes;
        std::size_t edges;
        bool chain;
    };
    for (const Graph& g : {Graph{0, 0, false},
                           {1, 0, false},
                           {1, 3, false},
                           {2, 1, false},
                           {65, 40, false},
                           {997, 400, false},
                           {997, 5000, false},
                           {100'003, 60'000, false},
                           {250'007, 250'006, true}}) {
        SCOPED_TRACE(testing::Message() << g.nodes << " nodes, " << g.edges << " edges");
        Random random(g.edges);
        Words from, to;
        Words name(g.nodes);
        std::iota(name.begin(), name.end(), 0u);
        random.shuffle(name);
        for (std::size_t e = 0; e < g.edges; ++e) {
            // Of a chain each tenth link is missing; a node beyond the last is none.
            from.push_back(g.chain ? name[e] : random.below(g.nodes + 1u));
            to.push_back(g.chain ? name[e % 10 ? e + 1 : e] : random.below(g.nodes + 1u));
        }
        const Buffer a = buffer(from, "from"), b = buffer(to, "to");
        const Guarded<std::uint32_t> got(*device, g.nodes, "components");
        primitives::connected_components(*queue, *scratch, a, b, got.slice());
        queue->run();
        EXPECT_TRUE(same(got.download(), oracle::components(g.nodes, from, to)));
        EXPECT_TRUE(got.untouched());
    }
}

TEST_P(Primitives, ScratchIsTakenAgain) {
    const auto memory = [&] {
        const auto a = scratch->take(1000), b = scratch->take(500);
        return std::pair{a.words().range.memory, b.words().range.memory};
    };
    const auto first = memory();
    EXPECT_NE(first.first, first.second);
    EXPECT_EQ(memory(), first);
}

TEST_P(Primitives, OutputsThatAreTooSmallAreRefused) {
    const Buffer from(*device, 10, "from"), to(*device, 9, "to");
    EXPECT_THAT(message_of([&] { primitives::scan(*queue, *scratch, from, to); }),
                ::testing::HasSubstr("the output of a scan has 9 words; it needs 10"));
}

class ManyKeys : public Primitives {};
TOPPLE_ON_EACH_FORM(ManyKeys);

// As many as once gave each work-item of two threads more of them than lavapipe runs rounds of
// loops.
TEST_P(ManyKeys, AreSorted) {
    constexpr std::size_t count = std::size_t{1} << 24;
    constexpr unsigned bits = 8;
    Words keys(count);
    for (std::size_t i = 0; i < count; ++i)
        keys[i] = static_cast<std::uint32_t>(i) * 2654435761u >> (32 - bits);
    const Buffer from = buffer(keys, "keys"), to(*device, count, "sorted");
    primitives::sort(*queue, *scratch, {from}, {to}, bits);
    queue->run();
    Words want;
    want.reserve(count);
    std::array<std::size_t, 1u << bits> of_key{};
    for (const std::uint32_t key : keys) ++of_key[key];
    for (std::uint32_t key = 0; key < of_key.size(); ++key)
        want.insert(want.end(), of_key[key], key);
    EXPECT_TRUE(same(to.download(), want));
}

}  // namespace
}  // namespace topple::test
