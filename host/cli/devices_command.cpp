// SPDX-License-Identifier: MIT
#include <cstdio>
#include <string>

#include "cli/commands.h"
#include "cli/print.h"
#include "topple/device.h"

namespace topple::cli {
namespace {

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

Command add_devices(CLI::App&) {
    return [] {
        for (const device::Listing& l : device::list_devices()) {
            if (!l.usable) {
                print("%-7s not usable: %s\n", device::to_string(l.backend), l.problem.c_str());
                continue;
            }
            const device::Limits& limits = l.info.limits;
            print(
                "%-7s %s%s\n        driver %s\n        memory %s, one allocation %s, one binding "
                "%s, group %u, shared %u KiB\n",
                device::to_string(l.backend), l.info.name.c_str(), l.info.gpu ? " (GPU)" : "",
                l.info.driver.c_str(), mebibytes(limits.memory_bytes).c_str(),
                mebibytes(limits.max_allocation_bytes).c_str(),
                mebibytes(limits.max_binding_bytes).c_str(), limits.max_group_size,
                limits.shared_bytes >> 10);
        }
        return 0;
    };
}

}  // namespace topple::cli
