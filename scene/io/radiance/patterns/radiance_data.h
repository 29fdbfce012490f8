#pragma once

#include <filesystem>
#include <span>
#include <vector>

namespace lightwell {

/// A table of RADIANCE's brightdata: values over a grid of one to ten coordinates, linear between
/// the grid's points.
class RadianceData {
 public:
  /// Reads the number of coordinates, for each its beginning, end and number of points (or 0 0,
  /// number and points), and the values, the last coordinate fastest. Throws InputError naming file
  /// and line.
  explicit RadianceData(const std::filesystem::path& path);

  std::size_t dimensions() const { return axes_.size(); }
  /// Value at `coordinates`, one for each dimension. Beyond the grid the table continues linearly
  /// for one interval, and falls off harmonically from there.
  double at(std::span<const double> coordinates) const;

 private:
  struct Axis {
    std::vector<double> points{};  // strictly rising, after division by `direction`
    double direction = 1.0;        // -1: the file's points fall
  };
  double along(std::size_t axis, std::size_t first, std::span<const double> coordinates) const;

  std::vector<Axis> axes_{};
  std::vector<double> values_{};
};

}  // namespace lightwell
