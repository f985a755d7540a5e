// SPDX-License-Identifier: MIT
#include "lab/evaluation/room.h"

#include "lab/evaluation/rigid.h"
#include "lab/evaluation/view.h"
#include "lab/temporary_folder.h"

namespace topple::evaluation {
namespace {

template <class Points>
void move(const Mat4& m, Points& points) {
    for (std::size_t n = 0; n < points.x.size(); ++n) {
        const Vec3 p = moved(m, {points.x[n], points.y[n], points.z[n]});
        points.x[n] = static_cast<float>(p[0]);
        points.y[n] = static_cast<float>(p[1]);
        points.z[n] = static_cast<float>(p[2]);
    }
}

// From the camera's frame, which is all that a single frame knows, to the input's.
void move(const Mat4& m, Scene& scene) {
    move(m, scene.points);
    move(m, scene.solid);
    ScenePoints& points = scene.points;
    for (std::size_t n = 0; n < points.nx.size(); ++n) {
        const Vec3 v = turned(m, {points.nx[n], points.ny[n], points.nz[n]});
        points.nx[n] = static_cast<float>(v[0]);
        points.ny[n] = static_cast<float>(v[1]);
        points.nz[n] = static_cast<float>(v[2]);
    }
    scene.up = turned(m, scene.up);
}

}  // namespace

Room scan_and_parse(const RoomOptions& options) {
    Room room;
    room.world = scenes::furnished_room(options.room);
    room.camera = options.camera;
    room.sequence = scenes::walk(room.world, options.camera);
    const scenes::TemporaryFolder folder("topple_evaluate");
    scenes::write_sequence(folder.path(), room.world, room.sequence);
    room.parse = parse(folder.path(), options.parse);
    if (options.camera.single) {
        room.input_from_grid = room.sequence.frames.front().camera_to_world;
        move(room.input_from_grid, room.parse.scene);
    }
    room.part = scenes::true_parts(room.world, room.parse.scene.points);
    return room;
}

RoomScore judge(const Room& room) {
    const Scene& scene = room.parse.scene;
    const ScenePoints& points = scene.points;
    const auto object = scenes::true_objects(room.world, room.part);
    RoomScore out;
    out.seed = room.world.seed;
    out.points = points.x.size();
    out.parts = room.world.parts.size();
    out.objects = room.world.objects.size();
    const auto agreement = [&](const auto& truth, const auto& found) {
        return scenes::segmentation_score(points, truth, found);
    };
    out.parts_by_region = agreement(room.part, points.region);
    out.parts_by_primitive = agreement(room.part, points.primitive);
    out.objects_by_region = agreement(object, points.region);
    out.objects_by_primitive = agreement(object, points.primitive);
    out.objects_by_object = agreement(object, points.object);
    const scenes::Domain domain = in_view(room.world, room.camera, room.sequence);
    const auto volume = [&](const SolidVoxels& solid) {
        return scenes::volume_score(room.world, solid, scene.voxel_size_m, domain);
    };
    out.surface = volume(surface_alone(scene.solid));
    out.invisible = volume(never_seen_empty(room, domain));
    out.completed = volume(scene.solid);
    out.relations = scenes::relation_score(room.world, scene, room.part);
    out.gravity_deg = scenes::gravity_error_deg(room.world, scene);
    for (const auto& [stage, seconds] : scene.timings_s) out.parse_s += seconds;
    return out;
}

}  // namespace topple::evaluation
