// SPDX-License-Identifier: MIT
#include "clicking.h"
#include "in_browser.h"
#include "synthetic_scene.h"

// What the report's page does for those who use it.
namespace topple::report {
namespace {

namespace fs = std::filesystem;

class Page : public test::InBrowser {};

TEST_F(Page, opens_at_the_object_of_a_link) {
    const auto page = open(test::SyntheticScene(0.2).make(), R"(
        const share = id => {
            const seen = toppleView.seen();
            return (seen.get(id) || 0) / [...seen.values()].reduce((a, b) => a + b, 0);
        };
        is(out.chosen, 2);
        const near = share(2);
        toppleView.reset();
        toppleView.render();
        is(near > 4 * share(2), true);
        location.hash = '#object=3';
        await new Promise(done => setTimeout(done, 50));
        is(out.chosen, 3);
        toppleChoose(4);
        is(location.hash, '#object=4');
        dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}));
        is(out.chosen || 'none', 'none');
        location.hash = '#object=77';
        await new Promise(done => setTimeout(done, 50));
        is(out.chosen || 'none', 'none');
    )",
                           "", "#object=2");
}

TEST_F(Page, turns_by_keys_and_can_be_reached_by_them) {
    const auto page = open(test::SyntheticScene(0.2).make(), R"(
        const canvas = toppleView.renderer.domElement;
        const press = key => canvas.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
        const eye = () => toppleView.camera.position.clone(), from = eye();
        press('ArrowLeft');
        is(eye().distanceTo(from) > 0.1 && Math.abs(eye().z - from.z) < 0.01, true);
        press('0');
        is(eye().distanceTo(from) < 0.01, true);
        press('+');
        is(eye().distanceTo(toppleView.controls.target) < 0.9 * from.distanceTo(toppleView.controls.target), true);
        // What a click does, something that takes the focus does, too.
        toppleChoose(3);
        const deaf = [...document.querySelectorAll('button, a, input, summary, canvas, [onclick]')].filter(node => node.tabIndex < 0);
        is(deaf.length, 0);
        is(document.querySelectorAll('#objects tbody button').length, 6);
        is([...document.querySelectorAll('h1, h2')].filter(node => !node.textContent.trim()).length, 0);
        is(document.getElementById('say').textContent, 'Object 3 chosen: 6.2\u00a0kg, category high, unsure. Upset by 1 in 40 walks or 1 in 40 earthquakes.');
    )");
}

// Clicks at one place go from what is seen there to what lies behind.
TEST_F(Page, chooses_what_lies_behind) {
    const auto page = open(test::SyntheticScene(0.1).make(), test::clicking + R"(
        const chosen = () => out.chosen || 'none', line = [];
        // The cup hides some of the table, and both the floor.
        for (let n = 0; n < 4; ++n) {
            click((part, object) => object === 2);
            line.push(chosen());
        }
        is(line.join(' '), '2 1 0 none');
        // Elsewhere it begins anew.
        click((part, object) => object === 2);
        click((part, object) => object === 1);
        is(chosen(), 1);
        toppleChoose(null);
        const strike = key => canvas.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
        const middle = () => toppleView.pick(canvas.clientWidth / 2, canvas.clientHeight / 2), inFront = middle();
        strike('Enter');
        is(chosen() === String(inFront), true);
        strike('Enter');
        is(chosen() !== String(inFront), true);
        strike('ArrowLeft');
        strike('ArrowRight');
        toppleView.render();
        is(middle() === inFront, true);
    )");
}

