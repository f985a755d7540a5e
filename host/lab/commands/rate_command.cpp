// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <string>

#include "cli/print.h"
#include "core/numbered_object.h"
#include "io/replace_file.h"
#include "io/text.h"
#include "lab/commands/commands.h"
#include "lab/evaluation/ratings.h"
#include "topple/error.h"
#include "topple/parse.h"

namespace topple::cli {
namespace {

struct RateArguments {
    std::string parsed, ratings, sheet, picture;
};

std::string rho_text(double value) {
    return std::isnan(value)
               ? "   - "
               : (value < 0 ? "" : "+") + io::short_number(std::round(value * 100) / 100);
}

void print_comparison(const Scene& scene, const evaluation::RatingComparison& found) {
    print("%-28s %8s %8s %s\n", "object", "people", "parse", "of people, least to most");
    for (const evaluation::RatedObject& o : found.objects) {
        double least = 10, most = 1;
        for (const double rating : o.ratings) {
            least = std::fmin(least, rating);
            most = std::fmax(most, rating);
        }
        print("%-28s %8.1f %8.1f %g to %g\n",
              numbered_object(scene.objects[static_cast<std::size_t>(o.object)]).c_str(), o.mean,
              o.unsafety, least, most);
    }
    print("\n%-28s %8s %12s %12s\n", "person", "objects", "with parse", "with others");
    for (const evaluation::Person& p : found.people)
        print("%-28s %8zu %12s %12s\n", p.name.c_str(), p.rated, rho_text(p.with_parse).c_str(),
              rho_text(p.with_others).c_str());
    const auto line = [](const char* of, const evaluation::Correlation& c) {
        print("%s of the parse and the mean of people: %.2f (95 %% interval %.2f to %.2f)\n", of,
              c.value, c.low, c.high);
    };
    print("\n");
    line("Rank correlation", found.ranks);
    line("Linear correlation", found.values);
}

int run_rate(const RateArguments& a) {
    if (a.ratings.empty() == a.sheet.empty())
        throw Error(ErrorKind::usage, "rate: expected either a file of ratings, or --sheet FILE");
    if (!a.picture.empty() && a.ratings.empty())
        throw Error(ErrorKind::usage, "--picture: it is of ratings, and none were given");
    const Scene scene = read_outputs(a.parsed).scene;
    if (!a.sheet.empty()) {
        io::check_own_file(a.sheet, "object,name,", "is no sheet of topple; choose another name");
        io::replace_file(a.sheet, evaluation::ratings_sheet(scene));
        print(
            "%s: a line for each object that was judged; people write 1 (safe) to 10 into a "
            "column each\n",
            a.sheet.c_str());
        return 0;
    }
    const evaluation::RatingComparison found =
        evaluation::compare_ratings(scene, evaluation::read_ratings(a.ratings), a.ratings);
    print_comparison(scene, found);
    if (!a.picture.empty()) {
        io::check_own_file(a.picture, "<svg", "is no picture; choose another name");
        io::replace_file(a.picture, evaluation::ratings_picture(found));
    }
    return 0;
}

}  // namespace

Command add_rate(CLI::App& app) {
    auto a = std::make_shared<RateArguments>();
    app.add_option("OUT", a->parsed, "Output folder of a parse")->required();
    app.add_option("RATINGS", a->ratings,
                   "Comma-separated: a column \"object\", and one for each person");
    app.add_option("--sheet", a->sheet,
                   "Write a sheet for people to fill in, where they have not rated yet");
    app.add_option("--picture", a->picture,
                   "Write people's ratings over the parse's as SVG (the paper's Fig. 20 b)");
    return [a] { return run_rate(*a); };
}

}  // namespace topple::cli
