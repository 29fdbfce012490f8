#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "raytrace/readings/lux_grid.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "scene/lamp.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

using std::numbers::pi;

std::string_view photometric_text(const std::string& file) {
  using namespace validation_data;
  const std::map<std::string, std::string_view> texts = {{"axial_lambert.ies", axial_lambert_ies},
                                                         {"quadrant_mult.ies", quadrant_mult_ies},
                                                         {"spot.ies", spot_ies},
                                                         {"isym1.ldt", isym1_ldt},
                                                         {"isym2.ldt", isym2_ldt},
                                                         {"isym4.ldt", isym4_ldt}};
  return texts.at(file);
}

// Intensity towards C and gamma, degrees.
double candela(const PhotometricWeb& web, double C, double gamma) {
  const double c = C * pi / 180.0, g = gamma * pi / 180.0;
  return web.at({std::sin(g) * std::cos(c), std::sin(g) * std::sin(c), -std::cos(g)});
}

// Values are sums of a few products of doubles; the stored ones have 13 digits. Beside 0 the scale
// is the peak.
constexpr double share_of_candela = 1e-9, share_of_flux = 1e-6, share_of_lux = 1e-5;

ComparedValues photometric_file(const ReferenceValue& c) {
  const std::string name = c.at("file");
  const EmbeddedFile file(name, photometric_text(name));
  const LuminaireFile luminaire = read_luminaire(file.path());
  const PhotometricWeb& web = *luminaire.web;
  const ReferenceValue& e = c.at("expected");
  ComparedValues values;
  for (const ReferenceValue& at : e.at("candela")) {
    values.push_back({fmt::format("cd at C {:g}, gamma {:g}", at.at("C").get<double>(),
                                  at.at("gamma").get<double>()),
                      at.at("I"), candela(web, at.at("C"), at.at("gamma")),
                      share_of_candela * web.peak()});
  }
  const double lumens = e.at("lumens_exact_bilinear"), peak = e.at("max_candela");
  values.push_back({"lumens", lumens, luminaire.flux(), share_of_flux * lumens});
  values.push_back({"peak, cd", peak, web.peak(), share_of_candela * peak});

  Scene scene;
  Lamp lamp{.name = "lamp", .position = {0, 0, 3}};
  place_luminaire(luminaire, scene.bands, constant_spectrum(scene.bands, 1.0f), lamp);
  lamp.opening = {};  // the stored values are those of a point
  scene.lamps = {lamp};
  add_case_polygon(scene, "far", add_paint(scene, {}), {{9, 9, -9}, {8, 9, -9}, {8, 8, -9}});
  const LitCase lit(std::move(scene));
  for (const ReferenceValue& at : e.at("illuminance_floor_3m")) {
    const double x = at.at("x"), y = at.at("y"), E = at.at("E");
    values.push_back(
        {fmt::format("lx at ({:g}, {:g})", x, y), E,
         luminous(lit.scene.bands,
                  constant_spectrum(lit.scene.bands, static_cast<float>(lit.direct(
                                                         {x, y, 0}, Eigen::Vector3d::UnitZ())))),
         share_of_lux * E + 1e-9 * peak});
  }
  constexpr double halving = 0.01;  // degrees, to which angles of shares are sought
  if (e.contains("beam_angle_50pct_deg")) {
    values.push_back(
        {"beam angle, degrees", e.at("beam_angle_50pct_deg"), beam_angle(web, 0.0, 0.5), halving});
    values.push_back({"field angle, degrees", e.at("field_angle_10pct_deg"),
                      beam_angle(web, 0.0, 0.1), halving});
  }
  return values;
}

Lamp lamp_of(IntensityShape shape) {
  return {.intensity = constant_spectrum(rgb_bands(), 1.0f), .shape = std::move(shape)};
}

// Candela of a lamp that gives so many lumens in all.
double candela_of_lumens(double lumens, const Lamp& lamp) {
  return lumens / relative_flux(lamp);
}

Sky sky_of(SkyKind kind) {
  return {.up = Eigen::Vector3d::UnitZ(),
          .north = Eigen::Vector3d::UnitY(),
          .kind = kind,
          .bright = Eigen::Vector3d::UnitZ(),
          .scale = constant_spectrum(rgb_bands(), 1000.0f),
          .ground = constant_spectrum(rgb_bands(), 0.0f)};
}

// Tolerances of identities, relative.
constexpr double of_floats = 1e-6;
// Integrals over the dome are good to 2e-4 at a horizon: the cells of the dome are 2 pi / 512 wide,
// and the midpoint rule is off by the square of that.
constexpr double of_dome = 2e-4;
// The standard rounds the weights of red, green and blue to four digits.
constexpr double of_weights = 1e-4;

// Illuminance of a free point by a sky of 1000 cd/m^2.
double light_of_sky(SkyKind kind, const Eigen::Vector3d& normal) {
  Scene scene;
  scene.sky = sky_of(kind);
  add_case_polygon(scene, "far", add_paint(scene, {}), {{9, 9, -9}, {8, 9, -9}, {8, 8, -9}});
  return LitCase(std::move(scene)).direct({0, 0, 0}, normal);
}

double light_on_floor(const std::function<void(Scene&)>& add_light) {
  Scene scene;
  add_light(scene);
  add_case_polygon(scene, "far", add_paint(scene, {}), {{9, 9, -9}, {8, 9, -9}, {8, 8, -9}});
  return LitCase(std::move(scene)).direct({0, 0, 0}, Eigen::Vector3d::UnitZ());
}

// A row of the table of photometric identities: its tolerance, relative, and the program's value.
struct Identity {
  double tolerance = of_floats;
  std::function<double()> compute{};
};

