// SPDX-License-Identifier: MIT
// topple-mujoco: runs in a process of its own, for `topple verify`, what MuJoCo may crash in. Not
// for use by hand: child/process.h says how it is called.
//   settle SECONDS PATIENCE FILE    runs the scene for so long, or until that took PATIENCE seconds
#include <cstdio>
#include <cstdlib>

#include "child/confine.h"
#include "child/process.h"
#include "mujoco/main/settle.h"
#include "topple/version.h"

using namespace topple;

namespace {

// MuJoCo's errors can't be returned from.
[[noreturn]] void tell_error(const char* what) {
    mujoco::Settled none;
    none.problem = what;
    mujoco::write_settled(none);
    std::_Exit(0);
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> task = child::accept_task(argc, argv);
    if (task.size() != 4 || task[0] != "settle") {
        std::fprintf(stderr, "topple-mujoco %s belongs to topple, which runs it\n", version);
        return 2;
    }
    child::confine({{std::filesystem::path(task[3]).parent_path()}, {}});
    mujoco::write_settled(mujoco::settle(task[3], std::strtod(task[1].c_str(), nullptr),
                                         std::strtod(task[2].c_str(), nullptr), tell_error));
    std::_Exit(0);
}
