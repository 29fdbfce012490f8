#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/parallel.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"
#include "validation/cases/sky_scenes.h"

namespace lightwell {
namespace {

using std::numbers::pi;
constexpr double percent_of_whole = 100.0;
constexpr int most_skies = 16;

// Standard error that rays to the dome are asked to reach, as a share of the light, and five of
// them, which a right program exceeds once in two million values.
constexpr double standard_error = 1.6e-3;
constexpr double daylight_error = 5.0 * standard_error;

Opening opening_of(const ReferenceValue& geometry) {
  const ReferenceValue& o = geometry.at("opening");
  return {.origin = reference_point(o.at("origin")),
          .u = reference_point(o.at("u")),
          .v = reference_point(o.at("v"))};
}

// The black room, whose face with the opening has a hole, or is missing if all of it is open.
void add_open_room(const ReferenceValue& geometry, const Opening& opening, Scene& scene) {
  const int black = add_paint(scene, {});
  scene.materials.back().one_sided = true;
  const CaseBox room{.high = reference_point(geometry.at("room"))};
  const int open_face = std::abs(opening.normal().z()) > 0.5 ? 5 : 2;
  for (int face = 0; face < 6; ++face) {
    const std::vector<Eigen::Vector3d> corners = box_face(room, face);
    if (face != open_face) {
      add_case_polygon(scene, box_face_names[static_cast<std::size_t>(face)], black, corners);
      continue;
    }
    const double area = (corners[1] - corners[0]).cross(corners[2] - corners[1]).norm();
    if (opening.u.cross(opening.v).norm() > 0.999 * area) continue;
    std::vector<Eigen::Vector3d> hole = opening.corners();
    const Eigen::Vector3d facing = (corners[1] - corners[0]).cross(corners[2] - corners[1]);
    if (opening.normal().dot(facing) < 0.0) std::reverse(hole.begin(), hole.end());
    add_holed_polygon(scene, "open", black, corners, hole);
  }
}

// The mask of the case, as long as an endless one seems from inside, with the given exitance.
void add_mask(const ReferenceValue& geometry, double exitance, Scene& scene) {
  constexpr double far = 12.0;  // m, to both sides
  const ReferenceValue& mask = geometry.at("mask");
  const int paint = add_paint(scene, {.exitance = static_cast<float>(exitance)});
  if (mask.at(0) == "h") {
    const double depth = mask.at(1), z = geometry.at("room").at(2);
    add_case_polygon(scene, "mask", paint,
                     {{-far, -depth, z}, {-far, 0, z}, {far, 0, z}, {far, -depth, z}});
  } else {
    const double height = mask.at(1), distance = 6.0;
    add_case_polygon(scene, "mask", paint,
                     {{far, -distance, 0},
                      {-far, -distance, 0},
                      {-far, -distance, height},
                      {far, -distance, height}});
  }
}

struct DaylightCase {
  const ReferenceValue& reference;
  bool has_glass = false;
  ClearPane pane{};
};

Scene daylight_scene(const DaylightCase& daylight, int number) {
  const ReferenceValue& c = daylight.reference;
  const ReferenceValue& g = c.at("geometry");
  const Opening opening = opening_of(g);
  Scene scene;
  add_open_room(g, opening, scene);
  Sky sky = numbered_sky(number, reference_point(g.at("sun_direction")));
  const double E = c.at("Ehz_relative").at(std::to_string(number));
  const double rho = c.at("photometry").at("ground_reflectance");
  sky.ground = constant_spectrum(scene.bands, static_cast<float>(rho * E / pi));
  scene.sky = sky;
  if (!g.at("mask").is_null()) {
    add_mask(g, E * c.at("prescribed_mask_exitance_over_Ehz").get<double>(), scene);
  }
  // The program learns beforehand where the sky is seen from cubes of a 32nd of the scene's size. A
  // speck below the horizon makes the cubes twice as large as a room alone would, which takes a
  // quarter of the time.
  add_case_polygon(scene, "speck", add_paint(scene, {}),
                   {{0, 0, -9}, {0.01, 0, -9}, {0, 0.01, -9}});
  if (daylight.has_glass) {
    scene.materials.push_back(pane_material(scene.bands, daylight.pane));
    add_case_polygon(scene, "glass", static_cast<int>(scene.materials.size()) - 1,
                     opening.corners());
  }
  return scene;
}

// Light of a point in percent of the unobstructed horizontal light, by the stored numbers, or by
// quadrature with Fresnel's pane in place of the report's polynomial.
double expected_percent(const DaylightCase& daylight, const Scene& scene, const std::string& sky,
                        const std::string& point) {
  const ReferenceValue& c = daylight.reference;
  const double E = c.at("Ehz_relative").at(sky);
  if (daylight.has_glass) {
    const ReferenceValue& g = c.at("geometry");
    const SurfacePoint at{.position = reference_point(g.at("points").at(point)),
                          .normal = reference_point(g.at("normals").at(point))};
    return percent_of_whole / E * light_through(opening_of(g), *scene.sky, at, [&](double cosine) {
             return pane_transmittance(daylight.pane, cosine);
           });
  }
  const ReferenceValue& factors = c.at("config_factor_percent").at(point);
  double sum = c.at("SC_percent").at(sky).at(point);
  sum += factors.at("ground").get<double>() *
         c.at("photometry").at("ground_reflectance").get<double>();
  if (!c.at("geometry").at("mask").is_null()) {
    sum +=
        factors.at("mask").get<double>() * c.at("prescribed_mask_exitance_over_Ehz").get<double>();
  }
  return sum;
}

void add_sky(const DaylightCase& daylight, int number, ComparedValues& values) {
  const ReferenceValue& c = daylight.reference;
  const LitCase lit(daylight_scene(daylight, number));
  const ReferenceValue& points = c.at("geometry").at("points");
  const std::string sky = std::to_string(number);
  const double E = c.at("Ehz_relative").at(sky);
  std::vector<std::string> names;
  for (const auto& [name, at] : points.items()) names.push_back(name);
  ComparedValues found(names.size());
  parallel_for(static_cast<int>(names.size()), 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const std::string& name = names[static_cast<std::size_t>(i)];
      const double expected = expected_percent(daylight, lit.scene, sky, name);
      const double computed =
          percent_of_whole / E *
          lit.direct(reference_point(points.at(name)),
                     reference_point(c.at("geometry").at("normals").at(name)), standard_error);
      found[static_cast<std::size_t>(i)] = {
          fmt::format("sky {}, point {}", number == most_skies ? "overcast" : sky, name), expected,
          computed, daylight_error * expected};
    }
  });
  values.insert(values.end(), found.begin(), found.end());
}

