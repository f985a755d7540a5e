// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace topple::child {

// What stands before an answer, written when all the rest is.
struct AnswerHead {
    std::uint64_t magic = 0, size = 0;  // size: with the head, bytes
};
inline constexpr std::uint64_t answer_magic = 0x31657770706f74;  // "topwpe1"
// Stands there from when the child runs: what ends it from then on is no missing library.
inline constexpr std::uint64_t begun_magic = 0x32657770706f74;

}  // namespace topple::child
