// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "api/arrays.h"
#include "core/room_measures.h"
#include "io/text.h"
#include "physics/assess.h"
#include "physics/tipping.h"
#include "support_function.hpp"
#include "topple/kernels/queue.h"

namespace topple::stages {
namespace {

constexpr std::uint64_t direction_block = 32;  // what one work-item takes, on any backend
// Of the output at once, where it goes to host memory: half of the smallest binding.
constexpr std::uint64_t tile_values = (std::uint64_t{64} << 20) / sizeof(float);
constexpr const char* support_stage = "support_functions";
constexpr double largest_resolution_m = 1;  // as of voxels
// Means over the box around a body, kg/m^3: no matter has more; and a rod of wood that leans, in
// its own box, has ten times the least. What is beyond is in other units than metres and kilograms.
constexpr double most_kg_m3 = 30000, least_kg_m3 = 0.01;

void check(const Coordinates& vertices, std::span<const std::uint64_t> first,
           const Coordinates& directions, const Array<float>& out) {
    const auto equal = [](const Coordinates& c) {
        return c.x.count == c.y.count && c.x.count == c.z.count;
    };
    require(equal(vertices) && equal(directions), support_stage, "x, y and z differ in length");
    require(directions.x.count > 0, support_stage, "there are no directions");
    require(
        !first.empty() && first.front() == 0 && first.back() == vertices.x.count &&
            std::adjacent_find(first.begin(), first.end(), std::greater_equal<>()) == first.end(),
        support_stage,
        "first must rise from 0 to the " + std::to_string(vertices.x.count) +
            " vertices, with no set empty");
    const std::uint64_t sets = first.size() - 1;
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    require(vertices.x.count <= most && directions.x.count <= most / 2 &&
                sets <= most / (directions.x.count + direction_block),
            support_stage, "more than 2^32 vertices or values of output");
    require(out.count == sets * directions.x.count, support_stage,
            "out has " + std::to_string(out.count) + " values, not " +
                std::to_string(sets * directions.x.count));
    const bool on_device = directions.x.on_device() || directions.y.on_device() ||
                           directions.z.on_device() || out.on_device();
    require(!on_device || directions.x.count % direction_block == 0, support_stage,
            std::to_string(directions.x.count) +
                " directions: a multiple of 32 is needed in a device's buffer");
}

// To whole blocks; the rest repeats the first direction.
std::vector<float> padded(const Array<const float>& axis, std::uint64_t count) {
    std::vector<float> out(axis.host.begin(), axis.host.end());
    out.resize(axis.on_device() ? 0 : count, out.empty() ? 0 : out[0]);
    return out;
}

// A centre of mass lies within its body, or of one that was seen from one side beside its points;
// so many times as far off as they extend it is in another unit.
constexpr double farthest_off = 5;

// Throws Error(input) for what is in other units than metres and kilograms.
void check_units(const std::string& name, const StandingBody& body, double resolution_m) {
    Vec3 size{};
    double volume_m3 = 1, off = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto along = [&](const Vec3& p) { return p[a]; };
        const auto [low, high] = std::ranges::minmax(body.points, {}, along);
        const double at = body.center_of_mass_m[a];
        size[a] = high[a] - low[a];
        volume_m3 *= size[a] + resolution_m;
        off = std::max({off, low[a] - at, at - high[a]});
    }
    const double kg_m3 = body.mass_kg / volume_m3;
    // Of what is flat no more than that is known.
    if (volume_m3 != 0 && !(kg_m3 <= most_kg_m3 && kg_m3 >= least_kg_m3))
        throw Error(ErrorKind::input,
                    "barriers: " + name + " of " + io::short_number(body.mass_kg) +
                        " kg would be " + io::short_number(size[0]) + " x " +
                        io::short_number(size[1]) + " x " + io::short_number(size[2]) +
                        " m large, " + io::two_digits(kg_m3) +
                        " kg/m^3: points must be in metres, and its mass in kilograms");
    const double longest = std::ranges::max(size);
    if (!(off <= farthest_off * (longest + resolution_m)))
        throw Error(ErrorKind::input,
                    "barriers: the centre of mass of " + name + " lies " + io::short_number(off) +
                        " m off its points, which extend over " + io::short_number(longest) +
                        " m: it must be in metres, in their frame; if it is in mm, multiply it "
                        "by 0.001");
}

}  // namespace

