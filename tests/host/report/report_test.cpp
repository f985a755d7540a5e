// SPDX-License-Identifier: MIT
#include "report/report.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "synthetic_scene.h"
#include "topple/error.h"

namespace topple::report {
namespace {

namespace fs = std::filesystem;

class Report : public ::testing::Test {
  protected:
    Report() {
        auto name = (fs::temp_directory_path() / "topple-test-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~Report() override {
        std::error_code error;
        fs::remove_all(folder_, error);
    }

    std::string read(const fs::path& file) const {
        std::ostringstream out;
        out << std::ifstream(file, std::ios::binary).rdbuf();
        return out.str();
    }

    // Opens the page in a headless browser, runs `script` after the page's own, and returns the
    // page as it then stands and what the browser logged. `flags`: more for the browser.
    struct Opened {
        std::string dom, log;
        std::string data(const std::string& name) const {
            const auto key = "data-" + name + "=\"";
            const auto body = dom.find("<body");
            const auto at = dom.find(key, body);
            if (body == std::string::npos || at == std::string::npos || at > dom.find('>', body))
                return "(none)";
            return dom.substr(at + key.size(), dom.find('"', at + key.size()) - at - key.size());
        }
    };
    Opened open(const fs::path& page, const std::string& script = "",
                const std::string& flags = "") {
        const auto shown = folder_ / "shown.html";
        std::ofstream(shown) << read(page) << "<script>" << script << "</script>";
        const std::string command =
            "timeout 240 chromium --headless --no-sandbox --use-angle=swiftshader "
            "--enable-unsafe-swiftshader --enable-logging=stderr --window-size=900,900 "
            "--user-data-dir='" +
            (folder_ / "browser").string() + "' " + flags +
            " --virtual-time-budget=10000 --dump-dom 'file://" + shown.string() + "' > '" +
            (folder_ / "dom").string() + "' 2> '" + (folder_ / "log").string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0);
        return {read(folder_ / "dom"), read(folder_ / "log")};
    }

    fs::path folder_;
};

bool no_browser() {
    return std::system("command -v chromium > /dev/null 2>&1") != 0;
}

// A browser that is missing skips a test by name, and fails it where everything must run.
#define NEEDS_BROWSER()                                                                \
    if (no_browser()) {                                                                \
        const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");                 \
        if (required && std::string(required) == "1") FAIL() << "chromium is missing"; \
        GTEST_SKIP() << "chromium is missing: apt-get install chromium";               \
    }

TEST_F(Report, is_one_file_whose_text_can_not_break_out) {
    const auto scene = test::SyntheticScene(0.08).make();
    write_report(folder_ / "report.html", scene);
    const auto html = read(folder_ / "report.html");
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
        scene.solid.x.push_back(float(i % 100) * 0.04f);
        scene.solid.y.push_back(float(i / 100 % 100) * 0.04f);
        scene.solid.z.push_back(3 + float(i / 10000) * 0.04f);
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

TEST_F(Report, can_not_be_written) {
    EXPECT_THROW(write_report(folder_ / "missing" / "report.html", Scene{}), Error);
}

TEST_F(Report, shows_the_scene_in_a_browser) {
    NEEDS_BROWSER();
    const auto scene = test::SyntheticScene(0.08).make();
    write_report(folder_ / "report.html", scene);
    // Looks which objects cover the view, then uses every control, then asks for one object.
    const auto page = open(folder_ / "report.html", R"(
        const seen = toppleView.seen();
        document.body.dataset.found = [...seen.keys()].filter(id => seen.get(id) > 10).sort().join(' ');
        document.body.dataset.middle = toppleView.pick(toppleView.container.clientWidth / 2, toppleView.container.clientHeight / 2);
        for (const control of document.querySelectorAll('.toolbar button, .toolbar input')) control.click();
        document.querySelectorAll('#objects thead button')[2].click();
        document.body.dataset.heaviest = [...document.querySelectorAll('#objects tbody tr')].pop().cells[0].textContent;
        document.querySelectorAll('#objects tbody tr')[0].click();
        toppleChoose(3);
        toppleView.render();
        document.body.dataset.used = '1';
    )");
    EXPECT_EQ(page.data("ready"), "1") << page.log;
    EXPECT_EQ(page.data("used"), "1") << page.log;
    EXPECT_EQ(page.data("error"), "(none)");
    EXPECT_EQ(page.data("view"), "(none)") << "the 3D view must work";
    EXPECT_EQ(page.data("rows"), "6");
    EXPECT_EQ(page.data("found"), "0 1 2 3 4 5") << "every object is seen, through the walls";
    EXPECT_NE(page.data("middle"), "null") << "the scene is in the middle of the view";
    EXPECT_EQ(page.data("heaviest"), "0");
    EXPECT_GT(std::stoi("0" + page.data("faces")), 10000);
    EXPECT_EQ(page.data("points"), std::to_string(scene.points.x.size()));
    EXPECT_EQ(std::stoi("0" + page.data("triangles")), 2 * std::stoi("0" + page.data("faces")));
    for (const char* wrong : {"Uncaught", "THREE.", "ERR_"}) {
        EXPECT_EQ(page.log.find(wrong), std::string::npos) << page.log;
    }
    // Three charts' worth of text: the panel of object 3, its curve, the sampler's.
    for (const char* expected :
         {"Object 3", "It tips over.", "Instability S(W)", "class=\"curve\"", "Rests on",
          "Poses: energy", "Disconnectivity graph", "Places: work", "data:image/png", "fallen",
          "A note with &lt;i&gt;markup&lt;/i&gt;", "sampler", "look through walls"}) {
        EXPECT_NE(page.dom.find(expected), std::string::npos) << expected;
    }
}

TEST_F(Report, says_so_where_there_is_no_webgl) {
    NEEDS_BROWSER();
    write_report(folder_ / "report.html", test::SyntheticScene(0.2).make());
    const auto page = open(folder_ / "report.html", "", "--disable-3d-apis");
    EXPECT_EQ(page.data("ready"), "1") << page.log;
    EXPECT_EQ(page.data("view"), "none");
    EXPECT_EQ(page.data("rows"), "6") << "the table works without it";
    EXPECT_EQ(page.log.find("Uncaught"), std::string::npos) << page.log;
    EXPECT_NE(page.dom.find("The 3D view needs WebGL"), std::string::npos);
}

TEST_F(Report, shows_scenes_with_nothing_or_with_holes_in_them) {
    NEEDS_BROWSER();
    auto scene = test::SyntheticScene(0.2).make();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    auto& object = scene.objects[2];
    object.mass_kg = object.barrier_J = object.unsafety = object.center_of_mass_m[1] = nan;
    object.risk_J["wind"] = std::numeric_limits<double>::infinity();
    object.instability[0].S_J = nan;
    scene.swc_energy[3] = nan;
    for (const auto& s : {Scene{}, scene}) {
        write_report(folder_ / "report.html", s);
        const auto page = open(folder_ / "report.html",
                               "for (let id = 0; id < 6; ++id) toppleChoose(id);"
                               "document.body.dataset.used = '1';");
        EXPECT_EQ(page.data("ready"), "1") << page.log;
        EXPECT_EQ(page.data("used"), "1") << page.log;
        EXPECT_EQ(page.data("error"), "(none)");
        EXPECT_EQ(page.data("rows"), std::to_string(s.objects.size()));
        const auto shown = page.dom.substr(0, page.dom.find("id=\"data\""));
        EXPECT_GT(shown.size(), 1000u);
        EXPECT_EQ(shown.find("NaN"), std::string::npos) << "no number shows as NaN";
    }
}

}  // namespace
}  // namespace topple::report
