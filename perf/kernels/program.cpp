// SPDX-License-Identifier: MIT
#include "topple/kernel_testing/program.h"

#include <getopt.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "perf/kernels/kernel_suite.h"
#include "perf/kernels/probes.h"
#include "perf/kernels/report.h"
#include "topple/error.h"

namespace topple::perf {
namespace {

constexpr const char* usage =
    "usage: %s perf [OPTION...]          measures the kernels on each backend\n"
    "       %s compare BASE [OPTION...]  whether it is slower than the program BASE (--help)\n"
    "\n"
    "  --filter TEXT     only cases whose name contains this; may be repeated\n"
    "  --backend LIST    native, opencl, vulkan, with commas, or all (default)\n"
    "  --json FILE       write all samples, counts and hashes\n"
    "  --csv FILE        write one line per case\n"
    "  --runs N          samples of each case (default: 7 to 100, for --seconds)\n"
    "  --seconds S       time for each case (default 1)\n"
    "  --threads N       of the native backend (default 0: all cores)\n"
    "  --no-roofline     without the probes of bandwidth and arithmetic\n"
    "  --list            print the names of the cases\n";

struct Options {
    std::vector<std::string> backends, filters;
    MeasureOptions measure;
    std::string json, csv;
    unsigned threads = 0;
    bool roofline = true, list = false, help = false;
};

double positive_number(const std::string& option, const std::string& text, double most) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end || !(value >= 0 && value <= most)) {
        throw Error(ErrorKind::usage, option + " " + text + ": it takes a number from 0 to " +
                                          std::to_string(static_cast<unsigned>(most)));
    }
    return value;
}
unsigned count(const std::string& option, const std::string& text) {
    return static_cast<unsigned>(positive_number(option, text, 1e6));
}

Options read_options(int argc, char** argv) {
    static constexpr option known[] = {{"filter", required_argument, nullptr, 'f'},
                                       {"backend", required_argument, nullptr, 'b'},
                                       {"json", required_argument, nullptr, 'j'},
                                       {"csv", required_argument, nullptr, 'c'},
                                       {"runs", required_argument, nullptr, 'r'},
                                       {"seconds", required_argument, nullptr, 's'},
                                       {"threads", required_argument, nullptr, 't'},
                                       {"no-roofline", no_argument, nullptr, 'n'},
                                       {"list", no_argument, nullptr, 'l'},
                                       {"help", no_argument, nullptr, 'h'},
                                       {}};
    Options options;
    ::opterr = 0;
    for (int letter; (letter = ::getopt_long(argc, argv, "", known, nullptr)) != -1;) {
        const std::string value = ::optarg ? ::optarg : "";
        std::istringstream list(value);
        switch (letter) {
            case 'f':
                options.filters.push_back(value);
                break;
            case 'b':
                for (std::string one; std::getline(list, one, ',');)
                    options.backends.push_back(one);
                break;
            case 'j':
                options.json = value;
                break;
            case 'c':
                options.csv = value;
                break;
            case 'r':
                options.measure.runs = count("--runs", value);
                break;
            case 's':
                options.measure.seconds = positive_number("--seconds", value, 3600);
                break;
            case 't':
                options.threads = count("--threads", value);
                break;
            case 'n':
                options.roofline = false;
                break;
            case 'l':
                options.list = true;
                break;
            case 'h':
                options.help = true;
                break;
            default:
                throw Error(ErrorKind::usage, std::string(argv[::optind - 1]) +
                                                  " is unknown, or lacks its value; see --help");
        }
    }
    if (::optind < argc)
        throw Error(ErrorKind::usage, std::string(argv[::optind]) + " is unknown; see --help");
    return options;
}

// Opened before the measuring, which takes minutes.
std::ofstream opened(const std::string& path) {
    std::ofstream file;
    if (path.empty()) return file;
    file.open(path);
    if (!file) throw Error(ErrorKind::input, path + " can't be written: " + std::strerror(errno));
    return file;
}

void finish(std::ofstream& file, const std::string& path, const std::string& text) {
    if (path.empty()) return;
    file << text;
    file.close();
    if (!file) throw Error(ErrorKind::input, path + " can't be written: " + std::strerror(errno));
}

// The probes and the program's own.
std::vector<Case> with_probes(std::span<const Case> cases) {
    std::vector<Case> all(std::begin(probes), std::end(probes));
    for (const Case& test : cases) {
        for (const Case& other : all) {
            if (std::strcmp(test.name, other.name) == 0)
                throw Error(ErrorKind::usage, std::string("there are two cases called ") +
                                                  test.name + ", or it is a probe; rename one");
        }
        all.push_back(test);
    }
    return all;
}

int measure_all(const Options& options, std::span<const Case> own) {
    const std::vector<Case> cases = with_probes(own);
    std::vector<std::string> names;
    for (const Case& test : cases) names.emplace_back(test.name);
    if (options.list) {
        for (const std::string& name : names) std::printf("%s\n", name.c_str());
        return 0;
    }
    check_filters(options.filters, names);
    std::ofstream json = opened(options.json), csv = opened(options.csv);
    const bool all = options.roofline || !options.filters.empty();
    std::vector<Result> results;
    each_backend(options.backends, options.threads,
                 [&](const std::shared_ptr<device::Device>& device) {
                     auto one = measure_cases(*device, all ? cases : own, options.filters,
                                              options.roofline, options.measure);
                     apply_roofline(one);
                     print_results(one);
                     results.insert(results.end(), one.begin(), one.end());
                 });
    finish(json, options.json, json_text(results));
    finish(csv, options.csv, csv_text(results));
    return hashes_agree(results) ? 0 : 1;
}

// Python runs it in this process's place.
[[noreturn]] void compare_with(int argc, char** argv, const char* script) {
    char self[4096];
    const ssize_t length = ::readlink("/proc/self/exe", self, sizeof(self) - 1);
    if (length < 0)
        throw Error(ErrorKind::device, std::string("/proc/self/exe: ") + std::strerror(errno));
    self[length] = 0;
    std::vector<char*> words{const_cast<char*>("python3"), const_cast<char*>(script),
                             const_cast<char*>("--kernels"), argv[2], self};
    words.insert(words.end(), argv + 3, argv + argc);
    words.push_back(nullptr);
    ::execvp(words[0], words.data());
    throw Error(ErrorKind::device, std::string("python3 did not start: ") + std::strerror(errno) +
                                       "; compare takes it: apt-get install python3");
}

}  // namespace

int run_program(int argc, char** argv, std::span<const Case> cases, const char* compare) {
    try {
        const std::string command = argc > 1 ? argv[1] : "";
        if (command == "compare" && argc > 2) compare_with(argc, argv, compare);
        if (command == "perf") {
            const Options options = read_options(argc - 1, argv + 1);
            if (!options.help) return measure_all(options, cases);
        }
        const bool asked = command == "perf" || command == "--help";
        std::fprintf(asked ? stdout : stderr, usage, argv[0], argv[0]);
        return asked ? 0 : 2;
    } catch (const Error& error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return error.kind() == ErrorKind::input ? 1 : error.kind() == ErrorKind::usage ? 2 : 3;
    }
}

}  // namespace topple::perf
