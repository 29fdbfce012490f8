#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "viewer/report/daylight_study.h"
#include "viewer/report/year_count.h"
#include "viewer/report/year_instant.h"

namespace lightwell {

/// A year of daylight that was gone through.
struct StudiedYear {
  YearReport report{};
  std::vector<SkyHour> hours{};  ///< with light
  std::vector<Probe> sensors{};  ///< of all rooms
  Eigen::ArrayXXi states{};      ///< of the windows, groups x hours
  MetricBounds bounds{};         ///< of YearReport::sensors
};

/// Notes on a year's weather, a sentence each. `hours` are those of sky_hours().
std::vector<std::string> weather_notes(const Weather& weather, const std::vector<SkyHour>& hours);

/// Goes through the hours of a year, those of sky_hours(), and fills in all measures. `see`, if not
/// empty, gets the light of all sensors of the model, in blocks and in order. Throws what
/// operate_year() throws.
StudiedYear study_year(const DaylightStudy& study, const StudiedModel& of,
                       std::vector<SkyHour> hours,
                       const std::function<void(const HourBlock&)>& see = {});

/// True if no daylight reaches any sensor, which the last of the notes says.
bool is_dark(const YearReport& report);

/// Sun and sky of an instant; `text` names it in messages. Throws InputError for one without light.
SkyHour sky_of_instant(const DaylightStudy& study, const ClockTime& when, const std::string& text);

/// The daylight of an instant, with the model of model_of_instants().
InstantReport study_instant(const DaylightStudy& study, const StudiedModel& of, const SkyHour& sky,
                            const std::string& text);

/// Files of write_year(), relative to their folder, and of write_instant_files().
std::vector<std::filesystem::path> year_files(const DaylightStudy& study);
std::vector<std::filesystem::path> instant_files();

/// Writes sensors.csv, hours.csv, year.html and year.json; glare.csv with eyes, rooms.csv with
/// ratings or rooms, and the folder `metrics` with sensor grids of a Honeybee model. Throws
/// std::runtime_error with the file and the reason.
void write_year(const std::filesystem::path& folder, const DaylightStudy& study,
                const StudiedYear& year);

/// Writes instant.csv and instant.html. Throws std::runtime_error with the file and the reason.
void write_instant_files(const std::filesystem::path& folder, std::span<const Probe> sensors,
                         const InstantReport& instant);

}  // namespace lightwell
