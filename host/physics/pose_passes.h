// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "physics/basins.h"
#include "physics/landscape.h"

// Passes of one pose landscape, from its energies U and its levels L (paper, Defs. 1 and
// 2). All heights are U / (M g), metres: the centre of mass above the lowest point.
namespace topple::physics {

inline Vec3 direction_of(const SphereMesh& mesh, std::size_t v) {
    return {mesh.x[v], mesh.y[v], mesh.z[v]};
}

struct Sampled {
    const SphereMesh* mesh = nullptr;
    std::span<const float> height;   // U / (M g) per direction
    const Basins* basins = nullptr;  // and their levels, of L / (M g)
    std::uint32_t start = 0;
    double spacing = 0;       // longest edge of the mesh, radians
    double resolution_m = 0;  // to which heights are known
    // A descent of less than this is noise. Beside the resolution it holds what the mesh misses of
    // a landscape's creases: it samples them up to half a spacing beside their floor, and their
    // walls rise by at most the body's radius per radian.
    double noise_m = 0;
};

// One pass out of the start's basin, and the deepest minimum that it opens beyond those that lower
// passes open.
struct PosePass {
    double height_m = 0;         // at the pass
    Vec3 direction{};            // up in the body's frame at the pass
    double deepest_m = 0;        // lowest height behind this pass or lower ones
    Vec3 deepest{};              // and its direction
    std::optional<Ends> edge{};  // over which it balances, relative to the centre of mass
};

// A minimum that lies behind a pass, as seen from the start.
struct MinimumBehind {
    double level_m = 0;      // of the pass
    double height_m = 0;     // of the minimum
    Vec3 pass{}, minimum{};  // directions
    std::optional<Ends> edge{};
};
// One pass for each level, by rising height; of equal minima the first counts.
std::vector<PosePass> passes_to(std::vector<MinimumBehind> behind);

// The passes that matter, by rising height: the lowest, and those that open something deeper than
// lower ones do. Two that are within rounding of each other stay two.
std::vector<PosePass> passes_that_matter(std::vector<PosePass> passes);
std::vector<PosePass> find_passes(const Sampled& landscape);

// Whether the body can turn by 90 degrees and more with its height all the way within the noise of
// the start's.
bool rolls(const Sampled& landscape);

// The exact pass near one found on the mesh. A body balances over an edge of its hull where the
// centre of mass stands above the edge, and every pass is such a pose; vertices are relative to the
// centre of mass. The mesh bounds the true pass by height * (1 + spacing^2 / 8) (the landscape is a
// maximum of linear functions, so it sags between neighbours); of the edges nearby, the highest
// within that bound is taken. Nothing where no edge qualifies.
std::optional<PosePass> refine_pass(const PosePass& found, std::span<const Vec3> vertices,
                                    double spacing);

// Follows the landscape of the vertices down from a minimum of the mesh to the true one beside it,
// within 2 spacings, by a pattern search that halves its steps. Returns the height reached.
double refine_minimum(const Vec3& direction, std::span<const Vec3> vertices, double spacing);

}  // namespace topple::physics
