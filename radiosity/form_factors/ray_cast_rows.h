#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "radiosity/form_factors/estimated_row.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/openings/portals.h"
#include "radiosity/paths/light_path.h"
#include "scene/hemisphere_sets.h"
#include "scene/sampling.h"

namespace lightwell {

/// Hit counts of many patches, cleared in time proportional to the number of patches hit.
class PatchCounts {
 public:
  explicit PatchCounts(std::size_t patches)
      : count_(patches, 0),
        words_(patches / word_bits + 1, 0),
        met_words_(words_.size() / word_bits + 1, 0) {}

  void add(int patch) {
    const auto p = static_cast<std::size_t>(patch);
    ++count_[p];
    words_[p / word_bits] |= bit(p);
    met_words_[p / word_bits / word_bits] |= bit(p / word_bits);
  }
  /// Number of patches hit.
  std::size_t size() const {
    std::size_t sum = 0;
    for (const std::uint64_t word : words_) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
  }
  int count(int patch) const { return count_[static_cast<std::size_t>(patch)]; }

  /// Calls `visit(patch, count)` for all patches hit, in ascending order, and clears the counts.
  template <class Visit>
  void take(Visit visit) {
    for_each_bit(met_words_, 0, met_words_.size(), [&](std::size_t w) {
      for_each_bit(words_, w, w + 1, [&](std::size_t p) {
        visit(static_cast<int>(p), count_[p]);
        count_[p] = 0;
      });
    });
  }

 private:
  static constexpr std::size_t word_bits = 64;
  static std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << (i % word_bits); }
  template <class Visit>
  static void for_each_bit(std::vector<std::uint64_t>& words, std::size_t begin, std::size_t end,
                           Visit visit) {
    for (std::size_t w = begin; w < end; ++w) {
      for (std::uint64_t left = std::exchange(words[w], 0); left != 0; left &= left - 1) {
        visit(w * word_bits + static_cast<std::size_t>(std::countr_zero(left)));
      }
    }
  }

  std::vector<int> count_;
  std::vector<std::uint64_t> words_;      // one bit per patch: hit
  std::vector<std::uint64_t> met_words_;  // one bit per word of words_: not 0
};

/// Casts the rays of rows.
class RowCaster {
 public:
  /// `most_rays`: most rays of any row. `portals`, null for none: openings that rays are aimed at
  /// as well. Keeps references to all of them.
  RowCaster(const ElementCaster& caster, const LightPaths& paths, int most_rays,
            const Portals* portals = nullptr);

  /// Memory that one thread reuses from row to row.
  class Scratch {
   public:
    explicit Scratch(const PatchMesh& mesh);

   private:
    friend class RowCaster;
    void take(int rays, bool with_hidden, EstimatedRow& row);

    PatchCounts first_, hidden_;
    std::map<int, double> by_portal_;  // per patch, weights of rays that passed portals
    std::vector<HemispherePoint> points_;
  };

  /// Casts `rays` cosine-distributed rays from all over the patch (Malley's method). The row is
  /// empty for patches that take no part in diffuse exchange. `count_hidden`: rays continue through
  /// all surfaces, to fill EstimatedRow::hidden.
  ///
  /// A quarter as many rays more are aimed at portals where any are seen. Rays of both kinds that
  /// pass a portal and meet a diffuse surface, or nothing, have the weights of the balance
  /// heuristic.
  ///
  /// Rays that an absorbing body dims on their way to a diffuse surface count per band, as if they
  /// had come by way of glass.
  EstimatedRow cast(int patch, int rays, Scratch& scratch, bool count_hidden = false) const;

 private:
  // Sums per band of what arrives at patches.
  using Arrivals = std::map<int, Spectrum>;
  static void arrive(int patch, const Spectrum& share, Arrivals& arrivals);
  // A row under way.
  struct Row {
    EstimatedRow& row;
    Arrivals by_way_of_specular{};
    // Rays that a body dims on their way to a diffuse surface: sum of weights, and what arrives.
    double dimmed = 0.0;
    Arrivals of_dimmed{};
    Spectrum absorbed{};  // of dimmed rays
    void take(int rays);
    void take_dimmed(int rays);
  };
  bool is_specular(const ElementHit& hit) const;
  void count(const ElementHit& hit, Scratch& scratch, EstimatedRow& row) const;
  bool dim(const Ray& ray, const ElementHit& hit, double weight, Row& to) const;
  void pass_on(const Ray& ray, const ElementHit& hit, std::uint64_t branch, Row& to) const;
  double density(const Portals::View& view, const Ray& ray, const ElementHit& hit) const;
  void add_weight(const ElementHit& hit, double weight, Scratch& scratch, EstimatedRow& row) const;
  void aim_at_portals(int patch, int rays, const Portals::View& view, Scratch& scratch,
                      Row& to) const;
  void count_hidden(std::span<Ray> rays, std::span<ElementHit> hits, Scratch& scratch) const;

  const ElementCaster& caster_;
  const LightPaths& paths_;
  HemisphereSets sets_;
  const Portals* portals_;
  SobolPoints aims_;  // of rays aimed at portals
};

/// The way in which for_each_row() goes through patches.
struct RowLoop {
  int rays_per_patch = 0;  ///< approximate rays of one call
  const Progress& progress;
  const JournalPhase& phase;  ///< whose block i the call for patch i recalls or keeps
};

/// Calls `work(i, scratch)` for each patch i, in parallel, with progress between slices.
void for_each_row(const PatchMesh& mesh, const RowLoop& loop,
                  const std::function<void(int, RowCaster::Scratch&)>& work);

/// Casts `rays_of[i]` rays from each patch i.
std::vector<EstimatedRow> cast_rows(const ElementCaster& caster, const LightPaths& paths,
                                    const std::vector<int>& rays_of, const Progress& progress);

}  // namespace lightwell
