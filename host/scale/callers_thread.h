// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "topple/parse.h"

namespace topple {

// Options whose callbacks may be called from any thread, and reach the caller's on this one alone:
// progress that others tell is passed on when this thread polls next, and all see what it was told.
inline ParseOptions called_here(const ParseOptions& options) {
    struct Shared {
        std::thread::id here = std::this_thread::get_id();
        std::atomic<bool> cancelled{false};
        std::mutex mutex;
        std::optional<std::pair<std::string, double>> told;  // by others
    };
    const auto shared = std::make_shared<Shared>();
    ParseOptions out = options;
    if (options.progress) {
        out.progress = [shared, progress = options.progress](const std::string& name, double done) {
            const bool is_here = std::this_thread::get_id() == shared->here;
            {
                const std::lock_guard lock(shared->mutex);
                shared->told.reset();
                if (!is_here) shared->told.emplace(name, done);
            }
            if (is_here) progress(name, done);
        };
    }
    out.cancelled = [shared, progress = options.progress, cancelled = options.cancelled] {
        if (shared->cancelled || std::this_thread::get_id() != shared->here)
            return shared->cancelled.load();
        std::optional<std::pair<std::string, double>> told;
        {
            const std::lock_guard lock(shared->mutex);
            told.swap(shared->told);
        }
        if (told) progress(told->first, told->second);
        if (cancelled && cancelled()) shared->cancelled = true;
        return shared->cancelled.load();
    };
    return out;
}

}  // namespace topple
