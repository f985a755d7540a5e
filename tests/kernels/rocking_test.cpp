// SPDX-License-Identifier: MIT
#include "rocking.hpp"

#include "device/devices.h"
#include "errors.h"
#include "oracle/rocking_oracle.h"
#include "topple/kernel_testing/compare.h"
#include "topple/kernel_testing/each_backend.h"

namespace topple::test {
namespace {

constexpr double g = 9.80665;
constexpr std::uint32_t block_events = 64, chunk_steps = 32;

// Means over steps of one length, whole chunks of them.
struct GroundSteps {
    double step_s = 0.01;
    std::array<std::vector<float>, 3> means;  // along, across, up

    std::array<double, 2> at(double t, double along, double across, double up) const {
        const auto n = static_cast<std::size_t>(t / step_s);
        if (n >= means[0].size()) return {0, 0};
        return {along * means[0][n] + across * means[1][n], up * means[2][n]};
    }
    double duration_s() const { return step_s * static_cast<double>(means[0].size()); }
};

GroundSteps ground_steps(std::size_t chunks, double step_s) {
    GroundSteps out;
    out.step_s = step_s;
    for (auto& plane : out.means) plane.assign(chunks * chunk_steps, 0.0f);
    return out;
}

// Steps that a function of time has at their middles, along.
template <class F>
GroundSteps ground_of(double seconds, double step_s, F along) {
    const auto chunks = static_cast<std::size_t>(std::ceil(seconds / step_s / chunk_steps));
    GroundSteps out = ground_steps(chunks, step_s);
    for (std::size_t n = 0; n < out.means[0].size(); ++n)
        out.means[0][n] = static_cast<float>(along((static_cast<double>(n) + 0.5) * step_s));
    return out;
}

GroundSteps random_ground(Random& random, std::size_t chunks, double step_s) {
    GroundSteps out = ground_steps(chunks, step_s);
    for (std::size_t c = 0; c < 3; ++c) {
        for (int wave = 0; wave < 8; ++wave) {
            const double pulse = 2 * std::numbers::pi / random.uniform(0.2f, 1.4f),
                         phase = random.uniform(0, 6.28f);
            for (std::size_t n = 0; n < out.means[c].size(); ++n) {
                const double t = (static_cast<double>(n) + 0.5) * step_s;
                out.means[c][n] +=
                    static_cast<float>(0.3 * std::sin(pulse * t + phase) *
                                       std::sin(std::numbers::pi * t / out.duration_s()));
            }
        }
    }
    return out;
}

struct RockingEvent {
    std::uint32_t body = 0, record = 0;
    double along = 1, across = 0, up = 0;
    double grip = 1;  // of its body's friction
};

// One dispatch.
struct RockingCase {
    std::vector<oracle::Block> bodies;
    std::vector<GroundSteps> records;
    std::vector<RockingEvent> events;  // by rising record
};

constexpr std::size_t outcome_planes = 10;

// The outcome's planes, of the padded events; `place` tells where each event is among them.
struct RockingRun {
    std::vector<float> planes;
    std::vector<std::size_t> place;
    std::array<double, 4> of(std::size_t event) const {
        const std::size_t at = place[event], count = planes.size() / outcome_planes;
        return {planes[at], planes[at + count], planes[at + 2 * count], planes[at + 3 * count]};
    }
    bool overturned(std::size_t event) const {
        const auto found = of(event);
        return std::max(found[0], found[1]) >= 1.5707963;
    }
};

// In dispatches of so many chunks of each motion.
RockingRun run_rocking(device::Device& device, const RockingCase& c, std::uint32_t chunks = 500) {
    std::vector<float> body;
    const auto plane = [&](auto value) {
        for (const auto& b : c.bodies) body.push_back(static_cast<float>(value(b)));
    };
    plane([](const auto& b) { return b.ahead; });
    plane([](const auto& b) { return b.behind; });
    plane([](const auto& b) { return b.height; });
    plane([](const auto& b) { return b.gyration; });
    plane([](const auto& b) { return b.friction; });
    plane([](const auto& b) { return b.room_ahead; });
    plane([](const auto& b) { return b.room_behind; });
    std::vector<std::uint32_t> first{0}, event_body, block_record;
    std::vector<float> step_s, shaking, strongest;
    for (const GroundSteps& r : c.records) {
        step_s.push_back(static_cast<float>(r.step_s));
        first.push_back(first.back() + static_cast<std::uint32_t>(r.means[0].size() / chunk_steps));
    }
    for (std::size_t p = 0; p < 3; ++p) {
        for (const GroundSteps& r : c.records) {
            shaking.insert(shaking.end(), r.means[p].begin(), r.means[p].end());
            for (std::size_t n = 0; n < r.means[p].size(); n += chunk_steps) {
                float most = 0;
                for (std::size_t k = n; k < n + chunk_steps; ++k)
                    most = p < 2 ? std::max(most, std::fabs(r.means[p][k]))
                                 : std::min(most, r.means[p][k]);
                strongest.push_back(most);
            }
        }
    }
    RockingRun out;
    std::array<std::vector<float>, 4> scales;
    const auto push = [&](const RockingEvent& e) {
        if (event_body.size() % block_events == 0) block_record.push_back(e.record);
        event_body.push_back(e.body);
        scales[0].push_back(static_cast<float>(e.along));
        scales[1].push_back(static_cast<float>(e.across));
        scales[2].push_back(static_cast<float>(e.up));
        scales[3].push_back(static_cast<float>(e.grip));
    };
    for (std::size_t n = 0; n < c.events.size(); ++n) {
        if (n > 0 && c.events[n].record != c.events[n - 1].record)
            while (event_body.size() % block_events != 0) push({0, c.events[n - 1].record, 0});
        out.place.push_back(event_body.size());
        push(c.events[n]);
    }
    while (event_body.size() % block_events != 0) push({0, c.events.back().record, 0});
    std::vector<float> scale;
    for (const auto& s : scales) scale.insert(scale.end(), s.begin(), s.end());

    const device::Buffer<float> on_body(device, body, "body"), on_scale(device, scale, "scale"),
        on_step(device, step_s, "step"), on_shaking(device, shaking, "shaking"),
        on_strongest(device, strongest, "strongest");
    const device::Buffer<std::uint32_t> on_event(device, event_body, "event_body"),
        on_block(device, block_record, "block_record"), on_first(device, first, "first");
    const Guarded<float> outcome(device, outcome_planes * event_body.size(), "outcome");
    constexpr float after_s = 20;
    const float least_step = *std::ranges::min_element(step_s);
    const std::uint32_t last =
        first.back() + static_cast<std::uint32_t>(after_s / (chunk_steps * least_step)) + 2;
    device::Queue queue(device);
    for (std::uint32_t from = 0; from < last; from += chunks) {
        queue.add<kernels::Rocking>(event_body.size(),
                                    {.body = on_body,
                                     .event_body = on_event,
                                     .event_scale = on_scale,
                                     .block_record = on_block,
                                     .record_first = on_first,
                                     .record_step = on_step,
                                     .shaking = on_shaking,
                                     .strongest = on_strongest,
                                     .outcome = outcome.slice()},
                                    {.event_count = static_cast<std::uint32_t>(event_body.size()),
                                     .body_count = static_cast<std::uint32_t>(c.bodies.size()),
                                     .chunk_count = first.back(),
                                     .gravity = static_cast<float>(g),
                                     .longest_s = after_s,
                                     .chunk_first = from,
                                     .chunk_last = from + chunks});
    }
    queue.run();
    EXPECT_TRUE(outcome.untouched());
    out.planes = outcome.download();
    return out;
}

oracle::BlockMotion by_oracle(const RockingCase& c, const RockingEvent& e, double step = 1e-4) {
    const GroundSteps& record = c.records[e.record];
    oracle::Block body = c.bodies[e.body];
    body.friction *= e.grip;
    oracle::BlockOracle block(body, g);
    return block.run([&](double t) { return record.at(t, e.along, e.across, e.up); },
                     record.duration_s() + 20, step);
}

oracle::Block slab(double b, double h, double friction = 10) {
    return {b, b, h, std::sqrt((b * b + h * h) / 3), friction};
}

class RockingKernel : public EachBackend {
  protected:
    // Least of the scales, by their factor, at which a body overturns.
    double least_scale(const RockingCase& given, double low, double high, double factor) {
        RockingCase c = given;
        c.events.clear();
        for (double s = low; s < high; s *= factor) c.events.push_back({0, 0, s});
        const RockingRun run = run_rocking(*device, c);
        for (std::size_t n = 0; n < c.events.size(); ++n)
            if (run.overturned(n)) return c.events[n].along;
        return INFINITY;
    }
};
TOPPLE_ON_EACH_FORM(RockingKernel);

RockingCase random_case(Random& random, std::size_t bodies, std::size_t records,
                        std::size_t events_each) {
    RockingCase c;
    for (std::size_t n = 0; n < bodies; ++n) {
        const double h = random.uniform(0.1f, 1.0f);
        oracle::Block b = slab(h * random.uniform(0.08f, 0.5f), h, random.uniform(0.15f, 0.9f));
        b.behind = b.ahead * random.uniform(0.5f, 1.0f);
        b.room_ahead = random.uniform(0.02f, 1.0f);
        c.bodies.push_back(b);
    }
    for (std::size_t r = 0; r < records; ++r) {
        c.records.push_back(random_ground(random, 10 + 3 * r, 0.01));
        for (std::size_t n = 0; n < events_each; ++n) {
            const double size = random.uniform(1, 12), turn = random.uniform(0, 6.28f);
            c.events.push_back({random.word() % static_cast<std::uint32_t>(bodies),
                                static_cast<std::uint32_t>(r), size * std::cos(turn),
                                size * std::sin(turn), size * 0.6, random.uniform(0.3f, 1)});
        }
    }
    return c;
}

TEST_P(RockingKernel, GivesTheNativeBackendsBits) {
    const auto native = device::open_native();
    Random random(11);
    for (const std::size_t events : {1u, 63u, 64u, 65u, 509u}) {
        SCOPED_TRACE(events);
        const RockingCase c = random_case(random, 37, 3, events);
        const RockingRun got = run_rocking(*device, c, 7);
        EXPECT_TRUE(same(got.planes, run_rocking(*native, c).planes));
        if (events == 509) {
            int fell = 0;
            for (std::size_t n = 0; n < c.events.size(); ++n) fell += got.overturned(n);
            EXPECT_GT(fell, 100);
            EXPECT_LT(fell, 1200);
        }
    }
}

// Of more steps than lavapipe gives all loops of a work-item together.
TEST_P(RockingKernel, FollowsRecordsOfManySteps) {
    RockingCase c;
    Random random(17);
    c.bodies = {slab(0.2, 0.5, 0.6)};
    c.records = {random_ground(random, 2200, 0.01)};
    for (int n = 0; n < 64; ++n) c.events.push_back({0, 0, 0.5 + 0.1 * n});
    const RockingRun got = run_rocking(*device, c);
    EXPECT_TRUE(same(got.planes, run_rocking(*device::open_native(), c, 10'000).planes));
}

// Single pulses, which leave no time for small differences to grow: each figure within 2 %, and a
// hundredth of the turn to balance or half a millimetre; where a body overturns in one and not in
// the other, it has to come within 2 % of it in force. Some rock, some slide, and some do both.
TEST_P(RockingKernel, MatchesTheOracleOnPulses) {
    Random random(5);
    RockingCase c;
    for (int n = 0; n < 40; ++n) {
        const double h = random.uniform(0.15f, 1.0f);
        oracle::Block b = slab(h * random.uniform(0.1f, 0.5f), h, random.uniform(0.15f, 0.5f));
        b.behind = b.ahead * random.uniform(0.6f, 1.0f);
        c.bodies.push_back(b);
    }
    for (int shape = 0; shape < 2; ++shape) {
        for (const double length : {0.25, 0.5, 1.0}) {
            GroundSteps r = ground_of(2.5, 0.005, [&](double t) {
                return t < length ? std::sin((1 + shape) * std::numbers::pi * t / length) : 0.0;
            });
            for (std::size_t n = 0; n < r.means[0].size(); ++n)
                r.means[2][n] = 0.3f * r.means[0][std::min(n + 7, r.means[0].size() - 1)];
            c.records.push_back(std::move(r));
        }
    }
    for (std::uint32_t r = 0; r < c.records.size(); ++r) {
        for (std::uint32_t b = 0; b < c.bodies.size(); ++b)
            c.events.push_back({b, r, random.uniform(2, 9), 0, 1});
    }
    const RockingRun run = run_rocking(*device, c);
    int rocked = 0, slid = 0, both = 0, overturned = 0, other = 0, off = 0;
    double worst = 0;
    for (std::size_t n = 0; n < c.events.size(); ++n) {
        const oracle::BlockMotion m = by_oracle(c, c.events[n]);
        const auto got = run.of(n);
        overturned += m.overturned();
        const bool rocks = m.turned_ahead + m.turned_behind > 0.01,
                   slides = m.slid_ahead + m.slid_behind > 0.01;
        rocked += rocks;
        slid += slides;
        both += rocks && slides && !m.overturned();
        if (run.overturned(n) != m.overturned()) {
            RockingEvent weaker = c.events[n], stronger = weaker;
            weaker.along *= 0.98;
            stronger.along *= 1.02;
            const bool near = by_oracle(c, weaker).overturned() != m.overturned() ||
                              by_oracle(c, stronger).overturned() != m.overturned();
            other += !near;
            continue;
        }
        const double want[] = {m.turned_ahead, m.turned_behind, m.slid_ahead, m.slid_behind};
        const oracle::Block& body = c.bodies[c.events[n].body];
        const double balance = 0.01 * std::atan(body.behind / body.height);
        double largest = 0;
        for (int k = 0; k < 4; ++k) {
            largest = std::max(largest, (std::fabs(got[k] - want[k]) - (k < 2 ? balance : 5e-4)) /
                                            std::max(std::fabs(want[k]), 1e-9));
        }
        // Overturning ends where a step does.
        if (!m.overturned()) worst = std::max(worst, largest);
        off += !m.overturned() && largest > 0.02;
    }
    std::printf(
        "%s: %zu pulses: %d rock, %d slide, %d both, %d overturn; %d overturn elsewhere, "
        "%d off by more than 2 %%, worst %.4f\n",
        GetParam(), c.events.size(), rocked, slid, both, overturned, other, off, worst);
    EXPECT_GE(both, 12);
    EXPECT_GE(overturned, 20);
    EXPECT_EQ(other, 0);
    // Where a swing begins or ends within a few steps, or near balance, small differences grow.
    EXPECT_LE(off, static_cast<int>(c.events.size() / 20));
}

// Many impacts make the motion sensitive, in nature too: single ends may differ, not their share.
TEST_P(RockingKernel, FallsAsOftenAsTheOracleOnLongShaking) {
    Random random(8);
    RockingCase c = random_case(random, 60, 4, 75);
    for (auto& b : c.bodies) b.room_ahead = 1e30;
    const RockingRun run = run_rocking(*device, c);
    int falls = 0, falls_there = 0, alike = 0;
    for (std::size_t n = 0; n < c.events.size(); ++n) {
        const bool there = by_oracle(c, c.events[n], 2e-4).overturned();
        falls += run.overturned(n);
        falls_there += there;
        alike += run.overturned(n) == there;
    }
    std::printf("%s: %d of %zu overturn, %d with the oracle, %d alike\n", GetParam(), falls,
                c.events.size(), falls_there, alike);
    EXPECT_GE(falls, 60);
    EXPECT_LE(falls, 240);
    EXPECT_LE(std::abs(falls - falls_there), 6);  // 2 %
    EXPECT_GE(alike, 288);                        // 96 %
}

// West: it begins to rock at |a| = g b / h, and to slide at mu g where that is less.
TEST_P(RockingKernel, BeginsWhereWestAndCoulombSay) {
    RockingCase c;
    c.bodies = {slab(0.05, 0.25, 0.5), slab(0.2, 0.25, 0.5)};
    c.records = {ground_of(0.3, 0.01, [](double) { return 1.0; })};
    const double west = g * 0.2, coulomb = g * 0.5;
    c.events = {{0, 0, 0.999 * west},     {0, 0, 1.001 * west},    {0, 0, -0.999 * west},
                {0, 0, -1.001 * west},    {1, 0, 0.999 * coulomb}, {1, 0, 1.001 * coulomb},
                {1, 0, -0.999 * coulomb}, {1, 0, -1.001 * coulomb}};
    const RockingRun run = run_rocking(*device, c);
    for (std::size_t n = 0; n < c.events.size(); ++n) {
        const auto [ahead, behind, slid, back] = run.of(n);
        const bool moves = n % 2 == 1, forward = n / 2 % 2 == 0, slides = n >= 4;
        EXPECT_EQ(ahead > 0, moves && forward && !slides) << n;
        EXPECT_EQ(behind > 0, moves && !forward && !slides) << n;
        EXPECT_EQ(slid > 0, moves && forward && slides) << n;
        EXPECT_EQ(back > 0, moves && !forward && slides) << n;
    }
    // What weighs less rocks earlier.
    c.records[0].means[2].assign(c.records[0].means[2].size(), -1.0f);
    c.events = {{0, 0, 0.81 * west, 0, 0.2 * g}, {0, 0, 0.79 * west, 0, 0.2 * g}};
    const RockingRun light = run_rocking(*device, c);
    EXPECT_GT(light.of(0)[0], 0);
    EXPECT_EQ(light.of(1)[0], 0);
}

// p t = ln(eta / (eta - 1)) of slender blocks (Housner 1963).
TEST_P(RockingKernel, OverturnsAtHousnersPulse) {
    const double alpha = 0.05, h = 1.0, b = h * std::tan(alpha);
    const double p = std::sqrt(3 * g / (4 * std::hypot(b, h)));
    double worst = 0;
    for (const double pt : {0.3, 0.6, 1.2, 2.0}) {
        // Whole steps, so that the pulse has its length.
        const double step = pt / p / 200;
        RockingCase c;
        c.bodies = {slab(b, h)};
        c.records = {ground_of(3 * pt / p, step, [&](double t) { return t < pt / p ? 1.0 : 0.0; })};
        const double eta = std::exp(pt) / (std::exp(pt) - 1);
        const double found =
            least_scale(c, 0.9 * eta * g * b / h, 1.1 * eta * g * b / h, 1.001) / (g * b / h);
        worst = std::max(worst, std::fabs(found / eta - 1));
    }
    std::printf("%s: rectangular pulses: off by %.4f at most\n", GetParam(), worst);
    EXPECT_LE(worst, 0.02);
}

// Half and full sines, against the linear equation of slender blocks, q'' = p^2 (a / g + q - alpha)
// on one side, by its own closed form of each piece being integrated in small steps.
TEST_P(RockingKernel, OverturnsAtSinePulses) {
    const double alpha = 0.04, h = 1.0, b = h * std::tan(alpha);
    const double p = std::sqrt(3 * g / (4 * std::hypot(b, h)));
    const double r = 1 - 1.5 * std::sin(alpha) * std::sin(alpha);
    double worst = 0;
    for (const bool full : {false, true}) {
        for (const double length : {0.3, 0.6, 1.2}) {  // of p t
            const auto pulse = [&](double t) {
                const double share = p * t / length;
                return share < 1 ? std::sin((full ? 2 : 1) * std::numbers::pi * share) : 0.0;
            };
            // Linear, either side, with Housner's impacts.
            const auto falls = [&](double scale) {
                double q = 0, w = 0;
                const double dt = 1e-4;
                for (double t = 0; t < 12 / p; t += dt) {
                    const double a = scale * pulse(t + dt / 2) / g;
                    if (q == 0 && w == 0 && std::fabs(a) <= alpha) continue;
                    const double side = q != 0 ? std::copysign(1.0, q) : std::copysign(1.0, a);
                    w += p * p * (a + q - side * alpha) * dt;
                    const double next = q + w * dt;
                    if (next * q < 0) w *= r;
                    q = next;
                    if (std::fabs(q) > 10 * alpha) return true;
                }
                return false;
            };
            double want = g * alpha;
            while (!falls(want)) want *= 1.002;
            RockingCase c;
            c.bodies = {slab(b, h)};
            c.records = {ground_of(2 * length / p, 0.005, pulse)};
            const double found = least_scale(c, g * alpha, 100 * g * alpha, 1.002);
            worst = std::max(worst, std::fabs(found / want - 1));
        }
    }
    std::printf("%s: sine pulses: off by %.4f at most\n", GetParam(), worst);
    EXPECT_LE(worst, 0.02);
}

// A rectangular pulse of acceleration a for t: s = (a - mu g) a t^2 / (2 mu g).
TEST_P(RockingKernel, SlidesAsNewmarkSays) {
    RockingCase c;
    c.bodies = {slab(1, 0.2, 0.3)};
    c.records = {ground_of(2, 0.01, [](double t) { return t < 0.3 ? 1.0 : 0.0; })};
    for (const double a : {3.1, 4.0, 6.0, 12.0, -5.0}) c.events.push_back({0, 0, a});
    const RockingRun run = run_rocking(*device, c);
    double worst = 0;
    for (std::size_t n = 0; n < c.events.size(); ++n) {
        const double a = std::fabs(c.events[n].along);
        const double s = (a - 0.3 * g) * a * 0.3 * 0.3 / (2 * 0.3 * g);
        const bool ahead = c.events[n].along > 0;
        worst = std::max(worst, std::fabs(run.of(n)[ahead ? 2 : 3] / s - 1));
        EXPECT_EQ(run.of(n)[ahead ? 3 : 2], 0);
        EXPECT_EQ(run.of(n)[0] + run.of(n)[1], 0);
    }
    std::printf("%s: sliding: off by %.4f at most\n", GetParam(), worst);
    EXPECT_LE(worst, 0.02);
    // Where the support ends, it ends.
    c.bodies[0].room_ahead = 0.9 * run.of(2)[2];
    const RockingRun cut = run_rocking(*device, c);
    EXPECT_GE(cut.of(2)[2], c.bodies[0].room_ahead);
    EXPECT_LT(cut.of(2)[2], run.of(2)[2]);
    EXPECT_EQ(cut.of(1)[2], run.of(1)[2]);
}

// After a pulse it swings freely: each swing goes as high as what the impact has left of the
// energy, r^2, lets it. One body's edges see the first swings of each side.
TEST_P(RockingKernel, LosesHousnersShareAtImpacts) {
    const double h = 0.5, b = 0.12, radius = std::hypot(b, h), alpha = std::atan(b / h);
    RockingCase c;
    c.bodies = {slab(b, h)};
    c.records = {ground_of(4, 0.0025, [](double t) { return t < 0.1 ? 1.0 : 0.0; })};
    c.events = {{0, 0, 1.6 * g * b / h}, {0, 0, 2.0 * g * b / h}};
    const RockingRun run = run_rocking(*device, c);
    const double kept = 1 - 1.5 * std::sin(alpha) * std::sin(alpha);
    for (std::size_t n = 0; n < c.events.size(); ++n) {
        const auto [first, second, slid, back] = run.of(n);
        const auto rise = [&](double q) { return radius * std::cos(alpha - q) - h; };
        ASSERT_GT(second, 0.01);
        ASSERT_LT(first, alpha);
        EXPECT_NEAR(rise(second) / rise(first), kept * kept, 0.02 * kept * kept);
    }
}

// A slender block that is let go at q0 is down again after acosh(1 / (1 - q0 / alpha)) / p (Housner
// 1963): so the oracle is right about time, too.
TEST(RockingOracle, SwingsInHousnersPeriod) {
    const double alpha = 0.05, h = 1.0, b = h * std::tan(alpha);
    const double p = std::sqrt(3 * g / (4 * std::hypot(b, h)));
    for (const double share : {0.2, 0.5, 0.8}) {
        oracle::BlockOracle block(slab(b, h), g);
        block.lean(share * alpha);
        double t = 0;
        while (block.phi() > 0) {
            block.run([](double) { return std::array<double, 2>{0, 0}; }, 1e-4, 1e-4);
            t += 1e-4;
        }
        EXPECT_NEAR(p * t, std::acosh(1 / (1 - share)), 0.01) << share;
    }
}

}  // namespace
}  // namespace topple::test
