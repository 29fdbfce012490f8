#include "scene/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

#include "tests/temporary_folder.h"

namespace lightwell::atomic_file_test {
namespace {

TEST(AtomicStream, GivesTheFileItsNameWhenWhole) {
  const TemporaryFolder folder;
  folder.write("a", "old");
  {
    AtomicStream file(folder / "a");
    file.stream() << "half of";
    file.stream().flush();
    EXPECT_EQ(content_of(folder / "a"), "old");
  }
  EXPECT_EQ(folder.file_count(), 1) << "without commit() nothing is left";
  AtomicStream file(folder / "a");
  file.stream() << "new";
  file.commit();
  EXPECT_EQ(content_of(folder / "a"), "new");
  EXPECT_EQ(folder.file_count(), 1);
}

// Every write to the device /dev/full fails like a write to a full disk.
TEST(AtomicStream, RemembersWhyAWriteFailed) {
  ASSERT_TRUE(std::filesystem::exists("/dev/full"));
  const TemporaryFolder folder;
  const std::string part = "a." + std::to_string(::getpid()) + ".part";
  for (const std::size_t size : {std::size_t{1}, std::size_t{1} << 20}) {
    std::filesystem::create_symlink("/dev/full", folder / part);
    AtomicStream file(folder / "a");
    file.stream() << std::string(size, 'x');
    file.stream() << "more";  // a later failure does not replace the reason
    const std::string message = message_of<std::runtime_error>([&] { file.commit(); });
    EXPECT_EQ(message, (folder / "a").string() + ": cannot be written: No space left on device");
    EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  }
}

TEST(AtomicStream, NamesAFolderThatIsMissing) {
  const TemporaryFolder folder;
  EXPECT_TRUE(says(message_of<std::runtime_error>([&] { AtomicStream(folder / "none/a"); }),
                   "none/a: cannot be written: No such file or directory"));
}

}  // namespace
}  // namespace lightwell::atomic_file_test
