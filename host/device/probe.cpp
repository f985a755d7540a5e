// SPDX-License-Identifier: MIT
#include "device/probe.h"

#include <map>
#include <mutex>

#include "child/message.h"
#include "child/process.h"
#include "child/program.h"
#include "device/devices.h"
#include "device/listing_message.h"

namespace topple::device {
namespace {

// A driver that builds its kernels when it is listed takes seconds at most.
constexpr double patience_s = 30;

Listing unusable(Backend backend, const std::string& problem) {
    Listing listing;
    listing.backend = backend;
    listing.problem = problem;
    return listing;
}

std::string of_driver(const std::string& what) {
    return "its driver " + what +
           " when it was tried in a process of its own; mend or remove the driver";
}

// With the environment that steers drivers, as they would have it here.
std::vector<Listing> probe_apart(const std::string& program, Backend backend) {
    const child::Ended ended = child::run(program, {"devices", to_string(backend)},
                                          {.wall_s = patience_s, .whole_environment = true}, [] {});
    if (!ended.answer.whole())
        return {unusable(backend, ended.started ? of_driver(ended.how) : ended.how)};
    try {
        return take_listings(ended.answer, backend);
    } catch (const child::BadAnswer&) {
        return {unusable(backend, of_driver("gave an answer that makes no sense"))};
    }
}

bool went_well(const std::vector<Listing>& listings) {
    for (const Listing& listing : listings)
        if (listing.usable) return true;
    return false;
}

}  // namespace

std::vector<Listing> probe(Backend backend) {
    static std::mutex mutex;
    static std::map<Backend, std::vector<Listing>> known;
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(backend); found != known.end()) return found->second;
    const std::string program = child::find_program(child::reader_program).string();
    std::vector<Listing> listings =
        program.empty() ? list_backend(to_string(backend)) : probe_apart(program, backend);
    if (went_well(listings)) known.emplace(backend, listings);
    return listings;
}

}  // namespace topple::device