std::map<std::string, Identity> photometric_identities() {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), level = Eigen::Vector3d::UnitX();
  const auto luminance = [](const Bands& bands, float r, float g, float b) {
    Spectrum radiance(3);
    radiance << r, g, b;
    return luminous(bands, radiance);
  };
  return {
      {"Km at 540 THz", {of_floats, [] { return rgb_bands().lumens_per_watt; }}},
      {"Rec.709 luminance of linear RGB (1,0.5,0.25)",
       {of_weights, [=] { return luminance(rgb_bands(1.0), 1.0f, 0.5f, 0.25f); }}},
      {"isotropic 1000 lm",
       {of_floats, [] { return candela_of_lumens(1000.0, lamp_of(EvenIntensity{})); }}},
      {"uniform 60 deg half-angle beam of 1000 lm",
       {of_floats,
        [] {
          return candela_of_lumens(1000.0, lamp_of(SpotCone{.inner = pi / 3.0, .outer = pi / 3.0}));
        }}},
      {"solid angle of a cone of half angle 60 deg",
       {of_floats,
        [] { return relative_flux(lamp_of(SpotCone{.inner = pi / 3.0, .outer = pi / 3.0})); }}},
      {"sun disc solid angle (0.533 deg diameter)",
       {of_floats, [] { return Sun{}.solid_angle(); }}},
      {"E at 3 m under 1000 cd",
       {of_floats,
        [] {
          return light_on_floor([](Scene& scene) {
            scene.lamps = {lamp_of(EvenIntensity{})};
            scene.lamps[0].intensity *= 1000.0f;
            scene.lamps[0].position = {0, 0, 3};
          });
        }}},
      {"uniform sky L=1000 cd/m2: horizontal illuminance",
       {of_dome, [=] { return light_of_sky(SkyKind::gradation, up); }}},
      {"uniform hemisphere on a vertical surface (sky half only)",
       {of_dome, [=] { return light_of_sky(SkyKind::gradation, level); }}},
      {"CIE overcast sky zenith L=1000: horizontal illuminance",
       {of_dome, [=] { return light_of_sky(SkyKind::overcast, up); }}},
      {"CIE overcast: vertical illuminance / horizontal",
       {of_dome,
        [=] {
          return light_of_sky(SkyKind::overcast, level) / light_of_sky(SkyKind::overcast, up);
        }}},
  };
}

ComparedValues identities(const ReferenceValue& c) {
  const std::map<std::string, Identity> known = photometric_identities();
  ComparedValues values;
  for (const ReferenceValue& row : c.at("expected")) {
    const auto found = known.find(row.at("what").get<std::string>());
    if (found == known.end()) continue;
    const double expected = row.at("value");
    const auto& [tolerance, compute] = found->second;
    values.push_back({found->first, expected, compute(), tolerance * expected});
  }
  return values;
}

std::string unknown_identities(const ReferenceValue& c) {
  const std::map<std::string, Identity> known = photometric_identities();
  std::string names;
  for (const ReferenceValue& row : c.at("expected")) {
    const std::string name = row.at("what");
    if (known.contains(name)) continue;
    names += (names.empty() ? "" : "; ") + name;
  }
  return "rows without a counterpart in the program, which uses none of these units or rules: " +
         names;
}

ComparedValues grid_rules(const ReferenceValue& c) {
  ComparedValues values;
  for (const ReferenceValue& row : c.at("expected").at("grid_spacing")) {
    const double d = row.at("d"), p = row.at("p");
    values.push_back(
        {fmt::format("spacing over {:g} m", d), p, greatest_grid_spacing(d), 1e-9 * p});
  }
  for (const ReferenceValue& row : c.at("expected").at("uniformity")) {
    const ReferenceValue& E = row.at("E");
    Eigen::ArrayXd lux(static_cast<Eigen::Index>(E.size()));
    for (Eigen::Index i = 0; i < lux.size(); ++i) lux[i] = E.at(static_cast<std::size_t>(i));
    const LuxField field = field_of(lux);
    values.push_back({"mean of a grid, lx", row.at("Em"), field.mean, 1e-9 * field.mean});
    values.push_back({"uniformity of a grid", row.at("Uo"), field.uniformity, 1e-9});
  }
  return values;
}

ComparedValues photometry_of(const ReferenceValue& c) {
  const std::string kind = c.at("kind");
  if (kind == "photometry-file") return photometric_file(c);
  return kind == "photometry-table" ? identities(c) : grid_rules(c);
}

}  // namespace

std::vector<ValidationCase> photometry_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::photometry_json)) {
    const std::string kind = c.at("kind");
    if (kind == "ugr") continue;
    ValidationCase one{.id = c.at("id"), .group = "photometry", .title = c.at("title")};
    if (kind == "photometry-file") {
      one.source = c.at("conventions");
      one.reason =
          "1e-9 of the peak for candela; 1e-6 of the flux; 1e-5 of an illuminance, whose "
          "intensities are floats";
    } else if (kind == "photometry-table") {
      one.source = "definitions of SI and of CIE, and closed forms";
      one.reason =
          "1e-6 of the value; 2e-4 for integrals over the dome in steps of 2 pi / 512; 1e-4 for "
          "the "
          "standard's weights of four digits";
      one.note = unknown_identities(c);
    } else {
      one.source = c.at("formula");
      one.reason = "1e-9 of the value: rounding";
      one.note =
          "surrounding areas, cylindrical illuminance and the series of UGR are no part of "
          "the program";
    }
    one.compute = [c](const Progress&) { return photometry_of(c); };
    cases.push_back(std::move(one));
  }
  return cases;
}

}  // namespace lightwell
