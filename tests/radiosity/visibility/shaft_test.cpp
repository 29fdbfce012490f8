#include "radiosity/visibility/shaft.h"
#include "mesh/patches/patch_sampler.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "mesh/elements/element_caster.h"
#include "scene/sampling.h"
#include "tests/radiosity/polygons.h"

namespace lightwell::shaft_test {
namespace {

using Eigen::Vector3d;
using test::Corners;
using test::Polygons;

const Corners floor_square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Corners ceiling = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};

Between between(const std::vector<Corners>& polygons) {
  const Polygons p(polygons);
  const Shafts shafts(p.mesh);
  Between found;
  shafts.find(p.end(shafts, 0), p.end(shafts, 1), found);
  return found;
}

TEST(Shaft, HoldsWhatStandsBetween) {
  const Corners screen = {{0.2, 0.2, 0.5}, {0.4, 0.2, 0.5}, {0.4, 0.4, 0.5}, {0.2, 0.4, 0.5}};
  EXPECT_EQ(between({floor_square, ceiling, screen}).pieces.size(), 1u);
  // Facets block from behind as well.
  EXPECT_EQ(between({floor_square, ceiling, {screen.rbegin(), screen.rend()}}).pieces.size(), 1u);
}

TEST(Shaft, HoldsNothingThatOnlyTouches) {
  const Corners beside = {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  const Corners wall = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  const Corners far_wall = {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};
  const Corners behind = {{-3, -3, -0.5}, {3, -3, -0.5}, {3, 3, -0.5}, {-3, 3, -0.5}};
  const Corners cellar = {{0, 0, 0}, {0, 0, -1}, {1, 0, -1}, {1, 0, 0}};
  EXPECT_TRUE(
      between({floor_square, ceiling, beside, wall, far_wall, behind, cellar}).is_nothing());
}

TEST(Shaft, IsNarrowerThanTheBoxAboutItsEnds) {
  // The hull of two small squares far apart runs along the diagonal of their box.
  const Corners low = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}};
  const Corners high = {{1, 1, 1}, {1, 1.1, 1}, {1.1, 1.1, 1}, {1.1, 1, 1}};
  const Corners aside = {{0.8, 0.1, 0.5}, {1.0, 0.1, 0.5}, {1.0, 0.3, 0.5}, {0.8, 0.3, 0.5}};
  const Corners across = {{0.5, 0.5, 0.5}, {0.6, 0.5, 0.5}, {0.6, 0.6, 0.5}, {0.5, 0.6, 0.5}};
  EXPECT_TRUE(between({low, high, aside}).is_nothing());
  EXPECT_EQ(between({low, high, across}).pieces.size(), 1u);
}

TEST(Shaft, TakesAWallOfManyFacetsAsOne) {
  std::vector<Corners> polygons = {floor_square, ceiling};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double x = 0.2 * i, y = 0.2 * j, h = 0.2;
      polygons.push_back({{x, y, 0.5}, {x + h, y, 0.5}, {x + h, y + h, 0.5}, {x, y + h, 0.5}});
    }
  }
  EXPECT_EQ(between(polygons).pieces.size(), 1u);
}

// A strip of a millimetre continues the slope of the floor. The strip rises by only 1e-6 m, so it
// nearly lies in the plane of the level strip beyond, in which the floor does not.
TEST(Shaft, KeepsAWallInItsOwnPlaneWhateverStripsItMeets) {
  constexpr double bend = 1e-3, mm = 1e-3;
  const auto strip = [](double x, double width, double low, double high) -> Corners {
    return {{x, 0, low}, {x + width, 0, high}, {x + width, 5, high}, {x, 5, low}};
  };
  const double edge = 5.0 * bend, next = edge + mm * bend;
  // Order of input: level strip, sloping strip, floor.
  const Polygons p(
      {strip(5.0 + mm, mm, next, next), strip(5.0, mm, edge, next), strip(0.0, 5.0, 0.0, edge)});
  const Occluders occluders(p.mesh);
  for (const Occluder& piece : occluders.pieces) {
    for (const Vector3d& corner : piece.polygon.corners()) {
      EXPECT_LE(std::abs(piece.plane.height(corner)), occluders.tolerance);
    }
  }
}

TEST(Shaft, KnowsWhatIsCoveredFaceToFace) {
  const Corners lid = {{0.2, 0.2, 0}, {0.2, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 0.2, 0}};
  const Corners beside = {{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}};
  for (const bool is_covered : {true, false}) {
    const Polygons p({floor_square, is_covered ? lid : beside});
    const Shafts shafts(p.mesh);
    bool any = false;
    for (int i = 0; i < p.mesh.patch_count(); ++i) {
      if (p.mesh.surface[i] == 0) any = any || shafts.is_covered(p.end(shafts, i));
    }
    EXPECT_EQ(any, is_covered);
    const Vector3d up = Vector3d::UnitZ();
    EXPECT_EQ(shafts.is_covered(shafts.end({{0.3, 0.3, 0}, up, 0})), is_covered);
    EXPECT_FALSE(shafts.is_covered(shafts.end({{0.7, 0.7, 0}, up, 0})));
  }
}

// If a ray between two patches is blocked, the occluder is in the patches' shaft.
TEST(Shaft, NeverMissesWhatBlocksARay) {
  const auto number = [](std::uint64_t a, std::uint64_t b) {
    return random_uniform(random_key(a, b, 5));
  };
  std::vector<Corners> polygons;
  for (std::uint64_t k = 0; k < 30; ++k) {
    const Vector3d at(number(k, 0), number(k, 1), number(k, 2));
    Corners triangle;
    for (std::uint64_t c = 0; c < 3; ++c) {
      triangle.push_back(
          at + 0.4 * Vector3d(number(k, 3 + 3 * c), number(k, 4 + 3 * c), number(k, 5 + 3 * c)));
    }
    polygons.push_back(triangle);
  }
  const Polygons p(polygons);
  const ElementCaster caster(p.mesh);
  const Shafts shafts(p.mesh);
  const SobolPoints sobol(64);
  const int n = p.mesh.patch_count();
  int settled = 0, pairs = 0;
  Between found;
  for (int i = 0; i < n; ++i) {
    const PatchSampler from(p.mesh, i);
    for (int j = i + 1; j < n; ++j) {
      const PatchSampler to(p.mesh, j);
      shafts.find(p.end(shafts, i), p.end(shafts, j), found);
      ++pairs;
      settled += found.is_nothing();
      if (!found.is_nothing()) continue;
      for (int s = 0; s < sobol.count(); ++s) {
        const Eigen::Array4f u = sobol.point(s, random_key(i, j));
        const PatchPoint a = from.point(u[0], u[1]), b = to.point(u[2], u[3]);
        const Vector3d way = b.position - a.position;
        // Only points that face each other: where the shaft is empty, nothing may block.
        constexpr double grazing = 1e-3;
        if (a.normal.dot(way) < grazing || -b.normal.dot(way) < grazing) continue;
        const Ray ray{.origin = a.position,
                      .direction = way,
                      .t_max = 1.0,
                      .origin_group = p.mesh.facet_of(i),
                      .target_group = p.mesh.facet_of(j)};
        std::uint8_t blocked = 0;
        caster.occluded({&ray, 1}, {&blocked, 1});
        EXPECT_EQ(blocked, 0) << i << " to " << j;
      }
    }
  }
  EXPECT_GT(settled, 0);
  EXPECT_LT(settled, pairs);
}

}  // namespace
}  // namespace lightwell::shaft_test
