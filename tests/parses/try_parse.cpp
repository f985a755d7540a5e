// SPDX-License-Identifier: MIT
#include "parses/try_parse.h"

#include "parses/invariants.h"
#include "parses/random_scene.h"

namespace topple::parses {
namespace {

bool one_line(const std::string& text) {
    for (const char c : text)
        if (static_cast<unsigned char>(c) < 0x20) return false;
    return !text.empty();
}

}  // namespace

std::string try_parse(std::uint64_t seed, const std::shared_ptr<device::Device>& device,
                      const std::filesystem::path& folder, bool small) {
    RandomScene scene = random_scene(seed, small);
    scene.options.device = device;
    try {
        const ParseResult result = parse(scene.cloud, scene.options);
        std::string wrong = what_is_wrong(result.scene);
        if (!wrong.empty() || folder.empty() || !scene.options.coordinates) return wrong;
        std::filesystem::remove_all(folder);
        OutputOptions outputs;
        outputs.glb = seed % 3 == 0;
        outputs.octomap = seed % 2 == 0;
        outputs.threads = 1;
        write_outputs(result, folder, outputs);
        return what_is_wrong(result.scene, folder);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::device)
            return std::string("an error of device: ") + error.what();
        if (!one_line(error.what())) return std::string("more than one line: ") + error.what();
    } catch (const std::exception& error) {
        return std::string("another exception: ") + error.what();
    }
    return {};
}

}  // namespace topple::parses
