#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mesh/elements/refine_elements.h"
#include "radiosity/emitters/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/refine/emitter_visibility_list.h"
#include "radiosity/refine/interpolated_vertices.h"

namespace lightwell {

struct ChannelLight;
struct RefineOptions;

/// What errors of irradiance are relative to, W/m^2: the scene's mean irradiance or a quarter of
/// the place's own, whichever is more. (Else a palm's breadth of lamp shade, lit a thousand times
/// as brightly as the room, would decide over all of it.)
double error_reference(double mean_irradiance, double own_irradiance);

/// That of every element, for irradiance at vertices: the mean over all area that reflects, and
/// that of the element's corners.
Eigen::ArrayXd error_references(const PatchMesh& mesh, const BandArray& irradiance);

/// How far irradiance interpolated over cells is from irradiance gathered inside them: the squared
/// difference's mean over each cell, mean of the bands, relative to the error_reference() squared.
///
/// A cell is compared at the middles of its edges and in its centre (weights of Simpson's rule; in
/// triangles at the middles alone), and those gathers are kept as the values of the vertices that
/// a split makes there. Direct light is gathered as for the final solution; indirect light twice,
/// with an eighth of the rays each (a sixteenth where the final gather's noise has a goal), down to
/// a quarter of that at the start's smallest elements, the same directions all over a side of a
/// surface, so that most of the noise is alike at neighbours and not in what they differ by. The
/// product of both differences is what counts, without the noise that is left, and only where it is
/// more than that.
///
/// What lies between these places is looked for with shadow rays from 16 more to each emitter that
/// all of them see whole, or that none of them sees: where one says otherwise, a shadow or a beam
/// narrower than half the cell runs through it, and direct light gathered there is compared too.
/// The edge of a shadow that runs through the middle is found in four places more: there the
/// corners' mean is right by chance.
///
/// Where indirect light was found to be what the corners of a cell tell, to three tenths of
/// the tolerance, with a quarter of the noise's square, nothing is gathered of it any more in what
/// the cell is split into: that is for the edges of shadows.
///
/// Caustics are left out, and the light on places that reflect none.
class InterpolationError {
 public:
  /// At the base's vertices: `radiosity` as gatherable_radiosity makes it, and caustic irradiance
  /// (or nothing). A first gather there replaces that radiosity, which patches hold as one value
  /// each, before the gathers that are compared; with `noise` above 0 it also tells how many rays
  /// the final gather takes to leave no larger a share of the mean irradiance. `caster` is of the
  /// base.
  InterpolationError(const LitScene& lit, const BandArray& radiosity, const BandArray& caustic,
                     RefinedElements& elements, const GatherOptions& options,
                     const RefineOptions& refine, double noise);

  /// Goes on to another tolerance: what was gathered is kept.
  void set_tolerance(double tolerance);
  /// Whether measure() would see more now than it did before set_tolerance().
  bool is_stale(int cell) const;
  /// Of the final gather.
  int rays() const { return options_.rays; }

  /// Whether light on a side of an element of the base is of interest.
  bool matters(int element) const { return matters_[element] != 0; }
  /// m^2 of all that is, and its mean irradiance, W/m^2.
  double area() const { return area_; }
  double mean_irradiance() const { return mean_; }

  /// A bound from the corners' values, for cells not measured yet: their range squared, and 5 %
  /// squared.
  double expected(int cell, int side) const;
  /// Gathers what it takes, and gives the error of each cell's two sides.
  struct Measured {
    std::array<double, 2> error{0.0, 0.0};
    std::array<double, 2> hidden{0.0, 0.0};  ///< what might be there besides, below the noise
  };
  std::vector<Measured> measure(const std::vector<int>& cells);

