// SPDX-License-Identifier: MIT
#include "device/probe.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "child/message.h"
#include "child/process.h"
#include "child/program.h"
#include "core/printable.h"
#include "device/devices.h"

namespace topple::device {
namespace {

// A driver that builds its kernels when it is listed takes seconds at most.
constexpr double patience_s = 30;

// Listings as a child's answer.
template <class Io, class Listings>
void answer_fields(Io& io, Listings& listings) {
    list_fields(io, listings, [](auto& each, auto& listing) {
        each(listing.usable);
        each(listing.problem);
        each(listing.info.name);
        each(listing.info.driver);
        each(listing.info.gpu);
        each(listing.info.limits);
    });
}

// Drivers' texts are printed, in a line.
void make_printable(std::string& text) {
    std::ranges::replace_if(
        text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    text = printable(text, std::string::npos);
}

std::vector<Listing> list_here(Backend backend) {
    return backend == Backend::opencl ? list_opencl() : list_vulkan();
}

// Throws child::BadAnswer where it is none of `backend`.
std::vector<Listing> take_listings(const child::Answer& answer, Backend backend) {
    child::Reader in(answer);
    std::vector<Listing> listings;
    answer_fields(in, listings);
    for (Listing& listing : listings) {
        listing.backend = listing.info.backend = backend;
        make_printable(listing.problem);
        make_printable(listing.info.name);
        make_printable(listing.info.driver);
    }
    in.finish();
    return listings;
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

}  // namespace

std::vector<Listing> probe(Backend backend) {
    static std::mutex mutex;
    static std::map<Backend, std::vector<Listing>> known;
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(backend); found != known.end()) return found->second;
    const std::string program = child::find_program(child::reader_program).string();
    std::vector<Listing> listings =
        program.empty() ? list_here(backend) : probe_apart(program, backend);
    if (std::ranges::any_of(listings, &Listing::usable)) known.emplace(backend, listings);
    return listings;
}

void answer_probe(const std::string& backend) {
    const std::vector<Listing> listings =
        list_here(backend == to_string(Backend::opencl) ? Backend::opencl : Backend::vulkan);
    child::Writer out;
    answer_fields(out, listings);
    out.finish();
}

}  // namespace topple::device