TEST_F(Page, has_pictures_on_paper_and_without_webgl) {
    write_report(folder_ / "report.html", test::SyntheticScene(0.1).make());
    const std::string coloured = R"(
        const colours = canvas => {
            const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height), found = new Set();
            for (let i = 0; i < data.length; i += 4) if (data[i + 3]) found.add(data[i] >> 4 << 8 | data[i + 1] >> 4 << 4 | data[i + 2] >> 4);
            return found.size;
        };
    )";
    const auto paper = open(folder_ / "report.html", coloured + R"(
        dispatchEvent(new Event('beforeprint'));
        out.empty = [...document.querySelectorAll('img.picture')].filter(image => !image.src).length;
        is(document.querySelectorAll('img.picture').length, 6, 'of four cards, and of two lines of the first page');
        out.scene = colours(document.querySelector('.on-paper')) > 20;
        is(document.querySelectorAll('#sheet .box').length, 3, 'what there is advice on, and what is grey');
        out.sheet = document.getElementById('sheet').textContent;
        is(document.querySelectorAll('#plan svg image').length, 1);
    )");
    EXPECT_EQ(paper.data("empty"), "0");
    EXPECT_EQ(paper.data("scene"), "true");
    paper.says("sheet", {"What is counted as the building is not judged.",
                         "This is no safety certificate", "Object 3, high, unsure: Fix it where it",
                         "sets free 260\u00a0J", "once in about 500 years"});
    const auto still = open(folder_ / "report.html", coloured + R"(
        const canvas = document.querySelector('.still');
        out.scene = colours(canvas) > 20;
        const before = canvas.toDataURL();
        document.querySelectorAll('#sides button')[1].click();
        is(canvas.toDataURL() !== before, true);
        paintPictures(toppleScene, true);
        out.empty = [...document.querySelectorAll('img.picture')].filter(image => !image.src).length;
        is([...document.querySelectorAll('.stage .hint')].filter(hint => !hint.hidden).length, 0, 'how to turn what isn\'t there');
    )",
                            "--disable-3d-apis");
    EXPECT_EQ(still.data("view"), "none");
    EXPECT_EQ(still.data("rows"), "6") << "the table works without it";
    EXPECT_EQ(still.data("scene"), "true");
    EXPECT_EQ(still.data("empty"), "0");
    EXPECT_THAT(still.dom, HasSubstr("The 3D view needs WebGL"));
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
    if (axe_script().empty())
        GTEST_SKIP() << "axe-core is missing: pip install axe-core-python into build/venv (or run "
                        "./dev setup)";
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    const std::string look = test::bytes_of_file(axe_script()) + R"(;
        const faults = [], ground = getComputedStyle(document.body).backgroundColor;
        // Drawings stay light on a dark page, whose colour axe takes for theirs where they are scrolled out of view.
        const where = ground === 'rgb(18, 20, 23)' ? {exclude: [['svg']]} : document;
        for (const details of document.querySelectorAll('details')) details.open = true;
        for (const id of [null, 3]) {
            if (id !== null) toppleChoose(id);
            const {violations} = await axe.run(where, {resultTypes: ['violations']});
            for (const {id: rule, nodes} of violations) faults.push(`${rule} ${nodes[0].target}`);
        }
        is(faults.join(', '), '');
        out.looked = ground;
    )";
    const auto page = open(folder_ / "report.html", look);
    EXPECT_EQ(page.data("looked"), "rgb(243, 244, 246)") << page.log.substr(0, 2000);
    const auto dark =
        open(folder_ / "report.html", look, "--blink-settings=preferredColorScheme=0");
    EXPECT_EQ(dark.data("looked"), "rgb(18, 20, 23)") << dark.log.substr(0, 2000);
}

// What the report's page says of what is at risk.

class PageRisk : public test::InBrowser {};

