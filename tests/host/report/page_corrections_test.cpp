// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clicking.h"
#include "in_browser.h"
#include "report/report.h"
#include "synthetic_scene.h"

// What the report's page takes down of what is wrong in a parse.
namespace topple::report {
namespace {

using Json = nlohmann::json;
using test::clicking;

// The room, whose table and monitor are one object by mistake: object 1 has parts 3, 4 and 6.
Scene wrongly_grouped() {
    Scene scene = test::SyntheticScene(0.08).make();
    for (Primitive& part : scene.primitives)
        if (part.object == 3) part.object = 1;
    for (auto* objects : {&scene.points.object, &scene.solid.object})
        for (std::int32_t& object : *objects)
            if (object == 3) object = 1;
    return scene;
}

Json unescaped(std::string attribute) {
    const std::string quote = "&quot;";
    for (auto at = attribute.find(quote); at != std::string::npos; at = attribute.find(quote))
        attribute.replace(at, quote.size(), "\"");
    return Json::parse(attribute, nullptr, false);
}

// Which part a place is a point of: that of the nearest point.
std::int32_t part_at(const Scene& scene, const Json& at) {
    std::int32_t part = -1;
    double least = 1e-5;
    for (std::size_t i = 0; i < scene.points.x.size(); ++i) {
        const double dx = scene.points.x[i] - at[0].get<double>(),
                     dy = scene.points.y[i] - at[1].get<double>(),
                     dz = scene.points.z[i] - at[2].get<double>();
        const double square = dx * dx + dy * dy + dz * dz;
        if (square >= least) continue;
        least = square;
        part = scene.points.primitive[i];
    }
    return part;
}

std::vector<std::int32_t> parts_at(const Scene& scene, const Json& places) {
    std::vector<std::int32_t> out;
    for (const Json& at : places) out.push_back(part_at(scene, at));
    std::ranges::sort(out);
    return out;
}

class PageCorrections : public test::InBrowser {};

TEST_F(PageCorrections, takes_a_part_out_of_an_object_in_four_clicks) {
    NEEDS_BROWSER();
    const Scene scene = wrongly_grouped();
    write_report(folder_ / "report.html", scene);
    const auto page = open(folder_ / "report.html", clicking + R"(
        let saved = null;
        URL.createObjectURL = blob => { saved = blob; return '#'; };
        click((part, object) => part === 6);
        click((part, object) => part === 6, {ctrlKey: true});
        out.meant = document.getElementById('mend-meant').textContent;
        press('[data-do=apart]');
        out.list = document.getElementById('mend-list').textContent;
        out.command = document.getElementById('mend-command').textContent;
        press('#mend-save');
        out.clicks = clicks;
        out.said = await saved.text();
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("missed"), "(none)");
    EXPECT_EQ(page.data("clicks"), "4");
    EXPECT_EQ(page.data("meant"), "Chosen: part 6 of object 1.");
    EXPECT_EQ(page.data("list"), "Part 6 of object 1: a thing by itself undo");
    EXPECT_EQ(
        page.data("command"),
        "topple parse 'made-up &lt;room&gt; &amp; &quot;hall&quot; &lt;/script&gt;&lt;b&gt;.ply' "
        "-o OUT-2 --cache OUT/parse.cache --corrections ~/Downloads/corrections.json");
    const Json said = unescaped(page.data("said"));
    ASSERT_TRUE(said.is_object()) << page.data("said");
    EXPECT_EQ(said["schema"], "topple.corrections/1");
    ASSERT_EQ(said["corrections"].size(), 1u);
    const Json& one = said["corrections"][0];
    EXPECT_EQ(one["do"], "apart");
    EXPECT_EQ(parts_at(scene, one["at_m"]), std::vector<std::int32_t>{6});
    EXPECT_EQ(parts_at(scene, one["from_m"]), (std::vector<std::int32_t>{3, 4}));
}

// What is chosen as a whole stays chosen beside what is Shift-clicked; one object alone is one
// already.
TEST_F(PageCorrections, joins_the_chosen_object_to_another) {
    NEEDS_BROWSER();
    const Scene scene = test::SyntheticScene(0.08).make();
    write_report(folder_ / "report.html", scene);
    const auto page = open(folder_ / "report.html", clicking + R"(
        toppleChoose(3);
        click((part, object) => object === 1, {shiftKey: true});
        press('[data-do=one_thing]');
        out.said = told();
        const refused = [];
        for (const object of [1, 2, 3, 4, 5]) {
            toppleChoose(object);
            const button = document.querySelector('[data-do=one_thing]');
            if (button.disabled) continue;
            button.click();
            refused.push(document.getElementById('mend-note').textContent);
        }
        out.refused = [...new Set(refused)].join('|');
        out.listed = document.querySelectorAll('#mend-list li').length;
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    const Json said = unescaped(page.data("said"));
    ASSERT_TRUE(said.is_object()) << page.data("said");
    EXPECT_EQ(parts_at(scene, said["corrections"][0]["at_m"]),
              (std::vector<std::int32_t>{3, 4, 6}));
    EXPECT_EQ(page.data("refused"), "These are one thing already: Shift-click the other one, too.");
    EXPECT_EQ(page.data("listed"), "1");
}

// From its card; what does not touch it is warned of. What is told by itself stays chosen, to be
// named, and both entries of the file are one correction.
TEST_F(PageCorrections, joins_what_is_a_piece_and_names_what_is_of_the_building) {
    NEEDS_BROWSER();
    Scene scene = test::SyntheticScene(0.2).make();
    scene.objects[2].piece_of = 1;
    scene.objects[2].piece_probability = 0.86;
    write_report(folder_ / "report.html", scene);
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset, note = () => document.getElementById('mend-note').textContent;
        document.querySelector('[data-join="1"]').click();
        out.joined = document.getElementById('mend-list').textContent;
        toppleParts.join(4, 5);
        out.warned = note();
        document.querySelector('[data-show="1"]').click();
        out.labels = [...document.querySelectorAll('.canvas .number')].map(label => label.textContent).join(' ');
        toppleChoose(0);
        const parts = [...document.querySelectorAll('#mend-parts input')].map(box => Number(box.value));
        toppleParts.take(parts.slice(0, 2));
        document.querySelector('[data-do=apart]').click();
        out.meant = document.getElementById('mend-meant').textContent;
        out.named = !document.querySelector('[data-do=name]').disabled;
        const said = toppleParts.corrections.document().corrections;
        out.numbers = sentenceNumbers(said.map(one => ({...one, held: true}))).join(' ');
        out.kinds = said.map(one => one.do).join(' ');
        out.forces = `${forceText(153.2)}, ${forceText(2.71)}`;
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("joined"), "Objects 1 and 2: one thing undo");
    EXPECT_NE(page.data("warned").find("object 4 and object 5 don\u2019t touch as scanned"),
              std::string::npos)
        << page.data("warned");
    EXPECT_EQ(page.data("labels"), "2 1");
    EXPECT_NE(page.data("meant").find(" of the building."), std::string::npos)
        << page.data("meant");
    EXPECT_EQ(page.data("named"), "true");
    EXPECT_EQ(page.data("kinds"), "one_thing one_thing one_thing apart");
    EXPECT_EQ(page.data("numbers"), "1 2 3 3");
    EXPECT_EQ(page.data("forces"), "154 N, 2.8 N");
}

// What is said is about what was clicked last, is said once, and not against what was said before.
TEST_F(PageCorrections, says_of_what_and_refuses_what_contradicts) {
    NEEDS_BROWSER();
    Scene scene = test::SyntheticScene(0.2).make();
    scene.objects[2].piece_of = 1;
    write_report(folder_ / "report.html", scene);
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset, aim = () => document.getElementById('mend-for').textContent;
        const say = kind => { document.querySelector(`[data-do=${kind}]`).click(); return document.getElementById('mend-note').textContent; };
        const listed = () => document.querySelectorAll('#mend-list li').length;
        toppleParts.take([0, 1]);
        out.ticked = aim();
        say('apart');
        out.against = say('fixed');
        toppleChoose(4);
        out.aim = aim();
        out.marked = toppleParts.marked.size;
        out.fixed = say('fixed');
        out.again = say('fixed');
        out.listed = listed();
        const join = document.querySelector('.card [data-join="1"]');
        join.click();
        out.noted = join.textContent;
        out.joined = listed();
        join.click();
        out.undone = `${join.textContent}, ${listed()}`;
        // Shift takes parts from the table and from cards, too.
        const shift = node => node.dispatchEvent(new MouseEvent('click', {bubbles: true, shiftKey: true}));
        toppleParts.clear();
        toppleChoose(null);
        shift([...document.querySelectorAll('#objects tbody tr')].find(row => row.cells[0].textContent === '1').cells[1]);
        shift(document.querySelector('.item[data-object="3"]'));
        out.shifted = document.getElementById('mend-meant').textContent;
        out.chosen = out.chosen || 'none';
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("ticked"), "For: 2 ticked parts of the building");
    EXPECT_EQ(test::text(page.data("against")),
              "You said that these are a thing by themselves: undo that first.");
    EXPECT_EQ(page.data("aim"), "For: object 4");
    EXPECT_EQ(page.data("marked"), "0");
    EXPECT_EQ(page.data("fixed"), "");
    EXPECT_EQ(page.data("again"), "That is noted already.");
    EXPECT_EQ(page.data("listed"), "2");
    EXPECT_EQ(page.data("noted"), "noted, undo");
    EXPECT_EQ(page.data("joined"), "3");
    EXPECT_EQ(page.data("undone"), "one thing with object 1, 2");
    EXPECT_EQ(page.data("shifted"), "Chosen: objects 1 and 3.");
    EXPECT_EQ(page.data("chosen"), "none");
}

TEST_F(PageCorrections, joins_objects_and_says_what_they_are) {
    NEEDS_BROWSER();
    const Scene scene = test::SyntheticScene(0.08).make();
    write_report(folder_ / "report.html", scene);
    const auto page = open(folder_ / "report.html", clicking + R"(
        const write = (id, text) => { document.getElementById(id).value = text; };
        click((part, object) => object === 3, {shiftKey: true});
        click((part, object) => object === 1, {shiftKey: true});
        press('[data-do=one_thing]');
        out.clicks = clicks;
        // All of an object where no part is chosen.
        toppleChoose(4);
        document.querySelector('[data-do=fixed]').click();
        write('mend-name', ' a "shelf" ');
        document.querySelector('[data-do=name]').click();
        write('mend-kg', '12.5');
        document.querySelector('[data-do=mass]').click();
        document.querySelector('[data-do=hollow]').click();
        // What makes no sense is refused.
        write('mend-kg', '-1');
        document.querySelector('[data-do=mass]').click();
        out.refused = document.getElementById('mend-note').textContent;
        document.querySelector('[data-do=apart]').click();
        out.alone = document.getElementById('mend-note').textContent;
        // By the list alone, as from the keyboard; the second of them is undone.
        toppleChoose(5);
        const part = document.querySelector('#mend-parts input');
        part.focus();
        part.click();
        out.focused = document.activeElement.value === part.value;
        out.spoken = document.getElementById('say').textContent;
        document.querySelector('[data-do=not_there]').click();
        [...document.querySelectorAll('#mend-list button')][1].click();
        out.listed = document.querySelectorAll('#mend-list li').length;
        out.said = told();
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("missed"), "(none)");
    EXPECT_EQ(page.data("clicks"), "3");
    EXPECT_EQ(page.data("refused"), "Write a mass above 0 kg first.");
    EXPECT_EQ(page.data("alone"), "Object 4 is by itself already: choose some of its parts.");
    EXPECT_EQ(page.data("focused"), "true") << "the list keeps the focus";
    EXPECT_EQ(page.data("spoken"), "Part 8 of object 5 chosen. 1 in all.");
    EXPECT_EQ(page.data("listed"), "5");
    const Json said = unescaped(page.data("said"));
    ASSERT_TRUE(said.is_object()) << page.data("said");
    const Json& all = said["corrections"];
    ASSERT_EQ(all.size(), 5u);
    EXPECT_EQ(all[0]["do"], "one_thing");
    EXPECT_EQ(parts_at(scene, all[0]["at_m"]), (std::vector<std::int32_t>{3, 4, 6}));
    EXPECT_EQ(all[1]["do"], "name");
    EXPECT_EQ(all[1]["name"], "a \"shelf\"");
    EXPECT_EQ(parts_at(scene, all[1]["at_m"]), std::vector<std::int32_t>{7});
    EXPECT_EQ(all[2]["kg"], 12.5);
    EXPECT_EQ(all[3]["do"], "hollow");
    EXPECT_EQ(all[3]["wall_m"], 0.02);
    EXPECT_EQ(all[4]["do"], "not_there");
    EXPECT_EQ(parts_at(scene, all[4]["at_m"]), std::vector<std::int32_t>{8});
}

// As scene.json has them once a parse has kept to some.
TEST_F(PageCorrections, keeps_corrections_of_this_parse) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    auto html = read(folder_ / "report.html");
    const std::string data = "id=\"data\">{";
    html.insert(
        html.find(data) + data.size(),
        R"("corrections": [{"do": "mass", "at_m": [[1, 2, 3]], "kg": 4, "was": "object 7", "held": true,
                    "outcome": "held", "objects": [2]}, {"do": "apart", "at_m": [[0, 0, 0]],
                    "from_m": [[1, 1, 1]], "held": false, "outcome": "nothing is there", "objects": []}],)");
    const std::string object = "{\"id\":2,\"primitives\"";
    html.insert(html.find(object) + 1, "\"name\":\"fridge\",\"corrected\":[1],");
    std::ofstream(folder_ / "report.html") << html;
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset;
        out.list = document.getElementById('mend-list').textContent;
        out.told = document.querySelectorAll('#told li').length;
        out.card = document.querySelector('.item[data-object="2"]').textContent;
        toppleChoose(2);
        out.mass = document.querySelector('#detail .numbers dd').textContent;
        toppleChoose(4);
        document.querySelector('[data-do=fixed]').click();
        document.querySelectorAll('#mend-list button')[1].click();
        out.said = JSON.stringify(toppleParts.corrections.document().corrections.map(one => ({...one, at_m: one.at_m.length})));
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(test::text(page.data("list")),
              "Fridge at 1.80 m east, 1.55 m north (before: object 7): 4\u00a0kg undo"
              "What is at 0.10 m east, 0.10 m north: apart from others (of this parse: nothing is "
              "there) undo");
    EXPECT_EQ(page.data("told"), "2");
    EXPECT_EQ(test::text(page.data("card")).find("Fridgehighobject 2, 0.4\u00a0kg"), 0u)
        << page.data("card");
    EXPECT_EQ(test::text(page.data("mass")), "0.4\u00a0kg, as given by hand");
    EXPECT_EQ(unescaped(page.data("said")),
              Json::parse(R"([{"do": "mass", "at_m": 1, "kg": 4, "was": "object 7"},
                                {"do": "fixed", "at_m": 1, "was": "object 4"}])"));
}

