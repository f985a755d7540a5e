// SPDX-License-Identifier: MIT
#include "report/deflated.h"

#include <libdeflate.h>

#include <memory>
#include <new>

#include "report/base64.h"

namespace topple::report {

std::string deflated(std::string_view bytes) {
    // Higher levels take a multiple of the time for a few hundredths of the size.
    constexpr int level = 6;
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(level), &libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
    const std::size_t size = libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(),
                                                      out.data(), out.size());
    return base64(out.data(), size);
}

}  // namespace topple::report
