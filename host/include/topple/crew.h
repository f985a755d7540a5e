// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace topple {

struct ParseOptions;

// The processes that parse a cloud in blocks together, on one machine or on many; each has an
// object of its own class derived from this. All their data goes through the files of
// ParseOptions::work_folder, which all of them see; a crew only hands out the tasks of a stage,
// each to one process. Who did which is not in the result.
//
// Member 0 leads: it calls parse(), and the others help_parse(). An implementation brings the
// messages between them; topple-mpi is one.
class Crew {
  public:
    // A task of a stage, and how long it takes compared with the stage's others.
    struct Task {
        std::uint64_t id = 0, weight = 0;
    };

    virtual ~Crew() = default;

    // The leader's: has the other members begin a stage, by returning `order` from their wait().
    // Tasks are handed out in the order given.
    virtual void begin(const std::string& order, std::vector<Task> tasks) = 0;
    // The leader's: the weight of the stage's tasks that are finished, by whomever.
    virtual std::uint64_t finished() const = 0;

    // The other members': the next stage's order; nothing: there will be none, the parse has ended.
    virtual std::optional<std::string> wait() = 0;

    // Any member's, from any of its threads: books the task that the thread has finished and gives
    // it the next. Nothing: there is none left, or a member has failed.
    virtual std::optional<std::uint64_t> next(std::optional<std::uint64_t> finished) = 0;
    // Any member's, once for each stage, after all of its threads have got nothing from next().
    // `failed`: what ended its part early, or null. The leader waits for all other members, calls
    // `poll` meanwhile, and throws what failed first in any of them, or what `poll` throws.
    virtual void end(std::exception_ptr failed, const std::function<void()>& poll) = 0;
};

// What the members that don't lead do during a parse: parts of its stages, until the leader has
// ended it. options: as the leader's, but that work_folder is not used. Errors go to the leader.
void help_parse(Crew& crew, const ParseOptions& options);

}  // namespace topple