TEST_F(PageRisk, has_one_order_in_which_to_act) {
    Scene scene = test::SyntheticScene(0.2).make();
    scene.events["tolerable_J"] = 0.1;
    // The riskiest is harmless, and the one of the highest category tolerated.
    scene.objects[3].unsafety_category = "none";
    scene.objects[4].unsafety_category = "high";
    scene.objects[4].unsafety = 9;
    scene.objects[4].agreement = 0.55;
    test::say_actions(scene);
    const auto page = open(scene, R"(
        const card = id => document.querySelector(`.item[data-object="${id}"]`).closest('.card').textContent;
        is([...document.querySelectorAll('.item')].map(item => item.dataset.object).join(' '), '4 2 1 3');
        out.rows = [...document.querySelectorAll('#objects tbody tr')].map(row => row.cells[0].textContent).join(' ');
        out.harmless = card(3);
        out.high = card(4);
        topplePlan.paint();
        is(document.querySelectorAll('#plan .chip').length, 4);
        is([...document.querySelectorAll('#objects .category, .item .category')].filter(badge => badge.textContent === 'none, unsure')
            .map(badge => badge.style.background).join(' '), 'rgb(222, 226, 230) rgb(222, 226, 230)');
    )");
    EXPECT_EQ(page.data("rows").substr(0, 7), "4 2 1 3");
    page.says("harmless", {"none, unsure", "Risk 6.5 \u00b1 1.3 J per walk",
                           "No need to act. To bring its risk below the 0.1 J per event that this "
                           "run tolerates all the same: fix it where it stands"});
    page.says("high", {"high", "How sure: one whole thing: 55 % likely",
                       "Its risk is below the 0.1", "m above the floor"});
}

TEST_F(PageRisk, lists_what_is_to_be_looked_at) {
    Scene scene = test::SyntheticScene(0.2).make();
    scene.events = {{"pga_m_s2", 2.94}, {"pga_spread", 0.5}, {"hazard_from_g", 0.4}};
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
    scene.objects[2].piece_of = 1;
    scene.objects[2].piece_probability = 0.864;
    scene.objects[2].weakest_joint = {3, 5};
    scene.objects[2].alternatives.emplace_back().probability = 0.48;
    test::say_actions(scene);
    const auto page = open(scene, R"(
        const text = id => document.querySelector(`.item[data-object="${id}"]`).closest('.card').textContent;
        is([...document.querySelectorAll('.item')].map(item => item.dataset.object).join(' '), '2 3 1 4');
        for (const id of [1, 2, 3, 4]) out[`card${id}`] = text(id);
        is([...document.querySelectorAll('#risk h3')].map(node => node.textContent).join(', '), 'To look at, Counted as the building');
        topplePlan.paint();
        is([...document.querySelectorAll('#plan .number')].map(node => node.textContent).join(', '), '2, 3, 1, 4 ?');
        is([...document.querySelectorAll('#objects tbody tr')].find(row => row.cells[0].textContent === '1').cells[8].textContent, 'check');
        toppleChoose(3);
        out.detail = document.getElementById('detail').textContent;
        is(`${number(16234.5)}, ${number(0.00012)}`, '16,200, 0.0001');
    )");
    page.says("card1", {"Nothing upsets it as measured; if its foot is one error smaller, it falls "
                        "with up to 180 J: check that it stands firm."});
    page.says("card2", {"unsure: two things (look whether its parts 3 and 5 are one), 48 % likely",
                        "Part of object 1?", "a piece of object 1 (86 % likely)"});
    page.says("card3", {"what holds it: seen, 40 % likely, one of several readings",
                        "An earthquake upsets it once in at most 500 years: the curve of the "
                        "hazard begins at 0.4",
                        "Upset by 1 in 40 walks or 1 in 40 earthquakes around 0.3 g."});
    page.says("card4", {"Go and look what holds it."});
    page.says("detail",
              {"Of 100 earthquakes that all peak at 0.3 g (very strong shaking, "
               "intensity VII) about 15 would upset it, and on a floor where it can\u2019t "
               "slide about 27. Half of those that peak at 0.41 g",
               "Its risk is reckoned with earthquakes around 0.3 g, two of three from "
               "0.18 to 0.49 g: of all these 1 in 40 earthquakes."});
    EXPECT_THAT(page.data("card3"), Not(HasSubstr("Of 100 earthquakes")));
}

