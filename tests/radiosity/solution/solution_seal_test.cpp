#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <vector>

#include "radiosity/solution/solution_file.h"
#include "radiosity/solution/solution_seal.h"
#include "scene/sampling.h"
#include "tests/radiosity/refused_solution.h"
#include "tests/radiosity/small_solution.h"

namespace lightwell::solution_seal_test {
namespace {

using SolutionSeal = SolutionFile;

TEST_F(SolutionSeal, TornFilesAreRefusedWhereverTheyEnd) {
  write_solution(file(), small_solution(3));
  const std::string whole = contents(file());
  for (std::size_t length = 0; length < whole.size(); length += length < 100 ? 7 : 97) {
    put(file("torn.vtp"), whole.substr(0, length));
    const std::string message = refusal(file("torn.vtp"));
    EXPECT_NE(message, "") << length << " of " << whole.size() << " bytes were accepted";
  }
  put(file("torn.vtp"), whole.substr(0, whole.size() / 2));
  expect_refused(file("torn.vtp"), "torn");
}

TEST_F(SolutionSeal, OneChangedByteIsNoticedAnywhere) {
  write_solution(file(), small_solution(3));
  const std::string whole = contents(file());
  for (std::size_t at = 0; at < whole.size(); at += 53) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    put(file("changed.vtp"), changed);
    EXPECT_NE(refusal(file("changed.vtp")), "") << "byte " << at;
  }
}

TEST_F(SolutionSeal, ForeignFilesAreRefusedWithTheReason) {
  expect_refused(file("none.vtp"), "no such file");
  expect_refused(folder_.path(), "folder");
  put(file("empty.vtp"), "");
  expect_refused(file("empty.vtp"), "empty");
  put(file("scene.toml"), "[camera]\nposition = [0, 0, 0]\n");
  expect_refused(file("scene.toml"), "not a Lightwell solution");
  put(file("noise.vtp"), std::string(5000, '\xff'));
  expect_refused(file("noise.vtp"), "not a Lightwell solution");
  put(file("other.vtp"), "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\"></VTKFile>\n");
  expect_refused(file("other.vtp"), "did not write");
  put(file("newer.vtp"), "<?lightwell-solution format=\"2\"\n?>\n<VTKFile/>\n");
  expect_refused(file("newer.vtp"), "solution format 2");
}

using ResealedSolution = SolutionFile;

// Random numbers of one damage.
class Choice {
 public:
  explicit Choice(std::uint64_t seed) : seed_(seed) {}
  std::size_t below(std::size_t count) {
    const double u = random_uniform(random_key(seed_, 0xda3a6e, ++number_));
    return static_cast<std::size_t>(u * static_cast<double>(count));
  }

 private:
  std::uint64_t seed_, number_ = 0;
};

// Replaces an attribute's value in the XML, which ends at `end`, or the whole attribute.
void damage_attribute(std::string& text, std::size_t end, bool is_whole, Choice& choice) {
  std::size_t value = text.find("=\"", choice.below(end));
  if (value == std::string::npos || value > end) value = text.find("=\"");
  const std::size_t close = text.find('"', value + 2);
  const std::size_t name = text.rfind(' ', value);
  const std::vector<std::string> odd{
      "-1",         "0",    "1",     "3",       "99999999999999999999",
      "4294967295", "",     "Int32", "Float64", "String",
      "UInt8",      "Name", "ascii"};
  if (is_whole) {
    text.erase(name, close + 1 - name);
  } else {
    text.replace(value + 2, close - value - 2, odd[choice.below(odd.size())]);
  }
}

void damage(std::string& text, Choice& choice) {
  const std::size_t data = text.find("<AppendedData"), length = text.size() - data;
  const std::size_t at = data + 31 + choice.below(length - 60);
  switch (choice.below(5)) {
    case 0:
      return damage_attribute(text, data, false, choice);
    case 1:
      return damage_attribute(text, data, true, choice);
    case 2:
      text[at] = static_cast<char>(text[at] ^ (1 << choice.below(8)));
      return;
    case 3:
      for (std::size_t i = 0; i < 8; ++i) text[at + i] = static_cast<char>(choice.below(256));
      return;
    default:
      text.erase(at, 1 + choice.below(std::min<std::size_t>(200, text.size() - at)));
  }
}

// A seal can be made again, so names, counts, blocks and the ends of strings are checked.
TEST_F(ResealedSolution, DamageOfAnyKindIsRefusedOrDoesNoHarm) {
  write_solution(file(), small_solution(3));
  std::string whole = contents(file());
  whole.resize(whole.rfind("<?lightwell-checksum"));
  constexpr int count = 3000;
  int refused = 0;
  for (int seed = 0; seed < count; ++seed) {
    SCOPED_TRACE(seed);
    Choice choice(static_cast<std::uint64_t>(seed));
    std::string text = whole;
    damage(text, choice);
    put(file("damaged.vtp"), text);
    seal_solution(file("damaged.vtp"));
    refused += refusal(file("damaged.vtp")).empty() ? 0 : 1;
  }
  std::printf("%d of %d refused\n", refused, count);
  // Two fifths of the damages are of attributes, some of which (labels, ranges) nothing reads. The
  // others are of data, which zlib's checksums guard but for the heads of arrays, and a fifth of
  // which are arrays for other programs that nothing reads.
  EXPECT_GT(refused, count / 2);
}

}  // namespace
}  // namespace lightwell::solution_seal_test
