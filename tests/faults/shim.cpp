// SPDX-License-Identifier: MIT
// A library for LD_PRELOAD that lets one call of a program's system fail. Of a process that has
// TOPPLE_FAULT set it counts, from main() on, the calls of a kind that the program and its
// libraries make:
//
//   TOPPLE_FAULT=memory:N         the Nth allocation gives no memory
//   TOPPLE_FAULT=ENOSPC:N, EIO:N  the Nth call that changes a file fails with that reason
//   TOPPLE_FAULT=short:N          the same; a write writes the half of what it shall, then no more
//   TOPPLE_FAULT=fork:K           every Kth allocation fails, each in a child of its own that is
//                                 forked there; the program itself goes on as if nothing were
//
// With a + after the number of an allocation, as memory:N+, all that follow fail, too.
// With N = 0 none fails. At the end a line with the number of calls goes to descriptor
// TOPPLE_FAULT_TELL; of each child that did not end as it should, one with why. A child's calls
// that would change what the program works on (rename, unlink, rmdir) are left out.
//
// With TOPPLE_FAULT_TRACE set a child that aborts or crashes tells from where: for addr2line.
//
// While the program has threads of its own no child is forked, since it would lack them: run it
// with
// --threads 1 on a single core.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

enum class Kind { none, memory, forking, no_space, bad_disk, cut_short };

constexpr int child_limit_s = 30;

Kind kind = Kind::none;
std::atomic<long> calls{0};
long at = 0;  // the call that fails; of forks every `at`th
std::atomic<bool> armed{false};
bool is_child = false, traced = false;
bool lasting = false;  // what failed once fails from then on
bool cut = false;      // a short write was made
bool outputs = false;  // files are being written: no more forks
int tell = -1;
long threads_at_start = 0;  // libraries start some when they are loaded
long children = 0, refused = 0, unaware = 0, wrong = 0;

void say(const char* format, ...) {
    char line[512];
    va_list values;
    va_start(values, format);
    const int length = std::vsnprintf(line, sizeof(line), format, values);
    va_end(values);
    if (length > 0 && tell >= 0) syscall(SYS_write, tell, line, static_cast<std::size_t>(length));
}

long now_ms() {
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1000L + t.tv_nsec / 1000000L;
}

// What the child of the nth call says on stderr and ends with.
void watch(pid_t child, int from, long n) {
    char text[1024];
    std::size_t length = 0;
    int lines = 0;
    const long until = now_ms() + child_limit_s * 1000L;
    bool late = false;
    for (;;) {
        pollfd waiting{from, POLLIN, 0};
        const long left = until - now_ms();
        if (left <= 0 || poll(&waiting, 1, static_cast<int>(left)) == 0) {
            late = true;
            kill(child, SIGKILL);
            break;
        }
        char piece[512];
        const auto got = syscall(SYS_read, from, piece, sizeof(piece));
        if (got <= 0) break;
        for (long c = 0; c < got; ++c) {
            lines += piece[c] == '\n';
            if (length + 1 < sizeof(text)) text[length++] = piece[c] == '\n' ? '|' : piece[c];
        }
    }
    text[length] = 0;
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    ++children;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (!late && code == 1 && lines == 1) {
        ++refused;
    } else if (!late && code == 0 && lines == 0) {
        ++unaware;  // the program did without that memory
    } else {
        ++wrong;
        say("wrong %ld code %d%s lines %d: %s\n", n, code, late ? " late" : "", lines, text);
    }
}

void trace(int why) {
    void* frames[40];
    const int count = backtrace(frames, 40);
    backtrace_symbols_fd(frames, count, tell);
    _exit(128 + why);
}

