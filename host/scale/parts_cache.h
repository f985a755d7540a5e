// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/checksum.h"
#include "objects/found_parts.h"
#include "topple/parse.h"

namespace topple {

// ParseOptions::cache_file: the parts of a scan, with the checksum of all that it depends on:
// the bytes of the input, the options, the device and the build of this library. It is this
// library's alone: another build writes another.
class PartsCache {
  public:
    PartsCache() = default;  // none: what is read there is nothing
    // Of the options' device. Not usable for scans that lie in files which only they name.
    PartsCache(const std::filesystem::path& input, const ParseOptions& options);

    bool usable() const { return key_.has_value(); }
    // None where there is none that fits. Of one that is damaged the options' notice is told.
    std::optional<FoundParts> read() const;
    // Where it can't be written the notice is told; the parse goes on.
    void write(const FoundParts& ground) const;

  private:
    std::filesystem::path file_;
    std::optional<Checksum::Value> key_;
    std::function<void(const std::string&)> notice_;
};

}  // namespace topple
