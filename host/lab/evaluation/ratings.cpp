// SPDX-License-Identifier: MIT
#include "lab/evaluation/ratings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>

#include "io/text.h"
#include "topple/error.h"

namespace topple::evaluation {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t least_objects = 4, most_people = 1000;
constexpr std::uint64_t largest_sheet_bytes = 10'000'000;

// What the columns of a sheet before those of people are called; the first is needed.
constexpr std::string_view own_columns[] = {"object", "name", "x_m", "y_m", "top_m", "size_m"};

std::string line_text(std::size_t line) {
    return "line " + std::to_string(line);
}

// The fields of the next line, quoted or not (RFC 4180; no line ends within quotes).
std::vector<std::string> next_line(std::string_view& text, const std::filesystem::path& file,
                                   std::size_t line) {
    std::vector<std::string> out(1);
    bool quoted = false;
    while (!text.empty()) {
        const char c = text.front();
        text.remove_prefix(1);
        if (quoted && c == '"' && text.starts_with('"')) {
            out.back() += '"';
            text.remove_prefix(1);
        } else if (c == '"') {
            quoted = !quoted;
        } else if (c == '\n') {
            break;
        } else if (c == ',' && !quoted) {
            out.emplace_back();
        } else if (c != '\r') {
            out.back() += c;
        }
    }
    if (quoted) io::fail(file, line_text(line) + ": a quotation has no end");
    return out;
}

std::string quoted(const std::string& field) {
    std::string out = "\"";
    for (const char c : field) out.append(c == '"' ? 2 : 1, c);
    return out + '"';
}

std::string to_cm(double metres) {
    return io::short_number(std::round(metres * 100) / 100);
}

std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t n) { return values[n]; });
    std::vector<double> ranks(values.size());
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
        for (std::size_t n = first; n < last; ++n)
            ranks[order[n]] = (static_cast<double>(first) + static_cast<double>(last) - 1) / 2;
    }
    return ranks;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const auto n = static_cast<double>(a.size());
    const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n,
                 mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
    }
    return aa > 0 && bb > 0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : none;
}

// Fisher's z is normal about that of the true correlation, with this variance times 1 / (n - 3).
Correlation with_interval(double value, std::size_t count, double variance) {
    if (!(std::abs(value) < 1) || count <= 3) return {value, value, value};
    constexpr double two_sided_95 = 1.959964;
    const double z = std::atanh(value),
                 reach = two_sided_95 * std::sqrt(variance / static_cast<double>(count - 3));
    return {value, std::tanh(z - reach), std::tanh(z + reach)};
}

// Rank correlation of those objects that both sides have.
double of_common(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> of_a, of_b;
    for (std::size_t n = 0; n < a.size(); ++n) {
        if (std::isnan(a[n]) || std::isnan(b[n])) continue;
        of_a.push_back(a[n]);
        of_b.push_back(b[n]);
    }
    return of_a.size() < least_objects ? none : correlation(ranks_of(of_a), ranks_of(of_b));
}

// Of all but one person; NaN: nobody.
double mean_without(const std::vector<double>& ratings, std::optional<std::size_t> person) {
    double sum = 0, count = 0;
    for (std::size_t p = 0; p < ratings.size(); ++p) {
        if (p == person || std::isnan(ratings[p])) continue;
        sum += ratings[p];
        ++count;
    }
    return count > 0 ? sum / count : none;
}

bool is_judged(const Object& o) {
    return !o.grounded && o.seen_enough;
}

}  // namespace

Ratings read_ratings(const std::filesystem::path& file) {
    const io::FileBytes bytes = io::read_file(file, largest_sheet_bytes);
    std::string_view text = bytes.text();
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    const std::vector<std::string> head = next_line(text, file, 1);
    if (head.front() != own_columns[0])
        io::fail(file, "line 1: its first column is " + io::in_quotes(head.front()) +
                           ", not \"object\"; topple rate OUT --sheet FILE begins such a table");
    Ratings out;
    std::vector<std::size_t> columns;
    for (std::size_t c = 1; c < head.size(); ++c) {
        if (std::ranges::find(own_columns, head[c]) != std::end(own_columns)) continue;
        columns.push_back(c);
        out.people.push_back(head[c]);
    }
    if (columns.empty() || columns.size() > most_people)
        io::fail(file, "line 1: has " + io::counted(columns.size(), "column") +
                           " of people; 1 to " + std::to_string(most_people) + " are taken");
    for (std::size_t line = 2; !text.empty(); ++line) {
        const std::vector<std::string> fields = next_line(text, file, line);
        if (fields.size() == 1 && fields[0].empty()) continue;
        std::uint64_t id = 0;
        if (!io::parse_count(fields[0], id) || id > INT32_MAX)
            io::fail(file, line_text(line) + ": " + io::in_quotes(fields[0]) +
                               " is no number of an object");
        std::vector<double> ratings;
        for (const std::size_t c : columns) {
            double rating = none;
            const std::string field = c < fields.size() ? fields[c] : "";
            if (!field.empty() &&
                (!io::parse_number(field, rating) || !(rating >= 1) || rating > 10))
                io::fail(file, line_text(line) + ": " + io::in_quotes(field) + " by " +
                                   io::in_quotes(head[c]) + " is no rating from 1 to 10");
            ratings.push_back(rating);
        }
        if (std::ranges::all_of(ratings, [](double r) { return std::isnan(r); })) continue;
        if (!out.of.try_emplace(static_cast<std::int32_t>(id), std::move(ratings)).second)
            io::fail(file, line_text(line) + ": object " + std::to_string(id) + " comes twice");
    }
    return out;
}

