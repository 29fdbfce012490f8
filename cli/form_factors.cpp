#include "radiosity/form_factors/form_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/memory_size.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "cli/view_factor_rows.h"
#include "radiosity/form_factors/form_factor_file.h"
#include "radiosity/form_factors/view_factor_scene.h"
#include "scene/errors.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

struct FormFactorArguments {
  std::string scene, output, method = "auto", view3d, row_output;
  double target_error = 1e-3;
  double max_patch_size = 0.0;  // in the scene file's unit; 0: a row per facet
  int hemicube_resolution = 256;
  int show_row = 0;  // counted from 1; 0: none
  bool two_sided = false;
  std::int64_t memory = 0;  // bytes; 0: no limit given

  std::string text() const;
  fs::path json_file() const { return fs::path(output).replace_extension(".json"); }
  fs::path row_file() const;
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

/// Mesh options for one row per facet. Ray casting samples a whole facet, so a facet is one patch.
/// A hemicube has one centre per patch, and a closed form few shadow rays per pair of patches: both
/// are summed over smaller patches. Every method cuts facets where other facets touch them.
constexpr int patches_of_hemicubes = 2048, patches_of_closed_forms = 512;
MeshOptions mesh_for_facets(FormFactorMethod method, const Scene& scene) {
  MeshOptions options{.elements_per_patch_edge = 1};
  if (method == FormFactorMethod::hemicube) {
    options.auto_patch_count = patches_of_hemicubes;
  } else if (method == FormFactorMethod::analytic) {
    options.auto_patch_count = patches_of_closed_forms;
  } else {
    options.max_patch_size = 2.0 * scene_bounds(scene).diagonal();
  }
  return options;
}

struct Computed {
  PatchMesh mesh{};
  ViewFactorRows rows{};
  ViewFactors factors{0};
  FormFactorReport report{};
  std::optional<double> error{};  // estimated error of the worst factor
  bool has_rays_alone = false;    // `automatic` fell back on them: facets are cut to shreds
};

/// Facets that cross each other by the dozen are cut into very many patches. Pairs of these with
/// partly hidden patches are too many for closed forms; but a facet's factors are means over its
/// patches, whose rays are independent, so few rays for each of them suffice. A facet that a few
/// others stand on or cut is in fewer than eight patches.
bool are_facets_shredded(const PatchMesh& mesh, const ViewFactorRows& rows) {
  constexpr int many = patches_of_closed_forms, of_each = 8;
  return mesh.patch_count() > many && mesh.patch_count() / of_each > rows.count();
}

/// Standard error of a patch's rays that gives a row the target error: rows with one large patch
/// need most rays.
double target_of_patches(double target, const PatchMesh& mesh, const ViewFactorRows& rows) {
  const auto count = static_cast<std::size_t>(rows.count());
  std::vector<double> area(count, 0.0), squares(count, 0.0);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const int row = rows.of_patch[static_cast<std::size_t>(i)];
    if (row < 0) continue;
    area[static_cast<std::size_t>(row)] += mesh.area[i];
    squares[static_cast<std::size_t>(row)] += mesh.area[i] * mesh.area[i];
  }
  double least_even = 0.0;
  for (std::size_t row = 0; row < count; ++row) {
    if (area[row] > 0.0) least_even = std::max(least_even, std::sqrt(squares[row]) / area[row]);
  }
  return least_even > 0.0 ? target / least_even : target;
}

/// Options of rays alone for shredded facets: as many as any share of them needs for the target, or
/// those of a minute or two.
void take_rays_alone(double target, const PatchMesh& mesh, const ViewFactorRows& rows,
                     FormFactorOptions& options) {
  constexpr unsigned most_rays = 1u << 26;
  const double error = target_of_patches(target, mesh, rows);
  const auto most = std::bit_floor(most_rays / static_cast<unsigned>(mesh.patch_count()));
  const double needed = std::clamp(0.25 / (error * error), 1.0, static_cast<double>(most));
  options.method = FormFactorMethod::ray_cast;
  options.target_error = error;
  options.rays_per_patch =
      std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(needed)))),
                 options.rays_per_patch, options.most_rays_per_patch);
  options.most_rays_per_patch = options.rays_per_patch;
}

