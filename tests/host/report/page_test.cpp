// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "clicking.h"
#include "in_browser.h"
#include "report/report.h"
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
        is(document.getElementById('say').textContent, 'Object 3 chosen: 6.2\u00a0kg, category high?. Upset by 1 walk in 40 or 1 earthquake in 40.');
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
    EXPECT_EQ(page.data("missed"), "(none)");
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
                         "This is no safety certificate", "Object 3, high?: Fix it where it",
                         "sets free 260\u00a0J", "once in about 500 years"});
    const auto still = open(folder_ / "report.html", coloured + R"(
        const canvas = document.querySelector('.still');
        out.scene = colours(canvas) > 20;
        const before = canvas.toDataURL();
        document.querySelectorAll('#sides button')[1].click();
        is(canvas.toDataURL() !== before, true);
        paintPictures(toppleScene, true);
        out.empty = [...document.querySelectorAll('img.picture')].filter(image => !image.src).length;
    )",
                            "--disable-3d-apis");
    EXPECT_EQ(still.data("view"), "none");
    EXPECT_EQ(still.data("scene"), "true");
    EXPECT_EQ(still.data("empty"), "0");
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
    const auto page = open(test::SyntheticScene(0.2).make(), read(axe_script()) + R"(;
        const faults = [];
        document.getElementById('glossary').open = true;
        for (const id of [null, 3]) {
            if (id !== null) toppleChoose(id);
            const {violations} = await axe.run(document, {resultTypes: ['violations']});
            for (const {id: rule, nodes} of violations) faults.push(`${rule} ${nodes[0].target}`);
        }
        is(faults.join(', '), '');
        out.looked = '1';
    )");
    EXPECT_EQ(page.data("looked"), "1") << page.log.substr(0, 2000);
}

}  // namespace
}  // namespace topple::report
