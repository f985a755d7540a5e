// SPDX-License-Identifier: MIT
// topple-reader: does in a process of its own, for topple and libtopple, what may crash. Not for
// use by hand: child/process.h says how it is called.
//   scan UNIT FILE    reads a file as reader::read_points does
//   devices BACKEND   lists a backend's devices
#include <cstdio>
#include <cstdlib>

#include "child/confine.h"
#include "child/process.h"
#include "device/probe.h"
#include "io/text.h"
#include "points/apart/read_scan.h"
#include "points/apart/scan_message.h"
#include "topple/version.h"

using namespace topple;

int main(int argc, char** argv) {
    const std::vector<std::string> task = child::accept_task(argc, argv);
    if (task.size() == 3 && task[0] == "scan") {
        // A glTF has files of its own, in its folder.
        const std::filesystem::path scan = task[2];
        child::confine(
            {{io::lower_case(scan.extension().string()) == ".gltf" ? scan.parent_path() : scan},
             {}});
        reader::answer_scan(task[1], task[2], [](const std::filesystem::path& file, double unit_m) {
            return reader::read_points(file, unit_m, [] {});
        });
    } else if (task.size() == 2 && task[0] == "devices") {
        device::answer_probe(task[1]);
    } else {
        std::fprintf(stderr, "topple-reader %s belongs to topple, which runs it\n", version);
        return 2;
    }
    // The libraries' own ends take time, and may crash.
    std::_Exit(0);
}
