#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// How patches exchange light.
enum class Transport {
  rows_in_memory,  ///< form factors are found once, kept, and solved with
  rows_on_disk,    ///< the same, and those that do not fit into memory go into a file
  shooting         ///< progressive refinement: rows are found when a patch shoots, and forgotten
};

/// What the choice goes by, in bytes.
struct TransportFigures {
  int patches = 0;
  std::int64_t rows = 0;      ///< of all form factors, at most: see most_row_bytes
  std::int64_t work = 0;      ///< beside rows while they are made and solved with
  std::int64_t shooting = 0;  ///< instead of both, for shooting
  std::int64_t resident = 0;  ///< what the process has in memory already
  std::int64_t limit = 0;     ///< what it may have
  std::int64_t disk = 0;      ///< free where rows would go: see room_on_disk
};

struct TransportChoice {
  Transport transport = Transport::rows_in_memory;
  std::string reason{};  ///< one sentence: which, why, and what would change it
};

/// More rows than this are not worth a disk: each of some 20 passes over them would take more than
/// half a minute at 200 MB/s, and shooting does not need them.
inline constexpr std::int64_t most_rows_on_disk = std::int64_t{8} << 30;

/// Form factors are kept wherever they fit, since they see every exchange from both ends: in
/// memory, else on disk, if that has twice their size free and they are no more than
/// most_rows_on_disk. Else, and where even the work beside rows is more than the limit leaves,
/// patches shoot. Where that does not fit either it is rows in memory, for which MemoryBudget says
/// what would do.
TransportChoice choose_transport(const TransportFigures& figures);

/// Bytes that the rows of so many patches take at most with rays: those that a patch's rays meet,
/// and as many on average whose rays meet it; of `analytic` all.
std::int64_t most_row_bytes(int patches, const FormFactorOptions& options);

/// Bytes that are to come beside rows: numbers for each patch while form factors are found and
/// solved with, and what each thread counts in.
std::int64_t bytes_beside_rows(const PatchMesh& mesh, std::int64_t emitters,
                               const FormFactorOptions& options);

/// Bytes that progressive refinement takes beside the mesh, with so many rays of a shot at most.
std::int64_t bytes_to_shoot(const PatchMesh& mesh, int most_rays);

/// Bytes that light on so many vertices and elements takes while it is gathered, refinement apart:
/// rows are given up by then.
std::int64_t bytes_to_gather(const PatchMesh& mesh);

/// Elements that refinement may make, in all, of light in so many columns (bands of each channel),
/// where so many bytes are left for them: what the solution of each takes, and its share of what
/// finds out where to split. Whole sixteenths of a power of two, so that what a process happens to
/// have resident decides hardly ever.
std::int64_t elements_in(std::int64_t bytes, std::int64_t columns);

/// Bytes free in a folder; 0 where that cannot be known, and where it is itself kept in memory.
std::int64_t room_on_disk(const std::filesystem::path& folder);

}  // namespace lightwell
