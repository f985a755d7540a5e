// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "clicking.h"
#include "in_browser.h"
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

class PageCorrections : public test::InBrowser {
  protected:
    // The JSON in out.said.
    static Json said_in(const Opened& page) {
        const std::string quote = "&quot;";
        std::string text = page.data("said");
        for (auto at = text.find(quote); at != std::string::npos; at = text.find(quote))
            text.replace(at, quote.size(), "\"");
        return Json::parse(text);
    }
};

TEST_F(PageCorrections, takes_a_part_out_of_an_object_in_four_clicks) {
    const Scene scene = wrongly_grouped();
    const auto page = open(scene, clicking + R"(
        let saved = null;
        URL.createObjectURL = blob => { saved = blob; return '#'; };
        click((part, object) => part === 6);
        click((part, object) => part === 6, {ctrlKey: true});
        is(document.getElementById('mend-meant').textContent, 'Chosen: part 6 of object 1.');
        press('[data-do=apart]');
        is(document.getElementById('mend-list').textContent, 'Part 6 of object 1: a thing by itself undo');
        is(document.getElementById('mend-command').textContent, 'topple parse \'made-up <room> & "hall" <\/script><b>.ply\' -o OUT-2 --cache OUT/parse.cache --corrections ~/Downloads/corrections.json');
        press('#mend-save');
        is(clicks, 4);
        out.said = await saved.text();
    )");
    const Json said = said_in(page);
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
    const Scene scene = test::SyntheticScene(0.08).make();
    const auto page = open(scene, clicking + R"(
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
        is([...new Set(refused)].join('|'), 'These are one thing already: Shift-click the other one, too.');
        is(document.querySelectorAll('#mend-list li').length, 1);
    )");
    const Json said = said_in(page);
    EXPECT_EQ(parts_at(scene, said["corrections"][0]["at_m"]),
              (std::vector<std::int32_t>{3, 4, 6}));
}

// From its card; what does not touch it is warned of. What is told by itself stays chosen, to be
// named, and both entries of the file are one correction.
TEST_F(PageCorrections, joins_what_is_a_piece_and_names_what_is_of_the_building) {
    Scene scene = test::SyntheticScene(0.2).make();
    scene.objects[2].piece_of = 1;
    scene.objects[2].piece_probability = 0.86;
    const auto page = open(scene, R"(
        const note = () => document.getElementById('mend-note').textContent;
        document.querySelector('[data-join="1"]').click();
        is(document.getElementById('mend-list').textContent, 'Objects 1 and 2: one thing undo');
        toppleParts.join(4, 5);
        out.warned = note();
        document.querySelector('[data-show="1"]').click();
        is([...document.querySelectorAll('.canvas .number')].map(label => label.textContent).join(' '), '2 1');
        toppleChoose(0);
        const parts = [...document.querySelectorAll('#mend-parts input')].map(box => Number(box.value));
        toppleParts.take(parts.slice(0, 2));
        document.querySelector('[data-do=apart]').click();
        out.meant = document.getElementById('mend-meant').textContent;
        is(!document.querySelector('[data-do=name]').disabled, true);
        const said = toppleParts.corrections.document().corrections;
        is(sentenceNumbers(said.map(one => ({...one, held: true}))).join(' '), '1 2 3 3');
        is(said.map(one => one.do).join(' '), 'one_thing one_thing one_thing apart');
        is(`${forceText(153.2)}, ${forceText(2.71)}`, '154 N, 2.8 N');
    )");
    EXPECT_THAT(page.data("warned"),
                HasSubstr("object 4 and object 5 don\u2019t touch as scanned"));
    EXPECT_THAT(page.data("meant"), HasSubstr(" of the building."));
}

// What is said is about what was clicked last, is said once, and not against what was said before.
TEST_F(PageCorrections, says_of_what_and_refuses_what_contradicts) {
    Scene scene = test::SyntheticScene(0.2).make();
    scene.objects[2].piece_of = 1;
    const auto page = open(scene, R"(
        const aim = () => document.getElementById('mend-for').textContent;
        const say = kind => { document.querySelector(`[data-do=${kind}]`).click(); return document.getElementById('mend-note').textContent; };
        const listed = () => document.querySelectorAll('#mend-list li').length;
        toppleParts.take([0, 1]);
        is(aim(), 'For: 2 ticked parts of the building');
        say('apart');
        is(say('fixed'), 'You said that these are a thing by themselves: undo that first.');
        toppleChoose(4);
        is(aim(), 'For: object 4');
        is(toppleParts.marked.size, 0);
        is(say('fixed'), '');
        is(say('fixed'), 'That is noted already.');
        is(listed(), 2);
        const join = document.querySelector('.card [data-join="1"]');
        join.click();
        is(join.textContent, 'noted, undo');
        is(listed(), 3);
        join.click();
        is(`${join.textContent}, ${listed()}`, 'join, 2');
        // Shift takes parts from the table and from cards, too.
        const shift = node => node.dispatchEvent(new MouseEvent('click', {bubbles: true, shiftKey: true}));
        toppleParts.clear();
        toppleChoose(null);
        shift([...document.querySelectorAll('#objects tbody tr')].find(row => row.cells[0].textContent === '1').cells[1]);
        shift(document.querySelector('.item[data-object="3"]'));
        is(document.getElementById('mend-meant').textContent, 'Chosen: objects 1 and 3.');
        out.chosen = out.chosen || 'none';
    )");
    EXPECT_EQ(page.data("chosen"), "none");
}

