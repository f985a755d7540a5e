// SPDX-License-Identifier: MIT
#include "report/report.h"

#include "in_browser.h"
#include "synthetic_scene.h"
#include "topple/error.h"

namespace topple::report {
namespace {

namespace fs = std::filesystem;

class Report : public test::InBrowser {
    void SetUp() override {}  // these take no browser
};
class ShownReport : public test::InBrowser {};

TEST_F(Report, is_one_file_whose_text_can_not_break_out) {
    const auto scene = test::SyntheticScene(0.08).make();
    write_report(folder_ / "report.html", scene, {}, {{}, scene.source});
    const auto html = test::bytes_of_file(folder_ / "report.html");
    EXPECT_NE(html.find("<title>topple: made-up &lt;room&gt; &amp; &quot;hall&quot; "
                        "&lt;/script&gt;&lt;b&gt;.ply</title>"),
              std::string::npos);
    EXPECT_EQ(html.find("</script><b>"), std::string::npos);
    EXPECT_EQ(html.find("<i>markup"), std::string::npos);
    EXPECT_EQ(html.find("<script src"), std::string::npos);
    EXPECT_EQ(html.find("stylesheet"), std::string::npos);
    EXPECT_NE(html.find("three.js authors"), std::string::npos) << "its licence asks for this";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(Report, stays_below_15_megabytes) {
    auto scene = test::SyntheticScene(0.02).make();
    // A million loose voxels, all exposed, and two million points with normals.
    for (int i = 0; i < 1000000; ++i) {
        test::add(scene.solid, float(i % 100) * 0.04f, float(i / 100 % 100) * 0.04f,
                  3 + float(i / 10000) * 0.04f);
        scene.solid.primitive.push_back(i % 9);
        scene.solid.object.push_back(i % 6);
        scene.solid.state.push_back(0);
    }
    auto& p = scene.points;
    for (auto* values : {&p.x, &p.y, &p.z, &p.nx, &p.ny, &p.nz}) values->resize(2000000, 0.5f);
    p.primitive.resize(2000000, 1);
    p.object.resize(2000000, 0);
    write_report(folder_ / "report.html", scene);
    EXPECT_LT(fs::file_size(folder_ / "report.html"), 15000000u);
}

TEST_F(Report, takes_what_a_simulator_found) {
    const fs::path file = folder_ / "report.html";
    write_report(file, test::SyntheticScene(0.1).make());
    const std::string before = test::bytes_of_file(file);
    EXPECT_NE(before.find("id=\"verified\">null</script>"), std::string::npos);
    EXPECT_TRUE(add_verification(file, R"({"simulator": "</script><b>"})"));
    EXPECT_NE(test::bytes_of_file(file).find(
                  R"(id="verified">{"simulator": "\u003c/script>\u003cb>"}</script>)"),
              std::string::npos);
    // A second time it is replaced.
    EXPECT_TRUE(add_verification(file, "null"));
    EXPECT_EQ(test::bytes_of_file(file), before);
    std::ofstream(folder_ / "old.html") << "<html></html>";
    EXPECT_FALSE(add_verification(folder_ / "old.html", "null"));
    EXPECT_THROW(add_verification(folder_ / "missing.html", "null"), Error);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

TEST_F(ShownReport, shows_what_a_simulator_found) {
    const fs::path file = folder_ / "report.html";
    write_report(file, test::SyntheticScene(0.1).make());
    add_verification(file, R"({"simulator": "MuJoCo 2.2.2", "simulated_s": 5, "cut_short": "",
        "objects": [{"id": 1, "free": true, "stays": true}, {"id": 2, "free": false},
                    {"id": 3, "free": true, "stays": false, "moved_m": 0.4, "turned_deg": 80}]})");
    const Opened page = open(file, R"(
        const words = () => document.getElementById('detail').textContent;
        is(document.getElementById('verification').textContent, 'In MuJoCo 2.2.2, 1 of 2 objects stayed for 5\u00a0s; this moved: object 3.');
        toppleChoose(3);
        is(words().includes('Moved in MuJoCo 2.2.2: by 40 cm, turned by 80'), true);
        toppleChoose(1);
        is(words().includes('Stayed in MuJoCo 2.2.2.'), true);
    )");
}

TEST_F(Report, can_not_be_written) {
    EXPECT_THROW(write_report(folder_ / "missing" / "report.html", Scene{}), Error);
}

TEST_F(ShownReport, shows_risks_first_and_the_scans_own_colours_when_asked) {
    auto scene = test::SyntheticScene(0.1).make();
    const auto script = R"(
        const box = document.getElementById('colour-by'), canvas = toppleView.renderer.domElement;
        const greens = () => {
            toppleView.render();
            const gl = toppleView.renderer.getContext(), all = new Uint8Array(4 * canvas.width * canvas.height);
            gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, all);
            let count = 0;
            for (let i = 0; i < all.length; i += 4) count += all[i + 1] > 2 * all[i] + 20;
            return Math.round(100 * count / (canvas.width * canvas.height));
        };
        out.pressed = box.querySelector('[aria-pressed=true]').dataset.value;
        out.buttons = box.querySelectorAll('button').length;
        out.risk = greens();
        if (box.querySelector('[data-value=photo]')) box.querySelector('[data-value=photo]').click();
        out.photo = greens();
        document.querySelector('#show [data-value=points]').click();
        out.dots = greens();
        toppleChoose(3);
        out.faded = greens();
    )";
    const auto plain = open(scene, script);
    EXPECT_EQ(plain.data("pressed"), "risk");
    EXPECT_EQ(plain.data("buttons"), "3");
    auto& p = scene.points;
    p.red.assign(p.x.size(), 30);
    p.green.assign(p.x.size(), 160);
    p.blue.assign(p.x.size(), 40);
    const auto page = open(scene, script);
    EXPECT_EQ(page.data("pressed"), "risk");
    EXPECT_EQ(page.data("buttons"), "4");
    EXPECT_GT(std::atoi(page.data("photo").c_str()), 20);
    EXPECT_LT(std::atoi(page.data("risk").c_str()), 5);
    EXPECT_GT(std::atoi(page.data("dots").c_str()), 10);
    EXPECT_LT(std::atoi(page.data("faded").c_str()), 5);
}

TEST_F(ShownReport, shows_the_scene_in_a_browser) {
    const auto scene = test::SyntheticScene(0.08).make();
    write_report(folder_ / "report.html", scene);
    // Looks which objects cover the view, clicks where one is, uses every control, then asks for
    // one object.
    const auto page = open(folder_ / "report.html", R"(
        const text = id => document.getElementById(id).textContent;
        is([...document.querySelectorAll('.item')].map(item => item.dataset.object).join(' '), '2 3 4 1', 'by category, what is certain, then by risk');
        out.first = document.querySelector('.item[data-object="3"]').closest('.card').textContent;
        const canvas = toppleView.renderer.domElement, box = canvas.getBoundingClientRect();
        const pixels = () => {
            toppleView.render();
            const gl = toppleView.renderer.getContext(), all = new Uint8Array(4 * canvas.width * canvas.height);
            gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, all);
            return all;
        };
        const differ = (a, b) => {
            let count = 0;
            for (let i = 0; i < a.length; i += 4) count += a[i] !== b[i] || a[i + 1] !== b[i + 1] || a[i + 2] !== b[i + 2];
            return count;
        };
        const plain = pixels();
        out.drawn = differ(plain, new Uint8Array(plain.length));
        for (const field of ['human', 'wind', 'earthquake', 'walks']) {
            const control = document.querySelector(`[data-field=${field}]`);
            control.click();
            out[field] = differ(plain, pixels());
            control.click();
        }
        // Where the monitor is seen: the first place of a grid.
        let at = null;
        for (let x = 5; x < box.width && !at; x += 5) {
            for (let y = 5; y < box.height && !at; y += 5) if (toppleView.pick(x, y) === 3) at = [x, y];
        }
        for (const type of ['pointerdown', 'pointerup'])
            canvas.dispatchEvent(new PointerEvent(type, {clientX: box.left + at[0], clientY: box.top + at[1], button: 0, bubbles: true, pointerId: 1}));
        out.clicked = text('detail');
        is(toppleView.marker.parts().join(' '), 'middle lands');
        is(document.querySelectorAll('.contacts .contact').length, 1, 'of the monitor\'s part with the table\'s');
        toppleChoose(null);
        toppleChoose(2);
        is(toppleView.marker.parts().join(' '), 'middle lands move');
        toppleChoose(null);
        const seen = toppleView.seen();
        is([...seen.keys()].filter(id => seen.get(id) > 10).sort().join(' '), '0 1 2 3 4 5', 'every object is seen, through the walls');
        out.middle = toppleView.pick(toppleView.container.clientWidth / 2, toppleView.container.clientHeight / 2);
        for (const control of document.querySelectorAll('.toolbar button, .toolbar input')) control.click();
        document.querySelectorAll('#objects thead button')[1].click();
        is([...document.querySelectorAll('#objects tbody tr')].pop().cells[0].textContent, 0);
        document.querySelectorAll('#objects tbody tr')[0].click();
        toppleChoose(3);
        toppleView.render();
    )");
    EXPECT_EQ(page.data("view"), "(none)") << "the 3D view must work";
    EXPECT_EQ(page.data("rows"), "6");
    EXPECT_NE(page.data("middle"), "null") << "the scene is in the middle of the view";
    page.says(
        "first",
        {"Object 3", "6.2\u00a0kg", "Upset by 1 in 40 walks or 1 in 40 earthquakes.",
         "It tips over to the north, falls 76 cm to the floor",
         "and takes object 2 along. It would land where 12 of 100 people pass who walk through "
         "the room, with 260\u00a0J.",
         "Goes over once it leans 15.2 \u00b1 0.4\u00b0, or at a steady push of 31 \u00b1 1 N at "
         "its top",
         "(the weight of 3.2 kg), if 18 N don't slide it before; begins to rock where the ground "
         "shakes with 0.27 g (very strong shaking, intensity VII).",
         "Risk 6.5 \u00b1 1.3 J per walk", "Fix it where it stands: 12 N"});
    page.says("clicked",
              {"Object 3", "Barrier: energy that moves it", "1.4\u00a0J",
               "Risk from people walking by", "6.5\u00a0J \u00b1 1.3", "Contacts", "Category",
               "high, unsure: its errors, or what it may be a piece of, leave a lower one "
               "open",
               "Of 100 earthquakes that all peak at 0.8 g (violent shaking, intensity IX) about 99 "
               "would upset it. Half of those that peak at 0.41 g (severe shaking, intensity VIII) "
               "would.",
               "An earthquake upsets it once in about 500 years.",
               "Chance of falling, over an earthquake\u2019s peak"});
    EXPECT_GT(std::stoi("0" + page.data("drawn")), 50000) << "pixels that are not blank";
    for (const char* field : {"human", "wind", "earthquake", "walks"})
        EXPECT_GT(std::stoi("0" + page.data(field)), 2000) << field << ": pixels that it changes";
    EXPECT_NE(page.data("first-picture-ms"), "(none)");
    EXPECT_GT(std::stoi("0" + page.data("faces")), 10000);
    EXPECT_EQ(page.data("points"), std::to_string(scene.points.x.size()));
    // Faces that look away from the camera, to three of six sides, are left out.
    EXPECT_GT(std::stoi("0" + page.data("triangles")), std::stoi("0" + page.data("faces")) / 2);
    EXPECT_LT(std::stoi("0" + page.data("triangles")), 3 * std::stoi("0" + page.data("faces")) / 2);
    // Three charts' worth of text: the panel of object 3, its curve, the sampler's.
    for (const char* expected :
         {"Object 3", "It tips over.", "Instability S(W)", "class=\"curve\"", "Rests on",
          "Poses: energy", "Disconnectivity graph", "Places: work", "data:image/png", "fallen",
          "A note with &lt;i&gt;markup&lt;/i&gt;", "sampler", "look through walls"}) {
        EXPECT_NE(page.dom.find(expected), std::string::npos) << expected;
    }
}

