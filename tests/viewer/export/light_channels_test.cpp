// Light channels in baked models and in the data of a walkthrough page.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/viewer/channel_room.h"
#include "tests/viewer/lit_sides.h"
#include "tests/viewer/page_values.h"
#include "viewer/export/appearance.h"
#include "viewer/export/export.h"

namespace lightwell::light_channels_test {
namespace {

using Json = nlohmann::ordered_json;

/// A basis of light as a page unpacks its values.
struct Basis {
  std::vector<float> radiance, illuminance;
  std::vector<float> weight;
  float largest_radiance = 0.0f, largest_illuminance = 0.0f;  // in size
};

std::vector<float> halves_at(const PageData& page, const Json& place, std::size_t count) {
  const float scale = place["scale"];
  std::vector<float> values;
  for (const std::uint16_t bits : values_at<std::uint16_t>(page, place, count)) {
    values.push_back(scale * half_to_float(bits));
  }
  return values;
}

std::vector<Basis> bases_of(const PageData& page, std::size_t vertices) {
  std::vector<Basis> bases;
  for (const Json& about : page.about["bases"]) {
    Basis basis{.radiance = halves_at(page, about["radiance"], 3 * vertices),
                .illuminance = halves_at(page, about["illuminance"], 3 * vertices),
                .weight = about["weight"].get<std::vector<float>>()};
    for (const float L : basis.radiance) {
      basis.largest_radiance = std::max(basis.largest_radiance, std::abs(L));
    }
    basis.largest_illuminance = *std::ranges::max_element(basis.illuminance);
    bases.push_back(std::move(basis));
  }
  return bases;
}

/// Error bound of a sum of bases. A half float has a relative error of 2^-11, or, for values below
/// 2^-29 of the largest in its array (2^-14 where the largest is 2^15), an absolute error of 2^-11
/// of that threshold. Sums without negative terms have the same bound. Some ten float roundings are
/// added.
double bound(double sum, double largest) {
  return sum * (std::exp2(-11.0) + 1e-6) + largest * std::exp2(-40.0);
}

int mesh_vertex(const BakedModel& model, const PatchMesh& mesh, int face, int vertex) {
  const int e = model.element[static_cast<std::size_t>(face)];
  for (int c = 0; c < mesh.corner_count(e); ++c) {
    const int v = mesh.corners[e][c];
    if (mesh.position(v) == model.position[static_cast<std::size_t>(vertex)]) return v;
  }
  ADD_FAILURE() << "vertex " << vertex << " is no corner of element " << e;
  return 0;
}

/// Expects that the weighted sum of the bases is the light of `wanted`.
void expect_sum(const std::vector<Basis>& bases, const BakedModel& model, const SolvedScene& wanted,
                const std::vector<Material>& materials) {
  const Bands& bands = wanted.solution.bands;
  const BandArray radiance = shown_radiance(wanted, materials), E = wanted.solution.irradiance();
  const auto check = [&](int i, int v) {
    Eigen::Array3d L = Eigen::Array3d::Zero();
    double lux = 0.0, brightest = 0.0, brightest_lux = 0.0;
    for (const Basis& basis : bases) {
      for (int k = 0; k < 3; ++k) {
        L[k] += basis.weight[k] * basis.radiance[3 * i + k];
        lux += basis.weight[k] * basis.illuminance[3 * i + k];
        brightest_lux += basis.weight[k] * basis.largest_illuminance;
      }
      brightest += *std::ranges::max_element(basis.weight) * basis.largest_radiance;
    }
    const Eigen::Array3f rgb = linear_rgb(bands, radiance.row(v).transpose());
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(L[k], rgb[k], bound(std::abs(rgb[k]), brightest)) << i;
    }
    const double expected = luminous(bands, E.row(v).transpose());
    EXPECT_NEAR(lux, expected, bound(expected, brightest_lux)) << i;
  };
  for (int f = 0; f < model.face_count(); ++f) {
    for (int c = 0; c < model.corner_count(f); ++c) {
      const int i = model.faces[static_cast<std::size_t>(f)][c];
      check(i, mesh_vertex(model, wanted.mesh, f, i));
    }
  }
}

const LuxRange any_range{.low = 0.0, .high = 1000.0};

class LightChannels : public testing::Test {
 protected:
  SolvedScene relit(const char* desk, const char* panel) const {
    return lightwell::relit(solved, {desk, panel});
  }
  const Scene scene = channel_room();
  const SolvedScene solved = solve_by_channel(scene);
};

/// The sum of the embedded bases is the light of relight(), also of visible lamps and of mirrors.
TEST_F(LightChannels, AddUpWithTheScalesInForce) {
  const SolvedScene dim = relit("0.25", "1.5,#ff4020");
  const BakedModel model = bake_model(dim, scene);
  const PageData page = page_data(model, any_range);
  const auto bases = bases_of(page, model.position.size());
  ASSERT_EQ(bases.size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(page.about["bases"][c]["name"], dim.solution.channels[c].name);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(bases[c].weight[k], dim.solution.channels[c].scale[k]);
    }
  }
  expect_sum(bases, model, dim, scene.materials);
}

