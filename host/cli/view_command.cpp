// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "child/environment.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/print.h"
#include "cli/view_server.h"
#include "io/output_folder.h"
#include "io/text.h"
#include "topple/error.h"

namespace topple::cli {
namespace {

struct ViewArguments {
    std::string parsed;
    std::uint16_t port = 0;
    bool no_browser = false;
};

// Has the desktop open the address, and says whether it was asked to: where there is no desktop, a
// browser for terminals would take this one.
bool open_browser(std::string url, pid_t& opener) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return false;
    std::string program = child::found_in_path("xdg-open");
    if (program.empty()) return false;
    const std::array<char*, 3> words{program.data(), url.data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    // It runs what it finds by relative names, too; here a stranger's files may lie.
    posix_spawn_file_actions_addchdir_np(&files, "/");
    for (const int fd : {0, 1, 2})
        posix_spawn_file_actions_addopen(&files, fd, "/dev/null", fd == 0 ? O_RDONLY : O_WRONLY, 0);
    const int failed =
        posix_spawn(&opener, program.c_str(), &files, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    return failed == 0;
}

int run(const ViewArguments& a) {
    io::check_output(a.parsed);
    ViewServer server(a.parsed, a.port);
    catch_interrupts();
    pid_t opener = 0;
    const bool opened = !a.no_browser && open_browser(server.url(), opener);
    print("%s shows %s; Ctrl-C ends this.%s\n", server.url().c_str(),
          io::path_text(a.parsed).c_str(), opened || a.no_browser ? "" : " Open it in a browser.");
    std::fflush(stdout);
    server.run([&] {
        if (opener > 0 && waitpid(opener, nullptr, WNOHANG) != 0) opener = 0;
        return interrupted() != 0;
    });
    return 0;
}

}  // namespace

Command add_view(CLI::App& app) {
    auto a = std::make_shared<ViewArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    app.add_option("--port", a->port, "Port of 127.0.0.1; else one that is free")
        ->check(CLI::Range(1, 65535));
    app.add_flag("--no-browser", a->no_browser, "Print the address, and open no browser");
    return [a] { return run(*a); };
}

}  // namespace topple::cli
