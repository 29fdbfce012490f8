#include "radiosity/journal/journal.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <set>
#include <thread>

#include "radiosity/journal/journal_format.h"
#include "radiosity/journal/journal_phase.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/temporary_folder.h"

namespace lightwell::journal_test {
namespace {
namespace fs = std::filesystem;

constexpr double never = 1e6;  // seconds

Provenance some_solve() {
  return {.version = "1.2",
          .scene_file = "rooms/office.toml",
          .scene_hash = 0x0123456789abcdef,
          .options = "--max-patch-size 0.5 --discontinuity --rays 512"};
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// Bytes of a block: of a length of its own for every phase and block.
std::vector<std::byte> block_bytes(int phase, int block) {
  return bytes_of(std::string(static_cast<std::size_t>(5 * block + phase), 'a' + block) + "!");
}

constexpr int phase_count = 2, block_count = 4;

int phase_of(Journal& journal, int p) {
  return journal.phase(p == 0 ? "rays" : "gather", 77u + static_cast<unsigned>(p));
}

std::vector<std::byte> state_bytes(int number) {
  return bytes_of("state " + std::to_string(number));
}

// File for the tests to damage: blocks of two phases and the second state of one phase.
std::string small_journal(const TemporaryFolder& folder) {
  const fs::path file = folder / "small";
  Journal journal(file, some_solve(), never);
  for (int p = 0; p < phase_count; ++p) {
    const int phase = phase_of(journal, p);
    for (int b = 0; b < block_count; ++b) journal.keep(phase, b, block_bytes(p, b));
  }
  journal.keep_state(phase_of(journal, 1), state_bytes(1));
  journal.close();
  Journal again(file, some_solve(), never);
  again.keep_state(phase_of(again, 1), state_bytes(2));
  again.close();
  return content_of(file);
}

// Number of blocks that can be recalled, each checked against its content.
int right_blocks(Journal& journal) {
  int found = 0;
  std::vector<std::byte> bytes;
  for (int p = 0; p < phase_count; ++p) {
    const int phase = phase_of(journal, p);
    for (int b = 0; b < block_count; ++b) {
      if (!journal.recall(phase, b, bytes)) continue;
      EXPECT_EQ(bytes, block_bytes(p, b));
      ++found;
    }
  }
  return found;
}

// Number of the recalled state; 0: none.
int right_state(Journal& journal) {
  std::vector<std::byte> bytes;
  if (!journal.recall_state(phase_of(journal, 1), bytes)) return 0;
  for (const int number : {1, 2}) {
    if (bytes == state_bytes(number)) return number;
  }
  ADD_FAILURE() << "a state that nobody kept";
  return -1;
}

TEST(Journal, GivesBackWhatWasKept) {
  TemporaryFolder folder;
  small_journal(folder);
  Journal journal(folder / "small", some_solve(), never);
  EXPECT_EQ(right_blocks(journal), phase_count * block_count);
  EXPECT_EQ(right_state(journal), 2);
  EXPECT_EQ(journal.torn(), 0);
  std::vector<std::byte> bytes;
  EXPECT_FALSE(journal.recall(phase_of(journal, 0), block_count, bytes));
  // Another fingerprint means another phase, of which nothing was kept.
  EXPECT_FALSE(journal.recall(journal.phase("rays", 1), 0, bytes));
}

TEST(Journal, ItsFirstLinesSayWhoseItIs) {
  TemporaryFolder folder;
  const std::string content = small_journal(folder);
  EXPECT_TRUE(says(content,
                   "lightwell-checkpoint 1\nversion: 1.2\nscene: rooms/office.toml\nhash: "
                   "0123456789abcdef\noptions: --max-patch-size 0.5"));
}

TEST(Journal, HoldsWorkOnceABlockIsKept) {
  TemporaryFolder folder;
  const fs::path file = folder / "C";
  { Journal journal(file, some_solve(), never); }
  EXPECT_FALSE(Journal::holds_work(file));
  {
    Journal journal(file, some_solve(), never);
    EXPECT_EQ(journal.found(), 0);
    journal.keep(journal.phase("rays", 1), 0, {});
  }
  EXPECT_TRUE(Journal::holds_work(file));
}

// A process may end at any moment: all work before remains, and the resumed journal becomes whole.
TEST(Journal, IsNotOpenedOverFinishedWorkUnlessItIsResumed) {
  const TemporaryFolder folder;
  small_journal(folder);
  const fs::path file = folder / "small";
  EXPECT_THROW(Journal::open(file, some_solve(), never, false), InputError);
  EXPECT_GT(Journal::open(file, some_solve(), never, true)->found(), 0);
  // A file without finished work is begun anew, whatever solve it is of.
  const fs::path empty = folder / "empty";
  Journal(empty, some_solve(), never).close();
  Provenance other = some_solve();
  other.options = "--rays 256";
  EXPECT_THROW(Journal::open(empty, other, never, true), InputError);
  EXPECT_EQ(Journal::open(empty, other, never, false)->of().options, other.options);
}

TEST(Journal, CutOffAnywhereItHoldsWhatLiesBefore) {
  TemporaryFolder folder;
  const std::string whole = small_journal(folder);
  const std::size_t header = journal_header(some_solve()).size();
  int last_blocks = 0, last_state = 0;
  for (std::size_t size = header; size <= whole.size(); ++size) {
    const fs::path file = folder.write("cut", whole.substr(0, size));
    {
      Journal journal(file, some_solve(), never);
      const int blocks = right_blocks(journal), state = right_state(journal);
      EXPECT_GE(blocks, last_blocks) << size;
      last_blocks = blocks;
      last_state = state;
      std::vector<std::byte> bytes;
      for (int p = 0; p < phase_count; ++p) {
        const int phase = phase_of(journal, p);
        for (int b = 0; b < block_count; ++b) {
          if (!journal.recall(phase, b, bytes)) journal.keep(phase, b, block_bytes(p, b));
        }
      }
    }
    Journal journal(file, some_solve(), never);
    EXPECT_EQ(journal.torn(), 0) << size;
    EXPECT_EQ(right_blocks(journal), phase_count * block_count) << size;
  }
  EXPECT_EQ(last_blocks, phase_count * block_count);
  EXPECT_EQ(last_state, 2);
}

TEST(Journal, CutOffInItsFirstLinesItIsRefused) {
  TemporaryFolder folder;
  const std::string whole = small_journal(folder);
  const std::size_t header = journal_header(some_solve()).size();
  for (std::size_t size = 0; size < header; ++size) {
    const fs::path file = folder.write("cut", whole.substr(0, size));
    EXPECT_THROW(Journal(file, some_solve(), never), InputError) << size;
    EXPECT_EQ(content_of(file).size(), size) << "a refused file is not touched";
  }
}

// A file with one flipped bit never yields wrong data. In records synced to disk, the file is
// refused; in a state, the older slot serves.
TEST(Journal, OneTurnedBitIsFoundOut) {
  TemporaryFolder folder;
  const std::string whole = small_journal(folder);
  int refused = 0, went_on = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string turned = whole;
    turned[at] = static_cast<char>(turned[at] ^ (1 << (at % 8)));
    const fs::path file = folder.write("turned", turned);
    try {
      Journal journal(file, some_solve(), never);
      right_blocks(journal);
      right_state(journal);
      ++went_on;
    } catch (const InputError&) {
      ++refused;
    }
  }
  std::printf("%d of %zu turned bits refused, %d harmless\n", refused, whole.size(), went_on);
  // All bits except those in the slots and in the last mark.
  const std::size_t states = 2 * (sizeof(StateHead) + state_bytes(1).size() * 3 / 2);
  const std::size_t mark = sizeof(RecordHead) + sizeof(std::uint64_t);
  EXPECT_GE(static_cast<std::size_t>(refused), whole.size() - states - mark);
}

TEST(Journal, SizesBeyondTheFileAreATornEnd) {
  TemporaryFolder folder;
  const std::string whole = small_journal(folder);
  for (const RecordKind kind : {RecordKind::phase, RecordKind::block, RecordKind::slots,
                                RecordKind::mark, static_cast<RecordKind>(99)}) {
    for (const std::uint64_t size :
         {std::uint64_t{1}, std::uint64_t{1} << 40U, std::uint64_t{1} << 63U, ~std::uint64_t{0},
          ~std::uint64_t{0} - 31}) {
      // The checksum is valid for kinds whose checksum covers the head alone.
      const auto record = journal_record({.kind = kind, .phase = 1, .size = size}, {});
      const fs::path file = folder.write(
          "huge", whole + std::string(reinterpret_cast<const char*>(record.data()), record.size()));
      Journal journal(file, some_solve(), never);
      EXPECT_EQ(right_blocks(journal), phase_count * block_count);
      EXPECT_EQ(journal.torn(), static_cast<std::int64_t>(record.size()));
    }
  }
}

// After a power loss the end of a file may hold anything, even whole records far behind.
TEST(Journal, GarbageThatWasNeverConfirmedIsCutOff) {
  TemporaryFolder folder;
  const std::string whole = small_journal(folder);
  const auto block =
      journal_record({.kind = RecordKind::block, .phase = 0, .block = 9, .size = 0}, {});
  const std::string text(reinterpret_cast<const char*>(block.data()), block.size());
  const fs::path file = folder.write("torn", whole + std::string(5000, '\0') + text);
  Journal journal(file, some_solve(), never);
  EXPECT_EQ(right_blocks(journal), phase_count * block_count);
  std::vector<std::byte> bytes;
  EXPECT_FALSE(journal.recall(phase_of(journal, 0), 9, bytes));
  EXPECT_EQ(journal.torn(), 5000 + static_cast<std::int64_t>(text.size()));
}

TEST(Journal, OnlyTheLatestStateTakesRoom) {
  TemporaryFolder folder;
  const fs::path file = folder / "C";
  std::int64_t first_size = 0;
  for (int number = 1; number <= 200; ++number) {
    Journal journal(file, some_solve(), never);
    std::vector<std::byte> bytes;
    const int phase = journal.phase("shots", 5);
    ASSERT_EQ(journal.recall_state(phase, bytes), number > 1);
    if (number > 1) {
      EXPECT_EQ(bytes, state_bytes(1000 + number - 1));
    }
    journal.keep_state(phase, state_bytes(1000 + number));
    journal.close();
    if (number == 1) first_size = journal.size();
  }
  const std::size_t mark = sizeof(RecordHead) + sizeof(std::uint64_t);  // one mark per process
  EXPECT_EQ(fs::file_size(file), static_cast<std::size_t>(first_size) + 199 * mark);
}

TEST(Journal, AStateMayGrow) {
  TemporaryFolder folder;
  const fs::path file = folder / "C";
  std::vector<std::byte> bytes;
  for (std::size_t size = 1; size < 100000; size *= 3) {
    Journal journal(file, some_solve(), never);
    const int phase = journal.phase("shots", 5);
    if (size > 1) {
      EXPECT_TRUE(journal.recall_state(phase, bytes));
      EXPECT_EQ(bytes, std::vector(size / 3, std::byte{7}));
    }
    journal.keep_state(phase, std::vector(size, std::byte{7}));
  }
}

TEST(Journal, ManyThreadsKeepAndRecall) {
  TemporaryFolder folder;
  constexpr int count = 20000;
  const auto bytes_at = [](int i) {
    return std::vector(static_cast<std::size_t>(i % 700), static_cast<std::byte>(i));
  };
  const ThreadLimit limit(3);
  {
    Journal journal(folder / "C", some_solve(), 0.01);
    const int phase = journal.phase("rays", 1);
    parallel_for(count, 16, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) journal.keep(phase, i, bytes_at(i));
    });
  }
  const Journal journal(folder / "C", some_solve(), 0.01);
  parallel_for(count, 16, [&](int begin, int end) {
    std::vector<std::byte> bytes;
    for (int i = begin; i < end; ++i) {
      EXPECT_TRUE(journal.recall(0, i, bytes));
      EXPECT_EQ(bytes, bytes_at(i));
    }
  });
}

