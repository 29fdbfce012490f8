#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "scene/optics.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"
#include "validation/cases/sky_scenes.h"

namespace lightwell {
namespace {

using std::numbers::pi;
constexpr double to_percent = 100.0;

constexpr const char* iray_report =
    "Dau Design and Consulting 2016, Validation of NVIDIA Iray against CIE 171:2006";
constexpr const char* errata =
    "I. Ashdown 2016, CIE 171:2006 - Errata, lightinganalysts.com/cie-1712006-errata";

// A named point of a case and the direction that it faces; level where the case gives no normals.
SurfacePoint case_point(const ReferenceValue& geometry, const std::string& name) {
  const ReferenceValue& at = geometry.at("points").at(name);
  SurfacePoint point{
      .position = {at.at(0), at.at(1), at.size() > 2 ? at.at(2).get<double>() : 0.0}};
  if (geometry.contains("normals")) point.normal = reference_point(geometry.at("normals").at(name));
  return point;
}

// A far black surface, since a scene needs one.
void add_far_surface(Scene& scene) {
  add_case_polygon(scene, "far", add_paint(scene, {}), {{9, 9, -9}, {8, 9, -9}, {8, 8, -9}});
}

// Lambert's intensity in steps of half a degree: between them, linear values are off by an eighth
// of the square of the step, 1e-5.
SharedWeb cosine_web() {
  constexpr int steps = 180;
  std::vector<double> gammas;
  Eigen::ArrayXXd values(1, steps + 1);
  for (int i = 0; i <= steps; ++i) {
    gammas.push_back(0.5 * i);
    values(0, i) = std::max(0.0, std::cos(0.5 * i * pi / 180.0));
  }
  return std::make_shared<PhotometricWeb>(std::vector<double>{0.0}, gammas, values);
}

ComparedValues point_source(const ReferenceValue& c) {
  const bool is_lambertian = c.at("photometry").at("type") == "lambertian point";
  const double candela = is_lambertian ? c.at("photometry").at("I0_cd").get<double>()
                                       : c.at("photometry").at("flux_lm").get<double>() / (4 * pi);
  Scene scene;
  Lamp lamp{.name = "source",
            .position = reference_point(c.at("geometry").at("source")),
            .intensity = constant_spectrum(scene.bands, static_cast<float>(candela))};
  if (is_lambertian) lamp.shape = cosine_web();
  scene.lamps = {lamp};
  add_far_surface(scene);
  const LitCase lit(std::move(scene));
  ComparedValues values;
  for (const auto& [name, E] : c.at("expected_lux").items()) {
    const SurfacePoint at = case_point(c.at("geometry"), name);
    const double expected = E;
    values.push_back(
        {"point " + name, expected, lit.direct(at.position, at.normal), 2e-5 * expected});
  }
  return values;
}

ComparedValues area_source(const ReferenceValue& c) {
  const ReferenceValue& g = c.at("geometry");
  Scene scene;
  const double M = pi * c.at("photometry").at("L_cd_m2").get<double>();
  add_case_polygon(scene, "luminaire", add_paint(scene, {.exitance = static_cast<float>(M)}),
                   reference_polygon(g.at("emitter")));
  add_far_surface(scene);
  const LitCase lit(std::move(scene));
  ComparedValues values;
  for (const auto& [name, E] : c.at("expected_lux").items()) {
    const SurfacePoint at = case_point(g, name);
    const double expected = E;
    values.push_back(
        {"point " + name, expected, lit.direct(at.position, at.normal), 1e-6 * expected});
  }
  return values;
}

// Flux onto each face of the room by Simpson's rule.
ComparedValues conserved_flux(const ReferenceValue& c) {
  Scene scene;
  const CaseBox room{.high = reference_point(c.at("geometry").at("room"))};
  const double lumens = c.at("photometry").at("flux_lm");
  scene.lamps.push_back(
      {.name = "source",
       .position = reference_point(c.at("geometry").at("source")),
       .intensity = constant_spectrum(scene.bands, static_cast<float>(lumens / (4 * pi)))});
  add_far_surface(scene);
  const LitCase lit(std::move(scene));
  const ReferenceValue& e = c.at("expected");
  ComparedValues values;
  double sum = 0.0;
  for (int face = 0; face < 6; ++face) {
    const std::vector<Eigen::Vector3d> corners = box_face(room, face);
    const Eigen::Vector3d u = corners[1] - corners[0], v = corners[3] - corners[0];
    const Eigen::Vector3d area = u.cross(v);
    constexpr int steps = 32;
    double mean = 0.0;
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= steps; ++j) {
        const auto weight = [](int k) {
          return (k == 0 || k == steps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / (3.0 * steps);
        };
        mean += weight(i) * weight(j) *
                lit.direct(corners[0] + u * i / steps + v * j / steps, area.normalized());
      }
    }
    const double flux = mean * area.norm();
    sum += flux;
    const char* key = face < 4    ? "flux_each_wall_lm"
                      : face == 4 ? "flux_floor_lm"
                                  : "flux_ceiling_lm";
    const double expected = e.at(key);
    values.push_back({fmt::format("lumens on {}", box_face_names[static_cast<std::size_t>(face)]),
                      expected, flux, 1e-5 * expected});
  }
  const double total = e.at("total_flux_lm");
  values.push_back({"lumens in all", total, sum, 1e-5 * total});
  return values;
}

// Largest distance of the polynomial from Fresnel's equations for a pane of index 1.52 with the
// same normal transmittance, from 0 to 85 degrees (7e-3 at 89 degrees).
constexpr double polynomial_error = 5e-3;

ComparedValues transmittance_by_angle(const ReferenceValue& c) {
  const ClearPane pane = pane_of_transmittance(c.at("expected").at("0"));
  ComparedValues values;
  for (const auto& [angle, T] : c.at("expected").items()) {
    const double cosine = std::cos(std::stod(angle) * pi / 180.0);
    const double expected = T;
    const double found = pane_shares(cosine, pane.index, pane.transmissivity).passed;
    values.push_back({angle + " degrees", expected, found, polynomial_error});
    values.push_back(
        {"Fresnel at " + angle + " degrees", pane_transmittance(pane, cosine), found, 1e-9});
  }
  return values;
}

// The ground patch under a vertical sun, whose reflected light the points receive.
ComparedValues ground_reflection(const ReferenceValue& c, const Progress& progress) {
  const ReferenceValue& g = c.at("geometry");
  constexpr float rho = 0.5f, E = 1000.0f;
  Scene scene;
  add_case_polygon(scene, "S2", add_paint(scene, {.reflectance = rho}),
                   reference_polygon(g.at("S2")));
  scene.materials.back().one_sided = true;
  scene.sky = Sky{.up = Eigen::Vector3d::UnitZ(),
                  .north = Eigen::Vector3d::UnitY(),
                  .bright = Eigen::Vector3d::UnitZ(),
                  .scale = constant_spectrum(scene.bands, 0.0f),
                  .ground = constant_spectrum(scene.bands, 0.0f),
                  .sun = Sun{.direction = Eigen::Vector3d::UnitZ(),
                             .irradiance = constant_spectrum(scene.bands, E)}};
  SolveOptions options = options_for_probes();
  options.run.progress = progress;
  const SolvedScene solved = solve_scene(scene, options);
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  std::vector<Probe> probes;
  ComparedValues values;
  for (const auto& [name, percent] : c.at("expected_percent").items()) {
    const SurfacePoint at = case_point(g, name);
    probes.push_back({.position = at.position, .normal = at.normal});
    const double expected = percent;
    values.push_back({"point " + name, expected, 0.0, 1e-3 * to_percent});
  }
  // Direct light of the sun is none: the points look down, or along the sun's rays.
  const BandArray found = probe_irradiance(scene, caster, direct_light, solved.solution, probes,
                                           {.rays = 1 << 16, .run = {.progress = progress}});
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i].computed = to_percent * static_cast<double>(found(static_cast<Eigen::Index>(i), 0)) /
                         static_cast<double>(rho * E);
  }
  return values;
}