/// Computes the factors on the mesh that suits `method`.
Computed compute_as(FormFactorMethod method, const FormFactorArguments& arguments,
                    const NumberedScene& numbered, const ViewFactorScene& view,
                    const Feedback& feedback) {
  const auto& [console, report] = feedback;
  Stopwatch watch;
  const bool per_patch = arguments.max_patch_size > 0.0;
  MeshOptions mesh_options = mesh_for_facets(method, view.scene);
  if (per_patch) {
    mesh_options.max_patch_size = arguments.max_patch_size * view.scene.metres_per_unit;
  }
  Computed computed;
  computed.mesh = build_patches(view.scene, mesh_options, console.progress());
  report.add_phase("mesh", watch.lap());
  computed.rows = per_patch ? patch_rows(numbered, view, computed.mesh)
                            : facet_rows(numbered, view, computed.mesh);
  if (arguments.show_row > computed.rows.count()) {
    throw InputError(fmt::format("{}: there is no row {} to show; there are {}",
                                 view.scene.file.string(), arguments.show_row,
                                 computed.rows.count()));
  }
  const ElementCaster caster(computed.mesh);
  const DirectLight no_light(view.scene, computed.mesh);
  FormFactorOptions options;
  options.method = method;
  options.target_error = arguments.target_error;
  options.hemicube_resolution = arguments.hemicube_resolution;
  options.memory = std::make_shared<MemoryBudget>(
      MemoryOptions{.limit = arguments.memory, .folder = fs::path(arguments.output).parent_path()});
  options.run.progress = console.progress();
  computed.has_rays_alone = method == FormFactorMethod::automatic && !per_patch &&
                            are_facets_shredded(computed.mesh, computed.rows);
  if (computed.has_rays_alone) {
    take_rays_alone(arguments.target_error, computed.mesh, computed.rows, options);
  }
  const auto form_factors =
      compute_form_factors({view.scene, caster, no_light}, options, &computed.report);
  console.finish_phase();
  stop_if_interrupted();
  if (!computed.report.row_error.empty()) {
    computed.error =
        error_estimate(computed.report, *form_factors, computed.mesh, computed.rows.of_patch);
  }
  computed.factors = sum_form_factors(*form_factors, computed.mesh, computed.rows.of_patch,
                                      computed.rows.count(), options.memory);
  report.add_storage(options.memory->report());
  report.add_phase("form_factors", watch.lap());
  return computed;
}

bool is_short(const Computed& computed, const FormFactorArguments& arguments) {
  return computed.error && *computed.error > arguments.target_error;
}

Computed compute(const FormFactorArguments& arguments, const NumberedScene& numbered,
                 const FacetCheck& check, const Feedback& feedback) {
  const ViewFactorScene view = make_view_factor_scene(numbered, check, arguments.two_sided);
  const FormFactorMethod method = form_factor_method(arguments.method);
  Computed computed = compute_as(method, arguments, numbered, view, feedback);
  // Few whole facets may be too large for exact visibility of many corners, and for the rays of one
  // row. Closed forms of their parts come nearer to the target.
  const bool is_coarse = method == FormFactorMethod::automatic &&
                         !(arguments.max_patch_size > 0.0) &&
                         computed.mesh.patch_count() < patches_of_closed_forms;
  if (is_coarse && is_short(computed, arguments)) {
    Computed finer = compute_as(FormFactorMethod::analytic, arguments, numbered, view, feedback);
    if (*finer.error < *computed.error) computed = std::move(finer);
  }
  return computed;
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

int form_factors(const FormFactorArguments& arguments, Console& console) {
  Report report(console.options());
  Stopwatch watch;
  const NumberedScene numbered = [&] {
    const InterruptEndsAtOnce at_once;
    return read_numbered_scene(arguments.scene, allowed_references(console.options()));
  }();
  for (const auto& file : numbered.scene.files) note_input(file);
  refuse_losses(numbered.scene, console.options());
  if (arguments.show_row > 0) require_writable(arguments.row_file());
  if (!arguments.view3d.empty()) require_writable(arguments.view3d);
  require_writable(arguments.output);
  require_writable(arguments.json_file());
  const FacetCheck check = check_facets(numbered.scene);
  std::vector<std::string> notes = findings(numbered, check);
  report.add_phase("read_scene", watch.lap());

  Computed computed = compute(arguments, numbered, check, {console, report});
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

void add_how(CLI::App& command, FormFactorArguments& arguments) {
  const std::string group = "How form factors are found";
  command
      .add_option("--method,--form-factors", arguments.method,
                  "auto (default), ray-cast, hemicube or analytic")
      ->type_name("METHOD")
      ->check(one_of("form-factor method", form_factor_method_names()))
      ->group(group);
  add_hemicube_resolution(command, arguments.hemicube_resolution)->group(group);
  command
      .add_option("--target-error", arguments.target_error,
                  "target standard error of every factor (default 1e-3)")
      ->type_name("E")
      ->check(positive())
      ->group(group);
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
}

}  // namespace

Action add_form_factors(CLI::App& command) {
  const auto arguments = std::make_shared<FormFactorArguments>();
  command.description(
      "View factors between the facets of a file, as a sparse matrix; materials do not matter.");
  command.add_option("scene", arguments->scene, fmt::format("geometry: {}", scene_extensions))
      ->required()
      ->type_name("SCENE");
  command
      .add_option("-o,--output", arguments->output,
                  "the matrix, Matrix Market .mtx; areas and names go into a .json beside it")
      ->required()
      ->type_name("FILE")
      ->check(with_extension({".mtx"}));
  command.add_option("--view3d", arguments->view3d, "also the result in View3D's text format")
      ->type_name("FILE");
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
