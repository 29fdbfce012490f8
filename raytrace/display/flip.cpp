#include "raytrace/display/flip.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "raytrace/display/display.h"
#include "scene/errors.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

/// One channel of a picture.
using PixelPlane = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Planes = std::array<PixelPlane, 3>;
/// Weights of a filter along one axis; the middle element belongs to offset 0.
using Kernel = std::vector<double>;

// Matrix from linear sRGB to CIE XYZ under D65, its inverse, and the XYZ of white.
const Eigen::Matrix3d& xyz_of_rgb() {
  static const Eigen::Matrix3d matrix = (Eigen::Matrix3d() << 10135552, 8788810, 4435075, 5226144,
                                         17577620, 1774030, 475104, 8788810.0 / 3, 70074185.0 / 3)
                                            .finished() /
                                        24577794;
  return matrix;
}
const Eigen::Matrix3d& rgb_of_xyz() {
  static const Eigen::Matrix3d matrix = xyz_of_rgb().inverse();
  return matrix;
}
const Eigen::Array3d& white() {
  static const Eigen::Array3d xyz = xyz_of_rgb().rowwise().sum().array();
  return xyz;
}

// Linear opponent space: brightness, red-green, yellow-blue. Applied to the cube roots of XYZ, the
// same map gives L*a*b*.
Eigen::Array3d opponents(const Eigen::Array3d& xyz) {
  return {116.0 * xyz[1] - 16.0, 500.0 * (xyz[0] - xyz[1]), 200.0 * (xyz[1] - xyz[2])};
}
Eigen::Array3d xyz_of_opponents(const Eigen::Array3d& ycc) {
  const double y = (ycc[0] + 16.0) / 116.0;
  return {y + ycc[1] / 500.0, y, y - ycc[2] / 200.0};
}

// L*a*b* with a and b scaled by L, so that colours differ less where they are dark (Hunt's effect).
Eigen::Array3d hunt_lab(const Eigen::Array3d& rgb) {
  const Eigen::Array3d xyz = (xyz_of_rgb() * rgb.matrix()).array() / white();
  Eigen::Array3d lab = opponents(xyz.unaryExpr([](double t) {
    constexpr double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
  }));
  lab.tail<2>() *= 0.01 * lab[0];
  return lab;
}

double hyab(const Eigen::Array3d& a, const Eigen::Array3d& b) {
  const Eigen::Array3d d = a - b;
  return std::abs(d[0]) + std::hypot(d[1], d[2]);
}

template <class Weight>
Kernel kernel(int radius, Weight weight) {
  Kernel k;
  for (int x = -radius; x <= radius; ++x) k.push_back(weight(static_cast<double>(x)));
  return k;
}

double sum(const Kernel& k) {
  double total = 0.0;
  for (const double weight : k) total += weight;
  return total;
}

Kernel scaled(Kernel k, double factor) {
  for (double& weight : k) weight *= factor;
  return k;
}

// Filters rows by one kernel and columns by the other. Beyond its edges a picture repeats its
// outermost pixels.
PixelPlane filtered(const PixelPlane& plane, const Kernel& along_rows,
                    const Kernel& along_columns) {
  const auto width = static_cast<int>(plane.cols()), height = static_cast<int>(plane.rows());
  const int radius = static_cast<int>(along_rows.size()) / 2;
  PixelPlane across(height, width), result(height, width);
  constexpr int grain = 8;
  parallel_for(height, grain, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < width; ++x) {
        double total = 0.0;
        for (int k = -radius; k <= radius; ++k) {
          total += along_rows[k + radius] * plane(y, std::clamp(x + k, 0, width - 1));
        }
        across(y, x) = static_cast<float>(total);
      }
    }
  });
  const int reach = static_cast<int>(along_columns.size()) / 2;
  parallel_for(height, grain, [&](int begin, int end) {
    Eigen::Array<double, 1, Eigen::Dynamic> total(width);
    for (int y = begin; y < end; ++y) {
      total.setZero();
      for (int k = -reach; k <= reach; ++k) {
        const int row = std::clamp(y + k, 0, height - 1);
        total += along_columns[k + reach] * across.row(row).cast<double>();
      }
      result.row(y) = total.cast<float>();
    }
  });
  return result;
}

