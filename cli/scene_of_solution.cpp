#include "cli/scene_of_solution.h"

#include <fmt/format.h>

#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"

namespace lightwell {
namespace fs = std::filesystem;

fs::path scene_of_solution(const fs::path& solution) {
  const fs::path known = read_solution(solution).solution.provenance.scene_file;
  // The stored path is relative to the folder where the solve ran, which is not known.
  const fs::path beside = solution.parent_path() / known.filename();
  if (!known.empty() && fs::exists(beside)) return beside;
  if (!known.empty() && fs::exists(known)) return known;
  throw InputError(fmt::format(
      "{}: the scene of the solution, '{}', is neither there nor beside the solution; name it "
      "first: lightwell view SCENE {}",
      solution.string(), known.string(), solution.string()));
}

}  // namespace lightwell
