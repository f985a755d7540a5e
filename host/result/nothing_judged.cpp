// SPDX-License-Identifier: MIT
#include "result/nothing_judged.h"

#include <algorithm>
#include <string>

#include "io/text.h"

namespace topple {
namespace {

std::string why_nothing(const Scene& scene) {
    const auto building = static_cast<std::uint64_t>(
        std::ranges::count_if(scene.objects, [](const Object& o) { return o.grounded; }));
    const std::uint64_t hidden = scene.objects.size() - building;
    const std::string counted = io::counted(building, "object") + (building == 1 ? " is" : " are") +
                                " counted as the building, or as fixed to it";
    if (hidden == 0) return "no object was found that can move: " + counted;
    return (hidden == 1 ? "the scan does not show what holds the one object"
                        : "of none of the " + std::to_string(hidden) +
                              " objects that can move does the scan show what holds it") +
           std::string(hidden == 1 ? " that can move" : "") + "; " + counted;
}

std::string up_text(const Scene& scene) {
    const std::string up = io::vector_text(scene.up);
    if (scene.up_method == "given") return "Up is " + up + ", as was given";
    if (scene.up_method == "assumed") return "Up was guessed to be " + up;
    return "Up was taken to be " + up;
}

}  // namespace

void note_nothing_judged(Scene& scene) {
    if (std::ranges::any_of(scene.objects,
                            [](const Object& o) { return !o.grounded && o.seen_enough; }))
        return;
    scene.notes.insert(
        scene.notes.begin(),
        "Nothing was judged, because " + why_nothing(scene) +
            ". That does not say that the room is safe. " + up_text(scene) +
            ": if that is wrong, give up (--up); if sizes are, unit_m (--unit), or "
            "the depth_scale of depth frames. Else scan from more sides, or tell by corrections "
            "what is furniture.");
}

}  // namespace topple