// Contrast sensitivity of the eye in one opponent channel: a sum of two Gaussians over the angle in
// degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> sensitivities = {
    {{1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

PixelPlane seen(const PixelPlane& plane, const Sensitivity& eye, double pixels_per_degree) {
  using std::numbers::pi;
  constexpr double widest = 0.04;
  const int radius =
      static_cast<int>(std::ceil(3.0 * std::sqrt(widest / (2.0 * pi * pi)) * pixels_per_degree));
  const auto gaussian = [&](double b) {
    return kernel(radius, [&](double x) {
      const double angle = x / pixels_per_degree;
      return std::exp(-pi * pi * angle * angle / b);
    });
  };
  const Kernel first = gaussian(eye.b1), second = gaussian(eye.b2);
  const double weight1 = eye.a1 * std::sqrt(pi / eye.b1), weight2 = eye.a2 * std::sqrt(pi / eye.b2);
  const double total = weight1 * sum(first) * sum(first) + weight2 * sum(second) * sum(second);
  PixelPlane result = filtered(plane, first, scaled(first, weight1 / total));
  if (weight2 > 0.0) result += filtered(plane, second, scaled(second, weight2 / total));
  return result;
}

// Strength of edges and points at each pixel: first and second derivatives of a Gaussian of the
// width with which people detect edges.
struct Features {
  PixelPlane edges, points;
};

Features features(const PixelPlane& brightness, double pixels_per_degree) {
  constexpr double peak_to_trough = 0.082;  // degrees
  const double sd = 0.5 * peak_to_trough * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0 * sd));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2.0 * sd * sd)); };
  const Kernel smooth = kernel(radius, gaussian);
  // Positive weights sum to 1 and negative ones to -1.
  const auto strength = [&](Kernel derivative) {
    double positive = 0.0, negative = 0.0;
    for (const double w : derivative) (w > 0.0 ? positive : negative) += std::abs(w);
    for (double& w : derivative) w /= w > 0.0 ? positive : negative;
    const Kernel even = scaled(smooth, 1.0 / sum(smooth));
    const PixelPlane x = filtered(brightness, derivative, even);
    const PixelPlane y = filtered(brightness, even, derivative);
    return PixelPlane((x.square() + y.square()).sqrt());
  };
  return {.edges = strength(kernel(radius, [&](double x) { return -x * gaussian(x); })),
          .points = strength(
              kernel(radius, [&](double x) { return (x * x / (sd * sd) - 1.0) * gaussian(x); }))};
}

template <class Body>
void for_each_flip_pixel(int count, Body body) {
  constexpr int grain = 4096;
  parallel_for(count, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) body(i);
  });
}

// Colours and features of a picture, which FLIP compares.
struct Impression {
  Planes lab;
  Features features;
};

Impression impression(const Image& shown, double pixels_per_degree) {
  const int width = shown.width, height = shown.height;
  Planes ycc;
  for (PixelPlane& plane : ycc) plane.resize(height, width);
  PixelPlane brightness(height, width);
  for_each_flip_pixel(width * height, [&](int i) {
    const Eigen::Array3d rgb =
        shown.radiance.row(i).head<3>().transpose().cast<double>().max(0.0).min(1.0);
    const Eigen::Array3d xyz = (xyz_of_rgb() * rgb.matrix()).array() / white();
    const Eigen::Array3d opponent = opponents(xyz);
    for (int k = 0; k < 3; ++k) ycc[k].data()[i] = static_cast<float>(opponent[k]);
    brightness.data()[i] = static_cast<float>(xyz[1]);
  });
  Impression result{.lab = {}, .features = features(brightness, pixels_per_degree)};
  for (int k = 0; k < 3; ++k) ycc[k] = seen(ycc[k], sensitivities[k], pixels_per_degree);
  for (PixelPlane& plane : result.lab) plane.resize(height, width);
  for_each_flip_pixel(width * height, [&](int i) {
    const Eigen::Array3d opponent(ycc[0].data()[i], ycc[1].data()[i], ycc[2].data()[i]);
    const Eigen::Array3d xyz = xyz_of_opponents(opponent) * white();
    const Eigen::Array3d lab =
        hunt_lab((rgb_of_xyz() * xyz.matrix()).array().max(0.0).min(1.0).eval());
    for (int k = 0; k < 3; ++k) result.lab[k].data()[i] = static_cast<float>(lab[k]);
  });
  return result;
}

// Colour difference, [0,1], compressed so that most of the range covers common differences.
double colour_error(const Eigen::Array3d& a, const Eigen::Array3d& b) {
  constexpr double exponent = 0.7, share = 0.4, target = 0.95;
  static const double largest =
      std::pow(hyab(hunt_lab({0.0, 1.0, 0.0}), hunt_lab({0.0, 0.0, 1.0})), exponent);
  const double d = std::pow(hyab(a, b), exponent), bend = share * largest;
  if (d < bend) return target / bend * d;
  return target + (d - bend) / (largest - bend) * (1.0 - target);
}

