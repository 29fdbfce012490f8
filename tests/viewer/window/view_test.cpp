#include "viewer/window/view.h"

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <thread>

#include "raytrace/display/display.h"
#include "raytrace/pictures/image.h"
#include "scene/errors.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/pictured_wall.h"
#include "tests/viewer/solved_box.h"
#include "viewer/export/start_view.h"
#include "viewer/window/lux_classes.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/walk_window.h"
#include "viewer/window/x_display.h"

namespace lightwell::view_test {
namespace {

namespace fs = std::filesystem;
using Pixel = std::array<int, 3>;

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
  Pixel at(int x, int y) const {
    const std::size_t i = 3 * (static_cast<std::size_t>(y) * width + x);
    return {bytes[i], bytes[i + 1], bytes[i + 2]};
  }
};

ViewOptions options_for(const Camera& camera) {
  ViewOptions options;
  options.camera = camera;
  options.cameras = {camera};
  options.width = camera.width;
  options.height = camera.height;
  return options;
}

Picture draw(const SolvedScene& solved, const ViewOptions& options, const Look* look = nullptr) {
  SolutionView view(solved, options);
  if (look) view.set_look(*look);
  return {options.width, options.height, draw_offscreen(view, options.width, options.height)};
}

/// Pixel bytes of a surface with irradiance E and reflectance 1.
Pixel expected(const SolvedScene& solved, const ViewOptions& options, const Eigen::Array3f& E) {
  const SolutionView view(solved, options);
  const BandArray L = E.transpose() / std::numbers::pi_v<float>;
  const auto bytes = display_colors(L, solved.solution.bands,
                                    view.look().metered_scale * std::exp2(view.look().exposure_ev));
  return {bytes[0], bytes[1], bytes[2]};
}

/// Tolerance of two roundings: OpenGL may round a colour up or down, and so may the mean over
/// subpixels.
void expect_pixel(const Pixel& seen, const Pixel& wanted, const char* what) {
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen[c], wanted[c], 2) << what << ", colour component " << c;
  }
}

/// Each wall has one colour: the pixels are the tone-mapped vertex colours, with left and right as
/// in the scene. The opening is 3 m away and 2 m wide in a picture 2 * 3 tan 20 deg = 2.18 m wide.
TEST(Snapshot, ShowsEveryWallWhereTheCameraSeesIt) {
  const SolvedScene box = solved_box();
  const ViewOptions options = options_for(box_camera());
  const Picture picture = draw(box, options);
  expect_pixel(picture.at(100, 75), expected(box, options, white), "back wall");
  expect_pixel(picture.at(20, 75), expected(box, options, green), "world +x is on the left");
  expect_pixel(picture.at(180, 75), expected(box, options, red), "world -x is on the right");
  expect_pixel(picture.at(100, 5), expected(box, options, blue), "ceiling");
  expect_pixel(picture.at(100, 145), expected(box, options, grey), "floor");
  expect_pixel(picture.at(2, 75), {0, 0, 0}, "beside the box there is nothing");
}

/// Parallel rays see the back wall alone, 2 m of a picture 4 m wide, and no side walls.
TEST(Snapshot, OrthographicCamerasSeeInParallel) {
  const SolvedScene box = solved_box();
  Camera camera = box_camera();
  camera.projection = Projection::orthographic;
  camera.view_width = 4.0;
  const ViewOptions options = options_for(camera);
  const Picture picture = draw(box, options);
  expect_pixel(picture.at(100, 75), expected(box, options, white), "back wall");
  expect_pixel(picture.at(54, 75), expected(box, options, white), "its left end");
  expect_pixel(picture.at(146, 75), expected(box, options, white), "its right end");
  expect_pixel(picture.at(45, 75), {0, 0, 0}, "beside the box there is nothing");
}

