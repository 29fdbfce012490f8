#include "scene/projected_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "scene/lamp.h"
#include "scene/sampling.h"

namespace lightwell::projected_picture_test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Texels of shares that 16-bit codes hold exactly: multiples of a fifth, squared.
std::shared_ptr<const PictureSums> slide(int width, int height) {
  std::vector<Texture::Code> codes;
  for (int i = 0; i < 3 * width * height; ++i) {
    const int fifth = (i * 7 + i / 5) % 6;
    codes.push_back(static_cast<Texture::Code>(65535 / 5 * fifth));
  }
  return std::make_shared<const PictureSums>(
      std::make_shared<const Texture>(width, height, 3, codes));
}

std::shared_ptr<const PictureSums> white(int width, int height) {
  return std::make_shared<const PictureSums>(std::make_shared<const Texture>(
      width, height, 1, std::vector<Texture::Code>(std::size_t(width) * height, 65535)));
}

Eigen::Array3d texel(const PictureSums& slide, int x, int y) {
  return slide.picture().texel(0, x, y).cast<double>();
}

Eigen::Vector3d direction(double x, double y) {
  return Eigen::Vector3d(x, y, -1.0).normalized();
}

/// T(x, y), by the law I = T / cos^3.
Eigen::Array3d shown(const ProjectedPicture& picture, double x, double y, double depth) {
  const double length = std::sqrt(1.0 + x * x + y * y);
  return picture.towards(direction(x, y), depth * length) / std::pow(length, 3);
}

double uniform(int i, int use) {
  return random_uniform(random_key(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(use)));
}

TEST(PictureSums, RectanglesAreTheSumsOfTheirTexels) {
  const auto sums = slide(7, 5);
  for (int k = 0; k < 200; ++k) {
    const double x0 = 7.0 * uniform(k, 0), x1 = x0 + (7.0 - x0) * uniform(k, 1);
    const double y0 = 5.0 * uniform(k, 2), y1 = y0 + (5.0 - y0) * uniform(k, 3);
    Eigen::Array3d all = Eigen::Array3d::Zero();
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 7; ++x) {
        const double across = std::max(0.0, std::min(x + 1.0, x1) - std::max<double>(x, x0));
        const double down = std::max(0.0, std::min(y + 1.0, y1) - std::max<double>(y, y0));
        all += across * down * texel(*sums, x, y);
      }
    }
    // Texels are floats of values up to 1: 35 roundings of 2^-24.
    const Eigen::Array3d found = sums->over({.left = x0, .right = x1, .top = y0, .bottom = y1});
    EXPECT_LT((found - all).abs().maxCoeff(), 35.0 * 0x1p-24);
  }
}

TEST(PictureSums, BlackBesideWhiteIsExactlyBlack) {
  std::vector<Texture::Code> codes(64 * 64, 65535);
  for (int y = 0; y < 64; ++y) {
    for (int x = 32; x < 64; ++x) codes[std::size_t(64 * y + x)] = 0;
  }
  const PictureSums sums(std::make_shared<const Texture>(64, 64, 1, codes));
  for (int k = 0; k < 100; ++k) {
    const double x = 32.0 + 31.0 * uniform(k, 4), y = 63.0 * uniform(k, 5);
    EXPECT_EQ(sums.over({.left = x, .right = x + 0.7, .top = y, .bottom = y + 0.3}).maxCoeff(),
              0.0);
  }
}

// White of 90 degrees across and half as high: T = 1 over slopes of -1 to 1 and -1/2 to 1/2.
TEST(ProjectedPicture, WhiteFillsItsBeamEvenly) {
  const ProjectedPicture picture(white(8, 4), {.beam = std::numbers::pi / 2.0}, RgbBasis());
  // The tangent of 45 degrees, and products of it, are rounded.
  constexpr double rounding = 1e-14;
  EXPECT_NEAR(picture.open_flux(), 2.0, rounding);
  EXPECT_NEAR(picture.flux().mean(), 2.0, rounding);
  for (const double x : {-0.999, 0.0, 0.7}) {
    for (const double y : {-0.499, 0.2}) {
      EXPECT_NEAR(shown(picture, x, y, 3.0).mean(), 1.0, rounding);
    }
  }
  for (const auto& [x, y] : {std::pair(-1.001, 0.0), std::pair(0.0, 0.501), std::pair(2.0, 2.0)}) {
    EXPECT_EQ(shown(picture, x, y, 3.0).mean(), 0.0);
  }
  EXPECT_EQ(picture.towards(Eigen::Vector3d::UnitZ(), 1.0).mean(), 0.0);
  EXPECT_EQ(picture.towards(Eigen::Vector3d::UnitX(), 1.0).mean(), 0.0);
}

