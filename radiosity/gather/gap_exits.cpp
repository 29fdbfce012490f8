#include "radiosity/gather/gap_exits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

constexpr double whole_turn = 2.0 * std::numbers::pi;
// Share of the directions that is drawn in all cells alike, so that no exit is left out.
constexpr double in_all_cells = 0.5;
// Least ln T: a gap is much wider than it is high.
constexpr double least_log_reach = 1.5;

}  // namespace

GapExits::GapExits(const SurfacePoint& at, double width, double reach)
    : across_(at.normal),
      width_(width),
      log_reach_(std::max(std::log(reach / width), least_log_reach)) {
  tangent_frame(at.normal, a_, b_);
  constexpr int cells = side * side;
  for (int cell = 0; cell < cells; ++cell) cell_up_to_.push_back((cell + 1.0) / cells);
}

GapExits::GapExits(const ElementCaster& caster, const SurfacePoint& at, double width, double reach,
                   std::uint64_t key, const IsOut& is_out)
    : GapExits(at, width, reach) {
  const int cells = side * side;
  std::vector<Ray> rays(static_cast<std::size_t>(cells));
  std::vector<ElementHit> hits(rays.size());
  for (int cell = 0; cell < cells; ++cell) {
    const auto number = [&](std::uint64_t i) {
      return random_uniform(random_key(key, static_cast<std::uint64_t>(cell), i));
    };
    rays[static_cast<std::size_t>(cell)] = {
        .origin = at.position,
        .direction = direction_at(at.normal, (cell / side + number(1)) / side,
                                  (cell % side + number(2)) / side),
        .origin_group = at.facet};
  }
  caster.closest_hits(rays, hits);
  std::vector<double> weight(rays.size(), 0.0);
  double out = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!is_out(rays[i], hits[i])) continue;
    const double cosine = rays[i].direction.dot(at.normal);
    weight[i] = cosine * std::numbers::inv_pi / even_density(cosine);
    out += weight[i];
  }
  is_closed_ = !(out > 0.0);
  if (is_closed_) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    sum += in_all_cells / cells + (1.0 - in_all_cells) * weight[i] / out;
    cell_up_to_[i] = sum;
  }
  cell_up_to_.back() = 1.0;
}

// Density of directions that are even in their coordinates.
double GapExits::even_density(double cosine) const {
  const double C = 1.0 / (log_reach_ + 0.5), sine2 = std::max(1.0 - cosine * cosine, 0.5);
  const double T2 = std::exp(2.0 * log_reach_);
  return sine2 < T2 * cosine * cosine ? C / (whole_turn * cosine * sine2)
                                      : C * T2 * cosine / (whole_turn * sine2 * sine2);
}

Eigen::Matrix<double, 3, 2> GapExits::frame(const Eigen::Vector3d& normal) const {
  const Eigen::Vector3d a = (a_ - a_.dot(normal) * normal).normalized(), b = normal.cross(a);
  Eigen::Matrix<double, 3, 2> axes;
  axes << a, (b.dot(b_) < 0.0 ? Eigen::Vector3d(-b) : b);
  return axes;
}

Eigen::Vector3d GapExits::direction_at(const Eigen::Vector3d& normal, double s, double turn) const {
  // The running sum of q over tan is C ln tan up to T, and C (ln T + (1 - T^2 / tan^2) / 2) beyond.
  constexpr double least = 1e-12;  // of T^2 / tan^2: no direction lies in the surface
  const double sum = s * (log_reach_ + 0.5), beyond = std::max(sum - log_reach_, 0.0);
  const double tan =
      std::exp(std::min(sum, log_reach_)) / std::sqrt(std::max(1.0 - 2.0 * beyond, least));
  const double cosine = 1.0 / std::hypot(1.0, tan), phi = whole_turn * turn;
  return cosine * (tan * (frame(normal) * Eigen::Vector2d(std::cos(phi), std::sin(phi))) + normal);
}

Eigen::Array2d GapExits::coordinates(const Eigen::Vector3d& normal,
                                     const Eigen::Vector3d& direction) const {
  const double cosine = direction.dot(normal);
  const Eigen::Vector2d in_plane = frame(normal).transpose() * direction;
  const double sine = in_plane.norm();
  if (!(cosine > 0.0) || !(sine > cosine)) return {-1.0, 0.0};
  const double log_tan = std::log(sine / cosine), beyond = std::max(log_tan - log_reach_, 0.0);
  const double sum = std::min(log_tan, log_reach_) + 0.5 * (1.0 - std::exp(-2.0 * beyond));
  const double turn = std::atan2(in_plane.y(), in_plane.x()) / whole_turn;
  return {sum / (log_reach_ + 0.5), turn < 0.0 ? turn + 1.0 : turn};
}

Eigen::Vector3d GapExits::draw(const Eigen::Vector3d& normal, double u, double v,
                               double which) const {
  const auto found = std::upper_bound(cell_up_to_.begin(), cell_up_to_.end() - 1, which);
  const auto cell = static_cast<int>(found - cell_up_to_.begin());
  return direction_at(normal, (cell / side + u) / side, (cell % side + v) / side);
}

double GapExits::density(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) const {
  const Eigen::Array2d at = coordinates(normal, direction);
  if (!(at[0] >= 0.0)) return 0.0;
  const int row = std::min(static_cast<int>(at[0] * side), side - 1),
            column = std::min(static_cast<int>(at[1] * side), side - 1);
  const auto cell = static_cast<std::size_t>(row * side + column);
  const double chance = cell_up_to_[cell] - (cell > 0 ? cell_up_to_[cell - 1] : 0.0);
  return chance * (side * side) * even_density(direction.dot(normal));
}

}  // namespace lightwell
