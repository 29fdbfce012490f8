// Exceedance of the bounds of light at places of random rooms, and the ratio of bounds to errors.
//
//   bounds_bench [rooms|gaps] [COUNT] [PLACES] [FIRST] [ACCURACY]
//
// ROOMS: closed rooms with boxes, of 0.1 to 30 m; GAPS: furnished rooms with gaps of 0.2 to 10 mm
// (see random_rooms.h). Each of COUNT rooms (5) is solved, by default or to ACCURACY, and
// interpolated and gathered at PLACES places (64). The truth is a path tracer's (path_tracer.h).
// Printed for all places, those in gaps, and dim ones (below a tenth of the mean): the share of
// places whose error exceeds lux_within, the RMS of bounds over the RMS of errors, and the share of
// places within a fifth of their own light. Environment: LIGHTWELL_PLACES names a file to which
// each place is written, LIGHTWELL_ROOMS a folder to which rooms and places are written for
// bench/bounds_mitsuba.py, and from which the truth that it adds is read. LIGHTWELL_TRUTH: no more
// than the truth is computed.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "bench/path_tracer.h"
#include "bench/random_rooms.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "scene/parallel.h"

namespace {

using namespace lightwell;

// Light at one place, lx.
struct Found {
  double truth = 0.0, noise = 0.0;  // noise: standard error of the truth
  double mean = 0.0;                // of the room's places
  double gap = 0.0;                 // m
  double interpolated = 0.0, interpolated_within = 0.0;
  double gathered = 0.0, gathered_within = 0.0;
};

int facet_at(const ElementCaster& caster, const RoomPlace& place) {
  // The facet under the place, seen from a tenth of the gap above.
  const double height = place.gap > 0.0 ? 0.1 * place.gap : 1e-5;
  const Ray ray{.origin = place.position + height * place.normal, .direction = -place.normal};
  ElementHit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  return hit.facet;
}

// The truth that bench/bounds_mitsuba.py wrote for the room; empty if it wrote none.
std::vector<Found> known_truth(const std::string& room_file, const RandomRoom& room) {
  std::ifstream file(room_file + ".truth");
  std::vector<Found> found;
  double truth = 0.0, noise = 0.0;
  for (char comma = 0; file >> truth >> comma >> noise;) {
    if (found.size() == room.places.size()) return {};
    found.push_back({.truth = truth, .noise = noise, .gap = room.places[found.size()].gap});
  }
  return found.size() == room.places.size() ? found : std::vector<Found>();
}

std::vector<Found> truth_of(const RandomRoom& room) {
  const PatchMesh mesh = build_patches(room.scene);
  const ElementCaster caster(mesh);
  const PathTracer tracer(caster);
  const double lumens = luminous(room.scene.bands, constant_spectrum(room.scene.bands, 1.0f));
  std::vector<Found> found(room.places.size());
  parallel_for(static_cast<int>(room.places.size()), 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const RoomPlace& place = room.places[static_cast<std::size_t>(i)];
      const int rays = place.gap > 0.0 ? 8192 : 2048;
      // Furniture is less than 2 m wide.
      const double widths = place.gap > 0.0 ? 2.0 / place.gap : 0.0;
      const auto E = tracer.irradiance(place.position, place.normal, facet_at(caster, place), 1024,
                                       rays, static_cast<std::uint64_t>(i), widths);
      found[static_cast<std::size_t>(i)] = {
          .truth = lumens * E.mean, .noise = lumens * E.error, .gap = place.gap};
    }
  });
  return found;
}

void set_mean(std::vector<Found>& found) {
  double mean = 0.0;
  for (const Found& f : found) mean += f.truth / static_cast<double>(found.size());
  for (Found& f : found) f.mean = mean;
}

void solve_and_probe(const RandomRoom& room, double accuracy, std::vector<Found>& found) {
  const Scene scene = merge_planar_regions(room.scene);
  SolveOptions options;
  if (accuracy > 0.0) options.accuracy = Accuracy{.share = accuracy};
  const SolvedScene solved = solve_scene(scene, options);
  const ElementCaster caster(solved.mesh);
  std::vector<Probe> probes;
  for (const RoomPlace& place : room.places) probes.push_back({place.position, place.normal});
  const BandArray interpolated = interpolate_irradiance(caster, solved.solution, probes);
  const Eigen::ArrayXd within = interpolation_bound(caster, solved.solution, probes);
  ProbeBounds bounds;
  const BandArray gathered = probe_irradiance(scene, caster, DirectLight(scene, solved.mesh),
                                              solved.solution, probes, {.rays = 1024}, &bounds);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    found[i].interpolated = luminous(scene.bands, interpolated.row(row).transpose());
    found[i].interpolated_within = within.size() > 0 ? within[row] : 0.0;
    found[i].gathered = luminous(scene.bands, gathered.row(row).transpose());
    found[i].gathered_within = bounds.lux_within[row];
  }
  fmt::print("  {} patches, {} elements, error estimate {:.2f} %\n", solved.mesh.patch_count(),
             solved.mesh.element_count(), 100.0 * solved.solution.error_estimate);
}

struct Tally {
  int count = 0, exceeded = 0, near = 0;
  double bounds = 0.0, errors = 0.0;