// Blocks larger than the buffer, and larger than the pieces of a checksum.
TEST(Journal, BlocksMayBeLarge) {
  TemporaryFolder folder;
  std::vector<std::byte> large(3 * Journal::most_buffered + 5);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::byte>(i * i >> 7U);
  {
    Journal journal(folder / "C", some_solve(), never);
    for (int b = 0; b < 3; ++b) journal.keep(journal.phase("rays", 1), b, large);
  }
  Journal journal(folder / "C", some_solve(), never);
  std::vector<std::byte> bytes;
  for (int b = 0; b < 3; ++b) {
    ASSERT_TRUE(journal.recall(0, b, bytes));
    EXPECT_EQ(bytes, large);
  }
}

TEST(Journal, WorkIsOnTheDiskSoonWithoutClosing) {
  TemporaryFolder folder;
  Journal journal(folder / "C", some_solve(), 0.05);
  journal.keep(journal.phase("rays", 1), 0, block_bytes(0, 0));
  for (int i = 0; i < 200 && !Journal::holds_work(folder / "C"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_TRUE(Journal::holds_work(folder / "C"));
}

TEST(Journal, RefusesAnotherSolve) {
  TemporaryFolder folder;
  small_journal(folder);
  const auto refusal = [&](const Provenance& of) {
    return message_of<InputError>([&] { Journal(folder / "small", of, never); });
  };
  Provenance of = some_solve();
  of.version = "1.3";
  EXPECT_TRUE(says(refusal(of), "was made by version 1.2, and this is version 1.3"));
  of = some_solve();
  of.scene_hash = 0xfeed;
  of.scene_file = "other.toml";
  EXPECT_TRUE(says(refusal(of),
                   "is of another scene: of 'rooms/office.toml' (hash 0123456789abcdef), while "
                   "'other.toml' has hash 000000000000feed"));
  of = some_solve();
  of.options = "--max-patch-size 0.25 --rays 512 --refine off";
  const std::string sentence = refusal(of);
  EXPECT_TRUE(says(sentence, "with --max-patch-size 0.5, now it is --max-patch-size 0.25;"));
  EXPECT_TRUE(says(sentence, "with --discontinuity, now it is no --discontinuity"));
  EXPECT_TRUE(says(sentence, "with no --refine, now it is --refine off"));
  EXPECT_EQ(sentence.find("--rays"), std::string::npos) << "that one is the same";
  of = some_solve();
  of.scene_file = "moved/office.toml";
  EXPECT_EQ(refusal(of), "") << "where the scene lies does not matter";
}

TEST(Journal, RefusesWhatIsNoJournal) {
  TemporaryFolder folder;
  const auto refusal = [&](const std::string& content) {
    const fs::path file = folder.write("C", content);
    return message_of<InputError>([&] { Journal(file, some_solve(), never); });
  };
  EXPECT_TRUE(says(refusal("unit = \"m\"\n"), "the file is something else"));
  EXPECT_TRUE(says(refusal(""), "is an empty file"));
  EXPECT_TRUE(says(refusal("lightwell-checkpoint 9\nversion: 9\n"), "has format 9, and this"));
  EXPECT_TRUE(says(refusal("lightwell-checkpoint 1\nversion: 9\n"), "is damaged: its first lines"));
}

TEST(Journal, IsUsedByOneAtATime) {
  TemporaryFolder folder;
  const Journal journal(folder / "C", some_solve(), never);
  EXPECT_TRUE(says(message_of<InputError>([&] { Journal(folder / "C", some_solve(), never); }),
                   "is in use by another process"));
}

TEST(Journal, AFolderThatIsNotThereIsSaidAtOnce) {
  TemporaryFolder folder;
  EXPECT_THROW(Journal(folder / "none/C", some_solve(), never), std::runtime_error);
  EXPECT_THROW(Journal(folder / "C", some_solve(), 0.0), std::invalid_argument);
}

// A full disk, for this process alone.
class LimitedFiles {
 public:
  explicit LimitedFiles(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~LimitedFiles() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  LimitedFiles(const LimitedFiles&) = delete;
  LimitedFiles& operator=(const LimitedFiles&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(Journal, AFullDiskStopsItAndNotTheWork) {
  TemporaryFolder folder;
  constexpr int count = 5000;
  const std::vector<std::byte> bytes(1000, std::byte{3});
  {
    Journal journal(folder / "C", some_solve(), 0.01);
    const LimitedFiles limit(1 << 20);
    const int phase = journal.phase("rays", 1);
    for (int i = 0; i < count; ++i) journal.keep(phase, i, bytes);
    journal.keep_state(phase, bytes);
    journal.close();
    EXPECT_TRUE(says(journal.failure(), "cannot be written any more: File too large"));
  }
  Journal journal(folder / "C", some_solve(), never);
  int found = 0;
  std::vector<std::byte> back;
  while (journal.recall(0, found, back)) {
    ASSERT_EQ(back, bytes);
    ++found;
  }
  std::printf("%d blocks of 1000 bytes in 1 MiB\n", found);
  EXPECT_GT(found, 500);
  EXPECT_LT(found, 1049);
  EXPECT_LT(journal.torn(), 1100) << "of what was written, one record is not whole at most";
}

TEST(JournalPhase, WithoutAJournalNothingIsKept) {
  bool was_asked = false;
  JournalPhase phase({}, "rays", [&](Fingerprint&) { was_asked = true; });
  int number = 5;
  phase.keep(0, number);
  phase.keep_state(number);
  EXPECT_FALSE(phase.recall(0, number));
  EXPECT_FALSE(phase.recall_state(number));
  EXPECT_FALSE(phase.is_state_due());
  EXPECT_FALSE(was_asked) << "fingerprints take time";
}

TEST(JournalPhase, SlicesThatWereKeptAreNotDoneAgain) {
  TemporaryFolder folder;
  constexpr int count = 1003;
  const auto print = [](Fingerprint& fingerprint) { fingerprint.add(count); };
  const auto run = [&](int stop, std::vector<double>& squares) {
    Journal journal(folder / "C", some_solve(), never);
    const JournalPhase phase({.journal = &journal}, "squares", print);
    std::atomic<int> done = 0;
    squares.assign(count, -1.0);
    try {
      for_each_slice(
          phase, count, 100, 7,
          [&](int begin, int size) { return std::tuple(std::span(squares).subspan(begin, size)); },
          [&](int begin) {
            if (begin >= stop) throw Interrupted();
          },
          [&](int begin, int end) {
            for (int i = begin; i < end; ++i) squares[i] = static_cast<double>(i) * i;
            done += end - begin;
          });
    } catch (const Interrupted&) {
    }
    return done.load();
  };
  std::vector<double> squares;
  EXPECT_EQ(run(350, squares), 400);
  EXPECT_EQ(run(800, squares), 400);
  EXPECT_EQ(run(count, squares), count - 800);
  for (int i = 0; i < count; ++i) EXPECT_EQ(squares[i], static_cast<double>(i) * i);
  EXPECT_EQ(run(count, squares), 0);
}

TEST(Fingerprint, EveryBitAndTheOrderCount) {
  const auto of = [](const std::vector<double>& values) {
    Fingerprint print;
    print.add(values);
    return print.value();
  };
  const std::vector<double> values = {1.0, -2.0, 3.0, 4.0};
  std::set<std::uint64_t> found = {of(values), of({-2.0, 1.0, 3.0, 4.0}), of({1.0, -2.0, 3.0})};
  int count = 3;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int bit = 0; bit < 64; ++bit) {
      std::vector<double> turned = values;
      std::uint64_t word = 0;
      std::memcpy(&word, &turned[i], sizeof word);
      word ^= std::uint64_t{1} << static_cast<unsigned>(bit);
      std::memcpy(&turned[i], &word, sizeof word);
      found.insert(of(turned));
      ++count;
    }
  }
  // Two flipped signs: the highest bits, which multiplication alone would keep separate from all
  // others.
  found.insert(of({-1.0, 2.0, 3.0, 4.0}));
  found.insert(of({1.0, -2.0, -3.0, -4.0}));
  found.insert(of({-1.0, -2.0, -3.0, 4.0}));
  EXPECT_EQ(static_cast<int>(found.size()), count + 3);
}

}  // namespace
}  // namespace lightwell::journal_test
