// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <initializer_list>
#include <vector>

#include "lab/furniture/blueprint.h"

// Things as they are made: hollow, of parts that meet with gaps, edges and overlaps; the frame is
// that of Blueprint. `pile` marks goods in rows.
namespace topple::scenes {

// Makes what stands on a surface with this free height.
struct ItemMake : std::function<Stack(Random&, double)> {
    ItemMake(Stack (*make)(Random&, double)) : function(make) {}
    ItemMake(Stack (*make)(Random&)) : function([make](Random& r, double) { return make(r); }) {}
    ItemMake(Blueprint (*make)(Random&))
        : function([make](Random& r, double) { return Stack{make(r)}; }) {}
};

// The first of a dozen, each by one of `makes`, that is lower than `clearance`; empty where none
// is.
inline Stack any_that_fits(Random& random, double clearance,
                           std::initializer_list<ItemMake> makes) {
    for (int attempt = 0; attempt < 12; ++attempt) {
        const Stack stack = makes.begin()[random.index(makes.size())](random, clearance);
        if (!stack.empty() && stack_height(stack) < clearance) return stack;
    }
    return {};
}

// A cabinet of the blueprint `b` with its back at y: doors or drawers with gaps, handles; or open,
// with a back, shelves, and perhaps a door ajar. Returns its top.
struct CabinetPlace {
    double x, back, bottom;
    Vec3 size;
};
int add_cabinet(Blueprint& b, const CabinetPlace& place, Random& random, double open);

// Kitchen.
Blueprint make_counter(Random& random, double length);  // with sink, hob, tap; to be built in
Blueprint make_wall_cupboards(Random& random, double length);
Blueprint make_hood(Random& random);
Blueprint make_fridge(Random& random);
Blueprint make_appliance(Random& random);  // dishwasher, washing machine, oven
Blueprint make_free_cupboard(Random& random);
Stack make_kitchen_item(Random& random, double clearance);

// Bathroom and laundry.
Blueprint make_basin(Random& random);
Blueprint make_toilet(Random& random);
Blueprint make_bath(Random& random);  // a tub or a shower
Blueprint make_towel_rail(Random& random);
Blueprint make_washer(Random& random, const Vec3& size);
Blueprint make_ironing_board(Random& random);
Blueprint make_drying_rack(Random& random);
Stack make_bath_item(Random& random, double clearance);

// Rooms to live and work in.
Blueprint make_rail_chair(Random& random);    // legs, rails, a back of slats, perhaps arms
Blueprint make_office_chair(Random& random);  // a star of five on casters
Blueprint make_work_table(Random& random);    // on legs or cheeks, with a rail, perhaps a pedestal
Blueprint make_drawer_unit(Random& random);
Blueprint make_bookcase(Random& random, double most_height);
Blueprint make_couch(Random& random);
Blueprint make_tv_board(Random& random);
Blueprint make_television(Random& random);
Blueprint make_bush(Random& random, double scale);  // a pot with many leaves
Blueprint make_basket(Random& random);
Blueprint make_built_in_wardrobe(Random& random, double length);
Blueprint make_double_bed(Random& random);
Blueprint make_lamp_on_pole(Random& random);
Stack make_desk_item(Random& random, double clearance);
Stack make_home_item(Random& random, double clearance);
Stack make_soft_item(Random& random, double clearance);  // cushions, clothes, towels
// Books or boxes upright and flush along x, as one thing.
Blueprint make_row(Random& random, double length, double height, double depth);
// For shelves: rows, boxes, and things in between.
Stack make_shelf_item(Random& random, double clearance);

// Stores.
Blueprint make_carton(Random& random, double most);
Blueprint make_rack(Random& random, double most_height);
Blueprint make_pallet(Random& random);
Blueprint make_trolley(Random& random);
Blueprint make_pallet_jack(Random& random);
Blueprint make_bucket(Random& random);
Blueprint make_drum(Random& random);
Blueprint make_step_ladder(Random& random);
Blueprint make_gondola(Random& random);  // a bookcase open to both sides
Stack make_store_item(Random& random, double clearance);
Stack make_shop_item(Random& random, double clearance);

// Libraries: bookcases of one make, metres. Their books are their own parts where `one`, for
// nobody tells them apart from their case; otherwise shelve_books() of library.cpp adds them.
struct BookcaseMake {
    double width, depth, height;  // of one side
    int shelves;
    bool two_sided, back, one;
    double full;  // share of the shelves' length that books take
    bool flush;   // with the boards' front edges
};
BookcaseMake any_bookcase_make(Random& random, double most_height);
Blueprint make_case_of_books(Random& random, const BookcaseMake& make);
// Books on a shelf along x, their backs to +y in one plane where `flush`: many heights, some lie.
Blueprint make_books(Random& random, double length, double height, double depth, bool flush);
Blueprint make_service_desk(Random& random);

// Where many meet.
Blueprint make_stacking_chair(Random& random);  // a seat and a back on bent tubes
Blueprint make_lectern(Random& random);
Blueprint make_wall_board(Random& random, double length);  // to be fixed: with rim and tray
Blueprint make_projection_screen(Random& random, double length);
Blueprint make_board_on_wheels(Random& random);

// What is soft.
Blueprint make_corner_sofa(Random& random);
Blueprint make_ottoman(Random& random);
Blueprint make_wall_curtain(Random& random, double length, double height);  // to be fixed
Blueprint make_soft_bed(Random& random);                   // an uneven duvet, pillows
Stack make_floor_thing(Random& random, double clearance);  // bags, boxes, bins, heaps

// Single things among those of make_varied_item() and make_item(); empty where chance offers none.
Stack make_turned_item(Random& random, double clearance);

}  // namespace topple::scenes
