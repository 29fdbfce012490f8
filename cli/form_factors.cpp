#include "radiosity/form_factors/facet_view_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/facet_geometry.h"
#include "cli/interrupt.h"
#include "cli/memory_size.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/several_processes.h"
#include "cli/steps.h"
#include "radiosity/form_factors/form_factor_file.h"
#include "radiosity/form_factors/heat_solver_files.h"
#include "scene/errors.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

struct FormFactorArguments {
  std::string scene, output, method = "auto", view3d, openfoam, moose, row_output;
  double target_error = 1e-3;
  double max_patch_size = 0.0;  // in the scene file's unit; 0: a row per facet
  int hemicube_resolution = 256;
  int show_row = 0;  // counted from 1; 0: none
  bool two_sided = false;
  std::int64_t memory = 0;  // bytes; 0: no limit given

  std::string text() const;
  fs::path json_file() const { return fs::path(output).replace_extension(".json"); }
  fs::path row_file() const;
  /// All files that the command writes, the matrix and its .json last.
  std::vector<fs::path> outputs() const;
};

std::string FormFactorArguments::text() const {
  // No value of --max-patch-size stands for one row per facet.
  return fmt::format(
      "--method {}{} --target-error {:g}{}{}", method, hemicube_text(method, hemicube_resolution),
      target_error,
      max_patch_size > 0.0 ? fmt::format(" --max-patch-size {:g}", max_patch_size) : "",
      two_sided ? " --two-sided" : "");
}

fs::path FormFactorArguments::row_file() const {
  if (!row_output.empty()) return row_output;
  return fs::path(output).replace_extension(fmt::format(".row{}.vtp", show_row));
}

std::vector<fs::path> FormFactorArguments::outputs() const {
  std::vector<fs::path> files;
  if (show_row > 0) files.push_back(row_file());
  for (const std::string& file : {view3d, moose}) {
    if (!file.empty()) files.emplace_back(file);
  }
  if (!openfoam.empty()) {
    for (const std::string& name : openfoam_file_names())
      files.push_back(fs::path(openfoam) / name);
  }
  files.emplace_back(output);
  files.push_back(json_file());
  return files;
}

using Computed = FacetViewFactors;

Computed compute(const FormFactorArguments& arguments, const NumberedScene& numbered,
                 const FacetCheck& check, const Feedback& feedback) {
  const auto& [console, report] = feedback;
  Stopwatch watch;
  FacetViewFactorOptions options{
      .method = form_factor_method(arguments.method),
      .target_error = arguments.target_error,
      .max_patch_size = arguments.max_patch_size * numbered.scene.metres_per_unit,
      .hemicube_resolution = arguments.hemicube_resolution,
      .two_sided = arguments.two_sided,
      .memory = {.limit = arguments.memory, .folder = fs::path(arguments.output).parent_path()},
      .progress = console.progress(),
      .processes = console.processes()};
  options.rows_found = [&](const ViewFactorRows& rows) {
    if (arguments.show_row <= rows.count()) return;
    throw InputError(fmt::format("{}: there is no row {} to show; there are {}",
                                 numbered.scene.file.string(), arguments.show_row, rows.count()));
  };
  options.phase_done = [&](const char* phase) { report.add_phase(phase, watch.lap()); };
  Computed computed = facet_view_factors(numbered, check, options);
  console.finish_phase();
  stop_if_interrupted();
  add_traffic(computed.mesh.patch_count(), feedback);
  report.add_storage(computed.storage);
  return computed;
}

bool is_short(const Computed& computed, const FormFactorArguments& arguments) {
  return computed.is_short(arguments.target_error);
}

Json form_factor_facts(const FormFactorArguments& arguments, const NumberedScene& numbered,
                       const Computed& computed) {
  const ViewFactors& F = computed.factors;
  double area = 0.0, most_open = 0.0;
  for (int i = 0; i < F.row_count(); ++i) {
    const auto r = static_cast<std::size_t>(i);
    area += F.area[r];
    most_open = std::max(most_open, F.open[r]);
  }
  return {{"scene", arguments.scene},
          {"options", arguments.text()},
          {"method", arguments.method},
          {"target_error", arguments.target_error},
          {"facets", numbered.rows.size()},
          {"rows", F.row_count()},
          {"patches", computed.mesh.patch_count()},
          {"entries", F.entry_count()},
          {"total_area", area},
          {"closure_max_error", closure_error(F)},
          {"reciprocity_max_error", reciprocity_error(F)},
          {"error_estimate", computed.error ? Json(*computed.error) : Json()},
          {"mean_closure_correction", computed.report.mean_closure_correction},
          {"max_closure_correction", computed.report.max_closure_correction},
          {"open_share", mean_open_share(F)},
          {"most_open_share", most_open},
          {"rays", computed.report.rays}};
}

