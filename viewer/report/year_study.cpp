#include "viewer/report/year_study.h"

#include <fmt/format.h>

#include <utility>

#include "daylight/glare_of_year.h"
#include "daylight/operated_year.h"
#include "scene/errors.h"
#include "scene/sun_position.h"

namespace lightwell {
namespace {

// Hours of each group of windows in its states.
std::vector<YearWindows> hours_in_states(const OperatedWindows& windows,
                                         const Eigen::ArrayXXi& states,
                                         std::span<const SkyHour> hours,
                                         const Occupancy& occupancy) {
  std::vector<YearWindows> all;
  for (std::size_t g = 0; g < windows.groups.size(); ++g) {
    const WindowGroup& group = windows.groups[g];
    YearWindows of_group{.name = group.name, .operation = operation_text(group)};
    for (const WindowState& state : group.states) of_group.states.push_back({.name = state.name});
    for (std::size_t h = 0; h < hours.size(); ++h) {
      const int state = states(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(h));
      YearWindows::State& in_state = of_group.states[static_cast<std::size_t>(state)];
      ++in_state.hours;
      if (occupancy.holds(hours[h].number)) ++in_state.occupied_hours;
    }
    all.push_back(std::move(of_group));
  }
  return all;
}

std::vector<std::string> conventions_of_year(const DaylightStudy& study, const SkyPatches& sky) {
  std::vector<std::string> sentences = {
      "An hour has the mean irradiances of the weather file; the sun stands where it is in the "
      "middle of the hour, standard time, without refraction (Michalsky 1988).",
      fmt::format("Dates are those of {}, since a typical year is put together from several.",
                  study.weather.is_leap_year ? "the leap year 2016" : "2017")};
  const std::vector<std::string> more = daylight_conventions(study, sky);
  sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

std::vector<std::string> conventions_of_instant(const DaylightStudy& study, const SkyPatches& sky) {
  std::vector<std::string> sentences = {
      "Sun and dome have the mean irradiances of the weather file's hour that holds the instant; "
      "the sun stands where it is at the instant, standard time, without refraction (Michalsky "
      "1988)."};
  if (!study.windows.groups.empty()) {
    sentences.emplace_back(
        "Blinds that close and open by their illuminance are taken as open before.");
  }
  const std::vector<std::string> more = daylight_conventions(study, sky);
  sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

// Counts of everything that a report of the year has.
class YearCounts {
 public:
  YearCounts(const DaylightStudy& study, const StudiedModel& of, std::span<const SkyHour> hours,
             const std::function<void(const HourBlock&)>& see, YearReport& made)
      : study_(study),
        see_(see),
        made_(made),
        is_operated_(!study.windows.groups.empty()),
        count_(hours, sensors_of(of), made),
        operated_(hours, sensors_of(of), made),
        glare_(study.eyes, sensors_of(of), hours, study.ground_reflectance) {}

  // Takes a block of a computation.
  void add(const ComputedYear& computed, const HourBlock& block) {
    if (computed.number == computations_) {
      ++computations_;
      if (!study_.eyes.empty()) glare_.add_computation(computed.model);
    }
    if (is_operated_) return operated_.add(computed, block);
    made_.error = computed.error;
    take(block, std::vector<double>(block.hours.size(), computed.error));
  }

  // Fills in the report once all computations are made, and returns the bounds of sensors.
  MetricBounds finish(const OperatedYear& year, std::span<const SkyHour> hours) {
    made_.daylight_factor = year.daylight_factor;
    if (!is_operated_) return finish_glare(year, count_.finish(nullptr));
    made_.error = year.error();
    take_operated(year, hours);
    const Eigen::ArrayXd open_sun_hours = operated_.open_sun_hours();
    MetricBounds bounds = count_.finish(&open_sun_hours);
    made_.windows = hours_in_states(study_.windows, year.states, hours, made_.occupancy);
    made_.states = operated_.years(year, study_.windows);
    made_.is_superposed = year.plan.is_superposed;
    made_.superposition = year.superposition;
    return finish_glare(year, std::move(bounds));
  }

 private:
  static int sensors_of(const StudiedModel& of) {
    return static_cast<int>(of.sensors.probes.size());
  }

  // Takes a block of the year's own light, with the bound of each hour.
  void take(const HourBlock& block, const std::vector<double>& errors) {
    count_.add(block, errors);
    glare_.add_light(block);
    if (see_) see_(block);
  }

  // Takes the year that is put together from the computations.
  void take_operated(const OperatedYear& year, std::span<const SkyHour> hours) {
    std::ptrdiff_t first = 0;
    year.visit(hours, [&](const HourBlock& block) {
      const auto begin = year.hour_errors.begin() + first;
      first += static_cast<std::ptrdiff_t>(block.hours.size());
      take(block, {begin, year.hour_errors.begin() + first});
    });
  }

  MetricBounds finish_glare(const OperatedYear& year, MetricBounds bounds) {
    made_.glare = glare_.finish(year.plan, year.states, made_.occupancy, occupied_hours_of(made_));
    return bounds;
  }

  const DaylightStudy& study_;
  const std::function<void(const HourBlock&)>& see_;
  YearReport& made_;
  bool is_operated_;
  YearCount count_;
  OperatedCount operated_;
  GlareCount glare_;
  std::size_t computations_ = 0;
};

}  // namespace

std::vector<std::string> weather_notes(const Weather& weather, const std::vector<SkyHour>& hours) {
  std::vector<std::string> notes = weather.notes;
  const std::string dark = note_on_dark_hours(weather, hours);
  if (!dark.empty()) notes.push_back(dark);
  return notes;
}

bool is_dark(const YearReport& report) {
  return !(report.daylight_factor > 0.0f).any();
}

StudiedYear study_year(const DaylightStudy& study, const StudiedModel& of,
                       std::vector<SkyHour> hours,
                       const std::function<void(const HourBlock&)>& see) {
  StudiedYear made{.report = daylight_report(study, weather_notes(study.weather, hours)),
                   .hours = std::move(hours),
                   .sensors = of.sensors.probes};
  const DaylightModel& model = *of.model;
  YearReport& report = made.report;
  report.conventions = conventions_of_year(study, model.sky());
  report.rooms = of.sensors.rooms;
  for (const SkyHour& hour : made.hours) report.hour_numbers.push_back(hour.number);
  const std::vector<SensorRange> ranges = of.sensors.ranges();
  YearCounts counts(study, of, made.hours, see, report);
  OperatedYear year = operate_year(
      study.scene, model, study.windows,
      {.hours = made.hours,
       .is_leap_year = study.weather.is_leap_year,
       .ground_reflectance = study.ground_reflectance,
       .rooms = ranges},
      [&](const ComputedYear& computed, const HourBlock& block) { counts.add(computed, block); });
  made.bounds = counts.finish(year, made.hours);
  made.states = std::move(year.states);
  if (is_dark(report)) {
    report.notes.emplace_back(
        "No daylight reaches any sensor: the scene has no opening, or its windows are opaque.");
  }
  if (!study.sun_points.empty()) {
    report.exposure =
        YearExposure{.day = study.sun_day,
                     .points = study.sun_points,
                     .hours = sun_exposure(model, study.weather, study.sun_points, study.sun_day)};
  }
  return made;
}

SkyHour sky_of_instant(const DaylightStudy& study, const ClockTime& when, const std::string& text) {
  const auto sky = sky_instant(study.weather, when, study.up, study.north);
  if (!sky) {
    throw InputError(fmt::format(
        "{}: at {} standard time the sun is below the horizon, or the weather has no light; give "
        "another time",
        study.weather.file.string(), text));
  }
  return *sky;
}

InstantReport study_instant(const DaylightStudy& study, const StudiedModel& of, const SkyHour& sky,
                            const std::string& text) {
  InstantReport made{.of = daylight_report(study, study.weather.notes), .when = text, .sky = sky};
  made.of.conventions = conventions_of_instant(study, of.model->sky());
  made.of.rooms = of.sensors.rooms;
  const std::vector<SensorRange> ranges = of.sensors.ranges();
  const OperatedYear year = operate_year(study.scene, *of.model, study.windows,
                                         {.hours = {&sky, 1},
                                          .is_leap_year = study.weather.is_leap_year,
                                          .ground_reflectance = study.ground_reflectance,
                                          .rooms = ranges},
                                         [&](const ComputedYear&, const HourBlock& block) {
                                           made.total = block.total.col(0);
                                           made.sunlight = block.sunlight.col(0);
                                         });
  // Computed last are the states of the instant.
  made.of.error = year.errors.back();
  made.states = states_text(study.windows, year.plan.computations.back());
  return made;
}

}  // namespace lightwell