void support_functions(device::Device& device, const Coordinates& vertices,
                       std::span<const std::uint64_t> first, const Coordinates& directions,
                       const Array<float>& out) {
    const device::InUse in_use(device);
    check(vertices, first, directions, out);
    const std::uint64_t sets = first.size() - 1, count = directions.x.count;
    const std::uint64_t row = (count + direction_block - 1) / direction_block * direction_block;
    if (sets == 0) return;
    const std::vector<float> dx = padded(directions.x, row), dy = padded(directions.y, row),
                             dz = padded(directions.z, row);
    const auto axis = [](const Array<const float>& given, const std::vector<float>& wide) {
        return given.on_device() ? given : Array<const float>(wide);
    };
    const Bound<const float> vx(device, vertices.x, vertices.x.count, "vertices x"),
        vy(device, vertices.y, vertices.y.count, "vertices y"),
        vz(device, vertices.z, vertices.z.count, "vertices z"),
        ax(device, axis(directions.x, dx), row, "directions x"),
        ay(device, axis(directions.y, dy), row, "directions y"),
        az(device, axis(directions.z, dz), row, "directions z");
    const std::uint64_t at_once =
        out.on_device() ? sets : std::min(sets, std::max<std::uint64_t>(1, tile_values / row));
    const Bound<float> s(device, out, at_once * row, "support functions");
    for (std::uint64_t from = 0; from < sets; from += at_once) {
        device::Queue queue(device);
        const std::uint64_t to = std::min(sets, from + at_once);
        for (std::uint64_t n = from; n < to; ++n) {
            queue.add<kernels::SupportFunction>(
                row,
                {.vx = vx.slice(),
                 .vy = vy.slice(),
                 .vz = vz.slice(),
                 .dx = ax.slice(),
                 .dy = ay.slice(),
                 .dz = az.slice(),
                 .s = s.slice()},
                {.vertex_count = static_cast<std::uint32_t>(first[n + 1] - first[n]),
                 .vertex_first = static_cast<std::uint32_t>(first[n]),
                 .direction_count = static_cast<std::uint32_t>(row),
                 .output_first = static_cast<std::uint32_t>((n - from) * row)});
        }
        queue.run();
        for (std::uint64_t n = from; !out.on_device() && n < to; ++n)
            s.own().download(out.host.subspan(n * count, count), (n - from) * row);
    }
}

std::vector<Barrier> barriers(device::Device& device, std::span<const StandingBody> bodies,
                              double resolution_m) {
    const device::InUse in_use(device);
    require(resolution_m >= 0 && resolution_m <= largest_resolution_m, "barriers",
            "resolution_m " + io::short_number(resolution_m) + ": expected metres from 0 to " +
                io::short_number(largest_resolution_m));
    physics::PartHulls parts{{}, resolution_m};
    std::vector<physics::Candidate> candidates;
    for (const StandingBody& body : bodies) {
        const std::string name = "body " + std::to_string(candidates.size());
        require(!body.points.empty(), "barriers", name + " has no points");
        bool finite = std::isfinite(body.mass_kg) && body.mass_kg > 0;
        for (const double c : body.center_of_mass_m) finite = finite && std::isfinite(c);
        require(finite, "barriers",
                name + ": its mass must be above 0, and its centre of mass finite");
        for (const Vec3& p : body.points) {
            for (const double c : p) {
                if (!(std::abs(c) <= farthest_m))
                    throw Error(ErrorKind::input,
                                "barriers: " + name + " has a point at " + io::short_number(c) +
                                    ": expected metres up to " + io::short_number(farthest_m));
            }
        }
        check_units(name, body, resolution_m);
        physics::Candidate c;
        c.primitives = {static_cast<std::int32_t>(candidates.size())};
        c.body.mass_kg = body.mass_kg;
        c.body.center = body.center_of_mass_m;
        c.support_height_m = std::numeric_limits<double>::infinity();
        for (const Vec3& p : body.points) c.support_height_m = std::min(c.support_height_m, p[2]);
        std::vector<std::array<double, 2>> bearing;
        for (const Vec3& p : body.points) {
            if (p[2] <= c.support_height_m + resolution_m) bearing.push_back({p[0], p[1]});
        }
        parts.corners.emplace_back(body.points.begin(), body.points.end());
        c.support_polygon = physics::convex_polygon(bearing);
        candidates.push_back(std::move(c));
    }
    std::vector<Barrier> out(bodies.size());
    device.threads().each(bodies.size(), 1, [&](std::size_t n) {
        physics::Stability s =
            physics::assess(physics::standing_hull(parts, candidates[n]), candidates[n]);
        out[n] = {s.barrier_J, s.release_J, s.easiest.direction, std::move(s.curve)};
    });
    return out;
}

}  // namespace topple::stages