/// A lens shifted by a quarter of the width to the right and a fifth of the height upwards moves
/// the picture by 50 pixels to the left and by 30 downwards.
TEST(Snapshot, ShiftedLensesMoveThePicture) {
  const SolvedScene box = solved_box();
  Camera camera = box_camera();
  camera.shift = {0.25, 0.2};
  const ViewOptions options = options_for(camera);
  const Picture picture = draw(box, options);
  expect_pixel(picture.at(50, 105), expected(box, options, white), "back wall");
  expect_pixel(picture.at(130, 105), expected(box, options, red), "world -x is on the right");
  expect_pixel(picture.at(50, 35), expected(box, options, blue), "ceiling");
}

/// The halves of the textured back wall have the light of a white wall times the texture. sRGB is
/// not a pure power, so the product of two encoded values has an error of up to 2 %.
TEST(Snapshot, ShowsPicturesInTheirLight) {
  PicturedBox box;
  ViewOptions options = options_for(box_camera());
  options.materials = box.scene.materials;
  options.scene = &box.scene;
  const auto near_to = [&](const Pixel& seen, const Eigen::Array3f& E, const char* what) {
    const Pixel wanted = expected(box.solved, options, E);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], wanted[c], 2 + 0.02 * 255) << what;
  };
  const Picture picture = draw(box.solved, options);
  near_to(picture.at(80, 75), bright_half * white, "world +x, where the picture begins");
  near_to(picture.at(120, 75), dark_half * white, "its other half");
  near_to(picture.at(20, 75), green, "other walls have none");

  options.illuminance = true;
  const Picture lux = draw(box.solved, options);
  EXPECT_EQ(lux.at(80, 75), lux.at(120, 75)) << "both halves receive the same";

  options.illuminance = false;
  box.scene.materials.back().mask = Mask{.image = picture_of(2, 1, {1.0f, 0.0f})};
  const Picture with_hole = draw(box.solved, options);
  near_to(with_hole.at(80, 75), bright_half * white, "what is left of the wall");
  expect_pixel(with_hole.at(120, 75), {0, 0, 0}, "through the hole there is nothing");
}

/// Light far above white keeps its colour on a dark texture, since light times texel is
/// tone-mapped. Codes of light are exact to 2 %, at most 4 of 255.
TEST(Snapshot, DarkPicturesInBrightLightKeepItsColour) {
  PicturedBox box;
  ViewOptions options = options_for(box_camera());
  options.materials = box.scene.materials;
  options.scene = &box.scene;
  BandArray warm(1, 3);
  warm << 60.0f, 30.0f, 12.0f;
  for (int v = 8; v < 12; ++v) box.solved.solution.direct_irradiance.row(v) = warm;
  Look look = SolutionView(box.solved, options).look();
  look.metered_scale = 0.1;  // up to 1.9 times white
  const Picture picture = draw(box.solved, options, &look);
  for (const auto& [x, rho] : {std::pair(80, bright_half), std::pair(120, dark_half)}) {
    const BandArray L = rho * warm / std::numbers::pi_v<float>;
    const auto wanted = display_colors(L, rgb_bands(), look.metered_scale);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.at(x, 75)[c], wanted[c], 5) << x << ' ' << c;
  }
}

