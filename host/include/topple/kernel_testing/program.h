// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "topple/kernel_testing/case.h"

namespace topple::perf {

// The main function of a program that measures kernels; topple_add_kernel_cases makes one.
//
//   PROGRAM perf [OPTION...]      measures each case on each backend, and compares the hashes
//   PROGRAM compare BASE [...]    whether it is slower than BASE, such a program of an earlier
//                                 revision, by topple's perf/compare, which lies at `compare`
//
// Returns the exit code: 0; 1 where backends disagree, or, of compare, it is slower; else that of
// the error, which it prints.
int run_program(int argc, char** argv, std::span<const Case> cases, const char* compare);

}  // namespace topple::perf
