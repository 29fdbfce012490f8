// Rows read back equal the rows added, in memory or on disk.
#include "radiosity/rows/row_store.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <numeric>

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/rows/column_block.h"
#include "radiosity/rows/spill_file.h"
#include "radiosity/rows/symmetric_rows.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "tests/sanitizers.h"
#include "tests/temporary_folder.h"

namespace lightwell::row_store_test {
namespace {

constexpr std::int64_t megabyte = 1 << 20;

std::shared_ptr<MemoryBudget> budget_of(std::int64_t rows, const TemporaryFolder& folder) {
  return std::make_shared<MemoryBudget>(MemoryOptions{.rows = rows, .folder = folder / ""});
}

// Test row: empty, of a few records, or longer than a chunk of 4096 bytes; columns ascend.
std::vector<FormFactor> row_of(int i, int n) {
  const auto key = static_cast<std::uint64_t>(i);
  const double share = i % 7 == 0 ? 0.0 : i % 11 == 0 ? 0.9 : 0.05;
  std::vector<FormFactor> row;
  for (int j = 0; j < n; ++j) {
    if (random_uniform(random_key(key, static_cast<std::uint64_t>(j))) < share) {
      row.push_back({j, static_cast<float>(i) + static_cast<float>(j) / static_cast<float>(n)});
    }
  }
  return row;
}

void expect_same(std::span<const FormFactor> found, const std::vector<FormFactor>& wanted, int i) {
  ASSERT_EQ(found.size(), wanted.size()) << "row " << i;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    ASSERT_EQ(found[k].patch, wanted[k].patch) << "row " << i;
    ASSERT_EQ(found[k].value, wanted[k].value) << "row " << i;
  }
}

// Bytes of rows that may stay in memory: all, some, none.
class RowsKept : public testing::TestWithParam<std::int64_t> {};

TEST_P(RowsKept, ComeBackAsTheyWereInAnyOrder) {
  constexpr int n = 900;
  const TemporaryFolder folder;
  const auto budget = budget_of(GetParam(), folder);
  RowStore<FormFactor> rows(budget, n);
  std::int64_t records = 0;
  for (int k = 0; k < n; ++k) {
    const int i = (k * 7) % n;  // each once: 7 and 900 have no factor in common
    const auto row = row_of(i, n);
    records += static_cast<std::int64_t>(row.size());
    rows.append(i, row);
  }
  rows.close();
  EXPECT_EQ(rows.record_count(), records);
  for (const int step : {1, 101}) {
    for (int k = 0; k < n; ++k) {
      const int i = (k * step) % n;
      expect_same(rows.row(i), row_of(i, n), i);
    }
  }
  const StorageReport report = budget->report();
  EXPECT_GE(report.most_in_memory + report.most_on_disk,
            records * static_cast<std::int64_t>(sizeof(FormFactor)));
  const std::int64_t most = GetParam() >= 0 ? GetParam() : std::numeric_limits<std::int64_t>::max();
  EXPECT_LE(report.most_in_memory, most);
  EXPECT_EQ(report.most_on_disk > 0, GetParam() >= 0);
  EXPECT_EQ(folder.file_count(), 0) << "the file has no name";
}

TEST_P(RowsKept, StayReadableWhileOthersAreReleased) {
  constexpr int n = 900;
  const TemporaryFolder folder;
  const auto budget = budget_of(GetParam(), folder);
  RowStore<FormFactor> rows(budget, n);
  for (int i = 0; i < n; ++i) rows.append(i, row_of(i, n));
  rows.close();
  const auto last = rows.row(n - 1);
  for (int i = 0; i < n - 1; ++i) {
    rows.release(i);
    EXPECT_TRUE(rows.row(i).empty());
  }
  expect_same(last, row_of(n - 1, n), n - 1);
  // The space of released rows is reused, on disk as in memory.
  const StorageReport before = budget->report();
  RowStore<FormFactor> again(budget, n);
  for (int i = 0; i < n; ++i) again.append(i, row_of(i, n));
  again.close();
  for (int i = 0; i < n; ++i) expect_same(again.row(i), row_of(i, n), i);
  expect_same(rows.row(n - 1), row_of(n - 1, n), n - 1);
  constexpr std::int64_t last_chunks = 64 << 10;  // one chunk is still in use, one more is needed
  EXPECT_LE(budget->report().most_on_disk, before.most_on_disk + last_chunks);
}

TEST_P(RowsKept, ManyThreadsMayAddThem) {
  constexpr int n = 900;
  const TemporaryFolder folder;
  RowStore<FormFactor> rows(budget_of(GetParam(), folder), n);
  const ThreadLimit threads(4);
  parallel_for(n, 3, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) rows.append(i, row_of(i, n));
  });
  rows.close();
  parallel_for(n, 3, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) expect_same(rows.row(i), row_of(i, n), i);
  });
}

