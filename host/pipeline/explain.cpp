// SPDX-License-Identifier: MIT
#include "pipeline/explain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "io/text.h"
#include "physics/fall_sweep.h"
#include "safety/disturbances.h"

namespace topple {
namespace {

std::string length(double metres) {
    return metres < 0.1 ? io::two_digits(100 * metres) + " cm" : io::two_digits(metres) + " m";
}
std::string energy(double joules) {
    return joules < 0.01 && joules > 5e-7 ? io::two_digits(1000 * joules) + " mJ"
                                          : io::two_digits(joules) + " J";
}

std::string compass(double azimuth_deg) {
    constexpr std::array names{"north", "north-east", "east", "south-east",
                               "south", "south-west", "west", "north-west"};
    return names[static_cast<std::size_t>(std::lround(azimuth_deg / 45)) % names.size()];
}

double azimuth(const Vec3& way) {
    const double degrees = std::atan2(way[0], way[1]) * 180 / std::numbers::pi;
    return degrees < 0 ? degrees + 360 : degrees;
}

// "object 3", or "object 3 (fridge)".
std::string numbered_object(const Object& o) {
    const std::string text = "object " + std::to_string(o.id);
    return o.name.empty() ? text : text + " (" + o.name + ")";
}

std::string what(const Scene& scene, const SolidParts& parts, std::int32_t primitive) {
    if (primitive < 0) return "what lies below";
    const auto at = static_cast<std::size_t>(primitive);
    const Object& object = scene.objects[static_cast<std::size_t>(scene.primitives[at].object)];
    if (!object.grounded) return numbered_object(object);
    switch (parts.solids->role(primitive)) {
        case Role::floor:
            return "the floor";
        case Role::wall:
            return "a wall";
        case Role::ceiling:
            return "the ceiling";
        default:
            return "what is built in";
    }
}

class Sentence {
  public:
    Sentence(const Scene& scene, const SolidParts& parts, const StableObject& from,
             const Object& object)
        : scene_(scene), parts_(parts), from_(from), object_(object), why_(object.why) {}

    std::string text() const {
        if (object_.grounded) return "It is the ground, or fixed to it: it can't fall.";
        if (!from_.seen_enough()) {
            return "The scan does not show what holds it up: it is taken to stand there, and is "
                   "not ranked.";
        }
        if (object_.mode == "slide") return slides();
        return tips();
    }

  private:
    std::string slides() const {
        if (!(why_.way_m > 0)) {
            return "Its centre of mass is past the edge of what carries it: " + falls() +
                   released();
        }
        const std::string off = why_.stands_on.size() == 1 ? carrier() : "what carries it";
        return "Slides " + to() + "off " + off + " at " + barrier() + ", over " +
               length(why_.way_m) + "; " + falls() + released();
    }
    std::string tips() const {
        const bool stands = from_.tipping.margin_m > 0;
        std::string text;
        if (!why_.edge_m.empty() && !stands && why_.W_J > 0) {
            // It would come to rest no lower there: the first step that releases is another one.
            text = "Its centre of mass is " + length(-from_.tipping.margin_m) +
                   " beyond the edge of what is seen to carry it, but falling there it would rest "
                   "no lower. Tips over its " +
                   edge() + " at " + barrier();
        } else if (!why_.edge_m.empty() && !stands) {
            text = "Falls " + to() + "as it stands: its centre of mass is " +
                   length(-from_.tipping.margin_m) + " beyond the edge of what carries it";
        } else if (!why_.edge_m.empty()) {
            text = "Tips over its " + edge() + " at " + barrier();
        } else {
            text = "Rolls or turns " + to() + "by itself";
        }
        if (!(object_.release_J > 0))
            return text + ", but then rests no lower: it releases nothing.";
        text += "; ";
        return text + (why_.drop_m > 0 ? falls() : "comes to rest lower") + released();
    }
    std::string carrier() const {
        const Object& on = scene_.objects[static_cast<std::size_t>(why_.stands_on[0])];
        return on.grounded ? "the ground" : numbered_object(on);
    }
    std::string barrier() const {
        if (!barrier_within_error(object_)) return energy(why_.W_J);
        return "between 0 and " + energy(object_.barrier_J + object_.barrier_error_J);
    }
    std::string to() const {
        return std::isnan(why_.azimuth_deg) ? "" : "to the " + compass(why_.azimuth_deg) + " ";
    }
    // An edge no longer than a voxel or two is a corner, or one of a round thing's many.
    std::string edge() const {
        const std::string side =
            std::isnan(why_.azimuth_deg) ? "" : compass(why_.azimuth_deg) + " ";
        const Vec3 &a = why_.edge_m[0], &b = why_.edge_m[1];
        const double size = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        if (size <= 2.5 * scene_.voxel_size_m) return side + "rim";
        return side + "edge, " + length(size) + " long,";
    }
    std::string falls() const {
        return "falls " + length(why_.drop_m) + " to " +
               what(scene_, parts_, from_.instability.onto);
    }
    std::string released() const { return " and releases " + energy(why_.S_J) + "."; }

