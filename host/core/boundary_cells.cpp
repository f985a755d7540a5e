// SPDX-License-Identifier: MIT
#include "core/boundary_cells.h"

#include <algorithm>
#include <ranges>
#include <tuple>

namespace topple {

bool SurfacePatch::flat() const {
    return std::all_of(c.begin() + 4, c.end(), [](double v) { return v == 0; });
}

bool BoundaryCells::solid(std::size_t n, const Vec3& p, double slack_m) const {
    const bool any = any_group(n);
    if (slots_used(n) == 0) return !any;
    bool own = false, all = true, one = false, group_all = true, group_one = false;
    for (std::size_t s = 0; s < slots_used(n); ++s) {
        const SlotUse u = use(n, s);
        double d = patches[slot[s][n]].distance(p);
        if (u.outside) d = -d;
        const bool in = d <= slack_m;
        if (u.bounds) {
            if (!in) return false;
            continue;
        }
        own = true;
        group_all = group_all && in;
        group_one = group_one || in;
        if (!u.last) continue;
        all = all && group_one;
        one = one || group_all;
        group_all = true;
        group_one = false;
    }
    return !own || (any ? one : all);
}

std::size_t BoundaryCells::first_from(std::int32_t vi, std::int32_t vj, std::int32_t vk,
                                      std::int32_t p) const {
    const std::tuple<std::int32_t, std::int32_t, std::int32_t, std::int32_t> wanted{vi, vj, vk, p};
    const auto all = std::views::iota(std::size_t{0}, size());
    const auto found = std::ranges::partition_point(
        all, [&](std::size_t n) { return std::tie(i[n], j[n], k[n], primitive[n]) < wanted; });
    return static_cast<std::size_t>(found - all.begin());
}

std::size_t BoundaryCells::find(std::int32_t vi, std::int32_t vj, std::int32_t vk,
                                std::int32_t p) const {
    const std::size_t n = first_from(vi, vj, vk, p);
    if (n == size() || std::tie(i[n], j[n], k[n], primitive[n]) != std::tie(vi, vj, vk, p))
        return absent;
    return n;
}

bool BoundaryCells::fits(std::size_t primitives) const {
    // Of patches: what follows from such numbers is finite.
    constexpr double most = 1e12;
    bool right = true;
    each_array([&](const auto& array) { right = right && array.size() == size(); }, *this);
    const auto is_primitive = [&](std::int32_t p) {
        return p >= 0 && static_cast<std::size_t>(p) < primitives;
    };
    const auto place = [&](std::size_t n) { return std::tie(i[n], j[n], k[n], primitive[n]); };
    for (std::size_t n = 0; right && n < size(); ++n) {
        right = is_primitive(primitive[n]) && share[n] <= whole && slots_used(n) <= slots &&
                (n == 0 || place(n - 1) < place(n));
        for (std::size_t s = 0; right && s < slots_used(n); ++s)
            right = slot[s][n] < patches.size();
    }
    for (const SurfacePatch& patch : patches) {
        double sum = std::abs(patch.noise_m) + std::abs(patch.offset_m);
        for (const double x : patch.c) sum += std::abs(x);
        for (const double x : patch.origin) sum += std::abs(x);
        right = right && sum < most && (patch.primitive == -1 || is_primitive(patch.primitive));
    }
    return right;
}

BoundaryCells BoundaryCells::only(const std::vector<bool>& kept) const {
    BoundaryCells out;
    out.patches = patches;
    each_array(
        [&](const auto& from, auto& to) {
            for (std::size_t n = 0; n < from.size(); ++n)
                if (kept[n]) to.push_back(from[n]);
        },
        *this, out);
    return out;
}

std::uint32_t make_form(bool any_group, const std::array<SlotUse, BoundaryCells::slots>& uses,
                        std::size_t used) {
    auto form = static_cast<std::uint32_t>(used) | (any_group ? 8U : 0U);
    for (std::size_t s = 0; s < used; ++s) {
        const std::uint32_t bits =
            (uses[s].outside ? 1U : 0U) | (uses[s].last ? 2U : 0U) | (uses[s].bounds ? 4U : 0U);
        form |= bits << (4 + 3 * s);
    }
    return form;
}

}  // namespace topple
