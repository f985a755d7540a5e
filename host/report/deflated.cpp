// SPDX-License-Identifier: MIT
#include "report/deflated.h"

#include <zlib.h>

#include <new>

#include "report/base64.h"

namespace topple::report {

std::string deflated(std::string_view bytes) {
    // Higher levels take a multiple of the time for a few hundredths of the size.
    constexpr int level = 4;
    uLongf size = compressBound(bytes.size());
    std::string out(size, '\0');
    const int result = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), level);
    if (result != Z_OK) throw std::bad_alloc();  // there is room, so that memory is all it can lack
    return base64(out.data(), size);
}

}  // namespace topple::report
