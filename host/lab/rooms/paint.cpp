// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>

#include "lab/rooms/furnish.h"

namespace topple::scenes {
namespace {

using Rgb = std::array<double, 3>;

enum class Material { white, wood, metal, dark, cloth, leaf, earth, paper, carton, any };

Rgb shade_of(Material material, Random& random) {
    const auto grey = [&](double low, double high) {
        const double g = random(low, high);
        return Rgb{g, g * random(0.97, 1.02), g * random(0.94, 1.02)};
    };
    switch (material) {
        case Material::white:
            return grey(185, 245);
        case Material::wood: {
            const double light = random(0.35, 1);
            return {light * random(190, 225), light * random(140, 180), light * random(85, 135)};
        }
        case Material::metal:
            return grey(90, 200);
        case Material::dark:
            return grey(20, 75);
        case Material::leaf:
            return {random(30, 90), random(90, 160), random(25, 70)};
        case Material::earth:
            return {random(100, 190), random(70, 120), random(45, 90)};
        case Material::paper:
            return grey(210, 250);
        case Material::carton:
            return {random(150, 205), random(115, 160), random(70, 115)};
        case Material::cloth: {
            const double dull = random(60, 170);
            return {dull + random(-40, 60), dull + random(-40, 40), dull + random(-40, 60)};
        }
        case Material::any:
            break;
    }
    return {random(20, 240), random(20, 240), random(20, 240)};
}

struct Habit {
    std::string_view word;  // in an object's or a part's name
    std::array<Material, 3> of;
};
using enum Material;
constexpr std::array part_habits{
    Habit{"leaf", {leaf, leaf, leaf}},        Habit{"crown", {leaf, leaf, leaf}},
    Habit{"trunk", {earth, wood, earth}},     Habit{"soil", {earth, dark, earth}},
    Habit{"screen", {dark, dark, dark}},      Habit{"caster", {dark, dark, metal}},
    Habit{"handle", {metal, metal, dark}},    Habit{"knob", {metal, dark, white}},
    Habit{"mattress", {white, cloth, white}}, Habit{"shade", {white, cloth, any}},
    Habit{"hob", {dark, dark, metal}},        Habit{"tap", {metal, metal, metal}},
    Habit{"worktop", {wood, metal, dark}},    Habit{"column", {metal, dark, metal}},
};
constexpr std::array object_habits{
    Habit{"carton", {carton, carton, carton}}, Habit{"box", {carton, any, white}},
    Habit{"paper", {paper, paper, paper}},     Habit{"chair", {wood, dark, cloth}},
    Habit{"stool", {wood, metal, any}},        Habit{"table", {wood, white, wood}},
    Habit{"desk", {wood, white, metal}},       Habit{"sofa", {cloth, dark, cloth}},
    Habit{"cushion", {cloth, any, cloth}},     Habit{"pillow", {white, cloth, white}},
    Habit{"bed", {wood, white, dark}},         Habit{"towel", {cloth, white, any}},
    Habit{"curtain", {cloth, white, any}},     Habit{"monitor", {dark, dark, metal}},
    Habit{"keyboard", {dark, white, metal}},   Habit{"cabinet", {white, wood, any}},
    Habit{"counter", {white, wood, any}},      Habit{"fridge", {white, metal, dark}},
    Habit{"dishwasher", {white, metal, dark}}, Habit{"radiator", {white, white, metal}},
    Habit{"toilet", {white, white, white}},    Habit{"basin", {white, white, white}},
    Habit{"tub", {white, white, white}},       Habit{"plate", {white, white, any}},
    Habit{"mug", {white, any, any}},           Habit{"lamp", {metal, white, dark}},
    Habit{"shelf", {wood, white, dark}},       Habit{"bookcase", {wood, white, wood}},
    Habit{"rack", {metal, any, dark}},         Habit{"pallet", {wood, wood, wood}},
    Habit{"ladder", {metal, wood, metal}},     Habit{"wardrobe", {white, wood, wood}},
    Habit{"plant", {earth, white, dark}},      Habit{"pan", {metal, dark, dark}},
};

template <class Habits>
const Habit* habit(const Habits& habits, const std::string& name) {
    const auto found = std::find_if(habits.begin(), habits.end(), [&](const Habit& h) {
        return name.find(h.word) != std::string::npos;
    });
    return found == habits.end() ? nullptr : &*found;
}

Material pick(const Habit* h, Random& random) {
    if (h == nullptr || random.chance(0.1)) return any;
    return h->of[random.integer(0, 2)];
}

std::array<std::uint8_t, 3> bytes(const Rgb& rgb) {
    std::array<std::uint8_t, 3> out{};
    for (std::size_t a = 0; a < 3; ++a)
        out[a] = static_cast<std::uint8_t>(std::clamp(rgb[a], 0.0, 255.0));
    return out;
}

}  // namespace

void paint(World& world, Random random) {
    const Rgb wall = random.chance(0.7) ? shade_of(white, random) : shade_of(cloth, random);
    const Rgb floor = shade_of(random.chance(0.6) ? wood : metal, random);
    std::map<std::string, Rgb> house;  // the style that things of a name share
    std::vector<Rgb> main(world.objects.size());
    std::vector<bool> uniform(world.objects.size());
    for (std::size_t n = 1; n < main.size(); ++n) {
        const std::string& name = world.objects[n].name;
        const Rgb own = shade_of(pick(habit(object_habits, name), random), random);
        const auto shared = house.emplace(name, own).first;
        main[n] = random.chance(0.55) ? shared->second : own;
        uniform[n] = random.chance(0.55);
    }
    std::map<std::pair<std::int32_t, std::string>, Rgb> of_part;
    for (Part& part : world.parts) {
        if (part.object == 0) {
            part.colour = bytes(part.name == "floor"     ? floor
                                : part.name == "ceiling" ? Rgb{235, 235, 232}
                                : part.name == "wall"    ? wall
                                                         : shade_of(white, random));
            continue;
        }
        const auto n = static_cast<std::size_t>(part.object);
        const auto key = std::pair{part.object, part.name};
        if (!of_part.contains(key)) {
            const Habit* h = habit(part_habits, part.name);
            of_part[key] =
                h != nullptr && random.chance(0.85) ? shade_of(pick(h, random), random)
                : uniform[n] || random.chance(0.4)
                    ? main[n]
                    : shade_of(pick(habit(object_habits, world.objects[n].name), random), random);
        }
        Rgb rgb = of_part[key];
        const double differs = random(0.96, 1.04);
        for (double& c : rgb) c *= differs;
        part.colour = bytes(rgb);
    }
}

}  // namespace topple::scenes
