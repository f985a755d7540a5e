// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/surfels.h"
#include "topple/kernels/device.h"

namespace topple::geometry {

// The scene's axes (paper, 2.2.1).
struct SceneFrame {
    std::array<Vec3, 3> axes;  // orthonormal, right-handed, input frame; axes[2] is up
    bool found = false;        // three near-orthogonal directions carry the scene's surfaces
    std::string up_method;     // as Scene::up_method
    std::string note;     // what to know before trusting up, in a sentence; empty where it is sure
    double up_share = 0;  // share of surfels whose normal is within 10 degrees of +-up
    Vec3 origin_m{};      // of the grid frame, in the input's
};

struct FrameHints {
    std::optional<Vec3> up;         // the user's: always wins, with a note where it looks wrong
    std::optional<Vec3> camera_up;  // mean -y axis of the cameras, if there were any
    // Whether nothing but the looks of the scene told which side of each surface was seen.
    bool sides_guessed = false;
    std::optional<Vec3> format_up{};  // by the file's format, which not every writer keeps to
};

// Clusters the normals on the sphere (kernel normal_cluster: spherical k-means with antipodes
// folded), picks three large near-orthogonal clusters, orthogonalises them, chooses up among them
// (manhattan_up.h), and refines it over the normals near it. Deterministic.
SceneFrame find_scene_frame(device::Device& device, const Surfels& surfels,
                            const FrameHints& hints);

// Spherical k-means with antipodes folded; exposed for tests. Returns `k` unit directions by
// falling weight; weights are sums over surfels of 0..1, less where
// the surface is rough: about the area that faces that way, in cells.
struct NormalClusters {
    std::vector<Vec3> direction;
    std::vector<double> weight;
};
NormalClusters cluster_normals(device::Device& device, const Surfels& surfels, unsigned k);

}  // namespace topple::geometry
