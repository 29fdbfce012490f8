// Manual pages, and completions for shells, for installers.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/command_text.h"
#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/man_page.h"
#include "cli/outputs.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

void write_text(const fs::path& file, const std::string& text) {
  require_writable(file);
  write_whole(file, {text});
}

int write_pages(CLI::App& command, const fs::path& output) {
  const std::vector<CommandText> texts = command_texts(*command.get_parent());
  const OutputFolder folder(output);
  write_text(folder / "lightwell.1", man_page_of_program(texts));
  for (std::size_t i = 1; i < texts.size(); ++i) {
    write_text(folder / fmt::format("lightwell-{}.1", texts[i].name), man_page(texts[i]));
  }
  return exit_done;
}

}  // namespace

Action add_manual(CLI::App& command) {
  const auto output = std::make_shared<std::string>("man1");
  command.description("Writes the manual pages of all commands, made from their --help.");
  command.add_option("-o,--output", *output, "folder for lightwell.1, lightwell-run.1, ... (man1)")
      ->type_name("DIR");
  command.footer("Example: lightwell manual -o ~/.local/share/man/man1");
  return [output, &command](Console&) { return write_pages(command, *output); };
}

Action add_completion(CLI::App& command) {
  const auto shell = std::make_shared<std::string>();
  command.description(
      "Prints a script that lets a shell complete commands, options and their words.");
  command.add_option("shell", *shell, "bash, zsh or fish")
      ->required()
      ->type_name("SHELL")
      ->check(one_of("completion for the shell", completing_shells()));
  command.footer(
      "Example: lightwell completion bash > ~/.local/share/bash-completion/completions/lightwell");
  return [shell, &command](Console&) {
    fmt::print("{}", completion_script(*shell, command_texts(*command.get_parent())));
    return exit_done;
  };
}

}  // namespace lightwell