/// Around the box the picture has the sky, the ground below the horizon, and the sun's disc. They
/// have no illuminance, so false colours leave them black.
TEST(Snapshot, ShowsTheSkyOutside) {
  const SolvedScene box = solved_box();
  Scene scene = box_scene();
  const Eigen::Vector3d to_sun = Eigen::Vector3d(0.7, 0.3, 2.0).normalized();
  scene.sky = Sky{.name = "even",
                  .scale = Eigen::Array3f(0.2f, 0.3f, 0.5f),
                  .ground = Eigen::Array3f(0.1f, 0.1f, 0.05f),
                  .sun = Sun{.direction = to_sun,
                             .irradiance = Eigen::Array3f(1.0f, 1.0f, 1.0f),
                             .angle_degrees = 4.0}};
  ViewOptions options = options_for(box_camera());
  options.scene = &scene;
  options.exposure_ev = -1.0;  // keeps every pixel below white
  const auto shown = [&](const Eigen::Array3f& L) {
    return expected(box, options, std::numbers::pi_v<float> * L);
  };
  // At tan 20 deg = 0.364 for 100 pixels: the sun is 0.35 to the left and 0.15 up.
  const Picture picture = draw(box, options);
  expect_pixel(picture.at(4, 10), shown(scene.sky->scale), "the sky beside the box");
  expect_pixel(picture.at(4, 140), shown(scene.sky->ground), "the ground");
  const Eigen::Array3f sun = radiance_outside(*scene.sky, to_sun);
  expect_pixel(picture.at(100 - 96, 75 - 41), shown(sun), "the sun");
  EXPECT_EQ(picture.at(4, 73), picture.at(4, 60)) << "the horizon is sharp";
  EXPECT_EQ(picture.at(4, 76), picture.at(4, 90)) << "the horizon is sharp";
  options.illuminance = true;
  expect_pixel(draw(box, options).at(4, 10), {0, 0, 0}, "no light falls on the sky");
}

TEST(Snapshot, BacksAreNotDrawn) {
  const SolvedScene box = solved_box();
  Camera camera = box_camera();
  camera.position = {-3, 1, 1};
  camera.direction = {1, 0, 0};
  const ViewOptions options = options_for(camera);
  const Picture picture = draw(box, options);
  expect_pixel(picture.at(100, 75), expected(box, options, green),
               "through the back of the red wall");
}

/// Both sides of a wall lie in the same plane, and only the side towards the camera is drawn.
TEST(Snapshot, EachSideOfAWallShowsItsOwnLight) {
  SolvedQuads quads;
  quads.add({{{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}}}, red);   // faces -z
  quads.add({{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}}, blue);  // faces +z
  SolvedScene wall = quads.solved();
  wall.mesh.twin = {1, 0};
  Camera camera = box_camera();
  camera.position = {1, 1, -2};
  for (const bool from_front : {true, false}) {
    if (!from_front) {
      camera.position.z() = 2;
      camera.direction.z() = -1;
    }
    const ViewOptions options = options_for(camera);
    const Picture picture = draw(wall, options);
    const Pixel wanted = expected(wall, options, from_front ? red : blue);
    for (int y = 30; y < 120; ++y) {
      for (int x = 40; x < 160; ++x) expect_pixel(picture.at(x, y), wanted, "one colour all over");
    }
  }
}

/// If two opposite corners are equal and the other two are not, the diagonal must join the equal
/// corners: the middle then has their value.
TEST(Snapshot, QuadsAreSplitAlongTheSmootherDiagonal) {
  const Eigen::Array3f dim = 0.25f * grey, bright = 3.0f * grey;
  for (const auto& irradiance :
       {std::array{grey, dim, grey, bright}, std::array{dim, grey, bright, grey}}) {
    SolvedQuads quads;
    quads.add({{{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}}}, irradiance);
    const SolvedScene quad = quads.solved();
    Camera camera = box_camera();
    camera.position = {1, 1, -2};
    const ViewOptions options = options_for(camera);
    const Picture picture = draw(quad, options);
    expect_pixel(picture.at(100, 75), expected(quad, options, grey), "the middle of the quad");
  }
}

