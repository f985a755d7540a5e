// SPDX-License-Identifier: MIT
#include "cli/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/print.h"
#include "core/listed.h"
#include "io/text.h"
#include "objects/told_sentences.h"
#include "physics/landscape.h"
#include "result/scene_json.h"
#include "safety/action.h"
#include "safety/disturbances.h"
#include "safety/earthquake/fragility.h"
#include "safety/earthquake/intensity.h"
#include "safety/largest_risk.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

constexpr std::size_t rows_shown = 12, sentences_shown = 3;

// By which one acts: the category, within one above none first what is certain to be in it, and
// then the unsafety, which is above 0 and 10 at most. What has no rank comes last.
double urgency_of(const Object& o) {
    const int category = o.unsafety_category == "high"     ? 3
                         : o.unsafety_category == "medium" ? 2
                         : o.unsafety_category == "low"    ? 1
                                                           : 0;
    return 10 * (2 * category + (category > 0 && o.unsafety_certain)) + rank_of(o);
}

// That on which one would act first, and its risk.
std::string worst_text(const Scene& scene) {
    const Object* worst = nullptr;
    for (const Object& o : scene.objects) {
        if (o.grounded || !o.seen_enough || safety::largest_risk(o).kind == nullptr) continue;
        if (worst == nullptr || urgency_of(o) > urgency_of(*worst)) worst = &o;
    }
    if (worst == nullptr) return "nothing is at risk";
    const auto [kind, risk_J] = safety::largest_risk(*worst);
    std::string text = "object " + std::to_string(worst->id);
    if (!worst->name.empty()) text.append(" (").append(io::printable(worst->name)).append(")");
    text.append(", ").append(worst->unsafety_category).append(worst->unsafety_certain ? "" : "?");
    text.append(", ").append(io::two_digits(risk_J)).append(" J per ");
    return text.append(kind->words.event);
}

// Without powers of ten where that is long enough for it.
std::string three_digits(double value) {
    char text[64];
    std::snprintf(text, sizeof(text), "%.3g", value);
    double rounded = 0;
    if (std::abs(value) >= 1000 && std::abs(value) < 1e9 && io::parse_number(text, rounded))
        std::snprintf(text, sizeof(text), "%.0f", rounded);
    return text;
}

// "-": not reckoned.
std::string risk_text(const Object& o, const std::string& disturbance) {
    const auto at = o.risk_J.find(disturbance);
    if (at == o.risk_J.end() || !o.seen_enough) return "-";
    return three_digits(at->second);
}

// Those that this parse reckoned with.
std::vector<const safety::DisturbanceKind*> reckoned_kinds(const Scene& scene) {
    std::vector<const safety::DisturbanceKind*> kinds;
    for (const safety::DisturbanceKind* kind : safety::disturbance_kinds())
        if (std::ranges::any_of(scene.objects,
                                [&](const Object& o) { return o.risk_J.contains(kind->name); }))
            kinds.push_back(kind);
    return kinds;
}

// " (0.31 g, very strong shaking, intensity VII)" of an earthquake's peak; "" of other figures.
std::string shaking_of(std::string_view key, double value) {
    if (key != "pga_m_s2") return "";
    const double in_g = value / physics::gravity;
    std::string text = " (";
    text.append(io::two_digits(in_g)).append(" g, ");
    return text.append(safety::shaking_text(in_g)).append(")");
}

std::string category_text(const Object& o) {
    return o.unsafety_category.empty() ? "-"
                                       : o.unsafety_category + (o.unsafety_certain ? "" : "?");
}

// The lowest unsafety is no risk worth a sentence, where there are others.
bool at_risk(const Object* o) {
    constexpr double printed_as_lowest = 1.05;
    return o->seen_enough && o->unsafety >= printed_as_lowest;
}

// What stands above the columns of risks: no harm to people, but what comes of one event.
std::string risks_text(const Scene& scene) {
    std::vector<std::string> columns, events;
    for (const safety::DisturbanceKind* kind : reckoned_kinds(scene)) {
        columns.emplace_back(kind->words.column);
        std::string event = kind->words.one_event;
        const auto& [key, follows, name, unit] = kind->words.figure;
        const auto figure = scene.events.find(key);
        if (*follows != 0 && figure != scene.events.end())
            event += follows + three_digits(figure->second) + " " + unit +
                     shaking_of(key, figure->second);
        events.push_back(std::move(event));
    }
    if (columns.empty()) return "";
    return listed(columns, "and") +
           " are risks: the energy\n   that it sets free, over all ways, "
           "per event: " +
           listed(events) + ".";
}

