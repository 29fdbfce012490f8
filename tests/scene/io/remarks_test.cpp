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

TEST(Remarks, LossesNameAllAndMentionsAreNone) {
  Remarks remarks;
  for (int i = 1; i <= 7; ++i) remarks.add("Holes were filled in", "wall " + std::to_string(i));
  remarks.mention("Doors were shut", "front door");
  EXPECT_FALSE(remarks.attempt("Locks were left out", "lock", [] { throw InputError("no key"); }));
  EXPECT_FALSE(remarks.attempt("Locks were left out", "bolt", [] { throw InputError("rust"); }));
  EXPECT_TRUE(remarks.attempt("Locks were left out", "chain", [] {}));
  EXPECT_THROW(remarks.attempt("Locks", "gate", [] { throw LimitError("too many"); }), LimitError);
  Scene scene;
  remarks.report_to(scene);
  ASSERT_EQ(scene.notes.size(), 3u);
  EXPECT_EQ(scene.notes[0],
            "Holes were filled in: 'wall 1', 'wall 2', 'wall 3', 'wall 4', 'wall 5' and 2 more.");
  ASSERT_EQ(scene.losses.size(), 2u);
  EXPECT_EQ(scene.losses[0],
            "Holes were filled in: 'wall 1', 'wall 2', 'wall 3', 'wall 4', 'wall 5', 'wall 6', "
            "'wall 7'.");
  EXPECT_EQ(scene.losses[1], "Locks were left out: 'lock', 'bolt'; the first: no key.");
}

}  // namespace
}  // namespace lightwell::remarks_test
