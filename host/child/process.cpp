// SPDX-License-Identifier: MIT
#include "child/process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include "child/answer_head.h"
#include "child/environment.h"
#include "core/descriptor.h"
#include "topple/version.h"

namespace topple::child {
namespace {

constexpr int poll_ms = 20;
// The child's side of a pipe that ends with it.
constexpr int life_descriptor = answer_descriptor + 1;

// Thrown where there is no process to run in.
struct NotStarted {
    std::string why;
};

[[noreturn]] void not_started(const std::string& what, int error) {
    const bool limited = error == EMFILE || error == ENFILE || error == EAGAIN || error == ENOMEM;
    throw NotStarted{what + std::strerror(error) + (limited ? "; raise the limits (ulimit)" : "")};
}

// Above those that the child gets, so that giving it one does not overwrite another.
Descriptor moved_up(const Descriptor& low) {
    const int up = ::fcntl(low.get(), F_DUPFD_CLOEXEC, life_descriptor + 1);
    if (up < 0) not_started("no descriptor: ", errno);
    return Descriptor(up);
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> out;
    for (std::string& word : words) out.push_back(word.data());
    out.push_back(nullptr);
    return out;
}

class Spawning {
  public:
    Spawning() {
        ::posix_spawn_file_actions_init(&actions_);
        ::posix_spawnattr_init(&attributes_);
    }
    Spawning(const Spawning&) = delete;
    Spawning& operator=(const Spawning&) = delete;
    ~Spawning() {
        ::posix_spawn_file_actions_destroy(&actions_);
        ::posix_spawnattr_destroy(&attributes_);
    }

