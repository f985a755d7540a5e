// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "topple/crew.h"
#include "topple/kernels/device.h"

// Stages whose tasks a crew shares out.
namespace topple {

// A crew of this process alone.
std::unique_ptr<Crew> lone_crew();

// Sorts tasks by falling weight: where large ones come first, all members end at about the same
// time.
void large_first(std::vector<Crew::Task>& tasks);

// This process' part of the stage that the crew has begun: calls work(task) on up to `lanes` of the
// device's threads at a time until no task is left. `tell` is called after each task, by one thread
// at a time. Ends the stage; the leader throws what failed first, the others tell the leader.
void work_off(Crew& crew, device::Device& device, unsigned lanes,
              const std::function<void(std::uint64_t)>& work, const std::function<void()>& tell);

}  // namespace topple
