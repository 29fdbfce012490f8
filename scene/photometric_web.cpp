#include "scene/photometric_web.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "scene/degree.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr double full_turn = 360.0, zenith = 180.0;

[[noreturn]] void refuse_web(const std::string& what) {
  throw std::invalid_argument("a photometric web " + what);
}

void check(const std::vector<double>& planes, const std::vector<double>& gammas,
           const Eigen::ArrayXXd& values) {
  if (planes.empty() || gammas.size() < 2) refuse_web("needs a plane and two angles gamma");
  if (planes.front() != 0.0 || !(planes.back() < full_turn)) {
    refuse_web("has planes from 0 to below 360 degrees");
  }
  if (!(gammas.front() >= 0.0 && gammas.back() <= zenith)) {
    refuse_web("has angles gamma within 0 and 180 degrees");
  }
  for (const std::vector<double>* angles : {&planes, &gammas}) {
    for (std::size_t i = 1; i < angles->size(); ++i) {
      if (!((*angles)[i] > (*angles)[i - 1])) refuse_web("has angles that rise");
    }
  }
  const auto rows = static_cast<Eigen::Index>(planes.size());
  const auto columns = static_cast<Eigen::Index>(gammas.size());
  if (values.rows() != rows || values.cols() != columns) {
    refuse_web(fmt::format("of {} planes and {} angles has not {} x {} values", rows, columns,
                           values.rows(), values.cols()));
  }
  if (!values.isFinite().all() || !(values >= 0.0).all()) refuse_web("has values from 0 up");
}

}  // namespace

PhotometricWeb::PhotometricWeb(std::vector<double> planes, std::vector<double> gammas,
                               const Eigen::ArrayXXd& values)
    : planes_(std::move(planes)), gammas_(std::move(gammas)), values_(values) {
  check(planes_, gammas_, values_);
  tabulate();
}

double PhotometricWeb::along(Eigen::Index plane, Eigen::Index interval, double t) const {
  return (1.0 - t) * values_(plane, interval) + t * values_(plane, interval + 1);
}

double PhotometricWeb::at_angles(double gamma, double plane) const {
  // A table ends where the light ends. Rounding of an angle must not cut its last value off.
  constexpr double rounding = 1e-9;
  if (gamma < gammas_.front() - rounding || gamma > gammas_.back() + rounding) return 0.0;
  gamma = std::clamp(gamma, gammas_.front(), gammas_.back());
  const auto interval =
      std::upper_bound(gammas_.begin(), gammas_.end() - 1, gamma) - gammas_.begin() - 1;
  const auto i = static_cast<std::size_t>(interval);
  const double t = (gamma - gammas_[i]) / (gammas_[i + 1] - gammas_[i]);
  if (planes_.size() == 1) return along(0, interval, t);
  const auto above = static_cast<std::size_t>(
      std::upper_bound(planes_.begin(), planes_.end(), plane) - planes_.begin());
  const double low = planes_[above - 1];
  const double high = above < planes_.size() ? planes_[above] : full_turn;
  const double s = (plane - low) / (high - low);
  const double value = (1.0 - s) * along(static_cast<Eigen::Index>(above) - 1, interval, t) +
                       s * along(static_cast<Eigen::Index>(above % planes_.size()), interval, t);
  return std::max(0.0, value);
}

double PhotometricWeb::at(const Eigen::Vector3d& direction) const {
  if (values_.size() == 0) return 0.0;
  const double across = std::hypot(direction.x(), direction.y());
  const double gamma = std::atan2(across, -direction.z()) / degree;
  double plane = 0.0;
  if (planes_.size() > 1) {
    plane = std::atan2(direction.y(), direction.x()) / degree;
    if (plane < 0.0) plane += full_turn;
    if (plane >= full_turn) plane = 0.0;
  }
  return at_angles(gamma, plane);
}

// The integral is exact. Values are linear over C, so the trapezoidal rule is exact. Over an
// interval of gamma, where I = a + b gamma, int I sin = [b sin - I cos].
void PhotometricWeb::tabulate() {
  const auto planes = static_cast<Eigen::Index>(planes_.size());
  Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(values_.cols());
  for (Eigen::Index p = 0; p < planes; ++p) {
    const auto i = static_cast<std::size_t>(p);
    const double before = p > 0 ? planes_[i - 1] : planes_.back() - full_turn;
    const double after = p + 1 < planes ? planes_[i + 1] : planes_.front() + full_turn;
    mean += 0.5 * (after - before) / full_turn * values_.row(p).transpose();
  }
  integral_ = 0.0;
  for (Eigen::Index g = 0; g + 1 < mean.size(); ++g) {
    const auto i = static_cast<std::size_t>(g);
    const double low = gammas_[i] * degree, high = gammas_[i + 1] * degree;
    const double slope = (mean[g + 1] - mean[g]) / (high - low);
    integral_ += slope * (std::sin(high) - std::sin(low)) -
                 (mean[g + 1] * std::cos(high) - mean[g] * std::cos(low));
  }
  integral_ *= 2.0 * std::numbers::pi;

  const double step = zenith / bands_of_gamma, turn = full_turn / sectors;
  row_cdf_.assign(bands_of_gamma, 0.0);
  cell_cdf_.assign(static_cast<std::size_t>(bands_of_gamma) * sectors, 0.0);
  double sum = 0.0;
  for (int r = 0; r < bands_of_gamma; ++r) {
    const double solid_angle =
        (std::cos(r * step * degree) - std::cos((r + 1) * step * degree)) * turn * degree;
    double of_row = 0.0;
    for (int s = 0; s < sectors; ++s) {
      // The largest of nine samples, so that no direction with light has a density of 0.
      double most = 0.0;
      for (const double y : {0.0, 0.5, 1.0}) {
        for (const double x : {0.0, 0.5, 1.0}) {
          most = std::max(most, at_angles((r + y) * step, std::fmod((s + x) * turn, full_turn)));
        }
      }
      of_row += most * solid_angle;
      cell_cdf_[static_cast<std::size_t>(r * sectors + s)] = of_row;
    }
    sum += of_row;
    row_cdf_[static_cast<std::size_t>(r)] = sum;
  }
}

DrawnDirection PhotometricWeb::draw(double u, double v) const {
  if (!(integral_ > 0.0)) return {};
  const auto [r, y, of_row] = draw_from_table(row_cdf_, u);
  const std::size_t first = static_cast<std::size_t>(r) * sectors;
  const auto [s, x, of_cell] = draw_from_table(std::span(cell_cdf_).subspan(first, sectors), v);
  const double step = zenith / bands_of_gamma * degree, turn = 2.0 * std::numbers::pi / sectors;
  const double top = std::cos(r * step), bottom = std::cos((r + 1) * step);
  const double cosine = top + y * (bottom - top);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double phi = (s + x) * turn;
  DrawnDirection drawn{.direction = {sine * std::cos(phi), sine * std::sin(phi), -cosine}};
  const double solid_angle = (top - bottom) * turn;
  drawn.weight = at(drawn.direction) * solid_angle * row_cdf_.back() / of_cell;
  return drawn;
}

}  // namespace lightwell
