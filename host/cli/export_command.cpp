// SPDX-License-Identifier: MIT
#include <memory>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/export_options.h"
#include "topple/export.h"

namespace topple::cli {
namespace {

struct ExportArguments {
    std::string parsed;
    ExportOptions options;
};

}  // namespace

Command add_export(CLI::App& app) {
    auto a = std::make_shared<ExportArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    add_export_options(app, a->options);
    app.add_option("--threads", a->options.threads, "Threads; else all cores")->check(whole_number);
    return [a] {
        print_export(export_output(a->parsed, a->options));
        return 0;
    };
}

}  // namespace topple::cli