/// Arrays of the JSON file beside the matrix, one value per row.
Json row_facts(const Computed& computed) {
  const ViewFactorRows& rows = computed.rows;
  Json side = Json::array();
  for (const char back : rows.is_back) side.push_back(back ? "back" : "front");
  return {{"area", computed.factors.area},
          {"name", rows.name},
          {"facet", rows.facet},
          {"side", std::move(side)},
          {"emittance", rows.emittance},
          {"open", computed.factors.open},
          {"blocked", computed.factors.blocked}};
}

std::string form_factor_text(const Json& facts) {
  std::string text;
  const auto number = [&facts](const char* key) { return facts[key].get<double>(); };
  text += fmt::format("{:<9} {} of {} facets, {} entries, {:.6g} m2 in all\n", "rows",
                      facts["rows"].get<int>(), facts["facets"].get<int>(),
                      facts["entries"].get<std::int64_t>(), number("total_area"));
  text += fmt::format("{:<9} rows and their open shares add up to 1 within {:.1e}\n", "closure",
                      number("closure_max_error"));
  text += fmt::format("{:<9} A_i F_ij = A_j F_ji within {:.1e} of the smaller area\n", "exchange",
                      number("reciprocity_max_error"));
  text += fmt::format("{:<9} {:.4f} % of the light of all rows, {:.4f} % at most, meets no facet\n",
                      "open", 100.0 * number("open_share"), 100.0 * number("most_open_share"));
  const Json& error = facts["error_estimate"];
  text += fmt::format(
      "{:<9} {} in the worst factor; target {:.1e} ({})\n", "error",
      error.is_null() ? "not estimated" : fmt::format("{:.1e}, estimated,", error.get<double>()),
      number("target_error"), facts["method"].get<std::string>());
  return text;
}

void write_files(const FormFactorArguments& arguments, const NumberedScene& numbered,
                 const Computed& computed, Report& report) {
  const ViewFactors& F = computed.factors;
  write_matrix_market(
      arguments.output, F,
      fmt::format("View factors by lightwell {}: row i, column j, share of what leaves i that "
                  "reaches j\nscene: {}\noptions: {}\nareas and names of the rows: {}",
                  LIGHTWELL_VERSION, arguments.scene, arguments.text(),
                  arguments.json_file().filename().string()));
  report.add_file(arguments.output);
  if (!arguments.view3d.empty()) {
    write_view3d(arguments.view3d, F, computed.rows.emittance, numbered.scene.metres_per_unit,
                 {.version = LIGHTWELL_VERSION, .is_enclosure = numbered.is_enclosure});
    report.add_file(arguments.view3d);
  }
  if (!arguments.moose.empty()) {
    write_moose(arguments.moose, F, computed.rows);
    report.add_file(arguments.moose);
  }
  if (!arguments.openfoam.empty()) {
    // Faces of OpenFOAM's boundaries point out of the fluid, so radiation sees their backs.
    const int first = arguments.two_sided ? F.row_count() / 2 : 0;
    write_openfoam(arguments.openfoam, F, computed.rows, first);
    for (const std::string& name : openfoam_file_names()) {
      report.add_file((fs::path(arguments.openfoam) / name).string());
    }
  }
  if (arguments.show_row > 0) {
    write_row(arguments.row_file(), computed.mesh, computed.rows.of_patch, F,
              arguments.show_row - 1);
    report.add_file(arguments.row_file());
  }
}

std::string shortfall(const FormFactorArguments& arguments, const Computed& computed) {
  const std::string remedy = arguments.method == "ray-cast"
                                 ? " --method auto finds factors between polygons without rays."
                                 : "";
  if (computed.has_rays_alone) {
    return fmt::format(
        "The worst factor has an estimated error of {:.1e}, above the target error of {:g}; "
        "'--method ray-cast' goes on for as long as it takes.",
        *computed.error, arguments.target_error);
  }
  return fmt::format(
      "The worst factor has an estimated error of {:.1e}, above the target error of {:g}; rows "
      "have {} rays at most.{}",
      *computed.error, arguments.target_error, FormFactorOptions{}.most_rays_per_patch, remedy);
}

void require_all_writable(const FormFactorArguments& arguments) {
  for (const fs::path& file : arguments.outputs()) require_writable(file);
  require_different(arguments.outputs());
}

