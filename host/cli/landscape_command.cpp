// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/landscape_picture.h"
#include "cli/print.h"
#include "io/output_folder.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "result/landscapes_json.h"
#include "result/scene_json.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

struct LandscapeArguments {
    std::string parsed, out;
    std::int64_t object = -1;
};

// Throws unless the object is there and can move.
const Object& chosen(const Scene& scene, std::int64_t id) {
    if (id < 0) {
        const Object* worst = nullptr;
        for (const Object& object : scene.objects) {
            if (!object.grounded && (!worst || rank_of(object) > rank_of(*worst))) worst = &object;
        }
        if (!worst) throw Error(ErrorKind::input, scene.source + ": has no object that can move");
        return *worst;
    }
    if (id >= static_cast<std::int64_t>(scene.objects.size())) {
        throw Error(ErrorKind::usage, "--object " + std::to_string(id) +
                                          ": the scene has objects 0 to " +
                                          std::to_string(scene.objects.size() - 1));
    }
    const Object& object = scene.objects[id];
    if (object.grounded) {
        throw Error(ErrorKind::usage,
                    "--object " + std::to_string(id) +
                        ": it is the building, or fixed to it, and has no landscape");
    }
    return object;
}

// What is written by the name's ending must have one that says what to write.
void check_ending(const std::string& out) {
    const std::string ending = std::filesystem::path(out).extension().string();
    if (ending == ".png" || ending == ".svg") return;
    throw Error(ErrorKind::usage,
                "--output " + io::printable(out) + ": expected a name that ends in .png or .svg");
}

// One that is replaced must be a picture itself: not a text that a slip of the hand names.
void check_own_picture(const std::string& out) {
    io::check_own_file(out, std::string_view(out).ends_with(".svg") ? "<svg" : "\x89PNG",
                       "is no picture; choose another name");
}

int run(const LandscapeArguments& a) {
    if (!a.out.empty()) check_ending(a.out);
    const std::filesystem::path folder = a.parsed;
    io::check_output(folder);
    Scene scene = io::read_scene_json(io::FileName::in(folder, "scene.json"));
    io::read_landscapes_json(io::FileName::in(folder, "landscapes.json"), scene);
    const Object& object = chosen(scene, a.object);
    const std::string out = a.out.empty() ? "object-" + std::to_string(object.id) + ".png" : a.out;
    check_own_picture(out);
    draw_landscape(scene, object, out);
    print("Object %d: %s\n%s\n", object.id, object.why.sentence.c_str(), out.c_str());
    return 0;
}

}  // namespace

Command add_landscape(CLI::App& app) {
    auto a = std::make_shared<LandscapeArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    app.add_option("--object", a->object, "Number of the object; else the most unsafe one")
        ->check(whole_number);
    app.add_option("-o,--output", a->out, "Picture, .png or .svg; else object-N.png");
    return [a] { return run(*a); };
}

}  // namespace topple::cli