void require_comparable(const Image& picture, const Image& reference) {
  if (picture.width != reference.width || picture.height != reference.height ||
      picture.radiance.rows() != reference.radiance.rows() || picture.radiance.cols() != 3 ||
      reference.radiance.cols() != 3) {
    throw InputError(fmt::format(
        "FLIP needs two RGB pictures of one size, not {} x {} with {} bands and {} x {} with {}",
        picture.width, picture.height, picture.radiance.cols(), reference.width, reference.height,
        reference.radiance.cols()));
  }
}

// Narkowicz's fit to the ACES curve: k0 to k5 of (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5), with x
// multiplied by 0.6 as in HDR-FLIP.
constexpr double k0 = 0.6 * 0.6 * AcesFit::a, k1 = 0.6 * AcesFit::b, k3 = 0.6 * 0.6 * AcesFit::c,
                 k4 = 0.6 * AcesFit::d, k5 = AcesFit::e;

float aces(float x) {
  constexpr float brightest = 65536.0f;
  const double y = std::clamp(x, 0.0f, brightest);
  return static_cast<float>(std::min(1.0, (k0 * y * y + k1 * y) / (k3 * y * y + k4 * y + k5)));
}

// The inverse of aces().
double aces_inverse(double t) {
  const double b = (k1 - k4 * t) / (k0 - k3 * t), c = -k5 * t / (k0 - k3 * t);
  return -0.5 * b + std::sqrt(0.25 * b * b - c);
}

Image exposed(const Image& image, double stops) {
  Image shown{.width = image.width, .height = image.height};
  const auto scale = static_cast<float>(std::exp2(stops));
  shown.radiance = (image.radiance * scale).unaryExpr([](float x) { return aces(x); });
  return shown;
}

}  // namespace

Eigen::ArrayXf flip(const Image& picture, const Image& reference, double pixels_per_degree) {
  require_comparable(picture, reference);
  const Impression a = impression(picture, pixels_per_degree),
                   b = impression(reference, pixels_per_degree);
  Eigen::ArrayXf error(picture.radiance.rows());
  for_each_flip_pixel(static_cast<int>(error.size()), [&](int i) {
    const auto lab = [i](const Impression& of) {
      return Eigen::Array3d(of.lab[0].data()[i], of.lab[1].data()[i], of.lab[2].data()[i]);
    };
    const double edges = std::abs(a.features.edges.data()[i] - b.features.edges.data()[i]);
    const double points = std::abs(a.features.points.data()[i] - b.features.points.data()[i]);
    const double feature = std::sqrt(std::max(edges, points) / std::numbers::sqrt2);
    error[i] = static_cast<float>(std::pow(colour_error(lab(a), lab(b)), 1.0 - feature));
  });
  return error;
}

FlipExposures flip_exposures(const Image& reference) {
  std::vector<double> Y;
  for (Eigen::Index i = 0; i < reference.radiance.rows(); ++i) {
    Y.push_back(std::max(0.0, luminance(reference.radiance.row(i).transpose())));
  }
  std::sort(Y.begin(), Y.end());
  if (!(Y.back() > 0.0)) return {};
  double median = Y[Y.size() / 2];
  if (!(median > 0.0)) {
    const auto lit = std::upper_bound(Y.begin(), Y.end(), 0.0);
    median = *(lit + (Y.end() - lit) / 2);
  }
  constexpr double target = 0.85;
  const double x = aces_inverse(target);
  const double first = std::log2(x / Y.back()), last = std::log2(x / median);
  return {.first = first,
          .last = last,
          .count = std::max(2, static_cast<int>(std::ceil(last - first)))};
}

Eigen::ArrayXf hdr_flip(const Image& picture, const Image& reference, double pixels_per_degree) {
  require_comparable(picture, reference);
  const FlipExposures range = flip_exposures(reference);
  Eigen::ArrayXf worst = Eigen::ArrayXf::Zero(reference.radiance.rows());
  for (int i = 0; i < range.count; ++i) {
    const double stops = range.first + i * (range.last - range.first) / (range.count - 1);
    worst = worst.max(flip(exposed(picture, stops), exposed(reference, stops), pixels_per_degree));
  }
  return worst;
}

}  // namespace lightwell
