#include "raytrace/readings/glare.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

using std::numbers::pi;

ComparedValues position_indices(const ReferenceValue& c) {
  ComparedValues values;
  for (const ReferenceValue& row : c.at("expected")) {
    const double alpha = row.at("alpha"), beta = row.at("beta"), p = row.at("p");
    values.push_back({fmt::format("alpha {:g}, beta {:g}", alpha, beta), p,
                      position_index(beta, alpha), 1e-9 * p});
  }
  return values;
}

// Sides of the luminaires in the case over those in the reference. The formula takes a luminaire as
// a point; at a tenth of its side the square of its angle is 100 times less. By L^2 w of a given
// intensity, UGR is then 8 lg 100 = 16 higher.
constexpr double shrunk = 0.1;

// True for a luminaire on the limit of the standard's table, which cuts through its area: within 5
// % of its distance ahead a luminaire counts or does not.
bool is_on_limit(const ReferenceValue& c, const ReferenceValue& luminaire) {
  const ReferenceValue& g = c.at("geometry");
  const Eigen::Vector3d to =
      reference_point(luminaire.at("position")) - reference_point(g.at("eye"));
  const Eigen::Vector3d view = reference_point(g.at("view"));
  const double ahead = to.dot(view), above = to.z();
  const double beside = (to - ahead * view - above * Eigen::Vector3d::UnitZ()).norm();
  return counts_for_glare(0.95 * ahead, beside, above) !=
         counts_for_glare(1.05 * ahead, beside, above);
}

// UGR by the formula from the sources of the reference, without those on the limit.
double expected_ugr(const ReferenceValue& c) {
  double sum = 0.0;
  for (const ReferenceValue& s : c.at("expected").at("per_source")) {
    if (is_on_limit(c, s)) continue;
    const double L = s.at("L"), omega = s.at("omega"), p = s.at("p");
    sum += L * L * omega / (p * p);
  }
  return 8.0 * std::log10(0.25 / c.at("parameters").at("Lb").get<double>() * sum);
}

ComparedValues unified_rating(const ReferenceValue& c, const Progress& progress) {
  const ReferenceValue& g = c.at("geometry");
  Scene scene;
  // An even light of B = pi L_b, as the walls of a room that reflect half.
  constexpr float rho = 0.5f;
  const int wall = add_paint(scene, {.reflectance = rho});
  add_case_box(
      scene,
      {.low = {-9, -9, 0}, .high = {9, 18, 9}, .materials = {wall, wall, wall, wall, wall, wall}});
  for (const ReferenceValue& s : g.at("luminaires")) {
    if (is_on_limit(c, s)) continue;
    const double side = shrunk * std::sqrt(s.at("area_m2").get<double>());
    const double I0 = s.at("I0_cd");
    const Eigen::Vector3d at = reference_point(s.at("position"));
    const double M = pi * I0 / (side * side) / scene.bands.lumens_per_watt;
    const Eigen::Vector3d x = 0.5 * side * Eigen::Vector3d::UnitX(),
                          y = 0.5 * side * Eigen::Vector3d::UnitY();
    add_case_polygon(scene, fmt::format("luminaire {}", scene.surfaces.size() - 5),
                     add_paint(scene, {.exitance = static_cast<float>(M)}),
                     {at - x - y, at - x + y, at + x + y, at + x - y});
  }
  const LitCase lit(std::move(scene));
  RadiositySolution solution;
  solution.bands = lit.scene.bands;
  solution.direct_irradiance.setZero(lit.mesh.vertex_count(), lit.scene.bands.count());
  solution.indirect_irradiance = solution.direct_irradiance;
  const double B = pi * c.at("parameters").at("Lb").get<double>() / lit.scene.bands.lumens_per_watt;
  solution.indirect_irradiance.setConstant(static_cast<float>(B) / rho);
  const Camera eye{.position = reference_point(g.at("eye")),
                   .direction = reference_point(g.at("view")),
                   .up = Eigen::Vector3d::UnitZ()};
  const Glare glare = unified_glare_rating(lit.scene, lit.caster, lit.direct_light, solution, eye,
                                           {.rays = 1024, .run = {.progress = progress}});
  const double of_size = 8.0 * std::log10(1.0 / (shrunk * shrunk));
  ComparedValues values = {{"UGR", expected_ugr(c), glare.ugr.value_or(0.0) - of_size, 0.02}};
  // Sources stand in the order of the luminaires. Their angle changes along them by 1 % at most,
  // and means differ from the middle by the square of that.
  std::size_t number = 0, counted = 0;
  for (const ReferenceValue& s : c.at("expected").at("per_source")) {
    counted += is_on_limit(c, s) ? 0 : 1;
  }
  values.push_back({"luminaires in sight", static_cast<double>(counted),
                    static_cast<double>(glare.sources.size()), 0.0});
  for (const ReferenceValue& s : c.at("expected").at("per_source")) {
    if (is_on_limit(c, s) || number >= glare.sources.size()) continue;
    const GlareSource& source = glare.sources[number++];
    const double omega = shrunk * shrunk * s.at("omega").get<double>();
    const double L = s.at("L").get<double>() / (shrunk * shrunk);
    values.push_back(
        {fmt::format("sr of luminaire {}", number), omega, source.solid_angle, 1e-3 * omega});
    values.push_back({fmt::format("cd/m2 of luminaire {}", number), L, source.luminance, 1e-3 * L});
  }
  return values;
}

}  // namespace

std::vector<ValidationCase> glare_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::photometry_json)) {
    if (c.at("kind") != "ugr") continue;
    const bool is_index = c.at("id") == "guth-position-index";
    ValidationCase one{.id = c.at("id"),
                       .group = "glare",
                       .title = c.at("title"),
                       .source = c.at("formula"),
                       .reason = "1e-9 of the value: rounding"};
    if (!is_index) {
      one.reason =
          "0.02 units: luminaires of a tenth of the side, whose finite size and whose small cover "
          "of the background change UGR by less; 1e-3 of solid angles and luminances";
      one.note =
          "the luminaires have a tenth of the side and the same intensity, which adds 16 to "
          "UGR; 16 is taken away. Luminaires on the limit of the standard's table are left out";
    }
    one.compute = [c, is_index](const Progress& progress) {
      return is_index ? position_indices(c) : unified_rating(c, progress);
    };
    cases.push_back(std::move(one));
  }
  return cases;
}

}  // namespace lightwell
