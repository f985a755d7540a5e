// SPDX-License-Identifier: MIT
#include "lab/evaluation/room.h"

#include "lab/solids/rigid.h"
#include "lab/temporary_folder.h"
#include "vdb/voxel_scene.h"

namespace topple::evaluation {
namespace {

using scenes::moved;
using scenes::Sequence;
using scenes::turned;
using scenes::World;

template <class Points>
void move(const Mat4& m, Points& points) {
    for (std::size_t n = 0; n < points.x.size(); ++n) {
        const Vec3 p = moved(m, {points.x[n], points.y[n], points.z[n]});
        points.x[n] = static_cast<float>(p[0]);
        points.y[n] = static_cast<float>(p[1]);
        points.z[n] = static_cast<float>(p[2]);
    }
}

// Whether a place projects into the image within the range.
bool in_image(const Intrinsics& k, const Mat4& m, double range_m, const Vec3& p) {
    const double d[3] = {p[0] - m[3], p[1] - m[7], p[2] - m[11]};
    const double z = m[2] * d[0] + m[6] * d[1] + m[10] * d[2];
    if (!(z > 0 && z <= range_m)) return false;
    const double u = k.cx + k.fx * (m[0] * d[0] + m[4] * d[1] + m[8] * d[2]) / z;
    const double v = k.cy + k.fy * (m[1] * d[0] + m[5] * d[1] + m[9] * d[2]) / z;
    return u >= -0.5 && v >= -0.5 && u < k.width - 0.5 && v < k.height - 0.5;
}

void put(SolidVoxels& list, float x, float y, float z) {
    list.x.push_back(x);
    list.y.push_back(y);
    list.z.push_back(z);
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
        // A single frame knows the camera's frame alone.
        const Mat4& m = room.input_from_grid = room.sequence.frames.front().camera_to_world;
        Scene& scene = room.parse.scene;
        move(m, scene.points);
        move(m, scene.solid);
        scene.up = turned(m, scene.up);
    }
    room.part = scenes::true_parts(room.world, room.parse.scene.points);
    return room;
}

scenes::Domain in_view(const World& world, const scenes::CameraOptions& camera,
                       const Sequence& sequence) {
    return [&world, &sequence, range = camera.max_range_m](const Vec3& p) {
        for (std::size_t a = 0; a < 3; ++a) {
            if (p[a] < 0 || p[a] > world.room[a]) return false;
        }
        const Vec3 q = world.to_input(p);
        for (const DepthFrame& frame : sequence.frames) {
            if (in_image(sequence.intrinsics, frame.camera_to_world, range, q)) return true;
        }
        return false;
    };
}

SolidVoxels never_seen_empty(const Room& room, const scenes::Domain& domain) {
    const vdb::VoxelScene& voxels = *room.parse.voxels;
    const vdb::Tiles tiles = voxels.tiles(true);
    const std::vector<std::uint8_t> states = voxels.states(tiles);
    const vdb::VoxelFrame& frame = voxels.frame();
    SolidVoxels out;
    for (std::size_t at = 0; at < states.size(); ++at) {
        if (states[at] == static_cast<std::uint8_t>(vdb::State::empty)) continue;
        const std::size_t leaf = at / 512;
        const auto local = static_cast<std::int32_t>(at % 512);
        const Vec3 own = frame.input_of({frame.voxel_m * (tiles.x[leaf] + (local >> 6) + 0.5),
                                         frame.voxel_m * (tiles.y[leaf] + (local >> 3 & 7) + 0.5),
                                         frame.voxel_m * (tiles.z[leaf] + (local & 7) + 0.5)});
        const Vec3 p = moved(room.input_from_grid, own);
        if (!domain(room.world.to_room(p))) continue;
        put(out, static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    }
    return out;
}

SolidVoxels surface_alone(const SolidVoxels& solid) {
    SolidVoxels out;
    for (std::size_t n = 0; n < solid.x.size(); ++n) {
        if (solid.state[n] == 0) put(out, solid.x[n], solid.y[n], solid.z[n]);
    }
    return out;
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