// Of this process now.
long thread_count() {
    char text[1024];
    const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, "/proc/self/stat", O_RDONLY));
    const auto got = file < 0 ? 0 : syscall(SYS_read, file, text, sizeof(text) - 1);
    if (file >= 0) syscall(SYS_close, file);
    text[got > 0 ? got : 0] = 0;
    const char* value = std::strrchr(text, ')');  // after the name, in which anything may stand
    for (int field = 2; value && field < 20; ++field) value = std::strchr(value + 1, ' ');
    return value ? std::atol(value) : 0;
}

// In the child: true. The parent goes on when the child has ended.
bool forked(long n) {
    int ends[2];
    if (thread_count() > threads_at_start) return false;
    if (syscall(SYS_pipe2, ends, O_CLOEXEC) != 0) return false;
    armed = false;
    const pid_t child = fork();
    if (child == 0) {
        is_child = true;
        if (traced)
            for (const int deadly : {SIGABRT, SIGSEGV, SIGBUS}) signal(deadly, trace);
        dup2(ends[1], STDERR_FILENO);
        syscall(SYS_close, ends[0]);
        syscall(SYS_close, ends[1]);
        return true;
    }
    syscall(SYS_close, ends[1]);
    if (child > 0) watch(child, ends[0], n);
    syscall(SYS_close, ends[0]);
    armed = true;
    return false;
}

bool no_memory() {
    if (is_child && lasting) return true;
    if (!armed.load(std::memory_order_relaxed)) return false;
    if (kind == Kind::memory) {
        const long n = calls.fetch_add(1) + 1;
        return at > 0 && (lasting ? n >= at : n == at);
    }
    if (kind != Kind::forking || outputs) return false;
    const long n = calls.fetch_add(1) + 1;
    return at > 0 && n % at == 0 && forked(n);
}

// Whether this call that changes a file fails, with errno set.
bool no_change() {
    if (!armed || (kind != Kind::no_space && kind != Kind::bad_disk && kind != Kind::cut_short))
        return false;
    if (calls.fetch_add(1) + 1 != at && !cut) return false;
    errno = kind == Kind::bad_disk ? EIO : ENOSPC;
    return true;
}

// Of a write that fails: writes the half first, where that is asked for.
long short_write(int file, const void* bytes, std::size_t count) {
    if (kind != Kind::cut_short || count < 2 || std::exchange(cut, true)) return -1;
    return syscall(SYS_write, file, bytes, count / 2);
}

// Terminals and pipes are no files that a disk could refuse.
bool is_file(int file) {
    return file > STDERR_FILENO && lseek(file, 0, SEEK_CUR) >= 0;
}

