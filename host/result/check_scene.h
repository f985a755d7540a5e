// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "topple/scene.h"

// What a scene.json must keep to, so that others can go by it: a file says anything. These throw
// Error(input) that names the file.
namespace topple::io {

// What each scene keeps to that was read: all ids are there, and lists that belong together are of
// one length.
void check_scene(const Scene& scene, const std::filesystem::path& file);

// What the bodies of a simulator take beyond that: masses, places and inertia.
void check_bodies(const Scene& scene, const std::filesystem::path& file);

}  // namespace topple::io
