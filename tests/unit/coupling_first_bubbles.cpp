#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coupling/first_bubbles.h"
#include "coupling/scene_toml.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

using Ids = std::vector<std::uint64_t>;
using Numbers = std::vector<double>;

const std::string kHead = "id,x,y,z,r\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    "property float radius\nend_header\n0.5 0.5 0.5 0.125\n0.5 0.5 0.25 0.25\n";

/// A scene in a folder with files of bubbles.
class FirstBubblesOfAScene : public testing::Test {
 protected:
  FirstBubblesOfAScene() : folder_(temporaryPath("first_bubbles")) {
    std::filesystem::create_directories(folder_);
  }
  ~FirstBubblesOfAScene() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ + "/" + name) << text;
  }
  Scene scene(const std::string& text) {
    write("scene.toml", "[domain]\nsize = [1, 1, 1]\n" + text);
    return readScene(folder_ + "/scene.toml");
  }
  /// The message the scene is refused with; empty if it is not.
  std::string refusal(const std::string& text) {
    try {
      scene(text);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  }

  static std::string file(const std::string& name) { return "[[bubbles]]\nfile = '" + name + "'\n"; }
  static std::string single(double radius) {
    return "[[bubbles]]\nposition = [0.5, 0.5, 0.5]\nradius = " + std::to_string(radius) + "\n";
  }

 private:
  std::string folder_;
};

TEST_F(FirstBubblesOfAScene, KeepTheIdsOfTheirFilesAndBirthsGoOnFromTheLargest) {
  write("a.csv", kHead + "70,0.5,0.5,0.5,0.0625\n50,0.5,0.5,0.25,0.125\n");
  write("b.csv", kHead + "60,0.5,0.5,0.5,0.25\n");
  foam::BubbleStore bubbles = initialBubbles(scene(file("a.csv") + file("b.csv")));
  EXPECT_EQ(bubbles.id, (Ids{50, 60, 70}));
  EXPECT_EQ(bubbles.radius, (Numbers{.125, .25, .0625}));
  EXPECT_EQ(bubbles.nextId, 71u);
  EXPECT_EQ(bubbles.add({{0, 0, 0}, {0, 0, 0}, 1}), 71u);
}

TEST_F(FirstBubblesOfAScene, WithoutIdsAreNumberedOnInTheOrderOfTheScene) {
  write("a.csv", kHead + "5,0.5,0.5,0.5,0.0625\n");
  write("b.ply", kPly);
  const foam::BubbleStore bubbles =
      initialBubbles(scene(single(.375) + file("b.ply") + file("a.csv") + file("b.ply")));
  EXPECT_EQ(bubbles.id, (Ids{5, 6, 7, 8, 9, 10}));
  EXPECT_EQ(bubbles.radius, (Numbers{.0625, .375, .125, .25, .125, .25}));
  EXPECT_EQ(bubbles.nextId, 11u);
  EXPECT_EQ(initialBubbles(scene(file("b.ply"))).id, (Ids{0, 1}));
}

TEST_F(FirstBubblesOfAScene, MayNotShareAnId) {
  write("a.csv", kHead + "7,0.5,0.5,0.5,0.0625\n");
  write("b.csv", kHead + "6,0.5,0.5,0.5,0.0625\n7,0.5,0.5,0.5,0.0625\n");
  const std::string message = refusal(file("a.csv") + file("b.csv"));
  for (const char* part :
       {"scene.toml:6:8: bubbles 1: ", "b.csv:3: id = 7 is already that of ", "a.csv:2; every bubble"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
}

TEST_F(FirstBubblesOfAScene, MayNotHaveIdsThatCachesCannotHold) {
  write("a.csv", kHead + "4503599627370496,0.5,0.5,0.5,0.0625\n");
  EXPECT_EQ(refusal(file("a.csv")), "");
  write("a.csv", kHead + "4503599627370497,0.5,0.5,0.5,0.0625\n");
  EXPECT_NE(refusal(file("a.csv")).find("a.csv:2: id = 4503599627370497; a scene may give 0 to"),
            std::string::npos);
}

TEST_F(FirstBubblesOfAScene, HaveTheWetnessOfTheirFileWhereItIsPerBubble) {
  write("a.csv", "id,x,y,z,r,wetness\n0,0.5,0.5,0.5,0.0625,0.75\n1,0.5,0.5,0.25,0.0625,0\n");
  write("b.csv", kHead + "2,0.5,0.5,0.5,0.0625\n3,0.5,0.5,0.5,0.0625\n");
  const std::string law = "[foam]\nwetness_law = 'per_bubble'\nwetness = 0.5\n";
  const Scene given = scene(law + file("a.csv") + "wetness = 0.25\n" + file("b.csv") + "wetness = 1\n");
  EXPECT_EQ(initialBubbles(given).wetness, (Numbers{.75, 0, 1, 1}));
  EXPECT_EQ(initialBubbles(scene(law + file("b.csv"))).wetness, (Numbers{.5, .5}));
}

TEST_F(FirstBubblesOfAScene, AreWarnedOfColumnsAndWetnessThatDoNothing) {
  write("a.csv", "id,x,y,z,r,wetness,wettness\n0,0.5,0.5,0.5,0.0625,0.75,0\n");
  const auto findingsOf = [this](const std::string& law) {
    FindingList findings;
    FirstBubbles(scene("[foam]\nwetness_law = '" + law + "'\n" + file("a.csv"))).lint(findings);
    return findings.take();
  };
  const std::vector<Finding> all = findingsOf("constant");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].severity, Severity::warning);
  EXPECT_NE(all[0].message.find("column 'wettness' is not read"), std::string::npos) << all[0].message;
  EXPECT_NE(all[1].message.find("wetness does nothing"), std::string::npos) << all[1].message;
  EXPECT_EQ(findingsOf("per_bubble").size(), 1u);
}

}  // namespace
}  // namespace spume::coupling
