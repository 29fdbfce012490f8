#include "radiosity/gather/caustic_irradiance.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/emitters/emitter.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/journal/journal_phase.h"
#include "radiosity/paths/light_path.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Power that lights leave on elements by way of mirrors and glass, W, elements x columns of every
// channel.
class CausticPower {
 public:
  // `paths` is kept a reference to.
  CausticPower(const LitScene& lit, const LightPaths& paths, int rays)
      : lit_(lit),
        paths_(paths),
        rays_(rays),
        bands_(lit.scene.bands.count()),
        sobol_(rays),
        power_(BandArray::Zero(lit.mesh().element_count(), lit.direct_light.column_count())) {
    for (int e = 0; e < static_cast<int>(lit.direct_light.emitters().size()); ++e) {
      const int facet = lit.direct_light.emitters()[e].facet;
      emitter_of_facet_.resize(std::max<std::size_t>(emitter_of_facet_.size(), facet + 1), -1);
      emitter_of_facet_[facet] = e;
    }
    find_rays();
  }

  BandArray& power() { return power_; }

  // Each patch of an emitter sends rays in proportion to its area.
  void add_patch(int p) {
    const PatchMesh& mesh = lit_.mesh();
    const int facet = mesh.facet[mesh.first_element[p]];  // emitters' patches lie on one facet each
    if (!lit_.direct_light.owns(facet, mesh.is_back[p] != 0) ||
        !(mesh.emission.row(p) > 0.0f).any())
      return;
    const int light = emitter_of_facet_[facet], of_light = rays_of_light_[light];
    const double share = mesh.area[p] / lit_.direct_light.emitters()[light].area;
    const int count = std::clamp(static_cast<int>(std::lround(of_light * share)), 1, of_light);
    const Spectrum power_per_ray =
        mesh.emission.row(p).transpose() * static_cast<float>(mesh.area[p] / count);
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(p), RandomPurpose::caustic_rays);
    const PatchSampler sampler(mesh, p);
    send(count, key, lit_.direct_light.first_column(facet), [&](int r) {
      const Eigen::Array4f u = sobol_.point(r, key);
      const Ray ray = cosine_ray(mesh, sampler.point(u[0], u[1]), u[2], u[3]);
      return std::pair(ray, power_per_ray);
    });
  }

  // Rays of the free source of this number.
  void add_source(int number) {
    const FreeSource& source = lit_.direct_light.free_sources()[static_cast<std::size_t>(number)];
    if (!source.is_on() || source.is_dome()) return;
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(source.number), RandomPurpose::caustic_source_rays);
    const int count = rays_of_light_[lit_.direct_light.emitters().size() + number];
    send(count, key, source.channel * bands_, [&](int r) {
      const SourceRay sent = source_ray(source, sobol_.point(r, key));
      return std::pair(sent.ray, Spectrum(with_color(source.light, sent.color) *
                                          static_cast<float>(sent.weight / count)));
    });
  }

 private:
  // Rays of each light: `rays_` times the root of the light's share of its channel's power. In
  // proportion to the power, all light together would have the least noise, but caustics of single
  // lamps, which lie apart, would be left with a few rays each.
  void find_rays() {
    const DirectLight& direct = lit_.direct_light;
    std::vector<double> power;
    std::vector<int> channel;
    for (const Emitter& emitter : direct.emitters()) {
      power.push_back(double{emitter.exitance.mean()} * emitter.area);
      channel.push_back(direct.first_column(emitter.facet) / static_cast<int>(bands_));
    }
    for (const FreeSource& source : direct.free_sources()) {
      power.push_back(double{mean_light(source).mean()} * total_weight(source));
      channel.push_back(source.channel);
    }
    std::vector<double> of_channel(static_cast<std::size_t>(direct.channel_count()), 0.0);
    for (std::size_t i = 0; i < power.size(); ++i) of_channel[channel[i]] += power[i];
    const int fewest = std::min(rays_, 1 << 12);
    for (std::size_t i = 0; i < power.size(); ++i) {
      const double all = of_channel[channel[i]];
      const double share = all > 0.0 ? power[i] / all : 1.0;
      rays_of_light_.push_back(
          std::clamp(static_cast<int>(std::lround(rays_ * std::sqrt(share))), fewest, rays_));
    }
  }

  struct Deposit {
    int element;
    Spectrum power;
  };

  // Sends rays r = 0 ... count - 1; first(r) returns a ray and its power, W. The rays deposit in
  // the columns from `column` on. Deposits of a round are kept at a time, since a ray between
  // mirrors leaves one at each.
  template <class First>
  void send(int count, std::uint64_t key, int column, First&& first) {
    constexpr int round = 1 << 16;
    for (int begin = 0; begin < count; begin += round) {
      send_round(begin, std::min(round, count - begin), key, column, first);
    }
  }

  // Sends `count` rays from number `start` on. Each piece of rays has a list of its own, and the
  // lists are added in order, so that the sum does not depend on the number of threads.
  template <class First>
  void send_round(int start, int count, std::uint64_t key, int column, First&& first) {
    constexpr int piece = 2048;
    std::vector<std::vector<Deposit>> deposits((count + piece - 1) / piece);
    parallel_for(count, piece, [&](int begin, int end) {
      auto& list = deposits[begin / piece];
      for (int r = start + begin; r < start + end; ++r) {
        const auto [ray, watts] = first(r);
        ElementHit hit;
        lit_.caster.closest_hits({&ray, 1}, {&hit, 1});
        if (hit.facet < 0 || !paths_.is_specular(hit.facet)) continue;
        paths_.follow(ray, hit,
                      random_key(key, RandomPurpose::caustic_paths, static_cast<std::uint64_t>(r)),
                      [&](const LightArrival& at) {
                        if (at.through_panes_only) return;  // direct light has that
                        list.push_back({at.hit.element, at.throughput * watts});
                      });
      }
    });
    for (const auto& list : deposits) {
      for (const Deposit& deposit : list) {
        power_.row(deposit.element).segment(column, bands_) += deposit.power.transpose();
      }
    }
  }

  LitScene lit_;
  const LightPaths& paths_;
  int rays_, bands_;
  SobolPoints sobol_;
  std::vector<int> emitter_of_facet_{};  // -1: none
  std::vector<int> rays_of_light_{};     // emitters, then free sources
  BandArray power_;
};

