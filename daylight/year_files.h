#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <vector>

#include "daylight/annual_metrics.h"
#include "daylight/daylight_glare.h"
#include "raytrace/readings/probe.h"
#include "scene/atomic_file.h"
#include "scene/io/window_states.h"

namespace lightwell {

/// Writes a NumPy file (.npy, format 1.0) of 32-bit floats, rows x columns, as rows become known:
/// `numpy.load(file, mmap_mode="r")` reads single rows of files that are larger than memory.
class NumpyRows {
 public:
  /// Throws std::runtime_error with the file and the reason if the file cannot be made.
  NumpyRows(const std::filesystem::path& file, int columns);

  /// Appends a row for each column of `values`, whose rows are the file's columns.
  void append(const Eigen::ArrayXXf& values);
  /// Completes the file; throws std::runtime_error with the file and the reason.
  void commit();

 private:
  void write_header();

  AtomicStream file_;
  int columns_ = 0;
  std::int64_t rows_ = 0;
};

/// Light of every hour and sensor: illuminance.npy and sunlight.npy in a folder, hours x sensors,
/// lx.
class HourlyFiles {
 public:
  /// Files of the first `sensors` of each block. Throws as NumpyRows does.
  HourlyFiles(const std::filesystem::path& folder, int sensors);

  void append(const HourBlock& block);
  void commit();

 private:
  int sensors_;
  NumpyRows total_, sunlight_;
};

/// Writes a line for each sensor: x,y,z,nx,ny,nz in file units, the measures of SensorMetrics and
/// the daylight factor DF, %. Throws std::runtime_error with the file and the reason.
void write_sensors(const std::filesystem::path& csv, std::span<const Probe> sensors,
                   const SensorMetrics& metrics, const Eigen::ArrayXf& daylight_factor,
                   double metres_per_unit);

/// Hours with light, and the states of operated windows in them.
struct HourTable {
  std::span<const SkyHour> hours{};
  bool is_leap_year = false;
  const OperatedWindows& windows;
  const Eigen::ArrayXXi& states;  ///< groups x hours
};

/// Writes a line for each hour with light: its number, month, day, standard time of its middle, the
/// sun's altitude and azimuth in degrees, lux across the sun's rays and of the dome on open ground,
/// and the state of each group of windows.
void write_hours(const std::filesystem::path& csv, const HourTable& table);

/// Writes a line for each hour with light: its number, and lux and DGP of each eye.
void write_glare(const std::filesystem::path& csv, std::span<const SkyHour> hours,
                 std::span<const GlareOfYear> eyes);

/// Writes a line for each sensor: x,y,z,nx,ny,nz in file units, lux, and lux straight from the sun.
void write_instant(const std::filesystem::path& csv, std::span<const Probe> sensors,
                   const Eigen::ArrayXf& total, const Eigen::ArrayXf& sunlight,
                   double metres_per_unit);

}  // namespace lightwell
