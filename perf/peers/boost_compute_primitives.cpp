// SPDX-License-Identifier: MIT
#include <algorithm>
#include <boost/compute/algorithm/copy_if.hpp>
#include <boost/compute/algorithm/exclusive_scan.hpp>
#include <boost/compute/algorithm/reduce.hpp>
#include <boost/compute/algorithm/reduce_by_key.hpp>
#include <boost/compute/algorithm/sort.hpp>
#include <boost/compute/algorithm/sort_by_key.hpp>
#include <boost/compute/algorithm/unique_copy.hpp>
#include <boost/compute/container/vector.hpp>
#include <boost/compute/lambda.hpp>
#include <boost/compute/system.hpp>
#include <boost/version.hpp>

#include "perf/kernels/stopwatch.h"
#include "perf/peers/primitive_peers.h"

namespace topple::perf {

namespace compute = boost::compute;

std::optional<PrimitivePeers> boost_compute_primitives(const PrimitiveInput& in, unsigned runs) {
    compute::command_queue queue = compute::system::default_queue();
    using Vector = compute::vector<std::uint32_t>;
    const std::size_t count = in.words.size();
    const auto filled = [&](const std::vector<std::uint32_t>& from) {
        return Vector(from.begin(), from.end(), queue);
    };
    const auto read = [&](const Vector& from, std::size_t most) {
        std::vector<std::uint32_t> out(most);
        compute::copy(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(most), out.begin(),
                      queue);
        return out;
    };
    // The first run builds the kernels.
    const auto best_of = [&](const auto& prepare, const auto& run) {
        double best = 1e300;
        for (unsigned n = 0; n <= runs; ++n) {
            prepare();
            queue.finish();
            const Stopwatch watch;
            run();
            queue.finish();
            best = std::min(best, watch.elapsed().wall_s);
        }
        return best;
    };
    const auto nothing = [] {};
    PrimitivePeers out{.library =
                           "Boost.Compute " BOOST_LIB_VERSION " on " + queue.get_device().name()};
    const Vector words = filled(in.words), values = filled(in.values),
                 ascending = filled(in.ascending);
    Vector to(count, queue.get_context()), value_to(count, queue.get_context());
    const auto fresh = [&] {
        compute::copy(words.begin(), words.end(), to.begin(), queue);
        compute::copy(values.begin(), values.end(), value_to.begin(), queue);
    };
    double seconds = best_of(fresh, [&] { compute::sort(to.begin(), to.end(), queue); });
    out.sort = PeerRun{seconds, read(to, count)};
    seconds = best_of(fresh,
                      [&] { compute::sort_by_key(to.begin(), to.end(), value_to.begin(), queue); });
    out.sort_by_key = PeerRun{seconds, read(value_to, count)};
    {
        const compute::vector<std::uint64_t> wide(in.wide.begin(), in.wide.end(), queue);
        compute::vector<std::uint64_t> wide_to(count, queue.get_context());
        seconds = best_of(
            [&] {
                compute::copy(wide.begin(), wide.end(), wide_to.begin(), queue);
                compute::copy(values.begin(), values.end(), value_to.begin(), queue);
            },
            [&] { compute::sort_by_key(wide_to.begin(), wide_to.end(), value_to.begin(), queue); });
        out.sort_wide_by_key = PeerRun{seconds, read(value_to, count)};
    }
    seconds = best_of(
        nothing, [&] { compute::exclusive_scan(words.begin(), words.end(), to.begin(), queue); });
    out.scan = PeerRun{seconds, read(to, count)};
    std::ptrdiff_t kept = 0;
    seconds = best_of(nothing, [&] {
        using compute::lambda::_1;
        kept = compute::copy_if(words.begin(), words.end(), to.begin(), _1 >= 0x80000000u, queue) -
               to.begin();
    });
    out.compact = PeerRun{seconds, read(to, static_cast<std::size_t>(kept))};
    std::uint32_t sum = 0;
    seconds = best_of(nothing, [&] {
        compute::reduce(words.begin(), words.end(), &sum, compute::plus<std::uint32_t>(), queue);
    });
    out.reduce = PeerRun{seconds, {sum}};
    std::ptrdiff_t runs_of = 0;
    seconds = best_of(nothing, [&] {
        runs_of = compute::reduce_by_key(ascending.begin(), ascending.end(), values.begin(),
                                         to.begin(), value_to.begin(), queue)
                      .second -
                  value_to.begin();
    });
    out.segmented_sum = PeerRun{seconds, read(value_to, static_cast<std::size_t>(runs_of))};
    seconds = best_of(nothing, [&] {
        runs_of = compute::unique_copy(ascending.begin(), ascending.end(), to.begin(), queue) -
                  to.begin();
    });
    out.unique = PeerRun{seconds, read(to, static_cast<std::size_t>(runs_of))};
    return out;
}

}  // namespace topple::perf
