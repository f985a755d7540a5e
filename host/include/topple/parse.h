// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "topple/cloud_view.h"
#include "topple/corrections.h"
#include "topple/device.h"
#include "topple/error.h"
#include "topple/frames_view.h"
#include "topple/input.h"
#include "topple/materials.h"
#include "topple/motion.h"
#include "topple/scene.h"
#include "topple/space_field.h"

namespace topple::vdb {
class VoxelScene;
}

namespace topple {

class Crew;
class SolidScene;
class TiledResult;

// The names of all disturbances that there are.
std::vector<std::string> known_disturbances();
// The names of all kinds of people that there are.
std::vector<std::string> known_people();

struct ParseOptions {
    // What to compute on, from topple/device.h or topple/embed.h; one parse at a time uses it.
    // Null: what open_device("auto") gives, opened for this parse alone.
    std::shared_ptr<device::Device> device;
    double voxel_m = 0;      // edge of a solid voxel, metres; 0: found from the data
    double unit_m = 1;       // metres in the unit of a cloud file's coordinates: 0.001 for mm
    std::optional<Vec3> up;  // up in the input's frame (from an IMU, say); else found
    // Empty: none, so that there are no risks, and no object has an unsafety or a category. What a
    // push or a blow does is known all the same. "reach" comes in only where somebody reaches.
    std::vector<std::string> disturbances = known_disturbances();
    // Who walks there, each kind as often as the others; of children, toddlers and elderly people
    // some reach for things, pull at them and climb.
    std::vector<std::string> people{"adults"};
    std::uint64_t seed = 1;
    std::uint64_t max_memory_bytes = 0;  // more is refused, or ends the parse. 0: 3/4 of what is
    // free, and of inputs of megabytes no more than 2 GB for each begun one
    double density_kg_m3 = 700;
    // What things weigh by their names (corrections) or their sizes, with errors that say how
    // little that is known, instead of all by that density; null: none.
    std::shared_ptr<const Materials> materials;
    double friction = 0.3;
    // What closed furniture (Object::mass_model) holds, over its inner volume; none: all is solid.
    std::optional<double> contents_kg_m3 = 68;
    // People who walk by: walks that are sampled, and how a body moves meanwhile, from
    // read_motion() or your own recording; none: a table of published figures of gait.
    unsigned walks = 500;
    std::vector<std::shared_ptr<const BodyMotion>> motions;
    double wind_m_s = 12;
    // Where the wind comes from, degrees clockwise from the scene's north, as Why::azimuth_deg;
    // none: from each of 16 directions.
    std::optional<double> wind_from_deg;
    // Peak ground acceleration; none: the accelerogram's own, or 3 without one.
    std::optional<double> pga_m_s2;
    // A recorded earthquake (read_accelerogram), instead of made-up ones about that peak.
    std::optional<Accelerogram> accelerogram;
    // What things stand on shakes so many times as strongly as the ground, as upper floors do;
    // peaks are those of the ground.
    double floor_amplification = 1;
    // How often the ground shakes there (read_hazard_curve), for how often each object falls.
    std::optional<HazardCurve> hazard;
    double tolerable_J = 0.1;   // risk per event below which nothing needs to be done
    bool space_fields = false;  // ParseResult::space_fields is wanted
    // Meshes, OctoMaps and OpenVDB files are read by libraries of others. They read in a process of
    // their own, the program topple-reader, with limits of memory and time by the file's size: what
    // crashes there is an Error here. Without, they read in this process, without limits, which is
    // for files that you trust. What is parsed from memory needs no such library.
    bool isolate = true;
    // What is known of the room beside the scan (read_corrections). Of what the scan does not show
    // there, or that others rule out, Scene::corrections tells; where two of them contradict each
    // other the parse ends with Error(input).
    std::vector<Correction> corrections;
    // A file that keeps what does not depend on corrections and disturbances, of a scan that is
    // read from files and parsed in one piece. Where it fits the scan and the options, the parse
    // goes on from there, with the same result; else it is made anew. Empty: none.
    std::filesystem::path cache_file;
    // The disturbance W under which an object is to stay (paper, Eq. 8), as a share of m g h, h the
    // height of its centre of mass above its support. 0: it stands at all. What would fall at W is
    // the likelier a part of what it touches: with more, more is one with the floor.
    double stability_level = 0;
    // Seconds for the search for objects, about; none: as long as it takes. Where a limit is met,
    // the objects depend on the machine.
    std::optional<double> grouping_time_s;
    // Whether the result holds its points' coordinates. Without, it takes 12 bytes a point less,
    // and add_coordinates() is needed before write_outputs().
    bool coordinates = true;
    // Clouds in files of over 4 million points are parsed in blocks of 5 m, so that they may be
    // larger than memory, and smaller ones in one piece; where this is given, every cloud file is
    // parsed in blocks. As many blocks as lie in a tile of this edge, metres, are read and handed
    // out together; 0: one by one. The result is the same.
    double tile_m = 0;
    // Where the blocks are kept meanwhile; a run that was killed goes on from what it finds there.
    // Is removed by write_outputs(). Empty: a temporary folder.
    std::filesystem::path work_folder;
    // With whom a parse in blocks is shared (topple/crew.h); null: nobody.
    std::shared_ptr<Crew> crew;
    // Called on the thread that called the parse, as `cancelled` is, when a stage starts and while
    // it goes on: its name, and about how much of the whole parse is done, which never falls, and
    // is 1 at the end: by the shares of time that stages take of typical parses.
    std::function<void(const std::string&, double)> progress;
    // Polled now and then; true stops the parse with Error(cancelled).
    std::function<bool()> cancelled;
    // Called on the same thread with what a user may want to know while it runs, a line each: that
    // it goes on with what an earlier run left in the work folder or the cache, or makes anew what
    // is damaged there; or, as a note says later, that poses or `up` do not fit what is seen, or
    // that the density is that of nothing.
    std::function<void(const std::string&)> notice;
};

// Throws Error(usage) that names the option that is out of its range. Every parse does so first.
void check_options(const ParseOptions& options);

// A parsed scene, with the voxel grids behind it.
struct ParseResult {
    Scene scene;
    std::shared_ptr<const vdb::VoxelScene> voxels;
    // Of a cloud that was parsed in blocks: its points' labels and the voxel grids, on disk.
    // scene.points is a sample then, and `voxels` is null.
    std::shared_ptr<const TiledResult> tiled;
    // The solids, finer than the voxels; null for a cloud that was parsed in blocks.
    std::shared_ptr<const SolidScene> solids;
    // By disturbance, those of people and of wind over space; empty unless
    // ParseOptions::space_fields asked for them.
    std::map<std::string, SpaceField> space_fields;
    // The size of the depth image that an organised cloud in a file is: scene.points are its
    // pixels, or those that ScenePoints::index says, row by row. 0: it is none.
    std::uint32_t image_width = 0, image_height = 0;
};

// Parses a scan: a point cloud (.ply, .pcd, .xyz, .las), a mesh (.obj, .stl, .glb, .gltf, .ply with
// faces), a map (.bt, .ot, .vdb), a sequence folder of depth frames with poses, or
// a folder with a single frame. The result does not hold the device. Throws Error: input (can't be
// parsed into a scene), usage (an option is out of range), device (it can't be opened, or failed),
// cancelled. Besides, std::bad_alloc where memory runs out, and what the options' functions throw.
ParseResult parse(const std::filesystem::path& input, const ParseOptions& options = {});

// The same on a cloud in memory, a PointCloud or the caller's own arrays. No copy of the points is
// made on the way in, unless some are not finite.
ParseResult parse(const CloudView& cloud, const ParseOptions& options = {});

// The same on depth frames in memory: bit for bit what a folder of them gives. Throws Error(input),
// too, where an image, its size, its rows, the intrinsics or a pose make no sense.
ParseResult parse(const FramesView& frames, const ParseOptions& options = {});

// Puts the coordinates of the cloud that was parsed into the result. Throws Error(usage) where it
// can't be that cloud, by its number of points.
void add_coordinates(const CloudView& cloud, ParseResult& result);

struct OutputOptions {
    bool pictures = false;  // the report's main views, too, as view-*.png
    bool glb = false;       // the solids as a mesh per object, too: objects.glb
    bool octomap = false;   // what was seen to be free and occupied, too: map.bt
    // ParseOptions::cache_file, to be moved into the folder as parse.cache. Empty: none.
    std::filesystem::path cache_file;
    // The words of the command that parses so again, which the report shows for a parse with
    // corrections. Empty: `topple parse` of the scene's source into the folder.
    std::vector<std::string> command;
    std::string title;     // of the report; empty: the source's name
    unsigned threads = 0;  // 1: no thread but the caller's
    // Polled now and then, from any thread; true ends the writing with Error(cancelled).
    std::function<bool()> cancelled;
};

// Writes points.ply, solid.ply, volume.vdb, scene.json, landscapes.json and report.html into the
// folder, which appears whole or not at all. Throws Error: input (it can't be written: the path and
// why), usage (the result has no coordinates of its points, or comes from read_outputs()).
void write_outputs(const ParseResult& result, const std::filesystem::path& folder,
                   const OutputOptions& options = {});

// Reads back what write_outputs() has written: the scene with its points and solid voxels. Fields,
// walks, regions of points and the voxel grids are not in it, so that it can be exported
// (topple/export.h) and label frames, but not be written again. Throws Error(input) where a file is
// missing, damaged or of another scene.
ParseResult read_outputs(const std::filesystem::path& folder);

}  // namespace topple
