// SPDX-License-Identifier: MIT
#include "rocking.hpp"

#include <cmath>
#include <memory>

#include "lab/random.h"
#include "perf/cases/cases.h"

namespace topple::perf {
namespace {

// Blocks of 100 kinds at ten scales, under records of 10 s that never calm down: nothing is
// skipped, since of 64 events side by side some always move.
struct ShakenBlocks {
    static constexpr std::uint32_t kinds = 100, records = 8, chunks = 32, each = 4096;
    static constexpr std::uint32_t events = records * each, steps = 32 * chunks;
    std::vector<float> body, scale, step, shaking, strongest;
    std::vector<std::uint32_t> event_body, block_record, first{0};

    ShakenBlocks() {
        scenes::Random random(21);
        body.resize(7 * kinds);
        for (std::uint32_t n = 0; n < kinds; ++n) {
            const double h = random(0.2, 1.0), b = h * random(0.1, 0.4);
            const double values[] = {b,    b,   h, std::sqrt((b * b + h * h) / 3), random(0.3, 0.7),
                                     1e30, 1e30};
            for (std::uint32_t p = 0; p < 7; ++p)
                body[n + p * kinds] = static_cast<float>(values[p]);
        }
        for (std::uint32_t e = 0; e < events; ++e) event_body.push_back(e % kinds);
        for (std::uint32_t b = 0; b < events / 64; ++b) block_record.push_back(b * 64 / each);
        for (std::uint32_t plane = 0; plane < 3; ++plane) {
            for (std::uint32_t e = 0; e < events; ++e)
                scale.push_back(
                    static_cast<float>((plane == 2 ? 0.3 : 1) * std::pow(1.2, e / kinds % 10)));
        }
        scale.resize(4 * events, 1.0f);  // all of the friction
        for (std::uint32_t r = 0; r < records; ++r) {
            step.push_back(0.01f);
            first.push_back(first.back() + chunks);
        }
        shaking.resize(3 * records * steps);
        for (float& a : shaking) a = static_cast<float>(random(-6, 6));
        for (std::uint32_t c = 0; c < 3 * records * chunks; ++c)
            strongest.push_back(c < 2 * records * chunks ? 6.0f : -6.0f);
    }
};

}  // namespace

Prepared rocking(device::Device& device) {
    const ShakenBlocks on_host;
    struct Buffers {
        device::Buffer<float> body, scale, step, shaking, strongest;
        device::Buffer<std::uint32_t> event_body, block_record, first;
        device::Buffer<float> outcome;
    };
    auto on =
        std::make_shared<Buffers>(Buffers{upload(device, on_host.body, "body"),
                                          upload(device, on_host.scale, "scale"),
                                          upload(device, on_host.step, "step"),
                                          upload(device, on_host.shaking, "shaking"),
                                          upload(device, on_host.strongest, "strongest"),
                                          upload(device, on_host.event_body, "event_body"),
                                          upload(device, on_host.block_record, "block_record"),
                                          upload(device, on_host.first, "first"),
                                          {device, 10 * ShakenBlocks::events, "outcome"}});
    const double steps = double{ShakenBlocks::events} * ShakenBlocks::steps;
    // 185 operations a step: 17 of them the sine and the cosine, one a division.
    return {{steps, "steps",
             4.0 * (14.0 * ShakenBlocks::events + static_cast<double>(on_host.shaking.size())),
             185 * steps, steps},
            [on](device::Queue& queue) {
                queue.add<kernels::Rocking>(
                    ShakenBlocks::events,
                    {.body = on->body,
                     .event_body = on->event_body,
                     .event_scale = on->scale,
                     .block_record = on->block_record,
                     .record_first = on->first,
                     .record_step = on->step,
                     .shaking = on->shaking,
                     .strongest = on->strongest,
                     .outcome = on->outcome},
                    {.event_count = ShakenBlocks::events,
                     .body_count = ShakenBlocks::kinds,
                     .chunk_count = ShakenBlocks::records * ShakenBlocks::chunks,
                     .gravity = 9.80665f,
                     .longest_s = 0,
                     .chunk_first = 0,
                     .chunk_last = ShakenBlocks::chunks + 1});
            },
            {},
            [on] { return Hash().add(on->outcome.download()).value(); }};
}

}  // namespace topple::perf
