// SPDX-License-Identifier: MIT
#include "core/build_id.h"

#include <elf.h>
#include <link.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace topple {
namespace {

struct BuildIdSearch {
    std::uintptr_t code;
    std::string id;
};

// The note of type NT_GNU_BUILD_ID, if there is one among these.
std::string build_id_in(const char* at, std::size_t left) {
    const auto padded = [](std::size_t size) { return (size + 3) / 4 * 4; };
    while (left >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) head;
        std::memcpy(&head, at, sizeof(head));
        const std::size_t name = sizeof(head), id = name + padded(head.n_namesz),
                          end = id + padded(head.n_descsz);
        if (end > left) break;
        if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 &&
            std::memcmp(at + name, "GNU", 4) == 0)
            return {at + id, head.n_descsz};
        at += end;
        left -= end;
    }
    return {};
}

int look_at(dl_phdr_info* info, std::size_t, void* data) {
    auto& search = *static_cast<BuildIdSearch*>(data);
    bool own = false;
    for (int n = 0; n < info->dlpi_phnum; ++n) {
        const auto& part = info->dlpi_phdr[n];
        const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr;
        own = own || (part.p_type == PT_LOAD && search.code >= begin &&
                      search.code < begin + part.p_memsz);
    }
    if (!own) return 0;
    for (int n = 0; n < info->dlpi_phnum && search.id.empty(); ++n) {
        const auto& part = info->dlpi_phdr[n];
        if (part.p_type == PT_NOTE)
            search.id = build_id_in(reinterpret_cast<const char*>(info->dlpi_addr + part.p_vaddr),
                                    part.p_memsz);
    }
    return 1;
}

}  // namespace

std::string build_id() {
    BuildIdSearch search{reinterpret_cast<std::uintptr_t>(&look_at), {}};
    dl_iterate_phdr(look_at, &search);
    return search.id;
}

}  // namespace topple