  void add(double value, double within, const Found& f) {
    const double error = std::abs(value - f.truth);
    ++count;
    // The truth's own error adds to that of the value, both bounded with the same odds.
    if (error > std::hypot(std::isnan(within) ? 0.0 : within, 2.0 * f.noise)) ++exceeded;
    if (error <= 0.2 * f.truth + 2.0 * f.noise) ++near;
    // In units of the room's mean: rooms count alike.
    if (!std::isnan(within)) bounds += std::pow(within / f.mean, 2);
    errors += std::max(0.0, std::pow(value - f.truth, 2) - f.noise * f.noise) / (f.mean * f.mean);
  }
};

template <class Counts>
void print(const char* name, const std::vector<Found>& all, Counts counts) {
  Tally interpolated, gathered;
  for (const Found& f : all) {
    if (!counts(f)) continue;
    interpolated.add(f.interpolated, f.interpolated_within, f);
    gathered.add(f.gathered, f.gathered_within, f);
  }
  if (interpolated.count == 0) return;
  const auto line = [&](const char* how, const Tally& t) {
    fmt::print(
        "{:<10} {:<12} {:5} places  exceeded {:5.1f} %  bound/error {:6.2f}  "
        "error {:6.3f} % of mean  within 20 %: {:5.1f} %\n",
        name, how, t.count, 100.0 * t.exceeded / t.count, std::sqrt(t.bounds / t.errors),
        100.0 * std::sqrt(t.errors / t.count), 100.0 * t.near / t.count);
  };
  line("interpolated", interpolated);
  line("gathered", gathered);
}

void print_all(const std::vector<Found>& all) {
  print("all", all, [](const Found&) { return true; });
  print("open", all, [](const Found& f) { return f.gap == 0.0; });
  print("gaps", all, [](const Found& f) { return f.gap > 0.0; });
  print("dim", all, [](const Found& f) { return f.gap == 0.0 && f.truth < 0.1 * f.mean; });
  std::fflush(stdout);
}

// Writes a room's materials, its faces, and its places with the truth.
void write_room(const std::string& path, const RandomRoom& room, const std::vector<Found>& found) {
  std::ofstream file(path);
  for (const Material& m : room.scene.materials) {
    file << fmt::format("material,{:.9g},{:.9g}\n", m.reflectance[0], m.emission[0]);
  }
  for (const Surface& surface : room.scene.surfaces) {
    file << fmt::format("face,{}", surface.material);
    for (const auto& v : std::get<PolygonMesh>(surface.shape).vertices) {
      file << fmt::format(",{:.12g},{:.12g},{:.12g}", v.x(), v.y(), v.z());
    }
    file << '\n';
  }
  for (std::size_t i = 0; i < room.places.size(); ++i) {
    const auto& [p, n, gap] = room.places[i];
    file << fmt::format(
        "place,{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:g},{:.9g},{:.3g}\n", p.x(), p.y(),
        p.z(), n.x(), n.y(), n.z(), gap, found[i].truth, found[i].noise);
  }
}

void append_places(const std::string& path, const std::vector<Found>& all) {
  std::ofstream file(path);
  file << "truth,noise,mean,gap,interpolated,interpolated_within,gathered,gathered_within\n";
  for (const Found& f : all) {
    file << fmt::format("{:.6g},{:.3g},{:.6g},{:g},{:.6g},{:.3g},{:.6g},{:.3g}\n", f.truth, f.noise,
                        f.mean, f.gap, f.interpolated, f.interpolated_within, f.gathered,
                        f.gathered_within);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const auto number = [&](std::size_t i, double otherwise) {
    return i < arguments.size() ? std::stod(arguments[i]) : otherwise;
  };
  const bool gaps = !arguments.empty() && arguments[0] == "gaps";
  const int count = static_cast<int>(number(1, 5)), places = static_cast<int>(number(2, 64));
  const auto first = static_cast<std::uint64_t>(number(3, 0));
  const char* const folder = std::getenv("LIGHTWELL_ROOMS");
  const bool only_truth = std::getenv("LIGHTWELL_TRUTH") != nullptr;
  std::vector<Found> all;
  for (std::uint64_t i = first; i < first + static_cast<std::uint64_t>(count); ++i) {
    const RandomRoom room = gaps ? gap_room(i, places) : random_room(i, places);
    const std::string file =
        folder ? fmt::format("{}/{}-{}.csv", folder, gaps ? "gaps" : "room", i) : std::string();
    std::vector<Found> found = known_truth(file, room);
    const bool is_known = !found.empty();
    const double traced = seconds_of([&] {
      if (!is_known) found = truth_of(room);
    });
    set_mean(found);
    if (folder && !is_known) write_room(file, room, found);
    double solved = 0.0;
    if (!only_truth) solved = seconds_of([&] { solve_and_probe(room, number(4, 0.0), found); });
    fmt::print("{} {}: mean {:.1f} lx, path tracer {:.1f} s, solve and probes {:.1f} s\n",
               gaps ? "gap room" : "room", i, found.empty() ? 0.0 : found[0].mean, traced, solved);
    std::fflush(stdout);
    all.insert(all.end(), found.begin(), found.end());
  }
  if (!only_truth) print_all(all);
  if (const char* path = std::getenv("LIGHTWELL_PLACES")) append_places(path, all);
}