// A tetrahedron in place of the scene's voxels.
ObjectSurface tetrahedron() {
    ObjectSurface out;
    out.object = 5;
    const std::array<Vec3, 4> corner{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
    const std::array<Vec3, 4> normal{{{0, 0, -1}, {0, -1, 0}, {-1, 0, 0}, {0.577, 0.577, 0.577}}};
    const std::array<std::array<std::size_t, 3>, 4> face{
        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    for (std::size_t f = 0; f < face.size(); ++f) {
        const auto first = static_cast<std::uint32_t>(out.vertex.size());
        for (const std::size_t c : face[f]) {
            out.vertex.push_back(corner[c]);
            out.normal.push_back(normal[f]);
        }
        out.triangle.push_back({first, first + 1, first + 2});
        out.primitive.push_back(0);
    }
    return out;
}

TEST_F(ShownReport, shows_surfaces_in_a_browser) {
    const std::vector surfaces{tetrahedron()};
    write_report(folder_ / "report.html", test::SyntheticScene(0.08).make(), surfaces);
    const auto page = open(folder_ / "report.html", R"(
        toppleView.render();
        const seen = toppleView.seen();
        is([...seen.keys()].filter(id => seen.get(id) > 10).sort().join(' '), 5);
        out.pixels = seen.get(5);
    )");
    EXPECT_EQ(page.data("view"), "(none)") << "the 3D view must work";
    EXPECT_EQ(page.data("faces"), "4");
    EXPECT_GT(std::stoi("0" + page.data("pixels")), 2000);
}

TEST_F(ShownReport, shows_all_on_a_phone) {
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    const auto page = open_on_phone(folder_ / "report.html", R"(
        out.window = innerWidth;
        const widths = [];
        for (const id of [null, 0, 3, 2]) {
            toppleChoose(id);
            widths.push(document.documentElement.scrollWidth - document.documentElement.clientWidth);
        }
        out.widths = widths.join(' ');
        const canvas = document.querySelector('#canvas canvas').getBoundingClientRect();
        out.canvas = canvas.width >= 300 && canvas.height >= 280 && canvas.right <= innerWidth;
        toppleChoose(null);
        const items = () => [...document.querySelectorAll('.item')].filter(item => item.checkVisibility()).length;
        out.items = items();
        for (const group of document.querySelectorAll('.cards')) group.open = true;
        out.more = items();
        out.first = document.querySelector('.stage').getBoundingClientRect().top < document.getElementById('risk').getBoundingClientRect().top;
        const small = [...document.querySelectorAll('p, td, button, dd')].filter(node => node.offsetHeight > 0 &&
            parseFloat(getComputedStyle(node).fontSize) < 12);
        out.small = small.length;
        out.failed = document.body.dataset.error || '';
    )");
    EXPECT_EQ(page.data("window"), "390") << page.log;
    EXPECT_EQ(page.data("widths"), "0 0 0 0") << "nothing to scroll sideways";
    EXPECT_EQ(page.data("canvas"), "true");
    EXPECT_EQ(page.data("items"), "2");
    EXPECT_EQ(page.data("first"), "true") << "the view comes before the cards";
    EXPECT_EQ(page.data("more"), "4");
    EXPECT_EQ(page.data("small"), "0") << "text too small to read";
    EXPECT_EQ(page.data("failed"), "");
}

TEST_F(ShownReport, says_so_where_disturbances_are_missing) {
    auto scene = test::SyntheticScene(0.2).make();
    scene.fields.erase("wind");
    scene.fields["human"] = {};
    scene.walks = {};
    for (auto& object : scene.objects) object.risk_J.erase("wind");
    // The monitor's barrier can't be told from 0; the ball's is 0, and nothing puts it at risk.
    scene.objects[3].barrier_error_J = 2;
    const auto page = open(scene, R"(
        out.about = document.getElementById('about').textContent;
        out.risk = document.getElementById('risk').textContent;
        is(document.getElementById('missing').textContent, 'Not shown: People walking by: it reaches nothing here. Wind: this run left it out. Walked floor: no floor was found that people could walk on.');
        is([...document.querySelectorAll('[data-field]')].filter(box => box.disabled)
            .map(box => box.dataset.field).join(' '), 'human wind walks');
    )");
    EXPECT_THAT(page.data("about"), Not(HasSubstr("left out")))
        << "whether there is wind the notes say: ";
    page.says("about",
              {"About this scan (3 notes)", "No floor was found on which people could walk"});
    page.says("risk", {"To act on", "To look at",
                       "Unsure what holds it; its fall can kill.Hold it and push gently"});
}

TEST_F(ShownReport, words_fit_the_numbers) {
    const auto page = open(test::SyntheticScene(0.2).make(), R"(
        is([[1, 2], [12345.25, 12345.75], [0.50001, 0.50002]]
            .map(([low, high]) => distinctNumbers(low, high).join(' ')).join(', '), '1 2, 12345 12346, 0.50001 0.50002');
        is([0, 1e-5, 0.031, 0.5, 1].map(chance => chanceText('human', chance)).join('; '), 'no walk; less than 1 in 10,000 walks; 1 in 32 walks; 5 in 10 walks; nearly every walk');
        const chart = energyChart([12345.75, 12345.5, 12345.25]);
        const curve = chart.querySelector('.curve').getAttribute('d').match(/[\d.]+ [\d.]+/g).map(at => Number(at.split(' ')[1]));
        const caption = [...chart.querySelectorAll('text')].find(text => text.textContent.startsWith('energy'));
        is(Math.min(...curve) > Number(caption.getAttribute('y')) + 8, true, 'a line runs through the text');
    )");
}

TEST_F(ShownReport, shows_scenes_with_nothing_or_with_holes_in_them) {
    auto scene = test::SyntheticScene(0.2).make();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    auto& object = scene.objects[2];
    object.mass_kg = object.barrier_J = object.unsafety = object.center_of_mass_m[1] = nan;
    object.risk_J["wind"] = std::numeric_limits<double>::infinity();
    object.instability[0].S_J = nan;
    scene.swc_energy[3] = nan;
    for (const auto& s : {Scene{}, scene}) {
        const auto page = open(s,
                               "for (let id = 0; id < 6; ++id) toppleChoose(id);"
                               "out.used = '1';");
        EXPECT_EQ(page.data("rows"), std::to_string(s.objects.size()));
        auto shown = page.dom.substr(0, page.dom.find("id=\"data\""));
        EXPECT_GT(shown.size(), 1000u);
        // Pictures are base64, which may hold any three letters.
        for (auto at = shown.find("data:image"); at != std::string::npos;
             at = shown.find("data:image"))
            shown.erase(at, shown.find('"', at) - at);
        EXPECT_EQ(shown.find("NaN"), std::string::npos) << "no number shows as NaN";
    }
}

}  // namespace
}  // namespace topple::report
