// SPDX-License-Identifier: MIT
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <string_view>

// A library that OpenVDB logs with starts four threads when it is loaded, before main(), and where
// the system gives none (ulimit -u) that ends the program in an abort. What stands in
// .preinit_array runs before any library: there as many are tried, which takes a tenth of a
// millisecond, so that the program can say why it ends.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
namespace {

constexpr std::size_t needed = 5;

struct Gate {
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
};

// They must all be there at a time: each waits until the last was started.
void* wait_for_the_last(void* gate) {
    auto* const mutex = &static_cast<Gate*>(gate)->mutex;
    pthread_mutex_lock(mutex);
    pthread_mutex_unlock(mutex);
    return nullptr;
}

void try_threads(int, char**, char**) {
    Gate gate;
    std::array<pthread_t, needed> threads;
    std::size_t started = 0;
    pthread_mutex_lock(&gate.mutex);
    while (started < needed &&
           pthread_create(&threads[started], nullptr, wait_for_the_last, &gate) == 0)
        ++started;
    pthread_mutex_unlock(&gate.mutex);
    for (std::size_t n = 0; n < started; ++n) pthread_join(threads[n], nullptr);
    if (started == needed) return;
    constexpr std::string_view message =
        "topple: no threads can be started, of which the libraries that it is linked with take "
        "some; raise the limit of processes (ulimit -u), or end some\n";
    [[maybe_unused]] const ssize_t written = ::write(2, message.data(), message.size());
    ::_exit(1);
}

[[gnu::used, gnu::section(".preinit_array")]] void (*const before_libraries)(int, char**,
                                                                             char**) = try_threads;

}  // namespace
#endif
