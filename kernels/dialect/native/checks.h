// SPDX-License-Identifier: MIT
// The prelude, and what the accesses of a checked form become, as C++: see ../glsl/checks.glsl.
#include "prelude.h"

#define CHECKS(i)
#define CHECKED(access, who, index) ::DIALECT_NAMESPACE::checked_(checks_, access, who, uint(index))

namespace DIALECT_NAMESPACE {
FN uint checked_(uint* checks_, uint access, uint who, uint index) {
    if (index < checks_[4 + (access >> 2)]) return index;
    uint none = 0;
    if (std::atomic_ref(checks_[0]).compare_exchange_strong(none, 1)) {
        checks_[1] = access;
        checks_[2] = who;
        checks_[3] = index;
    }
    return 0;
}
}  // namespace DIALECT_NAMESPACE