// What of the building may be a thing: counted where it would matter, told with its letter, and its
// parts are ticked by a click.
TEST_F(PageRisk, says_what_of_the_building_may_be_a_thing) {
    Scene scene = test::SyntheticScene(0.2).make();
    PossibleThing wall;
    wall.primitives = {1};
    wall.probability = 0.45;
    wall.size_m = {4.2, 5.2, 2.5};
    wall.barrier_J = 35;
    wall.unsafety_category = "high";
    scene.possible_things.assign(2, wall);
    scene.possible_things[1].primitives = {2};
    scene.possible_things[1].unsafety_category = "none";
    open(scene, R"(
        is(document.getElementById('headline').textContent, '2 things to act on, 1 in the building to check');
        const group = document.querySelector('.furniture').closest('.cards');
        group.open = true;
        is(group.textContent.includes('Counted as the building (1 may be a thing)'), true, group.textContent);
        is(/A: .*45 % likely a thing; then 35 J upset it: high/.test(group.textContent), true, group.textContent);
        is(document.querySelectorAll('.furniture li').length, 1);
        document.querySelector('.furniture button').click();
        is(document.querySelectorAll('#mend input:checked').length > 0, true);
    )");
}

// Of a report as a stranger opens it: how many to act on, and no card of more than 30 words.
TEST_F(PageRisk, says_first_what_to_do_in_few_words) {
    Scene scene = test::SyntheticScene(0.2).make();
    scene.objects[2].piece_of = 1;
    scene.objects[4].seen_enough = false;
    scene.objects[4].unsafety_category.clear();
    const auto page = open(scene, R"(
        is(document.getElementById('headline').textContent, '1 thing to act on, 1 to look at, 1 not judged');
        is([[0, 0, 0], [2, 0, 1], [0, 3, 0]].map(counts => headlineText(...counts)).join('; '), 'Nothing to act on; 2 things to act on, 1 not judged; Nothing to act on, 3 to look at');
        is(headlineText(0, 3, 1, 0, 2), '3 things to look at, 2 may be dangerous, 1 not judged');
        is([...document.querySelectorAll('.cards')].map(group => group.open).join(' '), 'true true false false', 'what may be dangerous is open, too');
        is(document.querySelector('.cards .item').dataset.object, 3);
        is(document.querySelector('#colour-by [data-value=reach]'), null, 'nobody reaches for things here');
        is([[0, 0], [0.1, 0.05], [0.1, 0.5], [0.1, 2]].map(([chance, risk]) => reachCategory({fall_chance: {reach: chance}, risk_J: {reach: risk}})).join(' '), 'none low medium high');
        is(document.querySelector('#colour-by [aria-pressed=true]').dataset.value, 'risk');
        const words = text => text.split(/\s+/).filter(word => /[\p{L}\p{N}]/u.test(word)).length;
        is(words(document.body.innerText) < 250, true, document.body.innerText);
        for (const group of document.querySelectorAll('.cards')) group.open = true;
        is([...document.querySelectorAll('.card')].filter(card => words(card.innerText) > 30).length, 0);
        const panel = document.createElement('div'), many = Array.from({length: 5}, () => toppleScene.objects[3]);
        fillRisk(panel, {...toppleScene, objects: many}, {});
        is(panel.querySelectorAll('.cards > .items > .card').length, 3);
        is(panel.querySelector('.cards > details > summary').textContent, '2 more');
        // Whoever corrects sees objects.
        document.getElementById('wrong').click();
        is(document.getElementById('mend').open, true);
        await new Promise(done => setTimeout(done, 50));
        is(document.querySelector('#colour-by [aria-pressed=true]').dataset.value, 'object');
        document.getElementById('mend').open = false;
        await new Promise(done => setTimeout(done, 50));
        is(document.querySelector('#colour-by [aria-pressed=true]').dataset.value, 'risk');
    )");
}