    // Without the host's descriptors, signal handlers and masks; in a group of its own, so that
    // Ctrl-C is the parent's business; and in no folder of a scan, where a stranger's library may
    // lie.
    pid_t start(const std::string& program, std::vector<std::string>& words, int answer, int life,
                std::optional<std::vector<std::string>> variables) {
        ::posix_spawn_file_actions_addchdir_np(&actions_, "/");
        ::posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_addopen(&actions_, 1, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_addopen(&actions_, 2, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_adddup2(&actions_, answer, answer_descriptor);
        ::posix_spawn_file_actions_adddup2(&actions_, life, life_descriptor);
        ::posix_spawn_file_actions_addclosefrom_np(&actions_, life_descriptor + 1);
        sigset_t none, all;
        ::sigemptyset(&none);
        ::sigfillset(&all);
        ::posix_spawnattr_setsigmask(&attributes_, &none);
        ::posix_spawnattr_setsigdefault(&attributes_, &all);
        ::posix_spawnattr_setpgroup(&attributes_, 0);
        ::posix_spawnattr_setflags(
            &attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
        const std::vector<char*> argv = pointers(words);
        std::vector<char*> chosen;
        if (variables) chosen = pointers(*variables);
        pid_t child = -1;
        const int error = ::posix_spawn(&child, program.c_str(), &actions_, &attributes_,
                                        argv.data(), variables ? chosen.data() : environ);
        if (error != 0)
            not_started(::access("/dev/null", R_OK | W_OK) == 0 ? "" : "/dev/null: ", error);
        return child;
    }

  private:
    posix_spawn_file_actions_t actions_;
    posix_spawnattr_t attributes_;
};

// Waits for a child, and ends it where it goes first.
class Child {
  public:
    explicit Child(pid_t id) : id_(id) {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (!over_) end();
    }

    // Whether it is over.
    bool look() {
        const pid_t got = ::waitpid(id_, &status_, WNOHANG);
        if (got == 0 || (got < 0 && errno == EINTR)) return false;
        known_ = got == id_;  // else somebody else in this process waits for its children
        return over_ = true;
    }
    void end() {
        ::kill(id_, SIGKILL);
        while (!over_) {
            const pid_t got = ::waitpid(id_, &status_, 0);
            over_ = got >= 0 || errno != EINTR;
        }
    }
    // The exit code of the dynamic loader, and of shells, for a program that can't be run; else 0.
    // A program that has begun may end with the same ones.
    int loader_failed() const {
        const int code = known_ && WIFEXITED(status_) ? WEXITSTATUS(status_) : 0;
        return code == 126 || code == 127 ? code : 0;
    }
    std::string how(const Limits& limits) const {
        if (!known_) return "ended without an answer";
        if (WIFSIGNALED(status_)) {
            const int signal = WTERMSIG(status_);
            if (signal == SIGXCPU)
                return "took more than the " + std::to_string(limits.cpu_s) + " s that it may";
            return std::string("crashed (") + ::strsignal(signal) + ")";
        }
        return "ended without an answer (exit code " + std::to_string(WEXITSTATUS(status_)) + ")";
    }

  private:
    pid_t id_;
    int status_ = 0;
    bool over_ = false, known_ = false;
};

}  // namespace

Answer::Answer(int descriptor) {
    const Descriptor memory(descriptor);
    struct stat status {};
    constexpr int seals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;
    if (::fcntl(memory.get(), F_ADD_SEALS, seals) != 0 || ::fstat(memory.get(), &status) != 0 ||
        static_cast<std::uint64_t>(status.st_size) < answer_head)
        return;
    size_ = static_cast<std::size_t>(status.st_size);
    void* const at = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, memory.get(), 0);
    if (at == MAP_FAILED) return;
    data_ = static_cast<std::byte*>(at);
    AnswerHead head;
    std::memcpy(&head, data_, sizeof(head));
    if (head.magic == answer_magic && head.size == size_) return;
    ::munmap(data_, size_);
    data_ = nullptr;
}

Answer::Answer(Answer&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(other.size_) {}

Answer::~Answer() {
    if (data_) ::munmap(data_, size_);
}

std::span<const std::byte> Answer::bytes() const {
    return std::span<const std::byte>(data_, size_).subspan(answer_head);
}

void Answer::release(std::size_t end) const {
    ::madvise(data_, answer_head + end, MADV_DONTNEED);
}

namespace {

Ended run_started(const std::string& program, const std::vector<std::string>& task,
                  const Limits& limits, const std::function<void()>& poll) {
    const int memory = ::memfd_create("topple-answer", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (memory < 0) not_started("no memory to share: ", errno);
    Descriptor answer = moved_up(Descriptor(memory));
    int pipe[2];
    if (::pipe2(pipe, O_CLOEXEC) != 0) not_started("no pipe: ", errno);
    const Descriptor alive(pipe[0]);
    Descriptor life = moved_up(Descriptor(pipe[1]));
    std::vector<std::string> words{program, version, std::to_string(::getpid()),
                                   std::to_string(limits.memory_bytes),
                                   std::to_string(limits.cpu_s)};
    words.insert(words.end(), task.begin(), task.end());
    Child child(Spawning().start(
        program, words, answer.get(), life.get(),
        limits.whole_environment ? std::nullopt : std::optional(plain_environment())));
    life = Descriptor();
    const auto start = std::chrono::steady_clock::now();
    pollfd ends{alive.get(), POLLIN, 0};
    bool over = false;
    while (!over) {
        // The pipe's end tells at once; but a process forked meanwhile may hold it open.
        const bool ended = ::poll(&ends, 1, poll_ms) > 0;
        if (ended) ::usleep(200);
        over = child.look();
        if (over) break;
        if (poll) poll();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        if (taken.count() > limits.wall_s) {
            child.end();
            return {Answer(), "did not end within " +
                                  std::to_string(static_cast<std::uint64_t>(limits.wall_s)) + " s"};
        }
    }
    AnswerHead head;
    const bool begun =
        ::pread(answer.get(), &head, sizeof(head), 0) == sizeof(head) && head.magic == begun_magic;
    Answer got(answer.release());
    if (got.whole()) return {std::move(got), ""};
    if (const int code = begun ? 0 : child.loader_failed()) {
        return {Answer(),
                program + " did not start (exit code " + std::to_string(code) +
                    "): a shared library that it needs is missing here (ldd " + program +
                    "); put it on the library path",
                false};
    }
    return {Answer(), child.how(limits)};
}

}  // namespace

Ended run(const std::string& program, const std::vector<std::string>& task, const Limits& limits,
          const std::function<void()>& poll) {
    try {
        return run_started(program, task, limits, poll);
    } catch (const NotStarted& failed) {
        return {Answer(), program + " did not start: " + failed.why, false};
    }
}

}  // namespace topple::child