TEST(ProjectedPicture, TexelsStandWhereTheyAreInThePicture) {
  const auto texels = slide(4, 3);
  const ProjectedPicture picture(texels, {.beam = 0.6}, RgbBasis());
  const double half = std::tan(0.3), size = half / 2.0;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      const Eigen::Array3d found =
          shown(picture, -half + (x + 0.3) * size, 1.5 * size - (y + 0.8) * size, 5.0);
      EXPECT_LT((found - texel(*texels, x, y)).abs().maxCoeff(), 1e-14);
    }
  }
}

// Flux is the integral over directions: by the midpoint rule over angle and azimuth, without the
// slopes by which the class computes.
TEST(ProjectedPicture, FluxIsTheIntegralOverDirections) {
  const ProjectedPicture picture(
      slide(4, 3), {.beam = 1.2, .shutters = {.left = 0.1, .right = 0.2, .bottom = 0.37}},
      RgbBasis());
  constexpr int rings = 1000, sectors = 2000;
  const double widest = std::atan(std::tan(0.6) * 1.25);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < rings; ++i) {
    const double angle = (i + 0.5) * widest / rings;
    const double solid_angle =
        std::sin(angle) * (widest / rings) * (2.0 * std::numbers::pi / sectors);
    for (int j = 0; j < sectors; ++j) {
      const double turn = (j + 0.5) * 2.0 * std::numbers::pi / sectors;
      sum += solid_angle * picture.towards({std::sin(angle) * std::cos(turn),
                                            std::sin(angle) * std::sin(turn), -std::cos(angle)},
                                           infinite);
    }
  }
  // Edges of texels and blades are 9 lines of the window's size, which cross at most 9 x 2000 of
  // the cells that it has, a million; the errors of half a cell each have either sign.
  EXPECT_LT(((sum - picture.flux()) / picture.flux()).abs().maxCoeff(), 1e-3);
}

TEST(ProjectedPicture, ShuttersCutExactly) {
  const ProjectorOptics::Shutters shutters{.left = 0.1, .right = 0.25, .top = 0.3, .bottom = 0.05};
  const ProjectedPicture picture(white(4, 4), {.beam = 0.8, .shutters = shutters}, RgbBasis());
  const double w = 2.0 * std::tan(0.4);
  EXPECT_NEAR(picture.flux().mean() / picture.open_flux(), 0.65 * 0.65, 1e-14);
  const double left = (0.1 - 0.5) * w, right = (0.75 - 0.5) * w, top = (0.5 - 0.3) * w,
               bottom = (0.05 - 0.5) * w;
  constexpr double close = 1e-9;
  for (const double side : {-close, close}) {
    const double in = side > 0.0 ? 1.0 : 0.0;
    EXPECT_NEAR(shown(picture, left + side, 0.0, 2.0).mean(), in, 1e-14);
    EXPECT_NEAR(shown(picture, right - side, 0.0, 2.0).mean(), in, 1e-14);
    EXPECT_NEAR(shown(picture, 0.0, top - side, 2.0).mean(), in, 1e-14);
    EXPECT_NEAR(shown(picture, 0.0, bottom + side, 2.0).mean(), in, 1e-14);
  }
}

TEST(ProjectedPicture, IsSharpInFocusAlone) {
  const auto texels = slide(6, 6);
  const ProjectedPicture sharp(texels, {.beam = 0.5}, RgbBasis());
  const ProjectedPicture focused(texels, {.beam = 0.5, .focus = 4.0, .lens = 0.2}, RgbBasis());
  double most = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double x = 0.24 * (2.0 * uniform(k, 0) - 1.0), y = 0.24 * (2.0 * uniform(k, 1) - 1.0);
    const Eigen::Array3d T = shown(sharp, x, y, 9.0);
    EXPECT_LT((shown(focused, x, y, 4.0) - T).abs().maxCoeff(), 1e-12);
    most = std::max(most, (shown(focused, x, y, 8.0) - T).abs().maxCoeff());
  }
  EXPECT_GT(most, 0.2);
}

