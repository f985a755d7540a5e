// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include <cstdio>
#include <cstring>

#include "fuzz/libfuzzer/file_in_memory.h"
#include "fuzz/readers.h"

// libFuzzer's entry: TOPPLE_READER names the reader.
namespace {

const topple::fuzz::Reader& chosen() {
    const char* name = std::getenv("TOPPLE_READER");
    for (const auto& reader : topple::fuzz::readers()) {
        if (name && std::strcmp(reader.name, name) == 0) return reader;
    }
    std::fprintf(stderr, "TOPPLE_READER must be one of:");
    for (const auto& reader : topple::fuzz::readers()) std::fprintf(stderr, " %s", reader.name);
    std::fprintf(stderr, "\n");
    std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const topple::fuzz::Reader& reader = chosen();
    static const std::filesystem::path file = std::filesystem::path("/nowhere") / reader.file;
    topple::fuzz::show_file(file.c_str(), {reinterpret_cast<const char*>(data), size});
    const auto wrong = topple::fuzz::try_file(reader, file);
    if (!wrong.empty()) {
        std::fprintf(stderr, "%s: %s\n", reader.name, wrong.c_str());
        std::abort();
    }
    return 0;
}
