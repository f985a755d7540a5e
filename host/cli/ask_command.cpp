// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/print.h"
#include "core/json.h"
#include "core/listed.h"
#include "core/numbered_object.h"
#include "core/vectors.h"
#include "io/json_values.h"
#include "io/text.h"
#include "report/view_data.h"
#include "topple/ask.h"
#include "topple/error.h"
#include "topple/parse.h"
#include "topple/stays.h"

namespace topple::cli {
namespace {

using Steps = std::vector<std::vector<std::int32_t>>;

struct AskArguments {
    std::string parsed, without, before, holds, push, at, spots, releases, energy;
    bool order = false, json = false;
};

// The number of an object; whether there is one the library tells.
std::int32_t object_number(const char* option, std::string_view text) {
    std::uint64_t id = 0;
    if (!io::parse_count(text, id) || id > INT32_MAX)
        throw Error(ErrorKind::usage, std::string(option) + " " + io::printable(text) +
                                          ": expected the number of an object, as tables and the "
                                          "report have it");
    return static_cast<std::int32_t>(id);
}
// "12" or "12,13".
std::vector<std::int32_t> object_numbers(const char* option, std::string_view text) {
    std::vector<std::int32_t> out;
    for (;;) {
        const auto comma = text.find(',');
        out.push_back(object_number(option, text.substr(0, comma)));
        if (comma == std::string_view::npos) return out;
        text.remove_prefix(comma + 1);
    }
}

// A question's answer, in both of its forms.
struct Answer {
    std::string text;
    OrderedJson json;
};

std::string object_text(const Scene& scene, std::int32_t id) {
    return numbered_object(scene.objects[id]);
}
std::string objects_text(const Scene& scene, const std::vector<std::int32_t>& ids) {
    std::vector<std::string> words;
    for (const std::int32_t id : ids) words.push_back(object_text(scene, id));
    return listed(words, "and");
}

std::string unsure_text(const Scene& scene, const std::vector<std::int32_t>& ids) {
    if (ids.empty()) return "";
    return "The scan does not show for sure what holds " + objects_text(scene, ids) +
           ": look first.\n";
}

Answer what_falls(const Scene& scene, const std::vector<std::int32_t>& taken) {
    const FallsWithout without = falls_without(scene, taken);
    Answer out;
    const std::string gone = objects_text(scene, taken);
    out.text = "Without " + gone + ", " +
               (without.falls.empty() ? "nothing else falls.\n"
                                      : io::counted(without.falls.size(), "other object") +
                                            (without.falls.size() == 1 ? " falls:\n" : " fall:\n"));
    for (const Unheld& one : without.falls) out.text += "  " + one.reason + ".\n";
    out.text += unsure_text(scene, without.unsure);
    out.json = {{"schema", "topple.ask/1"},
                {"question", "without"},
                {"objects", taken},
                {"falls", io::list(without.falls,
                                   [](const Unheld& one) {
                                       return OrderedJson{{"object", one.object},
                                                          {"lost", one.lost},
                                                          {"left", one.left},
                                                          {"beyond_m", io::number(one.beyond_m)},
                                                          {"probability", one.probability},
                                                          {"reason", one.reason}};
                                   })},
                {"unsure", without.unsure}};
    return out;
}

// Numbered lines, of a ring that it goes together.
std::string steps_text(const Scene& scene, const Steps& steps) {
    std::string text;
    for (std::size_t n = 0; n < steps.size(); ++n) {
        std::string step = objects_text(scene, steps[n]);
        step[0] = 'O';
        text += "  " + std::to_string(n + 1) + ". " + step;
        if (steps[n].size() > 1) text += " together: each carries the other, or what carries it";
        text += ".\n";
    }
    return text;
}

Answer which_order(const Scene& scene) {
    const Steps steps = removal_steps(scene);
    return {steps.empty() ? "There is nothing that can be taken away.\n"
                          : "An order in which nothing is taken before what it carries:\n" +
                                steps_text(scene, steps),
            {{"schema", "topple.ask/1"}, {"question", "order"}, {"steps", steps}}};
}

Answer what_before(const Scene& scene, std::int32_t object) {
    const Steps steps = removal_steps(scene, object);
    std::vector<std::int32_t> unsure = falls_without(scene, {object}).unsure;
    for (const std::vector<std::int32_t>& step : steps)
        std::erase_if(unsure,
                      [&](std::int32_t id) { return std::ranges::find(step, id) != step.end(); });
    std::string text = steps.size() == 1 && steps.front().size() == 1
                           ? "Nothing has to go before " + object_text(scene, object) + ".\n"
                           : "So that nothing falls when " + object_text(scene, object) +
                                 " is taken away, take in this order:\n" + steps_text(scene, steps);
    return {text + unsure_text(scene, unsure),
            {{"schema", "topple.ask/1"},
             {"question", "before"},
             {"object", object},
             {"steps", steps},
             {"unsure", unsure}}};
}

// "the building, from below on 0.12 m2, 98 % likely"
std::string holder_text(const Scene& scene, const Holder& holder) {
    return (holder.building ? "The building" : "O" + object_text(scene, holder.object).substr(1)) +
           (holder.from_below ? ", from below" : ", not seen to be from below") + ", on " +
           io::two_digits(1e4 * holder.area_m2) + " cm2; " +
           io::two_digits(100 * holder.probability) + " % likely";
}

Answer what_holds(const Scene& scene, std::int32_t object) {
    const std::vector<Holder> holders = held_by(scene, object);
    const Object& o = scene.objects[object];
    Answer out;
    std::string who = object_text(scene, object);
    who[0] = 'O';
    if (holders.empty()) {
        out.text = who + ": the parse has found nothing that holds it.\n";
    } else {
        out.text = who + " is held by:\n";
        for (const Holder& holder : holders) out.text += "  " + holder_text(scene, holder) + ".\n";
    }
    out.text += "How it rests (rests_by): " + o.rests_by + ", " +
                io::two_digits(100 * o.rest_probability) + " % likely" +
                (o.seen_enough ? "" : "; the scan does not show enough of what holds it") + ".\n";
    out.json = {{"schema", "topple.ask/1"},
                {"question", "holds"},
                {"object", object},
                {"held_by", io::list(holders,
                                     [](const Holder& holder) {
                                         return OrderedJson{{"object", holder.object},
                                                            {"building", holder.building},
                                                            {"area_m2", io::number(holder.area_m2)},
                                                            {"probability", holder.probability},
                                                            {"from_below", holder.from_below}};
                                     })},
                {"rests_by", o.rests_by},
                {"rest_probability", io::number(o.rest_probability)},
                {"seen_enough", o.seen_enough}};
    return out;
}

const Object& object_of(const Scene& scene, const char* option, std::int32_t id) {
    if (static_cast<std::size_t>(id) < scene.objects.size()) return scene.objects[id];
    throw Error(ErrorKind::usage, std::string(option) + " " + std::to_string(id) +
                                      ": the parse has " +
                                      io::counted(scene.objects.size(), "object") + ", from 0 on");
}

// At a place, or at the middle of its top.
Answer what_push(const Scene& scene, std::int32_t object, std::optional<Vec3> place_m) {
    const Object& o = object_of(scene, "--push", object);
    const Vec3 at = place_m.value_or(along(o.box_middle_m, o.size_m[2] / 2, scene.up));
    const std::string doubt = why_moves(scene, o, {.place_m = at});
    const double force_N = doubt.empty() ? stays_up_to_N(scene, o, at) : 0;
    std::string who = object_text(scene, object);
    who[0] = 'O';
    Answer out;
    if (o.grounded)
        out.text = who + " is the building, or fixed to it, and stays.\n";
    else if (!doubt.empty())
        out.text = "Nobody knows whether " + object_text(scene, object) +
                   " stays when it is pushed there: " + doubt + ".\n";
    else
        out.text = who + " stays up to a steady push of " + io::two_digits(force_N) + " N at " +
                   io::vector_text(at) + ", to any side. With more, " +
                   why_moves(scene, o, {.place_m = at, .force_N = 1.001 * force_N}) + ".\n";
    out.json = {{"schema", "topple.ask/1"},
                {"question", "push"},
                {"object", object},
                {"place_m", io::vector(at)},
                {"stays_up_to_N", io::number(force_N)},
                {"doubt", doubt}};
    return out;
}

Answer what_released(const Scene& scene, std::int32_t object, double W_J) {
    const Object& o = object_of(scene, "--releases", object);
    const double S_J = released_J(o, W_J);
    std::string who = object_text(scene, object);
    who[0] = 'O';
    return {who + ", given " + io::two_digits(W_J) + " J, " +
                (S_J > 0 ? "may set free up to " + io::two_digits(S_J) + " J.\n"
                         : "sets nothing free.\n"),
            {{"schema", "topple.ask/1"},
             {"question", "releases"},
             {"object", object},
             {"W_J", io::number(W_J)},
             {"S_J", io::number(S_J)}}};
}

// A correction that makes these one thing, whatever a later parse numbers them.
Answer which_spots(const Scene& scene, const std::vector<std::int32_t>& objects) {
    for (const std::int32_t id : objects)
        if (static_cast<std::size_t>(id) >= scene.objects.size() || scene.objects[id].grounded)
            throw Error(ErrorKind::usage,
                        "--spots " + std::to_string(id) +
                            ": expected an object that is not the building, below " +
                            std::to_string(scene.objects.size()));
    const report::PackedView view = report::pack_view(
        scene, {.voxels = std::numeric_limits<std::size_t>::max(), .points = 0, .arrows = 0});
    OrderedJson spots = OrderedJson::array();
    for (std::size_t g = 0; g < view.groups.size(); ++g)
        if (view.spots[g] && std::ranges::find(objects, view.groups[g].second) != objects.end())
            spots.push_back(io::vector(*view.spots[g]));
    const OrderedJson correction{{"do", "one_thing"}, {"at_m", spots}};
    return {correction.dump() + "\n",
            {{"schema", "topple.ask/1"},
             {"question", "spots"},
             {"objects", objects},
             {"correction", correction}}};
}

// Numbers are read before the scene, which takes longer.
using Question = std::function<Answer(const Scene&)>;
Question question_of(const AskArguments& a) {
    const auto given = [](const std::string& text) { return text.empty() ? 0 : 1; };
    if (given(a.without) + given(a.before) + given(a.holds) + given(a.push) + given(a.spots) +
            given(a.releases) + (a.order ? 1 : 0) !=
        1)
        throw Error(ErrorKind::usage,
                    "ask: expected one question: --without, --order, --before, --holds, --push, "
                    "--releases or --spots");
    if (given(a.releases) != given(a.energy))
        throw Error(ErrorKind::usage,
                    "ask: --releases N and --energy JOULES go together: what object N may set "
                    "free once it is given that energy");
    if (given(a.releases)) {
        double W_J = 0;
        if (!io::parse_number(a.energy, W_J) || !(W_J >= 0))
            throw Error(ErrorKind::usage,
                        "--energy " + io::printable(a.energy) + ": expected joules, 0 or more");
        return [id = object_number("--releases", a.releases), W_J](const Scene& scene) {
            return what_released(scene, id, W_J);
        };
    }
    if (given(a.at) && !given(a.push))
        throw Error(ErrorKind::usage, "--at: it is of a push; give --push, too");
    if (given(a.push)) {
        std::optional<Vec3> at;
        if (given(a.at)) at = parse_vector("--at", a.at, "a place X,Y,Z, metres");
        return [id = object_number("--push", a.push), at](const Scene& scene) {
            return what_push(scene, id, at);
        };
    }
    if (a.order) return which_order;
    if (given(a.spots))
        return [ids = object_numbers("--spots", a.spots)](const Scene& scene) {
            return which_spots(scene, ids);
        };
    if (!a.without.empty())
        return [ids = object_numbers("--without", a.without)](const Scene& scene) {
            return what_falls(scene, ids);
        };
    if (!a.before.empty())
        return [id = object_number("--before", a.before)](const Scene& scene) {
            return what_before(scene, id);
        };
    return [id = object_number("--holds", a.holds)](const Scene& scene) {
        return what_holds(scene, id);
    };
}

int run_ask(const AskArguments& a) {
    const Question question = question_of(a);
    const Answer answer = question(read_outputs(a.parsed).scene);
    if (a.json)
        std::fputs(
            (answer.json.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n").c_str(),
            stdout);
    else
        print("%s", answer.text.c_str());
    return 0;
}

}  // namespace

Command add_ask(CLI::App& app) {
    auto a = std::make_shared<AskArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    app.add_option("--without", a->without,
                   "What falls if object N is taken away, or several: N,N,...");
    app.add_flag("--order", a->order, "An order in which everything can be taken away");
    app.add_option("--before", a->before,
                   "What has to go before object N, so that nothing falls with it");
    app.add_option("--holds", a->holds, "What holds object N, and how likely");
    app.add_option("--push", a->push,
                   "Up to which steady push object N stays, to any side, and what then happens");
    app.add_option("--at", a->at, "Where it is pushed, X,Y,Z in metres (default: its top)");
    app.add_option("--releases", a->releases,
                   "What object N may set free once it is given an energy: S(W)");
    app.add_option("--energy", a->energy, "That energy W, joules");
    app.add_option("--spots", a->spots,
                   "A correction that makes objects N,N,... one thing, by a spot of each part");
    app.add_flag("--json", a->json, "Print JSON, not sentences");
    return [a] { return run_ask(*a); };
}

}  // namespace topple::cli
