#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <ostream>
#include <tuple>

#include "coupling/scene_toml.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

/// A scene file of this process that goes away with the object.
class SceneFile {
 public:
  explicit SceneFile(const std::string& text) : path_(temporaryPath("bad_scene.toml")) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~SceneFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string messageOf(const std::string& text, const Overrides& overrides = {}) {
  const SceneFile file(text);
  try {
    readScene(file.path(), overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

const std::string kDomain = "[domain]\nsize = [1, 1, 1]\n";

struct BadInput {
  std::string name, text;
  std::vector<std::string> expected;  ///< parts of the message: place, key, value, range, remedy
  Overrides overrides{};

  friend void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }
};

class BadScene : public testing::TestWithParam<BadInput> {};

TEST_P(BadScene, IsRefusedWithPlaceAndRemedy) {
  const std::string message = messageOf(GetParam().text, GetParam().overrides);
  ASSERT_FALSE(message.empty()) << "the scene was accepted";
  for (const std::string& part : GetParam().expected)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line: " << message;
}

const BadInput kBadInputs[] = {
    {"Syntax", kDomain + "resolution = [1,\n", {"bad_scene.toml:", "syntax"}},
    {"InvalidUtf8", "\xff\xfe", {":1:1: ", "syntax"}},
    {"Empty", "", {"domain.size is missing", "3 numbers"}},
    {"UnknownKey", "[domain]\nsiez = [1, 1, 1]\n", {":2:1: unknown key domain.siez", "domain.size"}},
    {"UnknownTable", kDomain + "[fom]\n", {":3:2: unknown key fom", "foam"}},
    {"UnknownNestedTable",
     kDomain + "[coupling.entrainmnt]\n",
     {"coupling.entrainmnt", "coupling.entrainment"}},
    {"TooSmall", kDomain + "resolution = 4\n", {":3:14: domain.resolution = 4", "8 to 1024 [cells]"}},
    {"TooLarge", kDomain + "[foam]\nwetness = 1.5\n", {":4:11: foam.wetness = 1.5", "0 to 1 [-]"}},
    {"NotANumber", kDomain + "[time]\nfps = nan\n", {":4:7: time.fps = nan", "1 to 1000 [1/s]"}},
    {"Infinite", kDomain + "[time]\nfps = inf\n", {":4:7: time.fps = inf", "1 to 1000 [1/s]"}},
    {"StringForNumber", kDomain + "[time]\nfps = '30'\n", {":4:7: time.fps", "string", "number"}},
    {"FractionForCount", kDomain + "resolution = 64.5\n", {":3:14: ", "64.5", "whole number"}},
    {"NumberForSwitch", kDomain + "[output]\nliquid = 1\n", {":4:10: ", "true or false"}},
    {"ShortVector", "[domain]\nsize = [1, 1]\n", {":2:8: domain.size has 2 entries", "3 numbers"}},
    {"MixedVector", "[domain]\nsize = [1, 'a', 1]\n", {":2:8: domain.size", "string"}},
    {"UnknownChoice", kDomain + "[foam]\npreset = 'real'\n", {":4:10: foam.preset", "paper, physical"}},
    {"UnknownWall", kDomain + "walls = ['top']\n", {":3:9: domain.walls", "top", "-x, +x, -y, +y, -z, +z"}},
    {"TableForArray", kDomain + "[inflow]\nspeed = 1\n", {":3:1: inflow", "[[inflow]]"}},
    {"ArrayForTable", kDomain + "[[foam]]\n", {"foam is not a table", "[foam]"}},
    {"UnorderedKeys",
     kDomain + "[[inflow]]\nspeed = { keys = [[1, 1], [0, 2]] }\n",
     {":4:9: ", "increasing"}},
    {"KeyOutOfRange", kDomain + "[[inflow]]\nspeed = { keys = [[0, 1000]] }\n", {":4:9: ", "0 to 100 [m/s]"}},
    {"KeyOfOtherShape", kDomain + "[[solid]]\nshape = 'box'\nradius = 1\n", {":5:10: ", "sphere, cylinder"}},
    {"UnorderedVectorKeys",
     kDomain +
         "[[solid]]\nshape = 'sphere'\nradius = 0.1\nposition = { keys = [[1, 0, 0, 0], [0, 1, 0, 0]] }\n",
     {":6:12: ", "[[t, x, y, z], ...]", "increasing"}},
    {"ThinVessel",
     kDomain + "[[solid]]\nname = 'mug'\nshape = 'vessel'\nwall_thickness = 0\n",
     {":6:18: solid.0.wall_thickness = 0", "1e-06 to 10000 [m]"}},
    {"NoSuchVessel",
     kDomain + "[[liquid_body]]\nname = 'tea'\nvessel = 'mug'\ndepth = 0.1\n",
     {":5:10: liquid_body 'tea': vessel = \"mug\"", "[[solid]]", "give one that name"}},
    {"OverfullVessel",
     kDomain + "[[solid]]\nname = 'mug'\nshape = 'vessel'\ncentre = [0.5, 0.5, 0.5]\n"
               "[[liquid_body]]\nname = 'tea'\nvessel = 'mug'\ndepth = 0.2\n",
     {":10:9: liquid_body 'tea': depth = 0.2 m", "more than 0, up to its inner_height of 0.1 m"}},
    {"ShapeBesideVessel",
     kDomain + "[[liquid_body]]\nvessel = 'mug'\nshape = 'box'\n",
     {":5:9: liquid_body.0.shape", "does not apply"}},
    {"RateOfAFreeOutflow", kDomain + "[[outflow]]\nrate = 1\n", {":4:8: outflow.0.rate", "mode rate"}},
    {"OutflowOutside",
     kDomain + "[[outflow]]\nname = 'drain'\nshape = 'sphere'\ncentre = [3, 0, 0]\nradius = 0.1\n",
     {":6:10: outflow 'drain': centre = [3, 0, 0] m: the sphere from [2.9, -0.1, -0.1] to",
      "lies outside the domain from [0, 0, 0] to [1, 1, 1] m; move it"}},
    {"OutflowWithoutCells",
     kDomain + "[[outflow]]\nname = 'drain'\nshape = 'sphere'\ncentre = [0.5, 0.5, 0.5]\nradius = 1e-3\n",
     {":7:10: outflow 'drain': radius = 0.001 m: the outflow holds 0 centres of cells of 0.015625 m, at "
      "least",
      "make it larger or raise domain.resolution"}},
    {"FlatOutflowWithoutCells",
     kDomain + "[[outflow]]\nlower = [0.5, 0.5, 0.5]\nupper = [0.501, 0.6, 0.6]\n",
     {":5:9: outflow 0: upper = [0.501, 0.6, 0.6] m: the outflow holds 0 "}},
    {"ProbeOutside",
     kDomain + "[[probe]]\nname = 'p1'\nkind = 'pressure'\nposition = [0.5, 2, 0.5]\n",
     {":6:12: probe 'p1': position = [0.5, 2, 0.5] m", "outside the domain from", "move the probe"}},
    {"ProbeOfAVolumeOutside",
     kDomain + "[[probe]]\nname = 'p2'\nkind = 'volume'\nlower = [2, 0, 0]\nupper = [3, 1, 1]\n",
     {":6:9: probe 'p2': lower = [2, 0, 0] m: the box from [2, 0, 0] to [3, 1, 1] m", "move it"}},
    {"ProbeNameWithComma", kDomain + "[[probe]]\nname = 'a,b'\n", {":4:8: probe.0.name", "letters"}},
    {"MeshWithoutFile",
     kDomain + "[[solid]]\nname = 'duck'\nshape = 'mesh'\n",
     {":3:1: solid 'duck': file is missing; name the mesh"}},
    {"UnsafeName", kDomain + "[scene]\nname = '../x'\n", {":4:8: scene.name", "letters"}},
    {"StepsCrossed", kDomain + "[time]\nmin_step = 0.1\n", {":4:12: time.min_step = 0.1", "time.max_step"}},
    {"RadiiCrossed", kDomain + "[coupling.entrainment]\nmin_radius = 0.01\n", {":4:14: ", "median_radius"}},
    {"TooManyCells", "[domain]\nsize = [1, 1, 1]\nresolution = 1025\n", {":3:14: ", "1024"}},
    {"FlatBox",
     kDomain + "[[solid]]\nname = 'slab'\nlower = [0, 1, 0]\nupper = [1, 1, 1]\n",
     {":6:9: solid 'slab': upper = [1, 1, 1] m must exceed lower = [0, 1, 0] m on every axis"}},
    {"NoRadius",
     kDomain + "[[solid]]\nshape = 'sphere'\n",
     {":3:1: solid 0: radius = 0 m; a sphere needs more than 0 m"}},
    {"NoHeight",
     kDomain + "[[solid]]\nshape = 'cylinder'\nradius = 0.1\n",
     {":3:1: solid 0: height = 0 m; a cylinder needs more than 0 m"}},
    {"ZeroRotationAxis",
     kDomain + "[[solid]]\nshape = 'sphere'\nradius = 0.1\nrotation_axis = [0, 0, 0]\n",
     {":6:17: solid 0: rotation_axis = [0, 0, 0] has no direction; [0, 1, 0] points upwards"}},
    {"ZeroAxis",
     kDomain + "[[solid]]\nshape = 'cylinder'\naxis = [0, 0, 0]\nradius = 1\nheight = 1\n",
     {":5:8: solid 0: axis = [0, 0, 0] has no direction; [0, 1, 0] points upwards"}},
    {"BodyOutside",
     kDomain + "[[liquid_body]]\nname = 'lost'\nshape = 'sphere'\ncentre = [5, 5, 5]\nradius = 1\n",
     {":6:10: liquid_body 'lost': centre = [5, 5, 5] m: the sphere", "outside the domain", "remove it"}},
    {"InflowOutside",
     kDomain + "[[inflow]]\nname = 'jet'\ncentre = [0.5, 2, 0.5]\nradius = 0.1\n",
     {":5:10: inflow 'jet': centre = [0.5, 2, 0.5] m: its outlet leaves the domain", "shrink the radius"}},
    {"NozzleWithoutRoom",
     kDomain + "[[inflow]]\nname = 'jet'\ncentre = [0.5, 0.99, 0.5]\nradius = 0.1\n",
     {":5:10: inflow 'jet': centre = [0.5, 0.99, 0.5] m: the nozzle needs 0.03125 m behind its outlet",
      "by at least that"}},
    {"InflowInSolid",
     kDomain + "[[solid]]\nshape = 'sphere'\ncentre = [0.5, 0.5, 0.5]\nradius = 0.3\n"
               "[[inflow]]\ncentre = [0.5, 0.5, 0.5]\nradius = 0.1\n",
     {":8:10: inflow 0: centre = [0.5, 0.5, 0.5] m: its outlet is inside a solid at", "move the inflow"}},
    {"InflowTooThin",
     kDomain + "[[inflow]]\ncentre = [0.5, 0.5, 0.5]\nradius = 0.001\n",
     {":5:10: inflow 0: radius = 0.001 m is too small for cells of 0.015625 m; at least 0.01171875 m",
      "or a finer domain.resolution"}},
    {"InflowWithoutDirection",
     kDomain + "[[inflow]]\ncentre = [0.5, 0.5, 0.5]\nradius = 0.1\ndirection = [0, 0, 0]\n",
     {":6:13: inflow.0.direction = [0, 0, 0] has no direction; [0, -1, 0] points downwards"}},
    {"TimesCrossed",
     kDomain + "[[inflow]]\ncentre = [0.5, 0.5, 0.5]\nradius = 0.1\nstart = 2\nstop = 1\n",
     {":6:9: inflow.0.start = 2 exceeds inflow.0.stop = 1 [s]; lower the one or raise the other"}},
    {"SameNameTwice",
     kDomain + "[[solid]]\nname = 'a'\nshape = 'sphere'\nradius = 0.1\n"
               "[[solid]]\nname = 'a'\nshape = 'sphere'\nradius = 0.1\n",
     {":8:8: solid 'a': name = \"a\" is that of another object too; give each its own"}},
    {"BubbleOutside",
     kDomain + "[[bubbles]]\nposition = [2, 0, 0]\nradius = 0.001\n",
     {":4:12: bubbles 0: position = [2, 0, 0] m lies outside the domain", "move the bubble"}},
    {"KillOutside",
     kDomain + "[[bubble_kill]]\nname = 'k'\nshape = 'sphere'\ncentre = [2, 2, 2]\nradius = 0.1\n",
     {":6:10: bubble_kill 'k': centre = [2, 2, 2] m: the sphere", "outside the domain", "move it"}},
    {"BubbleWithoutRadius",
     kDomain + "[[bubbles]]\nposition = [0, 0, 0]\n",
     {":3:1: bubbles.0.radius is missing"}},
    {"HugeBubble",
     kDomain + "[[bubbles]]\nposition = [0, 0, 0]\nradius = 0.9\n",
     {":5:10: bubbles 0: radius = 0.9 m: the bubble is larger than the domain; at most 0.5 m"}},
    {"WetnessOverOne", kDomain + "[foam]\nwetness = 1.1\n", {":4:11: foam.wetness = 1.1", "0 to 1"}},
    {"WetnessBelowZero", kDomain + "[foam]\nwetness_aloft = -0.1\n", {":4:17: ", "0 to 1"}},
    {"CoefficientNotANumber",
     kDomain + "[foam]\nliquid_adhesion = nan\n",
     {":4:19: foam.liquid_adhesion", "[N/m]"}},
    {"ContactAngle",
     kDomain + "[foam.walls]\ncontact_angle = 200\n",
     {":4:17: foam.walls.contact_angle = 200", "0 to 180 [degrees]"}},
    {"SolidCoefficient",
     kDomain + "[[solid]]\nshape = 'sphere'\nradius = 0.1\nadhesion = -1\n",
     {":6:12: solid.0.adhesion = -1", "0 to 100 [N/m]"}},
    {"NegativeBubble",
     kDomain + "[[bubbles]]\nradius = -1e-3\n",
     {":4:10: bubbles.0.radius = -0.001", "1e-06 to 1 [m]"}},
    {"NoNumberOfBubble", kDomain + "[[bubbles]]\nradius = nan\n", {":4:10: bubbles.0.radius", "[m]"}},
    {"WetnessOfOneBubble",
     kDomain + "[[bubbles]]\nradius = 1e-3\nwetness = 0.5\n",
     {":5:11: bubbles.0.wetness does not apply", "per_bubble"}},
    {"BubbleInSolid",
     kDomain + "[[solid]]\nshape = 'sphere'\nradius = 0.1\n[[bubbles]]\nradius = 1e-3\n",
     {":6:1: bubbles 0: position = [0, 0, 0] m is inside a solid; move the bubble or the solid"}},
    {"FileAndRadius",
     kDomain + "[[bubbles]]\nfile = 'x.csv'\nradius = 1e-3\n",
     {":5:10: bubbles.0.radius does not apply", "without a file"}},
    {"OverrideOutOfRange",
     kDomain,
     {"--set time.fps=0: time.fps = 0", "1 to 1000 [1/s]"},
     {{"time.fps", "0"}}},
    {"OverrideOfAnObjectThatDoesNotFit",
     kDomain + "[[inflow]]\nname = 'jet'\ncentre = [0.5, 0.5, 0.5]\nradius = 0.1\n",
     {"--set inflow.0.centre=[0.5, 2, 0.5]: inflow 'jet': centre = [0.5, 2, 0.5] m", "leaves the domain"},
     {{"inflow.0.centre", "[0.5, 2, 0.5]"}}},
    {"OverrideInAnObjectThatDoesNotFit",
     kDomain + "[[solid]]\nname = 'ball'\nshape = 'sphere'\n",
     {"bad_scene.toml:3:1 with --set solid.0.centre=[1, 1, 1]: solid 'ball': radius = 0 m"},
     {{"solid.0.centre", "[1, 1, 1]"}}},
    {"MedianOutsideTheCut",
     kDomain + "[[bubble_source]]\nshape = 'sphere'\nradius = 0.1\nmedian_radius = 0.1\n",
     {":6:17: bubble_source.0.median_radius = 0.1 lies outside the cut: min_radius", "[m]; move it"}},
    {"RadiiOfASourceCrossed",
     kDomain +
         "[[bubble_source]]\nshape = 'sphere'\nradius = 0.1\nradius_law = 'uniform'\nmin_radius = 0.1\n",
     {":7:14: bubble_source.0.min_radius = 0.1 exceeds bubble_source.0.max_radius", "[m]; lower the one"}},
    {"UnknownKeyLikeNoOther", kDomain + "[foam]\nlambda = 1\n", {"foam.lambda", "check --keys"}},
    {"OverrideUnknown", kDomain, {"--set time.fsp=3: unknown key time.fsp", "time.fps"}, {{"time.fsp", "3"}}},
    {"OverrideUnknownTable", kDomain, {"--set tiem.fps=3: unknown key tiem", "time"}, {{"tiem.fps", "3"}}},
    {"OverrideMissingItem", kDomain, {"--set inflow.0.speed=3", "array.0.key"}, {{"inflow.0.speed", "3"}}},
};

INSTANTIATE_TEST_SUITE_P(Table, BadScene, testing::ValuesIn(kBadInputs),
                         [](const testing::TestParamInfo<BadInput>& input) { return input.param.name; });

/// What a scene says about a file of bubbles beside it.
std::string messageOfBubbles(const std::string& csv, const std::string& scene = kDomain) {
  const std::string path = temporaryPath("bad_bubbles.csv");
  std::ofstream(path, std::ios::binary) << csv;
  const std::string message = messageOf(scene + "[[bubbles]]\nfile = 'bad_bubbles.csv'\n");
  std::remove(path.c_str());
  return message;
}

TEST(BubbleFile, IsRefusedWithFileAndLine) {
  const std::string head = "id,x,y,z,r\n", good = "0,0.5,0.5,0.5,1e-3\n";
  const std::pair<std::string, std::vector<std::string>> kCases[] = {
      {"", {"bad_bubbles.csv: is empty"}},
      {head, {"bad_bubbles.csv", "no bubbles"}},
      {head + good + "1,0.5,0.5,0.5,-1e-3\n", {"bad_bubbles.csv:3:", "radius", "-0.001"}},
      {head + good + "1,0.5,0.5,0.5,nan\n", {"bad_bubbles.csv:3:", "radius"}},
      {head + good + good, {"bad_bubbles.csv:3:", "id 0", "bad_bubbles.csv:2:"}},
      {head + good + "1,0.5,0.5\n", {"bad_bubbles.csv:3:", "3 fields"}},
      {head + "\r\n" + good + "1,0.5,1.5,0.5,1e-3\r\n",
       {"bad_scene.toml:4:8: bubbles 0: ", "bad_bubbles.csv:4: position = [0.5, 1.5, 0.5] m",
        "outside the domain"}},
      {"id,x,y,z,r,vx,vy,vz\n0,0.5,0.5,0.5,1e-3,0,1e6,0\n",
       {"bad_bubbles.csv:2: velocity = [0, 1e+06, 0] m/s", "-100 to 100 [m/s]"}},
      {head + "0,0.5,0.5,0.5,1e-9\n", {"bad_bubbles.csv:2: radius = 1e-09 m", "1e-06 m or more"}},
      {head + good + "1,0.5,0.5,0.5,0.6\n",
       {"bad_bubbles.csv:3: radius = 0.6 m", "larger than the domain", "0.5 m"}}};
  for (const auto& [csv, parts] : kCases) {
    const std::string message = messageOfBubbles(csv);
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
  }
  const std::string solid = kDomain + "[[solid]]\nshape = 'sphere'\ncentre = [0.5, 0.5, 0.5]\nradius = 0.1\n";
  EXPECT_NE(messageOfBubbles(head + good, solid)
                .find("bad_bubbles.csv:2: position = [0.5, 0.5, 0.5] m is inside a"),
            std::string::npos);
}

TEST(BubbleSource, IsRefusedWithFileAndLine) {
  const auto messageOfSource = [](const std::string& centre, const std::string& most) {
    return messageOf(
        kDomain + "[[solid]]\nshape = 'sphere'\ncentre = [0.5, 0.5, 0.5]\nradius = 0.2\n" +
        "[[bubble_source]]\nname = 'frit'\nshape = 'sphere'\ncentre = " + centre +
        "\nradius = 0.1\nrate = 10\nradius_law = 'uniform'\nmin_radius = 1e-3\nmax_radius = " + most + "\n");
  };
  const std::tuple<std::string, std::string, std::vector<std::string>> kCases[] = {
      {"[0.5, 0.5, 0.5]",
       "1e-3",
       {":10:10: bubble_source 'frit': centre = [0.5, 0.5, 0.5] m: all of the source is inside a solid",
        "move"}},
      {"[2, 0.5, 0.5]",
       "1e-3",
       {":10:10: bubble_source 'frit': centre = [2, 0.5, 0.5] m", "outside the domain", "move"}},
      {"[0.5, 0.8, 0.5]", "0.6", {":15:14: bubble_source 'frit': max_radius = 0.6 m", "at most 0.5 m"}}};
  for (const auto& [centre, most, parts] : kCases) {
    const std::string message = messageOfSource(centre, most);
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
  }
  EXPECT_EQ(messageOfSource("[0.5, 0.8, 0.5]", "0.5"), "");
}

/// A closed box, in a file beside the scene.
std::string messageOfMesh(const std::string& firstVertex, const std::string& scale) {
  const std::string path = temporaryPath("box.obj");
  std::ofstream(path) << "v " << firstVertex << "\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                      << "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string message = messageOf(
      kDomain + "[[solid]]\nname = 'duck'\nshape = 'mesh'\nfile = 'box.obj'\nscale = " + scale + "\n");
  std::remove(path.c_str());
  return message;
}

TEST(MeshFile, AnotherUnitIsRefusedWithPlaceAndRemedy) {
  EXPECT_EQ(messageOfMesh("0 0 0", "1"), "");
  for (const std::string& message : {messageOfMesh("0 0 0", "100"), messageOfMesh("1e30 0 0", "1")})
    for (const std::string part : {":7:9: solid 'duck': ", "box.obj: is ", "scale", "at most 20 m"})
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

TEST(MeshFile, MissingOneIsAFileErrorWithThePlaceInTheScene) {
  const SceneFile file(kDomain + "[[solid]]\nname = 'duck'\nshape = 'mesh'\nfile = 'no.obj'\n");
  try {
    readScene(file.path());
    FAIL() << "a missing file was read";
  } catch (const FileError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("bad_scene.toml:6:8: solid 'duck': "), std::string::npos) << message;
    EXPECT_NE(message.find("no.obj: cannot read: No such file"), std::string::npos) << message;
  }
}

TEST(SceneFile, AnyFileNameMakesASceneName) {
  const std::string path = temporaryPath("my scene \xc3\xbc.toml");
  std::ofstream(path) << kDomain;
  EXPECT_EQ(readScene(path).name, "my_scene___");
  std::remove(path.c_str());
}

TEST(SceneFile, MissingFileIsAFileError) {
  try {
    readScene("/no/such/scene.toml");
    FAIL() << "a missing file was read";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/scene.toml: cannot read: No such file"),
              std::string::npos)
        << error.what();
  }
  EXPECT_THROW(readScene("/tmp"), FileError);
}

}  // namespace
}  // namespace spume::coupling
