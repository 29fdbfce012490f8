#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "tests/scene/io/honeybee/honeybee_models.h"

namespace lightwell::honeybee_bsdf_test {
namespace {

using namespace honeybee_models;

// Two patches of directions: from the normal to 30 degrees and beyond, with projected solid angles
// of pi / 4 and 3 pi / 4.
std::string bsdf_xml(const std::string& transmission, const std::string& reflection,
                     const std::string& structure) {
  const auto data = [](const char* direction, const std::string& values) {
    return fmt::format(
        "<WavelengthData><Wavelength unit=\"Integral\">Visible</Wavelength><WavelengthDataBlock>"
        "<WavelengthDataDirection>{}</WavelengthDataDirection><ScatteringData>{}</ScatteringData>"
        "</WavelengthDataBlock></WavelengthData>",
        direction, values);
  };
  const auto block = [](int lower, int upper) {
    return fmt::format(
        "<AngleBasisBlock><nPhis>1</nPhis><ThetaBounds><LowerTheta>{}</LowerTheta><UpperTheta>{}"
        "</UpperTheta></ThetaBounds></AngleBasisBlock>",
        lower, upper);
  };
  return "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>" + structure +
         "</IncidentDataStructure><AngleBasis>" + block(0, 30) + block(30, 90) +
         "</AngleBasis></DataDefinition>" + data("Transmission Front", transmission) +
         data("Reflection Front", reflection) + data("Reflection Back", reflection) +
         "</Layer></Optical></WindowElement>";
}

Material material_of_bsdf(const std::string& transmission, const std::string& reflection,
                          const std::string& structure = "Columns",
                          const json& added = json::object()) {
  json of = model();
  of["properties"]["radiance"]["modifiers"] =
      json::array({{{"type", "BSDF"},
                    {"identifier", "shade"},
                    {"bsdf_data", bsdf_xml(transmission, reflection, structure)}}});
  of["properties"]["radiance"]["modifiers"][0].update(added);
  of["rooms"][0]["faces"][0]["apertures"][0]["properties"]["radiance"]["modifier"] = "shade";
  return material_of(read(of), "window");
}

TEST(HoneybeeBsdf, BsdfsScatterAsMuchAsTheirMatrices) {
  // A diffuser that passes 0.6 and reflects 0.3 has the values 0.6 / pi and 0.3 / pi everywhere.
  const std::string even = fmt::format("{0}, {0}, {0}, {0}", 0.6 * std::numbers::inv_pi);
  const std::string back = fmt::format("{0}, {0}, {0}, {0}", 0.3 * std::numbers::inv_pi);
  const Material diffuser = material_of_bsdf(even, back);
  // Shares are single precision.
  constexpr float single = 1e-6f;
  EXPECT_NEAR(diffuser.transmittance[0], 0.6f, single);
  EXPECT_NEAR(diffuser.reflectance[0], 0.3f, single);
  EXPECT_FALSE(diffuser.passes_straight());
  // A clear sheet that passes 0.8 sends the light of a patch of the angle a on by 0.8 / a.
  const double a = std::numbers::pi / 4.0;
  const Material clear =
      material_of_bsdf(fmt::format("{}, 0, 0, {}", 0.8 / a, 0.8 / (3.0 * a)), "0 0 0 0");
  EXPECT_NEAR(clear.regular_transmittance[0], 0.8f, single);
  EXPECT_FALSE(clear.is_translucent());
}

// Light of the patch around the normal, a quarter of all, scatters evenly by the value 0.4 / pi;
// light of the other patch passes within its patch alone, by 0.9 of it.
TEST(HoneybeeBsdf, MatricesOfBsdfsHaveColumnsOrRowsOfIncidentLight) {
  const double even = 0.4 * std::numbers::inv_pi, within = 0.9 / (0.75 * std::numbers::pi);
  const std::string by_columns = fmt::format("{0}, 0, {0}, {1}", even, within);
  const std::string by_rows = fmt::format("{0}, {0}, 0, {1}", even, within);
  for (const Material& shade : {material_of_bsdf(by_columns, "0 0 0 0", "Columns"),
                                material_of_bsdf(by_rows, "0 0 0 0", "Rows")}) {
    constexpr float single = 1e-6f;
    EXPECT_NEAR(shade.transmittance[0], 0.25f * 0.4f, single);
    EXPECT_NEAR(shade.regular_transmittance[0], 0.75f * 0.9f, single);
  }
}

TEST(HoneybeeBsdf, DiffuseSharesOfBsdfsAreAdded) {
  const std::string even = fmt::format("{0}, {0}, {0}, {0}", 0.3 * std::numbers::inv_pi);
  const Material shade = material_of_bsdf(
      even, even, "Columns",
      {{"diffuse_transmittance", {0.1, 0.1, 0.1}}, {"front_diffuse_reflectance", {0.2, 0.2, 0.2}}});
  constexpr float single = 1e-6f;
  EXPECT_NEAR(shade.transmittance[0], 0.4f, single);
  // The mean of both faces.
  EXPECT_NEAR(shade.reflectance[0], 0.3f + 0.1f, single);
}

}  // namespace
}  // namespace lightwell::honeybee_bsdf_test
