// SPDX-License-Identifier: MIT
#include <string>
#include <system_error>

#include "core/field_rules.h"
#include "io/output_folder.h"
#include "io/text.h"
#include "result/check_scene.h"
#include "result/landscapes_json.h"
#include "result/read_result_ply.h"
#include "result/scene_json.h"
#include "result/solids_file.h"
#include "topple/parse.h"

namespace topple {
namespace {

void check_labels(const Scene& scene, const std::vector<std::int32_t>& primitive,
                  const std::vector<std::int32_t>& object, const std::filesystem::path& file) {
    if (!rules::labels(scene.primitives.size())(primitive) ||
        !rules::labels(scene.objects.size())(object))
        io::fail(file, "is of another scene: it names an id that scene.json has not");
}

}  // namespace

ParseResult read_outputs(const std::filesystem::path& folder) {
    io::check_output(folder);
    const auto file = [&](const char* name) { return io::FileName::in(folder, name); };
    ParseResult out;
    Scene& scene = out.scene = io::read_scene_json(file("scene.json"));
    io::check_bodies(scene, folder / "scene.json");
    io::read_landscapes_json(file("landscapes.json"), scene);
    scene.points = io::read_points_ply(file("points.ply"));
    check_labels(scene, scene.points.primitive, scene.points.object, folder / "points.ply");
    scene.solid = io::read_solid_ply(file("solid.ply"));
    check_labels(scene, scene.solid.primitive, scene.solid.object, folder / "solid.ply");
    // Of a cloud that was parsed in blocks there are none.
    if (const io::FileName solids = file("solids.bin"); solids.is_there())
        out.solids = io::read_solids(solids);
    return out;
}

}  // namespace topple
