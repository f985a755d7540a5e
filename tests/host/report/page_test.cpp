// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "in_browser.h"
#include "report/report.h"
#include "synthetic_scene.h"

// What the report's page does for those who use it.
namespace topple::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

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

// In the page: a click of the pointer where `wanted(part, object)` is seen, with the keys that are
// held; each is counted.
const std::string clicking = R"(
    const out = document.body.dataset, canvas = toppleView.renderer.domElement, box = canvas.getBoundingClientRect();
    let clicks = 0;
    const seen = wanted => {
        for (let x = 3; x < box.width; x += 4) for (let y = 3; y < box.height; y += 4) {
            const group = toppleView.pickGroup(x, y);
            if (group && wanted(...group)) return {clientX: box.left + x, clientY: box.top + y};
        }
        return null;
    };
    const click = (wanted, keys = {}) => {
        const at = seen(wanted);
        if (!at) { out.missed = String(wanted); return; }
        ++clicks;
        for (const type of ['pointerdown', 'pointerup']) {
            canvas.dispatchEvent(new PointerEvent(type, {...at, ...keys, button: 0, bubbles: true, pointerId: 1}));
        }
    };
    const press = selector => { ++clicks; document.querySelector(selector).click(); };
    const told = () => JSON.stringify(toppleParts.corrections.document());
    toppleView.render();
)";

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

class Page : public test::InBrowser {};

TEST_F(Page, takes_a_part_out_of_an_object_in_four_clicks) {
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
TEST_F(Page, joins_the_chosen_object_to_another) {
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

TEST_F(Page, joins_objects_and_says_what_they_are) {
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
TEST_F(Page, keeps_corrections_of_this_parse) {
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

TEST_F(Page, opens_at_the_object_of_a_link) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset, share = id => {
            const seen = toppleView.seen();
            return (seen.get(id) || 0) / [...seen.values()].reduce((a, b) => a + b, 0);
        };
        out.first = out.chosen;
        const near = share(2);
        toppleView.reset();
        toppleView.render();
        out.nearer = near > 4 * share(2);
        location.hash = '#object=3';
        await new Promise(done => setTimeout(done, 50));
        out.then = out.chosen;
        toppleChoose(4);
        out.link = location.hash;
        dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}));
        out.none = out.chosen || 'none';
        location.hash = '#object=77';
        await new Promise(done => setTimeout(done, 50));
        out.unknown = out.chosen || 'none';
    )",
                           "", "#object=2");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("first"), "2");
    EXPECT_EQ(page.data("nearer"), "true");
    EXPECT_EQ(page.data("then"), "3");
    EXPECT_EQ(page.data("link"), "#object=4");
    EXPECT_EQ(page.data("none"), "none");
    EXPECT_EQ(page.data("unknown"), "none");
}

TEST_F(Page, turns_by_keys_and_can_be_reached_by_them) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset, canvas = toppleView.renderer.domElement;
        const press = key => canvas.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
        const eye = () => toppleView.camera.position.clone(), from = eye();
        press('ArrowLeft');
        out.turned = eye().distanceTo(from) > 0.1 && Math.abs(eye().z - from.z) < 0.01;
        press('0');
        out.back = eye().distanceTo(from) < 0.01;
        press('+');
        out.nearer = eye().distanceTo(toppleView.controls.target) < 0.9 * from.distanceTo(toppleView.controls.target);
        // What a click does, something that takes the focus does, too.
        toppleChoose(3);
        const deaf = [...document.querySelectorAll('button, a, input, summary, canvas, [onclick]')].filter(node => node.tabIndex < 0);
        out.deaf = deaf.length;
        out.columns = document.querySelectorAll('#objects tbody button').length;
        out.headings = [...document.querySelectorAll('h1, h2')].filter(node => !node.textContent.trim()).length;
        out.spoken = document.getElementById('say').textContent;
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    for (const char* key : {"turned", "back", "nearer"}) EXPECT_EQ(page.data(key), "true") << key;
    EXPECT_EQ(page.data("deaf"), "0");
    EXPECT_EQ(page.data("columns"), "6");
    EXPECT_EQ(page.data("headings"), "0");
    EXPECT_EQ(test::text(page.data("spoken")),
              "Object 3 chosen: 6.2\u00a0kg, category high?. Upset by 1 walk in 40 or 1 earthquake "
              "in 40.");
}

