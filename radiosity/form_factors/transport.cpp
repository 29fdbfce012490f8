#include "radiosity/form_factors/transport.h"

#include <fmt/format.h>
#include <sys/vfs.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/journal/journal.h"
#include "radiosity/visibility/pair_shafts.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr std::int64_t bytes_per_mebibyte = 1 << 20;
// Least slice of rows in memory; with less, rows would be moved to and fro page by page.
constexpr std::int64_t least_slice = 16 * bytes_per_mebibyte;

std::string size_text(std::int64_t bytes) {
  constexpr double large = 1000.0;
  const double megabytes = static_cast<double>(bytes) / bytes_per_mebibyte;
  return megabytes < large ? fmt::format("{:.0f} MB", megabytes)
                           : fmt::format("{:.1f} GB", megabytes / 1024.0);
}

}  // namespace

TransportChoice choose_transport(const TransportFigures& figures) {
  const std::int64_t room = figures.limit - figures.resident - figures.work;
  const std::string rows = fmt::format("form factors of {} patches may take {}", figures.patches,
                                       size_text(figures.rows));
  const std::string left =
      fmt::format("the {} that a budget of {} leaves", size_text(std::max<std::int64_t>(room, 0)),
                  size_text(figures.limit));
  if (figures.rows <= room) {
    return {Transport::rows_in_memory, fmt::format("{}, which fit into {}", rows, left)};
  }
  if (figures.resident + figures.shooting > figures.limit) {
    return {Transport::rows_in_memory, fmt::format("{}, and nothing fits into {}", rows, left)};
  }
  const double to_hold = static_cast<double>(figures.limit - room + figures.rows);
  const std::string enough = fmt::format(
      "'--memory {:.0f}M'", std::ceil(to_hold / static_cast<double>(bytes_per_mebibyte)));
  const bool has_slice = room >= std::min(least_slice, figures.rows);
  if (has_slice && figures.rows <= figures.disk / 2 && figures.rows <= most_rows_on_disk) {
    return {Transport::rows_on_disk,
            fmt::format("{}, more than {}; the rest goes to disk, which is as exact. {} would keep "
                        "all in memory",
                        rows, left, enough)};
  }
  const std::string why_not_disk =
      !has_slice ? "not even room for a part of them"
      : figures.rows > figures.disk / 2
          ? fmt::format("more than half of the {} free on disk", size_text(figures.disk))
          : fmt::format("more than a disk can be read through in time ({})",
                        size_text(most_rows_on_disk));
  return {Transport::shooting,
          fmt::format("{}, more than {}, and {}; so patches shoot their light without them "
                      "(--solver progressive), which is noisier. {}, or larger patches, would keep "
                      "form factors",
                      rows, left, why_not_disk, enough)};
}

std::int64_t most_row_bytes(int patches, const FormFactorOptions& options) {
  const bool takes_all =
      options.method == FormFactorMethod::analytic || options.method == FormFactorMethod::hemicube;
  const std::int64_t met = std::int64_t{2} * options.rays_per_patch;
  const std::int64_t each = takes_all ? patches : std::min<std::int64_t>(patches, met);
  return patches * each * static_cast<std::int64_t>(sizeof(FormFactor));
}

std::int64_t bytes_beside_rows(const PatchMesh& mesh, std::int64_t emitters,
                               const FormFactorOptions& options) {
  // Per patch: outlines with quadrature points, entries of stores, vectors of the scaling. Per
  // band: vectors of a solver. Per thread: scratch of a row. Per emitter: an entry of a
  // patch's row and one of the emitter's; of many emitters, four points ask some 250 each.
  constexpr std::int64_t per_patch = 900, per_band = 128, per_thread = 48, per_emitter = 16,
                         most_emitters = 1024;
  const std::int64_t bands = mesh.reflectance.cols();
  std::int64_t each = per_patch + per_band * bands + per_thread * thread_count() +
                      per_emitter * std::min(emitters, most_emitters);
  const bool analytic = options.method == FormFactorMethod::analytic;
  if (analytic) each += std::int64_t{sizeof(PatchSampler)};
  const bool clips =
      analytic || (options.method == FormFactorMethod::automatic && options.target_error > 0.0);
  const std::int64_t journal = options.run.journal ? 2 * Journal::most_buffered : 0;
  return journal + mesh.patch_count() * each + (clips ? PairShafts::bytes_for(mesh) : 0);
}

std::int64_t bytes_to_shoot(const PatchMesh& mesh, int most_rays) {
  // Per band: shot, unshot and arriving light with its bookkeeping, in floats and doubles. Per ray:
  // a number and a position in each of 16 rows at a time.
  constexpr std::int64_t per_band = 48, per_ray = 16, rows_at_once = 16;
  return mesh.patch_count() * per_band * mesh.reflectance.cols() +
         rows_at_once * per_ray * most_rays;
}

std::int64_t bytes_to_gather(const PatchMesh& mesh) {
  // Per band: direct, indirect and caustic light, its pilot gather and its noise. Per element:
  // sample points and rays of gathers.
  constexpr std::int64_t per_element = 100, per_band = 50;
  return mesh.element_count() * (per_element + per_band * mesh.reflectance.cols());
}

std::int64_t elements_in(std::int64_t bytes, std::int64_t columns) {
  // Solves with refinement were measured at 550 to 750 bytes per element. The estimate for three
  // columns is 650 + 3 * 50 = 800. `per_column`: as `per_band` in bytes_to_gather. The test
  // Memory.NoMoreElementsAreMadeThanFit bounds the peak of a whole solve by 1.15 budgets.
  constexpr std::int64_t per_element = 650, per_column = 50;
  const std::int64_t count =
      std::max<std::int64_t>(bytes, 0) / (per_element + per_column * columns);
  const std::int64_t step = std::max<std::int64_t>(
      static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint64_t>(count))) / 16, 1);
  return count / step * step;
}

std::int64_t room_on_disk(const std::filesystem::path& folder) {
  struct statfs status {};
  const std::filesystem::path where = folder.empty() ? std::filesystem::path(".") : folder;
  if (::statfs(where.c_str(), &status) != 0) return 0;
  constexpr decltype(status.f_type) tmpfs = 0x01021994, ramfs = 0x858458f6;  // linux/magic.h
  if (status.f_type == tmpfs || status.f_type == ramfs) return 0;
  return static_cast<std::int64_t>(status.f_bavail) * static_cast<std::int64_t>(status.f_bsize);
}

}  // namespace lightwell
