#include "scene/photometric_web.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lightwell {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double full_turn = 360.0, zenith = 180.0;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("a photometric web " + what);
}

void check(const std::vector<double>& planes, const std::vector<double>& gammas,
           const Eigen::ArrayXXd& values) {
  if (planes.empty() || gammas.size() < 2) refuse("needs a plane and two angles gamma");
  if (planes.front() != 0.0 || !(planes.back() < full_turn)) {
    refuse("has planes from 0 to below 360 degrees");
  }
  if (!(gammas.front() >= 0.0 && gammas.back() <= zenith)) {
    refuse("has angles gamma within 0 and 180 degrees");
  }
  for (const std::vector<double>* angles : {&planes, &gammas}) {
    for (std::size_t i = 1; i < angles->size(); ++i) {
      if (!((*angles)[i] > (*angles)[i - 1])) refuse("has angles that rise");
    }
  }
  const auto rows = static_cast<Eigen::Index>(planes.size());
  const auto columns = static_cast<Eigen::Index>(gammas.size());
  if (values.rows() != rows || values.cols() != columns) {
    refuse(fmt::format("of {} planes and {} angles has not {} x {} values", rows, columns,
                       values.rows(), values.cols()));
  }
  if (!values.isFinite().all() || !(values >= 0.0).all()) refuse("has values from 0 up");
}

// The slope at a point between secants of two intervals: 0 at an extremum, else their weighted
// harmonic mean, which keeps the cubic monotone (Fritsch & Butland 1984).
double monotone_slope(double before, double after, double width_before, double width_after) {
  if (!(before * after > 0.0)) return 0.0;
  const double a = 2.0 * width_after + width_before, b = width_after + 2.0 * width_before;
  return (a + b) / (a / before + b / after);
}

// One-sided, at an end of the table.
double end_slope(double secant, double next, double width, double next_width) {
  const double slope = ((2.0 * width + next_width) * secant - width * next) / (width + next_width);
  if (!(slope * secant > 0.0)) return 0.0;
  if (secant * next < 0.0 && std::abs(slope) > 3.0 * std::abs(secant)) return 3.0 * secant;
  return slope;
}

}  // namespace

PhotometricWeb::PhotometricWeb(std::vector<double> planes, std::vector<double> gammas,
                               const Eigen::ArrayXXd& values)
    : planes_(std::move(planes)), gammas_(std::move(gammas)), values_(values) {
  check(planes_, gammas_, values_);
  find_slopes();
  tabulate();
}

void PhotometricWeb::find_slopes() {
  slopes_ = Eigen::ArrayXXd::Zero(values_.rows(), values_.cols());
  const Eigen::Index n = values_.cols();
  const auto width = [&](Eigen::Index i) {
    return gammas_[static_cast<std::size_t>(i) + 1] - gammas_[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index p = 0; p < values_.rows(); ++p) {
    const auto secant = [&](Eigen::Index i) {
      return (values_(p, i + 1) - values_(p, i)) / width(i);
    };
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      slopes_(p, i) = monotone_slope(secant(i - 1), secant(i), width(i - 1), width(i));
    }
    slopes_(p, 0) = n > 2 ? end_slope(secant(0), secant(1), width(0), width(1)) : secant(0);
    slopes_(p, n - 1) =
        n > 2 ? end_slope(secant(n - 2), secant(n - 3), width(n - 2), width(n - 3)) : secant(0);
  }
  // Through the nadir, and through the zenith, a plane goes on in the one across.
  const Eigen::ArrayXXd own = slopes_;
  for (Eigen::Index p = 0; p < values_.rows(); ++p) {
    const double across = std::fmod(planes_[static_cast<std::size_t>(p)] + zenith, full_turn);
    const auto at_across = [&](Eigen::Index i) {
      const std::size_t planes = planes_.size();
      const auto above = static_cast<std::size_t>(
          std::upper_bound(planes_.begin(), planes_.end(), across) - planes_.begin());
      const double low = planes_[above - 1], high = above < planes ? planes_[above] : full_turn;
      const double t = (across - low) / (high - low);
      return (1.0 - t) * values_(static_cast<Eigen::Index>(above) - 1, i) +
             t * values_(static_cast<Eigen::Index>(above % planes), i);
    };
    if (gammas_.front() == 0.0) {
      const double w = width(0);
      slopes_(p, 0) = monotone_slope((values_(p, 0) - at_across(1)) / w,
                                     (values_(p, 1) - values_(p, 0)) / w, w, w);
    }
    if (gammas_.back() == zenith) {
      const double w = width(n - 2);
      slopes_(p, n - 1) = monotone_slope((values_(p, n - 1) - values_(p, n - 2)) / w,
                                         (at_across(n - 2) - values_(p, n - 1)) / w, w, w);
    }
  }
}