/// The dark wall covers a quarter of pixel column 100 and of pixel row 74; light is averaged before
/// it is encoded. At 2 m the picture is 4 tan 20 deg = 1.456 m wide and has 200 pixels; its right
/// is -x.
TEST(Snapshot, APixelShowsItsMeanLight) {
  const double quarter = 0.25 * 4.0 * std::tan(20.0 * std::numbers::pi / 180.0) / 200.0;
  const double right = 1.0 - quarter, top = 1.0 + quarter;
  SolvedQuads quads;
  quads.add({{{right, -3, 0}, {right, top, 0}, {5, top, 0}, {5, -3, 0}}}, grey);
  const SolvedScene wall = quads.solved();
  Camera camera = box_camera();
  camera.position = {1, 1, -2};
  const ViewOptions options = options_for(camera);
  const Picture picture = draw(wall, options);
  const SolutionView view(wall, options);
  const float full = display_rgb(grey / std::numbers::pi_v<float>, view.look().metered_scale)[0];
  const auto byte = [](float linear) {
    return static_cast<int>(255.0f * srgb_encode(linear) + 0.5f);
  };
  const int whole = byte(full), part = byte(0.25f * full), corner = byte(0.0625f * full);
  expect_pixel(picture.at(99, 76), {whole, whole, whole}, "inside");
  expect_pixel(picture.at(100, 76), {part, part, part}, "the right edge");
  expect_pixel(picture.at(99, 74), {part, part, part}, "the upper edge");
  expect_pixel(picture.at(100, 74), {corner, corner, corner}, "the corner");
  expect_pixel(picture.at(101, 76), {0, 0, 0}, "outside");
}

TEST(Snapshot, OneStopDoublesTheLight) {
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  const SolutionView plain(box, options);
  options.exposure_ev = 1.0;
  const SolutionView brighter(box, options);
  EXPECT_EQ(plain.look().metered_scale, brighter.look().metered_scale);
  const Picture picture = draw(box, options);
  const auto doubled = display_colors(white.transpose() / std::numbers::pi_v<float>,
                                      box.solution.bands, 2.0 * plain.look().metered_scale);
  expect_pixel(picture.at(100, 75), {doubled[0], doubled[1], doubled[2]}, "back wall");
}

TEST(Snapshot, UnlitSurfacesHideWhatIsBehindUntilLookedThrough) {
  SolvedQuads quads;  // a dark wall facing the camera, and a lit one behind it
  quads.add({{{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}}}, Eigen::Array3f::Zero().eval());
  quads.add({{{0, 0, 2}, {0, 2, 2}, {2, 2, 2}, {2, 0, 2}}}, white);
  const SolvedScene scene = quads.solved();
  const ViewOptions options = options_for(box_camera());
  expect_pixel(draw(scene, options).at(100, 75), {0, 0, 0}, "the dark wall");
  SolutionView view(scene, options);
  Look look = view.look();
  look.unlit = false;
  expect_pixel(draw(scene, options, &look).at(100, 75), expected(scene, options, white),
               "the lit wall behind it");
}

TEST(Snapshot, TheMeshOverlayDrawsTheOutlinesAndNoDiagonals) {
  const SolvedScene box = solved_box();
  const ViewOptions options = options_for(box_camera());
  const Picture plain = draw(box, options);
  Look look = SolutionView(box, options).look();
  look.mesh = true;
  const Picture meshed = draw(box, options, &look);
  // The edge between back wall and floor is 1 m below the axis at 5 m: 1 / (5 tan 20 deg) of the
  // half width of 100 pixels, 55 pixels below the middle.
  int darkest = 255;
  for (int y = 127; y <= 133; ++y) darkest = std::min(darkest, meshed.at(100, y)[0]);
  EXPECT_LT(darkest, plain.at(100, 126)[0] - 40);
  // Nothing crosses the middle of the back wall, where both diagonals would pass.
  for (int d = -3; d <= 3; ++d) {
    expect_pixel(meshed.at(100 + d, 75), plain.at(100, 75), "the middle of the back wall");
  }
}

TEST(Snapshot, BeginsAsTheOptionsSay) {
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  Look look = SolutionView(box, options).look();
  look.mesh = look.illuminance = true;
  const Picture switched = draw(box, options, &look);
  options.mesh = options.illuminance = true;
  EXPECT_EQ(draw(box, options).bytes, switched.bytes);

  const float lux = vertex_illuminance(box.solution)[8];  // of the back wall, even all over
  options.lux_range = {0.0, 4.0 * lux};
  const Eigen::Array3f quarter = 255.0f * false_color(0.25f);
  expect_pixel(
      draw(box, options).at(100, 75),
      {static_cast<int>(quarter[0]), static_cast<int>(quarter[1]), static_cast<int>(quarter[2])},
      "a quarter up the scale");
}

