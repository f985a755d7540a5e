// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>

#include "cli/command_line.h"

// Where memory runs out before main(), or in what may not throw, the runtime ends the program by
// std::terminate(), which aborts. Here it ends as any run that has no memory does. What stands in
// .preinit_array runs before any library.
namespace {

[[noreturn]] void end_without_memory() {
    try {
        if (const std::exception_ptr thrown = std::current_exception())
            std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        topple::cli::print_out_of_memory();
        ::_exit(topple::cli::exit_code(topple::ErrorKind::input));
    } catch (...) {
    }
    std::abort();
}

void end_so(int, char**, char**) {
    std::set_terminate(end_without_memory);
}

[[gnu::used, gnu::section(".preinit_array")]] void (*const first_of_all)(int, char**,
                                                                         char**) = end_so;

}  // namespace
