// SPDX-License-Identifier: MIT
#pragma once

#include "child/message.h"
#include "mujoco/settled.h"

// What topple-mujoco answers with.
namespace topple::mujoco {

void write_settled(const Settled& settled);

// Throws child::BadAnswer. The numbers in it may be anything, as they may in a run.
Settled read_settled(const child::Answer& answer);

}  // namespace topple::mujoco
