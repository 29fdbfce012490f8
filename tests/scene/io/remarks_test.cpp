#include "scene/io/remarks.h"

#include <gtest/gtest.h>

#include <string>

namespace lightwell::remarks_test {
namespace {

TEST(Remarks, NameEveryThingOnce) {
  Remarks remarks;
  for (int round = 0; round < 3; ++round) {
    for (int i = 1; i <= 7; ++i) remarks.add("Holes were filled in", "wall " + std::to_string(i));
  }
  remarks.add("Doors were shut", "front door");
  const auto sentences = remarks.sentences();
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_EQ(sentences[0],
            "Holes were filled in: 'wall 1', 'wall 2', 'wall 3', 'wall 4', 'wall 5' and 2 more.");
  EXPECT_EQ(sentences[1], "Doors were shut: 'front door'.");
}

}  // namespace
}  // namespace lightwell::remarks_test