Pixel quarter_up_the_scale() {
  const Eigen::Array3f c = 255.0f * false_color(0.25f);
  return {static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2])};
}

/// With reflectance 1, luminance is E / pi.
TEST(Snapshot, MeasuresLuminanceAndUnshotLight) {
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  options.illuminance = true;
  options.measure = Measure::luminance;
  const float lux = vertex_illuminance(box.solution)[8];  // of the back wall, even all over
  options.lux_range = {0.0, 4.0 * lux / std::numbers::pi};
  expect_pixel(draw(box, options).at(100, 75), quarter_up_the_scale(), "the back wall's luminance");

  options.measure = Measure::unshot;
  options.lux_range = {0.0, 40.0};
  SolutionView view(box, options);
  view.set_unshot(Eigen::ArrayXf::Constant(5, 10.0f));
  const Picture picture{200, 150, draw_offscreen(view, 200, 150)};
  expect_pixel(picture.at(100, 75), quarter_up_the_scale(), "a quarter of 40 lm/m2");
}

/// Illuminance rises from 0 at the left to 1000 lx at the right of a square; each pixel has the
/// class of its own illuminance, so the borders are at the tenths where the illuminance is that of
/// a class.
TEST(Snapshot, ClassesHaveSharpBorders) {
  const Eigen::Array3f none = Eigen::Array3f::Zero();
  const Eigen::Array3f most = Eigen::Array3f::Constant(1000.0f / 683.0f);
  SolvedQuads quads;
  quads.add({{{2, 0, 0}, {0, 0, 0}, {0, 2, 0}, {2, 2, 0}}}, {none, most, most, none});
  quads.add({{{0, 0, 0}, {-2, 0, 0}, {-2, 2, 0}, {0, 2, 0}}}, most);
  const SolvedScene wall = quads.solved();
  Camera camera = box_camera();
  camera.position = {1, 1, -2};
  ViewOptions options = options_for(camera);
  options.illuminance = options.lux_classes = true;
  options.width = 600;
  const SolutionView view(wall, options);
  const Picture picture{600, 150, draw_offscreen(view, 600, 150)};
  // Seen from 2 m, 600 pixels are 4 tan 20 deg = 1.456 m; x = 1 is in the middle, and -x on the
  // right.
  const double metres = 4.0 * std::tan(20.0 * std::numbers::pi / 180.0) / 600.0;
  int classes = 0;
  for (int x = 5; x < 480; ++x) {
    const double lux =
        500.0 * (1.0 + std::abs((x + 0.5 - 300.0) * metres) * (x + 0.5 < 300.0 ? -1.0 : 1.0));
    std::size_t reached = 0;
    bool is_border = false;
    for (const double limit : lux_classes) {
      reached += lux >= limit;
      is_border |= std::abs(lux - limit) < 500.0 * metres;  // a pixel that holds the border
    }
    if (is_border) continue;
    const Eigen::Array3f c = 255.0f * class_color(reached);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(picture.at(x, 75)[k], c[k], 2) << x << ' ' << lux;
    classes |= 1 << reached;
  }
  EXPECT_EQ(classes, 0b11110) << "200, 300, 500 and 750 lx are crossed";

  // The outline between both squares, of the highest class, is dark grey and a pixel wide.
  options.mesh = true;
  camera.position.x() = 0;
  options.camera = camera;
  const Picture outlined = draw(wall, options);
  int darkest = 255;
  for (int x = 297; x < 303; ++x) {
    darkest = std::min(darkest, outlined.at(x, 75)[0]);
  }
  EXPECT_LT(darkest, 160) << "the highest class has 255 of red";
}

