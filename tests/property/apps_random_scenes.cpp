// Scenes that nobody would write, drawn from a seed: all that is refused is refused for a reason, nothing
// crashes or fails, and a run resumed at every frame is the one that was never interrupted, to the last bit.
//
// SPUME_RANDOM_SCENES=FIRST:COUNT in the environment looks further than the suite does.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "foam/counter_random.h"
#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

constexpr int kFrames = 4;

/// A scene as its file has it.
class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : random_(seed, 0x7363656e65, 0) {
    size_ = between(0.02, 0.3), height_ = size_ * even(0.7, 1.4), level_ = height_ * even(0.25, 0.7);
    radius_ = 0.02 * size_ * between(0.3, 1);
    add("[domain]\nsize = ", vector(size_, height_, size_), "\nresolution = ", pick({12, 16, 20}));
    add("\n[time]\nfps = ", pick({24, 30, 60}), "\nframes = ", kFrames);
    add("\n[output]\ncheckpoint_every = 1\nfilms = ", flag(0.3));
    still_ = chance(0.15), vessel_ = !still_ && chance(0.3);
    if (still_)
      add("\n[still_pool]\nenabled = true\nlevel = ", level_);
    else
      addLiquid();
    addSolids(), addBubbles(), addFoam();
  }
  std::string text() const { return text_.str() + "\n"; }

 private:
  bool chance(double share) { return random_.uniform() < share; }
  double even(double low, double high) { return low + (high - low) * random_.uniform(); }
  double between(double low, double high) { return low * std::pow(high / low, random_.uniform()); }
  const char* flag(double share) { return chance(share) ? "true" : "false"; }
  template <typename T>
  T pick(std::initializer_list<T> of) {
    return of.begin()[static_cast<std::size_t>(random_.uniform() * static_cast<double>(of.size()))];
  }
  static std::string vector(double x, double y, double z) {
    std::ostringstream out;
    out << "[" << x << ", " << y << ", " << z << "]";
    return out.str();
  }
  std::string middle(double height) const { return vector(size_ / 2, height, size_ / 2); }
  template <typename... Parts>
  void add(const Parts&... parts) {
    (text_ << ... << parts);
  }

  void addLiquid() {
    add("\n[liquid]\ncfl = ", pick({1, 2, 4, 8}), "\nmarkers_per_cell = 8");
    if (chance(0.3)) add("\nviscosity = ", between(1e-3, 10));
    if (chance(0.15)) add("\nsurface_tension = ", even(0.01, 0.08));
    if (chance(0.2)) add("\nlevel_set_transport = \"weno5\"");
    if (chance(0.3)) add("\nvelocity_advection = \"", pick({"semi_lagrangian", "trapezoidal"}), "\"");
    if (chance(0.15)) add("\nvolume_control = false");
    if (chance(0.7) && !vessel_)
      add("\n[[liquid_body]]\nlower = [-1, -1, -1]\nupper = ", vector(1, level_, 1));
    if (chance(0.3))
      add("\n[[liquid_body]]\nshape = \"sphere\"\ncentre = ", middle(0.75 * height_),
          "\nradius = ", 0.12 * size_);
    if (chance(0.6)) {
      add("\n[[inflow]]\ncentre = ", middle(0.7 * height_), "\ndirection = ", vector(even(-0.3, 0.3), -1, 0));
      add("\nradius = ", 0.12 * size_, "\nspeed = ", between(0.05, 2),
          "\nturbulence = ", pick({0.0, 0.05, 0.3}));
      add("\nstart = ", pick({0.0, 1.0 / 30, 2.0 / 24, 0.05}), "\nstop = ", pick({0.08, 5.0}));
    }
    if (chance(0.2))
      add("\n[[outflow]]\nmode = \"rate\"\nrate = ", between(1e-7, 1e-5),
          "\nlower = [0, 0, 0]\nupper = ", vector(size_, 0.15 * height_, size_));
  }

  void addSolids() {
    if (vessel_)
      add("\n[[solid]]\nname = \"solid\"\nshape = \"vessel\"\ncentre = ", middle(0.15 * height_),
          "\ninner_diameter = ", 0.5 * size_, "\ninner_height = ", 0.4 * height_,
          "\nwall_thickness = ", 0.15 * size_, "\nbottom_thickness = ", 0.14 * height_);
    else if (chance(0.4))
      add("\n[[solid]]\nname = \"solid\"\nshape = \"sphere\"\ncentre = ",
          vector(0.3 * size_, height_ * even(0.2, 0.6), 0.4 * size_),
          "\nradius = ", size_ * even(0.08, 0.15));
    else
      return;
    if (chance(0.5)) add("\ndetach_radius = ", between(1e-4, 1e-2), "\ncontact_angle = ", even(0, 180));
    if (!vessel_ && !still_ && chance(0.5))
      add("\nposition = { keys = [[0, 0, 0, 0], [0.1, ", 0.2 * size_, ", 0, 0]] }");
    if (vessel_) add("\n[[liquid_body]]\nvessel = \"solid\"\ndepth = ", 0.3 * height_ * random_.uniform());
    if (chance(0.5))
      add("\n[[nucleation]]\nsolid = \"solid\"\ndensity = ", between(1e3, 1e5),
          "\nwaiting = 0.1\nmin_radius = ", 0.3 * radius_, "\nmax_radius = ", radius_);
  }

  void addBubbles() {
    add("\n[coupling]\ntwo_way = ", flag(0.4), "\nimmersed_gas = ", flag(0.7));
    add("\n[coupling.entrainment]\nonset = 0.2\nlength = ", between(1e-4, 5e-3),
        "\nmedian_radius = ", radius_, "\nmin_radius = ", 0.5 * radius_, "\nmax_radius = ", 2 * radius_);
    if (chance(0.7))
      add("\n[[bubble_source]]\nshape = \"sphere\"\ncentre = ",
          vector(size_ / 2, 0.2 * height_, 0.55 * size_), "\nradius = ", size_ * even(0.05, 0.15),
          "\nrate = ", between(100, 10000), "\nmin_radius = ", 0.5 * radius_, "\nmax_radius = ", 2 * radius_,
          "\nstop = ", pick({0.05, 0.1, 5.0}));
    if (chance(0.3)) add("\n[dissolved_gas]\nenabled = true");
    if (chance(0.15)) add("\n[[bubble_kill]]\nlower = ", vector(-1, level_, -1), "\nupper = [2, 2, 2]");
  }

  void addFoam() {
    add("\n[foam]\npreset = \"", pick({"physical", "paper"}),
        "\"\nborder_rate = ", pick({0.0, 0.0, 4.0, 20.0}));
    if (chance(0.5)) add("\nvolume_mode = \"newton\"\nvolume_tolerance = ", between(1e-4, 5e-2));
    if (chance(0.3)) add("\nattraction_law = \"", pick({"none", "coefficient", "capillary"}), "\"");
    if (chance(0.3)) add("\nwetness = ", random_.uniform(), "\nwetness_aloft = ", random_.uniform());
    if (chance(0.15)) add("\nsolver = \"", pick({"pcg_jacobi", "cholmod"}), "\"");
    if (chance(0.2)) add("\nsolver_tolerance = ", between(1e-9, 1e-1));
    if (chance(0.3)) add("\nburst_median_life = ", between(1e-2, 1));
    if (chance(0.2)) add("\nradius_limit = ", even(1.1, 8));
    if (chance(0.15)) add("\nconnectivity = \"global\"");
  }

  foam::CounterRandom random_;
  std::ostringstream text_;
  double size_ = 0, height_ = 0, level_ = 0, radius_ = 0;  // [m]
  bool still_ = false, vessel_ = false;
};

