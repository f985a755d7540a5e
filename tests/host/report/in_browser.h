// SPDX-License-Identifier: MIT
#pragma once

#include "host/io/files.h"
#include "report/embedded.h"
#include "report/report.h"

namespace topple {
using ::testing::AnyOf, ::testing::HasSubstr, ::testing::Not;
}

namespace topple::report {

inline void write_report(const std::filesystem::path& file, const Scene& scene,
                         std::span<const ObjectSurface> surfaces = {}, ReportWords words = {}) {
    if (words.command.empty()) words.command = {"topple", "parse", scene.source, "-o", "OUT"};
    Report(scene, !surfaces.empty(), std::move(words)).write(file, surfaces, 0);
}

}  // namespace topple::report

namespace topple::test {

// An attribute's text as it was before it was written into the page.
inline std::string text(std::string attribute) {
    const std::string space = "&nbsp;";
    for (auto at = attribute.find(space); at != std::string::npos; at = attribute.find(space))
        attribute.replace(at, space.size(), "\u00a0");
    return attribute;
}

class InBrowser : public Files {
  protected:
    // A browser that is missing skips a test by name, and fails it where everything must run.
    void SetUp() override {
        if (std::system("command -v chromium > /dev/null 2>&1") == 0) return;
        const char* required = std::getenv("TOPPLE_REQUIRE_BACKENDS");
        if (required && std::string(required) == "1") FAIL() << "chromium is missing";
        GTEST_SKIP() << "chromium is missing: apt-get install chromium";
    }

    // Opens the page in a headless browser, runs `script` once the page is ready, to its end and
    // without an error, and returns the page as it then stands and what the browser logged. The
    // script may await. By is(found, expected, why) it says what must be so, and in `out` what else
    // it found. `flags`: more for the browser; `link`: what follows the page's address.
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
        // The data hold all of these.
        void says(const std::string& name, const std::vector<std::string>& parts) const {
            for (const std::string& part : parts)
                EXPECT_THAT(text(data(name)), HasSubstr(part)) << name;
        }
    };
    Opened open(const std::filesystem::path& page, const std::string& script = "",
                const std::string& flags = "", const std::string& link = "") {
        const Opened opened = shown(bytes_of_file(page) + R"(<script>{
            const out = document.body.dataset, faults = [], is = (found, expected, why = '') => {
                if (String(found) !== String(expected)) faults.push(`${found}, not ${expected} ${why}`);
            };
            toppleReady.then(async () => {)" +
                                        script + R"(}).then(() => {
                out.faults = faults.join('; ');
                out.done = '1';
            });
        }</script>)",
                                    flags, link);
        EXPECT_EQ(opened.data("ready"), "1") << opened.log.substr(0, 2000);
        EXPECT_EQ(opened.data("done"), "1") << "the script has no end";
        EXPECT_EQ(opened.data("error"), "(none)");
        EXPECT_EQ(opened.data("faults"), "");
        EXPECT_EQ(opened.data("missed"), "(none)") << "a click found nothing";
        return opened;
    }
    // The same in a window as small as a phone's, which the browser's own can't be: within a frame.
    // `script` says what it found in `out`.
    Opened open_on_phone(const std::filesystem::path& page, const std::string& script) {
        const std::string inner =
            bytes_of_file(page) +
            "<script>const out = parent.document.body.dataset; toppleReady.then(async () => {" +
            script + "});</script>";
        return shown(
            "<!DOCTYPE html><body><iframe width=390 height=844 style='border:0' srcdoc=\"" +
            report::html_escaped(inner) + "\"></iframe></body>");
    }
    // Of a scene's report.
    Opened open(const Scene& scene, const std::string& script, const std::string& flags = "",
                const std::string& link = "") {
        report::write_report(folder_ / "report.html", scene);
        return open(folder_ / "report.html", script, flags, link);
    }
    Opened shown(const std::string& html, const std::string& flags = "",
                 const std::string& link = "") {
        const auto file = folder_ / "shown.html";
        std::ofstream(file) << html;
        const std::string command =
            "timeout 240 chromium --headless --no-sandbox --use-angle=swiftshader "
            "--enable-unsafe-swiftshader --enable-logging=stderr --window-size=900,900 "
            "--user-data-dir='" +
            (folder_ / "browser").string() + "' " + flags +
            " --virtual-time-budget=10000 --dump-dom 'file://" + file.string() + link + "' > '" +
            (folder_ / "dom").string() + "' 2> '" + (folder_ / "log").string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0);
        Opened opened{bytes_of_file(folder_ / "dom"), bytes_of_file(folder_ / "log")};
        EXPECT_THAT(opened.log, Not(HasSubstr("Uncaught")));
        // Without WebGL three.js says that there is none.
        if (flags.empty()) {
            EXPECT_THAT(opened.log, Not(AnyOf(HasSubstr("THREE."), HasSubstr("ERR_"))));
        }
        return opened;
    }
};

}  // namespace topple::test
