// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/object_of.h"
#include "core/table.h"
#include "device/stage_clock.h"
#include "graph/contact_graph.h"
#include "graph/pieces.h"
#include "graph/rest.h"
#include "graph/stable_objects.h"
#include "graph/supports.h"
#include "objects/floor_heights.h"
#include "objects/hand_corrections.h"
#include "objects/object_boxes.h"
#include "objects/object_masses.h"
#include "physics/bodies.h"
#include "physics/hidden_walls.h"
#include "physics/inertia.h"
#include "physics/landscape.h"
#include "physics/part_hulls.h"
#include "physics/sliding.h"
#include "physics/toppling.h"
#include "solids/solid_parts.h"
#include "topple/kernels/device.h"

// Sections 3 and 4 of the paper: from solid primitives to stable objects. Grid frame.
namespace topple {

// One object: a group of primitives, or the ground with all that is fixed to it.
struct Body {
    physics::Candidate candidate;
    bool grounded = false;
    physics::Stability tipping;
    physics::Stability open_tipping;   // if nothing of the building stood beside it
    physics::Stability level_tipping;  // and its support went on beyond all of its edges
    physics::SlideResult sliding;
    physics::Instability instability;  // of tipping and sliding together
    MassModel mass_model = MassModel::solid;
    physics::Symmetric inertia{};
    physics::Drawers drawers;
    physics::Friction friction;     // on what it stands on
    physics::BodyError body_error;  // at its density, as all that follows from it
    double density_error_kg = 0;    // of its mass, by what its density may be
    double mass_error_kg() const { return std::hypot(body_error.mass_kg, density_error_kg); }
    double barrier_error_J = 0;
    double seen_error_J = 0;  // the same of what was seen of its foot: risk knows of no more
    Overturning overturning;
    std::shared_ptr<const physics::Toppling> toppling;  // none: nothing holds it, or it is grounded
    double floor_m = 0;                                 // height of the floor under it
    double floor_shakes = 1;  // so many times as strongly as the ground floor (FloorHeights)
    // How it stands (graph/rest.h); its candidate is held up in that way.
    graph::RestKind rest = graph::RestKind::seen;
    double rest_probability = 1;
    double margin_error_m = 0;   // to which the border of its support is known
    double unseen_margin_m = 0;  // as of graph::Rest, where it is known what sensors saw
    // Whether what holds it up was seen well enough to say what a push does.
    bool seen_enough() const {
        return rest != graph::RestKind::hidden && rest != graph::RestKind::none;
    }
    double agreement = 1;                // how likely it is one thing, whole
    graph::PieceOf piece;                // what it may be a piece of
    graph::WeakestJoint weakest;         // what it hangs together by
    Landscape poses;                     // grid frame; its places are those of `sliding`
    double lowest_m = 0, highest_m = 0;  // of its voxels
    ObjectBox box;
};

// Takes over what is known of its mass and friction.
void take_mass(const ObjectMasses::Object& mass, Body& object);

// S(W) by direction and height of an object that tips so, as it stands.
physics::Toppling toppling_of(const Body& object, const physics::Stability& tipping);

// What a doubtful object may be in place of what it was taken for.
struct OtherReading {
    ObjectId object;         // which
    double probability = 0;  // of the joint by which it would be so
    ObjectId with;           // that it is one thing with; none: it is two things
    Body body;               // the whole, or of both parts the one that falls more easily
};

// What was counted as the building, and may be a thing by itself.
struct PossibleBody {
    double probability = 0;  // that it is
    Body body;               // then
};

struct ObjectStage {
    Table<PrimitiveId, physics::MassProperties> bodies;
    graph::ContactGraph contacts;
    std::vector<double> pair_probability;  // by pair of the contacts: that both are one solid
    graph::Grouping grouping;
    ObjectMasses masses;
    Table<PrimitiveId, std::int32_t> object_of_primitive;  // the ground, if any, is object 0
    // The same, but of what may be a thing: the number of objects and its place in that list.
    Table<PrimitiveId, std::int32_t> body_of_primitive;
    Table<ObjectId, Body> objects;
    FloorHeights floors;
    physics::HiddenWalls hidden_walls;
    std::vector<OtherReading> alternatives;  // by object, the likelier one first
    std::vector<PossibleBody> possible_things;
    std::vector<Support> supports;  // sorted by (supporter, supported)
    HandCorrections::Told told;
    std::optional<TakenAway> taken;  // by hand from the parts, before all else here
};

// What grouping starts from.
struct PartStage {
    Table<PrimitiveId, physics::MassProperties> bodies;
    graph::ContactGraph contacts;
    std::vector<graph::Joint> joints;
    graph::ShellOdds shell;
};
PartStage weigh_parts(device::Device& device, const SolidParts& parts, const ParseOptions& options,
                      StageClock& stage);

class Stops;

// Whether they are of the building, or of what is fixed to it.
Table<PrimitiveId, bool> fixed_primitives(ObjectOf object_of, TableView<ObjectId, Body> objects);

// What a push does to objects whose candidates are known, all in one batch: fills in the drops over
// their edges, tipping, sliding, both together, boxes, and their landscapes if asked for. `stops`
// and walls behind what hides them stop what falls.
void find_barriers(device::Device& device, const physics::PartHulls& parts,
                   const SolidScene& solids, const physics::HiddenWalls& walls, const Stops& stops,
                   ObjectOf object_of, std::vector<Body>& objects, const Unseen& unseen = {},
                   bool landscapes = true);

// Takes from the parts what is not there by hand, and from the solids what turns out to be no
// object's (graph/false_feet.h).
ObjectStage find_objects(device::Device& device, const ParseOptions& options, StageClock& stage,
                         SolidParts& solid, PartStage parts);
ObjectStage find_objects(device::Device& device, const ParseOptions& options, StageClock& stage,
                         SolidParts& solid);

}  // namespace topple
