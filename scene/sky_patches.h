#pragma once

#include <Eigen/Core>
#include <vector>

namespace lightwell {

/// The sphere of directions cut into sky patches, each of even luminance: Tregenza's 145 patches of
/// the dome (Tregenza 1987, "Subdivision of the sky hemisphere for luminance measurements"), or
/// Reinhart's finer ones (144 m^2 + 1). The ground below the horizon is a source of its own.
///
/// Rays are spread over *cells*: the patches of the dome, and as many below the horizon. Light has
/// a *column* for each patch of the dome, and a last one for the ground, to which all cells below
/// the horizon belong.
///
/// Patches lie in rows of equal height, from the horizon upwards. The first patch of a row is
/// centred on north, and the others follow clockwise as seen from above. The last patch is the cap
/// about the zenith.
class SkyPatches {
 public:
  /// `subdivision` is m, 1 to 8. `up` and `north` are unit and perpendicular. Throws
  /// std::invalid_argument for another m.
  SkyPatches(int subdivision, const Eigen::Vector3d& up, const Eigen::Vector3d& north);

  int dome_count() const { return static_cast<int>(cells_.size()) / 2; }
  int cell_count() const { return static_cast<int>(cells_.size()); }
  int column_count() const { return dome_count() + 1; }
  int ground_column() const { return dome_count(); }
  int column_of(int cell) const { return cell < dome_count() ? cell : ground_column(); }

  /// Row of a cell, from 0 at the horizon upwards or downwards.
  int row_of(int cell) const {
    const int row = cells_[static_cast<std::size_t>(cell)].row;
    return row < 0 ? -1 - row : row;
  }

  const Eigen::Vector3d& up() const { return up_; }
  const Eigen::Vector3d& north() const { return north_; }

  /// The cell that holds a unit direction.
  int cell_of(const Eigen::Vector3d& direction) const;
  /// The unit direction of a point (u, v) of a cell in [0,1]^2, even in solid angle.
  Eigen::Vector3d direction(int cell, double u, double v) const;
  double solid_angle(int cell) const;  ///< sr
  /// The unit direction to the middle of a cell; of a cap, the vertical.
  Eigen::Vector3d middle(int cell) const { return middles_.row(cell); }
  /// The cells that touch a cell, at corners too.
  const std::vector<int>& neighbours(int cell) const {
    return neighbours_[static_cast<std::size_t>(cell)];
  }
  /// The irradiance that each cell of radiance 1 gives an unobstructed point: int cos dw over its
  /// part above the horizon of a unit normal, sr. Exact but for cells within reach of the horizon,
  /// whose error is about 1e-3 of a cell in full view.
  Eigen::ArrayXd irradiances(const Eigen::Vector3d& normal) const;

 private:
  // A cell between two sines of altitude and two azimuths, which are in turns from north.
  struct Cell {
    int row = 0;
    double low = 0.0, high = 0.0;
    double begin = 0.0, width = 1.0;
  };
  void add_row(int row, int count, double low, double high);
  void find_neighbours();
  void find_sums();
  Eigen::Vector3d direction(const Cell& cell, double u, double v) const;

  double row_height_;  // radians; the cap about the zenith is as wide as a row is high
  Eigen::Vector3d up_, north_, east_;
  std::vector<Cell> cells_{};        // the dome's, then those below the horizon in the same order
  std::vector<int> first_of_row_{};  // of the dome, and the number of its cells
  std::vector<std::vector<int>> neighbours_{};
  Eigen::MatrixX3d fine_{};     // directions all over each cell, cell after cell
  Eigen::MatrixX3d sums_{};     // int w dw over each cell
  Eigen::MatrixX3d middles_{};  // directions to the middle of each cell
  Eigen::ArrayXd reaches_{};  // sine of the angle from there to the cell's farthest point, at least
};

}  // namespace lightwell
