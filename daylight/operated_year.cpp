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

// Light without sunlight of a column, never below nothing.
Eigen::ArrayXd skylight_of(const Eigen::ArrayXXf& total, const Eigen::ArrayXXf& sunlight,
                           Eigen::Index column) {
  return (total.col(column) - sunlight.col(column)).cast<double>().max(0.0);
}

// Collects what the bounds of hours with operated windows need while the computations are made.
class HourBounds {
 public:
  HourBounds(const WindowPlan& plan, Eigen::Index sensors, Eigen::Index hours)
      : plan_(plan),
        light_(Eigen::ArrayXXd::Zero(hours, static_cast<Eigen::Index>(plan.computations.size()))) {
    if (plan.is_superposed) deviation_ = Eigen::ArrayXXf::Zero(sensors, hours);
  }

  // Adds a block of a computation, whose hours begin with number `first` of the year's.
  void add(const HourBlock& block, std::size_t computation, Eigen::Index first) {
    const bool is_last = computation + 1 == plan_.computations.size();
    const auto weight =
        is_last
            ? -1.0f
            : static_cast<float>(plan_.superposed_weight(computation, plan_.computations.back()));
    for (Eigen::Index h = 0; h < block.total.cols(); ++h) {
      light_(first + h, static_cast<Eigen::Index>(computation)) =
          skylight_of(block.total, block.sunlight, h).sum();
      if (!plan_.is_superposed) continue;
      deviation_.col(first + h) += weight * (block.total.col(h) - block.sunlight.col(h));
    }
  }

  // Bounds of all hours of the year, whose light is complete.
  std::vector<double> of_hours(const OperatedYear& year) const {
    std::vector<double> errors;
    for (Eigen::Index h = 0; h < light_.rows(); ++h) {
      const WindowStates states = states_of_hour(year.states, h);
      const auto computed = std::ranges::find(plan_.computations, states);
      errors.push_back(
          computed == plan_.computations.end()
              ? of_superposed(year, states, h)
              : year.errors[static_cast<std::size_t>(computed - plan_.computations.begin())]);
    }
    return errors;
  }

  // See OperatedYear::superposition.
  double superposition() const {
    const double open = light_.col(0).sum();
    if (!plan_.is_superposed || !(open > 0.0)) return 0.0;
    double sum = 0.0;
    for (Eigen::Index h = 0; h < light_.rows(); ++h) {
      sum += std::sqrt(deviation_.col(h).cast<double>().square().mean());
    }
    return sum * static_cast<double>(deviation_.rows()) / open;
  }

 private:
  double of_superposed(const OperatedYear& year, const WindowStates& states,
                       Eigen::Index hour) const {
    const Eigen::ArrayXd light = skylight_of(year.total, year.sunlight, hour);
    if (!(light.sum() > 0.0)) return 1.0;
    double squares = 0.0;  // lx^2
    for (std::size_t c = 0; c < year.errors.size(); ++c) {
      const double part =
          plan_.weight(c, states) * year.errors[c] * light_(hour, static_cast<Eigen::Index>(c));
      squares += part * part;
    }
    return std::sqrt(squares) / light.sum() +
           relative_difference(deviation_.col(hour).cast<double>(), light);
  }

  const WindowPlan& plan_;
  Eigen::ArrayXXd light_;        // lx, sum over sensors, hours x computations
  Eigen::ArrayXXf deviation_{};  // lx, superposed less computed with all changed, sensors x hours
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

double OperatedYear::error() const {
  double light = 0.0, uncertain = 0.0;
  for (Eigen::Index h = 0; h < total.cols(); ++h) {
    const double lux = skylight_of(total, sunlight, h).sum();
    light += lux;
    uncertain += hour_errors[static_cast<std::size_t>(h)] * lux;
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
  HourBounds bounds(year.plan, open.sensor_count(), year.total.cols());
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
      if (is_operated) {
        add_weighted(block, c, first, year);
        bounds.add(block, c, first);
      }
      first += static_cast<Eigen::Index>(block.hours.size());
      visit(computed, block);
    });
  }
  if (is_operated) {
    year.hour_errors = bounds.of_hours(year);
    year.superposition = bounds.superposition();
  }
  return year;
}

}  // namespace lightwell
