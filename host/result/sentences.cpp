// SPDX-License-Identifier: MIT
#include "result/sentences.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

#include "core/listed.h"
#include "core/numbered_object.h"
#include "core/object_name.h"
#include "io/length_text.h"
#include "io/text.h"
#include "physics/drop.h"
#include "result/explanations.h"
#include "safety/action.h"
#include "safety/disturbances.h"
#include "safety/largest_risk.h"

namespace topple {
namespace {

std::string energy(double joules) {
    return joules < 0.01 && joules > 5e-7 ? io::two_digits(1000 * joules) + " mJ"
                                          : io::two_digits(joules) + " J";
}

std::string compass(double azimuth_deg) {
    constexpr std::array names{"north", "north-east", "east", "south-east",
                               "south", "south-west", "west", "north-west"};
    return names[static_cast<std::size_t>(std::lround(azimuth_deg / 45)) % names.size()];
}

constexpr const char* floor = "the floor";
constexpr double step_m = 0.05;  // a floor that is lower by less is the same one, not quite level

// What a primitive is to those in the room; of the building, which part of it.
std::string what(const Scene& scene, const SolidParts& parts, std::int32_t primitive) {
    if (primitive < 0) return "what is there";
    const auto at = static_cast<std::size_t>(primitive);
    const Object& object = scene.objects[scene.primitives[at].object];
    if (!object.grounded) return numbered_object(object);
    switch (parts.solids->role(primitive)) {
        case Role::floor:
            return floor;
        case Role::wall:
            return "a wall";
        case Role::ceiling:
            return "the ceiling";
        default:
            return "what is built in";
    }
}

struct Sentence {
    const Scene& scene;
    const SolidParts& parts;
    const ObjectStage& objects;
    const Landing& landing;
    std::size_t o;
    const physics::Swept& swept = landing.easiest;
    const Body& from = objects.objects[o];
    const Object& object = scene.objects[o];
    const Why& why = object.why;

    std::string text() const {
        if (object.grounded) {
            return "It is counted as the building, or as fixed to it, and is not judged here: what "
                   "of it is furniture has to be told.";
        }
        if (!from.seen_enough()) {
            return "The scan does not show what holds it up: it is taken to stand there, and is "
                   "not ranked.";
        }
        return (object.mode == "slide" ? slides() : tips()) + held() + foot() + otherwise();
    }

    // " Children or toddlers who pull at it or climb it upset it."
    std::string held() const {
        std::vector<std::string> people, acts;
        const auto add = [](std::vector<std::string>& to, const std::string& word) {
            if (std::ranges::find(to, word) == to.end()) to.push_back(word);
        };
        for (const Hold& hold : object.holds) {
            if (!(hold.fall_chance > 0)) continue;
            add(people, hold.by);
            add(acts, hold.act == "pull"    ? "pull at it"
                      : hold.act == "climb" ? "climb it"
                                            : "lean on it");
        }
        if (people.empty()) return "";
        std::string text = topple::listed(people) + " who " + topple::listed(acts) + " upset it.";
        text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
        return " " + text;
    }

