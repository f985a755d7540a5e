// SPDX-License-Identifier: MIT
// topple-volume-reader: reads OpenVDB files in a process of its own, for topple and libtopple. Not
// for use by hand: child/process.h says how it is called.
//   scan UNIT FILE     a volume of anybody's, as a scan
//   states UNIT FILE   one of topple's own
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>

#include "child/confine.h"
#include "child/process.h"
#include "points/apart/scan_message.h"
#include "topple/version.h"
#include "vdb/read_volume.h"

using namespace topple;

int main(int argc, char** argv) {
    const std::vector<std::string> task = child::accept_task(argc, argv);
    if (task.size() != 3 || (task[0] != "scan" && task[0] != "states")) {
        std::fprintf(stderr, "topple-volume-reader %s belongs to topple, which runs it\n", version);
        return 2;
    }
    child::confine({{task[2]}, {}});
    // Threads would reserve address space for their stacks, and nothing here gains by them.
    const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    reader::answer_scan(task[1], task[2], task[0] == "scan" ? vdb::read_volume : vdb::read_states);
    std::_Exit(0);
}
