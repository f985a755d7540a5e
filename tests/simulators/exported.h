// SPDX-License-Identifier: MIT
#pragma once

#include "export/named_bodies.h"
#include "standard.h"

// Scenes in all formats, for the libraries that read these.
namespace topple::exports::test {

struct Exported {
    SimScene scene;
    std::vector<NamedBody> bodies;  // of it
    // Holds scene.xml, scene.urdf, scene.sdf and scene.usda, and expected.json for Python.
    std::filesystem::path folder;
};

// Made once by each process: a scene with every kind of shape, and a scan with colours, parsed.
const std::vector<Exported>& exported();

}  // namespace topple::exports::test
