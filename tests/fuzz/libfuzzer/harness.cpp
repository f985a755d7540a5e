// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "fuzz/libfuzzer/file_in_memory.h"
#include "fuzz/readers.h"
#include "lab/temporary_folder.h"

// libFuzzer's entry: TOPPLE_READER names the reader.
namespace {

topple::fuzz::Reader chosen() {
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

// What own files are made from is a parse, which is none of an input's time.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
    const topple::fuzz::Reader reader = chosen();
    if (reader.made) reader.made({});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const topple::fuzz::Reader reader = chosen();
    static const topple::scenes::TemporaryFolder folder("topple_fuzz");
    static const std::filesystem::path file = [] {
        if (reader.put_beside) reader.put_beside(folder.path());
        return folder.path() / reader.file;
    }();
    const std::string_view input(reinterpret_cast<const char*>(data), size);
    const std::string made = reader.made ? reader.made(input) : std::string();
    topple::fuzz::show_file(file.c_str(), reader.made ? made : input);
    const auto wrong = topple::fuzz::try_file(reader, file);
    if (!wrong.empty()) {
        std::fprintf(stderr, "%s: %s\n", reader.name, wrong.c_str());
        std::abort();
    }
    return 0;
}
