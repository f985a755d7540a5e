// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "testing.h"
#include "topple/kernels/device.h"

// What a trace says, held to what the device has counted.
namespace topple::test {

struct TraceFile {
    nlohmann::json events;

    explicit TraceFile(const std::filesystem::path& file) {
        std::ifstream in(file);
        events = nlohmann::json::parse(in).at("traceEvents");
    }
    std::vector<nlohmann::json> of_kind(const std::string& kind) const {
        std::vector<nlohmann::json> some;
        for (const auto& event : events)
            if (event.value("cat", "") == kind) some.push_back(event);
        return some;
    }
    std::set<std::string> names(const std::string& kind) const {
        std::set<std::string> all;
        for (const auto& event : of_kind(kind)) all.insert(event.at("name"));
        return all;
    }
    // The names of the devices' tracks.
    std::vector<std::string> devices() const {
        std::vector<std::string> all;
        for (const auto& event : events)
            if (event.at("name") == "thread_name" && event.at("pid") == 2)
                all.push_back(event.at("args").at("name"));
        return all;
    }
    std::uint64_t sum(const std::string& kind, const char* number) const {
        std::uint64_t all = 0;
        for (const auto& event : of_kind(kind))
            all += event.at("args").at(number).get<std::uint64_t>();
        return all;
    }
    double microseconds(const std::string& kind) const {
        double all = 0;
        for (const auto& event : of_kind(kind)) all += event.at("dur").get<double>();
        return all;
    }
    void expect_counts(const device::Counters& counts) const {
        EXPECT_EQ(of_kind("dispatch").size(), counts.dispatches);
        EXPECT_EQ(sum("batch", "dispatches"), counts.dispatches);
        EXPECT_EQ(sum("dispatch", "bytes"), counts.bytes_bound);
        EXPECT_EQ(sum("write", "bytes"), counts.bytes_written);
        EXPECT_EQ(sum("read", "bytes"), counts.bytes_read);
        EXPECT_EQ(of_kind("build").size(), counts.kernel_builds);
    }
    // Every dispatch lies within a batch, and takes time; all of them no more than the batches.
    void expect_dispatches_in_batches() const {
        const auto batches = of_kind("batch");
        constexpr double rounding_us = 0.002;
        for (const auto& dispatch : of_kind("dispatch")) {
            const double begin = dispatch.at("ts"), end = begin + dispatch.at("dur").get<double>();
            EXPECT_GE(dispatch.at("dur").get<double>(), 0);
            EXPECT_TRUE(std::ranges::any_of(batches, [&](const nlohmann::json& batch) {
                const double from = batch.at("ts"), to = from + batch.at("dur").get<double>();
                return from <= begin + rounding_us && end <= to + rounding_us;
            })) << dispatch;
        }
        EXPECT_LE(microseconds("dispatch"), microseconds("batch"));
        EXPECT_GT(microseconds("dispatch"), 0);
    }
};

}  // namespace topple::test
