// SPDX-License-Identifier: MIT
#include "safety/earthquake/rocking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "physics/landscape.h"
#include "rocking.hpp"
#include "topple/kernels/queue.h"

namespace topple::safety {
namespace {

using physics::gravity;

constexpr float quarter_turn = 1.5707963f;  // as the kernel has it
constexpr double longest_step = 0.05;       // times 1 / p
// After a record a body near its balance has so long to make up its mind.
constexpr float longest_after_s = 30;
constexpr std::size_t chunk_steps = 32, block_events = 64;
constexpr std::size_t most_events = std::size_t{1} << 20;  // of a batch: 40 MiB of outcomes
constexpr std::size_t outcome_planes = 10;
// Of a dispatch: half of the rounds that the dialect allows a work-item.
constexpr std::uint32_t most_chunks = 1024;

// The quicker one of its two edges.
double quickness(const Profile& body) {
    const auto about = [&](double base) {
        const double radius = std::hypot(base, body.height_m);
        return std::sqrt(gravity * radius / (body.gyration_m * body.gyration_m + radius * radius));
    };
    return std::max(about(body.ahead_m), about(body.behind_m));
}

// Records as the kernel takes them, steps cut in so many that none is longer than longest_s.
struct Chunks {
    std::vector<std::uint32_t> first{0};
    std::vector<float> step_s;
    std::array<std::vector<float>, 3> means, strongest;  // along, across, up

    void add(const Accelerogram& record, double longest_s) {
        const auto parts =
            static_cast<std::size_t>(std::max(1.0, std::ceil(record.step_s / longest_s)));
        step_s.push_back(static_cast<float>(record.step_s / static_cast<double>(parts)));
        const std::size_t steps = (std::max<std::size_t>(record.m_s2.size(), 1) - 1) * parts;
        const std::size_t chunks = (steps + chunk_steps - 1) / chunk_steps;
        const std::array<const std::vector<double>*, 3> components{
            &record.m_s2, &record.across_m_s2, &record.up_m_s2};
        for (std::size_t c = 0; c < components.size(); ++c) {
            const std::vector<double>& values = *components[c];
            const std::size_t start = means[c].size();
            means[c].resize(start + chunks * chunk_steps, 0.0f);
            for (std::size_t s = 0; s < steps && !values.empty(); ++s) {
                const std::size_t n = s / parts;
                const double middle =
                    (static_cast<double>(s % parts) + 0.5) / static_cast<double>(parts);
                means[c][start + s] =
                    static_cast<float>(values[n] + (values[n + 1] - values[n]) * middle);
            }
            for (std::size_t k = 0; k < chunks; ++k) {
                float most = 0;
                for (std::size_t s = 0; s < chunk_steps; ++s) {
                    const float a = means[c][start + k * chunk_steps + s];
                    most = c < 2 ? std::max(most, std::fabs(a)) : std::min(most, a);
                }
                strongest[c].push_back(most);
            }
        }
        first.push_back(first.back() + static_cast<std::uint32_t>(chunks));
        const double after = longest_after_s / (static_cast<double>(chunk_steps) * step_s.back());
        longest = std::max(longest, static_cast<std::uint32_t>(chunks + std::ceil(after)) + 1);
    }
    std::uint32_t last() const { return static_cast<std::uint32_t>(step_s.size() - 1); }
    std::uint32_t longest = 0;  // chunks until the last motion has come to its own
};

template <class Planes>
auto joined(const Planes& planes) {
    typename Planes::value_type out;
    for (const auto& plane : planes) out.insert(out.end(), plane.begin(), plane.end());
    // A buffer has one element at least.
    if (out.empty()) out.push_back({});
    return out;
}

template <class T>
device::Buffer<T> on(device::Device& device, const std::vector<T>& values, const char* name) {
    return device::Buffer<T>(device, std::span<const T>(values), name);
}

// One dispatch: events by record and step, padded to whole blocks of each.
struct Batch {
    std::vector<std::uint32_t> source;  // index into the shakings; none: padding
    std::vector<std::uint32_t> body, block_record;
    std::array<std::vector<float>, 4> scale;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    void add(std::uint32_t index, std::uint32_t record, const Shaking& s) {
        if (body.size() % block_events == 0) block_record.push_back(record);
        push(index, s.body, s);
    }
    void fill_block() {
        while (body.size() % block_events != 0) push(none, body.back(), {});
    }

