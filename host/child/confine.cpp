// SPDX-License-Identifier: MIT
#include "child/confine.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/descriptor.h"

namespace topple::child {
namespace {

// Landlock as the kernel numbers it (linux/landlock.h), of which a system's headers may lack the
// later half.
namespace landlock {

constexpr long create_ruleset = 444, add_rule = 445, restrict_self = 446;
constexpr unsigned ask_version = 1, rule_path_beneath = 1;
constexpr std::uint64_t write_file = 1 << 1, read_file = 1 << 2, read_dir = 1 << 3,
                        remove_dir = 1 << 4, remove_file = 1 << 5, make_dir = 1 << 7,
                        make_reg = 1 << 8, truncate = 1 << 14;
constexpr std::uint64_t to_read = read_file | read_dir;
constexpr std::uint64_t to_write =
    to_read | write_file | remove_dir | remove_file | make_dir | make_reg | truncate;
constexpr std::uint64_t of_a_file = read_file | write_file | truncate;

// What each version handles, beginning with that of files.
struct Ruleset {
    std::uint64_t files, net, scopes;
};
struct [[gnu::packed]] Beneath {
    std::uint64_t allowed;
    std::int32_t parent;
};

std::uint64_t files_of(long version) {
    const int bits = version >= 5 ? 16 : version >= 3 ? 15 : version == 2 ? 14 : 13;
    return (std::uint64_t{1} << bits) - 1;
}

void allow(int ruleset, const std::filesystem::path& path, std::uint64_t rights) {
    const Descriptor open(::open(path.c_str(), O_PATH | O_CLOEXEC));
    struct stat status {};
    if (open.get() < 0 || ::fstat(open.get(), &status) != 0) return;
    const Beneath rule{S_ISDIR(status.st_mode) ? rights : rights & of_a_file, open.get()};
    ::syscall(add_rule, ruleset, rule_path_beneath, &rule, 0);
}

void take_on(const Reach& reach) {
    const long version = ::syscall(create_ruleset, nullptr, 0, ask_version);
    if (version < 1) return;
    const Ruleset handled{files_of(version), 3, 3};
    const std::size_t size = version >= 6 ? 24 : version >= 4 ? 16 : 8;
    const auto ruleset = static_cast<int>(::syscall(create_ruleset, &handled, size, 0));
    if (ruleset < 0) return;
    for (const auto& path : reach.read) allow(ruleset, path, to_read & handled.files);
    for (const auto& path : reach.write) allow(ruleset, path, to_write & handled.files);
    allow(ruleset, "/proc/self", to_read);
    ::syscall(restrict_self, ruleset, 0);
    ::close(ruleset);
}

}  // namespace landlock

#if defined(__x86_64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t architecture = 0;
#endif

// What no reader of files calls.
constexpr std::uint32_t refused[] = {
    __NR_socket,
    __NR_socketpair,
    __NR_connect,
    __NR_bind,
    __NR_listen,
    __NR_execve,
    __NR_execveat,
    __NR_ptrace,
    __NR_kill,
    __NR_process_vm_readv,
    __NR_process_vm_writev,
    __NR_unshare,
    __NR_setns,
    __NR_mount,
    __NR_umount2,
    __NR_pivot_root,
    __NR_chroot,
    __NR_bpf,
    __NR_perf_event_open,
    __NR_keyctl,
    __NR_add_key,
    __NR_request_key,
    __NR_init_module,
    __NR_finit_module,
    __NR_linkat,
    __NR_symlinkat,
    __NR_mknodat,
    __NR_fchmod,
    __NR_fchmodat,
    __NR_fchown,
    __NR_fchownat,
    __NR_setxattr,
    __NR_shmget,
    __NR_semget,
    __NR_msgget,
    __NR_mq_open,
    __NR_open_by_handle_at,
    __NR_name_to_handle_at,
    __NR_userfaultfd,
    425 /* io_uring_setup */,
    426 /* io_uring_enter */,
    434 /* pidfd_open */,
    438 /* pidfd_getfd */,
#if defined(__x86_64__)
    __NR_fork,
    __NR_vfork,
    __NR_link,
    __NR_symlink,
    __NR_mknod,
    __NR_chmod,
    __NR_chown,
    __NR_lchown,
#endif
};
constexpr std::uint32_t clone3 = 435, clone_thread = 0x00010000;

void refuse_calls() {
    if (architecture == 0) return;
    constexpr std::uint32_t number = offsetof(seccomp_data, nr),
                            arch = offsetof(seccomp_data, arch),
                            first_word = offsetof(seccomp_data, args);
    const auto load = [](std::uint32_t at) {
        return sock_filter{BPF_LD | BPF_W | BPF_ABS, 0, 0, at};
    };
    const auto answer = [](int error) {
        return sock_filter{BPF_RET | BPF_K, 0, 0,
                           SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error)};
    };
    // Skips the next instruction unless what was loaded is, or has, this.
    const auto if_equal = [](std::uint32_t value) {
        return sock_filter{BPF_JMP | BPF_JEQ | BPF_K, 0, 1, value};
    };
    std::vector<sock_filter> program{
        load(arch), {BPF_JMP | BPF_JEQ | BPF_K, 1, 0, architecture}, answer(EPERM), load(number)};
#if defined(__x86_64__)
    // The same calls under other numbers, of x32.
    program.push_back({BPF_JMP | BPF_JGE | BPF_K, 0, 1, 0x40000000});
    program.push_back(answer(ENOSYS));
#endif
    for (const std::uint32_t call : refused) {
        program.push_back(if_equal(call));
        program.push_back(answer(EPERM));
    }
    // Of threads, which a library may start, the C library asks by clone where there is no clone3.
    program.push_back(if_equal(clone3));
    program.push_back(answer(ENOSYS));
    program.push_back({BPF_JMP | BPF_JEQ | BPF_K, 0, 3, __NR_clone});
    program.push_back(load(first_word));
    program.push_back({BPF_JMP | BPF_JSET | BPF_K, 1, 0, clone_thread});
    program.push_back(answer(EPERM));
    program.push_back({BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW});
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter);
}

}  // namespace

void end_with(long parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
    if (::getppid() != parent) std::_Exit(1);  // it has died already
}

void confine(const Reach& reach) {
    // Both ask for it: no program that it could start would give it more rights.
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    landlock::take_on(reach);
    refuse_calls();
}

}  // namespace topple::child
