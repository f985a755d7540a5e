// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "io/text.h"

namespace topple::io {

// What a library may be asked to allocate for a file of so many bytes: what honest files take is
// below ten times their size, and of small files a few megabytes.
inline std::uint64_t import_budget(std::uint64_t file_bytes) {
    return (std::uint64_t{64} << 20) + saturating_multiply(10, file_bytes);
}

// Adds up what a file's counts will make a library allocate, and refuses it beyond its budget.
class ImportWeight {
  public:
    ImportWeight(const std::filesystem::path& file, std::uint64_t file_bytes)
        : file_(file), budget_(import_budget(file_bytes)) {}

    // `count` more of `noun`, which take `each` bytes.
    void add(std::uint64_t count, std::uint64_t each, const char* noun) {
        if (__builtin_add_overflow(weight_, saturating_multiply(count, each), &weight_))
            weight_ = UINT64_MAX;
        if (weight_ <= budget_) return;
        fail(file_, "its " + counted(count, noun) + ", with what else it holds, would take " +
                        bytes_text(weight_) + " of memory to read, more than the " +
                        bytes_text(budget_) +
                        " that a file of its size may; join them, or leave out what is no surface");
    }

  private:
    const std::filesystem::path& file_;
    std::uint64_t budget_;
    std::uint64_t weight_ = 0;
};

}  // namespace topple::io