TEST_F(Page, has_pictures_on_paper_and_without_webgl) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.1).make());
    const std::string coloured = R"(
        const out = document.body.dataset, colours = canvas => {
            const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height), found = new Set();
            for (let i = 0; i < data.length; i += 4) if (data[i + 3]) found.add(data[i] >> 4 << 8 | data[i + 1] >> 4 << 4 | data[i + 2] >> 4);
            return found.size;
        };
    )";
    const auto paper = open(folder_ / "report.html", coloured + R"(
        dispatchEvent(new Event('beforeprint'));
        out.empty = [...document.querySelectorAll('img.picture')].filter(image => !image.src).length;
        out.pictures = document.querySelectorAll('img.picture').length;
        out.scene = colours(document.querySelector('.on-paper')) > 20;
        out.boxes = document.querySelectorAll('#sheet .box').length;
        out.sheet = document.getElementById('sheet').textContent;
        out.plan = document.querySelectorAll('#plan svg image').length;
    )");
    EXPECT_EQ(paper.data("error"), "(none)") << paper.log;
    EXPECT_EQ(paper.data("pictures"), "4");
    EXPECT_EQ(paper.data("empty"), "0");
    EXPECT_EQ(paper.data("scene"), "true");
    EXPECT_EQ(paper.data("boxes"), "2") << "what there is advice on";
    for (const char* part : {"This is no safety certificate", "Object 3, high?: Fix it where it",
                             "sets free 260\u00a0J", "once in about 500 years"})
        EXPECT_NE(test::text(paper.data("sheet")).find(part), std::string::npos)
            << part << " in " << paper.data("sheet");
    EXPECT_EQ(paper.data("plan"), "1");
    const auto still = open(folder_ / "report.html", coloured + R"(
        const canvas = document.querySelector('.still');
        out.scene = colours(canvas) > 20;
        const before = canvas.toDataURL();
        document.querySelectorAll('#sides button')[1].click();
        out.turned = canvas.toDataURL() !== before;
        paintPictures(toppleScene, true);
        out.empty = [...document.querySelectorAll('img.picture')].filter(image => !image.src).length;
    )",
                            "--disable-3d-apis");
    EXPECT_EQ(still.data("view"), "none");
    for (const char* key : {"scene", "turned"}) EXPECT_EQ(still.data(key), "true") << key;
    EXPECT_EQ(still.data("empty"), "0");
    EXPECT_EQ(still.data("error"), "(none)") << still.log;
}

