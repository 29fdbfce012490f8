#include "radiosity/solution/compressed_blocks.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "radiosity/solution/poly_data.h"
#include "radiosity/solution/poly_data_file.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/temporary_folder.h"

namespace lightwell::compressed_blocks_test {
namespace {

// Reads the head at the beginning of `text`; throws std::invalid_argument where it is refused.
BlockHead head_of(const std::string& text) {
  const auto read = [&](std::uint64_t place, std::uint64_t count) {
    std::vector<std::uint64_t> words(count);
    std::memcpy(words.data(), text.data() + place, sizeof(std::uint64_t) * count);
    return words;
  };
  return block_head(text.size(), read,
                    [](const std::string& reason) { throw std::invalid_argument(reason); });
}

std::string words(const std::vector<std::uint64_t>& values, std::size_t bytes_after = 0) {
  std::string text(sizeof(std::uint64_t) * values.size(), 'x');
  std::memcpy(text.data(), values.data(), text.size());
  return text + std::string(bytes_after, 'x');
}

std::string refusal(const std::string& text) {
  return message_of<std::invalid_argument>([&] { head_of(text); });
}

}  // namespace

TEST(CompressedBlocks, ComeBackAndAreTheSameOnAnyNumberOfThreads) {
  for (const std::size_t size : {0, 1, 32767, 32768, 32769, 200000}) {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(i * i % 251);
    const auto packed = [&](int threads) {
      const ThreadLimit limit(threads);
      return compressed_blocks(bytes);
    };
    const std::string text = packed(1);
    EXPECT_EQ(packed(3), text);
    const BlockHead head = head_of(text);
    ASSERT_EQ(head.bytes(), size);
    std::string again(size, 'x');
    const std::size_t begin = text.size() - head.compressed_bytes();
    EXPECT_TRUE(uncompress_blocks(head, {text.data() + begin, head.compressed_bytes()}, again));
    EXPECT_EQ(again, bytes);
  }
}

TEST(CompressedBlocks, HeadsThatCannotBeAreRefused) {
  EXPECT_TRUE(says(refusal(words({9, 32768, 0}, 16)), "more blocks than the file"));
  EXPECT_TRUE(says(refusal(words({1ULL << 40u, 0, 0})), "more blocks than the file"));
  EXPECT_TRUE(says(refusal(words({1, 0, 0, 8}, 8)), "size of a block"));
  EXPECT_TRUE(says(refusal(words({1, 16, 17, 8}, 8)), "size of a block"));
  EXPECT_TRUE(says(refusal(words({1, 16, 0, 0}, 8)), "longer than the file"));
  EXPECT_TRUE(says(refusal(words({1, 16, 0, 9}, 8)), "longer than the file"));
  // Zlib makes 1032 bytes of one at most.
  EXPECT_TRUE(says(refusal(words({1, 9 * 1032, 0, 8}, 8)), "longer than the file"));
}

// A file of two arrays, whose XML `change` alters.
class AlteredFile : public ::testing::Test {
 protected:
  std::string refusal_after(const std::string& from, const std::string& to) const {
    PolyData data;
    data.points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    data.corners = {0, 1, 2};
    data.ends = {3};
    add_strings(data.field, "names", {"a", "b"});
    const std::vector<int> numbers = {1, 2, 3};
    add_values(data.field, "numbers", numbers.data(), 3);
    std::string text;
    for (const std::string& piece : poly_data_text(std::move(data))) text += piece;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const std::filesystem::path path = folder_.write("a.vtp", text);
    return message_of<InputError>([&] { PolyDataFile file(path); });
  }
  TemporaryFolder folder_;
};

TEST_F(AlteredFile, CountsOffsetsAndPlacesAreChecked) {
  EXPECT_EQ(refusal_after("\"names\"", "\"names\""), "");
  EXPECT_TRUE(says(refusal_after("offset=\"0\"", "offset=\"0x\""), "the offset is no number"));
  EXPECT_TRUE(says(refusal_after("NumberOfPoints=\"3\"", "NumberOfPoints=\"3a\""),
                   "NumberOfPoints is no count"));
  EXPECT_TRUE(says(refusal_after("NumberOfTuples=\"2\"", "NumberOfTuples=\"two\""),
                   "NumberOfTuples is 'two'"));
  EXPECT_TRUE(says(refusal_after("NumberOfTuples=\"2\"", "NumberOfTuples=\"2000000\""),
                   "the count of values is wrong"));
  // The same array a thousand times takes a thousand times its bytes, which the file does not have.
  std::string copies;
  for (int i = 0; i < 1000; ++i) {
    copies +=
        "<DataArray type=\"Int32\" Name=\"n\" NumberOfTuples=\"0\" format=\"appended\" "
        "offset=\"0\"/>";
  }
  EXPECT_TRUE(says(refusal_after("<FieldData>", "<FieldData>" + copies), "is damaged"));
}

// The text before the data may end anywhere in the pieces of 64 KiB that it is read in.
TEST_F(AlteredFile, TheDataMayBeginAnywhere) {
  const std::string comment = "<!--" + std::string((1 << 16) - 1400, '.');
  for (int more = 0; more < 1000; more += 1) {
    if (refusal_after("<FieldData>", comment + std::string(static_cast<std::size_t>(more), '.') +
                                         "--><FieldData>") != "") {
      FAIL() << more;
    }
  }
}

}  // namespace lightwell::compressed_blocks_test
