// SPDX-License-Identifier: MIT
#pragma once

#include "core/field_list.h"
#include "topple/scene.h"
#include "topple/topple.h"

// The fields of objects, each once: see core/result_fields.h.
namespace topple {

template <>
inline constexpr auto kind<InstabilityStep> = described(
    nullptr, "A step of S(W).", field("W_J", &InstabilityStep::W_J, "energy absorbed, joules"),
    field("S_J", &InstabilityStep::S_J, "energy that it can release then, joules"));

template <>
inline constexpr auto kind<Alternative> = described(
    "Alternative", "What a doubtful object may be in place of what it was taken for.",
    field("probability", &Alternative::probability, "that it is this, 0 to 1"),
    field("whole", &Alternative::whole,
          "the larger object that it is one thing with; -1: it is two things",
          Note{.rule = Rule::objects_or_none}),
    field("mass_kg", &Alternative::mass_kg,
          "of that whole, or of the one of the two that falls more easily, kilograms"),
    field("barrier_J", &Alternative::barrier_J, "its barrier, joules"),
    field("barrier_error_J", &Alternative::barrier_error_J, "one standard error of that"),
    field("unsafety_category", &Alternative::unsafety_category,
          "the category it would have, as measured; none at all: not `seen_enough`, or no "
          "disturbance was asked for",
          Note{.one_of = "\"none\", \"low\", \"medium\", \"high\"",
               .whole_null = true,
               .or_none = true}));

template <>
inline constexpr auto kind<Hold> = described(
    "Hold", "What one kind of people does to a thing within reach, from the floor.",
    field("by", &Hold::by, "the kind of people, as in `--people`"),
    field(
        "act", &Hold::act,
        "`pull`: as high as it is reached; `lean`: at 0.6 m above the floor, or where it is "
        "nearest to that; `climb`: onto its front; `open`: its drawers, if it has any, and by who "
        "climbs onto them; `fall`: against it",
        Note{.one_of = "\"pull\", \"lean\", \"climb\", \"open\", \"fall\""}),
    field("chance", &Hold::chance, "of it per hold, 0 to 1, from all sides"),
    field("fall_chance", &Hold::fall_chance, "the same of those that upset it"),
    field("place_m", &Hold::place_m,
          "where one of them acts, one that upsets it if any does, metres; of who climbs where "
          "their weight does, and that of drawers, before its front"),
    field("force_N", &Hold::force_N, "that one's force, newtons; none of who falls"),
    field("impulse_Ns", &Hold::impulse_Ns,
          "what the thing takes of who falls against it, newton seconds; else none"));

template <>
inline constexpr auto kind<PossibleThing> = described(
    "PossibleThing", "What was counted as the building and may be a thing by itself.",
    field("primitives", &PossibleThing::primitives, "its parts", Note{.rule = Rule::primitives}),
    field("probability", &PossibleThing::probability, "that it is a thing, 0 to 1"),
    field("spots_m", &PossibleThing::spots_m,
          "a spot amid each of its parts, metres, for corrections", Note{.rule = Rule::finite}),
    field("size_m", &PossibleThing::size_m,
          "its box along the room's axes, the third upright, metres"),
    field("box_middle_m", &PossibleThing::box_middle_m, "the middle of that box, metres"),
    field("mass_kg", &PossibleThing::mass_kg, "kilograms"),
    field("barrier_J", &PossibleThing::barrier_J, "its barrier, joules"),
    field("barrier_error_J", &PossibleThing::barrier_error_J, "one standard error of that"),
    field("risk_J", &PossibleThing::risk_J,
          "by disturbance: expected release per event if it is a thing, joules"),
    field("unsafety_category", &PossibleThing::unsafety_category,
          "the category it would have; none at all: it is not seen what holds it up, or no "
          "disturbance was asked for",
          Note{.one_of = "\"none\", \"low\", \"medium\", \"high\"",
               .whole_null = true,
               .or_none = true}));

template <>
inline constexpr auto kind<Fragility::Step> = described(
    nullptr, "A peak of earthquakes.",
    field("pga_g", &Fragility::Step::pga_g, "peak ground acceleration, in g"),
    field("chance", &Fragility::Step::chance, "share of records and directions in which it fell"));

template <>
inline constexpr auto kind<Overturning> = described(
    "Overturning",
    "What overturns an object slowly: statics of its easiest edge. NaN where it can't tip; errors "
    "are one standard error.",
    field("tilt_deg", &Overturning::tilt_deg,
          "atan(b / h), degrees: the lean from which it goes over", &topple_object::tilt_deg),
    field("tilt_error_deg", &Overturning::tilt_error_deg, "one standard error of that, degrees",
          &topple_object::tilt_error_deg),
    field("direction", &Overturning::direction,
          "horizontal unit vector towards that edge; zeros: any way",
          &topple_object::overturning_direction),
    field("push_N", &Overturning::push_N,
          "M g b / H, newtons: steady level push at its top, height H, that tips it",
          &topple_object::push_N),
    field("push_error_N", &Overturning::push_error_N, "one standard error of that, newtons",
          &topple_object::push_error_N),
    field("slide_N", &Overturning::slide_N,
          "friction x M g, newtons: level push that slides it; if less, it slides first",
          &topple_object::slide_N),
    field("slide_error_N", &Overturning::slide_error_N,
          "one standard error of that, newtons; a coefficient that nobody told is known to a third",
          Note{.since = "slide_error_N"}, &topple_object::slide_error_N),
    field("hand_push_N", &Overturning::hand_push_N,
          "as `push_N`, at a hand's height: 1 m above the floor, its top if lower, its centre if "
          "its support is higher",
          Note{.since = "gust_m_s"}, &topple_object::hand_push_N),
    field("hand_push_error_N", &Overturning::hand_push_error_N,
          "one standard error of that, newtons", Note{.since = "gust_m_s"},
          &topple_object::hand_push_error_N),
    field("hand_height_m", &Overturning::hand_height_m, "that height above its support, metres",
          Note{.since = "gust_m_s"}, &topple_object::hand_height_m),
    field("gust_m_s", &Overturning::gust_m_s,
          "steady gust that is as likely to tip it as not, m/s; NaN: sheltered",
          Note{.since = "gust_m_s"}, &topple_object::gust_m_s),
    field("gust_error_m_s", &Overturning::gust_error_m_s, "one standard error of that, m/s",
          Note{.since = "gust_m_s"}, &topple_object::gust_error_m_s),
    field("shake_g", &Overturning::shake_g,
          "level acceleration at which it begins to rock or slide, in g; falling takes more",
          &topple_object::shake_g));

template <>
inline constexpr auto kind<Fragility> = described(
    "Fragility",
    "How likely an object is to fall in an earthquake. NaN: few fall at the strongest that is "
    "tried.",
    field("pga_g", &Fragility::pga_g,
          "median peak ground acceleration that upsets it, in g; NaN: fewer than half fall at 4 g",
          &topple_object::fragility_pga_g),
    field("pga_dispersion", &Fragility::pga_dispersion,
          "standard deviation of its logarithm; NaN where counts level off below 9 in 10 or begin "
          "above half",
          &topple_object::fragility_pga_dispersion),
    field("firm_pga_g", &Fragility::firm_pga_g, "the same median if its foot can't slide, in g",
          Note{.since = "firm_pga_g"}, &topple_object::fragility_firm_pga_g),
    field("pgv_m_s", &Fragility::pgv_m_s, "median peak ground velocity, m/s",
          &topple_object::fragility_pgv_m_s),
    field("pgv_dispersion", &Fragility::pgv_dispersion, "standard deviation of its logarithm",
          &topple_object::fragility_pgv_dispersion),
    field(
        "counted", &Fragility::counted,
        "of each peak `pga_g`, and `chance`: the share of records and directions in which it fell"),
    field("falls_per_year", &Fragility::falls_per_year,
          "with a hazard curve; NaN without. Where a tenth or more fall at the curve's first peak, "
          "this is a bound",
          &topple_object::falls_per_year),
    field("return_years", &Fragility::return_years,
          "years between falls; NaN without a hazard curve", &topple_object::return_years));

template <>
inline constexpr auto kind<DirectedBarrier> = described(
    "DirectedBarrier",
    "What makes an object fall, by direction: n is towards the azimuth n * 22.5 degrees, clockwise "
    "from the room's y as seen from above. inf: no fall was found that way, which is no promise: "
    "what stands in its way counts as its end, and a drop counts only where a surface was scanned "
    "below.",
    field("height_m", &DirectedBarrier::height_m,
          "heights of blows above its support (`support_height_m`), metres",
          Note{.null = Null::refused}, &topple_object::blow_height_m, &topple_object::blow_heights),
    field("push_J", &DirectedBarrier::push_J,
          "by direction: work of a slow push until it falls, joules", Note{.null = Null::infinity},
          &topple_object::push_barrier_J),
    field("blow_Ns", &DirectedBarrier::blow_Ns,
          "by direction, then height: least level blow that makes it fall, as an impulse, newton "
          "seconds: a mass m at speed v that stays brings m v, up to twice that where it bounces "
          "back",
          Note{.since = "blow_Ns", .null = Null::infinity, .rows = true},
          &topple_object::blow_barrier_Ns),
    field("blow_J", &DirectedBarrier::blow_J,
          "by direction, then height: P² / (2 M) · (1 + (z − h)² / k²), joules: the energy that "
          "this impulse would give to the object if nothing held it; not that of what strikes",
          Note{.null = Null::infinity, .rows = true}, &topple_object::blow_barrier_J),
    field("direction", &DirectedBarrier::direction,
          "horizontal unit vectors, where the push or blow goes; it comes from the opposite side",
          Note{.since = "push_N"}, &topple_object::push_direction),
    field("push_N", &DirectedBarrier::push_N,
          "by direction: steady level push at `hand_height_m`, newtons, at which it begins to turn "
          "over the edge that lies there; inf: none does. Where `slide_N` is less, it slides "
          "before. Empty for what hangs",
          Note{.since = "push_N", .null = Null::infinity}, &topple_object::push_by_direction_N),
    field("push_error_N", &DirectedBarrier::push_error_N,
          "by direction: one standard error of that, newtons",
          Note{.since = "push_N", .null = Null::infinity},
          &topple_object::push_error_by_direction_N));

template <>
inline constexpr auto kind<Why> = described(
    "Why", "Its easiest step out of its pose, that of `barrier_J`.",
    field("azimuth_deg", &Why::azimuth_deg,
          "weakest direction, degrees clockwise from the room's y as seen from above; NaN: none is "
          "easier",
          &topple_object::why_azimuth_deg),
    field("edge_m", &Why::edge_m,
          "the two ends of the edge that it turns over, or of its support's where it slides off, "
          "metres; empty: it rolls",
          Note{.rule = Rule::two_or_none}, &topple_object::why_edge_m,
          &topple_object::why_edge_ends),
    field("W_J", &Why::W_J, "energy that the step takes, joules: `barrier_J`"),
    field("S_J", &Why::S_J, "energy that it can release, joules: `release_J`"),
    field("way_m", &Why::way_m, "metres slid on the support; 0 for other steps",
          &topple_object::why_way_m),
    field("drop_m", &Why::drop_m, "metres fallen beyond where its support ends; 0: it stays on it",
          &topple_object::why_drop_m),
    field("lands_on", &Why::lands_on, "the object below that drop; -1: none",
          Note{.rule = Rule::objects_or_none}, &topple_object::why_lands_on),
    field("stands_on", &Why::stands_on, "the objects that carry it", Note{.rule = Rule::objects},
          &topple_object::stands_on, &topple_object::stands_on_count),
    field("sentence", &Why::sentence, "all of it in words", &topple_object::why));

template <>
inline constexpr auto kind<Fall> = described(
    "Fall",
    "Where an object comes to lie by its easiest way that leads lower, and what that takes along.",
    field("falls", &Fall::falls, "whether any disturbance can upset it", &topple_object::falls),
    field("lands_m", &Fall::lands_m, "about its centre of mass at its first landing, metres",
          &topple_object::lands_m),
    field("drop_m", &Fall::drop_m, "metres fallen from its support to there; 0: it stays on it"),
    field("lands_on", &Fall::lands_on, "the object below that drop; -1: none",
          Note{.rule = Rule::objects_or_none}, &topple_object::lands_on),
    field("leans_on", &Fall::leans_on,
          "the object that stops it on its way; -1: none. The building stops it for good; other "
          "things may give way, so risk counts the full fall",
          Note{.since = "leans_on", .rule = Rule::objects_or_none}),
    field("takes_along", &Fall::takes_along, "objects that then lose half of their support",
          Note{.rule = Rule::objects}),
    field("hits_J", &Fall::hits_J, "energy that it has gathered where it lands, joules",
          Note{.since = "hits_J"}, &topple_object::hits_J),
    field("people_share", &Fall::people_share,
          "share of the walks that pass within 0.3 m of what it sweeps; none: nobody walks, or "
          "nobody was asked for",
          Note{.since = "hits_J", .or_none = true}, &topple_object::people_share));

template <>
inline constexpr auto kind<Advice> = described(
    "Advice", "What would lower an object's risk to what is tolerated.",
    field("kind", &Advice::kind,
          "`\"\"`: nothing is needed; `see`: nothing seen holds it; `check`: look first; `move`: "
          "there is a safer place; `fix`: there is none within 1.5 m, or it is not among the 16 "
          "riskiest",
          Note{.one_of = "\"\", \"see\", \"check\", \"move\", \"fix\""},
          &topple_object::advice_kind),
    field("move_m", &Advice::move_m, "for `move` the smallest that does, horizontal, metres",
          &topple_object::advice_move_m),
    field("risk_J", &Advice::risk_J, "its largest risk then, joules per event; for `check` now",
          &topple_object::advice_risk_J),
    field("hold_N", &Advice::hold_N,
          "for `fix`: horizontal force that a fixing must take, newtons, without a margin",
          &topple_object::hold_N),
    field("hold_height_m", &Advice::hold_height_m,
          "where that acts, metres above its support: its top", &topple_object::hold_height_m),
    field("sentence", &Advice::sentence,
          "in words, with the load rating of straps; empty: nothing is needed",
          &topple_object::advice),
    field("action", &Advice::action,
          "what to do, in agreement with the category: the advice, or that there is no need to "
          "act, or to look; empty for the ground",
          Note{.since = "action"}, &topple_object::action));

template <>
inline constexpr auto kind<Landscape::Pose> = described(
    nullptr, "A stable pose on level ground.",
    field("up", &Landscape::Pose::up,
          "unit vector of the object, as it was scanned, that points up then"),
    field("energy_J", &Landscape::Pose::energy_J,
          "potential energy less that as it was scanned, joules"),
    field("joins_at_J", &Landscape::Pose::joins_at_J,
          "the energy at which its basin joins that of a deeper pose; inf for the deepest"),
    field("joins", &Landscape::Pose::joins, "that deeper pose; -1 for the deepest"),
    field("probability", &Landscape::Pose::probability, "of coming to rest in it when tossed"));

template <>
inline constexpr auto kind<Landscape> =
    described("Landscape",
              "The energy landscape of an object on level ground: its stable poses, by rising "
              "energy. Empty where nothing is known.",
              field("now", &Landscape::now, "the pose in which it was scanned; -1: of the ground"));

template <>
inline constexpr auto kind<Object> = described(
    "Object", "One rigid body: primitives that are fixed to one another.",
    field("id", &Object::id, "its number, and place in the list", Note{.rule = Rule::own_place},
          &topple_object::id),
    field("primitives", &Object::primitives, "its parts", Note{.rule = Rule::primitives},
          &topple_object::primitives, &topple_object::primitive_count),
    field("grounded", &Object::grounded,
          "whether it is the ground: floor, walls and what is fixed to them. It can't fall",
          &topple_object::grounded),
    field("agreement", &Object::agreement,
          "the probability that it is one thing, whole, 0 to 1; 1: the ground, and what "
          "corrections say is one, with all its parts",
          Note{.since = "agreement"}, &topple_object::agreement),
    field("mass_kg", &Object::mass_kg, "kilograms", &topple_object::mass_kg),
    field("mass_model", &Object::mass_model,
          "`solid`; `closed`: furniture of 18 mm boards around `--contents`; `hollow`: a shell, by "
          "a correction; `kind`: as things of its name or size weigh, by `--materials`",
          Note{.since = "mass_model", .one_of = "\"solid\", \"closed\", \"hollow\", \"kind\""},
          &topple_object::mass_model),
    field("center_of_mass_m", &Object::center_of_mass_m, "metres",
          &topple_object::center_of_mass_m),
    field("support_height_m", &Object::support_height_m,
          "how high what it stands on lies along the scene's `up`, metres: a place p is p·`up` − "
          "`support_height_m` above that. NaN: the ground, or not `seen_enough`",
          Note{.since = "support_height_m"}, &topple_object::support_height_m),
    field("center_height_m", &Object::center_height_m,
          "of its centre of mass above that, metres; less than 0 for what hangs",
          Note{.since = "support_height_m"}, &topple_object::center_height_m),
    field("size_m", &Object::size_m, "its box along the room's axes, the third upright, metres",
          Note{.since = "size_m"}, &topple_object::size_m),
    field("box_middle_m", &Object::box_middle_m,
          "the middle of that box, metres; NaN: nothing of it is solid",
          Note{.since = "box_middle_m", .whole_null = true}, &topple_object::box_middle_m),
    field("piece_of", &Object::piece_of,
          "the larger object that it is likelier than not a piece of; -1: none",
          Note{.since = "piece_of", .rule = Rule::objects_or_none}, &topple_object::piece_of),
    field("piece_probability", &Object::piece_probability,
          "that it is a piece of the likeliest larger object that it touches, 0 to 1; 0: there is "
          "none",
          Note{.since = "piece_of"}, &topple_object::piece_probability),
    field("joint_probability", &Object::joint_probability,
          "of the least likely joint at which two parts of it meet, 0 to 1. Below 0.6 it may be "
          "two things",
          Note{.since = "weakest_joint"}, &topple_object::joint_probability),
    field("weakest_joint", &Object::weakest_joint,
          "the two primitives of that joint; -1, -1: it has one part",
          Note{.since = "weakest_joint", .rule = Rule::primitives_or_none},
          &topple_object::weakest_joint),
    field("alternatives", &Object::alternatives,
          "what else it may be, 25 % likely or more, the likelier first",
          Note{.since = "alternatives"}),
    field("inertia_kg_m2", &Object::inertia_kg_m2,
          "tensor about its centre of mass, along the input's axes", Note{.since = "mass_model"},
          &topple_object::inertia_kg_m2),
    field("mass_error_kg", &Object::mass_error_kg,
          "one standard error of the mass, by sensor noise, occluded sides and uncertain "
          "completion, with `--materials` by density, too, not by wrong segmentation. Contents of "
          "closed furniture count from nothing to twice",
          Note{.since = "mass_error_kg"}, &topple_object::mass_error_kg),
    field("center_of_mass_error_m", &Object::center_of_mass_error_m,
          "the same of its centre along each axis, metres", Note{.since = "mass_error_kg"},
          &topple_object::center_of_mass_error_m),
    field("footprint_error_m", &Object::footprint_error_m,
          "the same of where the border of its support lies, metres",
          Note{.since = "mass_error_kg"}, &topple_object::footprint_error_m),
    field("friction", &Object::friction,
          "its coefficient of friction, by its name or a correction; written where it is not the "
          "scene's",
          Note{.since = "friction", .if_any = true}, &topple_object::friction),
    field("barrier_J", &Object::barrier_J,
          "least energy, joules, that moves it out of its place. 0: it falls or rolls by itself",
          &topple_object::barrier_J),
    field("barrier_error_J", &Object::barrier_error_J,
          "one standard error of that; a barrier not above it can't be told from 0. It lacks the "
          "part of a foot that was not seen, which `overturning` has",
          Note{.since = "barrier_error_J"}, &topple_object::barrier_error_J),
    field("release_J", &Object::release_J,
          "energy set free then, joules; 0: nowhere lower. Stronger pushes may release more",
          &topple_object::release_J),
    field("overturning", &Object::overturning, "the figures of statics",
          Note{.since = "overturning"}),
    field("fragility", &Object::fragility, "how strong an earthquake upsets it",
          Note{.since = "fragility"}),
    field("mode", &Object::mode, "its easiest way: `tip`, `slide` or `none`",
          Note{.one_of = "\"tip\", \"slide\", \"none\""}, &topple_object::mode),
    field("direction", &Object::direction, "horizontal unit vector of that way; zeros for `none`",
          &topple_object::direction),
    field("instability", &Object::instability,
          "S(W) as steps `W_J`, `S_J`: the energy that it can release once it was given W, from "
          "its W to the next",
          &topple_object::instability, &topple_object::instability_count),
    field("barrier_by_direction", &Object::barrier_by_direction,
          "the barrier by where a push or a blow goes", Note{.since = "barrier_by_direction"}),
    field("why", &Object::why, "the step of its barrier",
          Note{.python = "why_figures", .since = "why"}),
    field("risk_J", &Object::risk_J, "by disturbance: expected release per event, joules"),
    field("risk_spread_J", &Object::risk_spread_J,
          "by disturbance: the part of `risk_error_J` that is from the sampling of events",
          Note{.since = "fall"}),
    field("risk_error_J", &Object::risk_error_J,
          "by disturbance: one standard error of the risk, from barrier, mass and sampling",
          Note{.since = "unsafety_category"}),
    field("fall_chance", &Object::fall_chance,
          "by disturbance: chance per event, 0 to 1, that it falls", Note{.since = "fall"}),
    field("holds", &Object::holds,
          "what people do to it within their reach; written where somebody does",
          Note{.since = "holds", .if_any = true}),
    field("unsafety", &Object::unsafety,
          "1 (safest) to 10: 1 + 9 log(1 + 999 r / r_max) / log 1000 of its largest risk r. Ranks "
          "this scene only: the worst has 10 however harmless. NaN: not `seen_enough`, or no "
          "disturbance was asked for",
          &topple_object::unsafety),
    field("unsafety_category", &Object::unsafety_category,
          "`none`, `low`, `medium` or `high`, whatever else is in the scene; none at all: not "
          "`seen_enough`, or no disturbance was asked for",
          Note{.since = "unsafety_category",
               .one_of = "\"none\", \"low\", \"medium\", \"high\"",
               .whole_null = true,
               .or_none = true},
          &topple_object::unsafety_category),
    field("unsafety_certain", &Object::unsafety_certain,
          "whether the category is the same at the better end of one standard error, and the "
          "object likelier a whole than a piece of another",
          Note{.since = "unsafety_category"}, &topple_object::unsafety_certain),
    field("seen_enough", &Object::seen_enough,
          "whether the scan shows what holds it up; else it has no rank, and its risks are 0 and "
          "mean nothing",
          Note{.since = "seen_enough"}),
    field("rests_by", &Object::rests_by,
          "how it is held, as the likeliest of: `seen` contacts; `near`, across gaps of up to "
          "three voxels; `leaning`; `hidden`; `none` (no solid); `ground`",
          Note{.since = "seen_enough",
               .one_of = "\"seen\", \"near\", \"leaning\", \"hidden\", \"none\", \"ground\""}),
    field("rest_probability", &Object::rest_probability, "of that way, 0 to 1",
          Note{.since = "seen_enough"}),
    field("fall", &Object::fall, "where it comes to lie", Note{.since = "fall"}),
    field("advice", &Object::advice, "what would lower its risk",
          Note{.python = "advice_figures", .since = "fall"}),
    field("name", &Object::name, "given by a correction; mostly there is none",
          Note{.since = "name", .if_any = true}, &topple_object::name),
    field("corrected", &Object::corrected,
          "numbers of the corrections about it, from 1; mostly there is none",
          Note{.since = "corrected", .rule = Rule::corrections, .if_any = true},
          &topple_object::corrected, &topple_object::corrected_count),
    field("landscape", &Object::landscape,
          "the poses in which it could lie on level ground, and what keeps them apart",
          Note{.elsewhere = true}));

template <>
inline constexpr auto shortcuts<Object> = std::tuple{
    field(
        "why", [](const Object& o) -> const auto& { return o.why.sentence; },
        "why it is as safe as it is, in a sentence"),
    field(
        "drop_m", [](const Object& o) -> const auto& { return o.why.drop_m; },
        "metres that its easiest way leads down beyond its support; 0: it stays on that"),
    field(
        "stands_on", [](const Object& o) -> const auto& { return o.why.stands_on; },
        "the objects that carry it"),
    field(
        "advice", [](const Object& o) -> const auto& { return o.advice.sentence; },
        "what would lower its risk, in a sentence; empty: nothing is needed"),
    field(
        "action", [](const Object& o) -> const auto& { return o.advice.action; },
        "what to do about it, so that it agrees with its category: the advice, or that there is no "
        "need to act, or to look")};

}  // namespace topple
