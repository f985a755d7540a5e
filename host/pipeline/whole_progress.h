// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "topple/parse.h"

namespace topple {

// Makes of the progress of stages, each from 0 to 1, that of the whole parse, which never falls and
// ends at 1: what is left when a stage starts is shared out among it and those that may follow, by
// the shares that they take of typical parses. So what is skipped, as all that a cache holds, and
// what takes longer or less than elsewhere, makes the share go slower or faster, and no more.
class WholeProgress {
  public:
    enum class Input { cloud, frames };
    WholeProgress(Input input, const ParseOptions& options);

    // Where a parse stands of whose stage so much is done. Of a stage that is not known here: where
    // it stood before.
    double operator()(const std::string& stage, double done);

  private:
    enum class Way { cloud, frames, blocks };
    static double percent(std::size_t stage, Way way);
    double left_from(std::size_t stage) const;  // the shares of it and of those after it, added up
    double share_of(std::size_t stage) const;

    std::vector<std::string> disturbances_;
    Way whole_, way_;         // of an input in one piece; and that which the last stage is of
    std::string stage_;       // the last one
    std::size_t number_ = 0;  // in the table
    bool known_ = false;      // whether it is there, and comes after the ones before it
    double start_ = 0;        // of the whole, when it started
    double done_ = 0;         // of the whole
};

// Calls parse_so(options), whose progress is that of the stages; the caller's is of the whole.
template <class Parse>
ParseResult tell_whole(WholeProgress::Input input, const ParseOptions& callers,
                       const Parse& parse_so) {
    if (!callers.progress) return parse_so(callers);
    ParseOptions options = callers;
    WholeProgress whole(input, callers);
    std::string last;
    options.progress = [&](const std::string& stage, double done) {
        last = stage;
        callers.progress(stage, whole(stage, done));
    };
    ParseResult result = parse_so(options);
    callers.progress(last, 1);
    return result;
}

}  // namespace topple
