#include "viewer/window/camera_path.h"

#include <gtest/gtest.h>

#include "scene/errors.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/solved_box.h"
#include "viewer/window/view.h"
#include "viewer/window/walk_window.h"

namespace lightwell::camera_path_test {
namespace {

CameraPath straight_path() {
  CameraPath path;
  for (const double t : {0.0, 1.0, 1.5, 4.0}) {
    Camera camera = box_camera();
    camera.position = {t, 2.0 * t, 1.0};
    path.seconds.push_back(t);
    path.cameras.push_back(camera);
  }
  return path;
}

/// The path through points of a straight walk at constant speed is that walk, for any time steps.
TEST(CameraPath, KeepsAnEvenWalkEven) {
  const CameraPath path = straight_path();
  for (const double t : {0.0, 0.3, 1.0, 1.2, 2.75, 4.0}) {
    EXPECT_LT((path.at(t).position - Eigen::Vector3d(t, 2.0 * t, 1.0)).norm(), 1e-12) << t;
  }
  EXPECT_EQ(path.at(-1.0).position, path.cameras.front().position);
  EXPECT_EQ(path.at(99.0).position, path.cameras.back().position);
  const auto frames = frames_along(path, 5);
  EXPECT_NEAR(frames[1].position.x(), 1.0, 1e-12);
  EXPECT_NEAR(frames[4].position.x(), 4.0, 1e-12);
  EXPECT_EQ(frames_along(path, 1)[0].position, path.cameras.front().position);
}

TEST(CameraPath, TurnsEvenly) {
  CameraPath path{{0.0, 2.0}, {box_camera(), box_camera()}};
  path.cameras[1].direction = {1, 0, 0};
  const Camera middle = path.at(1.0);
  EXPECT_LT((middle.direction - Eigen::Vector3d(1, 0, 1).normalized()).norm(), 1e-12);
  EXPECT_LT((middle.up - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(Turntable, GoesAroundAtOneDistance) {
  const Eigen::Vector3d center(1, 1, 1);
  const auto frames = turntable(box_camera(), center, Eigen::Vector3d::UnitY(), 4);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_LT((frames[0].position - box_camera().position).norm(), 1e-12);
  EXPECT_LT((frames[2].position - Eigen::Vector3d(1, 1, 5)).norm(), 1e-12);
  EXPECT_LT((frames[2].direction - Eigen::Vector3d(0, 0, -1)).norm(), 1e-12);
  for (const Camera& camera : frames) EXPECT_NEAR((camera.position - center).norm(), 4.0, 1e-12);
}

TEST(KeptViewsFile, ComesBackAsItWas) {
  const TemporaryFolder folder;
  KeptViews views;
  views.bookmarks[2] = box_camera();
  views.path = straight_path();
  write_views(folder / "v.json", views);
  const KeptViews read = read_views(folder / "v.json");
  EXPECT_FALSE(read.bookmarks[0]);
  ASSERT_TRUE(read.bookmarks[2]);
  EXPECT_EQ(read.bookmarks[2]->position, box_camera().position);
  EXPECT_EQ(read.bookmarks[2]->fov_degrees, 40.0);
  EXPECT_EQ(read.bookmarks[2]->width, 200);
  EXPECT_EQ(read.path.seconds, views.path.seconds);
  EXPECT_EQ(read.path.cameras[3].position, views.path.cameras[3].position);
}

TEST(KeptViewsFile, KeepsOrthographicAndShiftedViews) {
  const TemporaryFolder folder;
  KeptViews views;
  Camera plan = box_camera();
  plan.projection = Projection::orthographic;
  plan.view_width = 7.5;
  plan.near_distance = 2.0;
  plan.shift = {0.1, -0.2};
  views.bookmarks[0] = plan;
  write_views(folder / "v.json", views);
  const Camera read = *read_views(folder / "v.json").bookmarks[0];
  EXPECT_EQ(read.projection, Projection::orthographic);
  EXPECT_EQ(read.view_width, 7.5);
  EXPECT_EQ(read.near_distance, 2.0);
  EXPECT_EQ(read.shift, plan.shift);
  const auto bad =
      folder.write("bad.json", R"({"bookmarks": {"1": {"position": [0,0,0], "direction": [1,0,0],
                  "view_width": -1}}})");
  EXPECT_TRUE(says(message_of<InputError>([&] { read_views(bad); }), "a view -1 m wide"));
}

TEST(KeptViewsFile, WhatIsWrongIsNamed) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{", "parse"},
      {R"({"bookmarks": {"0": {}}})", "numbered 1 to 9"},
      {R"({"bookmarks": {"1": {"position": [1, 2]}}})", "three numbers"},
      {R"({"bookmarks": {"4": {"position": [1, 2, 3]}}})", "bookmark '4'"},
      {R"({"bookmarks": {"1": {"position": [0,0,0], "direction": [0,0,1]}}})", "along one line"},
      {R"({"bookmarks": {"1": {"position": [0,0,0], "direction": [1,0,0], "fov_degrees": 180}}})",
       "fov_degrees"},
      {R"({"path": [{"seconds": 1, "position": [0,0,0], "direction": [1,0,0]},
                    {"seconds": 1, "position": [0,0,0], "direction": [1,0,0]}]})",
       "camera 2 of the path"},
  };
  for (const auto& [text, wanted] : cases) {
    const auto file = folder.write("bad.json", text);
    try {
      read_views(file);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(wanted), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("bad.json"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(read_views(folder / "absent.json"), InputError);
}

TEST(FrameName, PutsTheNumberWhereThePatternSays) {
  EXPECT_EQ(frame_name("out-%04d.png", 7), "out-0007.png");
  EXPECT_EQ(frame_name("a/%d.png", 12), "a/12.png");
  for (const char* wrong : {"out.png", "%d-%d.png", "%s.png", "%", "%99999999d.png", "%-3d"}) {
    EXPECT_THROW(frame_name(wrong, 0), InputError) << wrong;
  }
}

TEST(Film, WritesAPictureAFrame) {
  const TemporaryFolder folder;
  KeptViews views;
  views.path = straight_path();
  write_views(folder / "v.json", views);
  ViewOptions options;
  options.cameras = {box_camera()};
  options.width = 40;
  options.height = 30;
  const std::string pattern = (folder / "f-%02d.png").string();
  const auto files = write_film(solved_box(), options, {folder / "v.json", 3}, pattern);
  ASSERT_EQ(files.size(), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder / "f-02.png"));
  write_film(solved_box(), options, {.frames = 4, .turntable = true}, pattern);
  EXPECT_TRUE(std::filesystem::exists(folder / "f-03.png"));
  write_views(folder / "none.json", {});
  EXPECT_THROW(write_film(solved_box(), options, {folder / "none.json", 3}, pattern), InputError);
}

ViewOptions with_bookmarks(const std::filesystem::path& file) {
  ViewOptions options;
  options.cameras = {box_camera()};
  options.width = 200;
  options.height = 150;
  options.bookmark_file = file;
  return options;
}

/// Ctrl and a digit keep a view, in a file that the next window reads.
TEST(WalkWindowViews, BookmarksOutliveTheWindow) {
  const TemporaryFolder folder;
  const SolvedScene box = solved_box();
  const ViewOptions options = with_bookmarks(folder / "box.views.json");
  Eigen::Vector3d kept;
  {
    WalkWindow window(box, options);
    window.wheel(3);
    kept = window.look().camera.position;
    window.press("Control_R");
    window.press("5");
    window.release("5");
    window.release("Control_R");
    window.press("Home");
    EXPECT_NE(window.look().camera.position, kept);
  }
  WalkWindow window(box, options);
  window.press("5");
  EXPECT_EQ(window.look().camera.position, kept);
  EXPECT_EQ(window.message(), "bookmark 5");
}

TEST(WalkWindowViews, AWalkThatWasRecordedIsPlayed) {
  const TemporaryFolder folder;
  const SolvedScene box = solved_box();
  const ViewOptions options = with_bookmarks(folder / "box.views.json");
  WalkWindow window(box, options);
  window.press("y");
  EXPECT_NE(window.message().find("no path"), std::string::npos);
  window.press("j");
  window.release("j");
  window.press("w");
  for (int i = 0; i < 20; ++i) window.tick(0.05);
  window.release("w");
  for (int i = 0; i < 20; ++i) window.tick(0.05);
  window.press("j");
  const Eigen::Vector3d end = window.look().camera.position;
  window.press("Home");
  window.release("y");
  window.press("y");
  for (int i = 0; i < 45; ++i) window.tick(0.05);
  EXPECT_LT((window.look().camera.position - end).norm(), 1e-6);
  EXPECT_NEAR(read_views(options.bookmark_file).path.duration(), 2.0, 0.11);
}

/// The camera orbits around the point in the middle of the picture: (1, 1, 2) on the back wall, 5 m
/// away.
TEST(WalkWindowViews, OrbitsAroundWhatIsInTheMiddle) {
  const SolvedScene box = solved_box();
  ViewOptions options;
  options.cameras = {box_camera()};
  WalkWindow window(box, options);
  window.press("o");
  window.drag(100, 40);
  const Camera& camera = window.look().camera;
  const Eigen::Vector3d to_pivot = Eigen::Vector3d(1, 1, 2) - camera.position;
  EXPECT_NEAR(to_pivot.norm(), 5.0, 1e-2);
  EXPECT_GT(to_pivot.normalized().dot(camera.direction), 0.9999) << "it stays in the middle";
  EXPECT_GT(camera.position.y(), 1.1) << "a drag downwards lifts the eye";
  EXPECT_GT((camera.position - box_camera().position).norm(), 0.5);
}

/// In the box of 2 m height the body is scaled by 2/2.5: eyes 1.28 m above the floor, radius 0.2 m.
TEST(WalkWindowViews, WalksOnTheFloorAndStopsAtTheWall) {
  const SolvedScene box = solved_box();
  ViewOptions options;
  options.cameras = {box_camera()};
  options.cameras[0].position = {1, 1.5, 0.5};
  options.walk = true;
  options.width = options.height = 100;
  WalkWindow window(box, options);
  EXPECT_TRUE(window.is_walking());
  window.press("w");
  for (int i = 0; i < 300; ++i) window.tick(0.02);
  const double scale = 2.0 / 2.5;
  EXPECT_NEAR(window.look().camera.position.y(), 1.6 * scale, 2e-3);
  EXPECT_NEAR(window.look().camera.position.z(), 2.0 - 0.25 * scale, 2e-3);
  window.release("w");
  window.press("g");
  EXPECT_FALSE(window.is_walking());
}

}  // namespace
}  // namespace lightwell::camera_path_test
