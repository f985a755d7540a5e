// SPDX-License-Identifier: MIT
// What every sanitized executable takes as given about libraries that are not instrumented. The
// sanitizers' runtime calls these functions by name; nothing of topple's own may be listed here.

#if defined(__SANITIZE_ADDRESS__)

// PoCL and its compiler keep their state until the process ends, and so does what cairo chooses
// fonts with. What assimp and OpenVDB made of a damaged file is lost.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libpocl\n"
           "leak:libLLVM\n"
           "leak:libfontconfig\n"
           "leak:libassimp\n"
           "leak:libopenvdb\n";
}

// What is suppressed is not listed on stderr, which tests compare.
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() {
    return "print_suppressions=0";
}

// The loaders unload drivers before leaks are looked for, and a frame of an unloaded library has no
// name that a suppression could match.
extern "C" int dlclose(void* handle);
extern "C" int dlclose(void*) {
    return 0;
}

#elif defined(__SANITIZE_THREAD__)

#include <oneapi/tbb/global_control.h>

namespace {

// OpenVDB hands work to libtbb, whose synchronisation cannot be seen, so that its threads would
// seem to race with whoever reads their results. Without workers there are none; topple's own
// threads are not libtbb's.
const oneapi::tbb::global_control no_tbb_workers{
    oneapi::tbb::global_control::max_allowed_parallelism, 1};

}  // namespace

// Nor can it be seen that libtbb's allocator gives what one thread freed to another: OpenVDB keeps
// the accessors of each grid, which belongs to one thread, in such a table.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "race:tbb::detail::d2::hash_map_base\n"
           "race:tbb::detail::d2::concurrent_hash_map\n";
}

#endif