// The edge of white spreads over the image of the lens, D |1/f - 1/d| wide.
TEST(ProjectedPicture, EdgesSpreadOverTheImageOfTheLens) {
  const double D = 0.2, f = 4.0;
  const ProjectedPicture picture(white(4, 4), {.beam = 0.8, .focus = f, .lens = D}, RgbBasis());
  const double edge = std::tan(0.4);
  for (const double d : {1.0, 2.0, 8.0, 40.0}) {
    const double radius = 0.5 * D * std::abs(1.0 / f - 1.0 / d);
    // Opposite halves of the lens are alike.
    EXPECT_NEAR(shown(picture, 0.0, edge, d).mean(), 0.5, 1e-12);
    EXPECT_NEAR(shown(picture, edge, 0.0, d).mean(), 0.5, 1e-12);
    EXPECT_NEAR(shown(picture, 0.0, edge - radius, d).mean(), 1.0, 1e-12);
    EXPECT_NEAR(shown(picture, 0.0, edge + radius, d).mean(), 0.0, 1e-12);
    EXPECT_LT(shown(picture, 0.0, edge - 0.99 * radius, d).mean(), 1.0);
    EXPECT_GT(shown(picture, 0.0, edge + 0.99 * radius, d).mean(), 0.0);
    // Half way out, a disc has 1/2 - (asin(1/2) + sqrt(3)/4) / pi of its area beyond. That a strip
    // is a rectangle changes nothing where the line runs between two strips.
    const double beyond = 0.5 - (std::asin(0.5) + std::sqrt(3.0) / 4.0) / std::numbers::pi;
    EXPECT_NEAR(shown(picture, 0.0, edge + 0.5 * radius, d).mean(), beyond, 1e-12);
  }
}

TEST(ProjectedPicture, BlurKeepsTheFluxAtEveryDepth) {
  const ProjectedPicture picture(
      slide(5, 4),
      {.beam = 0.6, .focus = 3.0, .lens = 0.3, .shutters = {.left = 0.13, .top = 0.21}},
      RgbBasis());
  for (const double depth : {0.1, 0.5, 1.0, 7.0, 1e6}) {
    // Slopes to which the picture and the image of the lens reach; the image has at most 9/20.
    constexpr int cells = 500;
    constexpr double end = 1.0, size = 2.0 * end / cells;
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        sum +=
            size * size * shown(picture, -end + (i + 0.5) * size, -end + (j + 0.5) * size, depth);
      }
    }
    // Blurred edges are linear in pieces, and the midpoint rule errs by (size / radius)^2 / 8 of
    // the light at an edge. The smallest radius is 0.15 (1/3 - 1/7), seven cells.
    EXPECT_LT(((sum - picture.flux()) / picture.flux()).abs().maxCoeff(), 0.003) << depth;
  }
}

/// Light that rays bring to a square grid of `n` x `n` cells of slopes -0.5 to 0.5 at a depth, over
/// the area of the slopes, r, g and b.
std::vector<Eigen::Array3d> landed(const ProjectedPicture& picture, double depth, int n, int rays,
                                   bool is_drawn) {
  std::vector<Eigen::Array3d> sum(std::size_t(n) * n, Eigen::Array3d::Zero());
  const SobolPoints sobol(rays);
  for (int r = 0; r < rays; ++r) {
    const Eigen::Array4d u = sobol.point(r, 11).cast<double>();
    const Eigen::Vector3d from = picture.lens_point(u[2], u[3]);
    Eigen::Vector3d way;
    Eigen::Array3d weight;
    if (is_drawn) {
      const ProjectedPicture::Drawn drawn = picture.draw(from, u[0], u[1]);
      way = drawn.direction;
      weight = drawn.weight;
    } else {  // even over slopes of -0.5 to 0.5, of which cos^3 is a solid angle
      way = direction(u[0] - 0.5, u[1] - 0.5);
      weight = picture.along(from, way) * std::pow(-way.z(), 3);
    }
    const Eigen::Vector2d at = from.head<2>() / depth - way.head<2>() / way.z();
    const int i = static_cast<int>(std::floor((at.x() + 0.5) * n)),
              j = static_cast<int>(std::floor((at.y() + 0.5) * n));
    if (i < 0 || j < 0 || i >= n || j >= n) continue;
    sum[std::size_t(j * n + i)] += weight * (double(n) * n / rays);
  }
  return sum;
}

