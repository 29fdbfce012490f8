// Targets of the files that Lightwell writes and reads again.
#include <fcntl.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <ranges>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "radiosity/journal/journal.h"
#include "radiosity/journal/journal_format.h"
#include "radiosity/journal/packed.h"
#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace lightwell::fuzz {
namespace {

JournalContents journal_contents(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw std::runtime_error("the input cannot be opened");
  try {
    JournalContents contents = read_journal(file, path);
    ::close(file);
    return contents;
  } catch (...) {
    ::close(file);
    throw;
  }
}

// Takes values of the kinds that phases keep out of the bytes of a block.
void unpack(std::span<const std::byte> bytes) {
  std::vector<float> numbers;
  Unpacked(bytes).take(numbers);
  Eigen::ArrayXXd table;
  Unpacked(bytes).take(table);
  std::tuple<int, std::vector<std::uint64_t>, Eigen::Array3f, Eigen::ArrayXXf> several;
  Unpacked(bytes).take(several);
}

// Blocks and states that the journal recalls; the first of very many.
int recall_all(Journal& journal, const JournalContents& contents) {
  constexpr std::size_t most_phases = 32;
  constexpr int most_blocks = 64;
  int recalled = 0;
  std::vector<std::byte> bytes;
  for (std::size_t p = 0; p < std::min(contents.phases.size(), most_phases); ++p) {
    const JournalContents::Phase& phase = contents.phases[p];
    const int number = journal.phase(phase.name, phase.fingerprint);
    for (const auto& block : std::views::keys(phase.blocks) | std::views::take(most_blocks)) {
      if (!journal.recall(number, static_cast<int>(block), bytes)) continue;
      unpack(bytes);
      ++recalled;
    }
    if (journal.recall_state(number, bytes)) unpack(bytes);
  }
  return recalled;
}

}  // namespace

void read_solved(std::string_view bytes) {
  read_solution(input_file("solved.vtp", bytes));
}

// A checkpoint that is accepted must serve: what another solve recalls from it, a resumed solve
// recalls as well, and work that is kept in it is there at the next opening.
void read_checkpoint(std::string_view bytes) {
  constexpr double never = 1e6;  // seconds
  const auto path = input_file("solve.checkpoint", bytes);
  Journal::holds_work(path);
  const JournalContents contents = journal_contents(path);
  const int other = recall_all(*Journal::of_another_solve(path, contents.of.version), contents);
  constexpr std::string_view name = "fuzzed";
  constexpr std::uint64_t fingerprint = 0x1f2e3d4c;
  const std::vector<std::byte> work(100, std::byte{42});
  {
    Journal resumed(path, contents.of, never);
    if (recall_all(resumed, contents) != other) {
      throw std::logic_error("a resumed solve recalls other blocks than another solve");
    }
    const int phase = resumed.phase(name, fingerprint);
    std::vector<std::byte> before;
    if (!resumed.recall(phase, 0, before)) resumed.keep(phase, 0, work);
    resumed.keep_state(phase, work);
    resumed.close();
    if (!resumed.failure().empty()) throw std::logic_error("the checkpoint cannot be written");
  }
  Journal again(path, contents.of, never);
  std::vector<std::byte> found;
  const int phase = again.phase(name, fingerprint);
  if (!again.recall(phase, 0, found) || !again.recall_state(phase, found) || found != work) {
    throw std::logic_error("work that a checkpoint kept is lost");
  }
  again.remove();
}

}  // namespace lightwell::fuzz