  /// Those of a mesh's vertices whose indirect light is interpolated from others of them; numbers
  /// are places in the list.
  std::vector<InterpolatedVertex> interpolated(const std::vector<int>& vertices);
  /// Of the same list, those that have all of their ends in it; `interpolated` as interpolated()
  /// has it.
  std::vector<VertexPrediction> predictions(const std::vector<int>& vertices,
                                            std::span<const InterpolatedVertex> interpolated);
  /// Gathers where nobody has yet, but for indirect light where it is told.
  void gather(const std::vector<int>& vertices, std::span<const InterpolatedVertex> interpolated);
  /// What was gathered at vertices, in their order.
  GatheredIrradiance values(const std::vector<int>& vertices) const;
  /// The same gathers, made again of light by channels: their sum is what values() would give after
  /// gather().
  GatheredIrradiance values_by_channel(const std::vector<int>& vertices,
                                       std::span<const InterpolatedVertex> interpolated,
                                       const ChannelLight& light);
  std::int64_t gathers() const { return gathers_; }
  /// Gives back memory for what was expected to be gathered.
  void shrink_to_fit();

 private:
  void share_pilot_rays();
  void sharpen_radiosity(const BandArray& caustic, double noise);
  void find_what_matters();
  GatherPoint gather_point(int vertex) const;
  void make_room();
  void gather_direct_at(const std::vector<int>& vertices);
  void gather_indirect_at(const std::vector<int>& vertices);
  void interpolate_indirect(int vertex);
  GatheredIrradiance indirect_at(const std::vector<int>& vertices, std::uint64_t replica,
                                 const BandArray& radiosity) const;
  bool is_even(int cell, int side) const;
  bool is_interpolated(int cell, int side) const;
  // Of those in a list whose ends all are in it, after their ends: what they are here, and by their
  // places in the list.
  template <class Visit>
  void for_each_with_ends(const std::vector<int>& vertices, Visit&& visit) const;
  template <class Visit>
  void for_each_inner_vertex(int cell, int side, Visit&& visit) const;
  void measure(int cell, int side, Measured& measured);
  template <class Visit>
  void for_each_vertex(int cell, int side, Visit&& visit) const;
  struct Squares {
    double error = 0.0, hidden = 0.0;
    double direct = 0.0;  // of direct light alone, with its noise
    double shadow_noise = 0.0;
    double indirect = 0.0;  // of indirect light alone, with a share of its noise
    double noise = 0.0;     // of that
  };
  Squares lattice_error(int cell, int side);
  // W/m^2, between the corners.
  double direct_range(int cell, int side) const;
  // Whether one of its vertices sees all of a light, or nothing, and another does not.
  bool has_edge(int cell, int side) const;
  // u and v in [0, 1], and direct light interpolated there.
  struct CellPoint {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Spectrum direct{};
  };
  CellPoint point_in(int cell, int side, double u, double v) const;
  double parts_error(int cell, int side) const;
  double probed_error(int cell, int side) const;
  Spectrum total(int vertex) const;
  double reference(int cell, int side) const;

  const Scene& scene_;
  const ElementCaster& caster_;
  const DirectLight& direct_light_;
  BandArray radiosity_;
  RefinedElements& elements_;
  GatherOptions options_;
  bool has_noise_goal_;
  double inset_;
  std::vector<char> matters_;
  double area_ = 0.0, mean_ = 0.0;
  double even_ = 0.0;  // of squared errors of indirect light, relative: told by corners if below
  // Of a cell's side: the squared error of indirect light, or how large it may be; the squared
  // noise in what says so; that of direct light between vertices, below 0 if nobody looked for it;
  // whether indirect light was interpolated when the cell was measured.
  struct CellSide {
    float indirect = std::numeric_limits<float>::infinity(), noise = indirect, probed = -1.0f;
    bool was_interpolated = false;
  };
  const CellSide* known_of(int cell, int side) const;
  std::vector<CellSide> sides_;  // by RefinedElements::side_number()
  // Per vertex.
  std::vector<char> has_direct_;
  enum class Indirect : char { unknown, interpolated, gathered };
  std::vector<Indirect> indirect_;
  std::vector<int> rays_;  // of each of the two gathers of indirect light
  BandArray direct_, first_, second_;
  EmitterVisibilityList visibility_;
  std::int64_t gathers_ = 0;
  SobolPoints probes_;
};

}  // namespace lightwell