/// steps.csv without the columns of seconds.
std::string untimed(const std::string& table) {
  std::istringstream lines(table);
  std::string line, cell, kept;
  std::set<int> timed;
  for (bool isHead = true; std::getline(lines, line); isHead = false) {
    std::istringstream cells(line);
    for (int column = 0; std::getline(cells, cell, ','); ++column) {
      if (isHead && cell.starts_with("seconds")) timed.insert(column);
      if (!timed.contains(column)) kept += cell + ',';
    }
    kept += '\n';
  }
  return kept;
}

/// Whether the program takes the scene.
bool runsAndResumes(std::uint64_t seed) {
  const Scratch scratch;
  const std::string text = RandomScene(seed).text(), scene = scratch.write("scene.toml", text);
  const auto run = [&](const std::string& folder, int frames) {
    return runSpume("run " + scene + " -o " + scratch / folder + " --no-preview --frames " +
                    std::to_string(frames));
  };
  const Outcome whole = run("whole", kFrames);
  EXPECT_TRUE(whole.code == 0 || whole.code == 2) << seed << ": " << whole.code << " " << whole.errors;
  if (whole.code == 2)
    EXPECT_NE(whole.errors.find("scene.toml:"), std::string::npos) << seed << ": " << whole.errors;
  if (whole.code != 0) return false;
  for (int frames = 1; frames <= kFrames; ++frames) {
    const Outcome part = run("parts", frames);
    EXPECT_EQ(part.code, 0) << seed << " at frame " << frames << ": " << part.errors;
  }
  const auto same = [&](const std::string& file) {
    return contentsOf(scratch / ("whole/" + file)) == contentsOf(scratch / ("parts/" + file));
  };
  EXPECT_TRUE(same("bubbles/bubbles.0004.ply")) << seed << text;
  EXPECT_EQ(untimed(contentsOf(scratch / "whole/steps.csv")),
            untimed(contentsOf(scratch / "parts/steps.csv")))
      << seed << text;
  return true;
}

TEST(RandomScenes, RunAndResumeToTheBit) {
  int first = 1, count = 12, taken = 0;
  if (const char* asked = std::getenv("SPUME_RANDOM_SCENES")) std::sscanf(asked, "%d:%d", &first, &count);
  for (int seed = first; seed < first + count; ++seed)
    taken += runsAndResumes(static_cast<std::uint64_t>(seed));
  EXPECT_GE(taken, count / 2) << "the others were refused";
}

}  // namespace
}  // namespace spume::apps::test