std::string ratings_sheet(const Scene& scene) {
    std::string out;
    for (const std::string_view column : own_columns) out.append(column).append(",");
    out += "person 1,person 2,person 3\n";
    for (const Object& o : scene.objects) {
        if (!is_judged(o)) continue;
        const Vec3 &at = o.box_middle_m, &size = o.size_m;
        double top = o.size_m[2] / 2;
        for (std::size_t a = 0; a < 3; ++a) top += at[a] * scene.up[a];
        out += std::to_string(o.id) + "," + quoted(o.name) + "," + to_cm(at[0]) + "," +
               to_cm(at[1]) + "," + to_cm(top) + "," + to_cm(size[0]) + " x " + to_cm(size[1]) +
               " x " + to_cm(size[2]) + ",,,\n";
    }
    return out;
}

Correlation rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const double r = correlation(ranks_of(a), ranks_of(b));
    return with_interval(r, a.size(), 1 + r * r / 2);
}

Correlation linear_correlation(const std::vector<double>& a, const std::vector<double>& b) {
    return with_interval(correlation(a, b), a.size(), 1);
}

RatingComparison compare_ratings(const Scene& scene, const Ratings& ratings,
                                 const std::filesystem::path& file) {
    RatingComparison out;
    for (const auto& [id, of_people] : ratings.of) {
        const std::string object = "object " + std::to_string(id);
        if (static_cast<std::size_t>(id) >= scene.objects.size())
            io::fail(file, object + ": the parse has " +
                               io::counted(scene.objects.size(), "object") + ", from 0 on");
        const Object& o = scene.objects[static_cast<std::size_t>(id)];
        if (!is_judged(o))
            io::fail(file, object + (o.grounded ? " is the building" : " was not seen enough") +
                               ", and has no unsafety to compare with; leave it out");
        out.objects.push_back({id, o.unsafety, mean_without(of_people, {}), of_people});
    }
    if (out.objects.size() < least_objects)
        io::fail(file, "rates " + io::counted(out.objects.size(), "object") + "; it takes " +
                           std::to_string(least_objects) + " at least");
    std::ranges::stable_sort(out.objects, std::ranges::greater{}, &RatedObject::mean);
    std::vector<double> unsafety, mean;
    for (const RatedObject& o : out.objects) {
        unsafety.push_back(o.unsafety);
        mean.push_back(o.mean);
    }
    for (std::size_t p = 0; p < ratings.people.size(); ++p) {
        Person person{ratings.people[p]};
        std::vector<double> own, others;
        for (const RatedObject& o : out.objects) {
            own.push_back(o.ratings[p]);
            others.push_back(mean_without(o.ratings, p));
            person.rated += !std::isnan(o.ratings[p]);
        }
        person.with_parse = of_common(own, unsafety);
        person.with_others = of_common(own, others);
        out.people.push_back(std::move(person));
    }
    out.ranks = rank_correlation(unsafety, mean);
    out.values = linear_correlation(unsafety, mean);
    return out;
}

std::string ratings_picture(const RatingComparison& comparison) {
    constexpr double edge = 46, step = 40;  // pixels: to the axes, and of one rating
    const auto x = [](double rating) { return io::short_number(edge + (rating - 0.5) * step); };
    const auto y = [](double rating) { return io::short_number((10.5 - rating) * step); };
    const auto line = [&](double x1, double y1, double x2, double y2, const char* colour) {
        return "<line x1='" + x(x1) + "' y1='" + y(y1) + "' x2='" + x(x2) + "' y2='" + y(y2) +
               "' stroke='" + colour + "'/>\n";
    };
    const auto text = [](const std::string& at_x, const std::string& at_y,
                         const std::string& says) {
        return "<text x='" + at_x + "' y='" + at_y + "' text-anchor='middle'>" + says + "</text>\n";
    };
    std::string out =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 470 450' font-family='sans-serif' "
        "font-size='13'>\n<rect width='470' height='450' fill='#fff'/>\n";
    for (int r = 1; r <= 10; ++r) {
        out += line(r, 0.5, r, 10.5, "#eee") + line(0.5, r, 10.5, r, "#eee");
        out += text(x(r), "415", std::to_string(r)) +
               text("30", io::short_number((10.5 - r) * step + 4), std::to_string(r));
    }
    out += line(0.5, 0.5, 10.5, 10.5, "#999");
    out += text("246", "438", "unsafety by the parse");
    out +=
        "<text transform='translate(13,200) rotate(-90)' text-anchor='middle'>unsafety by "
        "people</text>\n";
    for (const RatedObject& o : comparison.objects)
        for (const double rating : o.ratings)
            if (!std::isnan(rating))
                out += "<circle cx='" + x(o.unsafety) + "' cy='" + y(rating) +
                       "' r='3' fill='#7aa6c2' fill-opacity='.6'/>\n";
    for (const RatedObject& o : comparison.objects)
        out += "<circle cx='" + x(o.unsafety) + "' cy='" + y(o.mean) +
               "' r='10' fill='#fff' stroke='#b3261e' stroke-width='2'/>\n" +
               text(x(o.unsafety), io::short_number((10.5 - o.mean) * step + 4.5),
                    std::to_string(o.object));
    return out + "</svg>\n";
}

}  // namespace topple::evaluation
