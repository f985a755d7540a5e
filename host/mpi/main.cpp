// SPDX-License-Identifier: MIT
#include <mpi.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "mpi/mpi_crew.h"

// `topple parse` as an MPI job: mpirun -n RANKS topple-mpi parse INPUT -o OUT
int main(int argc, char** argv) {
    using namespace topple;
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit (ulimit -f) is an error of its write
    int threading = MPI_THREAD_SINGLE;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &threading);
    int code = 3;
    {
        const auto crew = std::make_shared<mpi::MpiCrew>();
        const bool leads = crew->rank() == 0;
        std::optional<Error> failed;
        if (threading < MPI_THREAD_SERIALIZED) {
            if (leads)
                cli::print_error({ErrorKind::device,
                                  "this MPI allows calls from one thread only; topple-mpi needs "
                                  "one with MPI_THREAD_SERIALIZED"});
        } else {
            // Whatever the others would print, the leader prints, too, or is told.
            [[maybe_unused]] const auto* nowhere =
                leads ? stdout : std::freopen("/dev/null", "w", stdout);
            const cli::Team team{crew, leads, crew->cores(), [&] { return crew->stopped(); }};
            const cli::CommandEntry commands[] = {
                {"parse", cli::parse_purpose, [&](CLI::App& app) {
                     return cli::add_parse(app, {argv, argv + argc}, team);
                 }}};
            code = cli::run_command_line(commands, argc, argv,
                                         [&](const Error& error) { failed = error; });
            if (leads && failed) {
                // Where another rank's failure has cancelled the leader, that is to be told.
                failed = crew->failure().value_or(*failed);
                cli::print_error(*failed);
                code = cli::exit_code(failed->kind());
            }
            crew->finish(failed);
            if (!leads) code = 0;  // the job's exit code is the leader's
        }
    }
    MPI_Finalize();
    return code;
}
