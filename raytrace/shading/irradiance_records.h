#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "scene/bands.h"

namespace lightwell {

/// A place at which indirect light was gathered.
struct IrradianceRecord {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< shading normal, unit
  double radius = 0.0;                                 ///< m, > 0, within which the record serves
  Spectrum irradiance{};                               ///< W/m^2
  double variance = 0.0;  ///< of the noise of the irradiance, mean of the bands, (W/m^2)^2
};

/// The box around all that a record serves.
BoxTree::Box reach(const IrradianceRecord& record);

/// Weight of a record at a point, [0,1]: 1 - max(distance / radius, sqrt((1 - cos) / (1 - cos 15
/// degrees))) with the angle between the normals (Tabellion & Lamorlette 2004). 0 at points a fifth
/// of the radius or more above or below the plane of the record: another surface.
double record_weight(const IrradianceRecord& record, const Eigen::Vector3d& position,
                     const Eigen::Vector3d& normal);

/// Limits of the radii of records by records around. The distance to the nearest surfaces grows by
/// no more than the way that one goes, and so do radii that are a share of such a distance. A place
/// in the open whose rays miss a house far away has a radius that reaches into the house; the
/// places seen there say so (neighbour clamping; Křivánek, Bouatouch, Pattanaik & Žára 2006).
class RecordNeighbours {
 public:
  /// `growth` is the most by which a radius may grow for each metre, > 0.
  RecordNeighbours(std::vector<IrradianceRecord> records, double growth);

  /// The radius of a record, m, or less: R_i + growth d_i at most, for each record i of the radius
  /// R_i that the record would serve, d_i away.
  double allowed_radius(const IrradianceRecord& record) const;

 private:
  std::vector<IrradianceRecord> records_;
  double growth_;
  BoxTree places_;
};

/// Irradiance that a plane through records tells.
struct RecordFit {
  Spectrum irradiance{};  ///< W/m^2
  /// Standard error by the noise of the records, W/m^2, mean of the bands.
  double error = 0.0;
  double variance = 0.0;  ///< mean variance of the records, (W/m^2)^2
  double spread = 0.0;    ///< RMS by which the records differ from the plane, W/m^2
  int count = 0;          ///< of records
};

/// Irradiance between records, as in irradiance caching (Ward, Rubinstein & Clear 1988), with a
/// local linear fit (Cleveland 1979) in the place of gradients: at a point, E is the value of the
/// plane over the tangent plane that fits the records around best. The fit evens out their noise
/// and follows light that falls off evenly, to the edge of a surface too.
class IrradianceRecords {
 public:
  /// Relative error of light between records of 256 rays, about their noise, which neighbours even
  /// out.
  static constexpr double usual_error = 0.03;

  /// Records serve within `widening` times their radius.
  explicit IrradianceRecords(std::vector<IrradianceRecord> records, double widening = 1.0);

  /// E at a point with a shading normal, within the range of the records around; empty where no
  /// record serves. Record number `left_out` does not count.
  std::optional<RecordFit> fit(const Eigen::Vector3d& position, const Eigen::Vector3d& normal,
                               int left_out = -1) const;
  /// The largest weight of a record at a point; 0: none serves.
  double coverage(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const;

 private:
  std::vector<IrradianceRecord> records_;
  BoxTree tree_;
};

/// Evens out the noise of records: each gets the value of the widest fit, up to four times its
/// radius, that agrees with the narrower one, and the narrowest one with the record itself, within
/// three standard errors (after Lepski 1991). The variance of each record, relative to its light,
/// is first set to the mean of those around, up to four times the radius. Light that changes near
/// by keeps its shape, and even walls lose their mottle. A record that differs from its neighbours
/// while they agree with each other counts as noise: what a single record tells is narrower than
/// records can show.
void even_out(std::vector<IrradianceRecord>& records);

}  // namespace lightwell
