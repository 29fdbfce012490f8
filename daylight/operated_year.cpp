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

// Light of all groups changed by superposition, without sunlight, summed over some hours.
struct SuperpositionSum {
  std::vector<SkyHour> hours{};  // ascending
  Eigen::ArrayXd light{};        // lx, per sensor
};

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

// Adds the light of those hours of a block that are among `hours`, without sunlight.
void add_to_sum(const HourBlock& block, double weight, std::span<const SkyHour> hours,
                Eigen::ArrayXd& sum) {
  if (weight == 0.0) return;
  for (std::size_t h = 0; h < block.hours.size(); ++h) {
    if (!std::ranges::binary_search(hours, block.hours[h].number, {}, &SkyHour::number)) continue;
    const auto column = static_cast<Eigen::Index>(h);
    sum += weight * (block.total.col(column) - block.sunlight.col(column)).cast<double>();
  }
}

// The model of the scene in other states, with the same sensors.
std::unique_ptr<DaylightModel> model_in_states(const Scene& scene, const DaylightModel& open,
                                               const OperatedWindows& windows,
                                               const WindowStates& states) {
  auto model = std::make_unique<DaylightModel>(scene_in_states(scene, windows, states),
                                               open.sky().up(), open.sky().north(), open.options());
  model->set_sensors(open.sensors());
  return model;
}

// The difference of superposed light from that of a computation with all groups changed, relative
// to the light of the operated year in the same hours. In no hour is more superposed.
double superposition_error(const DaylightModel& check, const SuperpositionSum& superposed,
                           const OperationTask& task, const OperatedYear& year) {
  Eigen::ArrayXd light = Eigen::ArrayXd::Zero(check.sensor_count()), operated = light;
  simulate_year(check, check.sky_coefficients().sum(), superposed.hours, task.ground_reflectance,
                [&](const HourBlock& block) {
                  light += (block.total - block.sunlight).cast<double>().rowwise().sum();
                });
  year.visit(task.hours,
             [&](const HourBlock& block) { add_to_sum(block, 1.0, superposed.hours, operated); });
  return relative_difference(superposed.light - light, operated);
}

}  // namespace

double OperatedYear::error_of_hour(std::size_t hour) const {
  if (plan.is_superposed) return std::ranges::max(errors) + superposition;
  const auto computed =
      std::ranges::find(plan.computations, states_of_hour(states, static_cast<Eigen::Index>(hour)));
  return errors[static_cast<std::size_t>(computed - plan.computations.begin())];
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
  SuperpositionSum checked{.hours = spread_over(task.hours),
                           .light = Eigen::ArrayXd::Zero(open.sensor_count())};
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
      if (year.plan.is_superposed) {
        add_to_sum(block, year.plan.weight(c, year.plan.check), checked.hours, checked.light);
      }
      first += static_cast<Eigen::Index>(block.hours.size());
      visit(computed, block);
    });
  }
  if (year.plan.is_superposed) {
    const auto model = model_in_states(scene, open, windows, year.plan.check);
    year.superposition = superposition_error(*model, checked, task, year);
  }
  return year;
}

}  // namespace lightwell