ComparedValues daylight_of(const ReferenceValue& c, const Progress& progress) {
  DaylightCase daylight{.reference = c, .has_glass = !c.at("photometry").at("glazing").is_null()};
  constexpr double normal_transmittance = 0.87881;  // the sum of the report's polynomial
  daylight.pane = pane_of_transmittance(normal_transmittance);
  ComparedValues values;
  for (int number = 1; number <= most_skies; ++number) {
    report(progress, "sky", 0.0);
    add_sky(daylight, number, values);
  }
  return values;
}

std::string daylight_note(const ReferenceValue& c) {
  if (!c.at("photometry").at("glazing").is_null()) {
    return "the report's polynomial for glass cannot be given to the program: the pane has index "
           "1.52 and the same normal transmittance, and the expected values are the quadrature of "
           "the same integral with Fresnel's equations (cie171-5.5-tregenza has the difference)";
  }
  if (!c.at("geometry").at("mask").is_null()) {
    return "the report does not give the mask's luminance: the mask has the exitance " +
           fmt::format("{:g}", c.at("prescribed_mask_exitance_over_Ehz").get<double>()) +
           " of the unobstructed horizontal illuminance here";
  }
  return "";
}

}  // namespace

std::vector<ValidationCase> cie171_daylight_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::cie171_json)) {
    if (c.at("kind") != "cie171-daylight") continue;
    cases.push_back(
        {.id = c.at("id"),
         .group = "CIE 171:2006",
         .title = c.at("title").get<std::string>() + ", 16 skies",
         .unit = "%",
         .source = c.at("formula"),
         .reason = "0.8 % of the value: five of the standard errors of 0.16 % that the "
                   "rays of a point are asked to reach",
         .note = daylight_note(c),
         .has_plot = true,
         .compute = [c](const Progress& progress) { return daylight_of(c, progress); }});
  }
  return cases;
}

}  // namespace lightwell