TEST(ProjectedPicture, RaysBringWhatPointsSee) {
  const ProjectorOptics focused{
      .beam = 0.7, .focus = 2.0, .lens = 0.3, .shutters = {.right = 0.15, .bottom = 0.2}};
  for (const ProjectorOptics& optics : {focused, ProjectorOptics{.beam = 0.7}}) {
    // More texels than cells of the table for one direction, fewer for the other.
    const ProjectedPicture picture(slide(90, 40), optics, RgbBasis());
    for (const double depth : {1.0, 2.0, 12.0}) {
      constexpr int n = 8, rays = 1 << 18, fine = 40;
      const auto drawn = landed(picture, depth, n, rays, true);
      const auto even = landed(picture, depth, n, rays, false);
      for (int c = 0; c < n * n; ++c) {
        Eigen::Array3d mean = Eigen::Array3d::Zero();
        for (int k = 0; k < fine * fine; ++k) {
          mean += shown(picture, -0.5 + (c % n + (k % fine + 0.5) / fine) / n,
                        -0.5 + (c / n + (k / fine + 0.5) / fine) / n, depth) /
                  (fine * fine);
        }
        // A cell gets 1/64 of the even rays, 4096, whose texels are between 0 and 1: a standard
        // error of less than 0.5 / 64 without stratification. 1600 sample points of the mean
        // have 0.5 / 40. Three of both, in 1152 comparisons that stratification helps.
        constexpr double most = 3.0 * (0.5 / 64 + 0.5 / 40);
        EXPECT_LT((drawn[std::size_t(c)] - mean).abs().maxCoeff(), most) << depth << ' ' << c;
        EXPECT_LT((even[std::size_t(c)] - mean).abs().maxCoeff(), most) << depth << ' ' << c;
      }
    }
  }
}

TEST(ProjectedPicture, RaysCarryTheFlux) {
  for (const double focus : {2.0, infinite}) {
    const ProjectedPicture picture(
        slide(90, 40), {.beam = 0.7, .focus = focus, .shutters = {.right = 0.15}}, RgbBasis());
    constexpr int rays = 1 << 16;
    const SobolPoints sobol(rays);
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int r = 0; r < rays; ++r) {
      const Eigen::Array4d u = sobol.point(r, 3).cast<double>();
      sum += picture.draw(picture.lens_point(u[2], u[3]), u[0], u[1]).weight / rays;
    }
    // Weights are at most about 5 times their mean; 65536 of them have a standard error below 1 %
    // without stratification.
    EXPECT_LT(((sum - picture.flux()) / picture.flux()).abs().maxCoeff(), 0.01);
  }
}

TEST(ProjectedPicture, BlackSendsNothing) {
  const auto black = std::make_shared<const PictureSums>(
      std::make_shared<const Texture>(2, 2, 1, std::vector<Texture::Code>(4, 0)));
  const ProjectedPicture picture(black, {.beam = 0.7, .focus = 2.0}, RgbBasis());
  EXPECT_EQ(picture.flux().maxCoeff(), 0.0);
  EXPECT_EQ(picture.draw(Eigen::Vector3d::Zero(), 0.3, 0.6).weight.maxCoeff(), 0.0);
}