// Hermite's cubic on an interval of gamma, t in [0,1].
double PhotometricWeb::along(Eigen::Index plane, Eigen::Index interval, double t) const {
  const auto i = static_cast<std::size_t>(interval);
  const double width = gammas_[i + 1] - gammas_[i];
  const double a = values_(plane, interval), b = values_(plane, interval + 1);
  const double da = width * slopes_(plane, interval), db = width * slopes_(plane, interval + 1);
  const double rise = b - a;
  return a + t * (da + t * (3.0 * rise - 2.0 * da - db + t * (da + db - 2.0 * rise)));
}

double PhotometricWeb::at_angles(double gamma, double plane) const {
  // Tables end where no light is left: rounding of an angle must not cut the last value off.
  constexpr double rounding = 1e-9;
  if (gamma < gammas_.front() - rounding || gamma > gammas_.back() + rounding) return 0.0;
  gamma = std::clamp(gamma, gammas_.front(), gammas_.back());
  const auto interval =
      std::upper_bound(gammas_.begin(), gammas_.end() - 1, gamma) - gammas_.begin() - 1;
  const auto i = static_cast<std::size_t>(interval);
  const double t = (gamma - gammas_[i]) / (gammas_[i + 1] - gammas_[i]);
  if (planes_.size() == 1) return std::max(0.0, along(0, interval, t));
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

// The integral is exact in C, where values are linear, and by Gauss's rule of five points over
// every interval of gamma.
void PhotometricWeb::tabulate() {
  const auto planes = static_cast<Eigen::Index>(planes_.size());
  std::vector<double> share(planes_.size());
  for (Eigen::Index p = 0; p < planes; ++p) {
    const auto i = static_cast<std::size_t>(p);
    const double before = p > 0 ? planes_[i - 1] : planes_.back() - full_turn;
    const double after = p + 1 < planes ? planes_[i + 1] : planes_.front() + full_turn;
    share[i] = 0.5 * (after - before) * degree;
  }
  constexpr double node[] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                             0.9061798459386640};
  constexpr double weight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                               0.4786286704993665, 0.2369268850561891};
  integral_ = 0.0;
  for (std::size_t i = 0; i + 1 < gammas_.size(); ++i) {
    const double width = gammas_[i + 1] - gammas_[i];
    for (int k = 0; k < 5; ++k) {
      const double t = 0.5 * (1.0 + node[k]);
      const double ring =
          0.5 * weight[k] * width * degree * std::sin((gammas_[i] + t * width) * degree);
      for (Eigen::Index p = 0; p < planes; ++p) {
        integral_ += ring * share[static_cast<std::size_t>(p)] *
                     std::max(0.0, along(p, static_cast<Eigen::Index>(i), t));
      }
    }
  }

  const double step = zenith / bands_of_gamma, turn = full_turn / sectors;
  row_cdf_.assign(bands_of_gamma, 0.0);
  cell_cdf_.assign(static_cast<std::size_t>(bands_of_gamma) * sectors, 0.0);
  double sum = 0.0;
  for (int r = 0; r < bands_of_gamma; ++r) {
    const double solid_angle =
        (std::cos(r * step * degree) - std::cos((r + 1) * step * degree)) * turn * degree;
    double of_row = 0.0;
    for (int s = 0; s < sectors; ++s) {
      // The largest of some places, so that no light has a density of 0.
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
  const auto pick = [](const double* cdf, int count, double x, double& within, double& size) {
    const double wanted = x * cdf[count - 1];
    int i = static_cast<int>(std::upper_bound(cdf, cdf + count, wanted) - cdf);
    i = std::min(i, count - 1);
    while (i > 0 && !(cdf[i] > cdf[i - 1])) --i;
    const double low = i > 0 ? cdf[i - 1] : 0.0;
    size = cdf[i] - low;
    within = std::clamp((wanted - low) / size, 0.0, 1.0);
    return i;
  };
  double y = 0.0, x = 0.0, of_row = 0.0, of_cell = 0.0;
  const int r = pick(row_cdf_.data(), bands_of_gamma, u, y, of_row);
  const int s =
      pick(cell_cdf_.data() + static_cast<std::ptrdiff_t>(r) * sectors, sectors, v, x, of_cell);
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