TEST_F(PageCorrections, joins_objects_and_says_what_they_are) {
    const Scene scene = test::SyntheticScene(0.08).make();
    const auto page = open(scene, clicking + R"(
        const write = (id, text) => { document.getElementById(id).value = text; };
        click((part, object) => object === 3, {shiftKey: true});
        click((part, object) => object === 1, {shiftKey: true});
        press('[data-do=one_thing]');
        is(clicks, 3);
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
        is(document.getElementById('mend-note').textContent, 'Write a mass above 0 kg first.');
        document.querySelector('[data-do=apart]').click();
        is(document.getElementById('mend-note').textContent, 'Object 4 is by itself already: choose some of its parts.');
        // By the list alone, as from the keyboard; the second of them is undone.
        toppleChoose(5);
        const part = document.querySelector('#mend-parts input');
        part.focus();
        part.click();
        is(document.activeElement.value === part.value, true, 'the list keeps the focus');
        is(document.getElementById('say').textContent, 'Part 8 of object 5 chosen. 1 in all.');
        document.querySelector('[data-do=not_there]').click();
        [...document.querySelectorAll('#mend-list button')][1].click();
        is(document.querySelectorAll('#mend-list li').length, 5);
        out.said = told();
    )");
    const Json said = said_in(page);
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
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    auto html = test::bytes_of_file(folder_ / "report.html");
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
        is(document.getElementById('mend-list').textContent, 'Fridge at 1.80 m east, 1.55 m north (before: object 7): 4\u00a0kg undoWhat is at 0.10 m east, 0.10 m north: apart from others (of this parse: nothing is there) undo');
        is(document.querySelectorAll('#told li').length, 2);
        out.card = document.querySelector('.item[data-object="2"]').closest('.card').textContent;
        toppleChoose(2);
        is(document.querySelector('#detail .numbers dd').textContent, '0.4\u00a0kg, as given by hand');
        toppleChoose(4);
        document.querySelector('[data-do=fixed]').click();
        document.querySelectorAll('#mend-list button')[1].click();
        out.said = JSON.stringify(toppleParts.corrections.document().corrections.map(one => ({...one, at_m: one.at_m.length})));
    )");
    EXPECT_TRUE(page.data("card").starts_with("Fridgehigh")) << page.data("card");
    page.says("card", {"object 2, 0.4\u00a0kg"});
    EXPECT_EQ(said_in(page), Json::parse(R"([{"do": "mass", "at_m": 1, "kg": 4, "was": "object 7"},
                                {"do": "fixed", "at_m": 1, "was": "object 4"}])"));
}

TEST_F(PageCorrections, shows_the_command_that_made_it) {
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make(), {},
                 {{"build/topple", "parse", "a room", "--corrections", "old.json", "--voxel",
                   "0.02", "--corrections=older.json", "-o", "it's-2/"},
                  "A <room>"});
    const auto page = open(folder_ / "report.html", R"(
        is(document.getElementById('mend-command').textContent, 'build/topple parse \'a room\' --voxel 0.02 -o \'it\'\\\'\'s-3\' --cache \'it\'\\\'\'s-2/parse.cache\' --corrections ~/Downloads/corrections.json');
        is(document.querySelector('h1').textContent, 'A <room>');
    )");
}

// A correction takes 100 spots.
TEST_F(PageCorrections, tells_every_part_however_many) {
    const auto page = open(test::SyntheticScene(0.2).make(), R"(
        const told = toppleParts.corrections, key = spot => spot.join(' ');
        for (let part = 1000; part < 1230; ++part) told.spots.set(part, [part, 0, 0]);
        const many = [...Array(210)].map((none, n) => 1000 + n), few = [...Array(20)].map((none, n) => 1210 + n);
        const one = told.oneThing(many), apart = told.apart(many, few), both = told.apart(few, many);
        const spots = list => new Set(list.flatMap(c => c.at_m.map(key))).size;
        is(`${one.length} ${spots(one)} ${one.every(c => key(c.at_m[0]) === key(one[0].at_m[0]) && c.at_m.length <= 100)}`, '3 210 true');
        const pairs = list => new Set(list.flatMap(c => c.at_m.flatMap(a => c.from_m.map(b => key(a) + '/' + key(b))))).size;
        is(`${apart.length} ${pairs(apart)}, ${both.length} ${pairs(both)}`, '3 4200, 3 4200');
        is(spots(told.of('fixed', many)), 210);
    )");
}

}  // namespace
}  // namespace topple::report