    // Which is more than what was seen of it.
    std::string foot() const {
        return from.unseen_margin_m > 0 && barrier_within_error(object)
                   ? " Part of its foot, as a leg, may stand where nobody saw in."
                   : "";
    }
    // What it may be else: where that is about as likely, or changes its category.
    std::string otherwise() const {
        std::string text;
        for (const Alternative& other : object.alternatives) {
            const bool whole = other.whole >= 0;
            const bool changes = !other.unsafety_category.empty() &&
                                 other.unsafety_category != object.unsafety_category;
            if (!changes && !(whole ? object.piece_of >= 0 : from.weakest.doubtful())) continue;
            const std::string likely =
                " (" + io::two_digits(100 * other.probability) + " % likely)";
            text += whole ? " It may be a piece of " + numbered_object(scene.objects[other.whole]) +
                                likely
                          : " It may be two things" + likely + ": look whether its parts " +
                                std::to_string(object.weakest_joint[0]) + " and " +
                                std::to_string(object.weakest_joint[1]) + " are one";
            if (changes)
                text += (whole ? "; both together take " : "; one of them takes ") +
                        energy(other.barrier_J) + " and would be \"" + other.unsafety_category +
                        "\"";
            text += ".";
        }
        return text;
    }
    std::string slides() const {
        if (!(why.way_m > 0)) {
            return "Its centre of mass is past the edge of what carries it: it falls " + dropped() +
                   " and releases " + energy(why.S_J) + ".";
        }
        const std::string off = carrier();
        if (off == floor && what(scene, parts, from.instability.onto) == floor &&
            why.drop_m < step_m) {
            return "Slides " + to() + "on the floor at " + barrier() + ", over " +
                   io::length_text(why.way_m) + ", to where it stands " +
                   io::length_text(why.drop_m) + " lower, and releases " + energy(why.S_J) + ".";
        }
        return "Slides " + to() + "off " + off + " at " + barrier() + ", over " +
               io::length_text(why.way_m) + "; falls " + dropped() + " and releases " +
               energy(why.S_J) + ".";
    }
    std::string tips() const {
        const bool stands = from.tipping.margin_m > 0;
        std::string text;
        if (!why.edge_m.empty() && !stands && why.W_J > 0) {
            // It would come to rest no lower there: the first step that releases is another one.
            text = "Its centre of mass is " + io::length_text(-from.tipping.margin_m) +
                   " beyond the edge of what is seen to carry it, but falling there it would rest "
                   "no lower. Tips over its " +
                   edge() + " at " + barrier();
        } else if (!why.edge_m.empty() && !stands) {
            text = "Falls " + to() + "as it stands: its centre of mass is " +
                   io::length_text(-from.tipping.margin_m) + " beyond the edge of what carries it";
        } else if (!why.edge_m.empty()) {
            text = "Tips over its " + edge() + " at " + barrier();
        } else {
            text = "Rolls or turns " + to() + "by itself";
        }
        if (!(object.release_J > 0)) {
            text += landing.for_good ? ", but leans on " + stop() + " before it has come so far"
                                     : ", but then rests no lower";
            text += ": it releases nothing.";
            const std::string harder = harder_way();
            if (harder.empty()) return text;
            return harder + io::lower_case(text.substr(0, 1)) + text.substr(1);
        }
        if (swept.stopped) return text + leans();
        return text + "; " + (why.drop_m > 0 ? "falls " + dropped() : "comes to rest lower") +
               " and releases " + energy(why.S_J) + ".";
    }
    // What more energy sets free, which its risk reckons with, before the easiest way.
    std::string harder_way() const {
        const auto first = std::ranges::find_if(
            object.instability, [](const InstabilityStep& step) { return step.S_J > 0; });
        if (first == object.instability.end()) return "";
        return "With " + energy(first->W_J) + " or more it may fall and release up to " +
               energy(object.instability.back().S_J) + ". The easiest way: ";
    }
    std::string stop() const { return what(scene, parts, swept.by); }
    // Against anything else its release and risk are those of a fall with room.
    std::string leans() const {
        std::string text =
            "; comes to lean on " + stop() + ", with " + energy(object.fall.hits_J) + ".";
        if (landing.for_good) return text;
        return text + " If that gave way it would " +
               (why.drop_m > 0 ? "fall " + dropped() : "come to rest lower") + " and release " +
               energy(why.S_J) + ", which its risk reckons with.";
    }
    // What it slides off. Of the building the part that carries most of it.
    std::string carrier() const {
        if (why.stands_on.size() != 1) return "what carries it";
        const Object& on = scene.objects[why.stands_on[0]];
        if (!on.grounded) return numbered_object(on);
        const auto object_of = [&](std::int32_t p) {
            return p < 0 ? -1 : objects.object_of_primitive[p];
        };
        const graph::Carrying* most = nullptr;
        for (const graph::Carrying& c : objects.contacts.carryings) {
            if (object_of(c.supported) == object.id && object_of(c.supporter) == on.id &&
                (!most || c.area_m2 > most->area_m2))
                most = &c;
        }
        return most ? what(scene, parts, most->supporter) : "what carries it";
    }
    std::string barrier() const {
        if (!barrier_within_error(object)) return energy(why.W_J);
        return "between 0 and " + energy(object.barrier_J + object.barrier_error_J);
    }
    std::string to() const {
        return std::isnan(why.azimuth_deg) ? "" : "to the " + compass(why.azimuth_deg) + " ";
    }
    // An edge no longer than a voxel or two is a corner, or one of a round thing's many.
    std::string edge() const {
        const std::string side = std::isnan(why.azimuth_deg) ? "" : compass(why.azimuth_deg) + " ";
        const Vec3 &a = why.edge_m[0], &b = why.edge_m[1];
        const double size = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        if (size <= 2.5 * scene.voxel_size_m) return side + "rim";
        return side + "edge, " + io::length_text(size) + " long,";
    }
    std::string dropped() const {
        return io::length_text(why.drop_m) + " to " + what(scene, parts, from.instability.onto);
    }
};

constexpr double light_kg = 5;  // one carries it away rather than fastens it
// What people move about a room by its nature, whatever it weighs.
bool is_moved_about(const std::string& name) {
    constexpr const char* words[] = {
        "chair",  "armchair", "stool", "bench",    "sofa",     "couch",  "table",  "desk",
        "bed",    "cot",      "bag",   "suitcase", "bin",      "basket", "crate",  "box",
        "carton", "trolley",  "cart",  "bicycle",  "bike",     "toy",    "walker", "wheelchair",
        "pram",   "stroller", "plant", "rug",      "mattress", "person"};
    return std::ranges::any_of(words, [&](const char* word) { return name_has(name, word); });
}
// What one person lifts (NIOSH lifting equation, 1991: 23 kg at best), and gets hold of: a chair, a
// stool. Nobody bolts these to a floor.
constexpr double carried_kg = 23, carried_m = 1.2;
bool is_carried(const Object& object) {
    return object.mass_kg <= carried_kg && std::ranges::max(object.size_m) <= carried_m;
}

std::string joules(double value) {
    return value < 0.0005 ? "nothing" : energy(value) + " per event";
}

// Against what brings it the most risk, the first of equals; where no wall is within reach, to what
// it stands on.
const safety::DisturbanceWords& worst_words(const Object& object) {
    const safety::DisturbanceKind* worst = safety::largest_risk(object).kind;
    return (worst != nullptr ? worst : safety::disturbance_kinds().front())->words;
}
std::string mend_of(const Object& object, const Fastening& to) {
    const safety::DisturbanceWords& words = worst_words(object);
    if (!to.wall && to.floor) return words.free_mend;
    return to.wall || std::string_view(words.mend).find("the wall") == std::string_view::npos
               ? words.mend
               : "Fasten it to what carries it";
}

// The least of 1, 2, 5, 10, 20, ... kilograms whose weight is no less than the force: how straps
// and brackets are sold.
std::string rated_for(double force_N) {
    const double kg = force_N / physics::gravity;
    double decade = 1;
    while (10 * decade < kg) decade *= 10;
    for (const double step : {1, 2, 5})
        if (step * decade >= kg) return io::short_number(step * decade) + " kg";
    return io::short_number(10 * decade) + " kg";
}

// What is to be held at least, rounded up: "154", "2.8".
std::string at_least_N(double force_N) {
    const double steps = force_N < 10 ? 10 : 1;
    return io::two_digits(std::ceil(force_N * steps - 1e-9) / steps);
}

// What nobody lifts alone: the guideline of the British Health and Safety Executive (INDG143) for
// men at the best height.
std::string with_help(const Object& object) {
    constexpr double alone_kg = 25;
    return object.mass_kg > alone_kg ? ", with somebody's help" : "";
}

std::string fix_sentence(const Object& object, const Suggestion& what) {
    constexpr double one_strap_m = 1;  // what is wider turns about a single one; set by hand
    constexpr double high_m = 0.3;     // of where a fall begins; set by hand
    constexpr double shelf_m = 0.35;   // what is wider is put on no shelf; set by hand
    constexpr double craft_N = 2000;   // what no bracket of a shop is rated for; set by hand
    const bool light = object.mass_kg < light_kg, bolted = !what.fasten.wall && what.fasten.floor;
    if (what.leg_of < 0 && is_carried(object) && object.fall.drop_m >= high_m)
        return std::string(worst_words(object).high_mend) + ": from here it falls " +
               io::length_text(object.fall.drop_m) + ".";
    if ((bolted && !light && is_carried(object)) || is_moved_about(object.name))
        return "Move it to where nobody passes and it stands level, or take it out" +
               with_help(object) + ".";
    std::string text = mend_of(object, what.fasten);
    if (what.hold.force_N > craft_N)
        text =
            "Ask someone who does such work: " + io::lower_case(text.substr(0, 1)) + text.substr(1);
    const bool large = *std::ranges::max_element(object.size_m) > shelf_m;
    if (light)
        text = what.leg_of >= 0 ? "Fasten it"
               : large          ? worst_words(object).large_mend
                                : worst_words(object).light_mend;
    if (!(what.hold.force_N > 0)) return text + ".";
    const safety::DisturbanceKind* kind = safety::find_disturbance_kind(what.hold_against);
    const std::string holds = at_least_N(what.hold.force_N) + " N sideways at least" +
                              (kind ? std::string(", ") + kind->words.push : "") +
                              ", without a margin";
    const std::string where =
        "at its top, " + io::length_text(what.hold.height_m) + " above what it stands on";
    if (bolted && !light) return text + ": " + where + ", it must be held against " + holds + ".";
    const std::string rated = "rated for " + rated_for(what.hold.force_N) + " or more (";
    if (what.fasten.wall && std::max(object.size_m[0], object.size_m[1]) > one_strap_m)
        return text + ", with two straps or brackets, at studs of the wall, each " + rated +
               "together they must hold " + holds + "), " + where + ".";
    return text + ", with a strap or bracket " + rated + "it must hold " + holds + "), " + where +
           ".";
}

std::string plain_advice(const Object& object, const Suggestion& what) {
    switch (what.kind) {
        case Suggestion::Kind::nothing:
            break;
        case Suggestion::Kind::see:
            return "See what holds it: the scan does not show it, and its risk is not known.";
        case Suggestion::Kind::check:
            return "Look whether it stands firm: what the scan shows of its support would hardly "
                   "hold it, and its risk follows from that.";
        case Suggestion::Kind::move: {
            std::string text = "Move it " +
                               io::length_text(std::hypot(what.move_m[0], what.move_m[1])) +
                               " to the " + compass(azimuth_deg(what.move_m));
            if (!object.fall.takes_along.empty()) text += ", with what stands on it";
            return text + with_help(object) + ": its risk falls from " +
                   joules(safety::largest_risk(object).risk_J) + " to " + joules(what.risk_J) + ".";
        }
        case Suggestion::Kind::fix:
            return fix_sentence(object, what);
    }
    return "";
}

std::string advice_sentence(const Scene& scene, const Object& object, const Suggestion& what) {
    std::string text = plain_advice(object, what);
    if (what.leg_of < 0 || text.empty()) return text;
    const Object& top = scene.objects[what.leg_of];
    return "Look first: this may be a leg of " + numbered_object(top) +
           ". If it is none: " + io::lower_case(text.substr(0, 1)) + text.substr(1);
}

}  // namespace

void write_reasons(const SolidParts& parts, const ObjectStage& objects,
                   std::span<const Landing> landings, Scene& scene) {
    const Landing free{};
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        const Landing& landing = o < landings.size() ? landings[o] : free;
        scene.objects[o].why.sentence = Sentence{scene, parts, objects, landing, o}.text();
    }
}

void write_advice(std::span<const Suggestion> suggestions, Scene& scene) {
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        Object& object = scene.objects[o];
        if (object.grounded) continue;
        object.advice.sentence = advice_sentence(scene, object, suggestions[o]);
        object.advice.action = safety::action_text(scene, object);
    }
}

}  // namespace topple
