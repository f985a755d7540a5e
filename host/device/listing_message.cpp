// SPDX-License-Identifier: MIT
#include "device/listing_message.h"

#include <algorithm>

#include "child/message.h"
#include "core/printable.h"
#include "device/devices.h"

namespace topple::device {
namespace {

template <class Archive, class Info>
void fields(Archive& a, Info& listing) {
    a(listing.usable);
    a(listing.problem);
    auto& info = listing.info;
    a(info.name);
    a(info.driver);
    a(info.gpu);
    a(info.limits);
}

// Drivers' texts are printed, in a line.
void make_printable(std::string& text) {
    std::ranges::replace_if(
        text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    text = printable(text, std::string::npos);
}

}  // namespace

std::vector<Listing> list_backend(const std::string& backend) {
    return backend == to_string(Backend::opencl) ? list_opencl() : list_vulkan();
}

void write_listings(const std::vector<Listing>& listings) {
    child::Writer out;
    list_fields(out, listings, [](auto& io, auto& listing) { fields(io, listing); });
    out.finish();
}

std::vector<Listing> take_listings(const child::Answer& answer, Backend backend) {
    child::Reader in(answer);
    std::vector<Listing> listings;
    list_fields(in, listings, [](auto& io, auto& listing) { fields(io, listing); });
    for (Listing& listing : listings) {
        listing.backend = listing.info.backend = backend;
        make_printable(listing.problem);
        make_printable(listing.info.name);
        make_printable(listing.info.driver);
    }
    in.finish();
    return listings;
}

}  // namespace topple::device