TEST_F(Page, shows_the_command_that_made_it) {
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
TEST_F(Page, tells_every_part_however_many) {
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

TEST_F(Page, has_one_order_in_which_to_act) {
    NEEDS_BROWSER();
    Scene scene = test::SyntheticScene(0.2).make();
    scene.events["tolerable_J"] = 0.1;
    // The riskiest is harmless, and the one of the highest category tolerated.
    scene.objects[3].unsafety_category = "none";
    scene.objects[4].unsafety_category = "high";
    scene.objects[4].unsafety = 9;
    scene.objects[4].agreement = 0.5;
    write_report(folder_ / "report.html", scene);
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset, card = id => document.querySelector(`.item[data-object="${id}"]`).textContent;
        out.listed = [...document.querySelectorAll('.item')].map(item => item.dataset.object).join(' ');
        out.rows = [...document.querySelectorAll('#objects tbody tr')].map(row => row.cells[0].textContent).join(' ');
        out.harmless = card(3);
        out.high = card(4);
        topplePlan.paint();
        out.plan = document.querySelectorAll('#plan .chip').length;
        out.red = [...document.querySelectorAll('#objects .category, .item .category')].filter(badge => badge.textContent === 'none?')
            .map(badge => badge.style.background).join(' ');
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("listed"), "4 2 1 3");
    EXPECT_EQ(page.data("rows").substr(0, 7), "4 2 1 3");
    const auto holds = [&](const char* card, std::initializer_list<const char*> parts) {
        for (const char* part : parts)
            EXPECT_NE(test::text(page.data(card)).find(part), std::string::npos)
                << part << " in " << page.data(card);
    };
    holds("harmless", {"none?", "Risk 6.5 \u00b1 1.3 J per walk",
                       "No need to act. To bring its risk below the 0.1\u00a0J per event that this "
                       "run tolerates all the same: fix it where it stands"});
    holds("high", {"high", "How sure: one thing in only 50 % of the searches",
                   "Its risk is below the 0.1", "m above the floor"});
    EXPECT_EQ(page.data("red"), "rgb(222, 226, 230) rgb(222, 226, 230)");
    EXPECT_EQ(page.data("plan"), "4");
}

TEST_F(Page, lists_what_is_to_be_looked_at) {
    NEEDS_BROWSER();
    Scene scene = test::SyntheticScene(0.2).make();
    scene.events = {{"pga_m_s2", 2.94}, {"hazard_from_g", 0.4}};
    // Nothing upsets the table, but for its error; nobody saw what holds the shelf.
    Object& table = scene.objects[1];
    table.unsafety_category = "high";
    table.unsafety_certain = false;
    for (auto& [name, risk] : table.risk_J) risk = table.fall_chance[name] = 0;
    Object& shelf = scene.objects[4];
    shelf.seen_enough = false;
    shelf.unsafety_category.clear();
    for (auto& [name, risk] : shelf.risk_J) risk = shelf.fall_chance[name] = 0;
    scene.objects[3].rest_probability = 0.4;
    write_report(folder_ / "report.html", scene);
    const auto page = open(folder_ / "report.html", R"(
        const out = document.body.dataset, text = id => document.querySelector(`.item[data-object="${id}"]`).textContent;
        out.listed = [...document.querySelectorAll('.item')].map(item => item.dataset.object).join(' ');
        for (const id of [1, 3, 4]) out[`card${id}`] = text(id);
        out.headings = [...document.querySelectorAll('#risk h3')].map(node => node.textContent).join(', ');
        topplePlan.paint();
        out.chips = [...document.querySelectorAll('#plan .number')].map(node => node.textContent).join(', ');
        out.advice = [...document.querySelectorAll('#objects tbody tr')].find(row => row.cells[0].textContent === '1').cells[8].textContent;
        out.large = `${number(16234.5)}, ${number(0.00012)}`;
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("listed"), "2 3 1 4");
    EXPECT_EQ(page.data("headings"),
              "To be looked at, The scan does not show what holds these: go and look");
    EXPECT_EQ(page.data("chips"), "2, 3, 1, 4 ?");
    EXPECT_EQ(page.data("advice"), "check");
    EXPECT_EQ(page.data("large"), "16,200, 0.0001");
    const std::vector<std::pair<const char*, const char*>> said{
        {"card1",
         "Nothing upsets it as measured; if its foot is one error smaller, it falls with "
         "180\u00a0J: check that it stands firm."},
        {"card3", "what holds it: seen, 40 % likely, one of several readings"},
        {"card3",
         "An earthquake upsets it once in at most 500 years: the curve of the hazard "
         "begins at 0.4"},
        {"card3",
         "At 0.3 g (very strong shaking, intensity VII) about 15 of 100 earthquakes upset "
         "it; on a floor where it can\u2019t slide about 27 of 100."},
        {"card4", "Go and look what holds it."}};
    for (const auto& [card, part] : said)
        EXPECT_NE(test::text(page.data(card)).find(part), std::string::npos)
            << part << " in " << page.data(card);
}

// axe-core as ./dev setup installs it for Python; empty where it is not.
fs::path axe_script() {
    std::error_code none;
    for (const auto& python : fs::directory_iterator(TOPPLE_SOURCE_DIR "/build/venv/lib", none)) {
        const auto file = python.path() / "site-packages/axe_core_python/axe.min.js";
        if (fs::exists(file)) return file;
    }
    return {};
}

TEST_F(Page, has_no_fault_that_axe_finds) {
    NEEDS_BROWSER();
    if (axe_script().empty())
        GTEST_SKIP() << "axe-core is missing: pip install axe-core-python into build/venv (or run "
                        "./dev setup)";
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    const auto page = open(folder_ / "report.html", read(axe_script()) + R"(;
        const out = document.body.dataset, faults = [];
        document.getElementById('glossary').open = true;
        for (const id of [null, 3]) {
            if (id !== null) toppleChoose(id);
            const {violations} = await axe.run(document, {resultTypes: ['violations']});
            for (const {id: rule, nodes} of violations) faults.push(`${rule} ${nodes[0].target}`);
        }
        out.faults = faults.join(', ');
        out.looked = '1';
    )");
    EXPECT_EQ(page.data("looked"), "1") << page.log.substr(0, 2000);
    EXPECT_EQ(page.data("faults"), "");
}

}  // namespace
}  // namespace topple::report
