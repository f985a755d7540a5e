// SPDX-License-Identifier: MIT
#include "cli/before.h"

#include <cstdio>

#include "cli/print.h"
#include "cli/urgency.h"
#include "io/text.h"
#include "result/scene_json.h"
#include "safety/largest_risk.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

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

void print_change(const Worst& before, const Scene& now) {
    print("Worst before (%s): %s; now: %s.\n", io::path_text(before.of).c_str(),
          before.text.c_str(), worst_text(now).c_str());
}

}  // namespace topple::cli