// How often it falls where it stands; "" without a hazard curve.
std::string years_text(const Object& o, const Scene& scene) {
    const double years = o.fragility.return_years;
    if (!std::isfinite(years)) return "";
    const auto from = scene.events.find("hazard_from_g");
    if (from != scene.events.end() && safety::falls_below(o.fragility, from->second))
        return " It falls once in at most " + io::two_digits(years) +
               " years: the hazard curve begins at " + io::short_number(from->second) + " g.";
    return " It falls once in about " + io::two_digits(years) + " years.";
}

// Who passes where it lands, with what its largest risk takes it to set free there, but for what
// something stops; "" where that is not known, or it lands softly.
std::string people_text(const Object& o) {
    const Fall& fall = o.fall;
    if (!fall.falls || std::isnan(fall.people_share) || !(fall.hits_J > 0)) return "";
    char text[96];
    std::snprintf(text, sizeof(text),
                  " It lands with %s J; of 100 people who walk through, %.0f pass there.",
                  io::two_digits(fall.leans_on < 0 ? safety::released_J(o) : fall.hits_J).c_str(),
                  100 * fall.people_share);
    return text;
}

// ", 0.08 x 0.2 x 0.21 m": the height last.
std::string size_text(const Object& o) {
    if (!(o.size_m[2] > 0)) return "";
    char text[64];
    std::snprintf(text, sizeof(text), ", %.2g x %.2g x %.2g m", o.size_m[0], o.size_m[1],
                  o.size_m[2]);
    return text;
}

// " (fridge)", where it is named by hand.
std::string name_text(const Object& o) {
    return o.name.empty() ? "" : " (" + io::printable(o.name) + ")";
}

// "The 3 riskiest of the 5 objects whose barrier is ...", or of fewer without an order among one.
// Where nothing upsets some of them they are to be looked at for what their errors leave open.
std::string first_text(std::span<const Object* const> shown, std::size_t of) {
    if (of == 1) return "The one object";
    if (shown.size() == of) return "The " + std::to_string(of) + " objects";
    const std::string count = shown.size() == 1 ? "" : std::to_string(shown.size()) + " ";
    const std::string others = "of the " + std::to_string(of) + " objects";
    if (std::ranges::any_of(shown, [](const Object* o) { return safety::upset_by_nothing(*o); }))
        return "The first " + count + "to look at " + others;
    return "The " + count + "riskiest " + others;
}

// Why the riskiest are what they are: of those whose barrier is above its error, where there are
// any. The others' risk says more about the scan.
void print_sentences(const std::vector<const Object*>& riskiest_first, const Scene& scene) {
    std::vector<const Object*> known, doubtful, unseen;
    for (const Object* o : riskiest_first) {
        auto& group = barrier_within_error(*o) ? doubtful : o->seen_enough ? known : unseen;
        group.push_back(o);
    }
    const bool doubts = known.empty() || (std::ranges::none_of(known, at_risk) &&
                                          std::ranges::any_of(doubtful, at_risk));
    const auto& told = doubts ? doubtful : known;
    if (told.empty()) {
        if (!unseen.empty())
            print("\nNothing was seen to hold what may move here: it has no rank.\n");
        return;
    }
    const auto risky = static_cast<std::size_t>(std::ranges::count_if(told, at_risk));
    const std::size_t shown = std::min(sentences_shown, risky > 0 ? risky : told.size());
    print("\n%s whose barrier is %s its error",
          first_text({told.data(), shown}, told.size()).c_str(), doubts ? "within" : "above");
    if (const std::size_t more = doubtful.size(); !doubts && more > 0)
        print(
            "; that of %zu more is within its error of 0: %s on edge, or the scan hardly shows "
            "%s support",
            more, more == 1 ? "it stands" : "they stand", more == 1 ? "its" : "their");
    if (const std::size_t more = unseen.size(); more > 0)
        print("; %zu more %s no rank, since nothing was seen to hold %s", more,
              more == 1 ? "has" : "have", more == 1 ? "it" : "them");
    print(":\n");
    for (std::size_t i = 0; i < shown; ++i) {
        const Object& o = *told[i];
        const std::string& action = o.advice.action;
        print("Object %d%s%s: %s%s%s%s%s\n", o.id, name_text(o).c_str(), size_text(o).c_str(),
              o.why.sentence.c_str(), people_text(o).c_str(), years_text(o, scene).c_str(),
              action.empty() ? "" : " ", action.c_str());
    }
}

// "0-0.12" of a barrier that can't be told from 0.
std::string barrier_text(const Object& o) {
    if (!barrier_within_error(o)) return three_digits(o.barrier_J);
    char text[32];
    std::snprintf(text, sizeof(text), "0-%.2g", o.barrier_J + o.barrier_error_J);
    return text;
}

