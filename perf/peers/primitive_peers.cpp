// SPDX-License-Identifier: MIT
#include "perf/peers/primitive_peers.h"

#include <algorithm>
#include <cstdio>
#include <execution>
#include <functional>
#include <numeric>

#include "perf/kernels/stopwatch.h"
#include "topple/kernels/primitives/reduce.h"
#include "topple/kernels/primitives/runs.h"
#include "topple/kernels/primitives/scan.h"
#include "topple/kernels/primitives/sort.h"
#include "topple/kernels/queue.h"

namespace topple::perf {
namespace {

using Words = std::vector<std::uint32_t>;
using Buffer = device::Buffer<std::uint32_t>;

PrimitiveInput make_input(std::uint32_t count) {
    PrimitiveInput in;
    std::uint64_t state = 1;
    std::uint32_t key = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        const auto word = static_cast<std::uint32_t>(state >> 32);
        in.words.push_back(word);
        in.values.push_back(word ^ i);
        in.flags.push_back(word >> 31);
        key += word >> 29 == 0;
        in.ascending.push_back(key);
        in.wide.push_back(std::uint64_t{word} << 32 | (word * 2654435761u + i));
    }
    return in;
}

// Best of some runs, each on a fresh copy where the algorithm works in place.
template <class Prepare, class Run>
double best_of(unsigned runs, const Prepare& prepare, const Run& run) {
    double best = 1e300;
    for (unsigned n = 0; n < runs; ++n) {
        prepare();
        const Stopwatch watch;
        run();
        best = std::min(best, watch.elapsed().wall_s);
    }
    return best;
}

struct Own {
    device::Device& device;
    unsigned runs;
    primitives::Scratch scratch{device};

    template <class Add>
    double best(const Add& add) {
        device::Queue queue(device);
        return best_of(
            runs + 1, [&] { add(queue); }, [&] { queue.run(); });
    }
};

Words head(const Buffer& buffer, std::size_t count) {
    Words out(count);
    buffer.download(std::span<std::uint32_t>(out));
    return out;
}

}  // namespace

PrimitivePeers standard_primitives(const PrimitiveInput& in, unsigned runs) {
    const auto par = std::execution::par_unseq;
    PrimitivePeers out{.library = "libstdc++ with TBB"};
    Words words;
    const auto fresh = [&] { words = in.words; };
    double seconds = best_of(runs, fresh, [&] { std::sort(par, words.begin(), words.end()); });
    out.sort = PeerRun{seconds, words};

    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(in.words.size());
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    seconds = best_of(
        runs,
        [&] {
            for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {in.words[i], in.values[i]};
        },
        [&] { std::stable_sort(par, pairs.begin(), pairs.end(), less); });
    Words values;
    for (const auto& pair : pairs) values.push_back(pair.second);
    out.sort_by_key = PeerRun{seconds, values};
    pairs = {};

    std::vector<std::pair<std::uint64_t, std::uint32_t>> wide(in.wide.size());
    seconds = best_of(
        runs,
        [&] {
            for (std::size_t i = 0; i < wide.size(); ++i) wide[i] = {in.wide[i], in.values[i]};
        },
        [&] { std::stable_sort(par, wide.begin(), wide.end(), less); });
    values.clear();
    for (const auto& pair : wide) values.push_back(pair.second);
    out.sort_wide_by_key = PeerRun{seconds, values};
    wide = {};

    words.assign(in.words.size(), 0);
    const auto nothing = [] {};
    seconds = best_of(runs, nothing, [&] {
        std::exclusive_scan(par, in.words.begin(), in.words.end(), words.begin(), 0u);
    });
    out.scan = PeerRun{seconds, words};

    // By flags: copy_if looks at the elements themselves, of which the upper bit is the flag.
    Words::iterator end;
    seconds = best_of(runs, nothing, [&] {
        end = std::copy_if(par, in.words.begin(), in.words.end(), words.begin(),
                           [](std::uint32_t w) { return w >> 31 != 0; });
    });
    out.compact = PeerRun{seconds, Words(words.begin(), end)};

    std::uint32_t sum = 0;
    seconds = best_of(runs, nothing,
                      [&] { sum = std::reduce(par, in.words.begin(), in.words.end(), 0u); });
    out.reduce = PeerRun{seconds, {sum}};

    seconds = best_of(runs, nothing, [&] {
        end = std::unique_copy(par, in.ascending.begin(), in.ascending.end(), words.begin());
    });
    out.unique = PeerRun{seconds, Words(words.begin(), end)};
    return out;
}

