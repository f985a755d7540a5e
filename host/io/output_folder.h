// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace topple::io {

// A result folder that is there whole or not at all. Files are written into a temporary folder
// beside the destination; commit() puts it in the destination's place in one step.
//
// The destination may be missing, an empty folder, or the output of an earlier run, which is
// replaced. A folder that holds anything else is refused: nobody's files are deleted. Missing
// parent folders are made, and taken away again where the run fails. Where the destination can't be
// replaced by a rename (it is a mount point or the current folder, or only it and not its parent is
// writable), commit() moves the files into it one by one, scene.json last.
//
// All errors are Error(input) that name the folder and the reason.
class OutputFolder {
  public:
    explicit OutputFolder(const std::filesystem::path& destination);
    ~OutputFolder();  // removes the temporary folder where commit() has not run
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    // The temporary folder, to write files (no folders) into. Names must be among those that topple
    // writes: points.ply, solid.ply, volume.vdb, report.html, landscapes.json, scene.json.
    const std::filesystem::path& folder() const { return temporary_; }
    const std::filesystem::path& destination() const { return destination_; }

    // All files are written and closed. At most once.
    void commit();

  private:
    void make_temporary();
    void forget();

    std::filesystem::path destination_, temporary_;
    std::vector<std::filesystem::path> made_parents_;  // outermost first
    int slot_ = -1;  // in the list of what remove_pending_outputs() removes
};

// Throws Error(input) where the folder is missing or no output of a parse, which is told by its
// scene.json.
void check_output(const std::filesystem::path& folder);

// Throws Error(usage) where the input is the destination or lies in it, and so would be replaced by
// what was made of it.
void check_not_replaced(const std::filesystem::path& input,
                        const std::filesystem::path& destination);

// Removes the temporary folders of all OutputFolders that live, for a program that is about to end
// by a signal. It is async-signal-safe: call it in the handler, then _exit(). It uses system calls
// on memory of its own only, so it is right whatever the interrupted thread was doing; another
// thread that is just creating a file there may leave it behind. A process that is killed by
// SIGKILL leaves its folder .topple-<pid>-<n> beside the destination.
void remove_pending_outputs() noexcept;

}  // namespace topple::io
