// SPDX-License-Identifier: MIT
#include "io/pending_outputs.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstring>

namespace topple::io {
namespace {

enum State : int { free_slot, changing, pending };

struct Slot {
    std::atomic<int> state{free_slot};
    int parents = 0;
    char path[PATH_MAX];
};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait for a lock");

std::array<Slot, 16> slots;

// What getdents64 fills in; the C library has no name for it.
struct Entry {
    std::uint64_t inode;
    std::int64_t offset;
    unsigned short length;
    unsigned char type;
    char name[1];
};

// Nothing that is written is nested deeper.
constexpr int deepest = 6;

// Removes what is in the folder of that path, PATH_MAX long, all but the lock of the outermost one;
// by one descriptor at a time, as there may be no more.
void unlink_all(char* path, int depth) {
    const std::size_t length = std::strlen(path);
    for (;;) {
        const int folder = ::open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        if (folder < 0) return;
        char inner[NAME_MAX + 1] = {};  // a folder that is not empty
        alignas(Entry) char buffer[2048];
        for (long bytes; (bytes = ::syscall(SYS_getdents64, folder, buffer, sizeof(buffer))) > 0;) {
            for (long at = 0; at < bytes;) {
                const auto* entry = reinterpret_cast<const Entry*>(buffer + at);
                const char* name = buffer + at + offsetof(Entry, name);
                at += entry->length;
                const bool dots =
                    name[0] == '.' && (name[1] == 0 || (name[1] == '.' && name[2] == 0));
                if (dots || (depth == 0 && std::strcmp(name, staging_lock) == 0)) continue;
                if (::unlinkat(folder, name, 0) != 0 &&
                    ::unlinkat(folder, name, AT_REMOVEDIR) != 0 &&
                    (errno == ENOTEMPTY || errno == EEXIST))
                    std::strncpy(inner, name, NAME_MAX);
            }
        }
        ::close(folder);
        if (inner[0] == 0 || depth == deepest || length + NAME_MAX + 2 >= PATH_MAX) return;
        path[length] = '/';
        std::strcpy(path + length + 1, inner);
        unlink_all(path, depth + 1);
        const bool removed = ::rmdir(path) == 0;
        path[length] = 0;
        if (!removed) return;
    }
}

}  // namespace

int add_pending(const std::filesystem::path& folder, int parents) noexcept {
    const auto& text = folder.native();
    if (text.size() >= PATH_MAX) return -1;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        int expected = free_slot;
        if (!slots[i].state.compare_exchange_strong(expected, changing)) continue;
        std::memcpy(slots[i].path, text.c_str(), text.size() + 1);
        slots[i].parents = parents;
        slots[i].state.store(pending);
        return static_cast<int>(i);
    }
    return -1;
}

void forget_pending(int slot) noexcept {
    if (slot >= 0) slots[slot].state.store(free_slot);
}

void remove_tree(const char* path) noexcept {
    char within[PATH_MAX];
    if (std::strlen(path) >= PATH_MAX) return;
    std::strcpy(within, path);
    // Another thread may add a file while we remove: look again. What is empty takes no descriptor.
    for (int attempt = 0; attempt < 100 && ::rmdir(path) != 0; ++attempt) {
        unlink_all(within, 0);
        const int folder = ::open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        if (folder < 0) return;
        ::unlinkat(folder, staging_lock, 0);
        ::close(folder);
    }
}

void remove_pending_outputs() noexcept {
    // Another thread may just have begun with one more.
    for (int round = 0; round < 2; ++round) {
        for (auto& slot : slots) {
            if (slot.state.load() != pending) continue;
            remove_tree(slot.path);
            std::size_t end = std::strlen(slot.path);
            for (int i = 0; i < slot.parents; ++i) {
                char parent[PATH_MAX];
                while (end > 0 && slot.path[end - 1] != '/') --end;
                if (end <= 1) break;
                --end;
                std::memcpy(parent, slot.path, end);
                parent[end] = 0;
                ::rmdir(parent);
            }
        }
    }
}

}  // namespace topple::io
