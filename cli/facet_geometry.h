#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/report.h"
#include "mesh/cleaning/facet_check.h"
#include "scene/io/numbered_scene.h"

namespace lightwell {

/// The facets of a file between which view factors are found.
struct FacetGeometry {
  NumberedScene numbered{};
  FacetCheck check{};
  std::vector<std::string> notes{};  ///< a sentence each, see findings()
};

/// Reads the file, whose files then count as inputs. Throws InputError as read_numbered_scene()
/// does, and for losses with --strict.
FacetGeometry read_facet_geometry(const std::string& file, const CommonOptions& options);

/// Adds the required argument SCENE.
void add_facet_geometry(CLI::App& command, std::string& scene);

/// Adds --target-error under the heading `group`.
void add_target_error(CLI::App& command, double& target_error, const std::string& group);

}  // namespace lightwell
