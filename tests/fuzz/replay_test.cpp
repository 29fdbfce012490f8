// Replays the kept files through the targets of the fuzzer, in every build and without clang.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "radiosity/journal/journal.h"
#include "radiosity/journal/journal_format.h"
#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"
#include "tests/radiosity/small_solution.h"

namespace lightwell::replay_test {
namespace {

using fuzz::bytes_of_file;
using fuzz::Target;

fs::path corpus_of(const Target& target) {
  return fs::path(LIGHTWELL_FUZZ_FOLDER) / "corpus" / target.name;
}

std::vector<fs::path> files_of(const Target& target) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(corpus_of(target))) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

// The message of a refusal; empty if the file was read.
std::string refusal(const Target& target, const std::string& bytes) {
  return message_of<InputError>([&] { target.read(bytes); });
}

std::vector<Target> targets_with_checksums() {
  std::vector<Target> found;
  std::ranges::copy_if(fuzz::targets(), std::back_inserter(found),
                       [](const Target& target) { return target.mutate != nullptr; });
  return found;
}

std::string name_of(const testing::TestParamInfo<Target>& target) {
  return std::string(target.param.name);
}

class KeptFiles : public testing::TestWithParam<Target> {};
class GuardedFiles : public testing::TestWithParam<Target> {};

TEST_P(KeptFiles, AreReadOrRefused) {
  int read = 0;
  for (const fs::path& file : files_of(GetParam())) {
    SCOPED_TRACE(file.string());
    EXPECT_NO_THROW(read += refusal(GetParam(), bytes_of_file(file)).empty() ? 1 : 0);
  }
  // Without a sound file the fuzzer would have to find the format first.
  EXPECT_GT(read, 0);
}

// A refusal for the checksum would hide all that is behind it.
TEST_P(GuardedFiles, AreMutatedBehindTheirChecksums) {
  const Target& target = GetParam();
  std::mt19937 random(7);
  const auto change_a_byte = [&](std::string bytes, std::size_t) {
    if (!bytes.empty()) bytes[random() % bytes.size()] = static_cast<char>(random());
    return bytes;
  };
  constexpr int count = 200;
  int read = 0, at_the_checksum = 0;
  std::string file;
  for (const fs::path& each : files_of(target)) {
    file = bytes_of_file(each);
    if (refusal(target, file).empty()) break;
  }
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const std::string message = refusal(target, target.mutate(file, change_a_byte, seed));
    read += message.empty() ? 1 : 0;
    for (const char* words : {"checksum does not fit", "CRC error", "compressed data end early",
                              "first lines are not as they were written"}) {
      at_the_checksum += message.find(words) == std::string::npos ? 0 : 1;
    }
  }
  EXPECT_GT(read, 0);
  // One change in eight, or fewer, leaves the checksums as they are: 25 of 200, with a standard
  // deviation of 4.7, so that 50 are out of reach of chance.
  EXPECT_LT(at_the_checksum, count / 4);
}

INSTANTIATE_TEST_SUITE_P(Of, KeptFiles, testing::ValuesIn(fuzz::targets()), name_of);
INSTANTIATE_TEST_SUITE_P(Of, GuardedFiles, testing::ValuesIn(targets_with_checksums()), name_of);

// The message tells that the claim was refused, rather than the memory taken and the file found
// short.
TEST(KeptFilesThatClaimMuch, AreRefusedForTheClaim) {
  struct Claim {
    std::string_view target;
    const char *file, *message;
  };
  const std::vector<Claim> claims = {
      {"exr", "attribute-longer-than-the-file.exr", "does not end within the file"},
      {"exr", "channels-that-end-before-their-size.exr", "not what its type and its size say"},
      {"png", "wider-and-higher-than-its-bytes.png", "too short for its width and height"},
      {"exr", "wider-than-its-bytes.exr", "is too short for its"},
      {"png", "text-longer-than-the-file.png", "a chunk does not end"},
      {"ply", "list-of-a-billion-corners.ply", "the file ends within 'face'"},
      {"solution", "huge-offset-of-a-polygon.vtp", "corners than they say"},
  };
  for (const Claim& claim : claims) {
    const Target& target = *std::ranges::find(fuzz::targets(), claim.target, &Target::name);
    EXPECT_TRUE(
        says(refusal(target, bytes_of_file(corpus_of(target) / claim.file)), claim.message));
  }
}

// Kept files of formats that Lightwell writes. Run it once a format changes:
//   fuzz_test --gtest_also_run_disabled_tests --gtest_filter=*WrittenAnew
TEST(KeptFilesOfOurFormats, DISABLED_AreWrittenAnew) {
  const fs::path corpus = fs::path(LIGHTWELL_FUZZ_FOLDER) / "corpus";
  write_solution(corpus / "solution/small.vtp", small_solution(3));
  const fs::path file = corpus / "checkpoint/small.checkpoint";
  fs::remove(file);
  constexpr double never = 1e6;  // seconds
  Journal journal(file, small_solution(3).solution.provenance, never);
  for (const char* name : {"rays", "gather"}) {
    const int phase = journal.phase(name, 77);
    const std::string block(40, 'b'), state(10, 's');
    for (int b = 0; b < 3; ++b) journal.keep(phase, b, std::as_bytes(std::span(block)));
    journal.keep_state(phase, std::as_bytes(std::span(state)));
    journal.keep_state(phase, std::as_bytes(std::span(state)));
  }
  journal.close();
  // A number that no solve has: the block must take memory for itself alone.
  const std::string block(4, 'b');
  const auto record =
      journal_record({.kind = RecordKind::block, .block = (1U << 30U) - 1, .size = block.size()},
                     std::as_bytes(std::span(block)));
  std::ofstream(corpus / "checkpoint/huge-block-number.checkpoint", std::ios::binary)
      << bytes_of_file(file)
      << std::string(reinterpret_cast<const char*>(record.data()), record.size());
}

}  // namespace
}  // namespace lightwell::replay_test
