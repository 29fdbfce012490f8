// Readings of the page beside those of `render`, in rooms of four materials.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/viewer/four_materials.h"
#include "tests/viewer/in_browser.h"

namespace lightwell::four_materials_in_browser_test {
namespace {

using namespace four_materials;

/// Pixels in the middle of the strips, as lit and by the light in view. The page's axes have y
/// upwards, and the wall of the strips is at z = 0.
constexpr const char* read_strips = R"(<script>
driver.run(async (page, found) => {
  const canvas = element('view');
  for (const white of ['as-lit', 'auto']) {
    element('white').value = white;
    element('white').dispatchEvent(new Event('change'));
    page.draw(0);
    found[white] = [0, 1, 2, 3].map((strip) => {
      const at = on_canvas(new Library.Vector3(strip + 0.5, 1, 0), page.picture.camera, canvas);
      return driver.pixel(at.x / canvas.clientWidth, at.y / canvas.clientHeight);
    });
  }
});
</script>)";

/// The bound of the window (WhiteBalance.TheWindowShowsTheColoursOfRender): 2 % of noise and
/// interpolation in one pixel are 2.3 bytes, and rounding adds 0.5.
TEST_P(InBrowser, ThePageShowsTheColoursOfRender) {
  std::printf(
      "| light | material | as lit: render | page | auto: render | page |\n"
      "|---|---|---|---|---|---|\n");
  for (const auto& [light, text] : lights_of_materials()) {
    const TemporaryFolder of_scene;
    const Scene scene = read_scene(of_scene.write("room.toml", text + room_of_materials));
    const SolvedScene solved = solved_room(scene);
    const Json found = run(bake_model(solved, scene), read_strips);
    ASSERT_FALSE(found.is_null());
    ASSERT_FALSE(found.contains("failed")) << found["failed"];
    const auto as_lit = rendered_room(scene, solved, WhitePoint::Kind::as_lit);
    const auto balanced = rendered_room(scene, solved, WhitePoint::Kind::automatic);
    ASSERT_FALSE(as_lit.empty());
    for (int m = 0; m < 4; ++m) {
      std::string row = fmt::format("| {} | {} |", light, materials[static_cast<std::size_t>(m)]);
      for (const auto& [white, picture] :
           {std::pair("as-lit", &as_lit), std::pair("auto", &balanced)}) {
        const Rgb wanted = reading_of(*picture, m);
        const Rgb seen = found[white][static_cast<std::size_t>(m)].get<Rgb>();
        row += " " + text_of(wanted) + " | " + text_of(seen) + " |";
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], wanted[c], 3.0) << row;
      }
      std::printf("%s\n", row.c_str());
    }
  }
}

}  // namespace
}  // namespace lightwell::four_materials_in_browser_test
