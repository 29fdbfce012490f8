#include "radiosity/form_factors/hemicube_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "radiosity/closed_forms/polygon_form_factor.h"

namespace lightwell::hemicube_cells_test {
namespace {

class HemicubeCellsOfSize : public testing::TestWithParam<int> {};

TEST_P(HemicubeCellsOfSize, DeltaFormFactorsSumToOne) {
  const HemicubeCells cells(GetParam());
  double sum = 0.0;
  for (int f = 0; f < HemicubeCells::face_count; ++f) {
    for (int row = 0; row < cells.rows(f); ++row) {
      for (int c = 0; c < cells.resolution(); ++c) {
        const double delta = cells.delta_form_factor(f, row, c, c + 1);
        EXPECT_GT(delta, 0.0);
        sum += delta;
      }
    }
  }
  EXPECT_NEAR(sum, 1.0, 1e-11);  // 3 n^2 roundings of 1e-16, at most 3e6 of them
}

// Lambert's contour sum (an independent closed form) over a block of cells as a polygon in space.
TEST_P(HemicubeCellsOfSize, BlockOfCellsIsThePolygonItCovers) {
  const int n = GetParam();
  const HemicubeCells cells(n);
  for (int f = 0; f < HemicubeCells::face_count; ++f) {
    const int rows = cells.rows(f);
    for (const auto& [row0, row1, column0, column1] :
         {std::array{0, rows, 0, n}, std::array{0, 1, 0, 1}, std::array{rows / 2, rows, n / 2, n},
          std::array{0, (rows + 1) / 2, n / 4, n / 2}}) {
      double sum = 0.0;
      for (int row = row0; row < row1; ++row) {
        sum += cells.delta_form_factor(f, row, column0, column1);
      }
      // Corners of cells lie half a cell before and after their centres.
      const auto corner = [&](int row, int column) -> Eigen::Vector3d {
        const Eigen::Vector3d at = cells.direction(f, row, column);
        const Eigen::Vector3d before = cells.direction(f, row - 1, column - 1);
        return 0.5 * (at + before);
      };
      const Loop loop = {corner(row0, column0), corner(row0, column1), corner(row1, column1),
                         corner(row1, column0)};
      const double exact =
          std::abs(point_to_polygon(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), {&loop, 1}));
      EXPECT_NEAR(sum, exact, 1e-12) << "face " << f;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Resolution, HemicubeCellsOfSize, testing::Values(2, 6, 64, 256, 1000));

// Cohen & Greenberg's table. Over a cell of width h the mean of the kernel k differs from k in the
// centre by h^2/24 |laplace k|; laplace k / k is at most 8 on the top, 16 on the sides.
TEST(HemicubeCells, DeltaFormFactorIsTheKernelTimesTheCellsArea) {
  const int n = 128;
  const HemicubeCells cells(n);
  const double h = 2.0 / n;
  for (int f = 0; f < HemicubeCells::face_count; ++f) {
    for (int row = 0; row < cells.rows(f); ++row) {
      for (int c = 0; c < n; ++c) {
        const Eigen::Vector3d d = cells.direction(f, row, c);
        const double r2 = d.squaredNorm();
        const double kernel = d.z() / (std::numbers::pi * r2 * r2) * h * h;
        const double tolerance = (f == 0 ? 8.0 : 16.0) * h * h / 24.0 + h * h * h * h;
        EXPECT_NEAR(cells.delta_form_factor(f, row, c, c + 1) / kernel, 1.0, tolerance);
      }
    }
  }
}

TEST(HemicubeCells, RefusesSizesItCannotCut) {
  for (const int n : {-2, 0, 1, 255, HemicubeCells::max_resolution + 2}) {
    EXPECT_THROW(HemicubeCells cells(n), std::invalid_argument) << n;
  }
}

}  // namespace
}  // namespace lightwell::hemicube_cells_test