bool compare_primitives(device::Device& device, std::uint32_t count, unsigned runs) {
    const PrimitiveInput input = make_input(count);
    const bool native = device.info().backend == device::Backend::native;
    std::optional<PrimitivePeers> peers;
    if (native)
        peers = standard_primitives(input, runs);
    else
        peers = boost_compute_primitives(input, runs);
    if (!peers) {
        std::printf("Boost.Compute: not in this build; apt-get install libboost-dev\n");
        return true;
    }
    std::printf("\n%-24s %9s %9s %9s  %u elements, %s, beside %s\n", "primitives", "topple s",
                "peer s", "ratio", count, device::to_string(device.info().backend),
                peers->library.c_str());
    Own own{device, runs};
    bool all_same = true;
    const auto row = [&](const char* name, const std::optional<PeerRun>& peer, const Buffer& out,
                         const auto& add) {
        if (!peer) return;
        const double seconds = own.best(add);
        const bool same = head(out, peer->out.size()) == peer->out;
        std::printf("%-24s %9.4f %9.4f %8.1fx  %s\n", name, seconds, peer->seconds,
                    peer->seconds / seconds, same ? "the same" : "DIFFERENT");
        std::fflush(stdout);
        all_same = all_same && same;
    };

    const Buffer words(device, input.words, "words"), values(device, input.values, "values"),
        flags(device, input.flags, "flags"), ascending(device, input.ascending, "ascending");
    const Buffer out(device, count, "out"), value_out(device, count, "values"),
        starts(device, count + 1, "starts"), number(device, 1, "count");
    row("sort", peers->sort, out,
        [&](device::Queue& queue) { primitives::sort(queue, own.scratch, {words}, {out}); });
    row("sort by key", peers->sort_by_key, value_out, [&](device::Queue& queue) {
        primitives::sort(queue, own.scratch, {words, {}, values}, {out, {}, value_out});
    });
    if (peers->sort_wide_by_key) {
        Words low, high;
        for (const std::uint64_t key : input.wide) {
            low.push_back(static_cast<std::uint32_t>(key));
            high.push_back(static_cast<std::uint32_t>(key >> 32));
        }
        const Buffer l(device, low, "low"), h(device, high, "high"), h_out(device, count, "high");
        row("sort 64 bits by key", peers->sort_wide_by_key, value_out, [&](device::Queue& queue) {
            primitives::sort(queue, own.scratch, {l, h, values}, {out, h_out, value_out});
        });
    }
    row("scan", peers->scan, out,
        [&](device::Queue& queue) { primitives::scan(queue, own.scratch, words, out); });
    row("compaction", peers->compact, out, [&](device::Queue& queue) {
        primitives::compact(queue, own.scratch, flags, words, out, number);
    });
    row("reduction", peers->reduce, number, [&](device::Queue& queue) {
        primitives::reduce(queue, own.scratch, primitives::Reduction::sum, primitives::Words(words),
                           primitives::Words(number));
    });
    row("segmented sum", peers->segmented_sum, out, [&](device::Queue& queue) {
        primitives::segmented_sum(queue, own.scratch, primitives::Segments::of_keys(ascending),
                                  values, out, number);
    });
    row("unique", peers->unique, out, [&](device::Queue& queue) {
        primitives::unique(queue, own.scratch, primitives::Segments::of_keys(ascending), out,
                           value_out, starts, number);
    });
    return all_same;
}

}  // namespace topple::perf
