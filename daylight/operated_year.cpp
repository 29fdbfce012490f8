#include "daylight/operated_year.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "daylight/year_error.h"

namespace lightwell {
namespace {

// Hours that are visited together.
constexpr std::size_t hours_of_block = 512;

// Adds the light of a block, times the computation's weight in each hour, to the year.
void add_weighted(const HourBlock& block, std::size_t computation, Eigen::Index first,
                  OperatedYear& year) {
  for (std::size_t h = 0; h < block.hours.size(); ++h) {
    const auto from = static_cast<Eigen::Index>(h);
    const auto weight = static_cast<float>(
        year.plan.weight(computation, states_of_hour(year.states, first + from)));
    if (weight == 0.0f) continue;
    year.total.col(first + from) += weight * block.total.col(from);
    year.sunlight.col(first + from) += weight * block.sunlight.col(from);
  }
}

// Compares superposed light of all groups changed with its computation, in hours all over the year.
class SuperpositionCheck {
 public:
  SuperpositionCheck(std::span<const SkyHour> hours, int sensors, OperatedYear& year)
      : hours_(spread_over(hours)),
        superposed_(Eigen::ArrayXd::Zero(sensors)),
        computed_(Eigen::ArrayXd::Zero(sensors)) {
    if (year.plan.is_superposed) {
      year.all_changed = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(hours.size()));
    }
  }

  // Adds a block of a computation, whose hours begin with number `first` of the year's.
  void add(const HourBlock& block, std::size_t computation, Eigen::Index first,
           OperatedYear& year) {
    const std::size_t last = year.plan.computations.size() - 1;
    const double weight = year.plan.superposed_weight(computation, year.plan.computations[last]);
    for (std::size_t h = 0; h < block.hours.size(); ++h) {
      const auto column = static_cast<Eigen::Index>(h);
      const Eigen::ArrayXd light =
          (block.total.col(column) - block.sunlight.col(column)).cast<double>();
      if (computation == last) year.all_changed[first + column] = light.sum();
      if (!std::ranges::binary_search(hours_, block.hours[h].number, {}, &SkyHour::number))
        continue;
      superposed_ += weight * light;
      if (computation == last) computed_ += light;
    }
  }

  double error() const { return relative_difference(superposed_ - computed_, computed_); }

 private:
  std::vector<SkyHour> hours_;            // ascending
  Eigen::ArrayXd superposed_, computed_;  // lx, sums of the hours without sunlight, per sensor
};

// The model of the scene in other states, with the same sensors.
std::unique_ptr<DaylightModel> model_in_states(const Scene& scene, const DaylightModel& open,
                                               const OperatedWindows& windows,
                                               const WindowStates& states) {
  auto model = std::make_unique<DaylightModel>(scene_in_states(scene, windows, states),
                                               open.sky().up(), open.sky().north(), open.options());
  model->set_sensors(open.sensors());
  return model;
}

}  // namespace

double OperatedYear::error_of_hour(std::size_t hour) const {
  const auto h = static_cast<Eigen::Index>(hour);
  const WindowStates in_hour = states_of_hour(states, h);
  const auto computed = std::ranges::find(plan.computations, in_hour);
  if (computed != plan.computations.end()) {
    return errors[static_cast<std::size_t>(computed - plan.computations.begin())];
  }
  const double light = (total.col(h) - sunlight.col(h)).cast<double>().sum();
  const double share = light > all_changed[h] ? all_changed[h] / light : 1.0;
  return std::ranges::max(errors) + superposition * plan.changed_pairs(in_hour) * share;
}

double OperatedYear::error() const {
  double light = 0.0, uncertain = 0.0;
  for (Eigen::Index h = 0; h < total.cols(); ++h) {
    const double lux = (total.col(h) - sunlight.col(h)).cast<double>().max(0.0).sum();
    light += lux;
    uncertain += error_of_hour(static_cast<std::size_t>(h)) * lux;
  }
  return light > 0.0 ? uncertain / light : std::ranges::max(errors);
}

void OperatedYear::visit(std::span<const SkyHour> hours,
                         const std::function<void(const HourBlock&)>& visit) const {
  for (std::size_t first = 0; first < hours.size(); first += hours_of_block) {
    HourBlock block{.hours = hours.subspan(first, std::min(hours_of_block, hours.size() - first))};
    const auto begin = static_cast<Eigen::Index>(first),
               count = static_cast<Eigen::Index>(block.hours.size());
    // Superposed light may end a little below nothing.
    block.sunlight = sunlight.middleCols(begin, count).max(0.0f);
    block.total = total.middleCols(begin, count).max(block.sunlight);
    visit(block);
  }
}

OperatedYear operate_year(const Scene& scene, const DaylightModel& open,
                          const OperatedWindows& windows, const OperationTask& task,
                          const VisitYear& visit) {
  OperatedYear year{.states = operate_windows(open, windows, task)};
  year.plan = plan_computations(windows, year.states);
  const bool is_operated = !windows.groups.empty();
  if (is_operated) {
    year.total =
        Eigen::ArrayXXf::Zero(open.sensor_count(), static_cast<Eigen::Index>(task.hours.size()));
    year.sunlight = year.total;
  }
  SuperpositionCheck check(task.hours, open.sensor_count(), year);
  for (std::size_t c = 0; c < year.plan.computations.size(); ++c) {
    std::unique_ptr<DaylightModel> changed;
    if (c > 0) changed = model_in_states(scene, open, windows, year.plan.computations[c]);
    const DaylightModel& model = changed ? *changed : open;
    const SkyCoefficients sky = model.sky_coefficients().sum();
    if (c == 0) year.daylight_factor = daylight_factors(model, sky, task.ground_reflectance);
    year.errors.push_back(year_error(model, sky, task.hours, task.ground_reflectance));
    const ComputedYear computed{.number = c, .model = model, .error = year.errors.back()};
    Eigen::Index first = 0;
    simulate_year(model, sky, task.hours, task.ground_reflectance, [&](const HourBlock& block) {
      if (is_operated) add_weighted(block, c, first, year);
      if (year.plan.is_superposed) check.add(block, c, first, year);
      first += static_cast<Eigen::Index>(block.hours.size());
      visit(computed, block);
    });
  }
  if (year.plan.is_superposed) year.superposition = check.error();
  return year;
}

}  // namespace lightwell