// Columns of either triangle, block by block, equal the transpose.
TEST_P(RowsKept, ColumnsAreWhatRowsSay) {
  constexpr int n = 400;
  using Count = RecordStore::Count;
  const TemporaryFolder folder;
  for (const Count triangle : {Count::below_diagonal, Count::above_diagonal}) {
    RowStore<FormFactor> rows(budget_of(GetParam(), folder), n, triangle);
    std::vector<std::vector<FormFactor>> columns(n);
    for (int i = 0; i < n; ++i) {
      const auto row = row_of(i, n);
      rows.append(i, row);
      for (const FormFactor& f : row) {
        const bool counts = triangle == Count::below_diagonal ? f.patch < i : f.patch > i;
        if (counts) columns[static_cast<std::size_t>(f.patch)].push_back({i, f.value});
      }
    }
    rows.close();
    int covered = 0;
    for (const ColumnRange range : column_ranges(rows.records(), 20000)) {
      const ColumnBlock block(rows.records(), range.first, range.last);
      for (int j = range.first; j < range.last; ++j, ++covered) {
        expect_same(block.column(j).as<FormFactor>(), columns[static_cast<std::size_t>(j)], j);
      }
    }
    EXPECT_EQ(covered, n) << "every column once";
    EXPECT_GT(column_ranges(rows.records(), 20000).size(), 2u) << "the case has several blocks";
  }
}

INSTANTIATE_TEST_SUITE_P(Bytes, RowsKept, testing::Values(-1, 100000, 0), [](const auto& tested) {
  return tested.param < 0 ? "AllInMemory" : tested.param > 0 ? "Some" : "AllOnDisk";
});

// y = S x from one triangle. All sums are exact in these numbers, so their order does not matter.
TEST(SymmetricRows, MultiplyAsTheWholeMatrixDoes) {
  constexpr int n = 300;
  const TemporaryFolder folder;
  RecordStore upper(budget_of(0, folder), n, sizeof(FormFactor),
                    RecordStore::Count::above_diagonal);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    std::vector<FormFactor> row;
    for (int j = i; j < n; j += 1 + (i + j) % 5) {
      row.push_back({j, static_cast<float>((i * 31 + j * 17) % 64)});
      S(i, j) = S(j, i) = row.back().value;
    }
    upper.append(i, row.data(), row.size());
  }
  upper.close();
  Eigen::VectorXd x(n), own = Eigen::VectorXd::Zero(n), below = own;
  for (int i = 0; i < n; ++i) x[i] = i % 13;
  read_symmetric(
      upper,
      [&](int i, RecordSpan row) {
        for (const FormFactor& f : row.as<FormFactor>()) own[i] += f.value * x[f.patch];
      },
      [&](int i, std::size_t k, RecordSpan row) {
        const FormFactor& f = row.as<FormFactor>()[k];
        below[f.patch] += f.value * x[i];
      });
  EXPECT_EQ(own + below, S * x);
  unfold_symmetric(upper, [&](int i, RecordSpan left, RecordSpan right) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
    for (const RecordSpan part : {left, right}) {
      for (const FormFactor& f : part.as<FormFactor>()) row[f.patch] = f.value;
    }
    EXPECT_EQ(row, S.row(i).transpose()) << i;
  });
}

