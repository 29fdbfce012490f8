#include "raytrace/shading/irradiance_records.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

BoxTree tree_of(const std::vector<IrradianceRecord>& records) {
  std::vector<BoxTree::Box> boxes;
  boxes.reserve(records.size());
  for (const IrradianceRecord& record : records) boxes.push_back(reach(record));
  return BoxTree(std::move(boxes));
}

BoxTree places_of(const std::vector<IrradianceRecord>& records) {
  std::vector<BoxTree::Box> boxes;
  boxes.reserve(records.size());
  for (const IrradianceRecord& record : records) {
    boxes.emplace_back(record.position, record.position);
  }
  return BoxTree(std::move(boxes));
}

std::vector<IrradianceRecord> widened(std::vector<IrradianceRecord> records, double widening) {
  for (IrradianceRecord& record : records) record.radius *= widening;
  return records;
}

// Calls visit(number, weight) for the records that serve at a point.
template <class Visit>
void for_each_around(const BoxTree& tree, const std::vector<IrradianceRecord>& records,
                     const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                     Visit&& visit) {
  thread_local std::vector<int> found;
  tree.find_overlaps(BoxTree::Box(position, position), found);
  for (const int i : found) {
    const IrradianceRecord& record = records[static_cast<std::size_t>(i)];
    const double weight = record_weight(record, position, normal);
    if (weight > 0.0) visit(i, weight);
  }
}

}  // namespace

BoxTree::Box reach(const IrradianceRecord& record) {
  const Eigen::Vector3d radius = Eigen::Vector3d::Constant(record.radius);
  return {record.position - radius, record.position + radius};
}

double record_weight(const IrradianceRecord& record, const Eigen::Vector3d& position,
                     const Eigen::Vector3d& normal) {
  // 1 - cos 15 degrees: light from aside, the most sensitive, changes by a quarter.
  constexpr double widest_turn = 0.034074;
  // Less than a step of a stair and more than a facet's distance from the curve that it stands for:
  // an arc of one radius at 15 degrees rises 0.13 of it.
  constexpr double highest = 0.2;
  const Eigen::Vector3d way = position - record.position;
  const double apart = way.norm() / record.radius;
  const double turned = std::sqrt(std::max(0.0, 1.0 - normal.dot(record.normal)) / widest_turn);
  if (!(apart < 1.0) || !(turned < 1.0)) return 0.0;
  const double height = 0.5 * std::abs(way.dot(normal + record.normal));
  if (height > highest * record.radius) return 0.0;
  return 1.0 - std::max(apart, turned);
}

RecordNeighbours::RecordNeighbours(std::vector<IrradianceRecord> records, double growth)
    : records_(std::move(records)), growth_(growth), places_(places_of(records_)) {}

double RecordNeighbours::allowed_radius(const IrradianceRecord& record) const {
  thread_local std::vector<int> found;
  places_.find_overlaps(reach(record), found);
  double radius = record.radius;
  for (const int i : found) {
    const IrradianceRecord& other = records_[static_cast<std::size_t>(i)];
    if (!(record_weight(record, other.position, other.normal) > 0.0)) continue;
    const double distance = (other.position - record.position).norm();
    radius = std::min(radius, other.radius + growth_ * distance);
  }
  return radius;
}

IrradianceRecords::IrradianceRecords(std::vector<IrradianceRecord> records, double widening)
    : records_(widened(std::move(records), widening)), tree_(tree_of(records_)) {}

double IrradianceRecords::coverage(const Eigen::Vector3d& position,
                                   const Eigen::Vector3d& normal) const {
  double most = 0.0;
  for_each_around(tree_, records_, position, normal,
                  [&](int, double weight) { most = std::max(most, weight); });
  return most;
}