// The power of the elements around each vertex over their area: W/m^2, vertices x columns.
BandArray vertex_irradiance(const PatchMesh& mesh, const BandArray& power) {
  BandArray vertex_power = BandArray::Zero(mesh.vertex_count(), power.cols());
  Eigen::ArrayXf vertex_area = Eigen::ArrayXf::Zero(mesh.vertex_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      vertex_power.row(mesh.corners[e][c]) += power.row(e);
      vertex_area[mesh.corners[e][c]] += static_cast<float>(mesh.element_area[e]);
    }
  }
  return vertex_power.colwise() / vertex_area.max(1e-30f);
}

}  // namespace

BandArray caustic_irradiance(const LitScene& lit, int rays, int max_specular_depth,
                             const RunControl& run) {
  const PatchMesh& mesh = lit.mesh();
  const LightPaths paths(lit.scene, lit.caster, max_specular_depth, PathDetail::patches,
                         PathArrivals::all);
  if (!paths.has_specular() || lit.direct_light.light_count() == 0) return {};
  JournalPhase phase(run, "caustics", [&](Fingerprint& print) {
    print.add(mesh);
    print.add(lit.direct_light.column_count());
    print.add(rays);
    print.add(max_specular_depth);
  });
  CausticPower found(lit, paths, rays);
  const auto sources = static_cast<int>(lit.direct_light.free_sources().size());
  const int patches = mesh.patch_count(), count = patches + sources;
  int first = 0;
  phase.recall_state(first, found.power());
  for (int i = first; i < count; ++i) {
    if (i < patches) {
      found.add_patch(i);
    } else {
      found.add_source(i - patches);
    }
    report(run.progress, "caustics", static_cast<double>(i) / count);
    if (phase.is_state_due()) phase.keep_state(i + 1, found.power());
  }
  phase.keep_state(count, found.power());
  return vertex_irradiance(mesh, found.power());
}

}  // namespace lightwell
