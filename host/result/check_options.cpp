// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "core/number_options.h"
#include "core/short_number.h"
#include "safety/disturbances.h"
#include "safety/people.h"
#include "topple/parse.h"

namespace topple {
namespace {

// A lowest of 0 is out of the range itself.
void check_range(const std::string& option, double value, double lowest, double highest) {
    if (value >= lowest && value <= highest && (lowest != 0 || value != 0)) return;
    throw Error(ErrorKind::usage, option + " " + short_number(value) + ": expected a number " +
                                      (lowest != 0 ? "from " + short_number(lowest) + " to "
                                                   : "above 0 and at most ") +
                                      short_number(highest));
}

void check(const NumberOption& option, const ParseOptions& options) {
    const std::optional<double> value = option.of(options);
    if (!value || (option.may_be_0 && *value == 0)) return;
    check_range(option.words, *value, option.least, option.most);
}

void check_once(const std::string& option, const std::vector<std::string>& names) {
    for (auto name = names.begin(); name != names.end(); ++name)
        if (std::find(names.begin(), name, *name) != name)
            throw Error(ErrorKind::usage,
                        option + ": " + *name + " is given twice; name each once");
}

}  // namespace

void check_options(const ParseOptions& o) {
    for (const NumberOption& option : number_options) check(option, o);
    if (o.up)
        check_range("up (--up): its length,", std::hypot((*o.up)[0], (*o.up)[1], (*o.up)[2]), 1e-6,
                    1e6);
    check_range("walks (--walks)", o.walks, 1, 1e6);
    if (o.accelerogram) {
        check_range("accelerogram (--accelerogram): step_s", o.accelerogram->step_s, 1e-5, 0.5);
        double sum = 0;  // not finite if one of them isn't
        for (const auto* component :
             {&o.accelerogram->m_s2, &o.accelerogram->across_m_s2, &o.accelerogram->up_m_s2}) {
            if (!component->empty() && component->size() != o.accelerogram->m_s2.size())
                throw Error(ErrorKind::usage,
                            "accelerogram (--accelerogram): its components have different numbers "
                            "of samples");
            for (const double a : *component) sum += std::abs(a);
        }
        check_range("accelerogram (--accelerogram): its peak in m/s^2,",
                    std::isfinite(sum) ? o.accelerogram->peak_m_s2() : NAN, 0, 100);
    }
    if (o.hazard) {
        if (const auto wrong = o.hazard->fault())
            throw Error(ErrorKind::usage, "hazard (--hazard): " + *wrong);
    }
    if (o.materials) {
        if (const auto wrong = fault_of(*o.materials))
            throw Error(ErrorKind::usage, "materials (--materials): " + *wrong);
    }
    if (const auto wrong = fault_of(o.corrections))
        throw Error(ErrorKind::usage, "corrections (--corrections): " + *wrong);
    for (const std::string& name : o.disturbances) safety::disturbance_kind(name);
    for (const std::string& name : o.people) safety::person_kind(name);
    check_once("disturbances (--disturbance)", o.disturbances);
    check_once("people (--people)", o.people);
    if (o.people.empty())
        throw Error(ErrorKind::usage,
                    "people (--people): none is given; name those in the room, or leave human out "
                    "of disturbances (--disturbance) where nobody walks");
    // Of all that there are some may be without who does it.
    if (o.disturbances != known_disturbances() &&
        safety::acting_kinds(o).size() < o.disturbances.size())
        throw Error(ErrorKind::usage,
                    "disturbances (--disturbance) reach: nobody of people (--people) reaches for "
                    "things; add children, toddlers or elderly, or leave reach out");
    for (std::size_t n = 0; n < o.motions.size(); ++n) {
        if (!o.motions[n])
            throw Error(ErrorKind::usage, "motion (--motion): number " + std::to_string(n) +
                                              " is null; give what read_motion() returns, or leave "
                                              "it out");
    }
}

}  // namespace topple
