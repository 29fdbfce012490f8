#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/refine/corner_predictions.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/refine/interpolated_vertices.h"
#include "radiosity/refine/shadow_search.h"
#include "radiosity/refine/vertex_gathers.h"

namespace lightwell {

struct ChannelLight;

/// The error of irradiance that is interpolated over cells: the squared difference from irradiance
/// gathered inside a cell, its mean over the cell and over the bands, relative to error_reference()
/// squared.
///
/// - Compared points: the middles of a cell's edges and its centre, with the weights of Simpson's
///   rule; in triangles the middles alone, a third each. The gathers there (see VertexGathers)
///   become the values of the vertices that a split makes.
/// - Noise: the product of the two differences of indirect light has no noise in the mean. The
///   product counts only if it is more than twice the noise that is left.
/// - Between the points: ShadowSearch.
/// - Cells whose indirect light the corners predict: CornerPredictions.
///
/// Caustics are left out, and so is the light on patches that do not count (see judged_patches).
class InterpolationError {
 public:
  /// `radiosity` as gatherable_radiosity makes it, and `caustic` irradiance (or an empty array),
  /// are at the base's vertices; the caster of `lit` is of the base. A first gather at these
  /// vertices replaces the radiosity, of which patches hold one value each, before the gathers that
  /// are compared. If the efforts of `refine` limit the noise, that gather also chooses the rays of
  /// the final gather. Keeps references to the parts of
  /// `lit` and to `elements`. Throws Interrupted when progress says stop.
  InterpolationError(const LitScene& lit, const BandArray& radiosity, const BandArray& caustic,
                     RefinedElements& elements, const GatherOptions& options,
                     const RefineOptions& refine);

  /// Changes the tolerances; what was gathered is kept.
  void set_tolerance(const RefineOptions& options) { predictions_.set_tolerance(options); }
  /// True if measure() would find more now than before set_tolerance().
  bool is_stale(int cell) const { return predictions_.is_stale(cell); }
  /// The run of the gathers.
  const RunControl& run() const { return gathers_.options().run; }
  /// Rays of the final gather in each part.
  const std::vector<int>& rays() const { return gathers_.rays(); }

  /// True if a side of an element of the base counts: judged_patches(), and the side is not hidden.
  bool matters(int element) const { return matters_[element] != 0; }
  /// Area of the sides that count in a SceneParts::group_of(), m^2.
  double area(int group) const { return area_[static_cast<std::size_t>(group)]; }

  /// A bound of the squared error from the corners' values, for cells not measured yet: their range
  /// squared, plus that of peaks of near lights, plus (5 %)^2.
  double expected(int cell, int side) const;
  /// Squared errors of the two sides of a cell.
  struct Measured {
    std::array<double, 2> error{0.0, 0.0};
    std::array<double, 2> hidden{0.0, 0.0};  ///< error that noise may hide besides
  };
  /// Makes the gathers that are missing and returns the errors, in the order of `cells`. Throws
  /// Interrupted when progress says stop.
  std::vector<Measured> measure(const std::vector<int>& cells);

  /// Vertices of a mesh (numbers in RefinedElements) whose indirect light is interpolated from
  /// others of the mesh. Vertex numbers of the result are indices in the list.
  std::vector<InterpolatedVertex> interpolated(const std::vector<int>& vertices);
  /// Predictions of the vertices whose ends are all in the list; `interpolated` as interpolated()
  /// returned it.
  std::vector<VertexPrediction> predictions(const std::vector<int>& vertices,
                                            std::span<const InterpolatedVertex> interpolated);
  /// Gathers direct light at the vertices that have none, and indirect light unless interpolated.
  void gather(const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated);
  /// VertexGathers::sharpen_sky().
  bool sharpen_sky(const std::vector<double>& left) { return gathers_.sharpen_sky(left); }
  /// VertexGathers::noisy_sky_variance().
  Eigen::ArrayXf noisy_sky_variance(const std::vector<int>& vertices) const {
    return gathers_.noisy_sky_variance(vertices);
  }
  /// Values gathered at vertices, in their order.
  GatheredIrradiance values(const std::vector<int>& vertices) const {
    return gathers_.values(vertices);
  }
  /// The gathers of values() made again with the light of channels; over channels the columns sum
  /// to the result of values() after gather().
  GatheredIrradiance values_by_channel(const std::vector<int>& vertices,
                                       std::span<const InterpolatedVertex> interpolated,
                                       const ChannelLight& light) const {
    return gathers_.values_by_channel(vertices, interpolated, light);
  }
  /// VertexGathers::shared() and VertexGathers::shared_predictions().
  const SharedGathers& shared() const { return gathers_.shared(); }
  std::vector<VertexPrediction> shared_predictions() const { return gathers_.shared_predictions(); }
  /// Number of points at which direct light was gathered.
  std::int64_t gathers() const { return gathers_.gathers(); }
  /// Gives back memory that was reserved for further cells and vertices.
  void shrink_to_fit();

 private:
  void find_what_matters();
  void make_room();
  void gather_for(const std::vector<int>& cells);
  void measure(int cell, int side, Measured& measured);
  // Squared errors at the vertices of a cell, (W/m^2)^2, mean of the bands.
  struct Squares {
    double error = 0.0, hidden = 0.0;
    double direct = 0.0;        // error of direct light alone, with its noise
    double shadow_noise = 0.0;  // of direct light
    double indirect = 0.0;      // error of indirect light alone, with a share of its noise
    double noise = 0.0;         // of indirect light
  };
  struct Differences;
  static Squares beyond_noise(const Differences& differences, double shadow_noise,
                              double drawn_noise);
  Squares lattice_error(int cell, int side) const;
  double reference(int cell, int side) const;

  const ElementCaster& caster_;
  RefinedElements& elements_;
  VertexGathers gathers_;
  CornerPredictions predictions_;
  ShadowSearch shadows_;
  std::vector<char> matters_;  // per element of the base
  SceneParts parts_;
  PartMeans means_;
  std::vector<double> area_{};  // of each group, m^2
  // Squared error between the vertices, relative, by RefinedElements::side_number(); below 0: not
  // searched yet.
  std::vector<float> between_;
};

}  // namespace lightwell