// Least squares of E_i - c - g . d_i with the weights of the records, where d_i is the way from the
// point to record i along the surface, over its radius. Ridge regression keeps the slope g small
// where few records tell it; ten times the ridge changes the error of a furnished room's picture by
// a hundredth of itself.
std::optional<RecordFit> IrradianceRecords::fit(const Eigen::Vector3d& position,
                                                const Eigen::Vector3d& normal, int left_out) const {
  constexpr double ridge = 0.03;
  Eigen::Vector3d along, across;
  tangent_frame(normal, along, across);
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Array<double, 3, Eigen::Dynamic> b;
  Eigen::Vector3d b_mean = Eigen::Vector3d::Zero();  // of the mean of the bands
  int count = 0;
  double square = 0.0, weights2 = 0.0, variance = 0.0;
  Spectrum least, most;
  for_each_around(tree_, records_, position, normal, [&](int i, double weight) {
    if (i == left_out) return;
    const IrradianceRecord& record = records_[static_cast<std::size_t>(i)];
    const Spectrum& E = record.irradiance;
    if (b.size() == 0) {
      b.setZero(3, E.size());
      least = most = E;
    }
    least = least.min(E);
    most = most.max(E);
    const Eigen::Vector3d way = (record.position - position) / record.radius;
    const Eigen::Vector3d row(1.0, way.dot(along), way.dot(across));
    A += weight * row * row.transpose();
    b += weight * (row * E.matrix().transpose().cast<double>()).array();
    const auto mean = static_cast<double>(E.mean());
    b_mean += weight * mean * row;
    square += weight * mean * mean;
    weights2 += weight * weight;
    ++count;
    variance += weight * record.variance;
  });
  if (b.size() == 0) return std::nullopt;
  const double sum = A(0, 0);
  A(1, 1) += ridge * sum;
  A(2, 2) += ridge * sum;
  const Eigen::Matrix3d inverse = A.inverse();
  const Eigen::RowVectorXd value = inverse.row(0) * b.matrix();
  // Sum of w (E_i - plane)^2, but for the ridge: sum w E^2 - b . x.
  const double left = std::max(0.0, square - b_mean.dot(inverse * b_mean)) / sum;
  variance /= sum;
  return RecordFit{Spectrum(value.transpose().array().cast<float>()).max(least).min(most),
                   std::sqrt(variance * weights2) / sum, variance, std::sqrt(left), count};
}

namespace {

// True if record number `i` differs from its neighbours far more than they differ from each other.
bool is_alone(const IrradianceRecords& known, const std::vector<IrradianceRecord>& records, int i) {
  constexpr int fewest = 5;  // three lie in a plane by themselves
  constexpr double times = 3.0;
  const IrradianceRecord& record = records[static_cast<std::size_t>(i)];
  const auto others = known.fit(record.position, record.normal, i);
  if (!others || others->count < fewest) return false;
  const auto difference =
      static_cast<double>(std::abs(others->irradiance.mean() - record.irradiance.mean()));
  return difference > times * others->spread;
}

}  // namespace

namespace {

constexpr int records_together = 16;  // that a thread takes at a time

// Variances of records by the relative variances of all around, within four times the radius: two
// halves of a gather tell the noise badly, and relative noise is alike among neighbours.
void pool_variances(std::vector<IrradianceRecord>& records) {
  constexpr double widening = 4.0;
  const std::vector<IrradianceRecord> wide = widened(records, widening);
  const BoxTree tree = tree_of(wide);
  parallel_for(static_cast<int>(records.size()), records_together, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      IrradianceRecord& record = records[static_cast<std::size_t>(i)];
      double weights = 0.0, variance = 0.0;
      for_each_around(tree, wide, record.position, record.normal, [&](int j, double weight) {
        const IrradianceRecord& other = wide[static_cast<std::size_t>(j)];
        const double E = other.irradiance.mean();
        if (!(E > 0.0)) return;
        weights += weight;
        variance += weight * other.variance / (E * E);
      });
      if (weights > 0.0) {
        record.variance = variance / weights * std::pow(double{record.irradiance.mean()}, 2);
      }
    }
  });
}

}  // namespace

void even_out(std::vector<IrradianceRecord>& records) {
  constexpr double deviations = 3.0;
  // The value of each record so far, its standard error, and whether wider fits agree.
  struct State {
    Spectrum irradiance{};
    double error = 0.0;
    bool is_even = true;
  };
  std::vector<State> states;
  for (const IrradianceRecord& record : records) states.push_back({record.irradiance});
  pool_variances(records);
  for (const double widening : {1.0, 2.0, 4.0}) {
    const IrradianceRecords known(records, widening);
    parallel_for(static_cast<int>(records.size()), records_together, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const IrradianceRecord& record = records[static_cast<std::size_t>(i)];
        State& state = states[static_cast<std::size_t>(i)];
        if (!state.is_even) continue;
        const auto fit = known.fit(record.position, record.normal);
        if (!fit) continue;
        if (widening == 1.0) state.error = std::sqrt(std::max(record.variance, fit->variance));
        const auto change =
            static_cast<double>(std::abs(fit->irradiance.mean() - state.irradiance.mean()));
        state.is_even = change <= deviations * state.error || is_alone(known, records, i);
        if (state.is_even) state = {fit->irradiance, fit->error};
      }
    });
  }
  for (std::size_t i = 0; i < records.size(); ++i) records[i].irradiance = states[i].irradiance;
}

}  // namespace lightwell
