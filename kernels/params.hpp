// SPDX-License-Identifier: MIT
// The kernels' parameter structs, as the host sees them.
#pragma once

#include <cstdint>

namespace topple::kernels {

using uint = std::uint32_t;

#define STRUCT(T) struct T
#define STRUCT_END(T) ;
#include "params.h"
#undef STRUCT
#undef STRUCT_END

}  // namespace topple::kernels
