#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"
#include "validation/cases/sky_scenes.h"

namespace lightwell {
namespace {

using std::numbers::pi;

// Standard error that rays to the dome are asked to reach, as a share of the light; five of them
// are the tolerance.
constexpr double standard_error_of_sky = 1e-3;

// A rectangle of an opening seen from a point: two sides that meet at the foot of the point's
// perpendicular, and the distance.
struct SeenCorner {
  double a = 1.0, b = 1.0, distance = 1.0;
};

// int sin dw and int sin^2 dw over an opening, with the elevation's sine: the light of an even sky
// and the additional light of a sky that is brighter towards the zenith, on a level element.
struct SkyIntegrals {
  double even = 0.0, rising = 0.0;
};

// A vertical opening `distance` away, from one side of the perpendicular to `a` and from the
// horizon up to `b`. With L = D^2 + H^2 and u = W / sqrt(W^2 + L): the first is the form factor to
// a perpendicular rectangle times pi, the second (arctan(H u / D) - D H u / L) / 3.
SkyIntegrals vertical_opening(const SeenCorner& s) {
  const double W = s.a, H = s.b, D = s.distance, slant = std::sqrt(D * D + H * H);
  const double u = W / std::sqrt(W * W + slant * slant);
  return {0.5 * (std::atan(W / D) - D / slant * std::atan(W / slant)),
          (std::atan(H * u / D) - D * H * u / (slant * slant)) / 3.0};
}

// A level opening `distance` above. With R^2 = a^2 + b^2 + h^2 the second integral is
// (arctan(a b / (h R)) + h a b / R (1 / (a^2 + h^2) + 1 / (b^2 + h^2))) / 3.
SkyIntegrals level_opening(const SeenCorner& s) {
  const double a = s.a, b = s.b, h = s.distance;
  const double ra = std::hypot(a, h), rb = std::hypot(b, h), R = std::hypot(ra, b);
  return {0.5 * (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)),
          (std::atan(a * b / (h * R)) + h * a * b / R * (1.0 / (ra * ra) + 1.0 / (rb * rb))) / 3.0};
}

struct OpeningCase {
  const char* id;
  const char* title;
  bool is_vertical, is_overcast;
};

constexpr std::array<OpeningCase, 4> opening_cases = {
    {{"window-uniform-sky", "sky component of a window under an even sky", true, false},
     {"window-overcast-sky", "sky component of a window under the overcast sky", true, true},
     {"rooflight-uniform-sky", "sky component of a rooflight under an even sky", false, false},
     {"rooflight-overcast-sky", "sky component of a rooflight under the overcast sky", false,
      true}}};

// The wall with the opening stands for a room whose other surfaces are black: nothing else of the
// sky is seen from before it.
Scene scene_of_opening(const OpeningCase& opening, const SeenCorner& s) {
  Scene scene;
  constexpr double far = 10.0;
  const int black = add_paint(scene, {});
  scene.materials.back().one_sided = true;
  if (opening.is_vertical) {
    add_holed_polygon(scene, "wall", black,
                      {{s.distance, -far, -far},
                       {s.distance, far, -far},
                       {s.distance, far, far},
                       {s.distance, -far, far}},
                      {{s.distance, -s.a, 0},
                       {s.distance, s.a, 0},
                       {s.distance, s.a, s.b},
                       {s.distance, -s.a, s.b}});
    // The room behind the point: a box without the wall.
    const CaseBox room{.low = {-1, -far, -1}, .high = {s.distance, far, far}};
    for (const int face : {0, 2, 3, 4, 5})
      add_case_polygon(scene, "room", black, box_face(room, face));
  } else {
    const double z = s.distance;
    add_holed_polygon(scene, "roof", black,
                      {{-far, -far, z}, {far, -far, z}, {far, far, z}, {-far, far, z}},
                      {{-s.a, -s.b, z}, {s.a, -s.b, z}, {s.a, s.b, z}, {-s.a, s.b, z}});
    const CaseBox room{.low = {-far, -far, -1}, .high = {far, far, z}};
    for (const int face : {0, 1, 2, 3, 4})
      add_case_polygon(scene, "room", black, box_face(room, face));
  }
  scene.sky = numbered_sky(opening.is_overcast ? 16 : 5, Eigen::Vector3d::UnitZ());
  return scene;
}

ComparedValues light_of_opening(const OpeningCase& opening, const Progress& progress) {
  ComparedValues values;
  for (const double distance : {1.0, 2.0, 4.0}) {
    report(progress, "sky", 0.0);
    const SeenCorner s{.a = 1.2, .b = 1.5, .distance = distance};
    const SkyIntegrals half = opening.is_vertical ? vertical_opening(s) : level_opening(s);
    // A rooflight has four quarters about the perpendicular, a window two halves.
    const double parts = opening.is_vertical ? 2.0 : 4.0;
    const double E = opening.is_overcast ? (half.even + 2.0 * half.rising) / 3.0 : half.even;
    const double unobstructed = opening.is_overcast ? 7.0 * pi / 9.0 : pi;
    const double expected = 100.0 * parts * E / unobstructed;
    const LitCase lit(scene_of_opening(opening, s));
    const double found =
        100.0 / unobstructed *
        lit.direct(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), standard_error_of_sky);
    values.push_back({fmt::format("{:g} m away", distance), expected, found,
                      5.0 * standard_error_of_sky * expected});
  }
  return values;
}