/// The scale is that of what the first camera sees, until it is fitted to another view.
TEST(Snapshot, TheScaleIsThatOfTheView) {
  SolvedQuads quads;
  quads.add({{{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}}}, grey);
  quads.add({{{7, 0, -9}, {9, 0, -9}, {9, 2, -9}, {7, 2, -9}}}, (100.0f * grey).eval());
  const SolvedScene walls = quads.solved();
  Camera camera = box_camera();
  camera.position = {1, 1, -2};
  ViewOptions options = options_for(camera);
  options.illuminance = true;
  SolutionView view(walls, options);
  EXPECT_EQ(view.measured_range().high, 1000.0) << "683 lx";
  Look look = view.look();
  look.camera.position = {8, 1, -5};
  look.camera.direction = {0, 0, -1};
  view.set_look(look);
  EXPECT_EQ(view.measured_range().high, 1000.0);
  view.fit_range();
  EXPECT_EQ(view.measured_range().high, 100000.0) << "68300 lx";
}

/// A given range holds for its own quantity; another quantity has an automatic scale.
TEST(Snapshot, ARangeHoldsForItsOwnQuantity) {
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  options.illuminance = true;
  Look look = SolutionView(box, options).look();
  look.measure = Measure::luminance;
  const Picture suits = draw(box, options, &look);
  options.lux_range = {0.0, 1e6};
  EXPECT_EQ(draw(box, options, &look).bytes, suits.bytes);
  options.measure = Measure::luminance;
  EXPECT_NE(draw(box, options, &look).bytes, suits.bytes);
}

/// True if the pixel has the marks' colour, also where edges are blended.
bool has_mark(const Picture& picture, int x, int y) {
  const Pixel p = picture.at(x, y);
  return p[0] > 240 && p[1] > 190 && p[2] < 80;
}

TEST(Snapshot, WhatKeysAndClicksShowIsDrawnOffScreen) {
  const TemporaryFolder folder;
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  options.width = 800;
  options.height = 600;
  const auto written = [&] {
    write_snapshot(box, options, folder / "picture.png");
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName((folder / "picture.png").string().c_str());
    reader->Update();
    vtkImageData* const image = reader->GetOutput();
    Picture picture{800, 600, {}};
    for (int y = 599; y >= 0; --y) {
      const auto* const row = static_cast<std::uint8_t*>(image->GetScalarPointer(0, y, 0));
      picture.bytes.insert(picture.bytes.end(), row, row + 2400);
    }
    return picture;
  };
  const Picture plain = written();
  options.annotations.click = Eigen::Vector2d(400.5, 300.5);
  const Picture clicked = written();
  EXPECT_TRUE(has_mark(clicked, 400, 300));
  EXPECT_NE(clicked.at(20, 20), plain.at(20, 20)) << "the reading is above on the left";
  options.annotations = {};
  options.annotations.measured = {Eigen::Vector2d(300.5, 300.5), Eigen::Vector2d(500.5, 300.5)};
  const Picture measured = written();
  for (const int x : {300, 400, 500}) EXPECT_TRUE(has_mark(measured, x, 300)) << x;
  options.annotations = {.pointer = Eigen::Vector2d(200.5, 300.5)};
  const Picture pointed = written();
  int changed = 0;  // pixels to the right, where there is room
  for (int x = 210; x < 400; ++x) changed += pointed.at(x, 320) != plain.at(x, 320);
  EXPECT_GT(changed, 50);
  options.annotations.pointer = Eigen::Vector2d(800.0, 300.0);
  EXPECT_THROW(written(), InputError);
  options.annotations = {.keys = true};
  EXPECT_NE(written().at(600, 200), plain.at(600, 200));

  options.annotations = {};
  options.from_outside = true;
  const SolutionView outside(box, options);
  EXPECT_EQ(outside.look().camera.position,
            frame_all(outside.bounds(), {0, 0, 1}, {0, 1, 0}, 800, 600).position);
  options.look_through = true;
  EXPECT_FALSE(SolutionView(box, options).look().unlit);
}

