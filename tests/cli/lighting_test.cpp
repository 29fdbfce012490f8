// Figures and errors of 'lightwell report' and 'lightwell info --ugr'.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/report_command.h"

namespace lightwell::lighting_test {
namespace {
using Words = std::vector<std::string>;
using Json = nlohmann::json;

/// The solve joins two surfaces into a floor of 4 m x 2 m; the report has each by its name.
TEST_F(ReportCommand, SurfacesOfOnePlaneAreMeasuredByName) {
  folder.write("floor.toml", R"(
unit = "m"
[materials.white]
reflectance = 0.5
[materials.panel]
power = 10
[[surfaces]]
name = "left"
material = "white"
polygon = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]
[[surfaces]]
name = "right"
material = "white"
polygon = [[2, 0, 0], [4, 0, 0], [4, 2, 0], [2, 2, 0]]
[[surfaces]]
name = "panel"
material = "panel"
polygon = [[0, 0, 2], [0, 2, 2], [1, 2, 2], [1, 0, 2]]
)");
  const Json solved = run_json(Words{"solve", "floor.toml", "-o", "floor.vtp"} + quick());
  EXPECT_EQ(solved["cleaned"]["joined"], 1);
  const Json json = run_json({"report", "floor.toml", "floor.vtp", "--surface", "left", "--surface",
                              "right", "--rays", "64"});
  ASSERT_EQ(json["surfaces"].size(), 2u);
  for (const Json& surface : json["surfaces"]) {
    EXPECT_DOUBLE_EQ(surface["area_m2"].get<double>(), 4.0);
    EXPECT_EQ(surface["points"], json["surfaces"][0]["points"]);
  }
  EXPECT_EQ(json["surfaces"][1]["name"], "right");
  // The panel hangs over the left half.
  EXPECT_GT(json["surfaces"][0]["E_min"], json["surfaces"][1]["E_max"]);
}

/// The room's largest plane that faces up is its floor of 4 m x 3 m, of which a margin of 0.5 m is
/// left out. All figures of a grid follow from the points in the CSV.
TEST_F(ReportCommand, FiguresAreThoseOfThePoints) {
  const Json json = run_json(
      {"report",        "room.toml", "room.vtp",   "--plane", "room@0.75", "--surface", "panel",
       "--maintenance", "0.8",       "--observer", "door",    "--watts",   "panel=40",  "--rays",
       "256",           "-o",        "a.html",     "-o",      "a.json",    "-o",        "a.csv"});
  ASSERT_EQ(json["surfaces"].size(), 2u);
  const Json& plane = json["surfaces"][1];  // planes follow the surfaces
  EXPECT_EQ(plane["name"], "room + 0.75 m");
  // EN 12464-1 spacing p(3 m) = 0.43 m: 7 x 5 cells.
  EXPECT_EQ(plane["points"], 35);
  EXPECT_EQ(Json::parse(content_of(folder / "a.json"))["surfaces"], json["surfaces"]);

  double sum = 0.0, least = 1e30;
  int count = 0;
  std::istringstream csv(content_of(folder / "a.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "surface,x,y,z,lux,lux_within");
  while (std::getline(csv, line)) {
    if (line.rfind("\"room + 0.75 m\",", 0) != 0) continue;
    std::vector<double> values;
    std::istringstream rest(line.substr(line.find("\",") + 2));
    for (std::string value; std::getline(rest, value, ',');) values.push_back(std::stod(value));
    ASSERT_EQ(values.size(), 5u);
    EXPECT_GE(values[0], 0.5);
    EXPECT_DOUBLE_EQ(values[2], 0.75);
    sum += values[3];
    least = std::min(least, values[3]);
    ++count;
  }
  ASSERT_EQ(count, 35);
  const double E_m = plane["E_m"];
  // The CSV has six digits: the relative rounding error is at most 5e-6.
  constexpr double rounded = 5e-6;
  EXPECT_NEAR(E_m, sum / count, rounded * E_m);
  EXPECT_NEAR(plane["E_min"].get<double>(), least, rounded * least);
  EXPECT_NEAR(plane["U_0"].get<double>(), least / E_m, rounded);
  // If the standard deviation of single rays is the mean, that of 256 rays is 1 / sqrt(256) of the
  // mean; `point_within` is two standard deviations.
  const double point_within = plane["point_within_relative"];
  EXPECT_GT(point_within, 0.0);
  EXPECT_LT(point_within, 2.0 / 16.0);

  ASSERT_EQ(json["luminaires"].size(), 1u);
  EXPECT_EQ(json["luminaires"][0]["name"], "panel");
  EXPECT_EQ(json["luminaires"][0]["watts"], 40.0);
  EXPECT_GT(json["luminaires"][0]["lumens"].get<double>(), 0.0);
  EXPECT_TRUE(json["observers"][0]["UGR"].is_number()) << json["observers"];

  const std::string page = content_of(folder / "a.html");
  for (const char* piece : {"room + 0.75 m", "<svg", "UGR", "maintenance factor of 0.8"}) {
    EXPECT_TRUE(says(page, piece));
  }
  for (std::size_t at = 0; (at = page.find("src=\"", at)) != std::string::npos; ++at) {
    EXPECT_EQ(page.compare(at + 5, 5, "data:"), 0) << "it holds all it needs";
  }
}

/// Power density is 40 W over the 12 m2 of the floor.
TEST_F(ReportCommand, GridsOfTheSceneFileAreMeasured) {
  folder.write("room.toml", small_room() +
                                "[[grids]]\nname = \"desks\"\nsurface = \"room\"\nheight = "
                                "0.75\nmargin = 0.25\nspacing = 1\n");
  const Json json = run_json(
      {"report", "room.toml", "room.vtp", "--watts", "panel=40", "--rays", "64", "-o", "a.html"});
  ASSERT_EQ(json["surfaces"].size(), 1u);
  const Json& desks = json["surfaces"][0];
  EXPECT_EQ(desks["name"], "desks");
  EXPECT_EQ(desks["points"], 4 * 3);  // 3.5 m x 2.5 m in cells of at most 1 m
  EXPECT_EQ(desks["margin_m"], 0.25);
  // Doubles in JSON are not rounded.
  EXPECT_DOUBLE_EQ(desks["W_per_m2"].get<double>(), 40.0 / 12.0);
  EXPECT_DOUBLE_EQ(desks["W_per_m2_per_100_lx"].get<double>(),
                   40.0 / 12.0 / (desks["E_m"].get<double>() / 100.0));
  EXPECT_TRUE(says(content_of(folder / "a.html"), "<td>3.33</td>"));
  EXPECT_FALSE(
      run_json({"report", "room.toml", "room.vtp", "--rays", "64"})["surfaces"][0].contains(
          "W_per_m2"))
      << "nobody knows the panel's power";
}

/// The language is that of pages; figures for programs are the same.
TEST_F(ReportCommand, SpeaksTheLanguageThatIsAskedFor) {
  const Words plane = {"report", "room.toml", "room.vtp", "--plane", "room@0.75", "--rays", "64"};
  const Json english = run_json(plane + Words{"-o", "a.html"});
  const Json german = run_json(plane + Words{"-o", "b.html", "--language", "de"});
  EXPECT_EQ(english["surfaces"], german["surfaces"]);
  EXPECT_TRUE(says(content_of(folder / "a.html"), "calculation surface"));
  EXPECT_TRUE(says(content_of(folder / "b.html"), "Berechnungsfläche"));
  expect_refused({"--surface", "room", "--language", "klingon", "-o", "c.html"}, 2, "--language");
}

/// A PDF is written, or the message says how to get one; the same input gives the same bytes.
TEST_F(ReportCommand, WritesPdf) {
  const Words report = {"report", "room.toml", "room.vtp", "--surface", "panel", "--rays", "64"};
#ifdef LIGHTWELL_PDF
  for (const char* name : {"a.pdf", "b.pdf"}) {
    const Ended ended = run(report + Words{"-o", name, "--quiet"});
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  const std::string bytes = content_of(folder / "a.pdf");
  EXPECT_EQ(bytes.substr(0, 5), "%PDF-");
  EXPECT_EQ(bytes, content_of(folder / "b.pdf"));
#else
  const Ended ended = run(report + Words{"-o", "a.pdf"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_TRUE(says(ended.err, "librsvg2-dev"));
#endif
}

/// Illuminance by the same rays is proportional to the maintenance factor.
TEST_F(ReportCommand, MaintenanceDimsAllAlike) {
  const auto mean = [&](const char* factor) {
    return run_json({"report", "room.toml", "room.vtp", "--plane", "room@0.75", "--rays", "64",
                     "--maintenance", factor})["surfaces"][0]["E_m"]
        .get<double>();
  };
  const double full = mean("1");
  EXPECT_EQ(mean("0.5"), 0.5 * full) << "halving a double rounds nothing";
}

// A room of 4 m x 3 m with a window under a sky, an emitting panel, a table and a spot.
std::string daylit_room(bool with_sky, bool with_lamps) {
  std::string text = R"(
title = "Room <1> & \"2\""
[report]
client = "A & B"
date = "2026-11-26"
[materials.white]
reflectance = 0.5
[materials.pane]
glass = { ior = 1.5, thin = true }
[[surfaces]]
name = "floor"
material = "white"
polygon = [[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]]
[[surfaces]]
name = "shell"
material = "white"
polygons = [
  [[0, 0, 2.5], [0, 3, 2.5], [4, 3, 2.5], [4, 0, 2.5]],
  [[0, 0, 0], [0, 0, 2.5], [4, 0, 2.5], [4, 0, 0]],
  [[4, 3, 0], [4, 3, 2.5], [0, 3, 2.5], [0, 3, 0]],
  [[0, 3, 0], [0, 3, 2.5], [0, 0, 2.5], [0, 0, 0]],
]
[[surfaces]]
name = "window"
material = "pane"
polygon = [[4, 0, 0], [4, 3, 0], [4, 3, 2.5], [4, 0, 2.5]]
[[surfaces]]
name = "table"
material = "white"
box = { min = [1, 1, 0.68], max = [2, 2, 0.70] }
[[cameras]]
name = "eye"
position = [0.5, 1.5, 1.2]
look_at = [4, 1.5, 1.0]
up = [0, 0, 1]
size = [64, 48]
)";
  if (with_sky) {
    text += R"([sky]
kind = "uniform"
illuminance = 5000
up = [0, 0, 1]
north = [0, 1, 0]
)";
  }
  if (!with_lamps) return text;
  return text + R"([[lamps]]
name = "spot"
position = [1, 1.5, 2.4]
lumens = 900
watts = 9
)";
}

class DaylightReport : public CommandTest {
 protected:
  Json report(const std::string& scene, const Words& solve, const Words& more) {
    folder.write("daylit.toml", scene);
    const Ended solved =
        run(Words{"solve", "daylit.toml", "-o", "daylit.vtp", "--quiet"} + solve + quick());
    EXPECT_EQ(solved.code, 0) << solved.err;
    return run_json(
        Words{"report", "daylit.toml", "daylit.vtp", "--plane", "floor@0.75", "--rays", "256"} +
        more);
  }
};

/// Each part is what a scene with nothing else would have, and the factor is that of lamps alone.
TEST_F(DaylightReport, KeepsElectricLightAndDaylightApart) {
  const Words factor = {"--maintenance", "0.8"};
  const Json both = report(daylit_room(true, true), {}, factor);
  EXPECT_EQ(both["contains"], "electric and daylight, apart");
  const Json day = report(daylit_room(true, false), {}, factor);
  EXPECT_EQ(day["contains"], "daylight");
  const Json lamps = report(daylit_room(false, true), {}, factor);
  EXPECT_EQ(lamps["contains"], "electric");
  const auto figure = [](const Json& surface, const char* key) {
    return surface[key].get<double>();
  };
  const Json& mixed = both["surfaces"][0];
  // Bounds of two gathers each, with odds of 19 to 1.
  for (const auto& [part, alone] : {std::pair(mixed["daylight"], day["surfaces"][0]),
                                    std::pair(mixed["electric"], lamps["surfaces"][0])}) {
    EXPECT_NEAR(figure(part, "E_m"), figure(alone, "E_m"),
                figure(part, "mean_within") + figure(alone, "mean_within"));
    EXPECT_GT(figure(part, "E_m"), 10.0);
  }
  // Sums of a few doubles.
  constexpr double rounding = 1e-14;
  EXPECT_NEAR(figure(mixed, "E_m"),
              figure(mixed["daylight"], "E_m") + figure(mixed["electric"], "E_m"),
              rounding * figure(mixed, "E_m"));
  EXPECT_DOUBLE_EQ(figure(mixed, "W_per_m2_per_100_lx"),
                   9.0 / 12.0 / (figure(mixed["electric"], "E_m") / 100.0));
}

TEST_F(DaylightReport, SaysThatAMixtureCannotBeToldApart) {
  const Json json = report(daylit_room(true, true), {"--channels", "off"}, {"-o", "a.html"});
  EXPECT_EQ(json["contains"], "electric and daylight, together");
  EXPECT_FALSE(json["surfaces"][0].contains("electric"));
  EXPECT_FALSE(json["surfaces"][0].contains("W_per_m2_per_100_lx"));
  EXPECT_TRUE(says(content_of(folder / "a.html"), "together</b>"));
}

/// The page has what is handed over: heading, picture, plan with walls, window, table, luminaire,
/// observer, axes, scale, north and isolux lines.
TEST_F(DaylightReport, ThePageIsComplete) {
  report(daylit_room(true, true), {}, {"--observer", "eye", "-o", "a.html", "-o", "a.csv"});
  const std::string page = content_of(folder / "a.html");
  for (const char* piece :
       {"Room &lt;1> &amp; &quot;2&quot;", "<dt>Client</dt><dd>A &amp; B</dd>", "2026-11-26",
        "data:image/png;base64,", "View ‘eye’", "class=\"wall\"", "class=\"pane\"",
        "class=\"edge\"", "class=\"luminaire\"", "class=\"eye\"", "class=\"iso\"", "x, m", "y, m",
        "1 : 40 on A4 paper", "class=\"north\"", "<b>electric light</b>", "<b>daylight</b>"}) {
    EXPECT_TRUE(says(page, piece));
  }
  EXPECT_EQ(content_of(folder / "a.csv").substr(0, 56),
            "surface,x,y,z,lux,lux_within,electric_lux,daylight_lux\n\"");
}

/// With the sky switched off, figures are those of the lamp alone.
TEST_F(DaylightReport, OfARelitSolutionIsOfTheLightThatIsOn) {
  const Json both = report(daylit_room(true, true), {}, {});
  const Ended relit = run({"relight", "daylit.vtp", "--channel", "sky=off", "-o", "night.vtp"});
  ASSERT_EQ(relit.code, 0) << relit.err;
  const Json night =
      run_json({"report", "daylit.toml", "night.vtp", "--plane", "floor@0.75", "--rays", "256"});
  EXPECT_EQ(night["contains"], "electric");
  // The same rays with the same light.
  EXPECT_DOUBLE_EQ(night["surfaces"][0]["E_m"].get<double>(),
                   both["surfaces"][0]["electric"]["E_m"].get<double>());
}

/// Names cannot end the page's title, style sheet or script, and a grid of one point has a plan.
TEST_F(DaylightReport, TakesHostileNamesAndTheSmallestGrid) {
  std::string scene = daylit_room(false, true);
  const std::string title = R"(title = "Room <1> & \"2\"")";
  const std::size_t at = scene.find(title);
  ASSERT_NE(at, std::string::npos);
  scene.replace(at, title.size(), R"(title = "</style><script>alert(1)</script>\n} *")");
  const Json json = report(scene, {}, {"--surface", "table", "--spacing", "2", "-o", "a.html"});
  EXPECT_EQ(json["surfaces"][0]["points"], 1);
  const std::string page = content_of(folder / "a.html");
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("</style>"), page.rfind("</style>")) << "the page's own";
}

