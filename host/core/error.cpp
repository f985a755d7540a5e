// SPDX-License-Identifier: MIT
#include "topple/error.h"

#include "core/printable.h"

namespace topple {

Error::Error(ErrorKind kind, const std::string& message)
    : std::runtime_error(printable(message, std::string::npos)), kind_(kind) {}

}  // namespace topple
