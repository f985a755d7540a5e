// SPDX-License-Identifier: MIT
#include "lab/scan/sensor.h"

#include <algorithm>
#include <cmath>

#include "core/vectors.h"
#include "lab/scan/smooth.h"

namespace topple::scenes {
namespace {

// From -1 to 1, constant in cells of some centimetres: patterns and wear.
double mottle(const Vec3& p) {
    std::uint64_t h = 0;
    for (const double a : p)
        h = scatter(h +
                    static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(a / 0.04))));
    return static_cast<double>(h >> 11) * 0x1p-52 - 1;
}

}  // namespace

Colour Light::shade(const Part& part, const Vec3& normal, const Vec3& at, Random& random) const {
    const double facing = std::max(0.0, dot(normal, direction));
    const double factor = exposure * (ambient + (1 - ambient) * facing) * (1 + 0.05 * mottle(at));
    Colour out{};
    for (std::size_t a = 0; a < 3; ++a) {
        const double value = factor * part.colour[a] + grain * random.normal();
        out[a] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
    }
    return out;
}

ExactView look(const RayCaster& caster, const Intrinsics& k, const Mat4& camera_to_room,
               const Light& light, Random random) {
    const std::size_t pixels = std::size_t{k.width} * k.height;
    ExactView view{std::vector<float>(pixels), std::vector<float>(pixels),
                   std::vector<std::int32_t>(pixels, -1), std::vector<Colour>(pixels)};
    const Mat4& m = camera_to_room;
    const Vec3 eye{m[3], m[7], m[11]};
    for (std::size_t at = 0; at < pixels; ++at) {
        const double x = (static_cast<double>(at % k.width) - k.cx) / k.fx;
        const double y = (static_cast<double>(at / k.width) - k.cy) / k.fy;
        const double length = std::hypot(x, y, 1.0);
        Vec3 d{};
        for (std::size_t a = 0; a < 3; ++a)
            d[a] = (m[4 * a] * x + m[4 * a + 1] * y + m[4 * a + 2]) / length;
        const auto hit = caster.cast(eye, d);
        if (hit.part < 0) continue;
        const Vec3 p = along(eye, hit.distance, d);
        const Part& part = caster.parts()[hit.part];
        const Vec3 normal = part.normal(p);
        view.depth[at] = static_cast<float>(hit.distance / length);
        view.cosine[at] = static_cast<float>(std::abs(dot(normal, d)));
        view.part[at] = hit.part;
        view.colour[at] = light.shade(part, normal, p, random);
    }
    return view;
}

Sensor any_sensor(const Intrinsics& k, Random& random) {
    Sensor s;
    const double quality = random(0.5, 1.5);
    s.most_m = random(3.8, 6.0);
    s.axial_m *= quality;
    s.growth *= quality;
    s.step = random.chance(0.75) ? random(0.0007, 0.002) : 0;
    s.ragged_px = random(0.4, 2.0);
    s.lost_edges = random(0.4, 0.9);
    s.flying = random.chance(0.4) ? random(0.1, 0.5) : 0;
    s.grazing = random(0.15, 0.32);
    s.blobs = random(1.8, 2.8);
    s.specks = random(0.002, 0.02);
    if (random.chance(0.6)) {
        const double size = random(0.0005, 0.003);
        s.bend = smooth_noise_image(k.width, k.height, 0.12 * k.width, size, random);
    }
    return s;
}

std::vector<float> rough_depth(const ExactView& view, const Intrinsics& k, const Sensor& sensor,
                               Random random) {
    const std::size_t w = k.width, h = k.height;
    const auto jitter_u = smooth_noise_image(w, h, 1, 0.35 * sensor.ragged_px, random);
    const auto jitter_v = smooth_noise_image(w, h, 1, 0.35 * sensor.ragged_px, random);
    const auto noise = smooth_noise_image(w, h, 0.7, 1, random);
    const auto blobs = smooth_noise_image(w, h, 6, 1, random);
    std::vector<float> depth(w * h, 0);
    const auto near = [](std::size_t at, float by, std::size_t size) {
        const double moved = static_cast<double>(at) + std::round(by);
        return static_cast<std::size_t>(std::clamp(moved, 0.0, static_cast<double>(size - 1)));
    };
    const auto far_apart = [&](std::size_t a, std::size_t b) {
        const float za = view.depth[a] > 0 ? view.depth[a] : 20,
                    zb = view.depth[b] > 0 ? view.depth[b] : 20;
        return std::abs(za - zb) > 0.12 * std::max(0.5f, za);
    };
    for (std::size_t v = 0; v < h; ++v) {
        for (std::size_t u = 0; u < w; ++u) {
            const std::size_t at = v * w + u;
            const std::size_t from = near(v, jitter_v[at], h) * w + near(u, jitter_u[at], w);
            const double drawn_edge = random.uniform(), drawn_fly = random.uniform(),
                         drawn_speck = random.uniform(), drawn_graze = random.uniform(),
                         share = random.uniform();
            const double exact = view.depth[at];
            double z = view.depth[from];
            if (!(exact > sensor.least_m && exact < sensor.most_m) || !(z > 0.35)) continue;
            const std::size_t left = at - (u > 0 ? 1 : 0), right = at + (u + 1 < w ? 1 : 0),
                              above = at - (v > 0 ? w : 0), below = at + (v + 1 < h ? w : 0);
            if (far_apart(left, right) || far_apart(above, below)) {
                if (drawn_edge < sensor.lost_edges) continue;
                const double other = std::max(
                    {view.depth[left], view.depth[right], view.depth[above], view.depth[below]});
                if (drawn_fly < sensor.flying && other < sensor.most_m) z += share * (other - z);
            }
            const double beyond = std::max(0.0, z - 0.4);
            z += noise[at] * (sensor.axial_m + sensor.growth * beyond * beyond);
            if (!sensor.bend.empty()) z += sensor.bend[at] * z * z;
            if (sensor.step > 0) z = 1 / (std::round(1 / z / sensor.step) * sensor.step);
            if (drawn_graze < (sensor.grazing - view.cosine[from]) / (0.8 * sensor.grazing))
                continue;
            if (blobs[at] > sensor.blobs || drawn_speck < sensor.specks) continue;
            depth[at] = static_cast<float>(z);
        }
    }
    return depth;
}

}  // namespace topple::scenes
