#include "radiosity/refine/light_peaks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>
#include <variant>

#include "mesh/elements/quad_weights.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

std::vector<LightBound> bounds_of_all(const DirectLight& light) {
  std::vector<LightBound> bounds = bounds_of(light.emitters());
  const std::vector<LightBound> of_sources =
      bounds_of(light.free_sources(), static_cast<int>(light.emitters().size()));
  bounds.insert(bounds.end(), of_sources.begin(), of_sources.end());
  return bounds;
}

std::vector<Eigen::AlignedBox3d> boxes_of(const std::vector<LightBound>& bounds) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const LightBound& bound : bounds) boxes.push_back(bound.box);
  return boxes;
}

// The corners of a cell's side.
struct Corners {
  std::array<Vector3d, 4> at{};
  int count = 0;

  double longest_side() const {
    double longest = 0.0;
    for (int i = 0; i < count; ++i) {
      longest = std::max(longest, (at[(i + 1) % count] - at[i]).norm());
    }
    return longest;
  }
  Eigen::AlignedBox3d box() const {
    Eigen::AlignedBox3d box;
    for (int i = 0; i < count; ++i) box.extend(at[i]);
    return box;
  }
  Vector3d place(const Eigen::Vector4d& weights) const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < count; ++i) sum += weights[i] * at[i];
    return sum;
  }
  // Weights of the place of the cell that is about the nearest to a point of its plane.
  Eigen::Vector4d nearest(const Vector3d& point) const {
    const Vector3d x = at[1] - at[0], y = at[count - 1] - at[0];
    const Eigen::Vector2d ab = in_terms_of<Vector3d>(x, y, point - at[0]);
    if (count == 4) {
      const Eigen::Vector2d shape = in_terms_of<Vector3d>(x, y, at[2] - at[0]);
      const Eigen::Vector2d st = bilinear_coordinates(shape[0], shape[1], ab[0], ab[1], ab);
      return bilinear_weights(st.cwiseMax(0.0).cwiseMin(1.0)).cast<double>();
    }
    Eigen::Vector3d weights(1.0 - ab[0] - ab[1], ab[0], ab[1]);
    weights = weights.cwiseMax(0.0);
    weights /= weights.sum();
    return {weights[0], weights[1], weights[2], 0.0};
  }
};

}  // namespace

LightPeaks::LightPeaks(const DirectLight& direct_light)
    : direct_light_(direct_light), bounds_(bounds_of_all(direct_light)), tree_(boxes_of(bounds_)) {}

double LightPeaks::unoccluded(int light, const SurfacePoint& at) const {
  const auto& emitters = direct_light_.emitters();
  const auto number = static_cast<std::size_t>(light);
  if (number < emitters.size()) {
    return direct_light_.unoccluded_form_factor(emitters[number], at) *
           emitters[number].exitance.mean();
  }
  const FreeSource& source = direct_light_.free_sources()[number - emitters.size()];
  return unoccluded_kernel(source, at.position, at.normal) *
         light_towards(source, at.position).mean();
}

// The distance, m, below which rounding may have brought a lamp near to the surface.
double LightPeaks::clearance_of(int light) const {
  const auto number = static_cast<std::size_t>(light);
  const std::size_t emitters = direct_light_.emitters().size();
  if (number < emitters) return 0.0;
  const auto* lamp = std::get_if<LampLight>(&direct_light_.free_sources()[number - emitters].shape);
  return lamp ? lamp->clearance : 0.0;
}

std::vector<LightPeak> LightPeaks::of_cell(const RefinedElements& elements, int cell, int side,
                                           const Vector3d& normal, int facet) const {
  // At half the longest side L a vertex of the cell, which is no farther than sqrt(2) L / 4 from
  // the foot, has at least (3/2)^(-3/2), half, of the peak.
  constexpr double near = 0.5;
  // Peaks behind four stronger ones are found in the parts of the cell, if any of the four is
  // missed; if none is, the strongest may all be hidden, which the four are to make rare.
  constexpr std::size_t most_peaks = 4;
  Corners corners{.count = elements.corner_count(cell)};
  for (int i = 0; i < corners.count; ++i) {
    corners.at[i] = elements.position(elements.corner_vertex(cell, side, i));
  }
  const double reach = near * corners.longest_side();
  Eigen::AlignedBox3d box = corners.box();
  box.min().array() -= reach;
  box.max().array() += reach;
  std::vector<int> found;
  tree_.find_overlaps(box, found);
  std::vector<LightPeak> peaks;
  for (const int i : found) {
    const LightBound& bound = bounds_[static_cast<std::size_t>(i)];
    const Vector3d middle = bound.box.center();
    const Vector3d foot = middle - (middle - corners.at[0]).dot(normal) * normal;
    LightPeak peak{.weights = corners.nearest(foot)};
    const Vector3d place = corners.place(peak.weights);
    const double distance = std::max((middle - place).norm(), 0.5 * bound.box.sizes().norm());
    if (!(distance > clearance_of(bound.light)) || !(distance < reach)) continue;
    peak.light = unoccluded(bound.light, {.position = place, .normal = normal, .facet = facet});
    if (!(peak.light > 0.0)) continue;
    // The square of (1 + r^2 / d^2)^(-3/2) over the plane is that of an area pi d^2 / 2 at the
    // foot.
    peak.share = std::min(1.0, 0.5 * std::numbers::pi * distance * distance / elements.area(cell));
    peaks.push_back(peak);
  }
  std::ranges::sort(peaks,
                    [](const LightPeak& a, const LightPeak& b) { return a.light > b.light; });
  if (peaks.size() > most_peaks) peaks.resize(most_peaks);
  return peaks;
}

}  // namespace lightwell
