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

// Clicks at one place go from what is seen there to what lies behind.
TEST_F(Page, chooses_what_lies_behind) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.1).make());
    const auto page = open(folder_ / "report.html", test::clicking + R"(
        const chosen = () => out.chosen || 'none', line = [];
        // The cup hides some of the table, and both the floor.
        for (let n = 0; n < 4; ++n) {
            click((part, object) => object === 2);
            line.push(chosen());
        }
        out.line = line.join(' ');
        // Elsewhere it begins anew.
        click((part, object) => object === 2);
        click((part, object) => object === 1);
        out.elsewhere = chosen();
        toppleChoose(null);
        const strike = key => canvas.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
        const middle = () => toppleView.pick(canvas.clientWidth / 2, canvas.clientHeight / 2), inFront = middle();
        strike('Enter');
        out.front = chosen() === String(inFront);
        strike('Enter');
        out.behind = chosen() !== String(inFront);
        strike('ArrowLeft');
        strike('ArrowRight');
        toppleView.render();
        out.unchanged = middle() === inFront;
    )");
    EXPECT_EQ(page.data("error"), "(none)") << page.log;
    EXPECT_EQ(page.data("missed"), "(none)");
    EXPECT_EQ(page.data("line"), "2 1 0 none");
    EXPECT_EQ(page.data("elsewhere"), "1");
    for (const char* key : {"front", "behind", "unchanged"})
        EXPECT_EQ(page.data(key), "true") << key;
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
    EXPECT_EQ(paper.data("pictures"), "6") << "of four cards, and of two lines of the first page";
    EXPECT_EQ(paper.data("empty"), "0");
    EXPECT_EQ(paper.data("scene"), "true");
    EXPECT_EQ(paper.data("boxes"), "3") << "what there is advice on, and what is grey";
    for (const char* part :
         {"What is counted as the building is not judged.", "This is no safety certificate",
          "Object 3, high?: Fix it where it", "sets free 260\u00a0J", "once in about 500 years"})
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