// Pages read long ago leave memory: 64 MB are read through a window of 16 MB / 8.
TEST(SpilledRows, DoNotStayResidentOnceRead) {
  const TemporaryFolder folder;
  RowStore<FormFactor> rows(budget_of(16 * megabyte, folder), 1000);
  const std::vector<FormFactor> row(8192, FormFactor{1, 0.5f});
  const std::int64_t before = resident_memory().now;
  for (int i = 0; i < 1000; ++i) rows.append(i, row);
  rows.close();
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(rows.row(i)[8191].value, 0.5f);
  // 16 MB of rows, the window, the chunk being filled, and some memory for the rest of the process.
  if (test::memory_is_its_own) {
    EXPECT_LT(resident_memory().now - before, 24 * megabyte);
  }
}

/// A full disk: limits the size of files during the object's lifetime.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(SpilledRows, AFullDiskIsASentenceAndNoSignal) {
  const TemporaryFolder folder;
  RowStore<FormFactor> rows(budget_of(0, folder), 1000);
  const std::vector<FormFactor> row(8192, FormFactor{1, 0.5f});
  int added = 0;
  std::string message;
  {
    const FullDisk full(megabyte);
    message = message_of<std::runtime_error>([&] {
      for (; added < 1000; ++added) rows.append(added, row);
    });
  }
  EXPECT_TRUE(says(message, folder / ""));
  EXPECT_TRUE(says(message, "could not be written"));
  EXPECT_LT(added, 20) << "a megabyte holds 16 of these rows";
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(SpilledRows, AFolderThatTakesNoFileIsNamed) {
  const TemporaryFolder folder;
  const auto budget =
      std::make_shared<MemoryBudget>(MemoryOptions{.rows = 0, .folder = folder / "missing"});
  RowStore<FormFactor> rows(budget, 2);
  rows.append(0, std::vector<FormFactor>{{1, 0.5f}});
  EXPECT_TRUE(says(message_of<std::runtime_error>([&] { rows.close(); }), "missing"));
}

TEST(MemoryBudget, OneThatIsTooSmallSaysWhatIsNeeded) {
  MemoryBudget budget({.limit = megabyte});
  const std::string message = message_of<InputError>([&] { budget.plan(100 * megabyte); });
  EXPECT_TRUE(says(message, "a memory budget of 1 MB is too small"));
  EXPECT_TRUE(says(message, "work 100 MB more"));
  MemoryBudget unlimited;
  unlimited.plan(std::int64_t{1} << 50);  // without a limit any amount is accepted
}

// All resident memory of the process counts, whoever allocated it.
TEST(MemoryBudget, LeavesRoomForWhatElseIsThere) {
  const std::int64_t limit = resident_memory().now + 40 * megabyte;
  MemoryBudget budget({.limit = limit});
  EXPECT_TRUE(budget.take(megabyte));
  const std::vector<char> other(40 * megabyte, 1);
  EXPECT_FALSE(budget.take(megabyte));
  EXPECT_EQ(budget.report().limit, limit);
}

TEST(MemoryBudget, KnowsWhatThisProcessUses) {
  const ResidentMemory before = resident_memory();
  EXPECT_GT(before.now, megabyte);
  EXPECT_GE(before.most, before.now);
  const std::vector<char> more(30 * megabyte, 1);
  const auto added = static_cast<double>(resident_memory().now - before.now);
  EXPECT_GE(added, 27.0 * megabyte);
  if (test::memory_is_its_own) {
    EXPECT_LE(added, 33.0 * megabyte);
  }
  EXPECT_GT(usable_memory(), before.now);
}

}  // namespace
}  // namespace lightwell::row_store_test
