#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/closed_forms/polygon_exchange.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/form_factors/facet_view_factors.h"
#include "scene/io/polygon_arrays.h"
#include "scene/sampling.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"
#include "validation/cases/round_rays.h"

namespace lightwell {
namespace {

constexpr double closed_form_error = 1e-9;  // relative, of polygon_exchange()
// Wanted standard error of the factors of the command 'form-factors', of which four are the
// tolerance: a right program exceeds it once in 16 000 times. A thousandth of the factor.
constexpr double target_share = 1e-3, least_target_error = 1e-6;

double target_of(double factor) {
  return std::max(target_share * factor, least_target_error);
}

ComparedValues element_to_polygon(const ReferenceValue& c) {
  const ReferenceValue& g = c.at("geometry");
  const Loop polygon = reference_polygon(g.at("polygon"));
  const double F = std::abs(point_to_polygon(reference_point(g.at("point")),
                                             reference_point(g.at("normal")), {&polygon, 1}));
  const double expected = c.at("value");
  return {{.expected = expected, .computed = F, .tolerance = closed_form_error * expected}};
}

// The rows of a file with these polygons, counted by the command 'form-factors': all one-sided.
double facet_factor(const std::vector<Loop>& polygons, double target_error,
                    const Progress& progress) {
  Scene scene;
  const int paint = add_paint(scene, {});
  PolygonArrays arrays{.first = {0}};
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    for (const Eigen::Vector3d& point : polygons[p]) {
      arrays.corners.push_back(static_cast<int>(arrays.vertices.size()));
      arrays.vertices.push_back(point);
    }
    arrays.first.push_back(arrays.corners.size());
    arrays.surface.push_back(static_cast<int>(p));
    scene.surfaces.push_back({.name = "polygon " + std::to_string(p + 1), .material = paint});
  }
  const NumberedScene numbered = scene_of_polygons(std::move(scene), arrays);
  FacetViewFactorOptions options;
  options.target_error = target_error;
  options.progress = progress;
  const FacetViewFactors found =
      facet_view_factors(numbered, check_facets(numbered.scene), options);
  return static_cast<double>(found.factors.factor(0, 1));
}

ComparedValues polygon_to_polygon(const ReferenceValue& c, const Progress& progress) {
  const ReferenceValue& g = c.at("geometry");
  const Loop first = reference_polygon(g.at("polygon1")),
             second = reference_polygon(g.at("polygon2"));
  const PatchOutline one = polygon_outline({first}), other = polygon_outline({second});
  Scene areas;
  add_case_polygon(areas, "first", add_paint(areas, {}), first);
  const double expected = c.at("value");
  return {{.place = "closed form",
           .expected = expected,
           .computed = polygon_exchange(one, other) / surface_area(areas.surfaces[0]),
           .tolerance = closed_form_error},
          {.place = "form-factors",
           .expected = expected,
           .computed = facet_factor({first, second}, target_of(expected), progress),
           .tolerance = 4.0 * target_of(expected)}};
}

void add_box_faces(const ReferenceValue& box, std::vector<Loop>& polygons) {
  const CaseBox block{
      .low = reference_point(box.at(0)), .high = reference_point(box.at(1)), .inwards = false};
  for (int face = 0; face < 6; ++face) polygons.push_back(box_face(block, face));
}

ComparedValues occluded_pair(const ReferenceValue& c, const Progress& progress) {
  const ReferenceValue& g = c.at("geometry");
  std::vector<Loop> polygons = {reference_polygon(g.at("polygon1")),
                                reference_polygon(g.at("polygon2"))};
  for (const ReferenceValue& blocker : g.at("blockers")) {
    if (blocker.contains("box")) {
      add_box_faces(blocker.at("box"), polygons);
    } else {
      polygons.push_back(reference_polygon(blocker.at("polygon")));
    }
  }
  const double expected = c.at("value");
  // Behind a blocker that hides everything nothing may be seen.
  return {{.expected = expected,
           .computed = facet_factor(polygons, target_of(expected), progress),
           .tolerance = expected > 0.0 ? 4.0 * target_of(expected) : 0.0}};
}

// Half the length of strips that stand for endless ones, in units of their width. What lies beyond
// is 1 / (4 length^2) of the light.
constexpr double strip_length = 1e4;

Loop strip(double x0, double z0, double x1, double z1) {
  return {{x0, -strip_length, z0},
          {x1, -strip_length, z1},
          {x1, strip_length, z1},
          {x0, strip_length, z0}};
}

// Mean over elements of the unit strip at z = 0, by the midpoint rule.
double mean_over_strip(const std::function<double(const Eigen::Vector3d&)>& factor) {
  constexpr int count = 4096;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += factor({(i + 0.5) / count, 0.0, 0.0});
  return sum / count;
}

ComparedValues plates_of_two_dimensions(const ReferenceValue& c) {
  const double angle = c.at("geometry").at("angle_deg").get<double>() * std::numbers::pi / 180.0;
  const Loop plate = strip(0.0, 0.0, std::cos(angle), std::sin(angle));
  const double F = mean_over_strip([&](const Eigen::Vector3d& point) {
    return std::abs(point_to_polygon(point, Eigen::Vector3d::UnitZ(), {&plate, 1}));
  });
  return {{.expected = c.at("value"), .computed = F, .tolerance = 1e-6}};
}

ComparedValues occluded_strips(const ReferenceValue& c) {
  const ReferenceValue& g = c.at("geometry");
  const ReferenceValue& blocker = g.at("blocker");
  const double z = blocker.at(2), distance = g.at("distance");
  Scene scene;
  const int black = add_paint(scene, {}), lamp = add_paint(scene, {.exitance = 1.0f});
  Loop emitter = strip(0.0, distance, 1.0, distance);
  std::reverse(emitter.begin(), emitter.end());
  add_case_polygon(scene, "emitter", lamp, emitter);
  add_case_polygon(scene, "blocker", black,
                   strip(blocker.at(0).get<double>(), z, blocker.at(1).get<double>(), z));
  const LitCase lit(std::move(scene));
  // Not LitCase::direct(), for which the blocker is near enough to these lengths to hold the point.
  const double F = mean_over_strip([&](const Eigen::Vector3d& point) {
    const LightQuery query{.at = {point, Eigen::Vector3d::UnitZ(), -1}, .key = 1};
    return static_cast<double>(lit.direct_light.irradiance(lit.caster, query)[0]);
  });
  return {{.expected = c.at("value"), .computed = F, .tolerance = 1e-6}};
}

Frustum disc(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius) {
  return {.base = center, .axis = normal, .height = 0.0, .base_radius = radius, .top_radius = 0.0};
}

Frustum tube(double radius, double length, bool inward) {
  return {.height = length, .base_radius = radius, .top_radius = radius, .inward = inward};
}

bool meets_first(int facet, const Eigen::Vector3d&) {
  return facet == 0;
}
bool meets_second(int facet, const Eigen::Vector3d&) {
  return facet == 1;
}

// The shapes of a reference case, and which rays count.
RoundRays round_rays(const ReferenceValue& g) {
  const std::string type = g.at("type");
  const auto number = [&g](const char* key) { return g.at(key).get<double>(); };
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  if (type == "disk-disk") {
    return {
        .shapes = {disc({0, 0, 0}, up, number("r1")), disc({0, 0, number("h")}, -up, number("r2"))},
        .counts = meets_second};
  }
  if (type == "sphere-disk") {
    return {.shapes = {Sphere{.center = reference_point(g.at("sphere_center")),
                              .radius = number("sphere_radius")},
                       disc(reference_point(g.at("disk_center")), -up, number("disk_radius"))},
            .counts = meets_second};
  }
  if (type == "sphere-sphere-concentric") {
    return {.shapes = {Sphere{.radius = number("r2")}, Sphere{.radius = number("r1")}},
            .from_back = true,
            .counts = meets_second};
  }
  const auto tangent = [](double degrees) { return std::tan(degrees * std::numbers::pi / 180.0); };
  if (type == "sphere-cap") {
    const double least = std::cos(number("half_angle_deg") * std::numbers::pi / 180.0);
    return {.shapes = {Sphere{}},
            .from_back = true,
            .counts = [least](int, const Eigen::Vector3d& end) { return end.z() > least; }};
  }
  if (type == "cone") {
    return {
        .shapes = {Frustum{
            .base_radius = tangent(number("half_angle_deg")), .top_radius = 0.0, .inward = true}},
        .counts = meets_first};
  }
  if (type == "cylinder-interior") {
    return {.shapes = {tube(number("r"), number("h"), true)}, .counts = meets_first};
  }
  return {.shapes = {tube(number("r2"), number("length"), true),
                     tube(number("r1"), number("length"), false)},
          .counts = meets_first};
}

ComparedValues between_round_shapes(const ReferenceValue& c, const Progress& progress) {
  return {{.expected = c.at("value"),
           .computed = round_form_factor(round_rays(c.at("geometry")), progress),
           .tolerance = round_ray_error}};
}

ComparedValues element_to_round_shape(const ReferenceValue& c) {
  const ReferenceValue& g = c.at("geometry");
  const SurfacePoint element{.position = reference_point(g.at("point")),
                             .normal = reference_point(g.at("normal"))};
  const double expected = c.at("value");
  RoundRays rays{.counts = meets_first};
  ComparedValues values;
  if (g.contains("disk")) {
    const ReferenceValue& d = g.at("disk");
    rays.shapes = {disc(reference_point(d.at("center")), reference_point(d.at("normal")),
                        d.at("radius").get<double>())};
  } else if (g.contains("cylinder")) {
    rays.shapes = {tube(g.at("cylinder").at("radius").get<double>(),
                        g.at("cylinder").at("length").get<double>(), false)};
  } else {
    const ReferenceValue& s = g.at("sphere");
    const Sphere sphere{.center = reference_point(s.at("center")), .radius = s.at("radius")};
    rays.shapes = {sphere};
    values.push_back({.place = "closed form",
                      .expected = expected,
                      .computed = point_to_sphere(element.position, element.normal, sphere.center,
                                                  sphere.radius),
                      .tolerance = closed_form_error * expected});
    // The direct light of a sphere that emits 1 is its form factor; exitances are floats.
    Scene scene;
    scene.surfaces.push_back({.name = "lamp", .material = add_paint(scene, {.exitance = 1.0f})});
    set_shape(scene.surfaces.back(), sphere);
    values.push_back(
        {.place = "direct light",
         .expected = expected,
         .computed = LitCase(std::move(scene)).direct(element.position, element.normal),
         .tolerance = 1e-6 * expected});
  }
  values.push_back({.place = "rays",
                    .expected = expected,
                    .computed = element_form_factor(rays, element),
                    .tolerance = round_ray_error});
  return values;
}

ComparedValues form_factors_of(const ReferenceValue& c, const Progress& progress) {
  const std::string type = c.at("geometry").at("type");
  if (type == "element-polygon") return element_to_polygon(c);
  if (type.starts_with("element-")) return element_to_round_shape(c);
  if (type == "polygon-polygon") return polygon_to_polygon(c, progress);
  if (type == "occluded-polygon-polygon") return occluded_pair(c, progress);
  if (type == "2d") return plates_of_two_dimensions(c);
  if (type == "2d-occluded") return occluded_strips(c);
  return between_round_shapes(c, progress);
}

std::string form_factor_reason(const std::string& type) {
  if (type == "element-polygon") return "1e-9 of the value: Lambert's contour sum in doubles";
  if (type == "element-sphere") {
    return "1e-9 of the value for the closed form; 1e-6 for direct light, in floats; three times "
           "n^-0.75 of "
           "2^17 stratified rays";
  }
  if (type == "polygon-polygon") {
    return "1e-9 for the closed form; four standard errors of a thousandth for the command "
           "'form-factors'";
  }
  if (type == "occluded-polygon-polygon") {
    return "four standard errors of a thousandth asked of the command 'form-factors'; 0 where "
           "nothing is "
           "seen";
  }
  if (type.starts_with("2d"))
    return "1e-6: floats; strips of 10^4 widths and 4096 midpoints across them add less";
  return "three times n^-0.75, the usual error of 2^17 stratified rays";
}

// Figures that manuals of other programs print for the same pair.
std::vector<PublishedValue> published_form_factors(const std::string& id) {
  const std::string place = "form-factors", view3d = "View3D",
                    manual = "manual of View3D (G. N. Walton, NIST)";
  if (id == "par-unit-squares") return {{place, view3d, 0.199824896, manual}};
  if (id == "perp-unit-common-edge") return {{place, view3d, 0.200043776, manual}};
  if (id == "par-ees-0.1-0.05") {
    return {{place, "EES", 0.4153, "the heat-transfer library of EES, function f3d_14"}};
  }
  return {};
}

}  // namespace

std::vector<ValidationCase> form_factor_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::viewfactors_json)) {
    ValidationCase one{.id = c.at("id"),
                       .group = "form factors",
                       .title = c.at("title"),
                       .source = c.at("method"),
                       .reason = form_factor_reason(c.at("geometry").at("type")),
                       .published = published_form_factors(c.at("id"))};
    if (c.contains("check")) {
      one.source += "; checked by " + c.at("check").at("method").get<std::string>();
    }
    one.compute = [c](const Progress& progress) { return form_factors_of(c, progress); };
    cases.push_back(std::move(one));
  }
  return cases;
}

}  // namespace lightwell
