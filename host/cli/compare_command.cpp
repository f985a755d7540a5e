// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/print.h"
#include "compare/comparison_json.h"
#include "core/numbered_object.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "topple/compare.h"

namespace topple::cli {
namespace {

struct CompareArguments {
    std::string a, b, out;
};

std::string metres(double m) {
    return io::two_digits(m) + " m";
}

// "object 12 (lamp), 0.2 x 0.2 x 0.5 m"
std::string sized(const Scene& scene, std::int32_t id) {
    const Object& object = scene.objects[static_cast<std::size_t>(id)];
    std::string out = numbered_object(object) + ",";
    for (std::size_t n = 0; n < 3; ++n)
        out += (n > 0 ? " x " : " ") + io::two_digits(object.size_m[n]);
    return out + " m";
}

// What became of it, or nothing where there is nothing to say.
std::string line_of(const Comparison& found, const ComparedThing& thing) {
    std::string out = thing.a >= 0 ? sized(found.a, thing.a) : sized(found.b, thing.b);
    const std::string now =
        thing.b >= 0 && thing.a >= 0 ? "; now object " + std::to_string(thing.b) : "";
    switch (thing.became) {
        case Became::moved:
            return "moved by " + metres(thing.moved_m) + ": " + out + now;
        case Became::came:
            return "came: " + out + ", of B";
        case Became::went:
            return "went: " + out;
        case Became::unseen:
            return std::string("unseen: ") + out +
                   (thing.a >= 0 ? ": B did not see its place" : ", of B: A did not see its place");
        default:
            return "";
    }
}

std::string safety_of(const Comparison& found, const ComparedThing& thing) {
    if (!thing.less_safe && !thing.safer && !thing.stands_otherwise) return "";
    const Object &a = found.a.objects[static_cast<std::size_t>(thing.a)],
                 &b = found.b.objects[static_cast<std::size_t>(thing.b)];
    std::string out = thing.less_safe ? "less safe: "
                      : thing.safer   ? "safer: "
                                      : "stands otherwise: ";
    out += sized(found.a, thing.a) + "; now object " + std::to_string(thing.b);
    if (a.unsafety_category != b.unsafety_category)
        out += ": " + a.unsafety_category + " -> " + b.unsafety_category;
    if (thing.stands_otherwise) out += ", on other things";
    return out;
}

int run_compare(const CompareArguments& a) {
    if (!a.out.empty())
        io::check_own_file(a.out, "topple.comparison/",
                           "is no comparison of topple; choose another file");
    catch_interrupts();
    CompareOptions options;
    options.cancelled = [] { return interrupted() != 0; };
    Comparison found;
    try {
        found = compare(a.a, a.b, options);
    } catch (const Error&) {
        if (interrupted() != 0) return interrupted_exit();
        throw;
    }
    if (!a.out.empty()) io::replace_file(a.out, comparing::comparison_json(found));
    const Alignment& laid = found.alignment;
    print(
        "%s to %s%s: %.0f %% of surfaces that both saw agree (next best: %.0f %%); off by %.1f "
        "cm\n",
        io::printable(found.a.source).c_str(), io::printable(found.b.source).c_str(),
        laid.same_frame ? ", in one frame" : "", 100 * laid.agreeing, 100 * laid.next_agreeing,
        100 * laid.error_m);
    std::size_t same = 0, merged = 0, said = 0;
    const auto say = [&](const std::string& line) {
        if (line.empty()) return;
        print("  %s\n", line.c_str());
        ++said;
    };
    for (const Became became : {Became::moved, Became::came, Became::went})
        for (const ComparedThing& thing : found.things)
            if (thing.became == became) say(line_of(found, thing));
    for (const ComparedThing& thing : found.things) say(safety_of(found, thing));
    for (const ComparedThing& thing : found.things) {
        if (thing.became == Became::unseen) say(line_of(found, thing));
        same += thing.became == Became::same;
        merged += thing.became == Became::merged;
    }
    if (said == 0) print("  nothing came, went or moved\n");
    print("%s where it was, %zu told apart otherwise\n", io::counted(same, "thing").c_str(),
          merged);
    return 0;
}

}  // namespace

Command add_compare(CLI::App& app) {
    auto a = std::make_shared<CompareArguments>();
    app.add_option("A", a->a, "OUT of the earlier parse")->required();
    app.add_option("B", a->b, "OUT of the later parse of the same room, in any frame")->required();
    app.add_option("-o,--output", a->out, "File for the comparison as JSON");
    return [a] { return run_compare(*a); };
}

}  // namespace topple::cli