// E_h of each sky with the sun 60 degrees high, for a relative luminance phi f of 1.
ComparedValues horizontal_light(const ReferenceValue& c) {
  ComparedValues values;
  const Eigen::Vector3d sun = reference_point(c.at("geometry").at("sun_direction"));
  for (const auto& [number, E] : c.at("Ehz_relative").items()) {
    const Sky sky = numbered_sky(std::stoi(number), sun);
    const double expected = E;
    values.push_back({number == "16" ? "overcast" : "type " + number, expected,
                      static_cast<double>(diffuse_horizontal_irradiance(sky)[0]), 3e-5 * expected});
  }
  return values;
}

ComparedValues zenith_ratio() {
  // The standard's tabulated gradations at chi = pi / 2 and Z = 0 are phi(0) = 1 + a exp(b).
  ComparedValues values;
  const Sky overcast = numbered_sky(16, Eigen::Vector3d::UnitZ());
  const auto radiance = [&overcast](double elevation) {
    return static_cast<double>(
        sky_radiance(overcast, {std::cos(elevation), 0.0, std::sin(elevation)})[0]);
  };
  for (const double degrees : {10.0, 30.0, 60.0}) {
    const double elevation = degrees * pi / 180.0;
    values.push_back({fmt::format("{:g} degrees", degrees), (1.0 + 2.0 * std::sin(elevation)) / 3.0,
                      radiance(elevation) / radiance(pi / 2.0), 1e-6});
  }
  return values;
}

}  // namespace

std::vector<ValidationCase> sky_cases() {
  const ReferenceValue c = reference_cases(validation_data::cie171_json);
  const ReferenceValue first_sky = [&c] {
    for (const ReferenceValue& one : c) {
      if (one.contains("Ehz_relative")) return one;
    }
    return ReferenceValue{};
  }();
  std::vector<ValidationCase> cases;
  cases.push_back(
      {.id = "sky-horizontal",
       .group = "sky components",
       .title = "horizontal irradiance of the 15 skies of ISO 15469 and the overcast "
                "sky of Moon & Spencer",
       .source = "quadrature with 13 digits; 7 pi / 9 for the overcast sky",
       .reason = "3e-5 of the value: the program states 1e-5, and values are floats",
       .has_plot = true,
       .compute = [first_sky](const Progress&) { return horizontal_light(first_sky); }});
  cases.push_back({.id = "sky-overcast-gradation",
                   .group = "sky components",
                   .title = "luminance of the overcast sky over that of the zenith",
                   .source = "(1 + 2 sin e) / 3, Moon & Spencer 1942",
                   .reason = "1e-6: floats",
                   .has_plot = true,
                   .compute = [](const Progress&) { return zenith_ratio(); }});
  for (const OpeningCase& opening : opening_cases) {
    cases.push_back({.id = opening.id,
                     .group = "sky components",
                     .title = opening.title,
                     .unit = "%",
                     .source = opening.is_vertical
                                   ? "closed form of int L sin dw over a vertical rectangle (the "
                                     "overcast sky: after Seshadri 1960)"
                                   : "closed form of int L sin dw over a level rectangle",
                     .reason = "0.5 % of the value: five of the standard errors of 0.1 % that the "
                               "rays of a point are asked to reach",
                     .has_plot = true,
                     .compute = [opening](const Progress& progress) {
                       return light_of_opening(opening, progress);
                     }});
  }
  return cases;
}

}  // namespace lightwell