    const Scene& scene_;
    const SolidParts& parts_;
    const StableObject& from_;
    const Object& object_;
    const Why& why_;
};

}  // namespace

void explain(const SolidParts& parts, const ObjectStage& objects, const ToInput& to_input,
             Scene& scene) {
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        const StableObject& from = objects.objects[o];
        Object& object = scene.objects[o];
        Why& why = object.why;
        if (!from.grounded) {
            const physics::Instability& step = from.instability;
            if (step.weakest != Vec3{}) why.azimuth_deg = azimuth(step.weakest);
            if (step.edge) why.edge_m = {to_input((*step.edge)[0]), to_input((*step.edge)[1])};
            why.W_J = object.barrier_J;
            why.S_J = object.release_J;
            if (object.mode == "slide") why.way_m = from.sliding.distance_m;
            why.drop_m = step.drop_m;
            if (step.drop_m > 0 && step.onto >= 0)
                why.lands_on = objects.object_of_primitive[static_cast<std::size_t>(step.onto)];
        }
        why.sentence = Sentence(scene, parts, from, object).text();
    }
}

namespace {

// Of two pieces that carry each other the lighter one is no support of the heavier.
bool carried_back(const Scene& scene, const std::vector<std::vector<Support>>& holders,
                  const Support& s) {
    const auto by = static_cast<std::size_t>(s.supporter),
               on = static_cast<std::size_t>(s.supported);
    if (scene.objects[by].grounded || scene.objects[by].mass_kg >= scene.objects[on].mass_kg)
        return false;
    return std::ranges::any_of(holders[by],
                               [&](const Support& back) { return back.supporter == s.supported; });
}

// What goes along with object o: what has lost half of its support with it, and with what went
// along before. Ascending.
std::vector<std::int32_t> taken_along(const Scene& scene,
                                      const std::vector<std::vector<Support>>& holders,
                                      std::size_t o) {
    std::vector<bool> gone(scene.objects.size());
    gone[o] = true;
    for (bool more = true; more;) {
        more = false;
        for (std::size_t x = 0; x < holders.size(); ++x) {
            if (gone[x] || scene.objects[x].grounded) continue;
            double all = 0, lost = 0;
            for (const Support& s : holders[x]) {
                if (carried_back(scene, holders, s)) continue;
                all += s.area_m2;
                if (gone[static_cast<std::size_t>(s.supporter)]) lost += s.area_m2;
            }
            if (lost > 0 && 2 * lost >= all) gone[x] = more = true;
        }
    }
    gone[o] = false;
    std::vector<std::int32_t> out;
    for (std::size_t x = 0; x < gone.size(); ++x) {
        if (gone[x]) out.push_back(static_cast<std::int32_t>(x));
    }
    return out;
}

constexpr double light_kg = 5;  // one carries it away rather than fastens it

std::string joules(double value) {
    return value < 0.0005 ? "nothing" : energy(value) + " per event";
}

// Against what brings it the most risk, the first of equals.
std::string mend_of(const Object& object) {
    const auto kinds = safety::disturbance_kinds();
    const auto risk = [&](const safety::DisturbanceKind* kind) {
        const auto at = object.risk_J.find(kind->name);
        return at == object.risk_J.end() ? 0.0 : at->second;
    };
    return (*std::ranges::max_element(kinds, {}, risk))->words.mend;
}

std::string fix_sentence(const Object& object, const Suggestion& what) {
    std::string text;
    if (what.places == Suggestion::Places::none)
        text = "What stands around it leaves no room to move it. ";
    if (what.places == Suggestion::Places::unsafe)
        text = "No place nearby on what carries it is safe enough. ";
    if (object.mass_kg < light_kg) {
        text += "Put it elsewhere, or fasten it";
    } else {
        text += mend_of(object);
    }
    if (!(what.hold.force_N > 0)) return text + ".";
    return text + ": the fixing must hold " + io::two_digits(what.hold.force_N) + " N at " +
           length(what.hold.height_m) + " above what it stands on.";
}

std::string advice_sentence(const Object& object, const Suggestion& what) {
    double worst = 0;
    for (const auto& [name, risk] : object.risk_J) worst = std::max(worst, risk);
    switch (what.kind) {
        case Suggestion::Kind::nothing:
            break;
        case Suggestion::Kind::see:
            return "See what holds it: the scan does not show it, and its risk is not known.";
        case Suggestion::Kind::check:
            return "Look whether it stands firm: what the scan shows of its support would hardly "
                   "hold it, and its risk follows from that.";
        case Suggestion::Kind::move: {
            std::string text = "Move it " + length(std::hypot(what.move_m[0], what.move_m[1])) +
                               " to the " + compass(azimuth(what.move_m));
            if (!object.fall.takes_along.empty()) text += ", with what stands on it";
            return text + ": its risk falls from " + joules(worst) + " to " + joules(what.risk_J) +
                   ".";
        }
        case Suggestion::Kind::fix:
            return fix_sentence(object, what);
    }
    return "";
}

}  // namespace

