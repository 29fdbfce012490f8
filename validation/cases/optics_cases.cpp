#include "scene/optics.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "scene/conductor.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

constexpr double rounding = 1e-9;  // of formulas in doubles
constexpr double degree_of_arc = std::numbers::pi / 180.0;

double cosine_of(const std::string& degrees) {
  return std::cos(std::stod(degrees) * degree_of_arc);
}

// Angle of refraction in degrees by the vector form of Snell's law.
std::optional<double> refracted_angle(double cosine, double relative_index) {
  const Eigen::Vector3d direction(std::sqrt(1.0 - cosine * cosine), 0.0, -cosine);
  const auto refracted = refract(direction, Eigen::Vector3d::UnitZ(), relative_index);
  if (!refracted) return std::nullopt;
  return std::atan2(refracted->x(), -refracted->z()) / degree_of_arc;
}

ComparedValues dielectric_face(const ReferenceValue& c) {
  const double index =
      c.at("parameters").at("n2").get<double>() / c.at("parameters").at("n1").get<double>();
  ComparedValues values;
  for (const auto& [angle, at] : c.at("expected").items()) {
    const double cosine = cosine_of(angle);
    const PolarisedReflectance R = polarised_reflectance(cosine, index);
    const auto add = [&, degrees = angle](const char* name, double expected, double computed) {
      values.push_back({fmt::format("{} at {:.4g} degrees", name, std::stod(degrees)), expected,
                        computed, rounding * std::max(1.0, expected)});
    };
    add("R s", at.at("Rs"), R.s);
    add("R p", at.at("Rp"), R.p);
    add("R", at.at("R"), fresnel_reflectance(cosine, index));
    const auto refracted = refracted_angle(cosine, index);
    if (at.at("tir").get<bool>()) {
      add("total reflection", 1.0, refracted ? 0.0 : 1.0);
    } else {
      add("refraction", at.at("theta_t_deg"), refracted.value_or(90.0));
    }
  }
  return values;
}

ComparedValues conductor_face(const ReferenceValue& c) {
  const Bands bands = rgb_bands();
  const ReferenceValue& p = c.at("parameters");
  const Conductor metal{.eta = constant_spectrum(bands, p.at("eta").get<float>()),
                        .k = constant_spectrum(bands, p.at("k").get<float>())};
  ComparedValues values;
  for (const auto& [angle, at] : c.at("expected").items()) {
    // Indices and reflectances are floats, a few roundings of 6e-8 each.
    values.push_back({fmt::format("{} degrees", angle), at.at("R"),
                      static_cast<double>(reflectance_at(metal, cosine_of(angle))[0]), 1e-6});
  }
  return values;
}

ComparedValues clear_pane(const ReferenceValue& c) {
  const double index = c.at("parameters").at("n");
  ComparedValues values;
  for (const auto& [angle, at] : c.at("expected").items()) {
    const PaneShares shares = pane_shares(cosine_of(angle), index, 1.0);
    values.push_back({fmt::format("T at {} degrees", angle), at.at("T"), shares.passed, rounding});
    values.push_back(
        {fmt::format("R at {} degrees", angle), at.at("R"), shares.reflected, rounding});
  }
  return values;
}

// The program's shares of each polarisation at a pane, with all reflections between two panes.
ComparedValues two_panes(const ReferenceValue& c) {
  const double index = c.at("parameters").at("n");
  ComparedValues values;
  for (const auto& [angle, at] : c.at("expected").items()) {
    const InterfaceShares pane = pane_interface(cosine_of(angle), index, 1.0);
    const auto both = [](double T, double R) { return T * T / (1.0 - R * R); };
    values.push_back(
        {fmt::format("T at {} degrees", angle), at.at("T"),
         0.5 * (both(pane.passed.s, pane.reflected.s) + both(pane.passed.p, pane.reflected.p)),
         rounding});
  }
  return values;
}

// Distance of the straight continuation of a ray from the ray that leaves a slab 1 m thick.
ComparedValues displaced_ray(const ReferenceValue& c) {
  const double index = c.at("parameters").at("n"), t = c.at("parameters").at("t");
  ComparedValues values;
  for (const auto& [angle, expected] : c.at("expected").items()) {
    const double cosine = cosine_of(angle);
    const Eigen::Vector3d in(std::sqrt(1.0 - cosine * cosine), 0.0, -cosine);
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d within = refract(in, up, index).value_or(in);
    const Eigen::Vector3d exit = t / -within.z() * within;
    const Eigen::Vector3d out = refract(within, up, 1.0 / index).value_or(up);
    values.push_back({fmt::format("{} degrees", angle), expected, exit.cross(in).norm(), rounding});
    values.push_back(
        {fmt::format("direction at {} degrees", angle), 0.0, (out - in).norm(), rounding});
  }
  return values;
}

ComparedValues directions(const ReferenceValue& c) {
  ComparedValues values;
  int number = 0;
  for (const ReferenceValue& at : c.at("expected")) {
    const Eigen::Vector3d d = reference_point(at.at("d")), n = reference_point(at.at("n"));
    const double index = at.at("n2").get<double>() / at.at("n1").get<double>();
    ++number;
    values.push_back({fmt::format("off the mirrored direction {}", number), 0.0,
                      (reflect(d, n) - reference_point(at.at("reflect"))).norm(), rounding});
    const auto refracted = refract(d, n, index);
    const double off = at.at("refract").is_null()
                           ? (refracted ? 1.0 : 0.0)
                           : (refracted.value_or(-d) - reference_point(at.at("refract"))).norm();
    values.push_back({fmt::format("off the refracted direction {}", number), 0.0, off, rounding});
  }
  return values;
}