ComparedValues obstructed_wall(const ReferenceValue& c) {
  const ReferenceValue& g = c.at("geometry");
  Scene scene;
  std::vector<Eigen::Vector3d> wall = reference_polygon(g.at("S2"));
  const Eigen::Vector3d normal = (wall[1] - wall[0]).cross(wall[2] - wall[1]);
  if (normal.y() > 0.0) std::reverse(wall.begin(), wall.end());  // faces the room
  add_case_polygon(scene, "S2", add_paint(scene, {.exitance = 1.0f}), wall);
  const int black = add_paint(scene, {});
  add_case_box(scene, {.low = reference_point(g.at("obstruction_box").at(0)),
                       .high = reference_point(g.at("obstruction_box").at(1)),
                       .materials = {black, black, black, black, black, black},
                       .inwards = false});
  const LitCase lit(std::move(scene));
  ComparedValues values;
  for (const auto& [name, percent] : c.at("expected_percent").items()) {
    const SurfacePoint at = case_point(g, name);
    const double expected = percent;
    values.push_back({"point " + name, expected, to_percent * lit.direct(at.position, at.normal),
                      2e-6 * to_percent});
  }
  return values;
}

// Indirect light of the closed cube for one reflectance: the mean, and at three places of a wall.
void add_indirect_light(const ReferenceValue& c, const std::string& rho, const Progress& progress,
                        ComparedValues& values) {
  const ReferenceValue &g = c.at("geometry"), &e = c.at("expected");
  const double lumens = c.at("photometry").at("flux_lm"), reflectance = std::stod(rho);
  Scene scene;
  const int paint = add_paint(scene, {.reflectance = static_cast<float>(reflectance)});
  scene.materials.back().one_sided = true;
  const CaseBox room{.high = reference_point(g.at("room")),
                     .materials = {paint, paint, paint, paint, paint, paint}};
  add_case_box(scene, room);
  scene.lamps.push_back(
      {.name = "source",
       .position = reference_point(g.at("source")),
       .intensity = constant_spectrum(scene.bands, static_cast<float>(lumens / (4 * pi)))});
  SolveOptions options = options_for_probes();
  options.mesh.auto_patch_count = 1200;
  options.run.progress = progress;
  const SolvedScene solved = solve_scene(scene, options);
  const PatchMesh& mesh = solved.mesh;
  const double mean_B =
      (solved.solution.patch_radiosity.col(0).cast<double>() * mesh.area).sum() / mesh.area.sum();
  const ReferenceValue& direct = e.at("direct_lux");
  const double mean = e.at("mean_indirect_lux").at(rho);
  // Half of N^-0.5 of the 2^20 rays that find the direct light of the lamp.
  values.push_back({fmt::format("mean of a wall, rho {}", rho), mean,
                    mean_B / reflectance - direct.at("mean").get<double>(),
                    5e-4 * (mean + direct.at("mean").get<double>())});

  const std::array<Probe, 3> probes = {
      {{{2, 2, 0}, {0, 0, 1}}, {{2, 0.5, 0}, {0, 0, 1}}, {{0.5, 0.5, 0}, {0, 0, 1}}}};
  const std::array<const char*, 3> names = {"centre", "at_u2_v0p5", "at_u0p5_v0p5"};
  const std::array<const char*, 3> places = {"middle of a wall", "0.5 m off an edge",
                                             "0.5 m off two edges"};
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const BandArray E = probe_irradiance(scene, caster, direct_light, solved.solution, probes,
                                       {.rays = 1 << 13, .run = {.progress = progress}});
  const ReferenceValue& local = e.at("local_indirect_lux").at(rho);
  const double bound = e.at("local_uncertainty").at(rho);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const double expected = local.at(names[i]);
    const double found =
        static_cast<double>(E(static_cast<Eigen::Index>(i), 0)) - direct.at(names[i]).get<double>();
    values.push_back(
        {fmt::format("{}, rho {}", places[i], rho), expected, found, 3e-3 * expected + bound});
  }
}