/// The basis of a lamp at scale 0 holds the lamp's full light.
TEST_F(LightChannels, AddUpWithOtherWeightsToTheSceneRelit) {
  const BakedModel model = bake_model(relit("off", "0.1"), scene);
  auto bases = bases_of(page_data(model, any_range), model.position.size());
  const SolvedScene wanted = relit("2,#8080ff", "0.7,#ffe0b0");
  for (std::size_t c = 0; c < 2; ++c) {
    const Spectrum& scale = wanted.solution.channels[c].scale;
    bases[c].weight.assign(scale.begin(), scale.end());
  }
  expect_sum(bases, model, wanted, scene.materials);
}

/// Lumens of a channel are those of emitted_flux at scale 1; a colour keeps them.
TEST_F(LightChannels, LumensAreThoseOfTheLamps) {
  const PageData page = page_data(bake_model(relit("0.3", "off"), scene), any_range);
  for (std::size_t c = 0; c < 2; ++c) {
    const auto lumens = page.about["bases"][c]["lumens"].get<std::vector<double>>();
    ASSERT_EQ(lumens.size(), 3u);
    const double flux = luminous(rgb_bands(), emitted_flux(solved.solution.channels[c]));
    EXPECT_NEAR(lumens[0] + lumens[1] + lumens[2], flux, 1e-6 * flux);
  }
}

/// Spectral bands share one weight per channel; a scale that differs between bands is part of the
/// basis.
TEST(SpectralChannels, KeepAnUnevenScale) {
  Scene scene;
  scene.bands = spectral_bands(420.0, 680.0, 4);
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, {wall, wall, wall, wall, wall, wall}, true);
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.1f, 10.0f));
  test::add_polygon(scene, "lamp", lamp,
                    {{0.5, 0.5, 1.9}, {0.5, 1.5, 1.9}, {1.5, 1.5, 1.9}, {1.5, 0.5, 1.9}});
  SolvedScene solved = solve_by_channel(scene);
  const Spectrum scale = (Spectrum(4) << 0.4f, 0.2f, 0.0f, 0.1f).finished();
  relight(solved, {&scale, 1});
  const BakedModel model = bake_model(solved, scene);
  const auto bases = bases_of(page_data(model, any_range), model.position.size());
  ASSERT_EQ(bases.size(), 1u);
  EXPECT_EQ(bases[0].weight, (std::vector<float>{0.4f, 0.4f, 0.4f}));
  expect_sum(bases, model, solved, scene.materials);
}

/// A side that only a switched-off lamp lights is part of the model, for when the lamp is switched
/// on.
TEST(ChannelsThatAreOff, StillCountAsLight) {
  SolvedScene square = square_of_two_sides(white, dark);
  RadiositySolution& s = square.solution;
  s.full_emission = BandArray::Zero(2, 3);
  s.patch_channel = {-1, -1};
  EXPECT_EQ(bake_model(square, {}).face_count(), 1);
  for (int side = 0; side < 2; ++side) {
    BandArray E = BandArray::Zero(8, 3);
    E.middleRows(4 * side, 4) = 2.0f;
    s.channels.push_back({.name = side == 0 ? "before" : "behind",
                          .scale = Spectrum::Constant(3, side == 0 ? 1.0f : 0.0f),
                          .patch_radiosity = BandArray::Zero(2, 3),
                          .direct_irradiance = E,
                          .indirect_irradiance = BandArray::Zero(8, 3),
                          .energy = BandEnergy::Ones(4, 3)});
  }
  const BakedModel model = bake_model(square, {});
  EXPECT_EQ(model.face_count(), 2);
  EXPECT_EQ(model.black_behind, (std::vector<std::uint8_t>{0, 0}));
  EXPECT_EQ(model.radiance.maxCoeff(),
            2.0f / std::numbers::pi_v<float>);  // with the scales of the solution
}

/// Without channels a page has one basis and no weights.
TEST(ChannelsThatAreNotKept, LeaveOneBasis) {
  const PageData page = page_data(bake_model(solved_box(), box_scene()), any_range);
  ASSERT_EQ(page.about["bases"].size(), 1u);
  EXPECT_FALSE(page.about["bases"][0].contains("weight"));
}

}  // namespace
}  // namespace lightwell::light_channels_test
