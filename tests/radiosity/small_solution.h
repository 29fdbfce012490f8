#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "radiosity/solve.h"
#include "tests/temporary_folder.h"

namespace lightwell {

namespace fs = std::filesystem;

/// A folder of its own that goes away with the test.
class SolutionFile : public testing::Test {
 protected:
  fs::path file(const std::string& name = "s.vtp") const { return folder_ / name; }
  TemporaryFolder folder_;
};

/// Band values with every awkward bit pattern that must survive: signed zero, the smallest
/// denormal, the largest number, infinity, no number, and thirds that no short decimal can hold.
inline BandArray awkward(int rows, int bands, int seed) {
  const float special[] = {-0.0f,
                           std::numeric_limits<float>::denorm_min(),
                           std::numeric_limits<float>::max(),
                           std::numeric_limits<float>::infinity(),
                           1.0f / 3.0f,
                           std::numeric_limits<float>::quiet_NaN()};
  BandArray values(rows, bands);
  for (int i = 0; i < rows * bands; ++i) {
    const int n = i + seed;
    values.data()[i] = n % 3 == 0 ? special[n / 3 % 6] : static_cast<float>(n) / 7.0f;
  }
  return values;
}

/// One two-sided quad and a triangle beside it, in two patches a side, with a sphere grid that
/// borrows their elements: small, and with something in every array.
inline SolvedScene small_solution(int band_count) {
  PatchMesh mesh;
  const std::vector<Eigen::Vector3d> positions = {
      {0, 0, 0.1}, {1, 0, 0.1}, {1, 1.0 / 3.0, 0.1}, {0, 1, 0.1}, {2, 0, 0.1},
      {0, 0, 0.1}, {0, 1, 0.1}, {1, 1.0 / 3.0, 0.1}, {1, 0, 0.1}};
  mesh.corners = {{0, 1, 2, 3}, {1, 4, 2, -1}, {5, 6, 7, 8}};
  mesh.patch = {0, 0, 1};
  mesh.element_area = Eigen::Array3d(2.0 / 3.0, 1.0 / 6.0, 2.0 / 3.0);
  mesh.twin = {2, -1, 0};
  mesh.first_element = {0, 2, 3};
  mesh.area = Eigen::Array2d(5.0 / 6.0, 2.0 / 3.0);
  mesh.reflectance = BandArray::Constant(2, band_count, 0.3f);
  mesh.emission = awkward(2, band_count, 4);
  mesh.surface = {4, 4};
  mesh.material = {1, 2};
  mesh.facet = {7, 7, 9};
  mesh.is_back = {0, 1};
  mesh.round_grids = {
      {.facet = 3,
       .shape = Sphere{{0.1, 0.2, 0.3}, 0.7},
       .rings = 1,
       .sectors = 3,
       .element = {0, 1, 2}},
      {.facet = 5, .shape = Sphere{{1, 2, 3}, 0.1}, .rings = 2, .sectors = 1, .element = {2, 0}}};
  build_topology(mesh, positions);

  RadiositySolution s;
  if (band_count == 3) {
    s.bands = rgb_bands(179.0);
  } else {
    s.bands = spectral_bands(400.0, 700.0, band_count);
  }
  s.bands.names[0] = "<\"a\" & 'b'>";
  s.metres_per_unit = 0.0254;
  s.unit_name = "in";
  s.patch_radiosity = awkward(2, band_count, 0);
  s.direct_irradiance = awkward(9, band_count, 1);
  s.indirect_irradiance = awkward(9, band_count, 2);
  s.history = {{1.0, 0.001}, {1.0 / 3.0, 0.002}, {1e-300, 0.003}};
  s.outcome = Outcome::max_sweeps_reached;
  s.residual = 0.1;
  s.energy = {100.0, 1.0 / 3.0, 2.0 / 3.0, 1e-17};
  s.error_estimate = 0.0123;
  s.seconds = {{"mesh", 0.1}, {"form factors", 1.0 / 7.0}};
  s.provenance = {"0.1.0", "räume/<box> ?> \"1\".toml", 0xfedcba9876543210u,
                  "solve --accuracy 1% -- '&'\n"};
  return {std::move(mesh), std::move(s)};
}

inline std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace lightwell
