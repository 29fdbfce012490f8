// Pictures: layers, exposure, checkpoints and comparison.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "radiosity/solution/solution_file.h"
#include "raytrace/pictures/image.h"
#include "tests/cli/program.h"

namespace lightwell::picture_test {
namespace {
using namespace std::chrono_literals;
using Words = std::vector<std::string>;

class Pictures : public CommandTest {
 protected:
  Pictures() {
    folder.write("room.toml", small_room());
    EXPECT_EQ(run(Words{"solve", "room.toml", "-o", "S.vtp", "--quiet"} + quick()).code, 0);
  }
  Words render(const Words& more) const {
    return Words{"render", "room.toml", "S.vtp", "--size", "24x18", "--pass", "interpolate"} + more;
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
  // Waits until the checkpoint holds a tile of a picture with that many channels.
  void wait_for_a_tile(const std::string& checkpoint, int channels) const {
    const auto a_tile = static_cast<std::uintmax_t>(8000) * channels * sizeof(float);
    std::error_code none;
    for (int i = 0; i < 2400; ++i) {
      const auto size = std::filesystem::file_size(folder / checkpoint, none);
      if (!none && size > a_tile) break;
      std::this_thread::sleep_for(25ms);
    }
  }
};

// A cube of emitters in relative units.
std::string relative_scene() {
  return R"(<scene version="3.0.0"><shape type="cube"><emitter type="area"/></shape>
      <sensor type="perspective"><transform name="to_world">
      <lookat origin="0,0,5" target="0,0,0"/></transform><film type="hdrfilm">
      <integer name="width" value="8"/><integer name="height" value="8"/></film></sensor></scene>)";
}

TEST_F(Pictures, QualitiesStandForOptions) {
  const auto picture = [&](const Words& options) {
    EXPECT_EQ(
        run(Words{"render", "room.toml", "S.vtp", "--size", "12x9", "-o", "q.exr"} + options).code,
        0);
    return read_exr(folder / "q.exr").radiance;
  };
  const BandArray draft = picture({"--quality", "draft"}), good = picture({});
  EXPECT_TRUE(
      (draft == picture({"--shadow-rays", "16", "--photons", "65536", "--noise", "10%"})).all());
  EXPECT_TRUE((good == picture({"--quality", "good"})).all());
  // An option of its own comes before the quality, in any order.
  EXPECT_TRUE((good == picture({"--shadow-rays", "64", "--photons", "524288", "--noise", "2%",
                                "--quality", "draft"}))
                  .all());
}

TEST_F(Pictures, WithoutASolutionAreMadeByVirtualLights) {
  const auto picture = [&](const Words& options) {
    const Ended made =
        run(Words{"render", "room.toml", "--size", "24x18", "-o", "v.exr"} + options);
    EXPECT_EQ(made.code, 0) << made.err;
    return read_exr(folder / "v.exr").radiance;
  };
  ASSERT_EQ(
      run({"render", "room.toml", "S.vtp", "--size", "24x18", "--pass", "gather", "-o", "g.exr"})
          .code,
      0);
  const BandArray gathered = read_exr(folder / "g.exr").radiance,
                  full = picture({"--pass", "virtual-lights", "--virtual-lights", "2048"}),
                  draft = picture({"--pass", "virtual-lights", "--quality", "draft"});
  std::printf("mean radiance: gathered %.5f, by virtual lights %.5f, draft %.5f\n", gathered.mean(),
              full.mean(), draft.mean());
  // Lengths of paths vary by less than their mean: 2048 (1 - rho) paths, 1024 by the room's mean
  // rho of 0.5, leave 1 / sqrt(1024) = 3 % of the indirect light, three times which is allowed.
  EXPECT_NEAR(full.mean() / gathered.mean(), 1.0f, 0.09f);
  // A draft shows the light of vertices: other pixels, lit as well.
  EXPECT_TRUE(draft.isFinite().all());
  EXPECT_GT(draft.mean(), 0.0f);
  EXPECT_FALSE((draft == full).all());
  EXPECT_TRUE(
      (draft == picture({"S.vtp", "--pass", "virtual-lights", "--quality", "draft"})).all());
  EXPECT_TRUE((full == picture({"--pass", "virtual-lights", "--virtual-lights", "2048"})).all());
}

TEST_F(Pictures, OfASceneWithoutLightAreRefused) {
  folder.write("dark.toml", R"(
[materials.wall]
reflectance = 0.5
[[surfaces]]
name = "room"
material = "wall"
box = { min = [0, 0, 0], max = [2, 1, 3], inward = true }
[[cameras]]
name = "c"
position = [1, 0.5, 0.2]
look_at = [1, 0.5, 3]
)");
  const Ended refused = run({"render", "dark.toml", "--pass", "virtual-lights", "-o", "v.exr"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("nothing emits light"), std::string::npos) << refused.err;
}

TEST_F(Pictures, OfOtherPassesNeedASolution) {
  for (const std::string pass : {"auto", "direct", "gather", "interpolate"}) {
    const Ended refused = run({"render", "room.toml", "--pass", pass, "-o", "v.exr"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("--pass " + pass + " shows the light of a solution"),
              std::string::npos)
        << refused.err;
  }
  EXPECT_FALSE(exists("v.exr"));
  EXPECT_EQ(run({"render", "room.toml", "--pass", "virtual-lights", "--virtual-lights", "0", "-o",
                 "v.exr"})
                .code,
            2);
}

TEST_F(Pictures, LayersComeIntoTheExr) {
  ASSERT_EQ(run(render({"-o", "a.exr", "--layers", "normal,depth", "--layers", "patch"})).code, 0);
  const Image some = read_exr(folder / "a.exr", ExrChannels::all);
  EXPECT_EQ(some.layers.names, (Words{"depth.Z", "normal.X", "normal.Y", "normal.Z", "patch.id"}));
  ASSERT_EQ(run(render({"-o", "all.exr", "--layers", "all"})).code, 0);
  EXPECT_EQ(read_exr(folder / "all.exr", ExrChannels::all).layers.names.size(), 23u);
  EXPECT_TRUE((read_exr(folder / "all.exr").radiance == some.radiance).all());
}

TEST_F(Pictures, LayersThatCannotBeAreRefusedBeforeTheWork) {
  const Ended misspelt = run(render({"-o", "a.exr", "--layers", "albedo,normals"}));
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_TRUE(says(misspelt.err, "there is no layer 'normals'")) << misspelt.err;
  EXPECT_TRUE(says(misspelt.err, "Did you mean 'normal'?")) << misspelt.err;
  const Ended nowhere = run(render({"-o", "a.png", "--layers", "albedo"}));
  EXPECT_EQ(nowhere.code, 3);
  EXPECT_TRUE(says(nowhere.err, "layers go into an .exr")) << nowhere.err;
  EXPECT_FALSE(exists("a.png"));
  const Ended no_png = run(render({"-o", "a.exr", "--false-colour", "luminance"}));
  EXPECT_EQ(no_png.code, 3);
  EXPECT_TRUE(says(no_png.err, "false colours go into a .png")) << no_png.err;
}

#ifdef LIGHTWELL_VIEWER
TEST_F(Pictures, FalseColoursHaveAScaleBesideThem) {
  ASSERT_EQ(run(render({"-o", "a.png", "--false-colour", "illuminance", "--range", "0:500", "-o",
                        "a.exr"}))
                .code,
            0);
  const std::string png = content_of(folder / "a.png");
  EXPECT_TRUE(says(png, "illuminance in lx, 0 to 500"));
  EXPECT_FALSE(says(png, "toneMap"));
  const auto edge = [&](std::size_t at) {
    return (static_cast<unsigned char>(png[at]) << 24) +
           (static_cast<unsigned char>(png[at + 1]) << 16) +
           (static_cast<unsigned char>(png[at + 2]) << 8) + static_cast<unsigned char>(png[at + 3]);
  };
  EXPECT_GT(edge(16), 24 + 30) << "as wide as the picture and the scale";
  EXPECT_GE(edge(20), 18);
  EXPECT_EQ(read_exr(folder / "a.exr", ExrChannels::all).layers.names, Words{"illuminance.Y"});
}
#endif

TEST_F(Pictures, WhatNeedsAUnitOfLightIsRefusedWhereThereIsNone) {
  folder.write("box.xml", relative_scene());
  ASSERT_EQ(run(Words{"solve", "box.xml", "-o", "B.vtp", "--quiet"} + quick()).code, 0);
  const Words box = {"render", "box.xml", "B.vtp", "-o", "b.exr", "-o", "b.png"};
  for (const Words& words :
       {Words{"--ev100", "10"}, Words{"--layers", "luminance"}, Words{"--layers", "illuminance"},
        Words{"--false-colour", "luminance"}}) {
    const Ended ended = run(box + words);
    EXPECT_EQ(ended.code, 3) << words[0];
    EXPECT_TRUE(says(ended.err, "box.xml: names no unit of light")) << ended.err;
    EXPECT_FALSE(exists("b.exr"));
  }
  ASSERT_EQ(run(box + Words{"--layers", "all"}).code, 0);
  const auto names = read_exr(folder / "b.exr", ExrChannels::all).layers.names;
  EXPECT_EQ(names.size(), 21u) << "all but luminance and illuminance";
  EXPECT_EQ(std::count(names.begin(), names.end(), "luminance.Y"), 0);
}

TEST_F(Pictures, PngSaysWhatItsWhiteIs) {
  ASSERT_EQ(run(render({"-o", "a.png", "--ev100", "8", "--tone-map", "linear"})).code, 0);
  const std::string png = content_of(folder / "a.png");
  EXPECT_TRUE(says(png, "--tone-map linear --exposure 0 --ev100 8"));
  EXPECT_TRUE(says(png, std::string("whiteLuminance") + '\0' + "307.2"));  // 1.2 * 2^8 cd/m^2
  // --ev100 one higher is a stop darker, --exposure 1 a stop brighter.
  ASSERT_EQ(
      run(render({"-o", "b.png", "--ev100", "9", "--exposure", "1", "--tone-map", "linear"})).code,
      0);
  const auto pixels = [](const std::string& file) { return file.substr(file.find("IDAT")); };
  EXPECT_EQ(pixels(png), pixels(content_of(folder / "b.png")));
  ASSERT_EQ(run(render({"-o", "b.png", "--ev100", "9", "--tone-map", "linear"})).code, 0);
  EXPECT_NE(pixels(png), pixels(content_of(folder / "b.png")));
  const Ended wrong = run(render({"-o", "a.png", "--tone-map", "film"}));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(says(wrong.err, "Did you mean 'filmic'?")) << wrong.err;
}

TEST_F(Pictures, AnyCameraSeesInAnyProjection) {
  const Words square = {"render", "room.toml", "S.vtp", "--size", "20x20", "--pass", "interpolate"};
  ASSERT_EQ(run(square + Words{"--projection", "fisheye:180", "-o", "a.hdr", "-o", "a.exr", "-o",
                               "a.png", "--layers", "coverage"})
                .code,
            0);
  const std::string hdr = content_of(folder / "a.hdr");
  EXPECT_TRUE(says(hdr.substr(0, hdr.find("\n\n")), "\nVIEW= -vta -vp "));
  EXPECT_TRUE(says(hdr, " -vh 180 -vv 180 -vo 0 -va 0 -vs 0 -vl 0\n"));
  EXPECT_TRUE(says(content_of(folder / "a.png"), " -vh 180 -vv 180 "));
  EXPECT_TRUE(says(content_of(folder / "a.png"), "--projection fisheye:180"));
  const Image fisheye = read_exr(folder / "a.exr", ExrChannels::all);
  EXPECT_EQ(fisheye.layers.names, Words{"A"});
  EXPECT_EQ(fisheye.radiance.row(0).maxCoeff(), 0.0f);
  EXPECT_EQ(fisheye.layers.values(0, 0), 0.0f);
  for (const char* projection :
       {"perspective:90", "equisolid", "hemispherical", "stereographic:200", "cylindrical:360",
        "equirectangular", "stereo", "cube", "orthographic", "orthographic:3"}) {
    const Words words = {"render",       "room.toml", "S.vtp", "--pass", "interpolate",
                         "--projection", projection,  "-o",    "b.exr"};
    const Ended ended = run(words);
    EXPECT_EQ(ended.code, 0) << projection << ended.err;
    EXPECT_GT(read_exr(folder / "b.exr").radiance.maxCoeff(), 0.0f) << projection;
  }
  ASSERT_EQ(run(render({"--shift", "-0.1,0.25", "--near", "0.1", "-o", "b.png"})).code, 0);
  EXPECT_TRUE(says(content_of(folder / "b.png"), "-vo 0.1 -va 0 -vs -0.1 -vl 0.25"));
}

TEST_F(Pictures, ProjectionsThatCannotBeAreRefusedAtOnce) {
  const auto refused = [&](const Words& options, int code, const std::string& why) {
    const Ended ended = run(Words{"render", "room.toml", "missing.vtp", "-o", "a.png"} + options);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_TRUE(says(ended.err, why)) << ended.err;
  };
  refused({"--projection", "fishey"}, 2, "Did you mean 'fisheye'?");
  refused({"--projection", "fisheye:wide"}, 2, "write an angle in degrees after the colon");
  refused({"--projection", "cube:90"}, 2, "write 'cube' alone");
  refused({"--projection", "perspective:360"}, 3, "must lie between 0 and 180");
  refused({"--projection", "equirectangular", "--size", "200x200"}, 3, "give at most 200 x 100");
  refused({"--projection", "cube", "--size", "200x200"}, 3, "give 198 x 132");
  refused({"--projection", "stereo", "--shift", "0,0.1"}, 3, "turn the camera instead");
  refused({"--shift", "0.1"}, 2, "write two shares of the picture");
  refused({"--near", "-1"}, 2, "a number above 0 is needed");
}

TEST_F(Pictures, ImpossibleSizesAndPlacesAreRefusedAtOnce) {
  for (const char* size : {"0x10", "10x0", "100000x10", "-3x4", "640"}) {
    const Ended ended = run({"render", "room.toml", "missing.vtp", "--size", size, "-o", "a.png"});
    EXPECT_EQ(ended.code, 2) << size;
    EXPECT_TRUE(says(ended.err, "is no picture size")) << ended.err;
  }
  // The size is refused before the solution is read: "missing.vtp" does not exist.
  const Ended large =
      run({"render", "room.toml", "missing.vtp", "--size", "32768x32768", "-o", "a.png"});
  EXPECT_EQ(large.code, 3);
  EXPECT_TRUE(says(large.err, "32768 x 32768 pixels")) << large.err;
  const Ended nowhere = run({"render", "room.toml", "missing.vtp", "-o", "no/folder/a.png"});
  EXPECT_EQ(nowhere.code, 1);
  EXPECT_TRUE(says(nowhere.err, "no/folder")) << nowhere.err;
}

TEST_F(Pictures, InterruptedPictureGoesOnWithTheSameBits) {
  const Words slow = {"render", "room.toml",     "S.vtp", "--size",   "400x400", "-o",
                      "P.exr",  "--shadow-rays", "256",   "--layers", "all"};
  Words reference = slow;
  reference[6] = "R.exr";
  ASSERT_EQ(run(reference).code, 0);
  Running running(folder / "", slow + Words{"--checkpoint", "C", "--every", "0.1s"});
  wait_for_a_tile("C", 25);
  running.signal(SIGINT);
  const Ended ended = running.wait();
  ASSERT_EQ(ended.code, 4) << ended.err;
  EXPECT_TRUE(exists("P.exr"));
  EXPECT_TRUE(says(ended.err, "finished work is in 'C' (")) << ended.err;
  const std::string before_command = "To resume:\n  ";
  const std::size_t at = ended.err.find(before_command);
  ASSERT_NE(at, std::string::npos) << ended.err;
  std::string shell =
      "cd '" + folder.path().string() + "' && " + ended.err.substr(at + before_command.size());
  shell.erase(shell.find_last_not_of('\n') + 1);
  ASSERT_EQ(std::system((shell + " --json >out 2>err").c_str()), 0) << content_of(folder / "err");
  const auto json = nlohmann::json::parse(content_of(folder / "out"));
  EXPECT_GT(json["checkpoint"]["resumed_mb"].get<double>(), 0.5);
  EXPECT_FALSE(exists("C"));
  const Image resumed = read_exr(folder / "P.exr", ExrChannels::all),
              whole = read_exr(folder / "R.exr", ExrChannels::all);
  EXPECT_TRUE((resumed.radiance == whole.radiance).all());
  EXPECT_TRUE((resumed.layers.values == whole.layers.values).all());
}

TEST_F(Pictures, RunKeepsTheTilesOfItsPictures) {
  const Words slow = Words{"--size", "400x400", "--shadow-rays", "256"} + quick();
  ASSERT_EQ(run(Words{"run", "room.toml", "-o", "R"} + slow).code, 0);
  const Words kept =
      Words{"run", "room.toml", "-o", "D"} + slow + Words{"--checkpoint", "C", "--every", "0.1s"};
  Running running(folder / "", kept);
  // The checkpoint of the solve is removed once the solution is written; that of the pictures
  // follows.
  for (int i = 0; i < 2400 && !exists("D/solution.vtp"); ++i) std::this_thread::sleep_for(25ms);
  for (int i = 0; i < 400 && !says(running.err(), "removed the checkpoint"); ++i) {
    std::this_thread::sleep_for(5ms);
  }
  wait_for_a_tile("C", 3);
  running.signal(SIGTERM);
  const Ended ended = running.wait();
  ASSERT_EQ(ended.code, 130) << ended.err;
  EXPECT_TRUE(says(ended.err, "finished work is in 'C' (")) << ended.err;
  EXPECT_FALSE(exists("D/door.exr"));
  const auto json = run_json(kept + Words{"--resume"});
  EXPECT_GT(json["picture_checkpoint"]["resumed_mb"].get<double>(), 0.09);
  EXPECT_FALSE(exists("C"));
  EXPECT_TRUE(
      (read_exr(folder / "D/door.exr").radiance == read_exr(folder / "R/door.exr").radiance).all());
}

TEST_F(Pictures, SigtermWithoutACheckpointLeavesNothing) {
  const int before = folder.file_count();
  Running running(folder / "", {"render", "room.toml", "S.vtp", "--size", "2000x2000", "-o",
                                "P.exr", "--shadow-rays", "256"});
  std::this_thread::sleep_for(1s);  // the picture takes about 15 s
  running.signal(SIGTERM);
  EXPECT_EQ(running.wait().code, 130);
  EXPECT_EQ(folder.file_count(), before);
}

// A picture that is ended early has the rows that were finished, and the solution's light below.
TEST_F(Pictures, CtrlCCompletesThePictureQuickly) {
  const Words slow = {"render", "room.toml",     "S.vtp", "--size",   "400x400", "-o",
                      "P.exr",  "--shadow-rays", "256",   "--layers", "all"};
  ASSERT_EQ(run(Words{"render", "room.toml", "S.vtp", "--size", "400x400", "-o", "R.exr",
                      "--shadow-rays", "256", "--layers", "all"})
                .code,
            0);
  Running running(folder / "", slow + Words{"--checkpoint", "C", "--every", "0.1s", "--json"});
  wait_for_a_tile("C", 3);
  running.signal(SIGINT);
  const Ended ended = running.wait();
  ASSERT_EQ(ended.code, 4) << ended.err;
  EXPECT_TRUE(says(ended.err, "below, four samples for each pixel show the light of the solution"));
  const int rows = nlohmann::json::parse(ended.out)["cut_short_door"]["rows"];
  ASSERT_GT(rows, 0);
  ASSERT_LT(rows, 400);
  const Image early = read_exr(folder / "P.exr", ExrChannels::all),
              whole = read_exr(folder / "R.exr", ExrChannels::all);
  const Eigen::Index finished = rows * 400;
  EXPECT_TRUE((early.radiance.topRows(finished) == whole.radiance.topRows(finished)).all());
  EXPECT_TRUE(
      (early.layers.values.topRows(finished) == whole.layers.values.topRows(finished)).all());
  const Eigen::Index left = 160000 - finished;
  const double mean_early = early.radiance.bottomRows(left).cast<double>().mean();
  const double mean_whole = whole.radiance.bottomRows(left).cast<double>().mean();
  // The mean of errors is at most their RMS.
  const double rms = read_solution(folder / "S.vtp").solution.error_estimate;
  EXPECT_NEAR(mean_early / mean_whole, 1.0, rms);
}

TEST_F(Pictures, PicturesKeepTheTime) {
  const auto json =
      run_json({"render", "room.toml", "S.vtp", "--size", "64x64", "-o", "P.exr", "--time", "1h"});
  EXPECT_FALSE(json.contains("cut_short_door")) << "there was time for the picture as asked for";
  const Ended ended = run({"render", "room.toml", "S.vtp", "--size", "800x800", "-o", "Q.exr",
                           "--shadow-rays", "256", "--time", "0.1s", "--json"});
  EXPECT_EQ(ended.code, 4) << ended.err;
  EXPECT_TRUE(nlohmann::json::parse(ended.out).contains("cut_short_door"));
  EXPECT_TRUE(exists("Q.exr"));
}

// A picture without time is whole: it has the light of the solution in every row.
TEST_F(Pictures, APictureWithoutTimeIsWhole) {
  const Ended ended = run({"render", "room.toml", "S.vtp", "--size", "800x800", "-o", "Q.exr",
                           "--shadow-rays", "256", "--time", "0.1s", "--json"});
  ASSERT_EQ(ended.code, 4) << ended.err;
  ASSERT_EQ(run({"render", "room.toml", "S.vtp", "--size", "200x200", "-o", "R.exr"}).code, 0);
  const Image quick = read_exr(folder / "Q.exr"), whole = read_exr(folder / "R.exr");
  // The mean of errors is at most their RMS.
  const double rms = read_solution(folder / "S.vtp").solution.error_estimate;
  constexpr int strip = 100 * 800;
  for (int first = 0; first < 800 * 800; first += strip) {
    const double of_quick = quick.radiance.middleRows(first, strip).cast<double>().mean();
    EXPECT_GT(of_quick, 0.0) << first;
  }
  const double of_quick = quick.radiance.cast<double>().mean();
  EXPECT_NEAR(of_quick / whole.radiance.cast<double>().mean(), 1.0, rms);
}

TEST_F(Pictures, CompareFailsAboveTheErrorThatIsAllowed) {
  ASSERT_EQ(run(render({"-o", "a.exr"})).code, 0);
  ASSERT_EQ(run({"render", "room.toml", "S.vtp", "--size", "24x18", "-o", "b.exr"}).code, 0);
  const auto json = run_json({"compare", "a.exr", "b.exr", "-o", "d.png"});
  const double error = json["relative_rmse"];
  ASSERT_GT(error, 1e-4);
  ASSERT_LT(error, 0.5);
  EXPECT_EQ(json["bands"].size(), 3u);
  EXPECT_GT(json["flip"].get<double>(), 0.0);
  EXPECT_GE(json["hdr_flip"].get<double>(), json["flip"].get<double>() / 4);
  EXPECT_TRUE(exists("d.png"));
  const auto with_bound = [&](double share) {
    return run({"compare", "a.exr", "b.exr", "--fail-above", std::to_string(share), "--json"});
  };
  const Ended passes = with_bound(1.1 * error), fails = with_bound(0.9 * error);
  EXPECT_EQ(passes.code, 0) << passes.err;
  EXPECT_EQ(fails.code, 1);
  EXPECT_TRUE(says(fails.err, "is above the")) << fails.err;
  EXPECT_EQ(nlohmann::json::parse(fails.out)["passed"], false);
  EXPECT_EQ(run({"compare", "a.exr", "b.exr", "--fail-above", "much"}).code, 2);
}

TEST_F(Pictures, CompareTakesTwoNoisyReferences) {
  ASSERT_EQ(run(render({"-o", "a.exr"})).code, 0);
  const auto json = run_json({"compare", "a.exr", "a.exr", "a.exr", "--block", "4"});
  EXPECT_EQ(json["mean_square"].get<double>(), 0.0);
  EXPECT_EQ(json["reference_noise"].get<double>(), 0.0);
  ASSERT_EQ(run(Words{"render", "room.toml", "S.vtp", "--size", "18x24", "-o", "turned.exr"}).code,
            0);
  const Ended ended = run({"compare", "a.exr", "a.exr", "turned.exr"});
  EXPECT_EQ(ended.code, 3);
  EXPECT_TRUE(says(ended.err, "24 x 18 and 18 x 24")) << ended.err;
}

}  // namespace
}  // namespace lightwell::picture_test
