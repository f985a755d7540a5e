// SPDX-License-Identifier: MIT
#include "perf/report.h"

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "io/replace_file.h"
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

void print_score(const scenes::Score& s) {
    std::printf(
        "\nscore: parts mIoU %.3f, Hamming %.3f, missing %.3f, false alarm %.3f; objects mIoU "
        "%.3f\n",
        s.parts.miou, s.parts.hamming, s.parts.missing, s.parts.false_alarm, s.objects.miou);
    std::printf(
        "       volume precision %.3f, recall %.3f; fixed recall %.3f, precision %.3f; support "
        "recall %.3f, precision %.3f; "
        "gravity %.2f deg\n",
        s.volume.precision.value, s.volume.recall.value, s.relations.fixed_recall.value,
        s.relations.fixed_precision.value, s.relations.support_recall.value,
        s.relations.support_precision.value, s.gravity_deg);
    std::fflush(stdout);
}

void write_json(const std::string& path, const std::vector<Result>& results) {
    nlohmann::json list = nlohmann::json::array();
    for (const Result& r : results) {
        list.push_back({{"backend", r.backend},
                        {"device", r.device},
                        {"driver", r.driver},
                        {"gpu", r.gpu},
                        {"case", r.name},
                        {"unit", r.work.unit},
                        {"items", r.work.items},
                        {"bytes", r.work.bytes},
                        {"operations", r.work.operations},
                        {"divisions", r.work.divisions},
                        {"gathers", r.work.gathers},
                        {"samples_s", r.samples_s},
                        {"samples_cpu_s", r.samples_cpu_s},
                        {"best_s", r.best()},
                        {"best_cpu_s", r.best_cpu()},
                        {"median_s", r.median()},
                        {"share", r.share},
                        {"bound", r.bound},
                        {"hash", hex(r.hash)},
                        {"counts",
                         {{"dispatches", r.counters.dispatches},
                          {"submits", r.counters.submits},
                          {"kernel_builds", r.counters.kernel_builds},
                          {"bytes_written", r.counters.bytes_written},
                          {"bytes_read", r.counters.bytes_read},
                          {"bytes_bound", r.counters.bytes_bound}}}});
    }
    const nlohmann::json root{
        {"schema", "topple.perf/2"},
        {"topple_version", version},
        {"machine", {{"cpu", cpu_name()}, {"cores", std::thread::hardware_concurrency()}}},
        {"results", list}};
    io::replace_file(path, root.dump(1) + "\n");
}

void write_csv(const std::string& path, const std::vector<Result>& results) {
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
    io::replace_file(path, out.str());
}

}  // namespace topple::perf