TEST(ProjectedPicture, NoDirectionGivesMoreThanTheGreatestOfItsStep) {
  constexpr int steps = 16;
  for (const ProjectorOptics& optics :
       {ProjectorOptics{.beam = 0.2}, ProjectorOptics{.beam = 2.4, .shutters = {.left = 0.6}},
        ProjectorOptics{.beam = 0.3, .focus = 5.0, .lens = 0.4},
        ProjectorOptics{.beam = 1.5, .focus = 0.5, .lens = 0.5}}) {
    for (const auto& [width, height] : {std::pair(5, 3), std::pair(300, 400)}) {
      const ProjectedPicture picture(slide(width, height), optics, RgbBasis());
      const std::vector<Eigen::Array3d> greatest = picture.greatest_by_angle(steps);
      for (int k = 0; k < 20000; ++k) {
        const double angle = std::numbers::pi * uniform(k, 0), turn = 7.0 * uniform(k, 1);
        const Eigen::Array3d I = picture.towards(
            {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), -std::cos(angle)},
            std::exp(8.0 * uniform(k, 2) - 4.0));
        const auto step = static_cast<std::size_t>(angle / std::numbers::pi * steps);
        // Cosines are rounded.
        EXPECT_TRUE((I <= greatest[step] * (1.0 + 1e-12)).all()) << angle;
      }
    }
  }
}

TEST(ProjectedPicture, RefusesOpticsOutOfRange) {
  for (const ProjectorOptics& optics :
       {ProjectorOptics{.beam = 0.0}, ProjectorOptics{.beam = 3.1}, ProjectorOptics{.focus = 0.0},
        ProjectorOptics{.focus = 1.0, .lens = 1.1}, ProjectorOptics{.focus = 1.0, .lens = 0.0},
        ProjectorOptics{.shutters = {.left = -0.1}},
        ProjectorOptics{.shutters = {.left = 0.5, .right = 0.5}}}) {
    EXPECT_THROW(ProjectedPicture(white(2, 2), optics, RgbBasis()), std::invalid_argument);
  }
}

// A lamp turns the picture with its axes, and splits light into a mean and a colour.
TEST(ProjectedPicture, LampsTurnAndColourIt) {
  const auto texels = slide(4, 3);
  Lamp lamp{.position = {1, 2, 3},
            .axes = lamp_axes(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()),
            .intensity = Spectrum::Constant(3, 10.0f)};
  lamp.shape =
      std::make_shared<const ProjectedPicture>(texels, ProjectorOptics{.beam = 0.6}, RgbBasis());
  const double half = std::tan(0.3), size = half / 2.0;
  // Looking along +y with +z up, the picture's right is +x.
  const Eigen::Vector3d towards =
      Eigen::Vector3d(-half + 0.5 * size, 1.0, 1.5 * size - 0.5 * size).normalized();
  const Spectrum I = with_color(lamp.intensity, relative_color(lamp, towards)) *
                     static_cast<float>(relative_intensity(lamp, towards));
  const Eigen::Array3d expected = 10.0 * texel(*texels, 0, 0) / std::pow(towards.y(), 3);
  // Colours and intensities are floats: three roundings.
  EXPECT_LT((I.cast<double>() - expected).abs().maxCoeff(), 3.0 * 0x1p-23 * expected.maxCoeff());
  EXPECT_GT(expected.maxCoeff() - expected.minCoeff(), 0.1);
  Eigen::Array3d all = Eigen::Array3d::Zero();
  for (int i = 0; i < 12; ++i) all += 10.0 * size * size * texel(*texels, i % 4, i / 4);
  EXPECT_LT(((lamp_flux(lamp).cast<double>() - all) / all).abs().maxCoeff(), 4.0 * 0x1p-23);
}

// White stays white in spectral bands, and red is what a red surface reflects.
TEST(ProjectedPicture, SpectralBandsPassAsTheyAreReflected) {
  const RgbBasis basis(spectral_bands(400.0, 700.0, 30));
  const ProjectedPicture open(white(1, 1), {.beam = 0.6}, basis);
  EXPECT_LT((open.in_bands(Eigen::Array3d::Ones()) - 1.0f).abs().maxCoeff(), 1e-5f);
  const Spectrum red = open.in_bands({1.0, 0.0, 0.0});
  EXPECT_EQ((red - basis.reflectance({1.0f, 0.0f, 0.0f})).abs().maxCoeff(), 0.0f);
  EXPECT_GT(red[27], 0.9f);
  EXPECT_LT(red[10], 0.1f);
}

}  // namespace
}  // namespace lightwell::projected_picture_test
