#pragma once

#include <Eigen/Core>
#include <vector>

namespace lightwell {

/// The cells of a hemicube (Cohen & Greenberg 1985): half a cube of edge 2 about the eye, its faces
/// at distance 1, in a frame whose z axis is the patch's normal. Face 0 is the top, with n x n
/// cells. Faces 1 to 4 are the sides at +x, -x, +y and -y, with n/2 rows of n cells, row 0 at the
/// horizon.
///
/// The delta form factor of a cell is the share of what leaves the eye's point that passes through
/// the cell:
///   top   dF = dA / (pi (x^2 + y^2 + 1)^2)
///   side  dF = z dA / (pi (y^2 + z^2 + 1)^2)
/// Each is integrated exactly over the cell by the closed form of a rectangle seen from beneath one
/// of its corners (Cohen & Wallace 1993, section 4.6), and scaled so that all cells sum to 1.
class HemicubeCells {
 public:
  static constexpr int face_count = 5;
  static constexpr int max_resolution = 4096;

  /// Throws std::invalid_argument unless n is even and from 2 to max_resolution.
  explicit HemicubeCells(int resolution);

  int resolution() const { return n_; }  ///< n, cells along an edge of the top
  int rows(int face) const { return face == 0 ? n_ : n_ / 2; }
  int cell_count() const { return 3 * n_ * n_; }
  /// Number of a face's cell (row 0, column 0); cells of a row have successive numbers.
  int first_cell(int face) const { return face == 0 ? 0 : n_ * n_ + (face - 1) * (n_ / 2) * n_; }

  /// Sum of the delta form factors of columns first .. last - 1 of a row.
  double delta_form_factor(int face, int row, int first, int last) const {
    const double* sums = row_sums(face, row);
    return sums[last] - sums[first];
  }

  /// Direction through the cell's centre, in the hemicube's frame; the longest component is 1.
  Eigen::Vector3d direction(int face, int row, int column) const;

  /// Axes of a face as axes of the frame: along increasing columns, along increasing rows, and
  /// outwards with a sign.
  struct Face {
    int column_axis, row_axis, outward_axis;
    double outward_sign;
  };
  static const Face& face(int f);

  /// Position of a cell's centre along the face's axes: offset + step * index.
  double step() const { return 2.0 / n_; }
  double column_offset() const { return 1.0 / n_ - 1.0; }
  double row_offset(int face) const { return face == 0 ? column_offset() : 1.0 / n_; }

 private:
  const double* row_sums(int face, int row) const {
    const std::vector<double>& sums = face == 0 ? top_sums_ : side_sums_;
    return sums.data() + static_cast<std::size_t>(row) * (n_ + 1);
  }

  int n_;
  std::vector<double> top_sums_, side_sums_;  // n + 1 running sums per row
};

}  // namespace lightwell
