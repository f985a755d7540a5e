// SPDX-License-Identifier: MIT
#include "solids/surfaces.h"

#include <algorithm>
#include <utility>

#include "core/thread_pool.h"
#include "geometry/building.h"
#include "geometry/fragments.h"

namespace topple {
namespace {

// A solid shows at least this many surfels: a patch of six by six.
constexpr std::uint64_t least_surfels = 36;

}  // namespace

FramedSurfels find_surfels(device::Device& device, const Observation& input,
                           const ParseOptions& options, StageClock& stage) {
    FramedSurfels out;
    out.surfels = stage("normals", [&] {
        return geometry::make_surfels(device, input.cloud,
                                      input.surfels.value_or(surfel_cells * input.cell_m),
                                      input.viewpoints, input.viewpoint_of_point);
    });
    out.frame = stage("frame", [&] {
        if (!input.frame)
            return geometry::find_scene_frame(
                device, out.surfels,
                {options.up, input.camera_up, input.sides_guessed, input.format_up});
        geometry::SceneFrame frame = *input.frame;
        if (options.up)
            frame.note = geometry::find_scene_frame(device, out.surfels, {options.up, {}}).note;
        return frame;
    });
    // At once, where it says that the up that was given is wrong.
    if (options.up && options.notice && !out.frame.note.empty()) options.notice(out.frame.note);
    return out;
}

Surfaces find_primitives(device::Device& device, const Observation& input, FramedSurfels surfels,
                         StageClock& stage) {
    Surfaces g;
    g.surfels = std::move(surfels.surfels);
    g.frame = std::move(surfels.frame);
    const geometry::Regions regions =
        stage("splitting", [&] { return geometry::split(g.surfels, device.threads()); });
    g.primitives = stage("merging", [&] {
        const geometry::FreeSpace free(g.surfels, input.cloud, input.viewpoints,
                                       input.viewpoint_of_point, device.threads());
        geometry::PrimitiveSet primitives =
            geometry::merge_convex(g.surfels, regions, g.frame.axes[2], free, device.threads());
        geometry::absorb_fragments(g.surfels, least_surfels, primitives);
        return primitives;
    });
    device.threads().poll();
    const Vec3& up = g.frame.axes[2];
    g.storeys = input.storeys.empty() ? geometry::find_building(g.surfels, g.primitives, up)
                                      : input.storeys;
    g.region_of_point.reserve(input.cloud.size());
    g.primitive_of_point.reserve(input.cloud.size());
    for (const std::uint32_t s : g.surfels.of_point) {
        g.region_of_point.push_back(regions.label[s]);
        g.primitive_of_point.push_back(g.primitives.label[s]);
    }
    stage("shell", [&] {
        g.samples = geometry::sample_surface(input.cloud, g.surfels, g.primitive_of_point, g.frame,
                                             std::max(geometry::finest_sample_m, input.cell_m),
                                             device.threads());
        geometry::Shell shell =
            geometry::find_shell(g.samples, g.primitives.model.size(), device.threads(), g.storeys);
        g.role = std::move(shell.role);
        g.shell_log_odds = std::move(shell.log_odds);
    });
    return g;
}

geometry::SurfaceSeams surface_seams(const Surfaces& g, std::span<const std::int32_t> number,
                                     const std::function<bool(std::size_t)>& counts) {
    const geometry::Surfels& s = g.surfels;
    const auto solid = [&](std::size_t surfel) {
        const std::int32_t p = g.primitives.label[surfel];
        return p < 0 ? -1 : number[p];
    };
    geometry::SurfaceSeams out;
    out.inside.resize(static_cast<std::size_t>(
        std::ranges::count_if(number, [](std::int32_t to) { return to >= 0; })));
    for (std::size_t n = 0; n < s.size(); ++n) {
        const std::int32_t a = solid(n);
        if (a < 0 || (counts && !counts(n))) continue;
        for (const std::uint32_t m : s.around(n)) {
            const std::int32_t b = solid(m);
            if (m <= n || b < 0) continue;
            geometry::Seam& seam =
                a == b ? out.inside[a] : out.between[{std::min(a, b), std::max(a, b)}];
            seam.variation += 1 - (double{s.nx[n]} * s.nx[m] + double{s.ny[n]} * s.ny[m] +
                                   double{s.nz[n]} * s.nz[m]);
            ++seam.pairs;
            if (a == b) continue;
            seam.flush += geometry::in_one_surface(s, g.primitives, n, m);
            seam.ledge += geometry::ledge_between(g.primitives, n, m);
        }
    }
    return out;
}

}  // namespace topple
