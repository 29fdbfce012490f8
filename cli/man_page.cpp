#include "cli/man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

#include "cli/commands.h"

namespace lightwell {
namespace {

constexpr std::string_view rarely_needed = "Rarely needed";

// Text as roff prints it: its escape character is doubled, hyphens are those of command lines, and
// no line begins with a request.
std::string roff(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) {
      escaped += std::string("\\&") + c;
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string header(const std::string& page) {
  return fmt::format(
      ".\\\" Made from the command's own definition.\n.TH {} 1 \"\" \"lightwell {}\"\n",
      roff(upper(page)), LIGHTWELL_VERSION);
}

std::string synopsis(const CommandText& command) {
  std::string line = fmt::format(".B lightwell {}\n[\\fIOPTIONS\\fR]", roff(command.name));
  for (const OptionText& option : command.options) {
    if (!option.is_positional) continue;
    const std::string value =
        fmt::format("\\fI{}\\fR{}", roff(option.value), option.may_repeat ? " ..." : "");
    line += option.is_required ? " " + value : fmt::format(" [{}]", value);
  }
  return line + "\n";
}

// A paragraph: names and value of the option, and its description.
std::string paragraph(const OptionText& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names)
    names.push_back(fmt::format("\\fB{}\\fR", roff(name)));
  std::string head = fmt::format("{}", fmt::join(names, ", "));
  if (option.is_positional) head.clear();
  if (!option.value.empty()) {
    head += fmt::format("{}\\fI{}\\fR{}", head.empty() ? "" : " ", roff(option.value),
                        option.may_repeat ? " ..." : "");
  }
  return fmt::format(".TP\n{}\n{}\n", head, roff(option.description));
}

// Headings in the order of their first option; options without a heading come last.
std::vector<std::string> headings(const CommandText& command) {
  std::vector<std::string> found;
  for (const OptionText& option : command.options) {
    if (option.is_positional || option.group.empty()) continue;
    if (std::ranges::count(found, option.group) == 0) found.push_back(option.group);
  }
  found.emplace_back();
  return found;
}

std::string options_under(const CommandText& command, const std::string& heading) {
  std::string paragraphs;
  for (const OptionText& option : command.options) {
    if (!option.is_positional && option.group == heading) paragraphs += paragraph(option);
  }
  if (paragraphs.empty()) return {};
  return fmt::format(".SS {}\n{}",
                     roff(heading.empty() ? rarely_needed : std::string_view(heading)), paragraphs);
}

std::string exit_status() {
  constexpr std::array<std::pair<ExitCode, std::string_view>, 6> codes{
      {{exit_done, "The results are written."},
       {exit_failed, "A result could not be written, or memory did not suffice."},
       {exit_wrong_usage, "Wrong usage."},
       {exit_bad_input,
        "A file cannot be used; the message says what is wrong, where, and what to do."},
       {exit_not_accurate,
        "The results are written, but are less exact than asked for; of 'validate': a case fails."},
       {exit_interrupted, "Interrupted."}}};
  std::string text = ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : codes)
    text += fmt::format(".TP\n{}\n{}\n", static_cast<int>(code), meaning);
  return text;
}

}  // namespace

std::string man_page(const CommandText& command) {
  std::string page = header("lightwell-" + command.name);
  page += fmt::format(".SH NAME\nlightwell\\-{} \\- {}\n.SH SYNOPSIS\n{}", roff(command.name),
                      roff(command.summary()), synopsis(command));
  page += fmt::format(".SH DESCRIPTION\n{}\n", roff(command.description));
  for (const OptionText& option : command.options) {
    if (option.is_positional) page += paragraph(option);
  }
  page += ".SH OPTIONS\n";
  for (const std::string& heading : headings(command)) page += options_under(command, heading);
  constexpr std::string_view example = "Example: ";
  if (command.footer.starts_with(example)) {
    page += fmt::format(".SH EXAMPLE\n.EX\n{}\n.EE\n",
                        roff(std::string_view(command.footer).substr(example.size())));
  }
  return page + exit_status() + ".SH SEE ALSO\n.BR lightwell (1)\n";
}

std::string man_page_of_program(std::span<const CommandText> program_and_commands) {
  const CommandText& program = program_and_commands.front();
  std::string page = header(program.name);
  page += fmt::format(
      ".SH NAME\n{0} \\- {1}\n.SH SYNOPSIS\n.B {0}\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] "
      "\\fIFILES\\fR\n"
      ".SH DESCRIPTION\nComputes the light in a room once, and shows it from everywhere.\n"
      ".SH COMMANDS\n",
      program.name, roff(program.description));
  std::vector<std::string> pages;
  for (const CommandText& command : program_and_commands.subspan(1)) {
    page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(command.name), roff(command.description));
    pages.push_back(fmt::format(".BR {}\\-{} (1)", program.name, roff(command.name)));
  }
  page += ".SH OPTIONS\n";
  for (const std::string& heading : headings(program)) page += options_under(program, heading);
  return page + exit_status() + fmt::format(".SH SEE ALSO\n{}\n", fmt::join(pages, ",\n"));
}

}  // namespace lightwell
