// SPDX-License-Identifier: MIT
#include "graph/group_stances.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "group_stance.hpp"
#include "topple/kernels/queue.h"

namespace topple::graph {
namespace {

constexpr std::uint32_t directions = 64;

// Room for at least so many, and for more the next time.
template <class T>
void fit(device::Device& device, std::size_t count, const char* name, device::Buffer<T>& buffer) {
    if (buffer.size() < std::max<std::size_t>(count, 1))
        buffer = device::Buffer<T>(device, 2 * std::max<std::size_t>(count, 1), name);
}

}  // namespace

double standing_cost(const Stance& stance, double noise_m, double level) {
    constexpr double unseen_support = 0.05;  // share of what stands whose support no scan shows
    if (stance.mass_kg <= 0) return 0;
    // sqrt(h^2 + m^2) - h = level h.
    const double needed_m = std::max(0.0, stance.height_m) * std::sqrt(level * (2 + level));
    const double stands =
        0.5 * std::erfc((needed_m - stance.margin_m) / (noise_m * std::numbers::sqrt2));
    return -std::log(std::max(stands, unseen_support));
}

GroupStances::GroupStances(device::Device& device, const ContactGraph& contacts,
                           TableView<PrimitiveId, physics::MassProperties> bodies,
                           const Table<PrimitiveId, bool>& shell)
    : device_(device),
      contacts_(contacts),
      bodies_(bodies),
      shell_(shell),
      members_(bodies.size()) {
    std::vector<float> x, y, reach;
    for (std::uint32_t d = 0; d < directions; ++d) {
        const double angle = 2 * std::numbers::pi * d / directions;
        x.push_back(static_cast<float>(std::cos(angle)));
        y.push_back(static_cast<float>(std::sin(angle)));
    }
    if (!contacts.carryings.empty() && !contacts.carryings.front().outline.empty())
        std::ranges::copy(contacts.carryings.front().outline.front(), origin_);
    const auto add = [&](const auto& outline) {
        for (std::uint32_t d = 0; d < directions; ++d) {
            float most = -3e38F;
            for (const auto& p : outline)
                most = std::max(most, static_cast<float>((p[0] - origin_[0]) * x[d] +
                                                         (p[1] - origin_[1]) * y[d]));
            reach.push_back(most + 0.0F);  // no negative zero, of which a maximum may be either
        }
    };
    for (const Carrying& c : contacts.carryings) add(c.outline);
    for (const Leaning& l : contacts.leanings) add(l.outline);
    reach.resize(std::max<std::size_t>(reach.size(), directions));
    reach_ = device::Buffer<float>(device, reach, "reach of footings");
    ux_ = device::Buffer<float>(device, x, "directions x");
    uy_ = device::Buffer<float>(device, y, "directions y");
}

Stance GroupStances::add(const GroupQuery& group, Batch& batch) {
    Stance out;
    double center[3] = {};
    members_.clear();
    for (const std::int32_t n : group.nodes) {
        members_.add(n);
        const physics::MassProperties& body = bodies_[n];
        out.mass_kg += body.mass_kg;
        for (std::size_t a = 0; a < 3; ++a) center[a] += body.mass_kg * body.center[a];
    }
    if (out.mass_kg > 0)
        for (double& c : center) c /= out.mass_kg;
    double lowest_m = std::numeric_limits<double>::infinity();
    for (const std::int32_t n : group.nodes) {
        for (const Carrying& c : contacts_.carriers_of(n)) {
            if (c.supporter >= 0 && members_.has(c.supporter)) continue;
            batch.footing.push_back(static_cast<std::uint32_t>(&c - contacts_.carryings.data()));
            lowest_m = std::min(lowest_m, c.height_m);
        }
    }
    const bool carried = batch.footing.size() > batch.first.back();
    out.height_m = carried ? center[2] - lowest_m : center[2];
    for (const std::int32_t n : group.nodes) {
        if (!carried) break;
        for (const Leaning& l : contacts_.leanings_of(n)) {
            if (!shell_[l.against] || l.height_m < center[2] || members_.has(l.against)) continue;
            batch.footing.push_back(static_cast<std::uint32_t>(
                contacts_.carryings.size() +
                static_cast<std::size_t>(&l - contacts_.leanings.data())));
        }
    }
    batch.first.push_back(static_cast<std::uint32_t>(batch.footing.size()));
    batch.x.push_back(static_cast<float>(center[0] - origin_[0]));
    batch.y.push_back(static_cast<float>(center[1] - origin_[1]));
    return out;
}

std::vector<float> GroupStances::margins(const Batch& batch) {
    const std::size_t count = batch.x.size();
    fit(device_, batch.first.size(), "first footings", first_);
    fit(device_, batch.footing.size(), "footings", footing_);
    fit(device_, count, "centres x", x_);
    fit(device_, count, "centres y", y_);
    fit(device_, count, "margins", margin_);
    first_.upload(batch.first);
    footing_.upload(batch.footing);
    x_.upload(batch.x);
    y_.upload(batch.y);
    device::Queue queue(device_);
    queue.add<kernels::GroupStance>(
        count,
        {.reach = reach_,
         .ux = ux_,
         .uy = uy_,
         .first = first_,
         .footing = footing_,
         .cx = x_,
         .cy = y_,
         .margin = margin_},
        {.groups = static_cast<std::uint32_t>(count), .directions = directions});
    queue.run();
    std::vector<float> out(count);
    margin_.download(std::span(out));
    return out;
}

std::vector<Stance> GroupStances::of(std::span<const GroupQuery> groups) {
    std::vector<Stance> out;
    Batch batch;
    for (const GroupQuery& group : groups) out.push_back(add(group, batch));
    const std::vector<float> margin = margins(batch);
    for (std::size_t n = 0; n < out.size(); ++n)
        if (batch.first[n] < batch.first[n + 1]) out[n].margin_m = margin[n];
    return out;
}

}  // namespace topple::graph