void print_objects(const Scene& scene) {
    std::map<std::int32_t, std::string> rests_on;
    for (const Support& s : scene.supports) {
        std::string& text = rests_on[s.supported];
        if (!text.empty()) text.append(",");
        text.append(std::to_string(s.supporter));
    }
    std::vector<const Object*> movable;
    for (const Object& o : scene.objects) {
        if (!o.grounded) movable.push_back(&o);
    }
    std::stable_sort(movable.begin(), movable.end(), [](const Object* a, const Object* b) {
        return urgency_of(*a) > urgency_of(*b);
    });
    const auto kinds = reckoned_kinds(scene);
    print("\n%-12s %8s %8s %8s %9s %9s %6s ", "object", "category", "unsafety", "mass kg",
          "barrier J", "release J", "mode");
    for (const safety::DisturbanceKind* kind : kinds) print("%8s J ", kind->words.column);
    print(" rests on\n");
    for (std::size_t i = 0; i < std::min(rows_shown, movable.size()); ++i) {
        const Object& o = *movable[i];
        char unsafety[32] = "-";
        if (std::isfinite(o.unsafety))
            std::snprintf(unsafety, sizeof(unsafety), "%.1f", o.unsafety);
        const std::string barrier = barrier_text(o);
        print("%-12s %8s %8s %8s %9s %9s %6s ", (std::to_string(o.id) + name_text(o)).c_str(),
              category_text(o).c_str(), unsafety, three_digits(o.mass_kg).c_str(), barrier.c_str(),
              three_digits(safety::released_J(o)).c_str(), o.mode.c_str());
        for (const safety::DisturbanceKind* kind : kinds)
            print("%10s ", risk_text(o, kind->name).c_str());
        print(" %s\n", rests_on.contains(o.id) ? rests_on[o.id].c_str() : "-");
    }
    if (movable.size() > rows_shown)
        print("   ... and %zu more in scene.json\n", movable.size() - rows_shown);
    if (!movable.empty())
        print(
            "   Act from the top: by category, which is how often the thing falls and how hard, at "
            "the worse end of its error\n   (? where the better end says less, or it may be a "
            "piece of another thing), within one what has\n   no ? first, and then by unsafety, "
            "its risk from 1 to 10 within this scene, where 10 is the\n   worst, however "
            "harmless. Barrier and mode are those of the easiest way out of its place, release\n"
            "   that of the falls behind its largest risk. Rests on: 0 is the building. %s\n",
            risks_text(scene).c_str());
    print_sentences(movable, scene);
}

}  // namespace

std::optional<Worst> worst_of(const std::filesystem::path& output) {
    const io::FileName file = io::FileName::in(output, "scene.json");
    if (!file.is_there()) return std::nullopt;
    try {
        return Worst{worst_text(io::read_scene_json(file)), file.path()};
    } catch (const Error&) {
        return std::nullopt;  // of another version, or damaged: nothing to compare with
    }
}

void print_summary(const Scene& scene, const std::filesystem::path& out, double output_s,
                   const std::optional<Worst>& before) {
    double seconds = output_s;
    for (const auto& [stage, s] : scene.timings_s) seconds += s;
    std::size_t grounded = 0, counted = 0;
    for (const Primitive& p : scene.primitives) counted += static_cast<std::size_t>(p.points);
    // Clouds that are parsed in blocks are known by a sample; their parts count all points.
    const char* sample = counted > scene.points.x.size() ? " (samples of the scan)" : "";
    for (const Object& o : scene.objects) grounded += o.grounded;
    print("%s%s, voxels of %.3g cm, %s, %s (%zu fixed to the ground), %s; %.1f s on %s (%s)\n",
          io::counted(scene.points.x.size(), "point").c_str(), sample, 100 * scene.voxel_size_m,
          io::counted(scene.primitives.size(), "primitive").c_str(),
          io::counted(scene.objects.size(), "object").c_str(), grounded,
          io::counted(scene.supports.size(), "support").c_str(), seconds, scene.backend.c_str(),
          scene.device.c_str());
    for (const std::string& note : scene.notes) print("Note: %s\n", note.c_str());
    print_objects(scene);
    if (!scene.corrections.empty()) {
        const std::vector<std::size_t> said = told_sentences(scene.corrections);
        std::vector<bool> held(said.back(), true);
        for (std::size_t n = 0; n < said.size(); ++n)
            held[said[n] - 1] = held[said[n] - 1] && scene.corrections[n].held;
        print("\n%zu of %s held.\n", static_cast<std::size_t>(std::ranges::count(held, true)),
              io::counted(held.size(), "correction").c_str());
    }
    if (before)
        print("Worst before (%s): %s; now: %s.\n", io::path_text(before->of).c_str(),
              before->text.c_str(), worst_text(scene).c_str());
    print("\nReport: %s\n", (out / "report.html").c_str());
}

}  // namespace topple::cli
