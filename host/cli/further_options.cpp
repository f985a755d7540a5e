// SPDX-License-Identifier: MIT
#include "cli/further_options.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace topple::cli {
namespace {

constexpr const char* further = "Further options";

class Listing : public CLI::Formatter {
  public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override {
        all_ = mode != CLI::AppFormatMode::Normal;  // Sub: below the list of all commands
        return CLI::Formatter::make_help(app, std::move(name), mode);
    }
    std::string make_group(std::string group, bool is_positional,
                           std::vector<const CLI::Option*> options) const override {
        if (all_ || group != further)
            return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
        return std::to_string(options.size()) + " more options are listed by --help-all.\n";
    }

  private:
    mutable bool all_ = false;  // of what is printed now
};

}  // namespace

void further_options(CLI::App& command) {
    command.option_defaults()->group(further);
}

void list_them_apart(CLI::App& app) {
    app.formatter(std::make_shared<Listing>());
}

}  // namespace topple::cli
