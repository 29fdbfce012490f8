#include "validation/validate.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "validation/page/validation_page.h"
#include "validation/page/validation_text.h"

namespace lightwell {
namespace {

struct ValidateArguments {
  std::string only{}, html{}, markdown{}, json_file{};
  bool list = false;
};

void print_list(const std::vector<ValidationCase>& cases, bool json) {
  if (json) {
    ValidationRun run;
    for (const ValidationCase& one : cases) run.results.push_back({.about = one});
    fmt::print("{}", validation_json(run));
    return;
  }
  for (const ValidationCase& one : cases) {
    fmt::print("{:<30} {:<16} {}\n", one.id, one.group, one.title);
  }
}

void write_files(const ValidateArguments& arguments, const ValidationRun& run) {
  if (!arguments.html.empty()) {
    write_validation(arguments.html, validation_html(run, LIGHTWELL_VERSION));
  }
  if (!arguments.markdown.empty()) write_validation(arguments.markdown, validation_markdown(run));
  if (!arguments.json_file.empty()) write_validation(arguments.json_file, validation_json(run));
}

int validate_program(const ValidateArguments& arguments, Console& console) {
  std::vector<ValidationCase> cases = select_cases(validation_cases(), arguments.only);
  const CommonOptions& options = console.options();
  if (arguments.list) {
    print_list(cases, options.json);
    return exit_done;
  }
  require_different({arguments.html, arguments.markdown, arguments.json_file});
  for (const std::string& file : {arguments.html, arguments.markdown, arguments.json_file}) {
    if (!file.empty()) require_writable(file);
  }
  const bool has_table = !options.json && !options.quiet;
  if (has_table) fmt::print("{}", table_head());
  const auto print_case = [has_table](const CaseResult& result) {
    if (!has_table) return;
    fmt::print("{}", plain_lines(table_line(result)));
    std::fflush(stdout);
  };
  // The table shows how far the run is.
  const Progress beside_table = [](std::string_view, double) { return !interrupt_requested(); };
  const ValidationRun run =
      run_validation(std::move(cases), has_table ? beside_table : console.progress(), print_case);
  console.finish_phase();
  write_files(arguments, run);
  if (options.json) {
    fmt::print("{}", validation_json(run));
  } else if (!options.quiet) {
    fmt::print("{}\n", plain_lines(verdict_line(run)));
  }
  if (run.count(Verdict::stopped) > 0) return exit_interrupted;
  return run.has_failed() ? exit_not_accurate : exit_done;
}

}  // namespace

Action add_validate(CLI::App& command) {
  const auto arguments = std::make_shared<ValidateArguments>();
  command.description(
      "Known answers beside what this program computes, in about a minute. Exit code 4: one "
      "fails.");
  command
      .add_option("--only", arguments->only,
                  "run the cases whose name or group contains this; * stands for any characters")
      ->type_name("PATTERN");
  command.add_flag("--list", arguments->list, "name the cases, and run none");
  command.add_option("--html", arguments->html, "write a page with plots, for screens and paper")
      ->type_name("FILE");
  command
      .add_option("--markdown", arguments->markdown,
                  "write the tables as in docs/validation.md, without seconds")
      ->type_name("FILE");
  command
      .add_option("--json-file", arguments->json_file,
                  "write the JSON object of --json to a file, beside the table")
      ->type_name("FILE");
  command.footer("Example: lightwell validate --html validation.html");
  return [arguments](Console& console) { return validate_program(*arguments, console); };
}

}  // namespace lightwell
