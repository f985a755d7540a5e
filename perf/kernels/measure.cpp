// SPDX-License-Identifier: MIT
#include "perf/kernels/measure.h"

#include <algorithm>
#include <cmath>

namespace topple::perf {
namespace {

Span time_of(device::Queue& queue) {
    const Stopwatch watch;
    queue.run();
    return watch.elapsed();
}

}  // namespace

Result named(const device::Device& device, std::string name, Work work) {
    Result result;
    result.backend = device::to_string(device.info().backend);
    result.device = device.info().name;
    result.driver = device.info().driver;
    result.gpu = device.info().gpu;
    result.name = std::move(name);
    result.work = work;
    return result;
}

void sample(device::Device& device, Result& result, unsigned runs,
            const std::function<void()>& run) {
    for (unsigned n = 0; n < runs; ++n) {
        const device::Counters before = device.counters();
        const Stopwatch watch;
        run();
        result.add(watch.elapsed());
        if (n == 0) result.counters = device.counters() - before;
    }
}

device::Counters operator-(const device::Counters& a, const device::Counters& b) {
    return {a.dispatches - b.dispatches,
            a.submits - b.submits,
            a.kernel_builds - b.kernel_builds,
            a.bytes_written - b.bytes_written,
            a.bytes_read - b.bytes_read,
            a.bytes_bound - b.bytes_bound,
            a.waits - b.waits};
}

void Result::add(const Span& span, double runs) {
    samples_s.push_back(span.wall_s / runs);
    samples_cpu_s.push_back(span.cpu_s / runs);
}
double Result::best_cpu() const {
    if (samples_cpu_s.empty()) return 0;
    return *std::min_element(samples_cpu_s.begin(), samples_cpu_s.end());
}
double Result::best() const {
    return *std::min_element(samples_s.begin(), samples_s.end());
}
double Result::worst() const {
    return *std::max_element(samples_s.begin(), samples_s.end());
}
double Result::median() const {
    auto sorted = samples_s;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

Result measure(device::Device& device, const Case& test, const MeasureOptions& options) {
    const device::Counters before = device.counters();
    const Prepared prepared = test.prepare(device);
    device::Queue queue(device);
    if (prepared.reset) prepared.reset();
    prepared.enqueue(queue);
    const Span first = time_of(queue);  // builds the kernel
    Result result = named(device, test.name, prepared.work);
    result.hash = prepared.hash();
    result.counters = device.counters() - before;
    if (options.once) {
        result.add(first);
        return result;
    }

    unsigned batch = 1;
    if (!prepared.reset) {
        prepared.enqueue(queue);
        const double once = std::min(first.wall_s, time_of(queue).wall_s);
        batch = static_cast<unsigned>(std::clamp(std::ceil(0.001 / once), 1.0, 1000.0));
    }
    double spent = 0;
    const unsigned most = options.runs ? options.runs : 100;
    for (unsigned n = 0; n < most; ++n) {
        if (!options.runs && n >= 7 && spent >= options.seconds) break;
        if (prepared.reset) prepared.reset();
        for (unsigned k = 0; k < batch; ++k) prepared.enqueue(queue);
        const Span span = time_of(queue);
        spent += span.wall_s;
        result.add(span, batch);
    }
    return result;
}

void apply_roofline(std::vector<Result>& results) {
    const auto probe = [&](const std::string& backend, const char* name) -> const Result* {
        for (const Result& r : results) {
            if (r.backend == backend && r.name == name) return &r;
        }
        return nullptr;
    };
    struct Side {
        const char* probe;
        double Work::*amount;
        const char* bound;
    };
    static constexpr Side sides[] = {{"triad", &Work::bytes, "memory"},
                                     {"multiply_add", &Work::operations, "arithmetic"},
                                     {"divide", &Work::divisions, "divisions"},
                                     {"gather", &Work::gathers, "gathers"}};
    for (Result& r : results) {
        double least_s = 0;
        bool all = r.work.bytes > 0;
        for (const Side& side : sides) {
            const Result* of = probe(r.backend, side.probe);
            if (!of) all = false;
            if (!all) break;
            const double seconds = r.work.*side.amount * of->best() / (of->work.*side.amount);
            if (seconds <= least_s) continue;
            least_s = seconds;
            r.bound = side.bound;
        }
        if (all) r.share = least_s / r.best();
    }
}

}  // namespace topple::perf