void foretell(const ObjectStage& objects, const SafetyStage& safety, const ToInput& to_input,
              Scene& scene) {
    std::vector<std::vector<Support>> holders(scene.objects.size());  // of each object
    for (const Support& s : scene.supports)
        holders[static_cast<std::size_t>(s.supported)].push_back(s);
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        Object& object = scene.objects[o];
        const StableObject& from = objects.objects[o];
        object.fall.lands_m = object.center_of_mass_m;
        if (from.grounded) continue;
        object.fall.takes_along = taken_along(scene, holders, o);
        for (const auto& [name, chance] : object.fall_chance)
            object.fall.falls = object.fall.falls || chance > 0;
        const physics::Swept& swept = safety.landings[o].swept;
        object.fall.hits_J = safety.landings[o].hits_J;
        if (o < safety.people_share.size()) object.fall.people_share = safety.people_share[o];
        object.fall.lands_m = to_input(swept.center);
        object.fall.drop_m = swept.stopped ? 0 : object.why.drop_m;
        object.fall.lands_on = swept.stopped ? -1 : object.why.lands_on;
        if (swept.by >= 0)
            object.fall.leans_on = objects.object_of_primitive[static_cast<std::size_t>(swept.by)];
        // What stops it is not taken along.
        std::erase(object.fall.takes_along, object.fall.leans_on);
        const Suggestion& what = safety.advice[o];
        static constexpr std::array kinds{"", "see", "check", "move", "fix"};
        object.advice.kind = kinds[static_cast<std::size_t>(what.kind)];
        object.advice.move_m = to_input(what.move_m);
        object.advice.risk_J = what.risk_J;
        object.advice.hold_N = what.hold.force_N;
        object.advice.hold_height_m = what.hold.height_m;
        object.advice.sentence = advice_sentence(object, what);
    }
}

}  // namespace topple
