// SPDX-License-Identifier: MIT
#include "mujoco/settle_apart.h"

#include <cstdint>
#include <string>

#include "child/process.h"
#include "child/program.h"
#include "core/number_text.h"
#include "io/text.h"
#include "topple/error.h"

namespace topple::mujoco {
namespace {

constexpr const char* simulator_program = "topple-mujoco";

// Of what it takes beside the simulation: MuJoCo's rooms for 3000 contacts take 1.8 GB.
constexpr std::uint64_t memory_bytes = std::uint64_t{6} << 30;
constexpr double loading_s = 120;

}  // namespace

std::filesystem::path find_simulator() {
    const std::filesystem::path program = child::find_program(simulator_program);
    if (program.empty())
        throw Error(ErrorKind::device,
                    std::string(simulator_program) +
                        " was not found beside topple: it is built where MuJoCo is there "
                        "(apt-get install libmujoco-dev, then build topple again)");
    return program;
}

Settled settle_apart(const std::filesystem::path& file, double seconds, double patience_s,
                     const std::function<void()>& poll) {
    const std::filesystem::path program = find_simulator();
    child::Limits limits;
    limits.memory_bytes = memory_bytes;
    limits.wall_s = patience_s + loading_s;
    limits.cpu_s = static_cast<std::uint64_t>(limits.wall_s);
    const child::Ended ended =
        child::run(program.string(),
                   {"settle", to_digits(seconds, 17), to_digits(patience_s, 17),
                    std::filesystem::absolute(file).string()},
                   limits, poll);
    Settled out;
    try {
        if (!ended.answer.whole())
            throw Error(
                ErrorKind::device,
                (ended.started ? std::string(simulator_program) + " " + ended.how : ended.how) +
                    "; see that MuJoCo is installed (apt-get install libmujoco-dev)");
        out = read_settled(ended.answer);
    } catch (const child::BadAnswer&) {
        throw Error(ErrorKind::device,
                    std::string(simulator_program) + " gave an answer that makes no sense");
    }
    if (!out.problem.empty())
        throw Error(ErrorKind::input,
                    "MuJoCo can't run the scene: " + io::printable(out.problem, 300));
    return out;
}

}  // namespace topple::mujoco
