#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwell {

/// Mixes up to four numbers (patch, purpose, replica ...) into a key for scrambling. Any change of
/// any argument gives an unrelated key.
std::uint64_t random_key(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0,
                         std::uint64_t d = 0);

/// A uniform number in [0,1) that depends on the key only.
double random_uniform(std::uint64_t key);

/// The first `count` points of the 4-D Sobol sequence (direction numbers of Joe & Kuo 2008),
/// Owen-scrambled with a key (hash-based, after Burley 2020). Every key gives an independent
/// randomisation that is stratified equally well, so results depend on neither threads nor order.
/// Counts that are powers of two are stratified best.
class SobolPoints {
 public:
  explicit SobolPoints(int count);
  int count() const { return static_cast<int>(points_.size()); }
  /// Point i in [0,1)^4; any two dimensions are well stratified together.
  Eigen::Array4f point(int i, std::uint64_t key) const;
  /// The fifth dimension of point i, in [0,1), for samples that already use four.
  static double fifth(int i, std::uint64_t key);
  /// Points first, first + 1, ... one after another; quicker than one at a time.
  void points(int first, std::uint64_t key, std::span<Eigen::Array4f> result) const;

 private:
  std::vector<Eigen::Array<std::uint32_t, 4, 1>> points_;
};

/// Unit direction about +z with density cos(theta)/pi (Malley's method on Shirley & Chiu's
/// concentric disk map, which keeps stratification).
Eigen::Vector3d cosine_direction(float u, float v);

/// Two unit vectors that make a right-handed frame (first, second, n) with the unit vector n (Duff
/// et al. 2017: continuous except where n_z changes sign, and no branch).
void tangent_frame(const Eigen::Vector3d& n, Eigen::Vector3d& first, Eigen::Vector3d& second);

/// An entry of a table, drawn in proportion to its share.
struct TableDraw {
  int index = 0;
  double within = 0.0;  ///< u stretched over the entry, [0,1]
  double share = 0.0;   ///< of the entry, in the unit of the table
};
/// Draws from the running sum `cdf` of shares, whose last is above 0, by a number `u` in [0,1).
/// Entries without a share are not drawn.
TableDraw draw_from_table(std::span<const double> cdf, double u);

/// Barycentric weights of a uniform point of a triangle.
Eigen::Vector3d triangle_point(float u, float v);

}  // namespace lightwell