ComparedValues closed_cube(const ReferenceValue& c, const Progress& progress) {
  ComparedValues values;
  for (const auto& [rho, mean] : c.at("expected").at("mean_indirect_lux").items()) {
    add_indirect_light(c, rho, progress, values);
  }
  return values;
}

struct ElectricCase {
  std::string reason, unit;
  std::function<ComparedValues(const ReferenceValue&, const Progress&)> compute;
  std::vector<PublishedValue> published{};
  std::string note{};
};

// Table 19 of the report as the validation of Iray quotes its correction.
std::vector<PublishedValue> corrected_table_19() {
  constexpr std::array<double, 11> values = {16.07, 16.33, 15.40, 13.32, 10.32, 7.08,
                                             3.38,  3.63,  3.01,  0.0,   0.0};
  std::vector<PublishedValue> published;
  for (std::size_t i = 0; i < values.size(); ++i) {
    published.push_back({.place = std::string("point ") + static_cast<char>('A' + i),
                         .program = "table 19, corrected",
                         .value = values[i],
                         .source = iray_report});
  }
  return published;
}

ElectricCase electric_case(const ReferenceValue& c) {
  const std::string test = c.at("test");
  if (test.starts_with("5.2")) {
    return {"2e-5 of the value: the intensity is a table in steps of half a degree", "lx",
            [](const ReferenceValue& of, const Progress&) { return point_source(of); }};
  }
  if (test == "5.3") {
    return {"1e-6 of the value: floats",
            "lx",
            [](const ReferenceValue& of, const Progress&) { return area_source(of); },
            {{.place = "point G",
              .program = "CIE 171:2006, table 12",
              .value = 61.27,
              .source = "public descriptions of the report's tables",
              .mistake = "0.25 % low: Lambert's formula for the whole square, E = pi L F, gives "
                         "61.424 lx; the table agrees with a square divided into point sources"}}};
  }
  if (test == "5.4") {
    return {"1e-5 of the value: floats, and Simpson's rule with 33 x 33 points", "lm",
            [](const ReferenceValue& of, const Progress&) { return conserved_flux(of); }};
  }
  if (test.starts_with("5.5")) {
    return {
        "5e-3: the polynomial's distance from Fresnel's equations for a pane of index 1.52; 1e-9 "
        "beside these equations",
        "",
        [](const ReferenceValue& of, const Progress&) { return transmittance_by_angle(of); },
        {{.place = "",
          .program = "Tregenza & Sharples, algorithm 2.34, at 90 degrees",
          .value = -0.028,
          .source = "the polynomial's constant term",
          .mistake = "a transmittance is not negative: by Fresnel's equations both faces "
                     "reflect all light at grazing incidence, and T = 0"}}};
  }
  if (test == "5.6") {
    return {"0.1 % of the patch's exitance: four times N^-0.75 of the 2^16 rays of a gather", "%",
            [](const ReferenceValue& of, const Progress& progress) {
              return ground_reflection(of, progress);
            }};
  }
  if (test == "5.7") {
    return {"2e-6 of the wall's exitance: floats in exact visibility", "%",
            [](const ReferenceValue& of, const Progress&) { return obstructed_wall(of); },
            corrected_table_19(),
            std::string("table 19 of the report as printed is wrong: the view of the wall past the "
                        "box is clipped to a polygon, whose Lambert sum gives the values here "
                        "(") +
                errata + ")"};
  }
  return {
      "5e-4 of mean and direct light for the mean, half of N^-0.5 of the lamp's 2^20 rays; 0.3 % "
      "for "
      "places, three times N^-0.75 of the 2^13 rays of a gather, and the stored bound",
      "lx",
      [](const ReferenceValue& of, const Progress& progress) { return closed_cube(of, progress); },
      {},
      "table 20 of the report holds for the mean of a wall alone: light is not even over the "
      "walls of a cube, and its middle gets up to 12 % more"};
}

}  // namespace

std::vector<ValidationCase> cie171_electric_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::cie171_json)) {
    if (c.at("kind") != "cie171") continue;
    ElectricCase kind = electric_case(c);
    ValidationCase one{.id = c.at("id"),
                       .group = "CIE 171:2006",
                       .title = c.at("title"),
                       .unit = kind.unit,
                       .source = c.value("formula", std::string("recomputed from the geometry")),
                       .reason = kind.reason,
                       .note = kind.note,
                       .published = kind.published,
                       .has_plot = true};
    one.compute = [c, compute = kind.compute](const Progress& progress) {
      return compute(c, progress);
    };
    cases.push_back(std::move(one));
  }
  return cases;
}

}  // namespace lightwell
