// SPDX-License-Identifier: MIT
#include "perf/kernels/report.h"

#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include "core/printable.h"
#include "topple/version.h"

namespace topple::perf {
namespace {

std::string hex(std::uint64_t v) {
    char text[20];
    std::snprintf(text, sizeof(text), "%016" PRIx64, v);
    return text;
}

// 1234567 as "1.23 M".
std::string scaled(double v) {
    const char* suffix[] = {"", "k", "M", "G", "T"};
    int step = 0;
    while (v >= 999.5 && step < 4) {
        v /= 1000;
        ++step;
    }
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g %s", v, suffix[step]);
    return text;
}

std::string cpu_name() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("model name"))
            return line.substr(std::min(line.size(), line.find(':') + 2));
    }
    return "unknown";
}

// A field of a CSV that may hold commas.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    return out += '"';
}

// As JSON.
std::string number(double v) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof(text), v).ptr};
}
std::string numbers(const std::vector<double>& values) {
    std::string out = "[";
    for (const double v : values) out += (out.size() > 1 ? ", " : "") + number(v);
    return out + "]";
}
std::string text(const std::string& from) {
    std::string out = "\"";
    for (const char c : printable(from, std::string::npos)) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + "\"";
}

}  // namespace

void print_results(const std::vector<Result>& results) {
    if (results.empty()) return;
    std::printf("\n%s: %s\n", results.front().backend.c_str(), results.front().device.c_str());
    std::printf("%-26s %10s %10s %7s  %-24s %9s %9s  %-18s %s\n", "case", "best ms", "median ms",
                "spread", "throughput", "GB/s", "Gop/s", "roofline", "hash");
    for (const Result& r : results) {
        const double best = r.best();
        char share[32] = "";
        if (r.share > 0) std::snprintf(share, sizeof(share), "%5.1f %% %s", 100 * r.share, r.bound);
        const std::string rate = scaled(r.work.items / best) + r.work.unit + "/s";
        std::printf("%-26s %10.3f %10.3f %6.1f%%  %-24s %9.2f %9.2f  %-18s %s\n", r.name.c_str(),
                    1e3 * best, 1e3 * r.median(), 100 * (r.worst() / best - 1), rate.c_str(),
                    r.work.bytes / best * 1e-9, r.work.operations / best * 1e-9, share,
                    r.hash ? hex(r.hash).c_str() : "");
    }
    std::fflush(stdout);
}

std::string json_text(const std::vector<Result>& results) {
    std::ostringstream out;
    out << "{\n \"schema\": \"topple.perf/2\",\n \"topple_version\": " << text(version)
        << ",\n \"machine\": {\"cpu\": " << text(cpu_name())
        << ", \"cores\": " << std::thread::hardware_concurrency() << "},\n \"results\": [";
    const char* between = "\n";
    for (const Result& r : results) {
        const auto& c = r.counters;
        out << between << "  {\"backend\": " << text(r.backend)
            << ", \"device\": " << text(r.device) << ", \"driver\": " << text(r.driver)
            << ", \"gpu\": " << (r.gpu ? "true" : "false") << ", \"case\": " << text(r.name)
            << ", \"unit\": " << text(r.work.unit) << ", \"items\": " << number(r.work.items)
            << ", \"bytes\": " << number(r.work.bytes)
            << ", \"operations\": " << number(r.work.operations)
            << ", \"divisions\": " << number(r.work.divisions)
            << ", \"gathers\": " << number(r.work.gathers)
            << ", \"samples_s\": " << numbers(r.samples_s)
            << ", \"samples_cpu_s\": " << numbers(r.samples_cpu_s)
            << ", \"best_s\": " << number(r.best()) << ", \"best_cpu_s\": " << number(r.best_cpu())
            << ", \"median_s\": " << number(r.median()) << ", \"share\": " << number(r.share)
            << ", \"bound\": " << text(r.bound) << ", \"hash\": " << text(hex(r.hash))
            << ", \"counts\": {\"dispatches\": " << c.dispatches << ", \"submits\": " << c.submits
            << ", \"kernel_builds\": " << c.kernel_builds
            << ", \"bytes_written\": " << c.bytes_written << ", \"bytes_read\": " << c.bytes_read
            << ", \"bytes_bound\": " << c.bytes_bound << "}}";
        between = ",\n";
    }
    out << "\n ]\n}\n";
    return out.str();
}

std::string csv_text(const std::vector<Result>& results) {
    std::ostringstream out;
    out << "backend,device,driver,case,best_ms,median_ms,worst_ms,best_cpu_ms,samples,items,unit,"
           "bytes,operations,divisions,gathers,share,bound,dispatches,submits,bytes_written,bytes_"
           "read,bytes_bound,"
           "kernel_builds,hash\n";
    for (const Result& r : results) {
        out << r.backend << ',' << quoted(r.device) << ',' << quoted(r.driver) << ',' << r.name
            << ',' << 1e3 * r.best() << ',' << 1e3 * r.median() << ',' << 1e3 * r.worst() << ','
            << 1e3 * r.best_cpu() << ',' << r.samples_s.size() << ',' << r.work.items << ','
            << r.work.unit << ',' << r.work.bytes << ',' << r.work.operations << ','
            << r.work.divisions << ',' << r.work.gathers << ',' << r.share << ',' << r.bound << ','
            << r.counters.dispatches << ',' << r.counters.submits << ',' << r.counters.bytes_written
            << ',' << r.counters.bytes_read << ',' << r.counters.bytes_bound << ','
            << r.counters.kernel_builds << ',' << hex(r.hash) << '\n';
    }
    return out.str();
}

}  // namespace topple::perf
