#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "scene/io/pov/pov_language.h"

namespace lightwell {
namespace {

struct NamedColor {
  std::string_view name;
  double red, green, blue;
};

constexpr NamedColor color_table[] = {
    {"Red", 1, 0, 0},
    {"Green", 0, 1, 0},
    {"Blue", 0, 0, 1},
    {"Yellow", 1, 1, 0},
    {"Cyan", 0, 1, 1},
    {"Magenta", 1, 0, 1},
    {"White", 1, 1, 1},
    {"Black", 0, 0, 0},
    {"DimGray", 0.329412, 0.329412, 0.329412},
    {"DimGrey", 0.329412, 0.329412, 0.329412},
    {"Gray", 0.752941, 0.752941, 0.752941},
    {"Grey", 0.752941, 0.752941, 0.752941},
    {"LightGray", 0.658824, 0.658824, 0.658824},
    {"LightGrey", 0.658824, 0.658824, 0.658824},
    {"VLightGray", 0.80, 0.80, 0.80},
    {"VLightGrey", 0.80, 0.80, 0.80},
    {"Aquamarine", 0.439216, 0.858824, 0.576471},
    {"BlueViolet", 0.62352, 0.372549, 0.623529},
    {"Brown", 0.647059, 0.164706, 0.164706},
    {"CadetBlue", 0.372549, 0.623529, 0.623529},
    {"Coral", 1.0, 0.498039, 0.0},
    {"CornflowerBlue", 0.258824, 0.258824, 0.435294},
    {"DarkGreen", 0.184314, 0.309804, 0.184314},
    {"DarkOliveGreen", 0.309804, 0.309804, 0.184314},
    {"DarkOrchid", 0.6, 0.196078, 0.8},
    {"DarkSlateBlue", 0.419608, 0.137255, 0.556863},
    {"DarkSlateGray", 0.184314, 0.309804, 0.309804},
    {"DarkTurquoise", 0.439216, 0.576471, 0.858824},
    {"Firebrick", 0.556863, 0.137255, 0.137255},
    {"ForestGreen", 0.137255, 0.556863, 0.137255},
    {"Gold", 0.8, 0.498039, 0.196078},
    {"Goldenrod", 0.858824, 0.858824, 0.439216},
    {"GreenYellow", 0.576471, 0.858824, 0.439216},
    {"IndianRed", 0.309804, 0.184314, 0.184314},
    {"Khaki", 0.623529, 0.623529, 0.372549},
    {"LightBlue", 0.74902, 0.847059, 0.847059},
    {"LightSteelBlue", 0.560784, 0.560784, 0.737255},
    {"LimeGreen", 0.196078, 0.8, 0.196078},
    {"Maroon", 0.556863, 0.137255, 0.419608},
    {"MediumAquamarine", 0.196078, 0.8, 0.6},
    {"MediumBlue", 0.196078, 0.196078, 0.8},
    {"MediumForestGreen", 0.419608, 0.556863, 0.137255},
    {"MediumGoldenrod", 0.917647, 0.917647, 0.678431},
    {"MediumOrchid", 0.576471, 0.439216, 0.858824},
    {"MediumSeaGreen", 0.258824, 0.435294, 0.258824},
    {"MediumSlateBlue", 0.498039, 0.0, 1.0},
    {"MediumSpringGreen", 0.498039, 1.0, 0.0},
    {"MediumTurquoise", 0.439216, 0.858824, 0.858824},
    {"MediumVioletRed", 0.858824, 0.439216, 0.576471},
    {"MidnightBlue", 0.184314, 0.184314, 0.309804},
    {"Navy", 0.137255, 0.137255, 0.556863},
    {"NavyBlue", 0.137255, 0.137255, 0.556863},
    {"Orange", 1.0, 0.5, 0.0},
    {"OrangeRed", 1.0, 0.25, 0.0},
    {"Orchid", 0.858824, 0.439216, 0.858824},
    {"PaleGreen", 0.560784, 0.737255, 0.560784},
    {"Pink", 0.737255, 0.560784, 0.560784},
    {"Plum", 0.917647, 0.678431, 0.917647},
    {"Salmon", 0.435294, 0.258824, 0.258824},
    {"SeaGreen", 0.137255, 0.556863, 0.419608},
    {"Sienna", 0.556863, 0.419608, 0.137255},
    {"SkyBlue", 0.196078, 0.6, 0.8},
    {"SlateBlue", 0.0, 0.498039, 1.0},
    {"SpringGreen", 0.0, 1.0, 0.498039},
    {"SteelBlue", 0.137255, 0.419608, 0.556863},
    {"Tan", 0.858824, 0.576471, 0.439216},
    {"Thistle", 0.847059, 0.74902, 0.847059},
    {"Turquoise", 0.678431, 0.917647, 0.917647},
    {"Violet", 0.309804, 0.184314, 0.309804},
    {"VioletRed", 0.8, 0.196078, 0.6},
    {"Wheat", 0.847059, 0.847059, 0.74902},
    {"YellowGreen", 0.6, 0.8, 0.196078},
    {"SummerSky", 0.22, 0.69, 0.87},
    {"RichBlue", 0.35, 0.35, 0.67},
    {"Brass", 0.71, 0.65, 0.26},
    {"Copper", 0.72, 0.45, 0.20},
    {"Bronze", 0.55, 0.47, 0.14},
    {"Bronze2", 0.65, 0.49, 0.24},
    {"Silver", 0.90, 0.91, 0.98},
    {"BrightGold", 0.85, 0.85, 0.10},
    {"OldGold", 0.81, 0.71, 0.23},
    {"Feldspar", 0.82, 0.57, 0.46},
    {"Quartz", 0.85, 0.85, 0.95},
    {"NeonPink", 1.00, 0.43, 0.78},
    {"DarkPurple", 0.53, 0.12, 0.47},
    {"NeonBlue", 0.30, 0.30, 1.00},
    {"CoolCopper", 0.85, 0.53, 0.10},
    {"MandarinOrange", 0.89, 0.47, 0.20},
    {"LightWood", 0.91, 0.76, 0.65},
    {"MediumWood", 0.65, 0.50, 0.39},
    {"DarkWood", 0.52, 0.37, 0.26},
    {"SpicyPink", 1.00, 0.11, 0.68},
    {"SemiSweetChoc", 0.42, 0.26, 0.15},
    {"BakersChoc", 0.36, 0.20, 0.09},
    {"Flesh", 0.96, 0.80, 0.69},
    {"NewTan", 0.92, 0.78, 0.62},
    {"NewMidnightBlue", 0.00, 0.00, 0.61},
    {"VeryDarkBrown", 0.35, 0.16, 0.14},
    {"DarkBrown", 0.36, 0.25, 0.20},
    {"DarkTan", 0.59, 0.41, 0.31},
    {"GreenCopper", 0.32, 0.49, 0.46},
    {"DkGreenCopper", 0.29, 0.46, 0.43},
    {"DustyRose", 0.52, 0.39, 0.39},
    {"HuntersGreen", 0.13, 0.37, 0.31},
    {"Scarlet", 0.55, 0.09, 0.09},
    {"Med_Purple", 0.73, 0.16, 0.96},
    {"Light_Purple", 0.87, 0.58, 0.98},
    {"Very_Light_Purple", 0.94, 0.81, 0.99},
};

// Indices of refraction, and the six sides in POV-Ray's axes.
constexpr std::string_view constants_text = R"(
#declare Air_Ior = 1.000292; #declare Water_Ior = 1.33; #declare Crown_Glass_Ior = 1.51;
#declare Flint_Glass_Ior = 1.71; #declare Quartz_Glass_Ior = 1.46; #declare Diamond_Ior = 2.47;
#declare xy = <1, 1, 0>; #declare yz = <0, 1, 1>; #declare xz = <1, 0, 1>;
)";

constexpr std::string_view finishes_text = R"(
#declare Dull = finish { specular 0.5 roughness 0.15 }
#declare Shiny = finish { specular 1 roughness 0.001 }
#declare Phong_Dull = finish { phong 0.5 phong_size 1 }
#declare Phong_Shiny = finish { phong 1 phong_size 200 }
#declare Glossy = finish { specular 1 roughness 0.001 reflection 0.13 }
#declare Luminous = finish { ambient 1 diffuse 0 }
#declare Mirror = finish { ambient 0 diffuse 0 reflection 1 }
)";

