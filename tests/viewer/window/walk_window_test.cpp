#include "viewer/window/walk_window.h"

#include <gtest/gtest.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include "tests/viewer/solved_box.h"

namespace lightwell::walk_window_test {
namespace {

class WalkWindowTest : public testing::Test {
 protected:
  static ViewOptions options() {
    ViewOptions options;
    options.cameras = {box_camera(), box_camera()};
    options.cameras[1].name = "near";
    options.cameras[1].position.z() = -1;
    options.width = 160;
    options.height = 120;
    return options;
  }
  /// Sends a key event to the interactor style, as VTK does.
  void send(unsigned long event, const char* key) {
    window_.interactor()->SetKeySym(key);
    window_.interactor()->InvokeEvent(event);
  }
  void tap(const char* key) {
    send(vtkCommand::KeyPressEvent, key);
    send(vtkCommand::CharEvent, key);
    send(vtkCommand::KeyReleaseEvent, key);
  }

  SolvedScene box_ = solved_box();
  WalkWindow window_{box_, options()};
};

TEST_F(WalkWindowTest, HoldingAKeyWalksUntilItIsReleased) {
  send(vtkCommand::KeyPressEvent, "w");
  for (int i = 0; i < 20; ++i) window_.tick(0.05);
  const double walked = window_.look().camera.position.z() + 3.0;
  // The way is that of one second at the speed for a box 2 sqrt(3) m across, less the start.
  EXPECT_NEAR(walked, walking_speed(2.0 * std::sqrt(3.0)) * (1.0 - 0.08), 0.01);
  send(vtkCommand::KeyReleaseEvent, "w");
  for (int i = 0; i < 20; ++i) window_.tick(0.05);
  const Eigen::Vector3d rest = window_.look().camera.position;
  window_.tick(0.05);
  EXPECT_EQ(window_.look().camera.position, rest);
}

TEST_F(WalkWindowTest, CapitalsAndArrowsWalkToo) {
  send(vtkCommand::KeyPressEvent, "D");
  send(vtkCommand::KeyPressEvent, "Up");
  window_.tick(0.2);
  EXPECT_LT(window_.look().camera.position.x(), 1.0);  // the picture's right is world -x
  EXPECT_GT(window_.look().camera.position.z(), -3.0);
  send(vtkCommand::LeaveEvent, "");
  for (int i = 0; i < 20; ++i) window_.tick(0.1);
  EXPECT_FALSE(window_.look().camera.position.hasNaN());
  const Eigen::Vector3d rest = window_.look().camera.position;
  window_.tick(0.1);
  EXPECT_EQ(window_.look().camera.position, rest) << "keys are let go when the pointer leaves";
}

TEST_F(WalkWindowTest, DraggingTheMouseLooksAround) {
  window_.interactor()->SetEventInformation(80, 60);
  window_.interactor()->InvokeEvent(vtkCommand::MouseMoveEvent);
  window_.interactor()->SetEventInformation(100, 60);
  window_.interactor()->InvokeEvent(vtkCommand::MouseMoveEvent);
  EXPECT_EQ(window_.look().camera.direction, Eigen::Vector3d(0, 0, 1)) << "no button was held";
  window_.interactor()->InvokeEvent(vtkCommand::LeftButtonPressEvent);
  window_.interactor()->SetEventInformation(110, 70);
  window_.interactor()->InvokeEvent(vtkCommand::MouseMoveEvent);
  EXPECT_LT(window_.look().camera.direction.x(), -0.05) << "to the right";
  EXPECT_GT(window_.look().camera.direction.y(), 0.05) << "VTK counts rows upwards";
  window_.interactor()->InvokeEvent(vtkCommand::LeftButtonReleaseEvent);
}

TEST_F(WalkWindowTest, TheWheelMovesAlongTheView) {
  window_.interactor()->InvokeEvent(vtkCommand::MouseWheelForwardEvent);
  EXPECT_GT(window_.look().camera.position.z(), -3.0);
}

TEST_F(WalkWindowTest, NumbersGoToCamerasAndHomeGoesBack) {
  tap("2");
  EXPECT_EQ(window_.look().camera.position.z(), -1.0);
  EXPECT_EQ(window_.message(), "near");
  // Each camera has an exposure of its own, as in a window that opens at that camera.
  ViewOptions from_near = options();
  from_near.camera = from_near.cameras[1];
  EXPECT_EQ(window_.look().metered_scale, WalkWindow(box_, from_near).look().metered_scale);
  EXPECT_NE(window_.look().metered_scale, WalkWindow(box_, options()).look().metered_scale);
  tap("7");
  EXPECT_EQ(window_.look().camera.position.z(), -1.0);
  EXPECT_NE(window_.message().find("2 cameras"), std::string::npos);
  tap("Home");
  EXPECT_EQ(window_.look().camera.position, box_camera().position);
}

TEST_F(WalkWindowTest, FShowsTheWholeScene) {
  send(vtkCommand::KeyPressEvent, "w");
  for (int i = 0; i < 100; ++i) window_.tick(0.1);
  send(vtkCommand::KeyReleaseEvent, "w");
  tap("f");
  const Camera& camera = window_.look().camera;
  EXPECT_GT((camera.position - Eigen::Vector3d(1, 1, 1)).norm(), 2.0 * std::sqrt(3.0));
}

/// Seen from outside, surfaces without light are left out; inside they are back.
TEST_F(WalkWindowTest, AClosedRoomOpensUpForAViewFromOutside) {
  EXPECT_TRUE(window_.look().unlit);
  tap("f");
  EXPECT_FALSE(window_.look().unlit);
  tap("Home");
  EXPECT_FALSE(window_.look().unlit) << "the start lies outside, at z = -3";
  send(vtkCommand::KeyPressEvent, "w");
  for (int i = 0; i < 1000 && !(window_.look().camera.position.z() > 0.2); ++i) window_.tick(0.01);
  send(vtkCommand::KeyReleaseEvent, "w");
  ASSERT_LT(window_.look().camera.position.z(), 2.0);
  EXPECT_TRUE(window_.look().unlit);
  tap("x");
  EXPECT_FALSE(window_.look().unlit) << "chosen by hand";
  tap("Home");
  EXPECT_FALSE(window_.look().unlit);
}

/// Without a running solve there is no unshot light to show.
TEST_F(WalkWindowTest, FalseColoursShowLuminanceOrIlluminance) {
  tap("u");
  EXPECT_TRUE(window_.look().illuminance);
  EXPECT_EQ(window_.look().measure, Measure::luminance);
  EXPECT_NE(window_.status().find("luminance"), std::string::npos) << window_.status();
  tap("v");
  EXPECT_TRUE(window_.look().illuminance);
  EXPECT_EQ(window_.look().measure, Measure::illuminance);
  tap("u");
  EXPECT_EQ(window_.look().measure, Measure::luminance);
  tap("u");
  EXPECT_FALSE(window_.look().illuminance);
}

TEST_F(WalkWindowTest, KeysChooseTheScaleOfFalseColours) {
  tap("F6");
  EXPECT_NE(window_.message().find("false colours are off"), std::string::npos);
  tap("v");
  tap("F6");
  EXPECT_EQ(window_.look().scaling, Scaling::linear);
  tap("F6");
  EXPECT_EQ(window_.look().scaling, Scaling::logarithmic);
  tap("F7");
  EXPECT_EQ(window_.look().scaling, Scaling::classes);
  EXPECT_NE(window_.status().find("classes"), std::string::npos) << window_.status();
  tap("F7");
  EXPECT_EQ(window_.look().scaling, Scaling::given);
  tap("F5");
  EXPECT_NE(window_.message().find("fitted"), std::string::npos) << window_.message();
}

TEST_F(WalkWindowTest, AKeySwitchesTheWhite) {
  tap("F2");
  EXPECT_EQ(window_.look().white.kind, WhitePoint::Kind::automatic);
  tap("F2");
  EXPECT_EQ(window_.look().white.kind, WhitePoint::Kind::as_lit);
  ViewOptions warm = options();
  warm.white = {.kind = WhitePoint::Kind::black_body, .kelvin = 2700.0};
  WalkWindow window(box_, warm);
  for (const bool is_warm : {false, true}) {
    window.press("F2");
    window.release("F2");
    EXPECT_EQ(window.look().white, is_warm ? warm.white : WhitePoint{});
  }
}

TEST_F(WalkWindowTest, SwitchesSwitchOncePerPress) {
  for (const char* key : {"m", "v", "x"}) {
    send(vtkCommand::KeyPressEvent, key);
    send(vtkCommand::KeyPressEvent, key);  // held down: the keyboard repeats
    send(vtkCommand::KeyReleaseEvent, key);
  }
  EXPECT_TRUE(window_.look().mesh);
  EXPECT_TRUE(window_.look().illuminance);
  EXPECT_FALSE(window_.look().unlit);
  tap("m");
  EXPECT_FALSE(window_.look().mesh);
  window_.tick(0.01);
}

TEST_F(WalkWindowTest, ExposureGoesInThirdsOfAStop) {
  for (int i = 0; i < 3; ++i) tap("plus");
  EXPECT_NEAR(window_.look().exposure_ev, 1.0, 1e-12);
  tap("minus");
  tap("KP_Subtract");
  EXPECT_NEAR(window_.look().exposure_ev, 1.0 / 3.0, 1e-12);
  tap("0");
  EXPECT_EQ(window_.look().exposure_ev, 0.0);
}

TEST_F(WalkWindowTest, AScreenshotThatCannotBeSavedIsReportedNotThrown) {
  ViewOptions broken = options();
  broken.screenshot_folder = "/nonexistent-folder";
  WalkWindow window(box_, broken);
  EXPECT_NO_THROW(window.press("F12"));
  EXPECT_NE(window.message().find("/nonexistent-folder"), std::string::npos) << window.message();
}

/// VTK's own handling of 'e' and 'q' would end the event loop.
TEST_F(WalkWindowTest, VtksOwnKeysDoNothing) {
  int exits = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&exits);
  count->SetCallback(
      [](vtkObject*, unsigned long, void* data, void*) { ++*static_cast<int*>(data); });
  window_.interactor()->AddObserver(vtkCommand::ExitEvent, count);
  for (const char* key : {"w", "s", "e", "q", "p", "f", "j", "3"}) {
    window_.interactor()->SetKeyCode(key[0]);
    send(vtkCommand::CharEvent, key);
  }
  EXPECT_EQ(exits, 0);
  EXPECT_EQ(window_.look().camera.position, box_camera().position);
}

TEST_F(WalkWindowTest, TinyWindowsDraw) {
  ViewOptions tiny = options();
  tiny.width = tiny.height = 1;
  WalkWindow window(box_, tiny);
  EXPECT_NO_THROW(window.tick(0.01));
  window.drag(1, 1);
  window.press("f");
  EXPECT_NO_THROW(window.tick(0.01));
  EXPECT_TRUE(window.look().camera.position.allFinite());
}

TEST(WalkingSpeed, FollowsTheSizeOfTheScene) {
  EXPECT_DOUBLE_EQ(walking_speed(1.0), 0.2);
  EXPECT_DOUBLE_EQ(walking_speed(7.0), 1.4);
  EXPECT_DOUBLE_EQ(walking_speed(28.0), 2.8);
}

}  // namespace
}  // namespace lightwell::walk_window_test