/// The legend's white text ends within the picture.
TEST(Snapshot, TheLegendFitsIntoNarrowPictures) {
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  options.illuminance = true;
  options.lux_range = {1.0, 100000.0};
  options.width = 256;
  const Picture picture = draw(box, options);
  int brightest = 0;
  for (int y = 0; y < 150; ++y) {
    for (int x = 253; x < 256; ++x) brightest = std::max(brightest, picture.at(x, y)[0]);
  }
  EXPECT_LT(brightest, 128);
}

/// A test with a temporary folder.
class SnapshotFile : public testing::Test {
 protected:
  Picture read(const fs::path& png) const {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(png.c_str());
    reader->Update();
    const int* size = reader->GetOutput()->GetDimensions();
    Picture picture{size[0], size[1], {}};
    for (int y = size[1] - 1; y >= 0; --y) {
      const auto* row = static_cast<unsigned char*>(reader->GetOutput()->GetScalarPointer(0, y, 0));
      picture.bytes.insert(picture.bytes.end(), row, row + std::ptrdiff_t{3} * size[0]);
    }
    return picture;
  }

  TemporaryFolder folder_;
};

TEST_F(SnapshotFile, IsThePictureAsAPng) {
  const SolvedScene box = solved_box();
  const ViewOptions options = options_for(box_camera());
  write_snapshot(box, options, folder_ / "box.png");
  const Picture drawn = draw(box, options);
  const Picture stored = read(folder_ / "box.png");
  EXPECT_EQ(stored.width, 200);
  EXPECT_EQ(stored.height, 150);
  EXPECT_EQ(stored.bytes, drawn.bytes);
  EXPECT_EQ(folder_.file_count(), 1);
}

TEST_F(SnapshotFile, MayBeOnePixelOrLargerThanTheScreen) {
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  options.width = options.height = 1;
  write_snapshot(box, options, folder_ / "one.png");
  EXPECT_EQ(read(folder_ / "one.png").width, 1);
  options.width = 2500;
  options.height = 1800;
  write_snapshot(box, options, folder_ / "large.png");
  expect_pixel(read(folder_ / "large.png").at(1250, 900), expected(box, options, white), "middle");
  options.width = 0;
  EXPECT_THROW(write_snapshot(box, options, folder_ / "none.png"), std::invalid_argument);
  options.width = 100000;
  EXPECT_THROW(write_snapshot(box, options, folder_ / "none.png"), std::invalid_argument);
}

TEST_F(SnapshotFile, AFolderThatDoesNotExistIsNamed) {
  try {
    write_snapshot(solved_box(), options_for(box_camera()), folder_ / "absent" / "box.png");
    FAIL() << "wrote into a folder that does not exist";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("absent"), std::string::npos) << e.what();
  }
}

/// Without a display VTK would end the program; the library throws with a remedy.
TEST_F(SnapshotFile, WithoutADisplayTheMessageSaysWhatToDo) {
  const char* before = std::getenv("DISPLAY");
  const std::string display = before ? before : "";
  for (const char* name : {"", ":7654"}) {
    setenv("DISPLAY", name, 1);
    try {
      write_snapshot(solved_box(), options_for(box_camera()), folder_ / "box.png");
      ADD_FAILURE() << "drew without a display";
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("xvfb-run"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("isplay"), std::string::npos) << e.what();
    }
    EXPECT_THROW(show_window(solved_box(), options_for(box_camera())), std::runtime_error);
  }
  setenv("DISPLAY", display.c_str(), 1);
  EXPECT_EQ(folder_.file_count(), 0);
}