std::string colors_text() {
  std::string text;
  for (const NamedColor& color : color_table) {
    text += fmt::format("#declare {} = rgb <{}, {}, {}>;\n", color.name, color.red, color.green,
                        color.blue);
  }
  for (int percent = 5; percent < 100; percent += 5) {
    for (const char* spelling : {"Gray", "Grey"}) {
      text += fmt::format("#declare {}{:02} = rgb {};\n", spelling, percent, 0.01 * percent);
    }
  }
  return text + "#declare Clear = rgbf 1;\n";
}

}  // namespace

std::string pov_standard_names(std::string_view file) {
  const auto is = [&](std::initializer_list<std::string_view> names) {
    return std::ranges::find(names, file) != names.end();
  };
  if (file == "colors.inc") return colors_text();
  if (file == "consts.inc") return std::string(constants_text);
  if (file == "finish.inc") return std::string(finishes_text);
  if (is({"textures.inc", "glass.inc", "metals.inc", "golds.inc"})) {
    return colors_text() + std::string(constants_text) + std::string(finishes_text);
  }
  if (is({"math.inc", "shapes.inc", "transforms.inc", "functions.inc", "strings.inc",
          "rand.inc"})) {
    return std::string(constants_text);
  }
  return {};
}

}  // namespace lightwell