  private:
    void push(std::uint32_t index, std::uint32_t which, const Shaking& s) {
        source.push_back(index);
        body.push_back(which);
        scale[0].push_back(static_cast<float>(s.along));
        scale[1].push_back(static_cast<float>(s.across));
        scale[2].push_back(static_cast<float>(s.up));
        scale[3].push_back(static_cast<float>(s.grip));
    }
};

void run_batch(device::Device& device, const device::Buffer<float>& body, std::size_t bodies,
               const Chunks& chunks, const Batch& batch, std::vector<Motion>& out) {
    const std::size_t events = batch.body.size();
    if (events == 0) return;
    const auto event_body = on(device, batch.body, "event_body"),
               block_record = on(device, batch.block_record, "block_record"),
               record_first = on(device, chunks.first, "record_first");
    const auto event_scale = on(device, joined(batch.scale), "event_scale"),
               record_step = on(device, chunks.step_s, "record_step"),
               shaking = on(device, joined(chunks.means), "shaking"),
               strongest = on(device, joined(chunks.strongest), "strongest");
    const device::Buffer<float> outcome(device, outcome_planes * events, "outcome");
    device::Queue queue(device);
    for (std::uint32_t from = 0; from < chunks.longest; from += most_chunks) {
        queue.add<kernels::Rocking>(events,
                                    {.body = body,
                                     .event_body = event_body,
                                     .event_scale = event_scale,
                                     .block_record = block_record,
                                     .record_first = record_first,
                                     .record_step = record_step,
                                     .shaking = shaking,
                                     .strongest = strongest,
                                     .outcome = outcome},
                                    {.event_count = static_cast<std::uint32_t>(events),
                                     .body_count = static_cast<std::uint32_t>(bodies),
                                     .chunk_count = chunks.first.back(),
                                     .gravity = static_cast<float>(gravity),
                                     .longest_s = longest_after_s,
                                     .chunk_first = from,
                                     .chunk_last = from + most_chunks});
    }
    queue.run();
    std::vector<float> found(4 * events);  // without what a motion goes on from
    outcome.download(std::span(found));
    for (std::size_t e = 0; e < events; ++e) {
        if (batch.source[e] == Batch::none) continue;
        out[batch.source[e]] = {found[e], found[e + events], found[e + 2 * events],
                                found[e + 3 * events]};
    }
}

std::vector<float> planes_of(std::span<const Profile> bodies) {
    std::vector<float> out;
    const auto plane = [&](auto value) {
        for (const Profile& body : bodies)
            out.push_back(static_cast<float>(std::min(value(body), 1e30)));
    };
    plane([](const Profile& b) { return b.ahead_m; });
    plane([](const Profile& b) { return b.behind_m; });
    plane([](const Profile& b) { return b.height_m; });
    plane([](const Profile& b) { return b.gyration_m; });
    plane([](const Profile& b) { return b.friction; });
    plane([](const Profile& b) { return b.support_ahead_m; });
    plane([](const Profile& b) { return b.support_behind_m; });
    return out;
}

}  // namespace

bool Motion::overturned_ahead() const {
    return turned_ahead >= quarter_turn;
}

bool Motion::overturned_behind() const {
    return turned_behind >= quarter_turn;
}

bool Motion::slid_off(const Profile& body) const {
    const auto beyond = [](float way, double support) { return way > 0 && way >= support; };
    return beyond(slid_ahead_m, body.support_ahead_m) ||
           beyond(slid_behind_m, body.support_behind_m);
}

double Motion::raised_J_kg(const Profile& body) const {
    const auto about = [&](double base, double turned) {
        // The centre is highest above its edge.
        const double highest = std::atan2(base, body.height_m), to = std::min(turned, highest);
        return body.height_m * (std::cos(to) - 1) + base * std::sin(to);
    };
    return gravity *
           std::max(about(body.ahead_m, turned_ahead), about(body.behind_m, turned_behind));
}

std::vector<Motion> shake(device::Device& device, std::span<const Profile> bodies,
                          std::span<const Accelerogram> records,
                          std::span<const Shaking> shakings) {
    std::vector<Motion> out(shakings.size());
    // By how finely the body's steps are to be cut: each class has steps half as long.
    std::vector<int> fineness(bodies.size(), -1);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (!(bodies[b].height_m > 0)) continue;
        const double p = quickness(bodies[b]);
        fineness[b] = std::max(0, static_cast<int>(std::ceil(std::log2(p / 5))));
    }
    struct Order {
        int fineness;
        std::uint32_t record;
        double ease;  // peak over what it takes to move: what moves alike goes side by side
        std::uint32_t index;
    };
    std::vector<Order> order;
    for (std::size_t n = 0; n < shakings.size(); ++n) {
        const Shaking& s = shakings[n];
        if (fineness[s.body] < 0) continue;
        const Profile& body = bodies[s.body];
        const double least = std::min(s.grip * body.friction, body.slenderness());
        order.push_back({fineness[s.body], s.record,
                         std::hypot(s.along, s.across) / std::max(least, 1e-6),
                         static_cast<std::uint32_t>(n)});
    }
    // The finest first, which take longest.
    std::sort(order.begin(), order.end(), [](const Order& a, const Order& b) {
        if (a.fineness != b.fineness) return a.fineness > b.fineness;
        if (a.record != b.record) return a.record < b.record;
        return a.ease != b.ease ? a.ease < b.ease : a.index < b.index;
    });
    if (order.empty()) return out;
    const auto body = on(device, planes_of(bodies), "body");
    for (std::size_t n = 0; n < order.size();) {
        Chunks chunks;
        Batch batch;
        for (; n < order.size() && batch.body.size() < most_events; ++n) {
            const Order& at = order[n];
            if (batch.body.empty() || at.fineness != order[n - 1].fineness ||
                at.record != order[n - 1].record) {
                batch.fill_block();
                chunks.add(records[at.record], longest_step / 5 / std::exp2(at.fineness));
            }
            batch.add(at.index, chunks.last(), shakings[at.index]);
        }
        batch.fill_block();
        run_batch(device, body, bodies.size(), chunks, batch, out);
    }
    return out;
}

}  // namespace topple::safety