/// A grid of more than 5000 points is drawn as a picture.
TEST_F(DaylightReport, DrawsLargeGridsAsPictures) {
  report(daylit_room(false, true), {},
         {"--surface", "floor", "--spacing", "0.04", "--picture", "none", "-o", "a.html"});
  const std::string page = content_of(folder / "a.html");
  EXPECT_TRUE(says(page, "image-rendering: pixelated"));
  constexpr std::size_t a_megabyte = 1 << 20;
  EXPECT_LT(page.size(), a_megabyte);
}

TEST_F(DaylightReport, APlaneAtHeightZeroIsTheSurfaceItself) {
  const Json json = report(daylit_room(false, true), {}, {"--plane", "floor@0", "--margin", "0.5"});
  ASSERT_EQ(json["surfaces"].size(), 2u);
  EXPECT_EQ(json["surfaces"][1]["height_m"], 0.0);
  EXPECT_GT(json["surfaces"][1]["E_m"].get<double>(), 0.0);
}

TEST_F(DaylightReport, WrongNamesEndItBeforeAnythingIsMeasured) {
  report(daylit_room(false, true), {}, {});
  const Ended ended = run({"report", "daylit.toml", "daylit.vtp", "--plane", "floor@0.75",
                           "--observer", "ey", "-o", "b.html"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_EQ(ended.err.find("gather"), std::string::npos) << ended.err;
}

TEST_F(ReportCommand, PrintsItsFigures) {
  const Ended ended = run({"report", "room.toml", "room.vtp", "--surface", "panel", "--observer",
                           "door", "--rays", "64", "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended.out, "panel: E_m "));
  EXPECT_TRUE(says(ended.out, "door: UGR "));
}

TEST_F(ReportCommand, RefusesWhatItCannotMeasure) {
  expect_refused({"--surface", "pannel", "-o", "a.html"}, 3, "Did you mean 'panel'?");
  expect_refused({"-o", "a.html"}, 3, "--plane floor@0.75");
  expect_refused({"--plane", "room", "-o", "a.html"}, 2, "NAME@NUMBER");
  expect_refused({"--plane", "room@0.75", "--margin", "2", "-o", "a.html"}, 3, "smaller one");
  expect_refused({"--observer", "window", "-o", "a.html"}, 3, "window");
  expect_refused({"--surface", "panel", "--watts", "lamp=3", "-o", "a.html"}, 3, "no luminaire");
  expect_refused({"--surface", "panel", "-o", "a.doc"}, 2, ".html");
}

class InfoCommand : public CommandTest {};

TEST_F(InfoCommand, ListsTheSurfacesThatReportsName) {
  folder.write("room.toml", small_room());
  const Json list = run_json({"info", "room.toml", "--surfaces"})["surface_list"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["name"], "room");
  EXPECT_EQ(list[0]["facets"], 6);
  // 2 (4 x 3 + 4 x 2.5 + 3 x 2.5) m2. Each of six products and sums rounds by 1.1e-16 of at most
  // 59: 12 * 6.5e-15 = 8e-14.
  EXPECT_NEAR(list[0]["area"].get<double>(), 59.0, 1e-13);
  EXPECT_EQ(list[1]["material"], "panel");
  EXPECT_TRUE(says(run({"info", "room.toml", "--surfaces"}).out, "room, material white, facets 6"));
  EXPECT_FALSE(run_json({"info", "room.toml"}).contains("surface_list"));
}

TEST_F(InfoCommand, PrintsAndHandsOverTheUgrTable) {
  const std::string file = std::string(LIGHTWELL_TEST_DATA) + "/luminaires/ugr/sample_03.ldt";
  const Json ugr = run_json({"info", file, "--ugr"})["ugr"];
  ASSERT_EQ(ugr["rooms"].size(), 19u);
  EXPECT_EQ(ugr["rooms"][7], Json::array({4, 3}));
  EXPECT_EQ(ugr["reflectances_percent"][0], Json::array({70.0, 50.0, 20.0}));
  ASSERT_EQ(ugr["along_c0"].size(), 19u);
  ASSERT_EQ(ugr["along_c90"][7].size(), 5u);
  const Ended ended = run({"info", file, "--ugr"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const std::string row = ended.out.substr(ended.out.find("4H x 3H"));
  std::istringstream printed(row.substr(7));
  for (const char* view : {"along_c0", "along_c90"}) {
    for (const Json& rating : ugr[view][7]) {
      double value = 0.0;
      ASSERT_TRUE(printed >> value);
      EXPECT_DOUBLE_EQ(value, std::round(10.0 * rating.get<double>()) / 10.0);
    }
  }
}

// An XML file of TM-33 is a luminaire, in spite of its extension.
TEST_F(InfoCommand, DescribesLuminairesInXml) {
  const std::string file = std::string(LIGHTWELL_DOCS) + "/luminaires/panel.xml";
  const Json facts = run_json({"info", file, "--ugr"});
  EXPECT_EQ(facts["kind"], "luminaire");
  EXPECT_EQ(facts["format"], "IES TM-33-23");
  EXPECT_EQ(facts["input_watts"], 28.0);
  EXPECT_EQ(facts["spectra"][0]["samples"], 21);
  EXPECT_EQ(facts["ugr"]["rooms"].size(), 19u);
  EXPECT_TRUE(says(run({"info", file}).out, "board, lumens"));
}

}  // namespace
}  // namespace lightwell::lighting_test