// What a barrier within its error leaves open is told in the figures of a push; what stood where so
// many pass, in spite of its figures; what lies flat needs room.
TEST_F(PageRisk, says_what_is_not_known_and_what_to_try_by_hand) {
    Scene scene = test::SyntheticScene(0.2).make();
    scene.notes.push_back(
        "The points are about 52 mm apart: boards thinner than 129 mm may come out too thick or "
        "too thin, and what stands on less than 517 mm more or less firmly, by more than their "
        "errors say. A denser scan tells.");
    Object& shelf = scene.objects[4];  // nothing in the way of what it falls to
    shelf.barrier_error_J = 30;
    shelf.overturning = {9.5, 4, {}, 168, 140, 300, 0.1};
    shelf.size_m = {0.39, 2.7, 1.96};
    Object& slider = scene.objects[1];
    slider.barrier_error_J = 100;
    slider.mode = "slide";
    slider.overturning = {11, 4, {}, 56, 24, 240, 0.1};
    slider.size_m = {0.7, 1.3, 1.1};
    Object& monitor = scene.objects[3];
    monitor.fall_chance["human"] = 0.09;
    monitor.fall.drop_m = 0;
    monitor.fall.lands_on = -1;
    monitor.rest_probability = 0.57;
    monitor.advice.sentence = "Fasten it, with two straps or brackets.";
    Object& cup = scene.objects[2];
    cup.unsafety_category = "none";
    cup.unsafety_certain = false;
    Object& ball = scene.objects[5];  // taken for a wardrobe
    ball.barrier_J = 5;
    ball.size_m = {0.4, 2.7, 1.96};
    ball.instability = {{20, 595}};
    test::say_actions(scene);
    const auto page = open(scene, R"(
        const card = id => document.querySelector(`.item[data-object="${id}"]`).closest('.card').textContent;
        for (const id of [1, 3, 4]) out[`card${id}`] = card(id);
        out.tall = card(5);
        out.coarse = document.querySelector('#believe .warning').textContent;
        toppleChoose(2);
        out.pane = document.getElementById('detail').textContent;
        toppleChoose(4);
        out.doubt = document.getElementById('detail').textContent;
        dispatchEvent(new Event('beforeprint'));
        out.sheet = document.getElementById('sheet').textContent;
        is([...document.querySelectorAll('#sheet li strong')].map(node => node.textContent.match(/Object (\d)/)).filter(found => found).map(found => found[1]).join(' '), '3 4 1 5', 'what is to be looked at as the cards have it');
    )");
    const std::string foot =
        "Its foot is too poorly seen to tell: between nothing and 308 N at its top would tip it. "
        "Hold it, push gently, and look.";
    const std::string stood =
        "It stood there though so many pass: its foot was probably badly seen. Hold it and push "
        "gently first.";
    const std::string coarse = "Coarse scan (points 5 cm apart)";
    page.says("card1", {"from 240 N on it slides. Hold it, push gently, and look."});
    page.says("card3", {stood, "It falls flat to the", "Keep "});
    page.says("card4", {foot});
    page.says("doubt", {foot});
    page.says("sheet", {"look whether it stands firm. " + foot,
                        "It may set free up to 410\u00a0J: can kill.",
                        stood + " Fasten it, with two straps", "Brackets: 2, at 30 cm", coarse,
                        "Object 5, none: Nothing in this run upsets it. It is tall and heavy: see "
                        "that it is fastened."});
    page.says("coarse",
              {coarse +
               ": unsure of all things narrower than 52 cm, here 4 and 5: a denser scan tells."});
    page.says("tall", {"Object 5", "Tall and heavy: see that it is fastened."});
    page.says("pane", {"none, unsure: it"});
    for (const char* where : {"card1", "card3", "card4", "pane", "sheet"}) {
        EXPECT_THAT(page.data(where), Not(HasSubstr("none, or lower")));
        EXPECT_THAT(page.data(where), Not(HasSubstr("touch would")));
        EXPECT_THAT(page.data(where), Not(HasSubstr("57 % likely")));
    }
}

}  // namespace
}  // namespace topple::report
