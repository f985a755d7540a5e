// SPDX-License-Identifier: MIT
#pragma once

#include "core/field_list.h"
#include "core/object_fields.h"
#include "topple/scene.h"
#include "topple/topple.h"

// Every public field of a result, once, with its meaning, its rule, and where C has it:
// core/field_list.h says who goes by these lists. Names end with their unit. The order is that of
// scene.json, and of docs/output.md, which docs/fields writes. There NaN and inf are null.
namespace topple {

template <>
inline constexpr auto kind<Primitive> = described(
    "Primitive", "A part: solid, about convex, of which objects are made.",
    field("id", &Primitive::id, "its number, and place in the list", Note{.rule = Rule::own_place},
          &topple_primitive::id),
    field("object", &Primitive::object, "the object that it is part of",
          Note{.rule = Rule::objects_or_none}, &topple_primitive::object),
    field("model", &Primitive::model,
          "`plane` or `quadric`: one surface region; `merged`: several that meet convexly",
          &topple_primitive::model),
    field("points", &Primitive::points, "labelled points of the scan on it",
          &topple_primitive::points),
    field("solid_voxels", &Primitive::solid_voxels, "solid voxels of it",
          &topple_primitive::solid_voxels),
    field("volume_m3", &Primitive::volume_m3,
          "cubic metres; surface voxels count by the share within the surface",
          &topple_primitive::volume_m3),
    field("mass_kg", &Primitive::mass_kg, "kilograms", &topple_primitive::mass_kg),
    field("center_of_mass_m", &Primitive::center_of_mass_m, "metres",
          &topple_primitive::center_of_mass_m),
    field("name", &Primitive::name,
          "given by a correction to a part of the building; mostly there is none",
          Note{.since = "name", .if_any = true}, &topple_primitive::name));

template <>
inline constexpr auto kind<Contact> = described(
    "Contact", "Two primitives that touch.",
    field("a", &Contact::a, "the one primitive, not an object", Note{.rule = Rule::primitives},
          &topple_contact::a),
    field("b", &Contact::b, "the other primitive, above a", Note{.rule = Rule::primitives},
          &topple_contact::b),
    field("area_m2", &Contact::area_m2, "contact area, square metres", &topple_contact::area_m2),
    field("normal", &Contact::normal, "unit vector from a to b", &topple_contact::normal),
    field("relation", &Contact::relation,
          "`fixed`: parts of one object; `support`: one carries the other; `adjacent`",
          Note{.one_of = "\"fixed\", \"support\", \"adjacent\""}, &topple_contact::relation),
    field("probability", &Contact::probability,
          "that both are one solid, 0 to 1, calibrated. `relation` may differ, as the partition "
          "weighs all joints",
          &topple_contact::probability));

template <>
inline constexpr auto kind<Support> = described(
    "Support", "An object that carries another.",
    field("supporter", &Support::supporter, "the object below", Note{.rule = Rule::objects},
          &topple_support::supporter),
    field("supported", &Support::supported, "the object that it carries",
          Note{.rule = Rule::objects}, &topple_support::supported),
    field("area_m2", &Support::area_m2, "carrying area, square metres", &topple_support::area_m2),
    field("probability", &Support::probability,
          "that it carries it, 0 to 1. Listed above 0.5, else an object's likeliest above 0.2",
          Note{.since = "probability"}));

template <>
inline constexpr auto kind<AppliedCorrection> =
    described("AppliedCorrection", "What became of a correction.",
              field(
                  "do", [](const AppliedCorrection& c) { return to_string(c.correction.kind); },
                  "as in the correction", &topple_correction::what),
              field("held", &AppliedCorrection::held, "whether it holds", &topple_correction::held),
              field("outcome", &AppliedCorrection::outcome, "`held`, or what kept it from that",
                    &topple_correction::outcome),
              field("objects", &AppliedCorrection::objects, "the objects that it is about",
                    Note{.rule = Rule::objects}, &topple_correction::objects,
                    &topple_correction::object_count));

template <>
inline constexpr auto kind<Scene> = described(
    "Result", "All of a parse.",
    field("source", &Scene::source,
          "INPUT as given; of arrays the name that was given, or \"points\"",
          &topple_scene::source),
    field("topple_version", &Scene::topple_version, "the version that computed it"),
    field("backend", &Scene::backend, "what it was computed on: `native`, `opencl` or `vulkan`",
          &topple_scene::backend),
    field("device", &Scene::device, "name of that device", &topple_scene::device),
    field("seed", &Scene::seed, "of all randomness", &topple_scene::seed),
    field("voxel_size_m", &Scene::voxel_size_m,
          "edge of a solid voxel, metres: `--voxel`, else 2 cm, finer in dense scans, coarser in "
          "large halls and blocks",
          &topple_scene::voxel_size_m),
    field("up", &Scene::up, "unit vector against gravity", &topple_scene::up),
    field(
        "up_method", &Scene::up_method,
        "how up was found: `given`; `manhattan` (an axis of the room); `dominant-plane`; "
        "`upright-surfaces`; `assumed` (the cameras' or the input's axis); `map`; `format` (glTF)",
        &topple_scene::up_method),
    field("manhattan_found", &Scene::manhattan_found,
          "whether surfaces follow three orthogonal directions"),
    field("offset_m", &Scene::offset_m,
          "what to add to coordinates to get the input's own, metres; 0 except for `.las` beyond "
          "4096 m",
          Note{.since = "offset_m"}),
    field("manhattan_from_input", &Scene::manhattan_from_input,
          "rigid transform to z up and walls along the axes, by rows. *North* is its second row",
          Note{.rule = Rule::finite}, &topple_scene::manhattan_from_input),
    field("density_kg_m3", &Scene::density_kg_m3,
          "of all solids that no correction says other of, kg/m3, as it was given",
          &topple_scene::density_kg_m3),
    field("friction", &Scene::friction, "coefficient of friction, one for all, as it was given",
          &topple_scene::friction),
    field("events", &Scene::events,
          "the disturbances: `walks`, `wind_m_s`, `wind_from_deg`, `pga_m_s2`, `pga_spread` (of "
          "the peaks' logarithm), `floor_amplification`, `hazard_from_g`, `tolerable_J`, as far as "
          "they apply",
          Note{.since = "events"}),
    field("people", &Scene::people, "the kinds of people in it, `--people`; none: adults alone",
          Note{.since = "people", .if_any = true}),
    field("primitives", &Scene::primitives, "the parts that objects are made of, by id",
          &topple_scene::primitives),
    field("objects", &Scene::objects, "rigid bodies, by id", &topple_scene::objects),
    field("contacts", &Scene::contacts, "primitives that touch", &topple_scene::contacts),
    field("supports", &Scene::supports, "objects that carry others", &topple_scene::supports),
    field("possible_things", &Scene::possible_things,
          "parts of the building that may be things, the highest of risk times probability first",
          Note{.since = "possible_things"}),
    field("corrections", &Scene::corrections,
          "what became of those that were given, in their order",
          Note{.since = "corrections", .if_any = true}, &topple_scene::corrections),
    field("timings_s", &Scene::timings_s, "seconds by stage, in their order"),
    field("swc_energy", &Scene::swc_energy,
          "energy of the best partition after each step of the sampler, in nats"),
    field("notes", &Scene::notes,
          "sentences to read before trusting the rest: doubts about options and input first",
          &topple_scene::notes));

}  // namespace topple