/// A real window, driven by key events from outside: walk, save a picture, close.
TEST_F(SnapshotFile, AWindowCanBeWalkedPhotographedAndClosed) {
  if (std::system("command -v xdotool >/dev/null") != 0) GTEST_SKIP() << "xdotool is not installed";
  const SolvedScene box = solved_box();
  ViewOptions options = options_for(box_camera());
  options.width = 320;
  options.height = 240;
  options.screenshot_folder = folder_.path();
  std::thread person([] {
    const char* script =
        "timeout 60 xdotool search --sync --name 'Lightwell - box.toml' >/dev/null && sleep 0.5 &&"
        " xdotool mousemove 100 100 && sleep 0.2 && xdotool key p && sleep 1 &&"
        " xdotool keydown w && sleep 1 && xdotool keyup w && sleep 0.5 && xdotool key p &&"
        " sleep 1 && xdotool key Escape";
    EXPECT_EQ(std::system(script), 0);
  });
  show_window(box, options);
  person.join();
  ASSERT_EQ(folder_.file_count(), 2);
  const Picture before = read(folder_ / "lightwell-1.png");
  const Picture after = read(folder_ / "lightwell-2.png");
  EXPECT_EQ(before.width, 320);
  expect_pixel(before.at(160, 120), expected(box, options, white), "back wall");
  // Walking in by 2/3 m or more: the back wall covered 0.55 of the width, and now more than 0.6.
  const Pixel white_now = expected(box, options, white);
  expect_pixel(after.at(160 - 96, 120), white_now, "the back wall has come closer");
  EXPECT_NE(before.at(160 - 96, 120), after.at(160 - 96, 120));
}

/// A walk on foot stops with the eye a body's radius before the wall at z = 2. There a click in the
/// middle reads the wall, which has constant illuminance.
TEST_F(SnapshotFile, AWindowStopsAtWallsAndReadsWhatIsClicked) {
  if (std::system("command -v xdotool >/dev/null") != 0) GTEST_SKIP() << "xdotool is not installed";
  const SolvedScene box = solved_box();
  const Scene scene = box_scene();
  const WalkBody body = walk_body({{0, 0, 0}, {2, 2, 2}}, {0, 1, 0}, 0.0);
  Camera camera = box_camera();
  camera.position.y() = body.eye_height;  // no step up into the box
  ViewOptions options = options_for(camera);
  options.width = 320;
  options.height = 240;
  options.scene = &scene;
  options.bookmark_file = folder_ / "box.views.json";
  std::thread person([] {
    const char* script =
        "timeout 60 xdotool search --sync --name 'Lightwell - box.toml' >/dev/null && sleep 0.5 &&"
        " xdotool mousemove 160 120 && sleep 0.2 && xdotool key g && sleep 0.2 &&"
        " xdotool keydown Shift_L keydown w && sleep 6 && xdotool keyup w keyup Shift_L &&"
        " sleep 0.3 && xdotool key ctrl+1 && sleep 0.3 && xdotool key v && sleep 0.3 &&"
        " xdotool click 1 && sleep 0.5 && xdotool key Escape";
    EXPECT_EQ(std::system(script), 0);
  });
  const DisplayConnection display;
  WalkWindow window(box, options);
  window.run();
  person.join();
  EXPECT_TRUE(window.is_walking());
  EXPECT_TRUE(window.look().illuminance);
  const auto kept = read_views(options.bookmark_file).bookmarks[0];
  ASSERT_TRUE(kept.has_value());
  // Rays towards wall and floor are in single precision.
  EXPECT_NEAR(kept->position.z(), 2.0 - body.radius, 1e-6);
  EXPECT_NEAR(kept->position.y(), body.eye_height, 1e-6) << "it stands on the floor";
  ASSERT_TRUE(window.pointer().reading().has_value());
  const PointReading& reading = *window.pointer().reading();
  const float lux = vertex_illuminance(box.solution)[8];
  EXPECT_NEAR(reading.lux, lux, 1e-5 * lux);  // single precision
  EXPECT_EQ(reading.surface, scene.surfaces[2].name);
}

}  // namespace
}  // namespace lightwell::view_test
