// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "io/staging_folder.h"

namespace topple::io {

// What is in a result folder, and by what an earlier one is known. Nothing else is replaced.
struct OutputKind {
    std::span<const std::string_view> files;    // by name; the last is written last, and its
    std::string_view mark;                      // beginning holds this
    std::span<const std::string_view> folders;  // which hold numbered images
    const char* what;                           // "output of topple"
};
extern const OutputKind output_of_parse;

// A result folder that is there whole or not at all. Files are written into a staging folder beside
// the destination; commit() puts it in the destination's place in one step.
//
// The destination may be missing, an empty folder, or the output of an earlier run, which is
// replaced. A folder that holds anything else is refused, and so is one where a folder, a link or a
// special file has the name of one of topple's: nobody's files are deleted. Missing
// parent folders are made, and taken away again where the run fails. Where the destination can't be
// replaced by a rename (it is a mount point or the current folder, or only it and not its parent is
// writable), commit() moves the files into it one by one, scene.json last.
//
// All errors are Error(input) that name the folder and the reason.
class OutputFolder {
  public:
    explicit OutputFolder(const std::filesystem::path& destination,
                          const OutputKind& kind = output_of_parse);
    ~OutputFolder();  // removes what was made where commit() has not run
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    // Where to write what the kind has, and nothing else.
    std::filesystem::path folder() const { return staging_->path() / "out"; }
    const std::filesystem::path& destination() const { return destination_; }

    // All files are written and closed. At most once.
    void commit();

  private:
    void make_parents();
    void make_staging();
    void remove_parents() noexcept;
    bool exchange();

    const OutputKind& kind_;
    std::filesystem::path destination_;
    std::vector<std::filesystem::path> made_parents_;  // outermost first
    std::optional<StagingFolder> staging_;
};

// Throws Error(input) where the folder is missing or no output of a parse, which is told by its
// scene.json.
void check_output(const std::filesystem::path& folder);

// Throws Error(usage) where the input is the destination or lies in it, and so would be replaced by
// what was made of it.
void check_not_replaced(const std::filesystem::path& input,
                        const std::filesystem::path& destination);

}  // namespace topple::io
