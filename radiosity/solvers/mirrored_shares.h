#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "mesh/patches/patch_patterns.h"
#include "scene/coat.h"
#include "scene/scene.h"

namespace lightwell {

/// Shares, [0,1], of arriving light that surfaces mirror or pass straight on, for energy balances.
/// Mirrors and sheets have theirs.
/// Coats and metals mirror less of steep light and more of grazing light than mean_mirrored(): the
/// light that arrived or was lost beyond what was sent, and which no mirror sent on, is theirs.
class MirroredShares {
 public:
  MirroredShares(const Scene& scene, const PatchMesh& mesh, Eigen::Index columns)
      : kind_(mesh.material.begin(), mesh.material.end()),
        beyond_(Eigen::ArrayXd::Zero(columns)),
        by_coats_(beyond_) {
    const Eigen::Index channels = columns / scene.bands.count();
    for (const Material& material : scene.materials) add(material, channels);
    for (int p = 0; mesh.patterns && p < mesh.patch_count(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      if (!mesh.patterns->is_given(p)) continue;
      add(mesh.patterns->mirror_of(scene.materials[kind_[i]], p), channels);
      kind_[i] = shares_.size() - 1;
    }
  }

  /// True if there are coats or metals, whose light is to be counted before kept() is right.
  bool has_coats() const { return has_coats_; }

  /// Counts light, W per column, that arrives at a patch.
  void arrive(const Eigen::ArrayXd& light, int patch) {
    const std::size_t m = kind_[static_cast<std::size_t>(patch)];
    beyond_ += light;
    if (straight_[m].size() > 0) beyond_ -= light * straight_[m];
    if (is_coat_[m]) {
      by_coats_ += light * shares_[m];
    } else {
      beyond_ -= light * shares_[m];
    }
  }
  /// Counts light that was lost on its way; negative: light that was sent.
  void lose(const Eigen::ArrayXd& light) { beyond_ += light; }

  /// Sets what coats mirror by the light counted so far: between F(0) and all of grazing light, a
  /// third and eleven times F of even light at an index of 1.5.
  void settle() {
    constexpr double least = 0.25, most = 12.0;
    const Eigen::ArrayXd of_mean =
        (by_coats_ > 0.0).select((beyond_ / by_coats_).max(least).min(most), 1.0);
    for (std::size_t m = 0; m < shares_.size(); ++m) {
      if (is_coat_[m]) shares_[m] *= of_mean;
    }
  }
  /// Share of a column's arriving light, [0,1], that a patch keeps if it scatters the share
  /// `scattered` diffusely, to one side or both.
  double kept(int patch, Eigen::Index column, float scattered) const {
    const std::size_t m = kind_[static_cast<std::size_t>(patch)];
    const double straight = straight_[m].size() > 0 ? straight_[m][column] : 0.0;
    return std::max(0.0, 1.0 - double{scattered} - shares_[m][column] - straight);
  }

 private:
  void add(const Material& material, Eigen::Index channels) {
    const auto repeated = [&](const Spectrum& share) -> Eigen::ArrayXd {
      return share.cast<double>().replicate(channels, 1);
    };
    shares_.push_back(repeated(mean_mirrored(material)));
    straight_.push_back(material.passes_straight() ? repeated(material.regular_transmittance)
                                                   : Eigen::ArrayXd());
    is_coat_.push_back(material.coat || material.metal);
    has_coats_ = has_coats_ || is_coat_.back();
  }

  std::vector<std::size_t> kind_{};  // by patch: its material, or the patch itself with a pattern
  std::vector<Eigen::ArrayXd> shares_{};
  std::vector<Eigen::ArrayXd> straight_{};  // empty: nothing passes straight on
  std::vector<char> is_coat_{};
  bool has_coats_ = false;
  Eigen::ArrayXd beyond_, by_coats_;
};

}  // namespace lightwell
