// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "topple/corrections.h"
#include "topple/input.h"

// The result of a parse. Lengths in metres, masses in kilograms, energies in joules; every
// coordinate and direction is in the input's frame. Ids count from 0; -1 means unassigned.
namespace topple {

// A convex-ish solid part: one or more surface regions merged by geometry (paper, 2.1.2).
struct Primitive {
    std::int32_t id = -1;
    std::int32_t object = -1;
    std::string model;  // "plane" | "quadric" | "merged"
    std::uint64_t points = 0;
    std::uint64_t solid_voxels = 0;
    double volume_m3 = 0;
    double mass_kg = 0;
    Vec3 center_of_mass_m{};
    std::string name{};  // given by hand to what is fixed to the ground; else Object::name is
};

// One step of the instability curve S(W) (paper, Eq. 6).
struct InstabilityStep {
    double W_J = 0;  // energy absorbed
    double S_J = 0;  // the largest release that this much energy can set free
};

// What it takes to make an object fall by a push or a blow from where it comes: S(W) by direction
// and height. `instability` is its envelope: no push and no blow takes less. Index n of the
// directions is towards the azimuth n * 22.5 degrees (Why::azimuth_deg). Infinity: no fall was
// found that way, which is no promise: what stands in its way counts as its end, and a drop counts
// only where a surface was scanned below. Empty for the ground, and what is held by nothing that
// was seen.
struct DirectedBarrier {
    static constexpr std::size_t directions = 16;
    // Of blows, above what the object stands on (Object::support_height_m): ascending.
    std::vector<double> height_m;
    std::vector<double> push_J;  // joules, done by a slow push, by direction
    // Least level blow that makes it fall, by direction, then by height: that of direction n at
    // height_m[h] is [n * height_m.size() + h]. As an impulse, in newton seconds: what comes at v
    // m/s with m kg and stays brings m v, and up to twice that where it bounces back. And as the
    // joules that this impulse would give to the object if nothing held it, motion and turning
    // together, which are not the energy of what strikes.
    std::vector<double> blow_Ns, blow_J;
    std::vector<Vec3> direction;  // unit and horizontal, towards where the push goes
    // Steady level push at Overturning::hand_height_m, in newtons, at which the object begins to
    // turn over the edge that the line ahead meets first, whatever that then releases, and one
    // standard error of it: by direction. Infinity: no edge lies that way. Where
    // Overturning::slide_N is less, the object slides before. Empty for what hangs.
    std::vector<double> push_N, push_error_N;
};

// Why an object is as safe as it is: its easiest step out of its pose, which is the one of its
// barrier and release.
struct Why {
    // Of the weakest direction: degrees clockwise from the scene's north, seen from above. North is
    // the second row of manhattan_from_input. NaN where no way is easier than others.
    double azimuth_deg = std::numeric_limits<double>::quiet_NaN();
    // Ends of the edge that it turns over, or of its support's where it slides off: two or none.
    std::vector<Vec3> edge_m;
    double W_J = 0, S_J = 0;              // what the step takes, and what it can release
    double way_m = 0;                     // slid on the support; 0 for other steps
    double drop_m = 0;                    // fallen beyond where its support ends; 0: it stays on it
    std::int32_t lands_on = -1;           // object below that drop, or -1
    std::vector<std::int32_t> stands_on;  // objects that carry it, ascending
    std::string sentence;                 // all this in plain words
};

// The energy landscapes of an object (paper, 3.1 and 3.2, Figs. 5 and 6), as its pictures show
// them. Energies are joules above its pose and place as scanned.
struct Landscape {
    // Over directions d, each the one that is up then, in the body as it was scanned: U(d) = - M g
    // min over the corners v of v.d, less its value as scanned.
    struct Pose {
        Vec3 up{};
        double energy_J = 0;
        // The disconnectivity graph: the energy at which its basin joins that of a deeper pose, and
        // which one; infinity and -1 for the deepest of all.
        double joins_at_J = 0;
        std::int32_t joins = -1;
        double probability = 0;  // of coming to rest in it when tossed
    };
    // Where one basin borders on another: an edge over which the body can balance.
    struct Pass {
        Vec3 up{};
        double energy_J = 0;
        std::array<std::int32_t, 2> poses{};
        std::vector<Vec3> border;  // of the two basins, directions from top to top
    };
    // Where it can be pushed to: the work of the shortest way there on its support, around what
    // stands there; beyond the support's end minus what the fall releases. NaN: not reached, or
    // unknown. Infinity: something is in the way.
    struct Places {
        std::int32_t side = 0;        // places in a row, odd; its own is in the middle
        double step_m = 0;            // between them
        std::vector<float> energy_J;  // rows from south to north, each from west to east
    };
    std::vector<Vec3> hull_m;  // corners, relative to the centre of mass; none: not known
    std::vector<Pose> poses;   // by rising energy
    std::vector<Pass> passes;  // by rising energy
    std::int32_t now = -1;     // the pose that it is in
    Places places;
};

// Where an object comes to lie when what its risks reckon with happens, and what that takes along.
struct Fall {
    bool falls = false;                     // whether any disturbance can upset it
    Vec3 lands_m{};                         // its centre of mass, about, at its first landing
    double drop_m = 0;                      // fallen from its support to there; 0: it stays on it
    std::int32_t lands_on = -1;             // object below that drop; -1: none, or unknown
    std::int32_t leans_on = -1;             // object that stops it on its way; -1: none
    std::vector<std::int32_t> takes_along;  // what then loses half of its support, ascending
    double hits_J = 0;                      // energy that it has gathered where it lands
    // Share of the walks that pass within reach of its fall; NaN: nobody walks here, or nobody was
    // asked for.
    double people_share = std::numeric_limits<double>::quiet_NaN();
};

// What would lower an object's risk to what is tolerated.
struct Advice {
    std::string kind;          // "" (nothing needed) | "see" | "check" | "move" | "fix"
    Vec3 move_m{};             // "move": the smallest that does, horizontal
    double risk_J = 0;         // its largest risk afterwards
    double hold_N = 0;         // "fix": horizontal force at hold_height_m that a fixing must take
    double hold_height_m = 0;  // above its support
    std::string sentence;
    // What to do about it, so that it agrees with its category: the sentence, or that there is no
    // need to act, or to look. "" for the ground, and where the category is not known and there is
    // no sentence.
    std::string action{};
};

// What it takes to overturn an object slowly, on its easiest way to tip: the figures of statics.
// One standard error each, of the mass, its centre and the border of the footing. NaN where it
// can't tip: the ground, and what hangs or is held by nothing that was seen.
struct Overturning {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    double tilt_deg = none, tilt_error_deg = none;  // it goes over once it leans so much
    Vec3 direction{};                               // towards there: horizontal, unit; zero: any
    // Steady level push at its top that tips it; and one anywhere that slides it: the lesser of
    // both comes first.
    double push_N = none, push_error_N = none, slide_N = none;
    // Level acceleration of what carries it, in g, at which it begins to rock or slide. To begin is
    // not to fall: short shakes need several times as much.
    double shake_g = none;
    // The push that tips it at the height of a hand: a metre above the floor, at its top where that
    // is lower, and at its centre of mass where it stands higher than that.
    double hand_push_N = none, hand_push_error_N = none, hand_height_m = none;
    // Gust that is as likely to tip it as not, from where it takes least, if it does not slide.
    double gust_m_s = none, gust_error_m_s = none;
    // One standard error of slide_N: of the mass, and of a coefficient of friction that nobody
    // told.
    double slide_error_N = none;
};

// How likely an object is to fall in an earthquake, over how strong that is: counted over records
// scaled to rising peaks, each from 16 directions, and fitted by a lognormal distribution, so that
// half of the earthquakes of the median upset it. NaN where fewer than that fall at the strongest
// that is tried, and for what has no risk.
struct Fragility {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    struct Step {
        double pga_g = 0;
        double chance = 0;  // share of the records and directions in which it fell
    };
    // Of peak ground acceleration, over g. Where counts level off below 9 in 10, or begin above
    // half: the peak at which half falls (the least that was tried at the least), and no
    // dispersion.
    double pga_g = none, pga_dispersion = none;
    double firm_pga_g = none;                           // the same median if its foot can't slide
    double pgv_m_s = none, pgv_dispersion = none;       // of peak ground velocity
    std::vector<Step> counted;                          // by rising peaks; empty: not asked for
    double falls_per_year = none, return_years = none;  // with a hazard curve
};

// What those of a kind of people do to a thing within their reach, one of all the ways and heights
// at which they do: one that upsets it, where one does.
struct Hold {
    std::string by;   // the kind of people
    std::string act;  // "pull" | "lean" | "climb" | "open" | "fall"
    // Per event of "reach", and of those that upset it.
    double chance = 0, fall_chance = 0;
    // Where it acts; of who climbs, and of drawers, where their weight does, before it.
    Vec3 place_m{}, force_N{};
    Vec3 impulse_Ns{};  // that the thing takes of who falls against it
};

// What a doubtful object may be in place of what it was taken for, and what that would mean.
struct Alternative {
    double probability = 0;   // that it is this
    std::int32_t whole = -1;  // the object that it is one thing with; -1: it is two things
    // Of the whole, or of the one of both parts that falls more easily.
    double mass_kg = 0, barrier_J = 0, barrier_error_J = 0;
    // As Object::unsafety_category, as measured; "": not seen enough, or no disturbance.
    std::string unsafety_category;
};

// What was counted as the building (object 0), or as fixed to it, and may be a thing by itself:
// what it would be then. Corrections say which it is.
struct PossibleThing {
    std::vector<std::int32_t> primitives;
    double probability = 0;     // that it is a thing
    std::vector<Vec3> spots_m;  // amid each of those, for corrections
    // Its box, as Object::size_m and box_middle_m.
    Vec3 size_m{}, box_middle_m{};
    double mass_kg = 0, barrier_J = 0, barrier_error_J = 0;
    std::map<std::string, double> risk_J;  // by disturbance: expected release per event
    // As Object::unsafety_category; "": not seen enough, or no disturbance.
    std::string unsafety_category;
};

// A set of primitives fixed to one another: one rigid body.
struct Object {
    std::int32_t id = -1;
    std::vector<std::int32_t> primitives;
    bool grounded = false;  // holds the floor, or is fixed to what does
    // The probability that it is one thing, whole; 1 for the ground.
    double agreement = 1;
    double mass_kg = 0;
    // Its box along the room's axes (Scene::manhattan_from_input), the third upright: end to end,
    // and where its middle lies. Where nothing of it is solid: zeros, and NaN.
    Vec3 size_m{};
    Vec3 box_middle_m{std::numeric_limits<double>::quiet_NaN(),
                      std::numeric_limits<double>::quiet_NaN(),
                      std::numeric_limits<double>::quiet_NaN()};
    // The larger object that it is likelier than not a piece of, though grouping left them apart;
    // -1: none. And how likely it is a piece of the likeliest one; 0: there is none.
    std::int32_t piece_of = -1;
    double piece_probability = 0;
    // The least likely joint at which two parts of it meet (each a twentieth of what of it was
    // seen, or more), by how likely it is one: about as likely as not it is two things below 0.6. 1
    // and no primitives where it has one part.
    double joint_probability = 1;
    std::array<std::int32_t, 2> weakest_joint{-1, -1};
    // What else it may be, with a probability of a quarter or more, the likelier first: one thing
    // with that larger object, or two things.
    std::vector<Alternative> alternatives;
    // "solid", of the density that was given all through; "closed": furniture that is boards of
    // that density around ParseOptions::contents_kg_m3; or "hollow": a shell, as a correction says.
    std::string mass_model = "solid";
    // Coefficient of friction, by its name or a correction; NaN: Scene::friction.
    double friction = std::numeric_limits<double>::quiet_NaN();
    Vec3 center_of_mass_m{};
    // How high what it stands on lies along Scene::up, so that a place p is dot(up, p) -
    // support_height_m above that; and how high the centre of mass is above it, less than 0 for
    // what hangs. NaN for the ground, and what is held by nothing that was seen.
    double support_height_m = std::numeric_limits<double>::quiet_NaN();
    double center_height_m = std::numeric_limits<double>::quiet_NaN();
    Mat3 inertia_kg_m2{};  // about its centre of mass, along the axes of the input, row-major
    double barrier_J = 0;  // least energy that moves it out of its basin
    // One standard error each: of the mass and, along each axis, of its centre, by what surfaces
    // were not seen and how well the others were, at the density that was given; of where the
    // border of its footprint lies; and of the barrier, by all of these.
    double mass_error_kg = 0;
    Vec3 center_of_mass_error_m{};
    double footprint_error_m = 0;
    double barrier_error_J = 0;
    double release_J = 0;  // what it can release then
    Overturning overturning;
    Fragility fragility;
    std::string mode = "none";  // "tip" | "slide" | "none"
    Vec3 direction{};           // weakest horizontal direction, unit, or zero for "none"
    std::vector<InstabilityStep> instability;
    DirectedBarrier barrier_by_direction;
    Why why;
    Landscape landscape;
    // By disturbance: joules per event; their standard error from the sampling of events; and the
    // chance per event that it falls, which is that it absorbs its barrier or more.
    std::map<std::string, double> risk_J, risk_spread_J, fall_chance;
    // One standard error of that risk, by disturbance: of the sampling, and of what is not known of
    // the barrier and the mass.
    std::map<std::string, double> risk_error_J;
    std::vector<Hold> holds;  // that people take who reach for it, if any were asked for
    // 1 (safest) to 10, by risk, over the scene's objects; NaN: not seen enough to be ranked, or no
    // disturbance was asked for.
    double unsafety = 1;
    // "none" | "low" | "medium" | "high", by how likely one event makes it fall and how hard it
    // then falls, whatever else is in the scene, at the worse end of one standard error; "": not
    // seen enough, or no disturbance was asked for. Certain where the better end says the same.
    std::string unsafety_category = "none";
    bool unsafety_certain = true;
    // Whether what holds it up was seen; else it is taken to stand where it is lowest, and has no
    // rank. By what it stands: "seen" contacts, "near" (across gaps that noise leaves), "leaning"
    // on what is beside it, "hidden", "none", or "ground"; and how probable that is.
    bool seen_enough = true;
    std::string rests_by = "seen";
    double rest_probability = 1;
    Fall fall;
    Advice advice;
    std::string name{};  // given by hand; mostly empty
    std::vector<std::int32_t>
        corrected{};  // numbers of the corrections about it, from 1, ascending
};

// Whether the barrier can't be told from 0: what is known then is 0 to barrier_J + barrier_error_J.
inline bool barrier_within_error(const Object& o) {
    return !o.grounded && o.barrier_J <= o.barrier_error_J;
}

// By which the riskiest come first; what has no rank comes last.
inline double rank_of(const Object& o) {
    return o.unsafety >= 1 ? o.unsafety : 0;
}

// Two primitives that touch.
struct Contact {
    std::int32_t a = -1, b = -1;
    double area_m2 = 0;
    Vec3 normal{};  // unit, from a to b
    std::string
        relation;  // "fixed" (one object) | "support" (a carries b, or b carries a) | "adjacent"
    double probability = 0;  // that the joint is fixed, over the sampler's states
};

// One object that carries another.
struct Support {
    std::int32_t supporter = -1, supported = -1;
    double area_m2 = 0;
    double probability = 1;  // that it does
};

// Point of the parsed cloud, one array per field, input order (for frames: the fused cloud).
struct ScenePoints {
    std::vector<float> x, y, z;  // empty without ParseOptions::coordinates
    std::vector<float> nx, ny, nz;
    std::vector<std::int32_t> primitive, object;
    std::vector<std::int32_t> region{};  // smooth piece of surface that primitives are merged of
    // The scan's own colours, sRGB, 0 to 255; empty where it has none, or without
    // ParseOptions::coordinates. 0, 0, 0: this point's is not known.
    std::vector<std::uint8_t> red{}, green{}, blue{};
    // Of a cloud with points that are not finite, in memory or an organised one in a file: the
    // place of each of the others there, ascending. Empty: all are here, or others aren't known.
    std::vector<std::uint64_t> index{};
};

// Solid voxels at their centres.
struct SolidVoxels {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> primitive, object;
    std::vector<std::uint8_t> state;  // 0 seen surface, 1 completed
};

// A disturbance field on the walkable or exposed space: where, which way and how strongly a
// disturbance acts. One array per field.
struct FieldSamples {
    std::vector<float> x, y, z;     // metres
    std::vector<float> vx, vy, vz;  // mean direction times strength (m/s, or m/s^2 for earthquakes)
    std::vector<float> density;     // visits per event, or exposure in 0..1
};

// Where people walk (paper, 5.1.2 and Fig. 9): cell (x, y) spans corner_m + [x, x + 1] * along_x_m
// + [y, y + 1] * along_y_m, and its index is y * nx + x. Empty without the disturbance "human".
struct Walks {
    Vec3 corner_m{}, along_x_m{}, along_y_m{};
    std::int64_t nx = 0, ny = 0;
    std::vector<float> floor_m;            // height of the floor above corner_m, of each cell
    std::vector<float> visits;             // walks through the cell per event; -1: not walkable
    std::vector<std::vector<Vec3>> paths;  // corners of some of the walks, on the floor
};

struct Scene {
    Vec3 offset_m{0, 0, 0};  // the input's own coordinates are the scene's plus this
    std::string source, topple_version, backend, device;
    std::uint64_t seed = 1;
    double voxel_size_m = 0;
    Vec3 up{0, 0, 1};
    // "given" | "manhattan" | "dominant-plane" | "upright-surfaces" | "assumed" | "map"
    std::string up_method;
    bool manhattan_found = false;
    Mat4 manhattan_from_input{};
    double density_kg_m3 = 700, friction = 0.3;
    // What was reckoned with: walks, wind_m_s, pga_m_s2, tolerable_J, as far as they were asked
    // for.
    std::map<std::string, double> events;
    std::vector<std::string> people;  // ParseOptions::people; empty: adults alone
    std::vector<Primitive> primitives;
    std::vector<Object> objects;
    std::vector<Contact> contacts;
    std::vector<Support> supports;
    // Those that endanger most if they are things, each by its risk times its probability, first.
    std::vector<PossibleThing> possible_things;
    std::vector<std::pair<std::string, double>> timings_s;  // in the order of the stages
    std::vector<double> swc_energy;  // best energy after each sweep of the sampler (paper, Fig. 7d)
    std::vector<std::string> notes;  // what the reader of the result should know, in sentences
    std::vector<AppliedCorrection> corrections;  // those of ParseOptions, in their order
    ScenePoints points;
    SolidVoxels solid;
    std::map<std::string, FieldSamples> fields;  // by disturbance
    Walks walks;
};

}  // namespace topple