ComparedValues images_in_mirrors(const ReferenceValue& c) {
  ComparedValues values;
  for (const ReferenceValue& at : c.at("expected")) {
    const Eigen::Vector3d q = reference_point(at.at("plane_point"));
    const Eigen::Vector3d n = reference_point(at.at("plane_normal")).normalized();
    const Eigen::Vector3d image = q + reflect(reference_point(at.at("point")) - q, n);
    values.push_back({fmt::format("off image {}", values.size() + 1), 0.0,
                      (image - reference_point(at.at("image"))).norm(), rounding});
  }
  return values;
}

// A ray towards the image of a light meets the mirror where the path turns to the light itself.
ComparedValues path_by_mirror(const ReferenceValue& c) {
  const ReferenceValue& e = c.at("expected");
  const Eigen::Vector3d eye = reference_point(e.at("eye")), light = reference_point(e.at("light"));
  Scene scene;
  add_case_polygon(scene, "mirror", add_paint(scene, {}),
                   {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  const LitCase lit(std::move(scene));
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Ray ray{.origin = eye, .direction = reflect(light, up) - eye};
  ElementHit hit;
  lit.caster.closest_elements({&ray, 1}, {&hit, 1});
  const Eigen::Vector3d place = eye + hit.t * ray.direction;
  const Eigen::Vector3d on = reflect(ray.direction.normalized(), up);
  // Rays are cast in single precision, 6e-8 of coordinates of 18 m.
  constexpr double single = 2e-6;
  const double incidence = std::acos(on.z()) / degree_of_arc;
  return {
      {"off the place on the mirror", 0.0, (place - reference_point(e.at("hit"))).norm(), single},
      {"path length", e.at("path_length"), (place - eye).norm() + (light - place).norm(), single},
      {"off the light", 0.0, (light - place).cross(on).norm(), single},
      {"incidence, degrees", e.at("incidence_deg"), incidence, rounding}};
}

ComparedValues mirrored_emitter(const ReferenceValue& c, const Progress& progress) {
  Scene scene;
  const ReferenceValue& g = c.at("geometry");
  const int lamp = add_paint(
      scene, {.exitance = static_cast<float>(std::numbers::pi) * g.at("radiance").get<float>()});
  const int mirror = add_paint(scene, {});
  scene.materials.back().specular =
      constant_spectrum(scene.bands, g.at("mirror_reflectance").get<float>());
  constexpr double far = 50.0;  // m; the emitter is 3 m high
  add_case_polygon(scene, "emitter", lamp, reference_polygon(g.at("emitter")));
  add_case_polygon(scene, "mirror", mirror,
                   {{0, -far, 0}, {0, far, 0}, {0, far, far}, {0, -far, far}});
  SolveOptions options = options_for_probes();
  options.run.progress = progress;
  const SolvedScene solved = solve_scene(scene, options);
  const ElementCaster caster(solved.mesh);
  std::vector<Probe> probes;
  for (const ReferenceValue& at : c.at("expected")) {
    probes.push_back({.position = reference_point(at.at("point"))});
  }
  ProbeBounds bounds{.accuracy = 0.005};
  const BandArray E =
      probe_irradiance(scene, caster, DirectLight(scene, solved.mesh), solved.solution, probes,
                       {.rays = 1024, .run = {.progress = progress}}, &bounds);
  ComparedValues values;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const double expected = c.at("expected").at(i).at("total");
    values.push_back({fmt::format("x = {:g} m", probes[i].position.x()), expected,
                      static_cast<double>(E(static_cast<Eigen::Index>(i), 0)), 0.005 * expected});
  }
  return values;
}

ComparedValues optics_of(const ReferenceValue& c, const Progress& progress) {
  const std::string id = c.at("id");
  if (id == "fresnel-conductor-gold-ish") return conductor_face(c);
  if (id.starts_with("fresnel")) return dielectric_face(c);
  if (id == "slab-clear") return clear_pane(c);
  if (id == "double-glazing-clear") return two_panes(c);
  if (id == "slab-displacement") return displaced_ray(c);
  if (id == "reflect-refract-vectors") return directions(c);
  if (id == "mirror-images") return images_in_mirrors(c);
  if (id == "mirror-path") return path_by_mirror(c);
  return mirrored_emitter(c, progress);
}

std::string optics_reason(const std::string& id) {
  if (id == "fresnel-conductor-gold-ish") return "1e-6: indices and reflectances are floats";
  if (id == "mirror-path") return "2e-6 m: rays are cast in single precision";
  if (id == "mirror-wall-irradiance") {
    return "0.5 % of the value: the accuracy asked of 'probe', a bound with odds of 19 to 1";
  }
  return "1e-9: rounding of formulas in doubles";
}

}  // namespace

std::vector<ValidationCase> optics_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::optics_json)) {
    if (c.at("kind") != "optics") continue;
    const std::string id = c.at("id");
    ValidationCase one{.id = id,
                       .group = "optics",
                       .title = c.at("title"),
                       .source = c.at("formula"),
                       .reason = optics_reason(id)};
    if (id == "phong-lobes") {
      one.note =
          "Phong's lobes are no part of the program: gloss is GGX, and an exponent of Phong is "
          "read as a width of GGX";
      one.reason.clear();
    } else {
      one.compute = [c](const Progress& progress) { return optics_of(c, progress); };
    }
    if (id == "fresnel-conductor-gold-ish") one.note = "the mean of both polarisations alone";
    cases.push_back(std::move(one));
  }
  return cases;
}

}  // namespace lightwell
