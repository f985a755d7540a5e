/* SPDX-License-Identifier: MIT */
#ifndef TOPPLE_TOPPLE_H
#define TOPPLE_TOPPLE_H

#include <stddef.h>
#include <stdint.h>

/* topple for C, and for what calls C: C99, no other headers of topple.
 *
 * - Functions return TOPPLE_OK or another code of topple_code, and then say why in `status`, which
 *   may be NULL. A message is one line that names the object, the value, the limit and the mend,
 *   and options as the fields here.
 *   Nothing is global, nothing is printed, no exception leaves a function.
 * - Structs with a member `size` grow with the library: set it to sizeof of the struct, or call the
 *   struct's _init where there is one. What lies beyond the caller's size keeps its default.
 * - Different handles are independent and may be used from different threads at once. One device
 *   is used by one call at a time; a result may be read by several.
 * - Lengths in metres, masses in kilograms, energies in joules, directions unit; coordinates are in
 *   the input's frame. Ids count from 0, -1 means unassigned.
 * - Pointers that getters give belong to the handle and end with it. _release takes NULL, too. */
#ifdef __cplusplus
extern "C" {
#endif

typedef enum topple_code {
    TOPPLE_OK = 0,
    TOPPLE_ERROR_INPUT = 1,     /* the input can't be parsed, or the output can't be written */
    TOPPLE_ERROR_USAGE = 2,     /* an option or argument is wrong */
    TOPPLE_ERROR_DEVICE = 3,    /* the device can't be used */
    TOPPLE_ERROR_CANCELLED = 4, /* the callback `cancelled` said so */
    TOPPLE_ERROR_MEMORY = 5,    /* memory ran out, or the allocator gave NULL */
    TOPPLE_ERROR_INTERNAL = 6   /* anything else: a fault of the library */
} topple_code;

/* What went wrong in a call; written by every call that is given one. */
typedef struct topple_status {
    int32_t code;
    char message[1020]; /* ends with 0; cut where it is longer; empty for TOPPLE_OK */
} topple_status;

/* "0.2.0"; and 10000 * major + 100 * minor + patch. */
const char* topple_version(void);
uint32_t topple_version_number(void);

/* --- Devices ------------------------------------------------------------------------------- */

typedef struct topple_device topple_device;

/* backend: "auto" (or NULL), "native", "opencl" or "vulkan". threads bounds those of the native
 * backend; 0: all cores. */
int topple_device_open(const char* backend, uint32_t threads, topple_device** device,
                       topple_status* status);
/* The caller's own device, as topple/embed.h adopts it: cl_context, cl_device_id and an in-order
 * cl_command_queue; or VkInstance, VkPhysicalDevice, VkDevice, VkQueue and its family. The handles
 * stay the caller's, and must outlive the topple_device. */
int topple_device_adopt_opencl(void* context, void* device_id, void* queue, topple_device** device,
                               topple_status* status);
int topple_device_adopt_vulkan(void* instance, void* physical_device, void* logical_device,
                               void* queue, uint32_t queue_family, topple_device** device,
                               topple_status* status);
const char* topple_device_backend(const topple_device* device);
const char* topple_device_name(const topple_device* device);
void topple_device_release(topple_device* device);

/* One device of the machine, or why a backend offers none. */
typedef struct topple_device_info {
    char backend[16];
    char name[256];
    char driver[256];
    char problem[512]; /* empty: it can be used */
    int32_t usable, gpu;
    uint64_t memory_bytes;
} topple_device_info;
/* The number of devices goes to `count`, and the first `capacity` of them to `devices`. */
int topple_list_devices(topple_device_info* devices, uint64_t capacity, uint64_t* count,
                        topple_status* status);

/* --- Parsing ------------------------------------------------------------------------------- */

/* A point cloud in the caller's memory, metres. It is read where it lies, strided or not, and not
 * kept; points that are not finite are left out, which takes a copy of the others. */
typedef struct topple_cloud {
    size_t size;
    const float *x, *y, *z; /* of the first point */
    uint64_t count;
    int64_t stride_bytes;              /* from one point to the next; 0: sizeof(float) */
    const float *nx, *ny, *nz;         /* unit normals, or NULL */
    int64_t normal_stride_bytes;       /* 0: sizeof(float) */
    uint32_t width, height;            /* of an organised cloud, of width * height points; else 0 */
    const double* viewpoint;           /* 3 numbers: where the sensor was; or NULL */
    const char* name;                  /* for messages; NULL: "cloud" */
    const uint8_t *red, *green, *blue; /* sRGB, 0, 0, 0 where it is not known; or NULL */
    int64_t colour_stride_bytes;       /* 0: 1 */
    /* Of each point, where the sensor was that saw it, in place of `viewpoint`; or NULL */
    const float *viewpoint_x, *viewpoint_y, *viewpoint_z;
    int64_t viewpoint_stride_bytes; /* 0: sizeof(float) */
} topple_cloud;
void topple_cloud_init(topple_cloud* cloud, size_t size);

typedef struct topple_intrinsics {
    uint32_t width, height;
    double fx, fy, cx, cy, depth_scale; /* pixels; metres = stored value / depth_scale */
} topple_intrinsics;
/* What a camera saw at one time, in the caller's memory: rows of pixels without gaps. Of depth and
 * depth_m one is given, of the size that the intrinsics say; strides are from a row to the one
 * below it, 0 where nothing lies between them. struct FrameView of topple/frames_view.h says more.
 */
typedef struct topple_frame {
    size_t size;
    const uint16_t* depth; /* metres = value / depth_scale; 0: no reading */
    const float* depth_m;  /* metres; no reading: what is not finite, or not above 0 */
    int64_t depth_stride_bytes;
    const uint8_t* rgb;             /* sRGB, 3 bytes a pixel, 0, 0, 0: not known; or NULL */
    uint32_t rgb_width, rgb_height; /* 0: those of depth */
    int64_t rgb_stride_bytes;
} topple_frame;
void topple_frame_init(topple_frame* frame, size_t size);
/* Depth frames of one camera, with poses. */
typedef struct topple_frames {
    size_t size;
    topple_intrinsics intrinsics; /* of depth */
    const topple_intrinsics*
        colour_intrinsics; /* of rgb; NULL: those of depth, scaled to its size */
    uint64_t count;
    /* 16 numbers for each frame, row-major, metres; NULL: one frame, whose camera is the origin */
    const double* camera_to_world;
    /* `count` of them, each of the first one's `size`; or NULL, and what fills in one, which must
     * stay until the next call. It is called with `user` on the thread that parses, more than once
     * for each index, and returns 0, or what ends the parse with TOPPLE_ERROR_INPUT. */
    const topple_frame* frames;
    int (*load)(uint64_t index, topple_frame* frame, void* user);
    void* user;
    const char* name; /* for messages; NULL: "frames" */
} topple_frames;
void topple_frames_init(topple_frames* frames, size_t size);

/* Where the memory of a result's arrays comes from. `release` gets the size that was asked for. */
typedef struct topple_allocator {
    void* (*allocate)(size_t bytes, size_t alignment, void* user);
    void (*release)(void* memory, size_t bytes, void* user);
    void* user;
} topple_allocator;

enum { TOPPLE_HUMAN = 1, TOPPLE_WIND = 2, TOPPLE_EARTHQUAKE = 4, TOPPLE_REACH = 8 };
enum {
    TOPPLE_ADULTS = 1,
    TOPPLE_CHILDREN = 2,
    TOPPLE_TODDLERS = 4,
    TOPPLE_ELDERLY = 8,
    TOPPLE_WHEELCHAIR = 16
};
enum { TOPPLE_LOG_INFO = 0, TOPPLE_LOG_WARNING = 1 };

/* Options of a parse; the command line's --help and topple/parse.h say more of each. NaN means
 * "not given" where said so. */
typedef struct topple_options {
    size_t size;
    topple_device* device;     /* stays the caller's; NULL: the best, opened for this parse alone */
    double voxel_m;            /* edge of a solid voxel; 0: found */
    double unit_m;             /* metres in a cloud file's unit; 1 */
    double up[3];              /* in the input's frame; 0, 0, 0: found */
    uint32_t disturbances;     /* TOPPLE_HUMAN | TOPPLE_WIND | ..: 1 << n is that of
                                  topple_disturbance_name(n) */
    uint32_t walks;            /* 500 */
    uint64_t seed;             /* 1 */
    uint64_t max_memory_bytes; /* 0: as ParseOptions::max_memory_bytes says */
    double density_kg_m3;      /* 700 */
    double friction;           /* 0.3 */
    double wind_m_s;           /* 12 */
    double wind_from_deg;      /* NaN: from all sides */
    double pga_m_s2;           /* 0.3 g are 2.94; NaN: 3 */
    double tolerable_J;        /* 0.1 */
    double grouping_time_s;    /* NaN: as long as it takes */
    int32_t without_coordinates; /* not 0: the result keeps no coordinates of its points */
    int32_t without_isolation;   /* not 0: files of others' formats are read in this process */
    /* Called on the thread that parses, with `user`. They must return, and not by longjmp. */
    /* done: about how much of the whole parse, 0 to 1; it never falls */
    void (*progress)(const char* stage, double done, void* user);
    int (*cancelled)(void* user); /* not 0: stop */
    /* Each stage as it starts, at level TOPPLE_LOG_INFO; what the reader of the result should
     * know, at level TOPPLE_LOG_WARNING. Single lines. */
    void (*log)(int level, const char* message, void* user);
    void* user;
    /* Where the arrays lie that getters of the result hand out; it must outlive the result. The
     * library's own working memory, handles and strings do not come from it. NULL: the library's
     * memory, which saves a copy of them. */
    const topple_allocator* allocator;
    double contents_kg_m3;      /* of closed furniture; 68. NaN: all is solid */
    double floor_amplification; /* of the ground's shaking by the building; 1 */
    /* How often the ground shakes: hazard_points rising peaks, and falling annual rates at which
     * they are exceeded; 0: not known. Read during the parse alone. */
    const double *hazard_pga_g, *hazard_per_year;
    uint64_t hazard_points;
    /* What is known of the room beside the scan (docs/corrections.md): a file, or a file's text;
     * one of both at most. NULL: nothing. */
    const char *corrections_file, *corrections_json;
    const char* cache_file; /* what does not depend on corrections (topple/parse.h); NULL: none */
    double tile_m;          /* not 0: any cloud file is parsed in blocks (topple/parse.h) */
    double stability_level; /* W that objects are to stand, as a share of m g h; 0 */
    /* What things weigh by name or size: "household" or a file (topple/materials.h). NULL: all are
     * of density_kg_m3. */
    const char* materials;
    uint32_t people;      /* TOPPLE_ADULTS | TOPPLE_CHILDREN | ..: who is in the room; adults */
    int32_t space_fields; /* not 0: topple_result_write() writes fields.vdb, too */
} topple_options;
void topple_options_init(topple_options* options, size_t size);

typedef struct topple_result topple_result;

/* options: NULL for the defaults. A file or folder as the command line takes it; or a cloud; or
 * depth frames. */
int topple_parse(const char* path, const topple_options* options, topple_result** result,
                 topple_status* status);
int topple_parse_cloud(const topple_cloud* cloud, const topple_options* options,
                       topple_result** result, topple_status* status);
int topple_parse_frames(const topple_frames* frames, const topple_options* options,
                        topple_result** result, topple_status* status);
void topple_result_release(topple_result* result);

/* --- Results ------------------------------------------------------------------------------- */

typedef struct topple_scene {
    size_t size;
    const char *source, *backend, *device, *up_method;
    double voxel_size_m, density_kg_m3, friction;
    double up[3];
    double manhattan_from_input[16]; /* row-major 4x4 */
    uint64_t seed, points, primitives, objects, contacts, supports, notes;
    uint64_t corrections;
} topple_scene;
typedef struct topple_primitive {
    size_t size;
    int32_t id, object;
    const char* model;
    uint64_t points, solid_voxels;
    double volume_m3, mass_kg, center_of_mass_m[3];
    const char* name; /* given by hand to what is fixed to the ground; else "" */
} topple_primitive;
typedef struct topple_step { /* of the instability curve S(W) */
    double W_J, S_J;
} topple_step;
typedef struct topple_object {
    size_t size;
    int32_t id, grounded;
    const int32_t* primitives;
    uint64_t primitive_count;
    double mass_kg, center_of_mass_m[3];
    double size_m[3]; /* along the room's axes, the third upright */
    double barrier_J, barrier_error_J, release_J;
    const char* mode; /* "tip", "slide" or "none" */
    double direction[3];
    const topple_step* instability;
    uint64_t instability_count;
    double unsafety; /* 1 to 10; NaN: not seen enough to be ranked, or no disturbance given */
    double agreement;
    const char *why, *advice; /* sentences */
    /* one standard error each, as barrier_error_J */
    double mass_error_kg, center_of_mass_error_m[3], footprint_error_m;
    /* "solid", "closed" (boards around contents), "hollow" (by hand) or "kind" (by materials) */
    const char* mass_model;
    double inertia_kg_m2[9]; /* about its centre of mass, along the input's axes, row-major */
    /* to overturn it slowly (struct Overturning of topple/scene.h); NaN where it can't tip */
    double tilt_deg, tilt_error_deg, overturning_direction[3];
    double push_N, push_error_N, slide_N, shake_g;
    /* earthquakes half of which upset it (struct Fragility of topple/scene.h); NaN: none of those
     * that were tried. The rates are NaN without a hazard curve. */
    double fragility_pga_g, fragility_pga_dispersion, fragility_pgv_m_s, fragility_pgv_dispersion;
    double fragility_firm_pga_g;
    double falls_per_year, return_years;
    /* S(W) by direction and height (struct DirectedBarrier of topple/scene.h): blow_heights numbers
     * in blow_height_m, 16 in push_barrier_J, 16 rows of blow_heights in blow_barrier_J: that of
     * direction n at blow_height_m[h] is [n * blow_heights + h]; infinity: no fall was found so.
     * NULL and 0 where nothing is known. */
    const double *blow_height_m, *push_barrier_J, *blow_barrier_J;
    uint64_t blow_heights;
    double hand_push_N, hand_push_error_N, hand_height_m, gust_m_s, gust_error_m_s;
    /* where it would go (struct Fall of topple/scene.h): its centre of mass there, the object that
     * it falls to or -1, the energy that it has there, and the share of walks that pass within its
     * reach; NaN: nobody walks, or nobody was asked for */
    double lands_m[3], hits_J, people_share;
    int32_t falls, lands_on;
    /* "none", "low", "medium" or "high", at the worse end of one standard error, and whether the
     * better end says the same; "": not seen enough, or no disturbance given */
    const char* unsafety_category;
    int32_t unsafety_certain;
    const char* name;         /* given by hand, or "" */
    const int32_t* corrected; /* numbers of the corrections about it, from 1 */
    uint64_t corrected_count;
    /* of 16 directions, in the input's frame: where a push goes, x y z each; and the steady push at
     * hand_height_m, in newtons, at which it begins to turn over that way, and one standard error
     * of it; infinity: no edge lies there. NULL where nothing is known */
    const double *push_direction, *push_by_direction_N, *push_error_by_direction_N;
    /* what `why` is made of (struct Why of topple/scene.h): degrees clockwise from the scene's
     * north, NaN where no way is easier than others; the ends of the edge that it turns over, x y z
     * each, 2 or 0 of them; metres slid, and fallen beyond its support's end, and the object below
     * that or -1; what carries it */
    double why_azimuth_deg;
    const double* why_edge_m;
    uint64_t why_edge_ends;
    double why_way_m, why_drop_m;
    const int32_t* stands_on;
    uint64_t stands_on_count;
    /* and `advice` (struct Advice): "", "see", "check", "move" or "fix"; the smallest move that
     * does; its risk then; and the force that a fixing must take, at that height above its support
     */
    const char* advice_kind;
    double advice_move_m[3], advice_risk_J, hold_N, hold_height_m;
    int32_t why_lands_on;
    /* the larger object that it is likelier than not a piece of, or -1; and how likely the
     * likeliest such joint is, 0 where there is none */
    int32_t piece_of;
    double piece_probability;
    double box_middle_m[3]; /* the middle of the box of size_m; NaN: nothing of it is solid */
    const char* action;     /* what to do about it, so that it agrees with its category */
    /* how high what it stands on lies along the scene's `up`, and its centre of mass above that;
     * NaN for the ground, and what is held by nothing that was seen */
    double support_height_m, center_height_m;
    const double* blow_barrier_Ns; /* blow_barrier_J as impulses, newton seconds */
    /* the least likely joint at which two parts of it meet: how likely it is one, and its
     * primitives; 1 and -1 where it has one part. Below 0.6 it is about as likely two things */
    double joint_probability;
    int32_t weakest_joint[2];
    double friction;      /* coefficient, by its name or a correction; NaN: that of the scene */
    double slide_error_N; /* one standard error of slide_N */
} topple_object;
typedef struct topple_contact {
    size_t size;
    int32_t a, b; /* primitives */
    double area_m2, normal[3];
    const char* relation; /* "fixed", "support" or "adjacent" */
    double probability;
} topple_contact;
typedef struct topple_support {
    size_t size;
    int32_t supporter, supported; /* objects */
    double area_m2;
} topple_support;

int topple_result_scene(const topple_result* result, topple_scene* scene, topple_status* status);
/* These fill in the item of that index, from 0 to the count that topple_scene says. Of primitives
 * and objects the index is the id. */
int topple_result_primitive(const topple_result* result, uint64_t index,
                            topple_primitive* primitive, topple_status* status);
int topple_result_object(const topple_result* result, uint64_t index, topple_object* object,
                         topple_status* status);
int topple_result_contact(const topple_result* result, uint64_t index, topple_contact* contact,
                          topple_status* status);
int topple_result_support(const topple_result* result, uint64_t index, topple_support* support,
                          topple_status* status);
/* Numbers by their name in scene.json (docs/output.md), those that the structs above lack, too. of:
 * "scene", "primitive", "object", "contact", "support" or "possible_thing"; index: as above, of the
 * scene 0. field: "mass_kg", or of what is nested "fall.hits_J". `count` becomes how many numbers
 * it has: 1, or those of a vector or list; true and false are 1 and 0. The first `capacity` of them
 * go to `values`. TOPPLE_ERROR_USAGE: there is no such field, or it holds no numbers. */
int topple_result_numbers(const topple_result* result, const char* of, uint64_t index,
                          const char* field, double* values, uint64_t capacity, uint64_t* count,
                          topple_status* status);
/* The names of disturbances, from 0 on; NULL: there are no more. */
const char* topple_disturbance_name(uint32_t index);
/* Risk per event and chance of falling by one of the disturbances, either of which may be NULL;
 * NaN: it was not asked for. */
int topple_result_risk(const topple_result* result, uint64_t index, const char* disturbance,
                       double* risk_J, double* fall_chance, topple_status* status);
/* One standard error of that risk, and its part that more events would lessen. As above. */
int topple_result_risk_error(const topple_result* result, uint64_t index, const char* disturbance,
                             double* error_J, double* spread_J, topple_status* status);
const char* topple_result_note(const topple_result* result, uint64_t index); /* NULL: no such */
/* What became of correction index + 1 of those given. */
typedef struct topple_correction {
    size_t size;
    const char* what;    /* "one_thing", "apart", .. */
    const char* outcome; /* "held", or what kept it from that */
    int32_t held;
    const int32_t* objects; /* that it is about */
    uint64_t object_count;
} topple_correction;
int topple_result_correction(const topple_result* result, uint64_t index,
                             topple_correction* correction, topple_status* status);

/* Arrays over the points, `points` of the topple_scene long, in the input's order. */
const int32_t* topple_result_point_primitives(const topple_result* result);
const int32_t* topple_result_point_objects(const topple_result* result);
const float* topple_result_point_normals(const topple_result* result, int axis); /* 0, 1, 2 */
/* Where points that are not finite were left out: the place of each other one in the caller's
 * arrays, or in an organised file; else NULL. */
const uint64_t* topple_result_point_index(const topple_result* result);

/* Whether object `index` stays where it is when it is touched: topple/stays.h says what that means,
 * and what it does not promise. place_m and way: 3 numbers each, in the frame of the result's
 * points; way NULL: to any side. force_N: of a steady push; impulse_Ns: of a bump; slack_m: metres
 * that the bump may set it sliding, 0.02 say. *stays becomes 1 or 0. TOPPLE_ERROR_USAGE: an
 * argument makes no sense.
 */
int topple_result_stays(const topple_result* result, uint64_t index, const double* place_m,
                        const double* way, double force_N, double impulse_Ns, double slack_m,
                        int* stays, topple_status* status);

/* The steady push there up to which it stays, newtons: 0 where nobody knows. As above. */
int topple_result_stays_up_to(const topple_result* result, uint64_t index, const double* place_m,
                              const double* way, double* force_N, topple_status* status);
/* S(W): the most that an object may set free once it is given W_J joules. */
int topple_result_released(const topple_result* result, uint64_t index, double W_J,
                           double* released_J, topple_status* status);
/* Questions before things are taken away (topple/ask.h). `count` becomes how many ids the answer
 * has; the first `capacity` of them go to `ids`. What falls, in that order, once `taken` is gone:
 */
int topple_result_falls_without(const topple_result* result, const int32_t* taken,
                                uint64_t taken_count, int32_t* ids, uint64_t capacity,
                                uint64_t* count, topple_status* status);
/* an order in which all can be taken away; or what has to go before object `before`, which comes
 * last; -1: all; things that carry one another in a ring follow on one another; */
int topple_result_removal_order(const topple_result* result, int32_t before, int32_t* ids,
                                uint64_t capacity, uint64_t* count, topple_status* status);
/* and what holds an object, the likeliest first; probabilities: as many, or NULL. */
int topple_result_held_by(const topple_result* result, int32_t object, int32_t* ids,
                          double* probabilities, uint64_t capacity, uint64_t* count,
                          topple_status* status);

/* What pixels of depth frames show of a result (topple/frame_labels.h), which must hold its points'
 * coordinates, and need not outlive it. May be asked from several threads at once. */
typedef struct topple_labeller topple_labeller;
int topple_labeller_create(const topple_result* result, topple_labeller** labeller,
                           topple_status* status);
/* Of frame `number`. primitives and objects, one of which may be NULL, get an id for each pixel,
 * row by row from the upper left one on; -1: nothing that is known. */
int topple_labeller_label(const topple_labeller* labeller, const topple_frames* frames,
                          uint64_t number, int32_t* primitives, int32_t* objects,
                          topple_status* status);
void topple_labeller_release(topple_labeller* labeller);

enum { TOPPLE_WRITE_PICTURES = 1, TOPPLE_WRITE_GLB = 2, TOPPLE_WRITE_OCTOMAP = 4 };
/* The folder of outputs, which appears whole or not at all. `what`: these, added up, or 0. A result
 * without coordinates needs topple_result_add_coordinates() first, with the cloud that was parsed.
 */
int topple_result_write(const topple_result* result, const char* folder, uint32_t what,
                        topple_status* status);
int topple_result_add_coordinates(topple_result* result, const topple_cloud* cloud,
                                  topple_status* status);

/* Writes the scene for a simulator, and what became of each body as bodies.json beside it
 * (docs/export.md). format and path: "mjcf", "urdf" or "sdf" and a folder, or "usd" and a file,
 * NAME.usda. Folders are made where they are missing; an earlier export is replaced, and nothing
 * else is. TOPPLE_ERROR_USAGE: there is no such format; TOPPLE_ERROR_INPUT: a file there is no
 * export of topple, or can't be written, or the folder holds a scan, or the cloud was parsed in
 * blocks. */
int topple_result_export(const topple_result* result, const char* format, const char* path,
                         topple_status* status);

/* --- A scan that is still being made: topple/session.h says more ----------------------------- */

typedef struct topple_session topple_session;
/* Of a camera, or, with both NULL, of sweeps of points. colour NULL: its colour images are seen as
 * depth is. options NULL: defaults; what
 * they point to must stay as long as the session. max_frame_bytes 0: the default. keep_gone: 1 to
 * count readings, too, at places that later frames see through; else 0. */
int topple_session_create(const topple_intrinsics* depth, const topple_intrinsics* colour,
                          const topple_options* options, uint64_t max_frame_bytes, int keep_gone,
                          topple_session** session, topple_status* status);
void topple_session_release(topple_session* session);
/* Writes the frames, their poses, and the things of the last update to a file, UTF-8. */
int topple_session_checkpoint(const topple_session* session, const char* file,
                              topple_status* status);
/* A session that goes on from there, with the cameras of the file. */
int topple_session_resume(const char* file, const topple_options* options, uint64_t max_frame_bytes,
                          int keep_gone, topple_session** session, topple_status* status);
/* Adds frames of that camera, whose intrinsics count, copied. `ids`, which may be NULL, gets the id
 * of each. Those before one that is refused stay. */
int topple_session_add(topple_session* session, const topple_frames* frames, uint64_t* ids,
                       topple_status* status);
/* Adds points in the sensor's axes, z up, copied, to a session of points. sensor_to_world: 16
 * numbers, row-major, metres. `id` may be NULL. */
int topple_session_add_points(topple_session* session, const topple_cloud* points,
                              const double* sensor_to_world, uint64_t* id, topple_status* status);
/* camera_to_world: 16 numbers for each of `count` frames, row-major, metres. */
int topple_session_correct(topple_session* session, const uint64_t* ids,
                           const double* camera_to_world, uint64_t count, topple_status* status);
int topple_session_forget(topple_session* session, uint64_t id, topple_status* status);
/* Parses what is there. `result`, which may be NULL, gets a result of its own, which is to be
 * released; `things` how many topple_session_thing() has then. */
int topple_session_update(topple_session* session, topple_result** result, uint64_t* things,
                          topple_status* status);
/* The same within budget_ms: a parse that takes longer goes on behind, and until a later update has
 * its scene it is the one before; `result` is NULL and `things` 0 where there is none yet. */
int topple_session_update_within(topple_session* session, uint64_t budget_ms,
                                 topple_result** result, uint64_t* things, topple_status* status);
/* An update, then the result of topple_parse_frames() of all that is there, also of what has gone.
 */
int topple_session_settle(topple_session* session, topple_result** result, topple_status* status);
/* From any thread: ends the update that is at work, or goes on behind, as cancelled. */
int topple_session_cancel(topple_session* session, topple_status* status);
enum {
    TOPPLE_CHANGE_NONE = 0,
    TOPPLE_CHANGE_FOUND = 1,   /* not seen, or not told apart, before */
    TOPPLE_CHANGE_CAME = 2,    /* its place was seen to be free before */
    TOPPLE_CHANGE_MOVED = 3,   /* by moved_m */
    TOPPLE_CHANGE_CHANGED = 4, /* it stands on something else, or its category is another */
    TOPPLE_CHANGE_LOST = 5,    /* not told apart any more */
    TOPPLE_CHANGE_GONE = 6     /* its place was seen to be free since */
};
typedef struct topple_thing {
    size_t size;
    uint64_t id;    /* the same as long as it is the same thing; 0: the building */
    int32_t object; /* of the last update's result; -1: it is lost or gone */
    int32_t change; /* since the update before */
    double moved_m;
} topple_thing;
int topple_session_thing(const topple_session* session, uint64_t index, topple_thing* thing,
                         topple_status* status);
/* What the latest frames since the last update show that was not there then; some tenths of a
 * second. `count`: how many topple_session_appeared() has then. */
typedef struct topple_appeared {
    size_t size;
    double middle_m[3], size_m[3]; /* its box, along the room's axes */
    double mass_kg, mass_error_kg;
    int32_t stands_on; /* the first of the last update's objects that carry it */
    double barrier_J, barrier_error_J, release_J;
    const char* mode;              /* until the next glance, as the category */
    const char* unsafety_category; /* at the worse end of errors */
} topple_appeared;
int topple_session_glance(topple_session* session, uint64_t* count, topple_status* status);
int topple_session_appeared(const topple_session* session, uint64_t index,
                            topple_appeared* appeared, topple_status* status);
/* The thing that each pixel of frame `number` shows, row by row; -1: nothing that is known. */
int topple_session_label(const topple_session* session, const topple_frames* frames,
                         uint64_t number, int64_t* things, topple_status* status);
/* The same by point. */
int topple_session_label_points(const topple_session* session, const topple_cloud* points,
                                const double* sensor_to_world, int64_t* things,
                                topple_status* status);

/* --- Two scans of one room: topple/compare.h says more --------------------------------------- */

typedef struct topple_comparison topple_comparison;
enum {
    TOPPLE_BECAME_SAME = 0,
    TOPPLE_BECAME_MOVED = 1, /* by moved_m */
    TOPPLE_BECAME_CAME = 2,
    TOPPLE_BECAME_WENT = 3,
    TOPPLE_BECAME_MERGED = 4, /* its place is solid in the other scan, but as other things */
    TOPPLE_BECAME_UNSEEN = 5  /* the other scan did not see its place */
};
typedef struct topple_alignment {
    size_t size;
    double a_from_b[16]; /* row-major 4x4: from the later scan's frame to the earlier one's */
    double seen, agreeing, next_agreeing, error_m;
    int32_t same_frame;
} topple_alignment;
typedef struct topple_compared_thing {
    size_t size;
    int32_t a, b; /* objects of the scenes in both folders; -1: there is none */
    int32_t became;
    int32_t less_safe, safer, stands_otherwise;
    double moved_m, free, solid;
} topple_compared_thing;
/* a, b: folders that topple_result_write() or `topple parse` has written, the earlier one first.
 * `things`, which may be NULL: how many topple_comparison_thing() has. */
int topple_compare(const char* a, const char* b, topple_comparison** comparison, uint64_t* things,
                   topple_status* status);
void topple_comparison_release(topple_comparison* comparison);
int topple_comparison_alignment(const topple_comparison* comparison, topple_alignment* alignment,
                                topple_status* status);
int topple_comparison_thing(const topple_comparison* comparison, uint64_t index,
                            topple_compared_thing* thing, topple_status* status);

/* --- Single stages: topple/stages.h says more ----------------------------------------------- */

/* `device` must be one that was opened or adopted: here NULL is TOPPLE_ERROR_USAGE. */

/* An array in host memory, or in the caller's buffer on an adopted device: then `data` is the
 * cl_mem or VkBuffer, and buffer_bytes its whole size, not 0. */
typedef struct topple_array {
    void* data;
    uint64_t count;
    uint64_t buffer_bytes;
    uint64_t offset_bytes; /* of the array in the buffer, a multiple of 512 */
} topple_array;

int topple_point_spacing(const topple_cloud* cloud, double* spacing_m, topple_status* status);
/* Unit normals, 0 where there is none. cell_m: edge of the cells whose points are looked at
 * together, about 2 * topple_point_spacing(). eye: 3 numbers, where the sensor was: normals point
 * there. NULL: to the cloud's viewpoints; where it has none, neighbours agree in sign, and each
 * connected piece as a whole faces the middle of the cloud, as the inside of a room does; a lone
 * object's normals then point inwards. nx, ny, nz: a float for each point. */
int topple_normals(topple_device* device, const topple_cloud* cloud, double cell_m,
                   const double* eye, float* nx, float* ny, float* nz, topple_status* status);

/* Arrays of float. first: `sets` + 1 numbers; out: sets rows of as many values as directions. */
int topple_support_functions(topple_device* device, const topple_array vertices[3],
                             const uint64_t* first, uint64_t sets, const topple_array directions[3],
                             const topple_array* out, topple_status* status);

/* Bodies on level ground, z up: points[3 * first[n]] to points[3 * first[n + 1]] are those of body
 * n, x y z each. mass_kg and center_of_mass_m (x y z each) have an entry for each body, and so do
 * barrier_J and release_J, which are written. */
int topple_barriers(topple_device* device, const double* points, const uint64_t* first,
                    uint64_t bodies, const double* mass_kg, const double* center_of_mass_m,
                    double resolution_m, double* barrier_J, double* release_J,
                    topple_status* status);

typedef struct topple_footprint_entry {
    int32_t dx, dy;
    float weight;
} topple_footprint_entry;
/* first: directions + 1 numbers. primary, density: arrays of float. */
int topple_convolve(topple_device* device, uint32_t width, uint32_t height, uint32_t directions,
                    uint32_t margin, const topple_array* primary,
                    const topple_footprint_entry* footprint, const uint32_t* first,
                    const topple_array* density, topple_status* status);

/* A voxel grid to carve and fill, z up. */
typedef struct topple_volume topple_volume;
/* label: of each point, -1 for none. */
int topple_volume_create(const topple_cloud* cloud, const int32_t* label, double voxel_m,
                         topple_volume** volume, topple_status* status);
/* depth: `frames` images in a row; camera_to_world: 16 numbers for each, row-major. */
int topple_volume_carve(topple_volume* volume, topple_device* device,
                        const topple_intrinsics* intrinsics, const uint16_t* depth,
                        const double* camera_to_world, uint64_t frames, topple_status* status);
/* hollow: labels that are not filled. `filled`: voxels completed; may be NULL. */
int topple_volume_fill(topple_volume* volume, topple_device* device, uint32_t votes,
                       const int32_t* hollow, uint64_t hollow_count, uint64_t* filled,
                       topple_status* status);
/* 0 seen empty, 1 seen surface, 2 never seen, 3 completed. */
int topple_volume_state(const topple_volume* volume, int32_t i, int32_t j, int32_t k);
void topple_volume_release(topple_volume* volume);

#ifdef __cplusplus
}
#endif
#endif