int form_factors(const FormFactorArguments& arguments, Console& console) {
  Report report(console.options());
  Stopwatch watch;
  const FacetGeometry geometry = read_facet_geometry(arguments.scene, console.options());
  const NumberedScene& numbered = geometry.numbered;
  agree_on({.scene_hash = scene_hash(numbered.scene), .options = arguments.text()}, TimeLimit(0.0),
           console);
  std::optional<OutputFolder> openfoam;
  if (console.is_first()) {
    if (!arguments.openfoam.empty()) openfoam.emplace(arguments.openfoam);
    require_all_writable(arguments);
  }
  std::vector<std::string> notes = geometry.notes;
  report.add_phase("read_scene", watch.lap());

  Computed computed = compute(arguments, numbered, geometry.check, {console, report});
  if (!console.is_first()) return exit_done;
  if (computed.factors.entry_count() == 0) {
    notes.push_back(
        "No facet sees another; the front of a facet is where its corners run counter-clockwise.");
  }
  const bool falls_short = is_short(computed, arguments);
  if (computed.has_rays_alone) {
    notes.push_back(fmt::format(
        "The facets cross or touch each other in so many places that they are cut into {} patches; "
        "their factors are counts of rays, as with '--method ray-cast'.",
        computed.mesh.patch_count()));
  }
  if (falls_short) notes.push_back(shortfall(arguments, computed));
  if (!computed.error) {
    notes.push_back(
        fmt::format("The method {} has no estimate of its error; --target-error has no effect.",
                    arguments.method));
  }
  for (const std::string& note : notes) console.say("note: " + note);
  const Json found = form_factor_facts(arguments, numbered, computed);
  for (const auto& [key, value] : found.items()) report.add(key, value);
  report.add("notes", notes);

  watch.lap();
  write_files(arguments, numbered, computed, report);
  report.add_phase("write", watch.lap());
  report.add_file(arguments.json_file());
  computed.factors.release_rows();  // makes room for the arrays of the JSON file
  Json beside = report.json();
  beside["row"] = row_facts(computed);
  write_json(arguments.json_file(), beside);

  const CommonOptions& common = console.options();
  if (!common.json && !common.quiet) fmt::print("{}", form_factor_text(found));
  report.print();
  return falls_short ? exit_not_accurate : exit_done;
}

void add_heat_solvers(CLI::App& command, FormFactorArguments& arguments) {
  command
      .add_option(
          "--openfoam", arguments.openfoam,
          "also the lists of OpenFOAM's model viewFactor in this folder, a face for each row "
          "(with --two-sided for each back)")
      ->type_name("FOLDER");
  command
      .add_option("--moose", arguments.moose,
                  "also view factors between surfaces, a MOOSE user object (.i) or a table (.csv)")
      ->type_name("FILE")
      ->check(with_extension({".i", ".csv"}));
}

void add_how(CLI::App& command, FormFactorArguments& arguments) {
  const std::string group = "How form factors are found";
  command
      .add_option("--method,--form-factors", arguments.method,
                  "auto (default), ray-cast, hemicube or analytic")
      ->type_name("METHOD")
      ->check(one_of("form-factor method", form_factor_method_names()))
      ->group(group);
  add_hemicube_resolution(command, arguments.hemicube_resolution)->group(group);
  add_target_error(command, arguments.target_error, group);
  add_memory(command, arguments.memory)->group(group);
  command
      .add_option("--max-patch-size", arguments.max_patch_size,
                  "cut facets into patches of at most this edge, in the scene file's unit, with a "
                  "row each (default: a row for each facet)")
      ->type_name("L")
      ->check(positive())
      ->group(group);
  command
      .add_flag("--two-sided", arguments.two_sided,
                "both sides of facets have rows: row n + i is the back of row i of n")
      ->group(group);
  command.get_option("--openfoam")->excludes("--max-patch-size");
  command.get_option("--moose")->excludes("--two-sided");
}

}  // namespace

Action add_form_factors(CLI::App& command) {
  const auto arguments = std::make_shared<FormFactorArguments>();
  command.description(
      "View factors between the facets of a file, as a sparse matrix; materials do not matter.");
  add_facet_geometry(command, arguments->scene);
  command
      .add_option("-o,--output", arguments->output,
                  "the matrix, Matrix Market .mtx; areas and names go into a .json beside it")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".mtx"}));
  command.add_option("--view3d", arguments->view3d, "also the result in View3D's text format")
      ->type_name("FILE");
  add_heat_solvers(command, *arguments);
  auto* const show_row =
      command
          .add_option("--show-row", arguments->show_row,
                      "also a .vtp of the surfaces, coloured by the factors of row N in ParaView")
          ->type_name("N")
          ->check(whole_number(1, 2000000000));
  command
      .add_option("--row-output", arguments->row_output,
                  "file of --show-row (default: beside the matrix)")
      ->type_name("FILE")
      ->check(with_extension({".vtp"}))
      ->needs(show_row);
  add_how(command, *arguments);
  command.footer("Example: lightwell form-factors room.stl -o room.mtx --target-error 1e-3");
  return [arguments](Console& console) { return form_factors(*arguments, console); };
}

}  // namespace lightwell
