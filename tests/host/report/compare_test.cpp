// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "in_browser.h"
#include "result/scene_json.h"
#include "synthetic_scene.h"

// What the report's page says of another parse of the room.
namespace topple::report {
namespace {

using Json = nlohmann::json;

class Compare : public test::InBrowser {
  protected:
    // A file as the text of a script.
    std::string literal(const char* file) const {
        std::string text = Json(test::bytes_of_file(folder_ / file)).dump();
        for (auto at = text.find("</"); at != std::string::npos; at = text.find("</"))
            text.replace(at, 2, "<\\/");
        return text;
    }
    static Scene room(double voxel_m, const Vec3& size_m) {
        Scene scene = test::SyntheticScene(voxel_m).make();
        for (Object& object : scene.objects) object.size_m = size_m;
        scene.voxel_size_m = 0.02;
        return scene;
    }
    // What became of each object, once `change` has made another parse of it.
    Opened compared(const Scene& scene, const std::string& change) {
        write_report(folder_ / "report.html", scene);
        io::write_scene_json(folder_ / "scene.json", scene);
        return open(folder_ / "report.html",
                    "const other = JSON.parse(" + literal("scene.json") + ");" + change + R"(
            document.getElementById('compare-order').value = 'after';
            await toppleCompare.read('other.json', JSON.stringify(other));
            out.rows = [...document.querySelectorAll('#compare-result tbody tr')]
                .map(row => `${row.cells[0].textContent}: ${row.cells[6].textContent}`).join('; ');
            out.banner = document.querySelector('#compare-result p').textContent;
        )");
    }
};

TEST_F(Compare, tells_what_became_safer) {
    Scene scene = room(0.2, {0.4, 0.3, 0.5});
    // Boxes lie about the centres of mass, as in what earlier versions wrote.
    for (Object& object : scene.objects) object.box_middle_m = Object{}.box_middle_m;
    for (std::size_t id = 1; id < 6; ++id)
        scene.objects[id].center_of_mass_m = {double(id), 1, 0.5};
    write_report(folder_ / "report.html", scene);
    // Before: the monitor was less safe, the shelf safer, the ball elsewhere, the cup larger, and
    // numbers others.
    Scene before = scene;
    before.source = "earlier.ply";
    before.objects[3].risk_J["human"] *= 9;
    before.objects[4].risk_J["earthquake"] /= 9;
    before.objects[5].center_of_mass_m[1] = 4;
    before.objects[2].size_m[0] = 1.2;
    before.objects[2].risk_J["human"] *= 9;
    std::swap(before.objects[1], before.objects[4]);
    for (std::size_t id = 0; id < 6; ++id) before.objects[id].id = std::int32_t(id);
    io::write_scene_json(folder_ / "before.json", before);
    write_report(folder_ / "before.html", before);
    const auto page = open(folder_ / "report.html", "const json = " + literal("before.json") +
                                                        ", html = " + literal("before.html") + R"(;
        const text = selector => document.querySelector(`#compare-result ${selector}`).textContent;
        const rows = () => [...document.querySelectorAll('#compare-result tbody tr')]
            .map(row => `${row.cells[0].textContent}: ${row.cells[6].textContent}`).join(', ');
        await toppleCompare.read('before.json', json);
        out.rows = rows();
        is(text('.counts'), '1 safer, 1 less safe, 1 as before within the errors, 1 moved, 0 new, 0 gone, 1 told apart differently.');
        is([...document.querySelector('#compare-result tbody').rows[0].cells].slice(2, 4).map(cell => cell.textContent).join(' to '), 'low to low');
        await toppleCompare.read('before.html', html);
        is(rows() === out.rows, true);
        // Object 4 was object 1 there, whose colour it has now; no two have the same.
        is(String(objectColour(toppleScene, 4)) === String(toppleScene.colours[1]), true, 'the same thing has the same colour in both');
        const colours = toppleScene.objects.filter(object => !object.grounded).map(object => String(objectColour(toppleScene, object.id)));
        is(new Set(colours).size === colours.length, true);
        document.getElementById('compare-order').value = 'after';
        toppleCompare.show();
        is(text('tbody tr th'), 'object 3', 'which is less safe now');
        const told = JSON.parse(json);
        told.corrections = [{do: 'fixed', held: true, at_m: [[5, 1, 0.5]]}];
        await toppleCompare.read('told.json', JSON.stringify(told));
        is(rows().includes('object 5: fixed now'), true);
        await toppleCompare.read('x.html', '<html></html>');
        is(text('.warning'), 'x.html is a web page, but no report of topple.');
    )");
    EXPECT_EQ(page.data("rows"),
              "object 4: less safe, object 5: moved: by 3.0 m, object 3: safer, "
              "object 2: told apart differently: other size, object 1: as before");
}

TEST_F(Compare, measures_moves_by_boxes) {
    const Scene scene = room(0.1, {0.4, 0.3, 0.5});
    // The centre of mass of 1 rose, 2 was carried and is half as heavy, 3 was pushed, of 4 more was
    // seen to one side, and 5, elsewhere, is another thing: half as high.
    const auto page = compared(scene, R"(
        other.source = 'later.ply';
        const [, table, cup, monitor, shelf, ball] = other.objects;
        table.center_of_mass_m[2] += 0.07;
        cup.box_middle_m[0] += 9;
        cup.mass_kg /= 2;
        cup.mass_error_kg = 2 * cup.mass_kg;
        monitor.box_middle_m[1] += 0.1;
        shelf.size_m[2] += 0.03;
        shelf.box_middle_m[2] += 0.015;
        ball.box_middle_m[1] -= 9;
        other.primitives.find(part => part.object === ball.id).center_of_mass_m[1] -= 9;
        ball.size_m[2] /= 2;
    )");
    EXPECT_EQ(
        page.data("rows"),
        "object 5 after: new; object 3: moved: by 10 cm; object 2: perhaps moved: looks like "
        "object 2 after, 9.0 m away; object 5: gone; object 1: as before; object 4: as before");
    EXPECT_TRUE(page.data("banner").starts_with("The two scans may have been told apart"))
        << page.data("banner");
}

// What is gone may be part of what has its solid now: in its place, or beside where that was.
TEST_F(Compare, tells_of_what_the_missing_may_be_part) {
    const Scene scene = room(0.1, {0.3, 0.3, 0.5});
    const auto page = compared(scene, R"(
        other.source = 'later.ply';
        const [, table, cup, monitor, shelf, ball] = other.objects, part = object => other.primitives.find(each => each.id === object.primitives[0]);
        part(cup).object = 1;
        // The ball was rolled to the shelf.
        part(ball).object = 4;
        part(ball).center_of_mass_m = shelf.box_middle_m.map((value, k) => value + (k < 2 ? 0.25 : 0));
        shelf.mass_kg += ball.mass_kg;
        for (const k of [0, 1]) { shelf.size_m[k] += 0.2; shelf.box_middle_m[k] += 0.1; }
        // Nothing is where the monitor was.
        other.primitives = other.primitives.filter(each => each.object !== 3);
        other.objects = [other.objects[0], table, shelf];
    )");
    for (const char* row : {"object 2: gone or now part of object 1 after",
                            "object 5: gone or now part of object 4 after", "object 3: gone;"})
        EXPECT_THAT(page.data("rows") + ";", HasSubstr(row));
}

TEST_F(Compare, tells_errors_that_are_too_large_from_no_change) {
    const Scene scene = room(0.2, {0.4, 0.3, 0.5});
    const auto page = compared(scene, R"(
        other.source = 'later.ply';
        const [, , , monitor, shelf] = other.objects;
        monitor.risk_J.human *= 1.1;
        monitor.risk_error_J.human = 9;
        shelf.unsafety_category = 'medium';
    )");
    for (const char* row : {"object 3: unsure", "object 4: unsure", "object 1: as before"})
        EXPECT_THAT(page.data("rows"), HasSubstr(row));
}

TEST_F(Compare, follows_the_parts_of_a_scan_that_was_corrected) {
    const Scene scene = test::SyntheticScene(0.1).make();
    // The cup is one with the table; the shelf is fixed, and with it the monitor; the ball is not
    // there, and the parts after it have other numbers. Of the table a leg is apart.
    const auto page = compared(scene, R"(
        const {objects, primitives} = other, spot = id => objects[id].box_middle_m, [building, table, cup, monitor, shelf, ball] = objects;
        other.corrections = [
            {do: 'one_thing', held: true, at_m: [spot(1), spot(2)]}, {do: 'fixed', held: true, at_m: [spot(4)]},
            {do: 'one_thing', held: true, at_m: [spot(4), spot(3)]}, {do: 'not_there', held: true, at_m: [spot(5)]},
            {do: 'apart', held: true, at_m: [spot(1)], from_m: [spot(1)]}];
        for (const object of objects) object.size_m = [0.2, 0.2, 0.2];
        for (const object of toppleScene.objects) object.size_m = [0.2, 0.2, 0.2];
        const leg = table.primitives.pop();
        table.primitives.push(...cup.primitives);
        Object.assign(table, {name: 'Desk', corrected: [1]});
        building.primitives.push(...monitor.primitives, ...shelf.primitives);
        primitives.splice(primitives.findIndex(part => part.id === ball.primitives[0]), 1);
        Object.assign(cup, {primitives: [leg], corrected: [5]});
        other.objects = [building, table, cup];
    )");
    EXPECT_EQ(page.data("banner"), "The same scan: what changed follows from the corrections.");
    for (const char* row :
         {"object 2: joined to Desk after (correction 1)", "object 4: fixed now, which holds only",
          "object 3: fixed now, with object 4", "object 5: not there (correction 4)",
          "object 2 after: parted from object 1 (correction 5)",
          "object 1: as before: with object 2 (correction 1), without what is now object 2 after"})
        EXPECT_THAT(page.data("rows"), HasSubstr(row));
}

}  // namespace
}  // namespace topple::report