// One with a name; what is written for a child process to read has none.
bool is_output(int file) {
    struct stat about {};
    return fstat(file, &about) == 0 && S_ISREG(about.st_mode) && about.st_nlink > 0;
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

// A library that OpenVDB uses has threads of its own, which a child lacks, and waits for them at
// its end.
void end_child(int code) {
    if (!is_child) return;
    std::fflush(nullptr);
    _exit(code);
}

void report() {
    if (kind == Kind::none || is_child || !armed.exchange(false)) return;
    if (kind == Kind::forking)
        say("calls %ld children %ld refused %ld unaware %ld wrong %ld\n", calls.load(), children,
            refused, unaware, wrong);
    else
        say("calls %ld\n", calls.load());
}

int counted_main(int argc, char** argv, char** environment) {
    if (const char* fault = std::getenv("TOPPLE_FAULT")) {
        const char* number = std::strchr(fault, ':');
        const auto is = [&](const char* name) {
            return std::strncmp(fault, name, std::strlen(name)) == 0;
        };
        kind = is("memory")   ? Kind::memory
               : is("fork")   ? Kind::forking
               : is("ENOSPC") ? Kind::no_space
               : is("EIO")    ? Kind::bad_disk
               : is("short")  ? Kind::cut_short
                              : Kind::none;
        at = number ? std::atol(number + 1) : 0;
        lasting = number && std::strchr(number, '+');
        const char* descriptor = std::getenv("TOPPLE_FAULT_TELL");
        traced = std::getenv("TOPPLE_FAULT_TRACE") != nullptr;
        tell = descriptor ? std::atoi(descriptor) : -1;
        // Programs that this one starts have no faults.
        unsetenv("LD_PRELOAD");
        unsetenv("TOPPLE_FAULT");
        threads_at_start = thread_count();
        armed = true;
    }
    const int code = real_main(argc, argv, environment);
    end_child(code);
    report();
    return code;
}

template <class Call>
Call next(const char* name) {
    return reinterpret_cast<Call>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

int __libc_start_main(Main program, int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*loader)(), void* stack) {
    real_main = program;
    using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
    return next<Start>("__libc_start_main")(counted_main, argc, argv, init, fini, loader, stack);
}

void* malloc(std::size_t bytes) {
    if (no_memory()) return errno = ENOMEM, nullptr;
    return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
    if (no_memory()) return errno = ENOMEM, nullptr;
    return __libc_calloc(count, bytes);
}
void* realloc(void* from, std::size_t bytes) {
    if (no_memory()) return errno = ENOMEM, nullptr;
    return __libc_realloc(from, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
    if (no_memory()) return errno = ENOMEM, nullptr;
    return __libc_memalign(alignment, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    return memalign(alignment, bytes);
}
int posix_memalign(void** to, std::size_t alignment, std::size_t bytes) {
    void* memory = memalign(alignment, bytes);
    if (!memory) return ENOMEM;
    *to = memory;
    return 0;
}

ssize_t write(int file, const void* bytes, std::size_t count) {
    // A staging folder's lock holds a line and is no output.
    outputs = outputs || (count > 64 && is_output(file));
    if (is_file(file) && no_change()) return short_write(file, bytes, count);
    return syscall(SYS_write, file, bytes, count);
}
ssize_t writev(int file, const iovec* pieces, int count) {
    if (is_file(file) && no_change())
        return count > 0 ? short_write(file, pieces[0].iov_base, pieces[0].iov_len) : -1;
    return syscall(SYS_writev, file, pieces, count);
}
ssize_t pwrite(int file, const void* bytes, std::size_t count, off_t where) {
    if (no_change()) return -1;
    return syscall(SYS_pwrite64, file, bytes, count, where);
}
ssize_t pwrite64(int file, const void* bytes, std::size_t count, off64_t where) {
    return pwrite(file, bytes, count, where);
}
int fsync(int file) {
    return no_change() ? -1 : static_cast<int>(syscall(SYS_fsync, file));
}
int fdatasync(int file) {
    return no_change() ? -1 : static_cast<int>(syscall(SYS_fdatasync, file));
}
int ftruncate(int file, off_t length) noexcept {
    return no_change() ? -1 : static_cast<int>(syscall(SYS_ftruncate, file, length));
}
int mkdir(const char* path, mode_t mode) noexcept {
    return no_change() ? -1 : static_cast<int>(syscall(SYS_mkdir, path, mode));
}
int rename(const char* from, const char* to) noexcept {
    if (is_child) return 0;
    return no_change() ? -1 : static_cast<int>(syscall(SYS_rename, from, to));
}
int renameat2(int folder, const char* from, int other, const char* to, unsigned flags) noexcept {
    if (is_child) return 0;
    return no_change() ? -1
                       : static_cast<int>(syscall(SYS_renameat2, folder, from, other, to, flags));
}
int unlink(const char* path) noexcept {
    return is_child ? 0 : static_cast<int>(syscall(SYS_unlink, path));
}
int unlinkat(int folder, const char* path, int flags) noexcept {
    return is_child ? 0 : static_cast<int>(syscall(SYS_unlinkat, folder, path, flags));
}
int rmdir(const char* path) noexcept {
    return is_child ? 0 : static_cast<int>(syscall(SYS_rmdir, path));
}

void exit(int code) {
    end_child(code);
    report();
    next<void (*)(int)>("exit")(code);
    _exit(code);
}

}  // extern "C"