TEST_F(PageCorrections, shows_the_command_that_made_it) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make(), {},
                 {{"build/topple", "parse", "a room", "--corrections", "old.json", "--voxel",
                   "0.02", "--corrections=older.json", "-o", "it's-2/"},
                  "A <room>"});
    const auto page = open(folder_ / "report.html", R"(
        document.body.dataset.command = document.getElementById('mend-command').textContent;
        document.body.dataset.title = document.querySelector('h1').textContent;
    )");
    EXPECT_EQ(page.data("command"),
              "build/topple parse 'a room' --voxel 0.02 -o 'it'\\''s-3' --cache "
              "'it'\\''s-2/parse.cache' --corrections ~/Downloads/corrections.json");
    EXPECT_EQ(page.data("title"), "A &lt;room&gt;");
}

// A correction takes 100 spots.
TEST_F(PageCorrections, tells_every_part_however_many) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset, told = toppleParts.corrections, key = spot => spot.join(' ');
        for (let part = 1000; part < 1230; ++part) told.spots.set(part, [part, 0, 0]);
        const many = [...Array(210)].map((none, n) => 1000 + n), few = [...Array(20)].map((none, n) => 1210 + n);
        const one = told.oneThing(many), apart = told.apart(many, few), both = told.apart(few, many);
        const spots = list => new Set(list.flatMap(c => c.at_m.map(key))).size;
        out.one = `${one.length} ${spots(one)} ${one.every(c => key(c.at_m[0]) === key(one[0].at_m[0]) && c.at_m.length <= 100)}`;
        const pairs = list => new Set(list.flatMap(c => c.at_m.flatMap(a => c.from_m.map(b => key(a) + '/' + key(b))))).size;
        out.apart = `${apart.length} ${pairs(apart)}, ${both.length} ${pairs(both)}`;
        out.fixed = spots(told.of('fixed', many));
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("one"), "3 210 true");
    EXPECT_EQ(page.data("apart"), "3 4200, 3 4200");
    EXPECT_EQ(page.data("fixed"), "210");
}

}  // namespace
}  // namespace topple::report
