// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace topple::cli {

// Serves the files that lie in one folder, and nothing else, over HTTP to this machine alone. Where
// another output takes its place, as `topple live` writes them, that is served from then on, and
// those who listen at /events are told: by a server-sent event `output` with the time at which that
// was, milliseconds since 1970, which comes once at first.
//
// A request names a file of the folder itself: names with a slash, hidden files, links and what is
// no regular file are not found, so that no path leads out of it. Nothing is written. Requests that
// came by another name than the server's own address are refused, since a web site may have its
// name point here.
class ViewServer {
  public:
    // Takes the port, or any that is free where it is 0. Throws Error(input) where the folder can't
    // be opened, Error(usage) where the port can't be taken.
    ViewServer(const std::filesystem::path& folder, std::uint16_t port);
    ~ViewServer();
    ViewServer(const ViewServer&) = delete;
    ViewServer& operator=(const ViewServer&) = delete;

    std::string url() const;  // of report.html

    // Serves until done(), which is asked ten times a second.
    void run(const std::function<bool()>& done);

  private:
    struct Inner;
    std::unique_ptr<Inner> inner_;
};

}  // namespace topple::cli
