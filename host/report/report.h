// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/object_surface.h"
#include "topple/scene.h"

namespace topple::report {

// What the page says beside the scene.
struct ReportWords {
    std::vector<std::string> command;  // that made it
    std::string title;                 // empty: the name of the source
};

// The result as one web page that opens from disk and needs no network: a 3D view of the solids and
// the scan, the disturbance fields, a table of the objects and the curves behind their figures.
// Scenes with more voxels or points than a browser draws well are thinned for the view, and the
// page says so; it stays below 15 MB. Made in two steps, the first of which needs no surfaces.
class Report {
  public:
    // with_surfaces: whether there will be some. The scene must outlive it.
    Report(const Scene& scene, bool with_surfaces, ReportWords words);
    ~Report();
    Report(const Report&) = delete;
    Report& operator=(const Report&) = delete;

    // Once. surfaces: of the scene's solids; without them, and where they are too large, voxels are
    // shown. threads: 0 for as many as the machine has. Throws Error(input) where the file can't be
    // written.
    void write(const std::filesystem::path& file, std::span<const ObjectSurface> surfaces,
               unsigned threads);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

// Puts what a simulator made of the scene, a verify.json, into a report that is there, in the place
// that the page keeps for it; an earlier one is replaced. False where the page has no such place:
// an older topple wrote it. Throws Error(input) where it can't be read or written.
bool add_verification(const std::filesystem::path& report, const std::string& json);

}  // namespace topple::report
